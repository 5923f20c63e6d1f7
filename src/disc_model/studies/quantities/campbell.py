"""Campbell diagrams: modes of steady sliding and of the stick-slip cycle, and crossings of their
frequencies with multiples of the stick-slip or rotation frequency, by linear interpolation between
two speeds.

A mode's frequency is that of the cycle's multiplier. Without one of its shape, as in a resonance,
it is that of steady sliding, with the difference interpolated. Multiples of the stick-slip frequency have
crossings between two neighbouring speeds with a cycle only, and none where that frequency jumps from
one kind of cycle to another. A speed at which the motion from the static start is not near the cycle
counts as one without: the cycle there is another.
"""

import math
from collections.abc import Iterator
from typing import Annotated, Any, ClassVar, NamedTuple

import numpy as np
from pydantic import Field

from disc_model.arrays import Array, Mask
from disc_model.data.frequency_jumps import frequency_jumps
from disc_model.data.variables import EXCLUDED, OF_QUANTITIES, flag_names, message_of
from disc_model.studies.quantity import Coordinate, Dataset, Point, Quantity, listed
from disc_model.units import Count, CycleTolerance, Positive, Unit

LEAST_SPEEDS = 3
"""Least number of speeds in a window by which the effect of a crossing is known."""
OF_CYCLE = ("growth_rate", "stick_slip_frequency", "cycle_frequency", "cycle_growth_rate")
"""Variables of the cycle, which is another where the motion is not near it."""


class Campbell(Quantity):
    """Frequencies and growth rates of steady sliding and of the stick-slip cycle."""

    modes: Annotated[Count, Field(ge=1, le=1000)] = 24
    """room for that many modes, the lowest in frequency"""
    half_bandwidth: Annotated[Positive, Unit("Hz")] = 1.0
    """greatest difference of the frequencies that meet, in the window about a crossing"""
    min_rise: Annotated[Positive, Unit("1/s")] = 0.01
    """least rise of a growth rate in the window, above those at its ends, that counts"""
    max_crossings: Annotated[Count, Field(ge=1, le=10_000)] = 100
    """room for that many crossings, and for more where more are found"""
    tol: CycleTolerance = 1e-12
    """tolerance of cycles: relative residual of the return map"""
    points_per_job: ClassVar = 2000
    over: ClassVar = "Omega"
    COLUMNS: ClassVar = OF_QUANTITIES["campbell"]["columns"]
    COORDINATES: ClassVar = {"mode": Coordinate(lambda o: range(1, o.modes + 1), "modes")}
    SUMMARY_COLUMNS: ClassVar = OF_QUANTITIES["campbell"]["summary"]
    SUMMARY_COORDINATES: ClassVar = {
        "crossing": Coordinate(lambda o: range(1, o.max_crossings + 1))
    }

    def compute_point(self, point: Point) -> tuple[dict[str, Any], str]:
        from disc_model.stability.frequencies import frequencies, may_be_near

        cycle, modes, (frequency, growth_rate, mac) = frequencies(point.parameters, tol=self.tol)
        kinds = self.COLUMNS["mode_kind"].flags
        values: dict[str, Any] = {
            "status": cycle.status.value, "growth_rate": cycle.growth_rate,
            "stick_slip_frequency": cycle.releases / cycle.period if cycle.releases else math.nan,
            "rotation_frequency": point.parameters.Omega / (2 * math.pi),
            "n_modes": len(modes.frequency),
            "largest_sliding_growth_rate": cycle.sliding.growth_rate,
            "mode_kind": np.where(modes.diameters < 0, kinds.index("slider"), kinds.index("disc")),
            "diameters": np.maximum(modes.diameters, 0), "forward_wave_fraction": modes.forward,
            "sliding_frequency": modes.frequency, "sliding_growth_rate": modes.growth_rate,
            "cycle_frequency": frequency, "cycle_growth_rate": growth_rate, "mac": mac,
            "near_motion": may_be_near(cycle),
        }  # fmt: skip
        return values, message_of(cycle)

    def summarise(self, cell: Dataset) -> dict[str, Any]:
        # where a rule of the grid leaves some speeds out, an axis ends
        included = flag_names(cell["status"]) != EXCLUDED
        stretches = np.split(np.arange(len(included)), np.flatnonzero(np.diff(included)) + 1)
        axes = [
            cell.isel(Omega=stretch).transpose("Omega", ...)
            for stretch in stretches
            if included[stretch[0]]
        ]
        rows = [row for axis in axes for row in crossings(axis, self)]
        rows.sort(key=lambda row: (row["Omega"], row["mode"], row["multiple"]))
        columns = listed(rows)
        summary: dict[str, Any] = {"n_crossings": len(rows)}
        for name, column in columns.items():
            summary[f"crossing_{name}"] = column
        return summary


