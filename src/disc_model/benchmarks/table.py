"""The measured points as a table, and costs at equal error."""

import math

import numpy as np
import pandas as pd
import xarray as xr

from disc_model.benchmarks.grid import TABLES, words
from disc_model.benchmarks.registry import METHODS
from disc_model.benchmarks.scenes import JUDGED, Verdict

DEFAULT = 1e-10
"""The series engine's default tolerance, and the event-time error (s) required of the other methods."""
FLOOR = 1e-15
"""Errors below this count as equal, zero among them, s."""
SHOWN = TABLES["work_precision_table"]
"""Variables by the column of the table that shows them."""


def measured_points(dataset: xr.Dataset) -> pd.DataFrame:
    """One row for each measured point, with its values and a derived column:

    further : cost of a further simulated second without setting up; where it was not measured, that of the whole run,
        which was so long that setting up is negligible
    """
    frame = dataset.to_dataframe(dim_order=["scene", "solver", "point"]).reset_index()
    frame = frame[frame["verdict"] != Verdict.NOT_RUN].reset_index(drop=True)
    return frame.assign(further=frame["marginal_cost"].fillna(frame["cost"]))


def headline(points: pd.DataFrame) -> dict[str, dict[str, float]]:
    """Cost with events correct to ``DEFAULT`` s over that of the series engine at its default, by scene and method.

    Costs are those of a further second, at that error by `cost_at`.  If the series engine's own error is larger, all
    methods are allowed that error.

    points : `measured_points`
    """
    found: dict[str, dict[str, float]] = {}
    for scene in JUDGED:
        part = points[points["scene"] == scene]
        own = at_default(part)
        if len(own) and math.isfinite(error := own["event_error"].to_numpy()[0]):
            costs = {name: cost_at(line, max(DEFAULT, error)) for name, line in part.groupby("solver", sort=False)}
            costs["series"] = float(own["further"].to_numpy()[0])
            found[scene] = {str(name): cost / costs["series"] for name, cost in costs.items() if math.isfinite(cost)}
    return found


def cost_at(line: pd.DataFrame, wanted: float, cost: str = "further") -> float:
    """Cost at which a line reaches an event-time error (s): interpolated in log-log; nan if no setting is as accurate.

    A setting counts only if no cheaper one is as accurate; nothing is extrapolated to coarser settings.
    """
    known = line[np.isfinite(line["event_error"])].sort_values(cost)
    errors = np.maximum(known["event_error"].to_numpy(), FLOOR)
    best = errors < np.minimum.accumulate(np.concatenate([[np.inf], errors[:-1]])) if len(known) else []
    errors, costs = errors[best], known[cost].to_numpy()[best]
    if not len(errors) or not errors[-1] <= max(wanted, FLOOR):
        return math.nan
    return float(np.exp(np.interp(-math.log(max(wanted, FLOOR)), -np.log(errors), np.log(costs))))


def at_default(points: pd.DataFrame) -> pd.DataFrame:
    """Points of the series engine at its default."""
    return points[(points["solver"] == "series") & (points["value"] == DEFAULT)]


def table(dataset: xr.Dataset) -> pd.DataFrame:
    """One row per measured point; ``times_series``: its cost over the series engine's at that error, by `cost_at`."""
    points = measured_points(dataset)
    series = points[points["solver"] == "series"]
    wanted = zip(points["scene"], points["event_error"], strict=True)
    yardsticks = [cost_at(series[series["scene"] == scene], error, "cost") for scene, error in wanted]
    derived = points.assign(
        setting=[f"{METHODS[name].setting}={x:.3g}" for name, x in points[["solver", "value"]].to_numpy()],
        verdict=[words(Verdict)[verdict] for verdict in points["verdict"]],
        times_series=points["cost"] / yardsticks,
    )
    counts = dict.fromkeys(("events", "separations", "repeats"), int)
    return derived.astype(counts)[[*SHOWN.values()]].set_axis([*SHOWN], axis=1)
