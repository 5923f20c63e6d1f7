"""Measure speed against accuracy; write the dataset, and the table as CSV."""

import xarray as xr

from disc_model.benchmarks.table import table
from disc_model.benchmarks.work_precision import work_precision
from disc_model.data.dataset import save
from disc_model.errors import script


@script
def main(output: str, csv: str) -> None:
    dataset = work_precision()
    save(xr.DataTree(dataset), output)
    table(dataset).to_csv(csv, index=False)
