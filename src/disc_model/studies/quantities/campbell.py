"""Campbell diagrams: modes of steady sliding and of the stick-slip cycle, and crossings of their
frequencies with multiples of the stick-slip or rotation frequency, by linear interpolation between
two speeds.

A mode's frequency is that of the cycle's multiplier. Without one of its shape, as in a resonance,
it is that of steady sliding, with the difference interpolated. Multiples of the stick-slip frequency have
crossings between two neighbouring speeds with a cycle only, and none where that frequency jumps from
one kind of cycle to another. A speed at which the motion from the static start is not near the cycle
counts as one without: the cycle there is another.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from xarray import Dataset

from disc_model.analysis.frequency_jumps import frequency_jumps
from disc_model.arrays import Array, Mask
from disc_model.data.variables import message_of
from disc_model.parameters import Parameters
from disc_model.studies.quantity import (
    BETWEEN,
    Row,
    Speeds,
    attempted,
    found,
    listed,
    quantity,
    values_between,
)
from disc_model.units import CycleTolerance, Speed

LEAST_SPEEDS = 3
"""Least number of speeds in a window by which the effect of a crossing is known."""
LIKE = 0.75
"""Likeness from which a multiplier belongs to a mode. A real multiplier, in a resonance, resembles the
conjugate as much, and has 0.5 at most."""
MODES, CROSSINGS = 24, 100
"""Room for that many modes, the lowest in frequency, and crossings."""
HALF_BANDWIDTH = 1.0
"""Greatest difference of the frequencies that meet, in the window about a crossing, Hz."""
MIN_RISE = 0.01
"""Least rise of a growth rate in the window, above those at its ends, that counts, 1/s."""


@quantity(own=("Omega",), rules=BETWEEN)
def campbell(
    case: Parameters, *, bounds: Speeds, step: Speed, tol: CycleTolerance = 1e-12
) -> Dataset:
    """Frequencies and growth rates of steady sliding and of the stick-slip cycle against the speed, and their
    crossings with multiples of the stick-slip and rotation frequencies.

    The effect of a crossing is what growth rates do in a window about it, in which the frequencies differ by 1 Hz at
    most: a rise above those at its ends counts from 0.01/s on.

    Parameters
    ----------
    bounds : lowest and highest speed
    step : between speeds
    tol : tolerance of cycles: relative residual of the return map

    Examples
    --------
    >>> import disc_model as dm
    >>> found = dm.campbell(dm.Parameters(N=385, Omega=15), bounds=(14, 15), step=0.5)
    >>> found["stick_slip_frequency"].values.round(1)
    array([66.8, 67.1, 67.5])
    """
    speeds = values_between(bounds, step)
    rows: list[Row] = [{} for _ in speeds]
    messages = attempted(rows, lambda i, row: _at_speed(case.replace(Omega=speeds[i]), tol, row))
    values: Row = dict(listed(rows))
    own: Row = {"Omega": speeds, "mode": range(1, MODES + 1)}
    crossings = [*_crossings(found("campbell", values, messages, **own))]
    crossings.sort(key=lambda row: (row["Omega"], row["mode"], row["multiple"]))
    values["n_crossings"] = len(crossings)
    values |= {f"crossing_{name}": column for name, column in listed(crossings).items()}
    return found("campbell", values, messages, **own, crossing=range(1, CROSSINGS + 1))


def _at_speed(case: Parameters, tol: float, row: Row) -> Iterator[str]:
    """Add the values at a speed; yields a message."""
    from disc_model.stability.frequencies import frequencies, may_be_near

    cycle, modes, (frequency, growth_rate, mac) = frequencies(case, tol=tol)
    row |= {
        "status": cycle.status.value,
        "growth_rate": cycle.growth_rate,
        "rotation_frequency": case.Omega / (2 * math.pi),
        "n_modes": len(modes.frequency),
        "largest_sliding_growth_rate": cycle.sliding.growth_rate,
        "mode_kind": ["slider" if diameters < 0 else "disc" for diameters in modes.diameters],
        "diameters": np.maximum(modes.diameters, 0),
        "forward_wave_fraction": modes.forward,
        "sliding_frequency": modes.frequency,
        "sliding_growth_rate": modes.growth_rate,
        "cycle_frequency": frequency,
        "cycle_growth_rate": growth_rate,
        "mac": mac,
        "near_motion": may_be_near(cycle),
    }
    if cycle.releases:
        row["stick_slip_frequency"] = cycle.releases / cycle.period
    yield message_of(cycle)


# ---- Crossings


class Rates(NamedTuple):
    """Growth rates over the speed: of the modes, shape (speeds, modes), and of the cycle, (speeds,);
    nan without a cycle, and where the motion is away from it; and the steps over which the stick-slip
    frequency jumps."""

    growth: Array
    leading: Array
    away: Mask
    jumps: Mask

    def missing(self, speeds: slice) -> str:
        """The effect of a crossing where some of these speeds have no cycle near the motion."""
        return "not_near" if self.away[speeds].any() else "no_cycle"


def _crossings(along: Dataset) -> Iterator[Row]:
    """All crossings over the speed, mode by mode, with n f_s, (n + 1/2) f_s and l f_Omega, l up to that of
    modes."""
    away = along["near_motion"] == 0
    # of the cycle, which is another where the motion is not near it
    near = along.where(~away)
    speeds = along["Omega"].values
    releases = near["stick_slip_frequency"].values
    # over gaps, which the window of a crossing may have
    joined = near["stick_slip_frequency"].interpolate_na("Omega").values
    jumps = frequency_jumps(speeds, releases)
    growth = near["cycle_growth_rate"].values
    rates = Rates(growth, near["growth_rate"].values, away.values, jumps)
    turns = along["rotation_frequency"].values
    for i, mode in enumerate(along["mode"].values):
        sliding = along["sliding_frequency"].values[:, i]
        on_cycle = near["cycle_frequency"].values[:, i]
        of_mode = _frequency_of(speeds, sliding, on_cycle, along["mac"].values[:, i])
        if not np.isfinite(of_mode).any():
            continue
        most = 0
        if np.isfinite(releases).any():
            most = math.floor(2 * np.nanmax(of_mode) / np.nanmin(releases)) + 1
        lines = [
            ("stick_slip", half, releases, joined, jumps) for half in np.arange(1, most + 1) / 2
        ]
        for l in range(1, int(along["diameters"].max()) + 1):
            lines.append(("rotation", l, turns, turns, np.zeros_like(jumps)))
        for kind, multiple, frequency, whole, at_jump in lines:
            detuning = of_mode - multiple * whole
            for index, part in _changes_of_sign(of_mode - multiple * frequency, at_jump):
                # the largest step by which the window has enough speeds, by the slope at the crossing
                slope = np.diff(detuning)[index] / np.diff(speeds)[index]
                yield {
                    "Omega": _between(speeds, index, part),
                    "frequency": _between(multiple * frequency, index, part),
                    "mode": int(mode),
                    "line": kind,
                    "multiple": float(multiple),
                    "step": 2 * HALF_BANDWIDTH / abs(float(slope)) / LEAST_SPEEDS,
                    **_effect_of(detuning, index, rates),
                }


def _changes_of_sign(detuning: Array, jumps: Mask) -> Iterator[tuple[int, float]]:
    """Yield the interval of each change of sign but jumps, and the part of it before the change. A zero at
    a speed belongs to the interval that begins there, if that has another end and is no jump."""
    followed = np.append(np.isfinite(detuning[2:]) & ~jumps[1:], False)
    for index in np.flatnonzero((detuning[:-1] * detuning[1:] <= 0) & ~jumps):
        before, after = detuning[index : index + 2]
        if before == after or (after == 0 and followed[index]):
            continue
        yield int(index), float(before / (before - after))


def _between(values: Array, index: int, part: float) -> float:
    """The value at a part of the interval that begins at an index."""
    return float(values[index] + part * (values[index + 1] - values[index]))


def _frequency_of(speeds: Array, sliding: Array, on_cycle: Array, mac: Array) -> Array:
    """Frequency of a mode at all speeds, Hz, as the module's docstring describes."""
    more = on_cycle - sliding
    known = np.isfinite(more) & (mac >= LIKE)
    if not known.any():
        return sliding
    return sliding + np.interp(speeds, speeds[known], more[known])


