"""Put what each answer costs into one dataset, and into tables as Markdown."""

from __future__ import annotations

import argparse
from pathlib import Path

import xarray as xr

from disc_model.benchmarks.answers.measure import merged
from disc_model.benchmarks.answers.words import to_markdown
from disc_model.data.dataset import load_inputs, save
from disc_model.errors import exit_on_error


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("parts", nargs="+", type=Path, help="netCDF files")
    parser.add_argument("--out", required=True, help="netCDF file to write")
    parser.add_argument("--md", type=Path, required=True)
    args = parser.parse_args()
    dataset = merged([tree.to_dataset() for tree in load_inputs(args.parts)])
    save(xr.DataTree(dataset), args.out)
    args.md.write_text(to_markdown(dataset), encoding="utf-8")


if __name__ == "__main__":
    exit_on_error(main)
