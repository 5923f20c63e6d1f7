"""Measure what each answer costs one method, or this package in its own ways."""

from __future__ import annotations

import argparse
import logging

import xarray as xr

from disc_model.benchmarks.answers.measure import OWN, Row, measure
from disc_model.benchmarks.register import RIVALS
from disc_model.data.dataset import save


def report(row: Row) -> None:
    logging.info(
        "%s %s %g: %.10g, error %.3g, %.4g s, %s %s",
        *(row.answer, row.line, row.setting, row.found, row.error, row.seconds, row.status.name, row.message),
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("part", choices=[*(rival.name for rival in RIVALS), *OWN])
    parser.add_argument("output", help="netCDF file to write")
    args = parser.parse_args()
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    save(xr.DataTree(measure(args.part, progress=report)), args.output)


if __name__ == "__main__":
    main()
