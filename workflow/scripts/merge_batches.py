"""Merge the batches of a grid study into one dataset, and list the points that failed.

What to merge is read from standard input as JSON: names of the batches, grid, attributes.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

import xarray as xr

from disc_model.data.dataset import load_inputs, save
from disc_model.errors import exit_on_error
from disc_model.studies.grids.merge import failures, merge_batches


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("output", help="netCDF file to write")
    parser.add_argument("report", type=Path, help="text file to write: one line for each point that failed")
    parser.add_argument("folder", type=Path, help="where the batches are")
    args = parser.parse_args()
    plan = json.load(sys.stdin)
    batches = load_inputs([args.folder / f"{name}.nc" for name in plan["batches"]])
    study = merge_batches([batch.to_dataset() for batch in batches], plan["grid"], plan["attrs"])
    args.report.write_text("".join(f"{line}\n" for line in failures(study)), encoding="utf-8")
    save(xr.DataTree(study), args.output)


if __name__ == "__main__":
    exit_on_error(main)
