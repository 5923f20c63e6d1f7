"""Compute one batch of a grid study and save it.

The batch, a text from `disc_model.studies.grid.GridStudy.batches`, is read from standard input: it may be too long for
a command.
"""

import sys

import xarray as xr

from disc_model.data.dataset import save
from disc_model.errors import script
from disc_model.studies.run import run_batch


@script
def main(output: str) -> None:
    save(xr.DataTree(run_batch(sys.stdin.read().strip())), output)
