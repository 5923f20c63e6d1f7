"""Merge the costs of the answers into one dataset, and write its rows as CSV."""

import xarray as xr

from benchmarks.answers import in_words
from disc_model.data.dataset import load_tree, save
from disc_model.errors import script


@script
def main(output: str, csv: str, *parts: str) -> None:
    datasets = [tree.to_dataset() for tree in map(load_tree, parts)]
    dataset = xr.concat(datasets, "row", combine_attrs="override")
    save(xr.DataTree(dataset), output)
    in_words(dataset).to_csv(csv, index=False)
