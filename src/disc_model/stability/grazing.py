"""The event that grazes along a cycle: where one is about to appear or vanish, a branch of separating cycles ends."""

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from disc_model.data.variables import PHASES
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Record, Window
from disc_model.simulation.result import Result, State

Array = NDArray[np.float64]

RATE = 1e5
"""Sampling rate, Hz; minima between samples are those of the parabola through three of them."""
GRAZES = 1e-3
"""An event grazes if it is missed, or occurs, by less than this share of its scale."""


class Watched(NamedTuple):
    """An event function, which ends a phase when it falls to 0.

    switch : name of the event in words; kind : kind of the event
    values : (n,), at the samples, relative to its scale
    during : (n,), whether the function applies at the sample
    """

    switch: str
    kind: str
    values: Array
    during: NDArray[np.bool_]


def grazing(p: Parameters, state: State, period: float) -> str:
    """Description of the event that grazes along a cycle.

    Parameters
    ----------
    state : a state on the cycle
    period : s
    """
    window = Window(start=0.0, stop=period, rate=RATE)
    run = simulate(p, period, initial_state=state.replace(time=0.0), record=Record(windows=(window,)))
    margin, what = min(margins(p, run.raise_for_status()), default=(math.inf, ""))
    return f"{what} is missed by {margin:.1e}" if margin < GRAZES else "what grazes was not found"


def margins(p: Parameters, run: Result) -> Iterator[tuple[float, str]]:
    """Margins by which each kind of event is missed, or occurs; relative to Omega, N and mu_s N."""
    time = run.samples[0]["time"]
    events = run.events
    for one in _watched(p, run.samples[0]):
        yield _nearest_dip(one), f"a further {one.switch}"
        at = events["time"].to_numpy()[events["kind"].to_numpy() == one.kind]
        yield _shallowest(one, np.searchsorted(time, at)), f"the omission of a {one.switch}"


def _watched(p: Parameters, samples: dict[str, Array]) -> Iterator[Watched]:
    stick, slip, apart = (samples["phase"] == PHASES.index(name) for name in ("stick", "slip", "separation"))
    yield Watched("stop", "slip_to_stick", np.abs(p.Omega - samples["psi_velocity"]) / p.Omega, slip)
    yield Watched("separation", "separation", samples["P"] / p.N, ~apart)
    pull = p.r_0 * np.abs(p.k_p * samples["psi"] + p.c_p * p.Omega)
    yield Watched("release", "stick_to_slip", samples["P"] / p.N - pull / (p.mu_s * p.N), stick)


def _nearest_dip(one: Watched) -> float:
    """The lowest minimum that does not reach 0; inf if there is none."""
    before, here, after = one.values[:-2], one.values[1:-1], one.values[2:]
    inside = one.during[:-2] & one.during[1:-1] & one.during[2:] & (here <= before) & (here < after)
    return max(float(np.min(_bottoms(before, here, after)[inside], initial=math.inf)), 0.0)


def _shallowest(one: Watched, ends: NDArray[np.int64]) -> float:
    """Depth below 0 of the shallowest extrapolated dip that ends at an event; inf if there is none.

    ends : the first sample after each event
    """
    last = ends[(ends >= 3) & (ends < len(one.values))]
    last = last[one.during[last - 1] & one.during[last - 2] & one.during[last - 3]]
    before, here, after = (one.values[last - back] for back in (3, 2, 1))
    bends = before - 2 * here + after > 0
    return float(np.min(-_bottoms(before, here, after)[bends], initial=math.inf))


def _bottoms(before: Array, here: Array, after: Array) -> Array:
    """Lowest values of parabolas through three equidistant ones."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return here - (after - before) ** 2 / (8 * (before - 2 * here + after))
