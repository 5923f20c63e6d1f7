"""Compute the motions for the explorer, by a text of `GridStudy.motions` read from standard input:
it may be long."""

import sys

import xarray as xr

from disc_model.data.dataset import save
from disc_model.errors import script
from disc_model.studies.motions import run_motions


@script
def main(output: str) -> None:
    save(xr.DataTree(run_motions(sys.stdin.read().strip())), output)