def crossings(cell: Dataset, options: Campbell) -> Iterator[dict[str, Any]]:
    """All crossings over ``Omega``, mode by mode, with n f_s, (n + 1/2) f_s and l f_Omega, l up to
    that of modes."""
    away = cell["near_motion"] == 0
    cell = cell.assign({name: cell[name].where(~away) for name in OF_CYCLE})
    growth = cell["cycle_growth_rate"].transpose("Omega", "mode").values
    speeds = cell["Omega"].values
    turns = cell["rotation_frequency"].values
    releases = cell["stick_slip_frequency"].values
    joined = cell["stick_slip_frequency"].interpolate_na("Omega").values
    jumps = frequency_jumps(speeds, releases)
    rates = Rates(growth, cell["growth_rate"].values, away.values, jumps)
    nowhere = np.zeros_like(jumps)
    for i, mode in enumerate(cell["mode"].values):
        of_mode = frequency_of(cell.isel(mode=i))
        if not np.isfinite(of_mode).any():
            continue
        most = 0
        if np.isfinite(releases).any():
            most = math.floor(2 * np.nanmax(of_mode) / np.nanmin(releases)) + 1
        halves = np.arange(1, most + 1) / 2
        lines = [Line("stick_slip", half, half * releases, half * joined, jumps) for half in halves]
        for l in range(1, int(cell["diameters"].max()) + 1):
            lines.append(Line("rotation", l, l * turns, l * turns, nowhere))
        for line in lines:
            joined_detuning = of_mode - line.joined
            for index, part in _changes_of_sign(of_mode - line.frequency, line.jumps):
                yield {
                    "Omega": _between(speeds, index, part),
                    "frequency": _between(line.frequency, index, part),
                    "mode": int(mode),
                    "line": line.kind,
                    "multiple": float(line.multiple),
                    "step": _step_of(joined_detuning, speeds, index, options),
                    **effect_of(joined_detuning, index, rates, options),
                }


class Line(NamedTuple):
    """A multiple of a frequency over the speed, Hz: where there is one, and joined over gaps, which the
    window of a crossing may have; and the steps at which it jumps."""

    kind: str
    multiple: float
    frequency: Array
    joined: Array
    jumps: Mask


def _changes_of_sign(detuning: Array, jumps: Mask) -> Iterator[tuple[int, float]]:
    """Yield the interval of each change of sign but jumps, and the part of it before the change. A zero at
    a speed belongs to the interval that begins there, if that has another end and is no jump."""
    followed = np.append(np.isfinite(detuning[2:]) & ~jumps[1:], False)
    for index in np.flatnonzero((detuning[:-1] * detuning[1:] <= 0) & ~jumps):
        before, after = detuning[index : index + 2]
        if before == after or (after == 0 and followed[index]):
            continue
        yield int(index), float(before / (before - after))


def _step_of(detuning: Array, speeds: Array, index: int, options: Campbell) -> float:
    """The largest step by which the window has enough speeds at a crossing after the speed of an index,
    rad/s, by the slope there."""
    slope = np.diff(detuning)[index] / np.diff(speeds)[index]
    width = 2 * options.half_bandwidth / abs(float(slope))
    return width / LEAST_SPEEDS


def _between(values: Array, index: Any, part: float) -> float:
    """The value at a part of the interval that begins at an index."""
    return float(values[index] + part * (values[index + 1] - values[index]))


def frequency_of(mode: Dataset) -> Array:
    """Frequency of a mode at all speeds, Hz, as the module's docstring describes."""
    sliding = mode["sliding_frequency"].values
    more = mode["cycle_frequency"].values - sliding
    # From this mac on a multiplier belongs to the mode. A real multiplier, in a resonance,
    # resembles the conjugate as much, and has 0.5 at most.
    known = np.isfinite(more) & (mode["mac"].values >= 0.75)
    speeds = mode["Omega"].values
    if not known.any():
        return sliding
    return sliding + np.interp(speeds, speeds[known], more[known])


class Rates(NamedTuple):
    """Growth rates over the speed: of the modes, shape (speeds, modes), and of the cycle, (speeds,);
    nan without a cycle, and where the motion is away from it; and the steps over which the stick-slip
    frequency jumps."""

    growth: Array
    leading: Array
    away: Array
    jumps: Mask

    def missing(self, speeds: slice) -> str:
        """The effect of a crossing where some of these speeds have no cycle near the motion."""
        return "not_near" if self.away[speeds].any() else "no_cycle"


def effect_of(detuning: Array, index: int, rates: Rates, options: Campbell) -> dict[str, Any]:
    """The effect of a crossing after the speed of an index, as far as it is known, by the growth
    rates in the window, compared with those at its ends."""
    growth, leading, _, jumps = rates
    beside = slice(index, index + 2)
    if not np.isfinite(leading[beside]).all():
        return {"effect": rates.missing(beside)}
    outside = np.flatnonzero(~(np.abs(detuning) <= options.half_bandwidth))  # nan lies outside
    first = outside.max(initial=-1, where=outside <= index)
    last = outside.min(initial=len(detuning), where=outside > index)
    within = slice(first + 1, last)
    leaves_scan = first < 0 or last >= len(detuning)
    if last - first - 1 < LEAST_SPEEDS and not leaves_scan:
        return {"effect": "unresolved"}
    highest = math.nan
    if np.isfinite(leading[within]).any():
        highest = float(np.nanmax(leading[within]))
    whole = slice(max(first, 0), last + 1)
    if not np.isfinite(leading[whole]).all():
        return {"effect": rates.missing(whole), "growth_rate": highest}
    if leaves_scan:
        return {"effect": "beyond_scan", "growth_rate": highest}
    ends = np.array([growth[first], growth[last]])
    rises = growth[within].max(axis=0) - ends.max(axis=0)
    if jumps[first:last].any() or not np.isfinite(rises).any():
        return {"effect": "unresolved", "growth_rate": highest}
    mode = int(np.nanargmax(rises))
    rise = float(np.nanmax(rises))
    at_ends = max(leading[first], leading[last])
    effect = "no_rise"
    if highest > 0 >= at_ends:
        effect = "destabilises"
    elif highest - at_ends >= options.min_rise:
        effect = "rises"
    elif rise >= options.min_rise:
        effect = "mode_rises"
    return {"effect": effect, "growth_rate": highest, "rise": rise, "growing_mode": mode + 1}
