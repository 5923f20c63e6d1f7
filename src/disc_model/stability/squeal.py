"""Squeal: modes of steady sliding that grow along a parameter, from where on, and what makes them grow.

What makes a mode grow is found by control: it is followed to the same equilibrium without the slope of
friction over the speed, to a case without friction's work on tangential motion, and to one without both.
"""

from __future__ import annotations

import math
from typing import Annotated, Any, NamedTuple

import numpy as np
from pandas import DataFrame
from pydantic import Field
from scipy.optimize import brentq

from disc_model.arrays import Array
from disc_model.parameters import SURFACE, Parameters
from disc_model.simulation.states import engine_case
from disc_model.stability.continuation import Bounds, require_interval
from disc_model.stability.sliding import LAWS, FollowedModes, follow_modes
from disc_model.units import Count, checked

SHARES = np.linspace(1, 0, 5).tolist()  # of a cause, along which a mode is followed until it is off
ROUNDING = 1e-12  # to which onsets are located, relatively
MOST_POINTS = 10_000  # largest number of values: minutes of work
OF_MODE = ("frequency", "growth_rate", "diameters", "circles", "disc")
COLUMNS = (
    *("mode", "frequency", "growth_rate", "at", "onset", "until", "end_growth_rate", "cause"),
    *("diameters", "circles", "disc"),
)


@checked
def squeal(
    case: Parameters,
    bounds: Bounds,
    *,
    name: str = "Omega",
    points: Annotated[Count, Field(ge=2, le=MOST_POINTS)] = 41,
) -> DataFrame:
    """Which modes of steady sliding grow within a range of speeds or of another number, at how many Hz, from where on,
    and why.

    Each mode is followed by its shape. Growth in a range narrower than the step between values may be missed, and
    growth without oscillation, which is no squeal, is left out: `SteadySliding.growing` has it.

    Parameters
    ----------
    case : the case; its value of the number is not used
    bounds : lowest and highest value of the number; SI units, or texts with units
    name : the number that varies, one of `Parameters.numbers`, such as "N"
    points : number of evenly spaced values, from 2 on

    Returns
    -------
    pandas.DataFrame
        One row for each mode and range of values in which it grows, the fastest first; none if nothing grows.

        - mode: its number by frequency at the lowest value, from 1, as `sliding_modes` has it
        - frequency (Hz), growth_rate (1/s): at the value `at` of those computed at which it grows fastest in this range
        - onset, until: values (in the number's SI unit) at which growth begins and ends; the bound, if it grows there
        - end_growth_rate (1/s): at the upper bound; nan if there is no such mode
        - cause: "falling friction" if the mode decays where friction does not fall with the speed; "tangential work"
          if it decays where friction does no work on the surface's tangential motion; "moving load" if it grows without
          both; else "more than one". Where it grows without both, but less than half as fast, it counts as decaying
          below half of its growth rate
        - diameters, circles: of the disc's modes with most energy in it; -1 if the slider's in-plane motion has most
        - disc: the disc's share of the energy

    Raises
    ------
    ParameterError
        If an argument breaks a rule, or the case does at a value within the bounds.

    Examples
    --------
    >>> import disc_model as dm
    >>> case = dm.Parameters(N=100, Omega=20, normalization="orthonormal", mu_s=0.45, mu_k=0.3, friction_decay=5,
    ...     c_p=0.2)
    >>> table = dm.squeal(case, (10, 60), points=11)
    >>> table[["frequency", "onset", "cause"]].round(1).values.tolist()[0]
    [71.2, 10.0, 'falling friction']
    """
    require_interval(case, name, bounds)
    values = np.linspace(*bounds, points).tolist()
    followed = follow_modes([case.replace(**{name: value}) for value in values])
    growth = np.full((1 + max(max(one.numbers, default=0) for one in followed), points), math.nan)
    for i, one in enumerate(followed):
        growth[one.numbers, i] = one.modes.growth_rate
    scan = _Scan(case, name, values, followed, growth)

    rows = []
    for number, rates in enumerate(growth):
        edges = np.flatnonzero(np.diff(np.concatenate([[0], rates > 0, [0]])))
        rows += [_row(scan, number, first, after) for first, after in edges.reshape(-1, 2)]
    table = DataFrame(rows, columns=[*COLUMNS])
    return table.sort_values("growth_rate", ascending=False, ignore_index=True)


