"""How many crossings of its study a Campbell diagram does not show, or does not know the effect of."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.display import counted
from disc_model.figures.campbell_multiples import marked_at_multiples
from disc_model.figures.campbell_peaks import Column, marked_at_peaks
from disc_model.figures.drawing import sample
from disc_model.figures.types import Array, Artist, Mask
from disc_model.figures.words import named

MANY_TIMES = 10  # from which ratio of the steps that crossings need two are named
UNKNOWN = ("unresolved", "beyond_scan")
"""Effects of crossings at which it is not known what growth rates do."""


class Crossings(NamedTuple):
    """The crossings of a column: those in its table, those above the highest frequency shown, those
    with a mark, and the effect of each."""

    study: xr.Dataset
    there: Mask
    above: Mask
    marked: Mask
    effects: Array

    def of_effect(self, effect: str) -> Mask:
        """Crossings of an effect, up to the highest frequency shown."""
        return self.there & ~self.above & (self.effects == effect)

    @property
    def unmarked(self) -> Mask:
        """Crossings of known effect without a mark, up to the highest frequency shown."""
        return self.there & ~self.above & ~self.marked & ~np.isin(self.effects, UNKNOWN)


def entries_of_counts(
    columns: Sequence[Column], multiples: Sequence[float], highest: float
) -> list[Artist]:
    """The entry of a legend that counts crossings: so many above the highest frequency shown (Hz), so
    many without a mark, and those at which it is not known what growth rates do, with the remedy:
    smaller steps, or a wider scan. Each crossing has a mark, or is counted once."""
    found = [_crossings_of(column, multiples, highest) for column in columns]
    every = sum(int(each.there.sum()) for each in found)
    above = sum(int(each.above.sum()) for each in found)
    unmarked = sum(int(each.unmarked.sum()) for each in found)
    said = []
    if above:
        said.append(f"{_share_of(above, every)} above {highest:g} Hz")
    if unmarked:
        said.append(f"{_share_of(unmarked, every)} not marked")
    for effect in UNKNOWN:
        said += _said_of_unknown(found, effect, every)
    if not said:
        return []
    lines = ",\n".join(said)
    return [sample(label=f"{counted(every, 'crossing')}: {lines}", linestyle="")]


def _crossings_of(column: Column, multiples: Sequence[float], highest: float) -> Crossings:
    """The crossings of a column, up to and above the highest frequency shown (Hz)."""
    study = column.study
    there = np.isfinite(study["crossing_Omega"].values)
    above = there & (study["crossing_frequency"].values > highest)
    marked = marked_at_peaks(column) | marked_at_multiples(study, multiples)
    effects = np.full(there.shape, "")
    if "crossing_effect" in study:
        effects = flag_names(study["crossing_effect"])
    return Crossings(study, there, above, marked, effects)


def _said_of_unknown(found: Sequence[Crossings], effect: str, every: int) -> list[str]:
    """What the legend says of crossings of an unknown effect, and how many of them have a mark; nothing
    without any."""
    count = sum(int(each.of_effect(effect).sum()) for each in found)
    if not count:
        return []
    marked = sum(int((each.of_effect(effect) & each.marked).sum()) for each in found)
    need = f"{_needs(count)} a wider scan"
    if effect == "unresolved":
        need = _steps_needed(found, count)
    return [f"{_share_of(count, every)} {need}{_marked_text(marked, count)}"]


def _marked_text(marked: int, count: int) -> str:
    """How many of so many crossings have a mark, in brackets; "" for none."""
    if not marked:
        return ""
    return " (marked)" if marked == count else f" ({marked} marked)"


def _share_of(count: int, every: int) -> str:
    """How many of all crossings, as a word where these are all of several."""
    return "all" if count == every > 1 else str(count)


def _needs(count: int) -> str:
    """The verb of so many crossings."""
    return "needs" if count == 1 else "need"


def _steps_needed(found: Sequence[Crossings], count: int) -> str:
    """What the legend says of unresolved crossings: the steps that resolve them, rounded down, for all
    and for the first one where these differ much; nothing of steps that are as small already."""
    steps = [step for each in found for step in _steps_of(each)]
    if not steps:
        return "unresolved"
    least = f"{rounded_down(min(steps)):g}"
    unit = named(found[0].study["Omega"]).unit
    if max(steps) < MANY_TIMES * min(steps):
        return f"{_needs(count)} steps of {least} {unit}"
    return f"{_needs(count)} steps of\n{least} to {rounded_down(max(steps)):g} {unit}"


def _steps_of(crossings: Crossings) -> Array:
    """Steps by which unresolved crossings are resolved, as far as they are smaller than those of the study."""
    study = crossings.study
    if "crossing_step" not in study:
        return np.zeros(0)
    steps = study["crossing_step"].values[crossings.of_effect("unresolved")]
    widest = np.diff(study["Omega"].values).max()
    return steps[steps < widest]


def rounded_down(value: float) -> float:
    """A positive number with one significant digit, not above the value."""
    unit = 10.0 ** math.floor(math.log10(value))
    return math.floor(value / unit) * unit
