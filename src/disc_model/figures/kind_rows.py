"""Rows beside bifurcation diagrams that say what kind of motion the points of each column are of."""

from typing import Any

import numpy as np
import xarray as xr

from disc_model.figures.classes import name_of
from disc_model.figures.drawing import mark, wide
from disc_model.figures.gap_rows import add_row
from disc_model.figures.sections import is_once_a_turn
from disc_model.figures.selection import failed
from disc_model.figures.settled_motions import kinds_of
from disc_model.figures.types import Array, Axes

SHAPES = {
    "quiet": "s",
    "other_cycle": "D",
    "separating": "s",
    "quasi_periodic": "P",
    "irregular": "*",
    "steady_sliding": "_",
    "at_rest": "1",
    "growing": ">",
    "undecided": "+",
}
"""Marks of kinds of motion, from the row next to the panel on."""
FILLED = ("separating", "irregular", "undecided")
"""Kinds whose marks are full, so that grey print tells the one that loses contact from those that keep it."""
SAMPLES = "v<pdhX8"
"""Marks of samples of sweeps beside others, which no kind has, nor any ring about samples in doubt."""
PERIODIC = ("quiet", "other_cycle", "separating")
WORDS = "kind of motion"
FILLS = "kind of motion; a cycle fills an interval: its period is no multiple of a turn"
"""The same of samples once a turn."""
SIZE = 3.5  # points


def has_kinds(study: xr.Dataset, x: str) -> bool:
    """Whether a study says along a dimension what kind of motion its samples are of."""
    return {"kind", "settled"} <= {*study} and study["kind"].dims == (x,)


def words_of_kinds(study: xr.Dataset) -> str:
    """What rows of kinds are called, with what samples once a turn show of a cycle if there are any."""
    cycles = np.isin(kinds_of(study), PERIODIC) & ~failed(study).values
    return FILLS if cycles.any() and is_once_a_turn(study) else WORDS


def looks_of_kinds(study: xr.Dataset, along: Array) -> list[tuple[Array, dict[str, Any]]]:
    """The places and the look of the marks of each kind of motion that a study has.

    along : places of its points
    """
    kinds = kinds_of(study)
    known = ~failed(study).values
    found = []
    for kind, shape in SHAPES.items():
        here = known & (kinds == kind)
        look: dict[str, Any] = {"marker": shape, "markersize": mark(SIZE), "label": name_of(kind)}
        look["markeredgewidth"] = wide(0.6)
        if kind not in FILLED:
            look["markerfacecolor"] = "none"
        if here.any():
            found.append((along[here], look))
    return found


def add_kinds(
    ax: Axes, study: xr.Dataset, along: Array, colour: Any, sweep: int | None = None
) -> None:
    """Mark above a panel what kind of motion each of its columns is of, a row for each kind, which the
    legend names.

    along : places of the columns
    sweep : number of the sweep, if others have such rows as well
    """
    words = words_of_kinds(study)
    for places, look in looks_of_kinds(study, along):
        add_row(ax, words, places, sweep, color=colour, **look)
