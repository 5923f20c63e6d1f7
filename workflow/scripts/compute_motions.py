"""Compute the motions for the explorer, at a few points of a grid study, and save them.

The text from `disc_model.studies.grid.GridStudy.motions` is read from standard input: it may be long.
"""

import sys

import xarray as xr

from disc_model.data.dataset import save
from disc_model.errors import script
from disc_model.studies.motions import run_motions


@script
def main(output: str) -> None:
    save(xr.DataTree(run_motions(sys.stdin.read().strip())), output)
