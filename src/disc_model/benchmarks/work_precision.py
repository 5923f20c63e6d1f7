"""Speed against accuracy, every method on every scene at settings from coarse to fine, and maps of
failures."""

import math
import time as clock
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from disc_model.benchmarks import scenes
from disc_model.benchmarks.methods import METHODS, SCENES, Method
from disc_model.benchmarks.methods.integrators import STABILITY_LIMIT, Problem, RunStatus
from disc_model.benchmarks.scenes import JUDGED, Answer, Verdict
from disc_model.benchmarks.study import TABLES, Row, run
from disc_model.data.dataset import json_attribute
from disc_model.disc.plate import mode_arrays
from disc_model.mode_choice import real_modes
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate

DEFAULT = 1e-10  # the series engine's default tolerance, and the event-time error (s) required of the other methods
BUDGET, RIGID_BUDGET = (
    12.0,
    4.0,
)  # for a point, s; the second on the rigid disc, which methods in Python cannot finish
LONG = 0.5  # longest time of a point measured in later rounds, s; a tenth of it or less is measured in all rounds
FURTHER = 4.0  # extension of quick points beyond a scene's end, in spans of the scene, for the cost of a further second
FLOOR = 1e-15  # errors below this count as equal in costs, zero among them, s
COLUMNS = TABLES["work_precision_table"]  # variables by the column of the table that shows them
Settings = Mapping[
    str, Mapping[str, Sequence[float]]
]  # settings from coarse to fine, by scene and method


def work_precision(settings: Settings | None = None, *, rounds: int = 11) -> xr.Dataset:
    """Measure all points along (scene, solver, point), at most ``rounds`` times, of which the
    median is reported. A method that gives up at a setting is not tried at finer ones."""
    if settings is None:
        settings = {
            x: {name: each.settings[x] for name, each in METHODS.items() if x in each.settings}
            for x in SCENES
        }
    points = [
        {"scene": scene, "solver": solver, "point": point, "value": value}
        for scene, by_method in settings.items()
        for solver, values in by_method.items()
        if not METHODS[solver].absent()
        for point, value in enumerate(values)
    ]
    times: dict[tuple[str, str, int], list[float]] = defaultdict(list)
    hopeless: set[tuple[str, str]] = set()

    def measure(scene: str, solver: str, point: int, value: float) -> Iterator[Row]:
        before = times[scene, solver, point]
        if not before and (scene, solver) in hopeless:
            return
        # quick points are measured in every round, others at most twice more
        if before and not _quick(before) and (np.median(before) >= LONG or len(before) >= 3):
            return
        problem, budget = scenes.problem(scene), RIGID_BUDGET if scene == "rigid" else BUDGET
        solve = partial(METHODS[solver].solve, value=value, budget=budget)
        result = solve(problem)
        if not before and result.seconds < LONG:  # the first call compiles and warms caches
            result = solve(problem)
        if result.outcome is RunStatus.TOO_SLOW:
            hopeless.add((scene, solver))
        before.append(result.seconds)
        errors = scenes.errors(problem, scenes.answer(scene), result)
        further = math.nan
        if scene in JUDGED and result.outcome is RunStatus.FINISHED and _quick(before):
            run_on = solve(replace(problem, t_end=problem.t_end + FURTHER * problem.span))
            if run_on.outcome is RunStatus.FINISHED:
                further = (run_on.seconds - result.seconds) / (FURTHER * problem.span)
        yield {
            "seconds": result.seconds, "cost": result.seconds / problem.span, "marginal_cost": further,
            "glue": result.glue / max(result.seconds, 1e-9), "event_error": errors.event_time,
            "state_error": errors.state, "verdict": errors.verdict, "work": result.work,
            "events": len(result.kinds), "separations": result.kinds.count("separation"),
            "whole_call": _whole_call() if (scene, solver, value) == (JUDGED[0], "series", DEFAULT) else math.nan,
        }  # fmt: skip

    described: dict[str, Any] = {}
    for name in settings:
        case, right = scenes.problem(name), scenes.answer(name)
        about = {
            "parameters": case.parameters.canonical_json,
            "span": case.span,
            "reference_error": right.error,
        }
        about |= {"events": len(right.kinds), "separations": right.kinds.count("separation")}
        described[f"scene_{name}"] = json_attribute(about)
    dataset = run(
        "work_precision", points, measure, ["scene", "solver", "point"], rounds=rounds, flags={"verdict": Verdict},
        title="Speed against accuracy", Conventions="CF-1.11", **described,
    )  # fmt: skip
    solvers = [name for name in METHODS if name in dataset["solver"]]
    dataset = dataset.drop_vars("point").sel(solver=solvers)
    return dataset.assign(
        label=("solver", [METHODS[name].label for name in solvers], {"long_name": "name in words"})
    )


def _whole_call() -> float:
    """Processor time (s) of one whole call of `simulate` at its default for ``stick_slip``: the
    median of several."""
    problem, seconds = scenes.problem("stick_slip"), []
    for _ in range(21):
        began = clock.thread_time()
        simulate(problem.parameters, problem.t_end)
        seconds.append(clock.thread_time() - began)
    return float(np.median(seconds))


def _quick(times: Sequence[float]) -> bool:
    return float(np.median(times)) < 0.1 * LONG


