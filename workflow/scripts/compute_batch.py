"""Compute one batch of a grid study and save it.

The batch, a text of `disc_model.studies.study.Cut`, is read from standard input: it may be too
long otherwise.
"""

from __future__ import annotations

import argparse
import logging
import sys

import xarray as xr

from disc_model.data.dataset import save
from disc_model.studies.grids.run import run_batch


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("output", help="netCDF file to write")
    args = parser.parse_args()
    logging.basicConfig(level=logging.INFO, format="%(name)s: %(message)s")
    save(xr.DataTree(run_batch(sys.stdin.read().strip())), args.output)


if __name__ == "__main__":
    main()
