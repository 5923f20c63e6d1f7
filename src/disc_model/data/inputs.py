"""Reading what other jobs have written: whole files, what is in the tree of a case, and many cases as one tree."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TypeVar

import numpy as np
import xarray as xr

from disc_model.data.dataset import CONVENTIONS, DamagedFile, json_attribute, load
from disc_model.data.variables import STATUSES
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


# ----------------------------------------------------------------------------------------------------
# What the tree of one case holds, or why not: what claims and figures ask it for


class Missing(Exception):
    """Evidence that is not there. The text says why; it goes on after "the case"."""


def group(case: xr.DataTree, name: str) -> xr.Dataset:
    """A window, the Poincare section ``poincare`` or ``events``, as recorded."""
    if name not in case.children:
        status = STATUSES[int(case.dataset["status"])] if "status" in case.dataset else "ok"
        raise Missing("failed" if status == "failed" else f"did not record {name}")
    return case.children[name].to_dataset(inherit=False)


def events(case: xr.DataTree) -> xr.Dataset:
    """Switches within the span ``kept_from`` to ``kept_until``."""
    found = group(case, "events")
    if "kept_from" not in found.attrs:
        raise Missing("keeps no events")
    return found


def samples(case: xr.DataTree, name: str, at_least: int = 2) -> xr.Dataset:
    """A window of single samples, no ranges; at least so many of them."""
    found = group(case, name)
    if _are_ranges(found):
        raise Missing(f"recorded {name} as ranges, not as samples: its window has an envelope")
    return _of_length(found, at_least, f"samples in {name}")


def ranges(case: xr.DataTree, name: str, at_least: int = 1) -> xr.Dataset:
    """A window of ranges, each variable as ``_min`` and ``_max``; at least so many bins."""
    found = group(case, name)
    if not _are_ranges(found):
        raise Missing(f"recorded {name} as samples, not as ranges: its window needs an envelope")
    return _of_length(found, at_least, f"bins in {name}")


def _are_ranges(window: xr.Dataset) -> bool:
    return any(str(key).endswith("_min") for key in window)


def _of_length(window: xr.Dataset, at_least: int, what: str) -> xr.Dataset:
    if window.sizes["time"] < at_least:
        raise Missing(f"has {window.sizes['time']} {what}, at least {at_least} are needed")
    return window


# ----------------------------------------------------------------------------------------------------
# Many cases as one tree


def merge_cases(cases: Mapping[str, xr.DataTree], labels: Mapping[str, Mapping[str, str]]) -> xr.DataTree:
    """Put cases into one tree.

    The root is a table with one row per case along the coordinate `case`: parameters, status, first separation and
    statistics, each a variable with units. Below it every case has its own group, laid out as in its own file, since
    cases differ in what they recorded and in how long that is:

        table = xarray.open_dataset("cases.nc")                                  # first_separation by case
        history = xarray.open_dataset("cases.nc", group="F13/history")           # one window of one case
        tree = xarray.open_datatree("cases.nc")                                  # everything

    Parameters
    ----------
    cases : by id, each as its file holds it; failed ones have scalars only
    labels : by id, texts that become variables of the table, such as title and reference
    """
    rows = [tree.to_dataset() for tree in cases.values()]
    table = xr.concat(rows, dim="case", join="exact", combine_attrs="override", data_vars="all", coords="minimal")
    table = table.assign_coords(case=("case", list(cases), {"long_name": "name of the case"}))
    texts = {"message": [row.attrs["message"] for row in rows]}
    for name in sorted({name for label in labels.values() for name in label}):
        texts[name] = [labels.get(case, {}).get(name, "") for case in cases]
    for name, values in texts.items():
        table[name] = ("case", np.array(values, dtype=str), {"long_name": _TEXTS.get(name, name)})
    table.attrs = {"Conventions": CONVENTIONS, **_common(rows)}
    tree = xr.DataTree(table)
    for name, case in cases.items():
        tree[name] = case
    return tree


_TEXTS = {
    "message": "what ended the simulation early",
    "reference": "place in the paper",
    "title": "what the case is",
}


def _common(rows: list[xr.Dataset]) -> dict[str, str]:
    """Provenance of the cases; a value that differs between them becomes the list of all."""
    common = {}
    for name in ("source_hash", "git_commit", "versions"):
        values = sorted({str(row.attrs[name]) for row in rows if name in row.attrs})
        if values:
            common[name] = values[0] if len(values) == 1 else json_attribute(values)
    return common
