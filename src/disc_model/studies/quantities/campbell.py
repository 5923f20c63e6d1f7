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
from functools import partial

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

LIKE = 0.75
"""Likeness from which a multiplier belongs to a mode. A real multiplier, in a resonance, resembles the
conjugate as much, and has 0.5 at most."""
MODES, CROSSINGS = 24, 100
"""Room for that many modes, the lowest in frequency, and crossings."""


@quantity(own=("Omega",), rules=BETWEEN)
def campbell(
    case: Parameters, *, bounds: Speeds, step: Speed, tol: CycleTolerance = 1e-12
) -> Dataset:
    """Frequencies and growth rates of steady sliding and of the stick-slip cycle against the speed, and their
    crossings with multiples of the stick-slip and rotation frequencies.

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
    rows: list[Row] = [{"speed": speed} for speed in speeds]
    values: Row = attempted(rows, partial(_at_speed, case, tol))
    own: Row = {"Omega": speeds, "mode": range(1, MODES + 1)}
    crossings = [*_crossings(found("campbell", values, **own))]
    crossings.sort(key=lambda row: (row["Omega"], row["mode"], row["multiple"]))
    values["n_crossings"] = len(crossings)
    values |= {f"crossing_{name}": column for name, column in listed(crossings).items()}
    return found("campbell", values, **own, crossing=range(1, CROSSINGS + 1))


def _at_speed(case: Parameters, tol: float, row: Row) -> Iterator[str]:
    """Add the values at the speed of a row; yields a message."""
    from disc_model.stability.frequencies import frequencies, may_be_near

    at_speed = case.replace(Omega=row["speed"])
    cycle, modes, (frequency, growth_rate, mac) = frequencies(at_speed, tol=tol)
    row |= {
        "status": cycle.status.value,
        "growth_rate": cycle.growth_rate,
        "rotation_frequency": row["speed"] / (2 * math.pi),
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


def _crossings(along: Dataset) -> Iterator[Row]:
    """All crossings over the speed, mode by mode, with n f_s, (n + 1/2) f_s and l f_Omega, l up to that of
    modes."""
    # of the cycle, which is another where the motion is not near it
    near = along.where(along["near_motion"] != 0)
    speeds = along["Omega"].values
    releases = near["stick_slip_frequency"].values
    jumps = frequency_jumps(speeds, releases)
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
        lines = [("stick_slip", half, releases, jumps) for half in np.arange(1, most + 1) / 2]
        for l in range(1, int(along["diameters"].max()) + 1):
            lines.append(("rotation", l, turns, np.zeros_like(jumps)))
        for kind, multiple, frequency, at_jump in lines:
            for index, part in _changes_of_sign(of_mode - multiple * frequency, at_jump):
                yield {
                    "Omega": _between(speeds, index, part),
                    "frequency": _between(multiple * frequency, index, part),
                    "mode": int(mode),
                    "line": kind,
                    "multiple": float(multiple),
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
