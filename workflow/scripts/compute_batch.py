"""Compute one batch of a grid study, a text of `GridStudy.batches` read from standard input, since
it may be long."""

import sys

import xarray as xr

from disc_model.data.dataset import save
from disc_model.errors import script
from disc_model.studies.run import run_batch


@script
def main(output: str) -> None:
    save(xr.DataTree(run_batch(sys.stdin.read().strip())), output)
