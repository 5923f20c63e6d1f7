"""Measures for rows on Section 4.3: effects of single parameters."""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from disc_model.analysis.classify import separation_location
from disc_model.arrays import Mask
from disc_model.data.dataset import Missing
from disc_model.data.variables import Outcome, flag_names, values_text
from disc_model.parameters import Parameters
from workflow.paper import growth, measures
from workflow.paper.measures import STRETCH, Absent, Array, Cases, CaseView, Found, extent

LOADS = (50, 125, 200, 300, 385, 600)
"""Preloads of the paper and beyond, N."""
SPEEDS = (10, 15, 20, 30, 40)
"""Speeds of the paper and beyond, rad/s."""


def combinations(p: Parameters) -> list[Parameters]:
    """Return a case at all combinations of `LOADS` and `SPEEDS`."""
    return [p.replace(N=N, Omega=speed) for N in LOADS for speed in SPEEDS]


def growth_with(case: CaseView, **changes: Any) -> float:
    """Return the growth rate of a case with other parameters, 1/s."""
    return growth.growth_of(case.parameters.replace(**changes))


def slowest(cases: Cases) -> float:
    """Return the lowest speed of the cases that separate, rad/s, or inf if none does."""
    return min((case["Omega"] for case in cases if case.separates), default=math.inf)


# ---- Damping


def growth_with_damping(case: CaseView, name: str, value: float) -> Found:
    """Measure what damping does to growth rates at `LOADS` and `SPEEDS`.

    Parameters
    ----------
    case : the run whose other parameters are taken
    name : parameter of the damping
    value : its value, which is raised from zero to this and to twice this

    Returns
    -------
    dict
        Numbers of steps that count, of these ``lowered``, and of growing cycles that are ``lost``;
        places where growth of a stable cycle is ``raised``.
    """
    cases = combinations(case.parameters)
    rates = []
    for damping in (0.0, value, 2 * value):
        damped = [p.replace(**{name: damping}) for p in cases]
        rates.append(np.array([growth.growth_of(p) for p in damped]))
    before = np.stack(rates[:-1])
    after = np.stack(rates[1:])
    counted = _counted(before, after)
    raised = np.argwhere((before < 0) & (after > before))
    return {
        "most": values_text({name: 2 * value}),
        "lowered": (counted & (after < before)).sum(),
        "growing": counted.sum(),
        "raised": [measures.place(cases[i].N, cases[i].Omega) for _, i in raised],
        "lost": ((before > 0) & np.isnan(after)).sum(),
    }


def _counted(before: Array, after: Array) -> Mask:
    """Return which steps of a parameter count: from a growing cycle to another cycle.

    Parameters
    ----------
    before, after : growth rates in 1/s before each step and after it, nan without a cycle
    """
    return (before > 0) & np.isfinite(after)


# ---- Stiffness and modulus


def growth_over_steps(study: xr.Dataset, name: str, direction: int) -> Found:
    """Count steps of a parameter on a map over it and the speed.

    Parameters
    ----------
    study : the map
    name : of the parameter
    direction : 1 for steps to larger values, -1 for steps to smaller ones

    Returns
    -------
    dict
        Numbers of steps that are ``counted``, in which growth ``falls`` or ``rises``, and that end in
        a ``stable`` cycle.
    """
    ordered = measures.published(study)["growth_rate"].sortby(name, ascending=direction > 0)
    rates = ordered.transpose("Omega", name).values
    before = rates[:, :-1]
    after = rates[:, 1:]
    counted = _counted(before, after)
    if not counted.any():
        raise Missing(f"study {study.attrs.get('study', '')} has no growing cycle")
    return {
        "falls": (counted & (after < before)).sum(),
        "rises": (counted & (after > before)).sum(),
        "counted": counted.sum(),
        "stable": (counted & (after < 0)).sum(),
    }


def late_ranges(case: CaseView) -> tuple[float, float]:
    """Return medians of the range of the contact force in the third and the last quarter of a run, N.

    The range is taken in every stretch of 20 s.
    """
    end = case["time_reached"]
    count = int(end / (4 * STRETCH))
    if not count and case.separates:  # where it was to be stopped
        raise Absent(case.fate.removesuffix("."))
    if not count:
        raise Missing(f"case {case.name} ends at {end:g} s, {4 * STRETCH:g} s are needed")
    widths = case.last_widths("P", STRETCH, 2 * count)
    return float(np.median(widths[count:])), float(np.median(widths[:count]))


def returns_of_separation(study: xr.Dataset) -> list[Any]:
    """Return speeds at which a stiffer spring separates and a softer one does not, rad/s.

    They are in groups of neighbours.
    """
    speed, _, separates, *_ = plane(study, "Omega", "k")
    begins = np.diff(separates.astype(int)) > 0
    again = np.flatnonzero(begins.any(axis=1))
    gaps = np.flatnonzero(np.diff(again) > 1)
    return [extent(speed[group]) for group in np.split(again, gaps + 1) if group.size]


