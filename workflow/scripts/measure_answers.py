"""Measure what each answer costs; write the dataset, and the table as Markdown."""

from __future__ import annotations

import argparse
import logging
from pathlib import Path

import xarray as xr

from disc_model.benchmarks.answers.measure import Row, measure
from disc_model.benchmarks.answers.words import to_markdown
from disc_model.data.dataset import save


def report(row: Row) -> None:
    found = row.found
    logging.info(
        "%s %s %g: %.10g, error %.3g, %.4g s, %s %s",
        *(row.answer, row.line, row.setting, found.value, row.error, found.seconds, found.status.name, found.message),
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("output", help="netCDF file to write")
    parser.add_argument("--md", type=Path, required=True)
    args = parser.parse_args()
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    dataset = measure(progress=report)
    save(xr.DataTree(dataset), args.output)
    args.md.write_text(to_markdown(dataset), encoding="utf-8")


if __name__ == "__main__":
    main()
