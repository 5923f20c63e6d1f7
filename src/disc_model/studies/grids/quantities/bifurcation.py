"""Samples of the settled motion, once a turn of the drive or at events."""

import math
from typing import Any

import numpy as np
import pandas as pd
from scipy.stats import wasserstein_distance

from disc_model.analysis.classify import closure, shortest_period
from disc_model.data.variables import LONG_TERM_OUTCOMES, PHASES, SCALARS, SERIES, Outcome, Variable
from disc_model.errors import raise_faults, violations
from disc_model.parameters import Parameters
from disc_model.simulation.api import make_initial_state, simulate, state_after
from disc_model.simulation.case import Poincare, Record
from disc_model.simulation.result import Result, State
from disc_model.stability.attractor.classification import SAME, SMALLEST, Regularity, cycle_reached, regularity
from disc_model.stability.attractor.outcome import FIRST_LEG, at_rest
from disc_model.stability.return_map import case_faults
from disc_model.studies.document import BifurcationOptions
from disc_model.studies.grids.points import STATUS, Coordinate, Point

REPEATS = 1e-11
"""Greatest difference of intervals of a periodic motion, s: rounding leaves 1e-13 s on a cycle."""
SAMPLED = ("psi", "psi_velocity", "P", "u", "w_point")
STEADY = ("unknown", "no", "yes")
COLUMNS = {
    "status": STATUS,
    **{name: SERIES[name]._replace(dims=("sample",)) for name in SAMPLED},
    "phase": Variable("1", "phase of the motion at the sample", ("none", *PHASES), dims=("sample",)),
    "first_separation": SCALARS["first_separation"],
    "separations": Variable("1", "number of separations, transient included", whole=True),
    "transient_time": Variable("s", "time left out before the samples"),
    "stationary": Variable("1", "whether two stretches of samples, at switches, were alike", STEADY),
    "kind": Variable("1", "what the motion has come to, at switches", LONG_TERM_OUTCOMES),
    "period_events": Variable(
        "1", "number of events after which the motion repeats, 0 if that is not shown", whole=True
    ),
    "period_residual": Variable(
        "s", "largest difference between an interval and the one a period later: what is left of the approach"
    ),
    "stick_fraction": Variable("1", "share of the time spent sticking, transient included"),
}
COORDINATES = {"sample": Coordinate("1", "number of the turn after the transient", lambda o: range(o.samples))}


def compute_point(point: Point, options: BifurcationOptions) -> tuple[dict[str, Any], str]:
    """Sample the motion from the static start or from the point's own start."""
    return _once_a_turn(point, options) if options.section == "stroboscopic" else _at_switches(point, options)


def _once_a_turn(point: Point, options: BifurcationOptions) -> tuple[dict[str, Any], str]:
    """Sample at t = i 2 pi / Omega after the transient; samples that the run does not reach are missing."""
    p = point.parameters
    raise_faults(violations((p.Omega > 0, "Omega", p.Omega, "must be > 0, because samples are taken once a turn")))
    turn = 2 * math.pi / p.Omega
    first = math.ceil(options.transient / turn)
    # both ends lie between samples, so that rounding neither adds one nor leaves one out
    end = (first + options.samples - 0.5) * turn
    record = Record(poincare=Poincare(start=max(first - 0.25, 0.0) * turn, stop=end, theta=options.theta))
    start = make_initial_state(p, point.start, options.tol)
    run = simulate(p, end, tol=options.tol, initial_state=start, record=record)
    reached, taken = run.final_state.time, run.poincare
    assert taken is not None
    values = {name: taken[name] for name in SAMPLED} | {
        "phase": taken["phase"] + 1,  # after "none"
        "status": run.status.value,
        "first_separation": run.first_separation,
        "separations": int(run.statistics["separations"]),
        "stick_fraction": run.statistics["time_stick"] / reached if reached else math.nan,
        "transient_time": options.transient,
    }
    return values, "" if run.status.complete else f"the simulation ended early: {run.status}"


