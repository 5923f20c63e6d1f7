"""The event that grazes along a cycle: where one is about to appear or vanish, a branch of separating cycles ends."""

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from disc_model.data.variables import PHASES
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Window
from disc_model.simulation.result import Array, Result, State

RATE = 1e5
"""Sampling rate, Hz; minima between samples are those of the parabola through three of them."""


def grazing(p: Parameters, state: State, period: float) -> str:
    """Description of the event that grazes along a cycle: missed, or occurring, by less than a thousandth of its scale.

    Parameters
    ----------
    state : a state on the cycle
    period : s
    """
    window = Window(start=0.0, stop=period, rate=RATE)
    run = simulate(p, period, initial_state=state.replace(time=0.0), record=window)
    margin, what = min(margins(p, run.raise_for_status()), default=(math.inf, ""))
    return f"{what} is missed by {margin:.1e}" if margin < 1e-3 else "what grazes was not found"


def margins(p: Parameters, run: Result) -> Iterator[tuple[float, str]]:
    """Margins by which each kind of event is missed, or occurs; relative to Omega, N and mu_s N."""
    samples, events = run.samples[0], run.events
    stick, slip, apart = (samples["phase"] == PHASES.index(name) for name in ("stick", "slip", "separation"))
    pull = p.r_0 * np.abs(p.k_p * samples["psi"] + p.c_p * p.Omega)
    # event functions, which end a phase when they fall to 0, and the samples to which they apply
    watched = (
        ("stop", "slip_to_stick", np.abs(p.Omega - samples["psi_velocity"]) / p.Omega, slip),
        ("separation", "separation", samples["P"] / p.N, ~apart),
        ("release", "stick_to_slip", samples["P"] / p.N - pull / (p.mu_s * p.N), stick),
    )
    for name, kind, values, during in watched:
        yield _nearest_dip(values, during), f"a further {name}"
        at = events["time"].to_numpy()[events["kind"].to_numpy() == kind]
        yield _shallowest(values, during, np.searchsorted(samples["time"], at)), f"the omission of a {name}"


def _nearest_dip(values: Array, during: NDArray[np.bool_]) -> float:
    """The lowest minimum of an event function that does not reach 0; inf if there is none.

    values, during : (n,), the function over its scale, and whether it applies, at the samples
    """
    before, here, after = values[:-2], values[1:-1], values[2:]
    inside = during[:-2] & during[1:-1] & during[2:] & (here <= before) & (here < after)
    return max(float(np.min(_bottoms(before, here, after)[inside], initial=math.inf)), 0.0)


def _shallowest(values: Array, during: NDArray[np.bool_], ends: NDArray[np.int64]) -> float:
    """Depth below 0 of the shallowest extrapolated dip that ends at an event; inf if there is none.

    ends : the first sample after each event
    """
    last = ends[(ends >= 3) & (ends < len(values))]
    last = last[during[last - 1] & during[last - 2] & during[last - 3]]
    before, here, after = (values[last - back] for back in (3, 2, 1))
    bends = before - 2 * here + after > 0
    return float(np.min(-_bottoms(before, here, after)[bends], initial=math.inf))


def _bottoms(before: Array, here: Array, after: Array) -> Array:
    """Lowest values of parabolas through three equidistant ones."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return here - (after - before) ** 2 / (8 * (before - 2 * here + after))
