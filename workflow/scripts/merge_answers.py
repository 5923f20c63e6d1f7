"""Merge the costs of the answers into one dataset, and write tables as Markdown."""

from pathlib import Path

import xarray as xr

from disc_model.benchmarks.answers.measure import merged
from disc_model.benchmarks.answers.report import to_markdown
from disc_model.data.dataset import load_inputs, save
from disc_model.errors import script


@script
def main(output: str, md: str, *parts: str) -> None:
    dataset = merged([tree.to_dataset() for tree in load_inputs([Path(part) for part in parts])])
    save(xr.DataTree(dataset), output)
    Path(md).write_text(to_markdown(dataset), encoding="utf-8")
