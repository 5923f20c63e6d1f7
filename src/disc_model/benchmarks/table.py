"""The measured points as a table, and what they come to in a few words."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from disc_model.benchmarks import scenes
from disc_model.benchmarks.methods import METHODS
from disc_model.benchmarks.scenes import JUDGED, VERDICT_WORDS, Verdict
from disc_model.benchmarks.texts import TEXTS
from disc_model.data.dataset import markdown_table

DEFAULT = 1e-10
"""The series engine's default tolerance, and the event-time error (s) that the others have to reach as well."""


def measured_points(dataset: xr.Dataset) -> pd.DataFrame:
    """A row for each measured point, with what it holds, and what follows:

    further : cost of a further simulated second, setting up left out; where that was not measured, that of the whole
        run, which was so long that it has next to no setting up
    right : whether all events are within ``DEFAULT`` s
    """
    frame = dataset.to_dataframe(dim_order=["scene", "solver", "point"]).reset_index()
    frame = frame[frame["verdict"] != Verdict.NOT_RUN].reset_index(drop=True)
    return frame.assign(
        further=frame["marginal_cost"].fillna(frame["cost"]),
        right=(frame["verdict"] == Verdict.CONVERGED) & (frame["event_error"] <= DEFAULT),
    )


def headline(points: pd.DataFrame) -> dict[str, dict[str, float]]:
    """By scene and method: least cost with events right to ``DEFAULT`` s, over the series engine's at its default.

    points : `measured_points`; costs are those of a further second
    """
    found: dict[str, dict[str, float]] = {}
    good = points[points["right"] & points["scene"].isin(JUDGED)]
    for scene, part in good.groupby("scene", sort=False):
        own = at_default(part)["further"]
        if len(own):
            found[str(scene)] = (part.groupby("solver", sort=False)["further"].min() / own.iloc[0]).to_dict()
    return found


def at_default(points: pd.DataFrame) -> pd.DataFrame:
    """Those of the series engine at its default."""
    return points[(points["solver"] == "series") & (points["value"] == DEFAULT)]


def table(dataset: xr.Dataset) -> pd.DataFrame:
    """One row per measured point, with the ratio of its cost to the series engine's at the same event-time error.

    ``times_series`` is cost over the cost at which the series engine (interpolated in log-log between its points, or
    its finest point if it is more accurate than asked) reaches the same or a smaller event-time error.
    """
    points = measured_points(dataset)
    series = points[points["solver"] == "series"]
    yardsticks = [_cost_at(series[series["scene"] == p.scene], p.event_error) for p in points.itertuples()]
    columns = {
        "scene": points["scene"],
        "method": points["solver"],
        "setting": [f"{METHODS[name].setting}={x:.3g}" for name, x in points[["solver", "value"]].to_numpy()],
        "verdict": [VERDICT_WORDS[verdict] for verdict in points["verdict"]],
        "seconds_per_simulated_second": points["cost"],
        "event_time_error": points["event_error"],
        "state_error": points["state_error"],
        "events": points["events"].astype(int),
        "separations": points["separations"].astype(int),
        "order_event": points["order_event"],
        "order_state": points["order_state"],
        "order_theory": points["order_theory"],
        "times_series": points["cost"] / yardsticks,
        "repeats": points["repeats"].astype(int),
    }
    return pd.DataFrame(columns)


def _cost_at(line: pd.DataFrame, wanted: Any) -> float:
    """Cost of the cheapest point of a line whose event-time error is at most the one asked for, or of the finest."""
    known = line[np.isfinite(line["event_error"])]
    if not math.isfinite(wanted) or known.empty:
        return math.nan
    reached = known["cost"][known["event_error"] <= wanted]
    return float(reached.min() if len(reached) else known["cost"][known["event_error"].idxmin()])


def to_markdown(dataset: xr.Dataset) -> str:
    """The table as Markdown, a section a scene, with the machine above and the orders beside each method."""
    frame, ratios = table(dataset), headline(measured_points(dataset))
    headlines = [
        {"title": scenes.TITLES[scene], "others": [{"label": label, "ratio": ratio} for ratio, label in others]}
        for scene, found in ratios.items()
        if (others := sorted((ratio, METHODS[name].label) for name, ratio in found.items() if name != "series"))
    ]
    sections = []
    for scene, part in frame.groupby("scene", sort=False):
        columns = {
            "method": [METHODS[name].label for name in part["method"]],
            "setting": part["setting"],
            "verdict": part["verdict"].str.replace("_", " "),
            "cost": part["seconds_per_simulated_second"].map(_short),
            "event-time error (s)": part["event_time_error"].map(_short),
            "state error": part["state_error"].map(_short),
            "events": part["events"],
            "order": [*map(_order_text, part["order_event"], part["order_theory"])],
            "x series": part["times_series"].map(_short),
        }
        lines = markdown_table(columns, zip(*columns.values(), strict=True))
        sections.append({"title": scenes.TITLES[str(scene)], "table": "\n".join(lines)})
    return TEXTS["table"].fill(machine=dataset.attrs["machine"], headlines=headlines, scenes=sections)


def _short(x: float) -> str:
    return f"{x:.2g}" if math.isfinite(x) else "-"


def _order_text(found: float, theory: float) -> str:
    if not math.isfinite(found):
        return "-"
    return f"{found:.1f} ({theory:.2g})" if math.isfinite(theory) else f"tol^{found:.2f}"
