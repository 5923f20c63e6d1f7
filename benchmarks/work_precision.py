"""Speed against accuracy: every method on every scene, at settings from coarse to fine."""

import math
import time as clock
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import xarray as xr

from benchmarks import scenes, study
from benchmarks.methods import METHODS, SCENES
from benchmarks.methods.integrators import MethodResult, Problem, RunStatus
from benchmarks.study import TABLES, Row
from disc_model.data.dataset import json_attribute
from disc_model.simulation.api import simulate

DEFAULT = 1e-10
"""The series engine's default tolerance, and the event-time error in s that others are asked for."""
BUDGET = 12.0
"""Time for a point, s."""
RIGID_BUDGET = 4.0
"""Time for a point on the rigid disc, which methods in Python cannot finish, s."""
LONG = 0.5
"""Longest time of a point that is measured again, s."""
QUICK = 0.1 * LONG
"""Longest time of a point that is measured in all rounds, s."""
FEW = 3
"""Number of measurements of other points."""
FURTHER = 4.0
"""How far quick points go on for the cost of a further second, in spans of the scene."""
FLOOR = 1e-15
"""Errors below this count as equal in costs, zero among them, s."""
WHOLE_CALLS = 21
"""Number of calls of which `_whole_call` takes the median."""
COLUMNS: dict[str, str] = TABLES["work_precision_table"]
"""Variables by the column of the table that shows them."""
Settings = Mapping[str, Mapping[str, Sequence[float]]]
"""Settings from coarse to fine, by scene and method."""


def work_precision(settings: Settings | None = None, *, rounds: int = 11) -> xr.Dataset:
    """Measure all points along (scene, solver, point).

    A method that gives up at a setting is not tried at finer ones.

    Parameters
    ----------
    settings : by scene and method; those of ``rivals.toml`` if None
    rounds : greatest number of measurements of a point, of which the median is reported
    """
    if settings is None:
        settings = _declared_settings()
    described: dict[str, Any] = {}
    for name in settings:
        described[f"scene_{name}"] = json_attribute(_description(name))
    dataset = study.run(
        "work_precision",
        _points(settings),
        _Measurement().measure,
        ["scene", "solver", "point"],
        rounds=rounds,
        flags={"verdict": scenes.Verdict},
        title="Speed against accuracy",
        Conventions="CF-1.11",
        **described,
    )
    solvers = [name for name in METHODS if name in dataset["solver"]]
    labels = [METHODS[name].label for name in solvers]
    dataset = dataset.drop_vars("point").sel(solver=solvers)
    return dataset.assign(label=("solver", labels, {"long_name": "name in words"}))


def _declared_settings() -> Settings:
    """Return the settings of ``rivals.toml``."""
    settings: dict[str, dict[str, Sequence[float]]] = {}
    for scene in SCENES:
        settings[scene] = {}
        for name, method in METHODS.items():
            if scene in method.settings:
                settings[scene][name] = method.settings[scene]
    return settings


def _points(settings: Settings) -> list[Row]:
    """Return the points of methods that are installed."""
    points: list[Row] = []
    for scene, by_method in settings.items():
        for solver, values in by_method.items():
            if METHODS[solver].absent():
                continue
            for point, value in enumerate(values):
                points.append({"scene": scene, "solver": solver, "point": point, "value": value})
    return points


def _description(scene: str) -> dict[str, Any]:
    """Return what the dataset states of a scene."""
    case = scenes.problem(scene)
    right = scenes.answer(scene)
    return {
        "parameters": case.parameters.canonical_json,
        "span": case.span,
        "reference_error": right.error,
        "events": len(right.kinds),
        "separations": right.kinds.count("separation"),
    }


class _Point(NamedTuple):
    """A method on a scene at a setting."""

    scene: str
    solver: str
    value: float

    @property
    def budget(self) -> float:
        return RIGID_BUDGET if self.scene == "rigid" else BUDGET

    def solve(self, problem: Problem) -> MethodResult:
        """Return the method's result on a problem."""
        return METHODS[self.solver].solve(problem, self.value, self.budget)


