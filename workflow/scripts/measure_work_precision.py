"""Measure speed against accuracy; write the dataset, and the table as CSV and Markdown."""

from __future__ import annotations

import argparse
import logging
from pathlib import Path

import xarray as xr

from disc_model.benchmarks.table import table, to_markdown
from disc_model.benchmarks.work_precision import Point, work_precision
from disc_model.data.dataset import save


def report(point: Point, seconds: float) -> None:
    logging.info("%s %s %g: %.4g s", point.scene, point.method, point.value, seconds)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("output", help="netCDF file to write")
    parser.add_argument("--csv", type=Path, required=True)
    parser.add_argument("--md", type=Path, required=True)
    args = parser.parse_args()
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    dataset = work_precision(progress=report)
    save(xr.DataTree(dataset), args.output)
    table(dataset).to_csv(args.csv, index=False)
    args.md.write_text(to_markdown(dataset), encoding="utf-8")


if __name__ == "__main__":
    main()
