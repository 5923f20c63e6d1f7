"""Speed against accuracy: every method on every scene, at settings from coarse to fine, in one run on one core.

Each round measures all points in turn, so that a disturbance of the machine affects all methods alike. The reported
value is the median over the rounds.  Slow points are measured less often (``repeats`` is the number).
"""

import logging
import math
import time as clock
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import xarray as xr

from disc_model.benchmarks import scenes
from disc_model.benchmarks.grid import measured, variables
from disc_model.benchmarks.hardware import machine, one_core
from disc_model.benchmarks.methods import RunStatus
from disc_model.benchmarks.registry import METHODS, SCENES
from disc_model.benchmarks.scenes import JUDGED, Verdict
from disc_model.data.dataset import json_attribute
from disc_model.data.provenance import versions
from disc_model.simulation.api import simulate

log = logging.getLogger(__name__)

BUDGET, RIGID_BUDGET = 12.0, 4.0
"""Budget of a method for a point, s, and on the rigid disc, which methods in Python cannot finish."""
LONG = 0.5
"""Longest time of a point measured in later rounds, s; a tenth of it or less is measured in all rounds."""
FURTHER = 4.0
"""Extension of quick points beyond a scene's end, in spans of the scene, for the cost of a further second."""
FLOOR = 1e-13
"""Errors below this (s, or relative) are rounding and are left out of the fit of the order."""
Settings = Mapping[str, Mapping[str, Sequence[float]]]
"""Settings from coarse to fine, by scene and method."""
VARIABLES = variables("work_precision", verdict=Verdict)
OF_LINES = variables("work_precision_lines")
"""Variables of methods and scenes."""


class Point(NamedTuple):
    """One method at one setting on one scene."""

    scene: str
    method: str
    place: int
    value: float


@one_core()
def work_precision(settings: Settings | None = None, *, rounds: int = 11) -> xr.Dataset:
    """Measure all points, and log each of them; a method that gives up at a coarse setting is not tried at finer ones.

    Parameters
    ----------
    settings : those of all methods if not given
    rounds : number of measurements of quick points

    Returns
    -------
    Dataset along (scene, solver, point), unused points nan; the variables of `VARIABLES`, and
    along (scene, solver) the fitted ``order_event`` and ``order_state``, see `fitted_order`.
    """
    if settings is None:
        settings = {
            scene: {name: method.settings[scene] for name, method in METHODS.items() if scene in method.settings}
            for scene in SCENES
        }
    todo = [
        Point(scene, method, place, value)
        for scene, by_method in settings.items()
        for method, values in by_method.items()
        if not METHODS[method].absent()
        for place, value in enumerate(values)
    ]
    rows, calls = [], []
    walls: dict[Point, list[float]] = defaultdict(list)
    hopeless: set[tuple[str, str]] = set()
    for turn in range(rounds):
        for point in todo:
            if point[:2] in hopeless if not turn else not _again(walls[point], turn):
                continue
            problem, limit = scenes.problem(point.scene), RIGID_BUDGET if point.scene == "rigid" else BUDGET
            result = METHODS[point.method].solve(problem, point.value, limit)
            if not turn and result.seconds < LONG:  # the first call compiles and warms caches
                result = METHODS[point.method].solve(problem, point.value, limit)
            if result.outcome is RunStatus.TOO_SLOW:
                hopeless.add(point[:2])
            walls[point].append(result.seconds)
            followed = point.scene in JUDGED and result.outcome is RunStatus.FINISHED and _quick(walls[point])
            found = scenes.errors(problem, scenes.answer(point.scene), result)
            row = {
                "seconds": result.seconds,
                "cost": result.seconds / problem.span,
                "marginal_cost": _marginal_cost(point, limit, result.seconds) if followed else math.nan,
                "glue": result.glue / max(result.seconds, 1e-9),
                "event_error": found.event_time,
                "state_error": found.state,
                "verdict": found.verdict,
                "work": result.work,
                "events": len(result.kinds),
                "separations": result.separations,
            }
            rows.append(point._asdict() | row)
            log.info("%s %s %g: %.4g s", point.scene, point.method, point.value, result.seconds)
        calls.append(_whole_call())
    each = pd.DataFrame(rows).groupby(["scene", "method", "place"])
    spread = each["seconds"].max() - each["seconds"].min()
    table = each.median().assign(seconds_spread=spread, repeats=each.size())
    return _dataset(settings, table, float(np.median(calls)))


