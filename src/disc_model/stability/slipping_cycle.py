"""The search for a cycle that slips all the time, near steady sliding or a given state."""

import math
from collections.abc import Callable, Iterator

import numpy as np
from scipy.optimize import brentq

from disc_model.arrays import ComplexArray
from disc_model.data.variables import CycleStatus
from disc_model.parameters import Parameters
from disc_model.simulation.states import State
from disc_model.stability.cycle import SLIPPING, FloquetResult, cycle_of, no_cycle
from disc_model.stability.return_map import Orbit, newton
from disc_model.stability.sliding import SteadySliding, steady_sliding
from disc_model.stability.slipping_map import SlippingMap

SMALLEST = 1e-3  # distance from steady sliding at which the search begins, over the deflection
FACTOR = 1.25  # of one distance over that before
MOST_DISTANCES = 60  # up to 500 times the deflection, beyond which the slider has long stopped
HALVINGS = 12  # of the distances up to which the slider does not stop
NEUTRAL = 1e-9  # growth in a return that may be rounding: without damping all motions return
PRECISION = 1e-6  # of the distance from which Newton's method begins, relative to it


def find_slipping_cycle(p: Parameters, tol: float, guess: State | None) -> FloquetResult:
    """The cycle that slips all the time which Newton's method finds near a state in slip, or the
    smallest one round steady sliding."""
    sliding = steady_sliding(p)
    missing = not sliding.status.exists
    if missing or min(p.N, p.k_p) <= 0:
        reason = "there is no steady sliding on a spring"
        return no_cycle(p, tol, CycleStatus.NO_CYCLE, reason, SLIPPING)

    map_ = SlippingMap(p, tol)
    orbit = None
    where = "round steady sliding"
    if guess is None:
        orbit = find_slipping_orbit(map_, sliding)
    else:
        where = "near the given state"
        x = map_.next_passage(guess)
        if x is not None:
            orbit = newton(map_, x)
    if orbit is None:
        without = f"no cycle {where} slips all the time"
        return no_cycle(p, tol, CycleStatus.NO_CYCLE, without, SLIPPING)
    return cycle_of(map_, orbit, SLIPPING)


def find_slipping_orbit(map_: SlippingMap, sliding: SteadySliding) -> Orbit | None:
    """The orbit of the smallest cycle that slips all the time, found along an oscillation of steady
    sliding, the least damped ones first; None if there is none.

    Motions at growing distances from steady sliding approach it or depart from it; a cycle is
    between two of which one grows and one decays.
    """
    for shape in _oscillations(sliding):
        orbit = _orbit_along(map_, sliding, shape)
        if orbit is not None:
            return orbit
    return None


def _orbit_along(map_: SlippingMap, sliding: SteadySliding, shape: ComplexArray) -> Orbit | None:
    """The orbit of the smallest cycle near an oscillation of steady sliding of a given shape."""
    equilibrium = map_.sliding_point(sliding)

    def growth(distance: float) -> float:
        """Logarithm of the distance from the equilibrium after a return over that before, along the
        latter; nan if the motion does not return."""
        x = map_.beside_sliding(sliding, shape, distance)
        if x is None:
            return math.nan
        orbit = map_.evaluate(x, tangent=False)
        away = x - equilibrium
        share = float((orbit.end - equilibrium) @ away) / float(away @ away)
        return math.log(share) if orbit.returned and share > 0 else math.nan

    bracket = _bracket(growth, SMALLEST * map_.deflection)
    if bracket is None:
        return None
    distance = float(brentq(growth, *bracket, rtol=PRECISION))
    x = map_.beside_sliding(sliding, shape, distance)
    return None if x is None else newton(map_, x)


def _oscillations(sliding: SteadySliding) -> Iterator[ComplexArray]:
    """Complex shapes of the oscillations of steady sliding, the least damped ones first."""
    values, vectors = np.linalg.eig(sliding.jacobian)
    oscillating = np.flatnonzero(values.imag > 0)
    for i in oscillating[np.argsort(-values[oscillating].real, kind="stable")]:
        yield vectors[:, i].astype(complex)


def _bracket(growth: Callable[[float], float], first: float) -> tuple[float, float] | None:
    """Two neighbouring distances of which one grows and one decays; None if there are none up to
    that at which the slider stops."""
    low = first
    before = growth(low)
    if math.isnan(before):
        return None
    for _ in range(MOST_DISTANCES):
        high = FACTOR * low
        after = growth(high)
        if math.isnan(after):
            return _bracket_below(growth, low, high)
        if _changes_sign(before, after):
            return low, high
        low = high
        before = after
    return None


def _changes_sign(before: float, after: float) -> bool:
    """Whether one of two growths is positive and one negative, by more than rounding."""
    return before * after <= 0 and max(abs(before), abs(after)) > NEUTRAL


def _bracket_below(
    growth: Callable[[float], float], low: float, stopped: float
) -> tuple[float, float] | None:
    """Two distances as in `_bracket`, between one at which the slider slips on and one at which it
    stops."""
    first = low
    before = growth(first)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + stopped)
        after = growth(middle)
        if math.isnan(after):
            stopped = middle
            continue
        if _changes_sign(before, after):
            return first, middle
        low = middle
    return None
