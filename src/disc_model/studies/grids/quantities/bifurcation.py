"""What the motion settles to, sampled once a turn of the drive or at switches."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from disc_model.analysis.classify import closure, shortest_period
from disc_model.data.variables import PHASES, SCALARS, SERIES, Column, Variable
from disc_model.parameters import Parameters
from disc_model.simulation.api import after, prepared, simulate
from disc_model.simulation.case import Record
from disc_model.simulation.result import State
from disc_model.stability.bifurcation import SAMPLED, STATUS_NAMES, bifurcation_samples
from disc_model.stability.cycle import cycle_neared
from disc_model.stability.return_map import case_faults
from disc_model.studies.grids.points import STATUS

if TYPE_CHECKING:
    from disc_model.studies.grids.quantities.schema import BifurcationOptions

STRETCH = 5.0
"""Length of a stretch of samples, s: some three hundred stick-slip cycles of the published cases."""
ALIKE = 0.05
"""Largest difference of two stretches that are alike, as a share of their spread."""
FEW = 8
"""Points up to which a motion is compared point by point."""
VISIBLE = 1e-3
"""Least spread, relative to the mean, that counts as one: below it a slow approach goes on unseen."""
SAME_INTERVAL = 1e-6
"""How nearly intervals repeat, s, for which a cycle is looked for; and at most by this share of their own differences,
over the number of switches after which they do: among n returns a motion on a torus misses by about 1/n."""
NEARLY = 0.05
REPEATS = 1e-11
"""Intervals that repeat this exactly, s, are periodic: roundings leave 1e-13 s of a cycle."""
TRIED = 3
"""Numbers of switches for which a cycle is looked for, at most."""
STEADY = ("unknown", "no", "yes")
COLUMNS = {
    "status": Column(*STATUS),
    **{name: Column(*SERIES[name], dims=("sample",)) for name in SAMPLED},
    "phase": Column("1", "phase of the motion at the sample", ("none", *PHASES), dims=("sample",)),
    "first_separation": Column(*SCALARS["first_separation"]),
    "separations": Column("1", "number of separations, transient included", whole=True),
    "transient": Column("s", "time left out before the samples"),
    "steady": Column("1", "whether two stretches of samples, at switches, were alike", STEADY),
    "period": Column("1", "number of switches after which the motion repeats, 0 if that is not shown", whole=True),
    "closure": Column(
        "s", "largest difference between an interval and the one a period later: what is left of the approach"
    ),
    "stick_fraction": Column("1", "share of the time spent sticking, transient included"),
}


def coordinates(options: BifurcationOptions) -> dict[str, tuple[Any, Variable]]:
    return {"sample": (np.arange(options.samples), Variable("1", "number of the turn after the transient"))}


def at(p: Parameters, options: BifurcationOptions) -> tuple[dict[str, Any], str]:
    """From the published start or the prepared one."""
    if options.section == "switch":
        return _at_switches(p, options)
    data = bifurcation_samples(
        p,
        "Omega",
        [p.Omega],
        transient=options.transient,
        samples=options.samples,
        initial_state=prepared(p, options, options.tol),
        theta=options.theta,
        tol=options.tol,
    ).isel(Omega=0)
    status = STATUS_NAMES[int(data["status"])]
    values: dict[str, Any] = {
        name: data[name].values for name in COLUMNS if name in data and name not in ("status", "phase")
    }
    values |= {"status": status, "phase": data["phase"].values + 1, "transient": options.transient}
    return values, "" if status == "ok" else f"the simulation ended early: {status}"


def _at_switches(p: Parameters, options: BifurcationOptions) -> tuple[dict[str, Any], str]:
    """Separations if there are any, else releases; the transient is doubled until the motion is known to repeat."""
    state, begin, transient = prepared(p, options, options.tol), 0.0, options.transient
    first, separations, stick = math.nan, 0, 0.0
    while True:
        stretches: list[Any] = []
        for recorded in (False, True, True):
            stop = begin + STRETCH if recorded else transient
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
                stretches.append(run.events)
        kind = "separation" if any((events["kind"] == "separation").any() for events in stretches) else "stick_to_slip"
        before, after_ = (events[events["kind"] == kind] for events in stretches)
        assert state is not None
        period, apart = _period(p, stretches[-1], kind, state)
        steady = period > 0 or alike(before["psi"].to_numpy(), after_["psi"].to_numpy())
        over = period > 0 or (steady and len(after_) < 2)
        if over or 2 * transient > options.longest:
            break
        transient *= 2
    taken = after_.iloc[-options.samples :]
    columns = {"psi": taken["psi"], "psi_velocity": p.Omega - taken["f"], "P": taken["P"], "u": taken["u"]}
    values: dict[str, Any] = {name: column.to_numpy(dtype=float) for name, column in columns.items()}
    values |= {
        "status": "ok",
        "phase": ["separation" if kind == "separation" else "stick"] * len(taken),
        "first_separation": first,
        "separations": separations,
        "stick_fraction": stick / begin,
        "transient": transient,
        "steady": "yes" if steady else "no",
        "period": period,
        "closure": apart,
    }
    return values, "" if steady else f"not steady after {transient:g} s"


def _period(p: Parameters, events: Any, kind: str, state: State) -> tuple[int, float]:
    """Number of switches after which the motion repeats, and how nearly it does so by now (s); 0 and nan if none.

    events : of the last stretch, which ends at `state`; those of the kind count
    """
    at = (events["kind"] == kind).to_numpy()
    intervals = np.diff(events["time"].to_numpy()[at])
    if n := repeats(intervals):
        return n, closure(intervals, n)
    releases = int((events["kind"] == "stick_to_slip").sum())
    for n in nearly(intervals) if releases and not case_faults(p, "a cycle") else ():
        cycle = cycle_neared(p, state, max(1, round(n * releases / at.sum())))
        if cycle is not None:
            found = cycle.separations if kind == "separation" else cycle.releases
            return found, closure(intervals, found)
    return 0, math.nan


def repeats(intervals: np.ndarray) -> int:
    """Least number of intervals after which they repeat to rounding; 0 if they do not within half the stretch."""
    n = shortest_period(intervals, REPEATS) if intervals.size > 1 else 0
    # small differences may add up to a slow drift
    drifts = any(np.ptp(intervals[i::n]) > REPEATS for i in range(n))
    return 0 if drifts else n


def nearly(intervals: np.ndarray) -> list[int]:
    """Numbers of intervals after which they nearly repeat, which proves nothing; the smallest ones."""
    extent = float(np.ptp(intervals)) if intervals.size else 0.0
    found = []
    for n in range(1, intervals.size // 2 + 1):
        bound = SAME_INTERVAL if n == 1 else min(SAME_INTERVAL, NEARLY * extent / n)
        if abs(intervals[n] - intervals[0]) <= bound and closure(intervals, n) <= bound:
            found.append(n)
    return found[:TRIED]


def alike(one: np.ndarray, two: np.ndarray) -> bool:
    """Whether two stretches show the same motion: the same few points, or as many with equal quantiles."""
    if min(len(one), len(two)) < 2:
        return len(one) == len(two)
    spread = max(np.ptp(one), np.ptp(two), VISIBLE * abs(float(np.mean(two))))
    # few points are the same ones; many have the same quantiles, which a sample more or less does not move
    sets = [np.unique(np.round(stretch / (ALIKE * spread))) for stretch in (one, two)]
    if max(map(len, sets)) <= FEW:
        return len(sets[0]) == len(sets[1]) and bool(np.max(np.abs(sets[0] - sets[1])) <= 1)
    quantiles = [np.quantile(stretch, np.linspace(0, 1, 21)) for stretch in (one, two)]
    counts = abs(len(one) - len(two)) <= max(1, ALIKE * len(two))
    return bool(counts and np.max(np.abs(quantiles[0] - quantiles[1])) <= ALIKE * spread)


def state_at(p: Parameters, options: BifurcationOptions) -> State:
    """Where the transient ends; raises `SimulationError` if the motion did not get there."""
    return after(p, options, options.transient, options.tol)