class _Scan(NamedTuple):
    """Modes of steady sliding followed along values of a number of a case; growth rates (modes, values)."""

    case: Parameters
    name: str
    values: list[float]
    followed: list[FollowedModes]
    growth: Array

    def at(self, value: float) -> Parameters:
        """The case at a value."""
        return self.case.replace(**{self.name: value})

    def place(self, number: int, i: int) -> int:
        """The place of a mode by frequency at one of the values."""
        return int(np.argmax(self.followed[i].numbers == number))


def _row(scan: _Scan, number: int, first: int, after: int) -> dict[str, Any]:
    """The row of a mode that grows at successive values, given by their places."""
    rates = scan.growth[number]
    fastest = first + int(np.argmax(rates[first:after]))
    place = scan.place(number, fastest)
    one = scan.followed[fastest]
    at = scan.values[fastest]
    return {column: getattr(one.modes, column)[place] for column in OF_MODE} | {
        "mode": number + 1,
        "at": at,
        "onset": _change(scan, number, first, first - 1),
        "until": _change(scan, number, after - 1, after),
        "end_growth_rate": rates[-1],
        "cause": _cause(scan.at(at), one, place),
    }


def _change(scan: _Scan, number: int, inside: int, outside: int) -> float:
    """The value between two neighbouring ones at which a mode begins or ceases to grow; the one at
    which it grows if the other is no value, or has no such mode."""
    start = scan.values[inside]
    if not 0 <= outside < len(scan.values) or math.isnan(scan.growth[number, outside]):
        return start
    place = scan.place(number, inside)

    def growth(value: float) -> float:
        rate = _growth_of(place, [scan.at(start), scan.at(value)])
        if rate > 0:
            return rate
        return min(rate, -ROUNDING)

    end = scan.values[outside]
    return float(brentq(growth, start, end, xtol=ROUNDING * abs(start), rtol=ROUNDING))


def _growth_of(place: int, cases: list[Parameters]) -> float:
    """The growth rate, 1/s, in the last case of a mode followed from its place by frequency in the
    first one; 0 if it is gone."""
    one = follow_modes(cases)[-1]
    return float(one.modes.growth_rate[one.numbers == place].sum())


def _cause(case: Parameters, one: FollowedModes, place: int) -> str:
    """What makes a mode grow, given by its place by frequency: see `squeal`."""

    def growth(slope: float, tangential: float) -> float:
        way = [(max(slope, share), max(tangential, share)) for share in SHARES]
        return _growth_of(place, [_without(case, one.sliding.rate, *shares) for shares in way])

    loaded = growth(0, 0)
    enough = 0.0
    if loaded > 0:
        enough = one.modes.growth_rate[place] / 2
    if loaded > enough:
        return "moving load"
    falling = growth(1, 0) > enough
    tangential = growth(0, 1) > enough
    if falling == tangential:
        return "more than one"
    if falling:
        return "falling friction"
    return "tangential work"


def _without(case: Parameters, rate: float, slope: float, tangential: float) -> Parameters:
    """The case with shares of the slope of friction over the speed, and of the lever or the amplitudes by which it
    works on tangential motion. Friction at the rate (rad/s) of sliding is the same for all shares of the slope."""
    mu = float(LAWS.friction_coefficient(engine_case(case).model, 1.0, rate))
    changes: dict[str, Any] = {
        "mu_s": mu + slope * (case.mu_s - mu),
        "mu_k": mu + slope * (case.mu_k - mu),
        "viscous_friction": slope * case.viscous_friction,
    }
    if case.disc is not None and case.friction_offset == SURFACE:
        amplitudes = [tangential * amplitude for amplitude in case.disc.tangential]
        return case.replace(disc=case.disc.replace(tangential=amplitudes), **changes)
    height = case.h / 2 if case.friction_offset == SURFACE else float(case.friction_offset)
    return case.replace(friction_offset=tangential * height, **changes)
