"""Speed against accuracy: every method on every scene, at settings from coarse to fine."""

import math
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from benchmarks import scenes
from benchmarks.machine import stamped
from benchmarks.methods import METHODS, SCENES
from benchmarks.methods.integrators import RunStatus

DEFAULT = 1e-10
"""The series engine's default tolerance, and the event-time error in s that others are asked for."""
BUDGET = {"rigid": 4.0}
"""Time for a point on scenes that methods in Python cannot finish, s;"""
USUAL_BUDGET = 12.0
"""and on the others."""
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
POINT = ["scene", "method", "setting"]
"""Columns that name a point."""
Settings = Mapping[str, Mapping[str, Sequence[float]]]
"""Settings from coarse to fine, by scene and method."""


def work_precision(settings: Settings | None = None, *, rounds: int = 11) -> pd.DataFrame:
    """Measure all points; a method that gives up at a setting is not tried at finer ones.

    Parameters
    ----------
    settings : by scene and method; those of ``rivals.toml`` if None
    rounds : greatest number of measurements of a point; a disturbance then affects all alike

    Returns
    -------
    table : a row for each point, with medians of its measurements:
        ``cost`` and ``further`` are seconds of processor time per simulated second, the latter
        beyond the scene's end; ``event_error`` is the largest error of an event time in s, nan if
        events are missing or invented; ``python`` is the share of the time spent in Python between
        compiled phases
    """
    times: dict[tuple[str, str, float], list[float]] = defaultdict(list)
    hopeless = set()
    rows = []
    for _ in range(rounds):
        for scene, method, value in _points(settings):
            known = times[scene, method, value]
            if _is_done(known) or (scene, method) in hopeless:
                continue
            row, outcome = _measured(scene, method, value, first=not known)
            rows.append(row)
            known.append(row["seconds"])
            if outcome is RunStatus.TOO_SLOW:
                hopeless.add((scene, method))

    groups = pd.DataFrame(rows).groupby(POINT, sort=False)
    medians = groups.median(numeric_only=True)
    points = medians.assign(verdict=groups["verdict"].first(), repeats=groups.size())
    points["further"] = points["further"].fillna(points["cost"])
    return stamped(points.reset_index())


def _points(settings: Settings | None) -> Iterator[tuple[str, str, float]]:
    """Yield scene, method and setting of the points of methods that are installed."""
    for scene, (name, method) in product(SCENES, METHODS.items()):
        values: Sequence[float] = method.settings.get(scene, ())
        if settings is not None:
            values = settings.get(scene, {}).get(name, ())
        if not method.absent():
            yield from ((scene, name, value) for value in values)


def _is_done(times: Sequence[float]) -> bool:
    """Return whether a point needs no further measurement, by the times of the earlier ones in s."""
    if not times:
        return False
    typical = float(np.median(times))
    return typical >= LONG or (typical >= QUICK and len(times) >= FEW)


def _measured(scene: str, name: str, value: float, *, first: bool) -> tuple[dict[str, Any], str]:
    """Return the results of a point, and how its run ended.

    Parameters
    ----------
    scene, name, value : the point
    first : whether it is the first measurement, which may compile
    """
    method = METHODS[name]
    budget = BUDGET.get(scene, USUAL_BUDGET)
    problem = scenes.problem(scene)
    result = method.solve(problem, value, budget)
    if first and result.seconds < LONG:  # the first call compiles and warms caches
        result = method.solve(problem, value, budget)

    errors = scenes.errors(problem, scenes.answer(scene), result)
    further = math.nan
    finished = result.outcome is RunStatus.FINISHED
    if scene in scenes.JUDGED and finished and result.seconds < QUICK:
        span = FURTHER * problem.span
        longer = method.solve(replace(problem, t_end=problem.t_end + span), value, budget)
        if longer.outcome is RunStatus.FINISHED:
            further = (longer.seconds - result.seconds) / span
    return {
        "scene": scene,
        "method": name,
        "setting": value,
        "verdict": errors.verdict.name.lower(),
        "seconds": result.seconds,
        "cost": result.seconds / problem.span,
        "further": further,
        "event_error": errors.event_time,
        "state_error": errors.state,
        "python": result.glue / max(result.seconds, 1e-9),
        "events": len(result.kinds),
        "separations": result.kinds.count("separation"),
    }, result.outcome


# ---- Costs at equal error


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
    cheaper = np.concatenate([[np.inf], errors[:-1]])
    best = errors < np.minimum.accumulate(cheaper)
    errors = errors[best]
    costs = known[cost].to_numpy()[best]
    wanted = max(wanted, FLOOR)
    if not errors[-1] <= wanted:
        return math.nan
    return float(np.exp(np.interp(-math.log(wanted), -np.log(errors), np.log(costs))))


def costs_of_methods(points: pd.DataFrame) -> pd.DataFrame:
    """Return costs by method, cheapest first, nan where a method reaches no such accuracy.

    Of the scenes `scenes.JUDGED` these are multiples of the series engine's cost of a further second
    at its default, where events are correct to `DEFAULT` s, or to its own error if that is larger.
    Of ``rigid`` it is the time of a simulated second at an error of `scenes.CONVERGED`, ms.
    """
    columns = {}
    for scene in scenes.JUDGED:
        part = points[points["scene"] == scene]
        own = at_default(part).iloc[0]
        wanted = max(DEFAULT, own["event_error"])
        costs = {name: cost_at(line, wanted) for name, line in part.groupby("method")}
        costs["series"] = own["further"]
        columns[scene] = pd.Series(costs) / own["further"]
    on_rigid_disc = {
        name: 1e3 * cost_at(line, scenes.CONVERGED, "cost")
        for name, line in points[points["scene"] == "rigid"].groupby("method")
    }
    table = pd.DataFrame({**columns, "rigid": pd.Series(on_rigid_disc, dtype=float)})
    order = table[[*columns]].min(axis=1).fillna(math.inf)
    return table.loc[order.sort_values(kind="stable").index].dropna(how="all")


def at_default(points: pd.DataFrame) -> pd.DataFrame:
    """Return the points of the series engine at its default tolerance."""
    return points[(points["method"] == "series") & (points["setting"] == DEFAULT)]