def _at_switches(point: Point, options: BifurcationOptions) -> tuple[dict[str, Any], str]:
    """Sample at separations if there are any, else at releases; double the transient until the motion repeats."""
    p = point.parameters
    state, begin, transient = make_initial_state(p, point.start, options.tol), 0.0, options.transient
    first, separations, stick = math.nan, 0, 0.0
    while True:
        stretches: list[Result] = []
        for recorded in (False, True, True):
            stop = begin + FIRST_LEG if recorded else transient
            if stop <= begin:
                continue
            run = simulate(p, stop, tol=options.tol, initial_state=state, record=Record(events=recorded))
            first = run.first_separation if math.isnan(first) else first
            separations += int(run.statistics["separations"])
            stick += run.statistics["time_stick"]
            state, begin = run.final_state, run.final_state.time
            if not run.status.complete:
                known = {"status": run.status.value, "first_separation": first, "separations": separations}
                return known, f"the simulation ended early: {run.status}"
            if recorded:
                stretches.append(run)
        events = pd.concat([run.events for run in stretches])
        kind = "separation" if (events["kind"] == "separation").any() else "stick_to_slip"
        before, taken = (run.events[run.events["kind"] == kind] for run in stretches)
        found = _periodic(p, stretches[-1], kind)
        steady = found.period > 0 or alike(before["psi"].to_numpy(), taken["psi"].to_numpy())
        over = found.period > 0 or (steady and len(taken) < 2)
        if over or 2 * transient > options.max_transient:
            break
        transient *= 2
    if found.kind is Outcome.UNDECIDED and steady:
        calm = at_rest(p, stretches[-1], options.tol)
        found = regularity(p, run.final_state, options.tol) if calm is None else Regularity(calm)
    if found.state is not None:
        # the attractor is known exactly
        events = simulate(p, found.state.time + FIRST_LEG, tol=options.tol, initial_state=found.state).events
        taken = events[events["kind"] == kind]
    shown = taken.iloc[-options.samples :]
    columns = {"psi": shown["psi"], "psi_velocity": p.Omega - shown["f"], "P": shown["P"], "u": shown["u"]}
    values: dict[str, Any] = {name: column.to_numpy(dtype=float) for name, column in columns.items()}
    values |= {
        "kind": found.kind,
        "period_events": found.period,
        "period_residual": found.closure,
        "status": "ok",
        "phase": ["separation" if kind == "separation" else "stick"] * len(shown),
        "first_separation": first,
        "separations": separations,
        "stick_fraction": stick / begin,
        "transient_time": transient,
        "stationary": "yes" if steady else "no",
    }
    return values, "" if steady else f"not steady after {transient:g} s"


def _periodic(p: Parameters, stretch: Result, kind: str) -> Regularity:
    """Regularity of one kind of event in a stretch: a stable cycle that the motion follows, or repeating intervals."""
    at = (stretch.events["kind"] == kind).to_numpy()
    intervals = np.diff(stretch.events["time"].to_numpy(dtype=float)[at])
    near = None if case_faults(p, "a cycle") else cycle_reached(p, stretch)
    if near is not None and near.follows_cycle:
        n = near.cycle.separations if kind == "separation" else near.cycle.releases
        if 0 < n < len(intervals):
            return Regularity(near.kind, n, closure(intervals, n), near.cycle.state)
    if n := repeats(intervals):
        separates = kind == "separation"
        return Regularity(Outcome.SEPARATING if separates else Outcome.OTHER_CYCLE, n, closure(intervals, n))
    return Regularity(Outcome.UNDECIDED)


def repeats(intervals: np.ndarray) -> int:
    """Smallest number of intervals after which they repeat to rounding; 0 if they do not within half the stretch."""
    n = shortest_period(intervals, REPEATS) if intervals.size > 1 else 0
    # small differences may add up to a slow drift
    drifts = any(np.ptp(intervals[i::n]) > REPEATS for i in range(n))
    return 0 if drifts else n


def alike(one: np.ndarray, two: np.ndarray) -> bool:
    """Whether two stretches show the same motion: similar numbers of points with similar distributions."""
    if min(len(one), len(two)) < 2:
        return len(one) == len(two)
    spread = max(np.ptp(one), np.ptp(two), SMALLEST * abs(float(np.mean(two))))
    counts = abs(len(one) - len(two)) <= max(1, SAME * len(two))
    return bool(counts and wasserstein_distance(one, two) <= SAME * spread)


def state_at(point: Point, options: BifurcationOptions) -> State:
    """State at the end of the transient; raises `SimulationError` if the motion does not reach it."""
    return state_after(point.parameters, point.start, options.transient, options.tol)
