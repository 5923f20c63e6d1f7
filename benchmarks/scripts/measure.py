"""Measure a part of the benchmark: module and function of its study, such as scaling.scaling, and
their arguments."""

from importlib import import_module

import xarray as xr

from disc_model.data.dataset import save
from disc_model.errors import script


@script
def main(study: str, output: str, *of: str) -> None:
    module, _, name = study.partition(".")
    measure = getattr(import_module(f"benchmarks.{module}"), name)
    save(xr.DataTree(measure(*of)), output)