# ---- The measured points as a table, and costs at equal error
def measured_points(dataset: xr.Dataset) -> pd.DataFrame:
    """One row for each measured point; ``further`` is the cost of a further second, or of a second
    of a long run."""
    frame = dataset.to_dataframe(dim_order=["scene", "solver", "point"]).reset_index()
    frame = frame[frame["verdict"] != Verdict.NOT_RUN].reset_index(drop=True)
    return frame.assign(further=frame["marginal_cost"].fillna(frame["cost"]))


def cost_at(line: pd.DataFrame, wanted: float, cost: str = "further") -> float:
    """Cost at which a line reaches an event-time error (s): interpolated in log-log; nan if no
    setting is as accurate. A setting counts only if no cheaper one is as accurate; nothing is
    extrapolated to coarser settings."""
    known = line[np.isfinite(line["event_error"])].sort_values(cost)
    errors = np.maximum(known["event_error"].to_numpy(), FLOOR)
    best = (
        errors < np.minimum.accumulate(np.concatenate([[np.inf], errors[:-1]]))
        if len(known)
        else []
    )
    errors, costs = errors[best], known[cost].to_numpy()[best]
    if not len(errors) or not errors[-1] <= max(wanted, FLOOR):
        return math.nan
    return float(np.exp(np.interp(-math.log(max(wanted, FLOOR)), -np.log(errors), np.log(costs))))


def table(dataset: xr.Dataset) -> pd.DataFrame:
    """One row per measured point; ``times_series``: its cost over the series engine's at that
    error, by `cost_at`."""
    points = measured_points(dataset)
    series = points[points["solver"] == "series"]
    wanted = zip(points["scene"], points["event_error"], strict=True)
    yardsticks = [
        cost_at(series[series["scene"] == scene], error, "cost") for scene, error in wanted
    ]
    derived = points.assign(
        setting=[
            f"{METHODS[name].setting}={x:.3g}" for name, x in points[["solver", "value"]].to_numpy()
        ],
        verdict=[Verdict(verdict).name.lower() for verdict in points["verdict"]],
        times_series=points["cost"] / yardsticks,
    )
    counts = dict.fromkeys(("events", "separations", "repeats"), int)
    return derived.astype(counts)[[*COLUMNS.values()]].set_axis([*COLUMNS], axis=1)


# ---- Where methods fail: maps over step or tolerance and number of modes, against the engine at
# `REFERENCE_TOL`
SPANS: Mapping[str, float] = {"stick_slip": 1.0, "separating": 0.1}  # s
STEPS = tuple(np.geomspace(2e-5, 2e-3, 61)[::-1].tolist())  # fixed steps of a map, s
REFERENCE_TOL = 1e-14
MapSettings = Sequence[float] | None  # those of `map_settings` if not given


def failure_map(
    method: str,
    scene: str = "separating",
    diameters: Sequence[int] = (1, 2, 4, 6, 8),
    values: MapSettings = None,
) -> xr.Dataset:
    """Verdicts on a method on a short span of a scene along (diameters, value), and facts that
    explain them."""
    judged = METHODS[method].economical()
    cases: dict[int, tuple[Problem, Answer]] = {}
    for count in diameters:
        p = Parameters(N=385.0, Omega=15.1, n_diameters=count)
        start = scenes.MOTIONS[scene][1](p)
        problem = Problem(p, start, start.time + SPANS[scene])
        right = METHODS["series"].solve(problem, REFERENCE_TOL)
        cases[count] = (
            problem,
            Answer(right.times.astype(np.longdouble), right.kinds, right.final, REFERENCE_TOL),
        )

    def measure(diameters: int, value: float) -> Iterator[Row]:
        problem, right = cases[diameters]
        result = judged.solve(problem, value, judged.map_budget)
        errors = scenes.errors(problem, right, result)
        yield {
            "verdict": errors.verdict,
            "event_error": errors.event_time,
            "longest_step": result.longest_step,
        }

    def facts(diameters: int) -> Iterator[Row]:
        problem, right = cases[diameters]
        p = problem.parameters
        top = float(mode_arrays(p).omega.max())
        gaps = np.diff(right.times.astype(float))  # which a step must not exceed
        shortest, stiff = float(gaps[gaps > 0].min()), p.mu_s * p.N / (p.m * p.r_0 * top)
        limits = {
            "step_limit": STABILITY_LIMIT / top,
            "shortest_phase": shortest,
            "stiff_epsilon": stiff,
        }
        yield {"modes": real_modes(diameters, 0), "omega_max": top} | limits

    axes = {"diameters": diameters, "value": map_settings(judged) if values is None else values}
    about: dict[str, Any] = {"scene": scene, "budget": judged.map_budget, "span": SPANS[scene]}
    study = run("failure_map", axes, measure, flags={"verdict": Verdict}, **about)
    return with_facts(judged, study, facts, "failure_map_facts")


def map_settings(method: Method) -> Sequence[float]:
    return STEPS if method.setting == "step" else method.map_values


def with_facts(
    method: Method, study: xr.Dataset, facts: Callable[..., Iterator[Row]], table: str
) -> xr.Dataset:
    """The map of a method with the facts of each row, and what its axes are."""
    study = study.assign(
        run(table, {"diameters": study["diameters"].values.tolist()}, facts).data_vars
    )
    study["diameters"].attrs = {"units": "1", "long_name": "highest nodal diameter"}
    study["value"].attrs = {"long_name": f"setting: {method.setting}"}
    return study.assign_attrs(method=method.name, label=method.label, setting=method.setting)