def _marginal_cost(point: Point, limit: float, seconds: float) -> float:
    """Seconds per simulated second beyond the scene's end, by a run that continues; ``seconds``: up to the end."""
    problem = scenes.problem(point.scene)
    longer = replace(problem, t_end=problem.t_end + FURTHER * problem.span)
    result = METHODS[point.method].solve(longer, point.value, limit)
    return (result.seconds - seconds) / (FURTHER * problem.span) if result.outcome is RunStatus.FINISHED else math.nan


def _whole_call() -> float:
    """Processor time (s) of one call of `simulate` at its default for the scene ``stick_slip``, everything included.

    It is the median of several calls: the first ones find caches filled by other methods.
    """
    problem, seconds = scenes.problem("stick_slip"), []
    for _ in range(21):
        began = clock.thread_time()
        simulate(problem.parameters, problem.t_end)
        seconds.append(clock.thread_time() - began)
    return float(np.median(seconds))


def _quick(walls: Sequence[float]) -> bool:
    return float(np.median(walls)) < 0.1 * LONG


def _again(walls: Sequence[float], turn: int) -> bool:
    """Whether to measure a point in a later round: always if it is quick, else at most twice more."""
    return bool(walls) and (_quick(walls) or (float(np.median(walls)) < LONG and turn < 3))


def _dataset(settings: Settings, rows: pd.DataFrame, whole_call: float) -> xr.Dataset:
    methods = [name for name in METHODS if any(name in by_method for by_method in settings.values())]
    most = max(len(values) for by_method in settings.values() for values in by_method.values())
    found: dict[Any, Any] = rows.to_dict("index")
    dataset = measured(
        {"scene": [*settings], "solver": methods, "point": range(most)},
        VARIABLES,
        lambda *place: found.get(place, {"verdict": Verdict.NOT_RUN}),
    ).drop_vars("point")
    dataset.attrs |= {"Conventions": "CF-1.11", "machine": machine(), "title": "Speed against accuracy"}
    dataset.attrs |= {"versions": json_attribute(versions("heyoka", "scikit-sundae"))}
    dataset.attrs |= {f"scene_{name}": json_attribute(scenes.describe(name)) for name in settings}
    lines: dict[str, tuple[str | tuple[str, ...], Any]] = {
        "label": ("solver", [METHODS[name].label for name in methods]),
        "whole_call": ((), whole_call),
        "order_theory": ("solver", [METHODS[name].order for name in methods]),
    }
    for error in ("event", "state"):
        orders = [[_line_order(dataset, scene, method, error) for method in methods] for scene in settings]
        lines[f"order_{error}"] = (("scene", "solver"), orders)
    return dataset.assign({name: (dims, values, OF_LINES[name].attributes) for name, (dims, values) in lines.items()})


def _line_order(dataset: xr.Dataset, scene: str, method: str, error: str) -> float:
    """Order against the step; for a method of variable order, the exponent q of error ~ tolerance^q."""
    line = dataset.sel(scene=scene, solver=method)
    usable = np.isin(line["verdict"].values, (int(Verdict.CONVERGED), int(Verdict.INACCURATE)))
    own = METHODS[method]
    # the number of right-hand sides counts the steps of a method of fixed order; other settings stand for themselves
    n = line["work"].values if own.setting == "tol" and math.isfinite(own.order) else 1.0 / line["value"].values
    return fitted_order(n[usable], line[f"{error}_error"].values[usable])


def fitted_order(n: np.ndarray, error: np.ndarray) -> float:
    """Order p of error ~ n^-p by least squares on the asymptotic part; nan if fewer than two points are left.

    n, error : (k,), from coarse to fine; n is the number of steps, or what grows like it.  The asymptotic part: errors
    above `FLOOR` (rounding) and below a tenth of the largest, or all above the floor if that leaves fewer than three.
    """
    usable = np.isfinite(n) & np.isfinite(error) & (error > FLOOR) & (n > 0)
    if np.count_nonzero(usable) < 2:
        return math.nan
    below = usable & (error <= 0.1 * np.max(error[usable]))
    if np.count_nonzero(below) >= 3:
        usable = below
    x, y = np.log(n[usable]), np.log(error[usable])
    if np.ptp(x) < math.log(1.5):  # stability or events, not the steps, decide the error
        return math.nan
    return float(-np.polyfit(x, y, 1)[0])