class _Measurement:
    """What is known of points from earlier rounds.

    Attributes
    ----------
    times : of the measurements of a point, s
    hopeless : scenes and methods that gave up
    """

    def __init__(self) -> None:
        self.times: dict[_Point, list[float]] = defaultdict(list)
        self.hopeless: set[tuple[str, str]] = set()

    def measure(self, scene: str, solver: str, point: int, value: float) -> Iterator[Row]:
        """Yield the results of a point, if it is to be measured once more.

        Parameters
        ----------
        scene, solver, value : the point
        point : number of the setting, which names the point only
        """
        asked = _Point(scene, solver, value)
        times = self.times[asked]
        if self._is_done(asked):
            return
        problem = scenes.problem(scene)
        result = asked.solve(problem)
        if not times and result.seconds < LONG:  # the first call compiles and warms caches
            result = asked.solve(problem)
        if result.outcome is RunStatus.TOO_SLOW:
            self.hopeless.add((scene, solver))
        times.append(result.seconds)

        errors = scenes.errors(problem, scenes.answer(scene), result)
        further = math.nan
        if scene in scenes.JUDGED and result.outcome is RunStatus.FINISHED and _is_quick(times):
            further = _cost_of_a_further_second(asked, problem, result)
        whole_call = math.nan
        if asked == (scenes.JUDGED[0], "series", DEFAULT):
            whole_call = _whole_call()
        yield {
            "seconds": result.seconds,
            "cost": result.seconds / problem.span,
            "marginal_cost": further,
            "glue": result.glue / max(result.seconds, 1e-9),
            "event_error": errors.event_time,
            "state_error": errors.state,
            "verdict": errors.verdict,
            "work": result.work,
            "events": len(result.kinds),
            "separations": result.kinds.count("separation"),
            "whole_call": whole_call,
        }

    def _is_done(self, asked: _Point) -> bool:
        """Return whether a point needs no further measurement."""
        times = self.times[asked]
        if not times:
            return (asked.scene, asked.solver) in self.hopeless
        if _is_quick(times):
            return False
        return float(np.median(times)) >= LONG or len(times) >= FEW


def _is_quick(times: Sequence[float]) -> bool:
    """Return whether a point is measured in all rounds, by its times in s."""
    return float(np.median(times)) < QUICK


def _cost_of_a_further_second(asked: _Point, problem: Problem, result: MethodResult) -> float:
    """Return the time of a simulated second beyond a scene's end, s; nan if it is not reached.

    Parameters
    ----------
    asked, problem : the point and its problem
    result : of the method up to the scene's end
    """
    further = FURTHER * problem.span
    longer = asked.solve(replace(problem, t_end=problem.t_end + further))
    if longer.outcome is not RunStatus.FINISHED:
        return math.nan
    return (longer.seconds - result.seconds) / further


def _whole_call() -> float:
    """Return the processor time of one whole call of `simulate` for ``stick_slip``, s.

    It is the median of several calls at the default.
    """
    problem = scenes.problem("stick_slip")
    seconds = []
    for _ in range(WHOLE_CALLS):
        began = clock.thread_time()
        simulate(problem.parameters, problem.t_end)
        seconds.append(clock.thread_time() - began)
    return float(np.median(seconds))


# ---- The measured points as a table, and costs at equal error


def measured_points(dataset: xr.Dataset) -> pd.DataFrame:
    """Return one row for each measured point.

    The column ``further`` is the cost of a further second, or of a second of a long run.
    """
    frame = dataset.to_dataframe(dim_order=["scene", "solver", "point"]).reset_index()
    frame = frame[frame["verdict"] != scenes.Verdict.NOT_RUN].reset_index(drop=True)
    return frame.assign(further=frame["marginal_cost"].fillna(frame["cost"]))


def cost_at(line: pd.DataFrame, wanted: float, cost: str = "further") -> float:
    """Return the cost at which a method reaches an event-time error.

    It is interpolated in log-log. A setting counts only if no cheaper one is as accurate; nothing
    is extrapolated to coarser settings.

    Parameters
    ----------
    line : measured points of a method on a scene
    wanted : the error, s
    cost : column of the costs

    Returns
    -------
    float
        nan if no setting is as accurate.
    """
    known = line[np.isfinite(line["event_error"])].sort_values(cost)
    if known.empty:
        return math.nan
    errors = np.maximum(known["event_error"].to_numpy(), FLOOR)
    costs = known[cost].to_numpy()
    cheaper = np.concatenate([[np.inf], errors[:-1]])
    best = errors < np.minimum.accumulate(cheaper)
    errors = errors[best]
    costs = costs[best]

    wanted = max(wanted, FLOOR)
    if not errors[-1] <= wanted:
        return math.nan
    accuracy = -np.log(errors)
    return float(np.exp(np.interp(-math.log(wanted), accuracy, np.log(costs))))


def table(dataset: xr.Dataset) -> pd.DataFrame:
    """Return one row for each measured point.

    The column ``times_series`` is its cost over that of the series engine at this error, by
    `cost_at`.
    """
    points = measured_points(dataset)
    series = points[points["solver"] == "series"]
    settings = []
    verdicts = []
    of_series = []
    for point in points.to_dict("records"):
        settings.append(f"{METHODS[point['solver']].setting}={point['value']:.3g}")
        verdicts.append(scenes.Verdict(point["verdict"]).name.lower())
        line = series[series["scene"] == point["scene"]]
        of_series.append(cost_at(line, point["event_error"], "cost"))
    derived = points.assign(
        setting=settings, verdict=verdicts, times_series=points["cost"] / of_series
    )
    counts = dict.fromkeys(("events", "separations", "repeats"), int)
    return derived.astype(counts)[[*COLUMNS.values()]].set_axis([*COLUMNS], axis=1)
