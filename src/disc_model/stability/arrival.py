"""What a motion has come to, and sweeps through a parameter; without a change of maps, which need no exponents."""

import math
import sys
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from disc_model.analysis.classify import CLOSES, FEWEST, Settled, Settling, closure, settling, shortest_period
from disc_model.data.variables import Outcome
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.result import Result
from disc_model.simulation.states import State
from disc_model.stability import thresholds
from disc_model.stability.cycle import may_stick_and_slip
from disc_model.stability.linear_motion import NearCycle, find_cycle_near, find_near_return
from disc_model.stability.lyapunov import CLEAR, CONVERGED, lyapunov_exponents
from disc_model.stability.outcome import Segment, final_segment, find_calm, switch_angles
from disc_model.stability.return_map import RETURNED, ReturnMap


class Arrival(NamedTuple):
    """Whether a motion has settled, with the rest or sliding, or the stable cycle by its multipliers, as proof."""

    settling: Settling
    calm: Outcome | None = None
    near: NearCycle | None = None

    @property
    def settled(self) -> bool:
        return self.settling.answer is Settled.SETTLED


def arrival(p: Parameters, legs: Sequence[Result], tol: float, most: int = sys.maxsize) -> Arrival:
    """What a motion has come to at the end of its legs: what rest, eigenvalues of steady sliding or multipliers of a
    cycle of up to `most` releases prove; otherwise what the record of angles at releases and separations shows."""
    leg = legs[-1]
    if (calm := find_calm(p, leg, tol)) is not None:
        return Arrival(Settling(Settled.SETTLED, least=0.0, since=leg.final_state.time), calm)
    near = cycle_reached(p, leg, most)
    if near is not None and near.follows_cycle:  # of stable cycles only
        return Arrival(Settling(Settled.SETTLED, near.cycle.growth_rate, 0.0, leg.final_state.time), near=near)
    if near is not None and near.lingers:
        return Arrival(Settling(Settled.CHANGING, near.cycle.growth_rate, 0.0))
    return Arrival(settling(*np.hstack([switch_angles(leg) for leg in legs])))


def cycle_reached(p: Parameters, leg: Result, most: int) -> NearCycle | None:
    """The cycle near the end of a simulated motion, recorded with its events; the cycle may lose contact. Periods of up
    to half the releases of the last `FIRST_LEG` are tried, and of up to `most` releases."""
    last = leg.events[leg.events["time"] > leg.final_state.time - thresholds.FIRST_LEG]
    releases = int((last["kind"] == "stick_to_slip").sum())
    if not releases or not may_stick_and_slip(p) or p.n_diameters < 0:
        return None
    map_ = ReturnMap(p, patient=True)
    code, x = map_.next_release(leg.final_state)
    if code != RETURNED:
        return None
    return find_cycle_near(map_, x, find_near_return(map_, x, max(1, min(most, releases // 2))))


def sweep(
    p: Parameters,
    name: str,
    values: Sequence[float],
    dwell: float,
    longest: float,
    late: float,
    tol: float,
    lowest: int = 0,
) -> Iterator[tuple[tuple[int, int], Result, Segment | None, Arrival]]:
    """Follow the motion through values of a parameter, up from that of index ``lowest`` and down again to the first.

    It stays ``dwell`` s at each value, then twice as long until it has settled, ``longest`` s at most; from a stable
    cycle it continues exactly. Yields direction (0 up, 1 down) and index of the value, the last run there, its last
    segment of ``late`` s, or None if a run ends early, and the arrival.
    """
    state: State | None = None
    for step in [(0, i) for i in range(lowest, len(values))] + [(1, i) for i in reversed(range(len(values)))]:
        case = p.replace(**{name: values[step[1]]})
        begin, stay, legs = 0.0 if state is None else state.time, dwell, list[Result]()
        while True:
            result = simulate(case, begin + stay, tol=tol, initial_state=state)
            legs.append(result)
            if not result.status.complete:
                yield step, result, None, Arrival(Settling())
                return
            state, reached = result.final_state, arrival(case, legs, tol)
            if reached.settled or 2 * stay > longest:
                break
            stay *= 2
        if reached.near is not None:
            state = reached.near.cycle.state
        result, segment = final_segment(case, state, late, late, tol)
        yield step, result, segment, reached
        state = result.final_state


class Regularity(NamedTuple):
    """Kind of a motion; number of events after which it repeats, 0 if that is not shown; closure, s."""

    kind: Outcome
    period: int = 0
    closure: float = math.nan


def regularity(p: Parameters, state: State, tol: float) -> Regularity:
    """Regularity of the motion from a state, by its separations, or else its releases, and by its largest exponent but
    that along the motion: zero on a torus, positive in chaos, negative on a cycle, however long its period."""
    run = simulate(p, state.time + thresholds.SETTLING * thresholds.FIRST_LEG, tol=tol, initial_state=state)
    times, kinds = run.events["time"].to_numpy(dtype=float), run.events["kind"].to_numpy()
    separates = bool((kinds == "separation").any())
    intervals = np.diff(times[kinds == ("separation" if separates else "stick_to_slip")])
    if not run.status.complete or len(intervals) < FEWEST:
        return Regularity(Outcome.UNDECIDED)
    periodic = Outcome.SEPARATING if separates else Outcome.OTHER_CYCLE
    if n := shortest_period(intervals, CLOSES):
        return Regularity(periodic, n, closure(intervals, n))
    # exponents below -90/s are not resolved by this interval; such a motion repeats
    how: Any = {"count": 1, "interval": 0.25, "leave_out_trivial": True, "initial_state": state, "tol": tol}
    largest = lyapunov_exponents(p, thresholds.SETTLING * thresholds.FIRST_LEG / 2, **how)
    rate, error = float(largest.exponents[0]), float(largest.errors[0])
    if not (math.isfinite(rate) and math.isfinite(error)):
        return Regularity(Outcome.UNDECIDED)
    if abs(rate) <= max(CLEAR * error, CONVERGED[1]):
        return Regularity(Outcome.QUASI_PERIODIC)
    return Regularity(Outcome.IRREGULAR if rate > 0 else periodic)
