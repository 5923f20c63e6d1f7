"""What the motion settles to, sampled once a turn of the drive or at switches."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from disc_model.analysis.classify import shortest_period
from disc_model.data.variables import PHASES, SCALARS, SERIES, Variable
from disc_model.parameters import Parameters
from disc_model.simulation.api import after, prepared, simulate
from disc_model.simulation.case import Record
from disc_model.simulation.result import State
from disc_model.stability.bifurcation import STATUS_NAMES, bifurcation_samples
from disc_model.studies.grids.run import STATUS, STATUSES, Column

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
"""How exactly intervals of a periodic motion repeat, s: far below their own differences, above what is left of the
approach after the transient."""
_SAMPLED = ("psi", "psi_velocity", "P", "u", "w_point")
STEADY = ("unknown", "no", "yes")
COLUMNS = {
    "status": Column(STATUS),
    **{name: Column(SERIES[name], ("sample",)) for name in _SAMPLED},
    "phase": Column(Variable("1", "phase of the motion at the sample", ("none", *PHASES)), ("sample",)),
    "first_separation": Column(SCALARS["first_separation"]),
    "separations": Column(Variable("1", "number of separations, transient included"), whole=True),
    "transient": Column(Variable("s", "time left out before the samples")),
    "steady": Column(Variable("1", "whether two stretches of samples, at switches, were alike", STEADY)),
    "period": Column(Variable("1", "number of switches after which the samples repeat, 0 if they do not"), whole=True),
    "stick_fraction": Column(Variable("1", "share of the time spent sticking, transient included")),
}


def coordinates(options: BifurcationOptions) -> dict[str, tuple[Any, Variable]]:
    """Numbers of the samples."""
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
    found = STATUS_NAMES[int(data["status"])]
    status = found if found in STATUSES else "ok"
    values: dict[str, Any] = {
        name: data[name].values for name in COLUMNS if name in data and name not in ("status", "phase")
    }
    values |= {"status": status, "phase": data["phase"].values + 1, "transient": options.transient}
    return values, "" if status == "ok" else f"the simulation ended early: {status}"


def _at_switches(p: Parameters, options: BifurcationOptions) -> tuple[dict[str, Any], str]:
    """Separations if there are any, else releases; the transient is doubled until two stretches are alike."""
    state, begin, transient = prepared(p, options, options.tol), 0.0, options.transient
    first, separations, stick = math.nan, 0, 0.0
    while True:
        stretches: list[Any] = []
        for end in (transient, math.nan, math.nan):
            recorded = math.isnan(end)
            if not recorded and end <= begin:
                continue
            stop = begin + STRETCH if recorded else end
            run = simulate(p, stop, tol=options.tol, initial_state=state, record=Record(events=recorded))
            first = run.first_separation if math.isnan(first) else first
            separations += int(run.statistics["separations"])
            stick += run.statistics["time_stick"]
            state, begin = run.final_state, run.final_state.time
            if not run.status.complete:
                values = {"status": run.status.value, "first_separation": first, "separations": separations}
                return values, f"the simulation ended early: {run.status}"
            if recorded:
                stretches.append(run.events)
        kind = "separation" if any((events["kind"] == "separation").any() for events in stretches) else "stick_to_slip"
        before, after_ = (events[events["kind"] == kind] for events in stretches)
        steady = alike(before["psi"].to_numpy(), after_["psi"].to_numpy())
        if steady or 2 * transient > options.longest:
            break
        transient *= 2
    taken = after_.iloc[-options.samples :]
    columns = {"psi": taken["psi"], "psi_velocity": p.Omega - taken["f"], "P": taken["P"], "u": taken["u"]}
    values = {name: _filled(column.to_numpy(dtype=float), options.samples) for name, column in columns.items()}
    phase = np.zeros(options.samples, np.int8)
    phase[: len(taken)] = 1 + PHASES.index("separation" if kind == "separation" else "stick")
    intervals = np.diff(after_["time"].to_numpy())
    values |= {
        "status": "ok",
        "phase": phase,
        "first_separation": first,
        "separations": separations,
        "stick_fraction": stick / begin,
        "transient": transient,
        "steady": "yes" if steady else "no",
        "period": shortest_period(intervals, SAME_INTERVAL) if intervals.size > 1 else 0,
    }
    return values, "" if steady else f"not steady after {transient:g} s"


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


def _filled(values: np.ndarray, size: int) -> np.ndarray:
    return np.concatenate([values, np.full(size - len(values), math.nan)])


def state_at(p: Parameters, options: BifurcationOptions) -> State:
    """Where the transient ends; raises `SimulationError` if the motion did not get there."""
    return after(p, options, options.transient, options.tol)
