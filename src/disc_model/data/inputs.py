"""Reading what other jobs have written."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TypeVar

import xarray as xr

from disc_model.data.dataset import load
from disc_model.data.files import DamagedFile
from disc_model.errors import DiscModelError

T = TypeVar("T")

SET_ASIDE = ".damaged"
"""Ending that a damaged file gets."""


class InputsError(DiscModelError):
    """Files that are damaged or missing: a line for each, and what to do."""


def load_inputs(paths: Sequence[Path]) -> list[xr.DataTree]:
    """Read files written by `disc_model.data.dataset.save`; `each_intact` says what becomes of damaged ones."""
    return each_intact(load, paths)


def load_cases(paths: Sequence[Path]) -> dict[str, xr.DataTree]:
    """`load_inputs` by the names of the files, which are those of the cases."""
    return dict(zip([path.stem for path in paths], load_inputs(paths), strict=True))


def each_intact(read: Callable[[Path], T], paths: Sequence[Path]) -> list[T]:
    """Apply a function to files.

    Those it finds damaged are set aside under another name, so that the next run finds them missing and computes them
    anew.

    Raises
    ------
    InputsError
        If any is damaged or missing.
    """
    found, faults = [], []
    for path in paths:
        try:
            found.append(read(path))
        except DamagedFile as error:
            faults.append(f"{error}; now called {set_aside(path).name}")
        except FileNotFoundError:
            faults.append(f"{path}: not there; another job may just have set it aside")
    if faults:
        raise InputsError("\n".join([*faults, "Run snakemake again: it computes them anew."]))
    return found


def set_aside(path: Path) -> Path:
    """Give a file another name, under which nothing looks for it."""
    aside = path.with_name(path.name + SET_ASIDE)
    with contextlib.suppress(FileNotFoundError):  # another job may just have done so
        os.replace(path, aside)
    return aside