def _effect_of(detuning: Array, index: int, rates: Rates) -> Row:
    """The effect of a crossing after the speed of an index, as far as it is known, by the growth
    rates in the window, compared with those at its ends."""
    growth, leading, _, jumps = rates
    beside = slice(index, index + 2)
    if not np.isfinite(leading[beside]).all():
        return {"effect": rates.missing(beside)}
    outside = np.flatnonzero(~(np.abs(detuning) <= HALF_BANDWIDTH))  # nan lies outside
    first = outside.max(initial=-1, where=outside <= index)
    last = outside.min(initial=len(detuning), where=outside > index)
    leaves_scan = first < 0 or last >= len(detuning)
    if last - first - 1 < LEAST_SPEEDS and not leaves_scan:
        return {"effect": "unresolved"}
    within = slice(first + 1, last)
    highest = float(np.fmax.reduce(leading[within]))
    effect = ""
    whole = slice(max(first, 0), last + 1)
    if not np.isfinite(leading[whole]).all():
        effect = rates.missing(whole)
    elif leaves_scan:
        effect = "beyond_scan"
    else:
        rises = growth[within].max(axis=0) - growth[[first, last]].max(axis=0)
        if jumps[first:last].any() or not np.isfinite(rises).any():
            effect = "unresolved"
    if effect:
        return {"effect": effect, "growth_rate": highest}
    rise = float(np.nanmax(rises))
    at_ends = max(leading[first], leading[last])
    effect = "no_rise"
    if highest > 0 >= at_ends:
        effect = "destabilises"
    elif highest - at_ends >= MIN_RISE:
        effect = "rises"
    elif rise >= MIN_RISE:
        effect = "mode_rises"
    growing = int(np.nanargmax(rises)) + 1
    return {"effect": effect, "growth_rate": highest, "rise": rise, "growing_mode": growing}