def stable_combinations(case: CaseView, **changes: Any) -> int:
    """Return at how many of `combinations` of a case with other parameters growth is negative.

    It is that of the stick-slip cycle, or of steady sliding where there is none.
    """
    stable = 0
    for p in combinations(case.parameters.replace(**changes)):
        rate = growth.growth_of(p)
        if math.isnan(rate):
            rate = growth.sliding_growth(p)
        stable += rate < 0
    return stable


# ---- Motions before and after separation


def starts_of_separation(case: CaseView) -> Found:
    """Measure where in its vertical motion the slider leaves the disc, in the window ``zoom``.

    Returns
    -------
    dict
        ``counts`` of separations and oscillations; heights at separations as a ``part`` of the range
        of an oscillation, and ``above`` the lowest point as a part of the range of all; the vertical
        ``speed``, m/s; the ``span`` of time, s.
    """
    window = case.samples("zoom")
    height = window["u"].values - case["u_0"]
    separated = window["phase"].values == measures.SEPARATION
    starts = np.flatnonzero(np.diff(separated.astype(int)) == 1) + 1
    separations = case.switches("separation")
    if not starts.size or not separations.sizes["event"]:
        raise Missing(f"no separation in the window of case {case.name}")
    typical = np.median(height[starts - 1])
    rises = np.diff(height) > 0
    return {
        "counts": (starts.size, int(np.sum(rises[1:] & ~rises[:-1]))),
        "span": extent(window["time"].values),
        "part": separation_location(height, starts),
        "above": float(typical - height.min()) / np.ptp(height),
        # by the events: samples come late, and the velocity of a light slider changes fast
        "speed": float(np.median(separations["u_velocity"].values)),
    }


def section_in_separation(case: CaseView) -> Found:
    """Return ranges of the disc's displacement in the section after the first separation, mm.

    They are those of the points in separation (``lost``), and of ``every`` point.
    """
    samples = case.samples("poincare")
    late = samples.isel(time=samples["time"].values > case["first_separation"])
    w = 1e3 * late["w_point"].values
    separated = late["phase"].values == measures.SEPARATION
    if not separated.any():
        raise Missing(f"case {case.name} has no point of the section in separation")
    return {"lost": extent(w[separated]), "every": extent(w)}


# ---- Maps

STABLE_IN_CONTACT = [
    Outcome.STICK_SLIP,
    Outcome.OTHER_CYCLE,
    Outcome.STEADY_SLIDING,
    Outcome.AT_REST,
]


class Plane(NamedTuple):
    """A map with the published modes."""

    first: Array
    """Values of its first parameter, ascending."""
    second: Array
    """Values of its second parameter, ascending."""
    separates: Mask
    """Whether the static start separates, shape (first, second)."""
    stable: Mask
    """Whether it comes to a stable motion in contact, of the same shape."""
    growth: Array
    """Growth rates of the cycle, 1/s, of the same shape."""


def plane(study: xr.Dataset, first: str, second: str) -> Plane:
    """Return a map over two parameters; raises `Missing` if a point failed."""
    ordered = measures.sound(measures.published(study)).sortby([first, second])
    ordered = ordered.transpose(first, second, ...)
    outcome = flag_names(ordered["outcome"])
    return Plane(
        first=ordered[first].values,
        second=ordered[second].values,
        separates=outcome == Outcome.SEPARATION,
        stable=np.isin(outcome, STABLE_IN_CONTACT),
        growth=ordered["growth_rate"].values,
    )


def newly_separating(study: xr.Dataset, c_p: float | None = None, load: float = 0) -> list[float]:
    """Return preloads at which a motion is stable without in-plane damping and separates with it, N.

    Parameters
    ----------
    study : map over preload and in-plane damping
    c_p : the damping, N s/m; any of the map if None
    load : preload in N from which on
    """
    loads, damping, separates, stable, _ = plane(study, "N", "c_p")
    chosen = separates if c_p is None else separates[:, damping == c_p]
    return loads[stable[:, 0] & chosen.any(axis=1) & (loads >= load)].tolist()


def never_separating(study: xr.Dataset, above: Sequence[float]) -> list[float]:
    """Return preloads above given ones at which no point of a map separates, N.

    Parameters
    ----------
    study : map over preload and in-plane damping
    above : preloads, N
    """
    loads, _, separates, *_ = plane(study, "N", "c_p")
    larger = loads > max(above, default=0.0)
    return loads[~separates.any(axis=1) & larger].tolist()
