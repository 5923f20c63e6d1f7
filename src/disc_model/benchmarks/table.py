"""The measured points as a table, and what they come to in a few words."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from disc_model.benchmarks import scenes
from disc_model.benchmarks.methods import METHODS
from disc_model.benchmarks.scenes import JUDGED, VERDICT_WORDS, Verdict
from disc_model.data.dataset import markdown_table

DEFAULT = 1e-10
"""The series engine's default tolerance, and the event-time error (s) that the others have to reach as well."""
HEAD = ("method", "setting", "verdict", "cost", "event-time error (s)", "state error", "events", "order", "x series")


def headline(dataset: xr.Dataset) -> dict[str, dict[str, float]]:
    """By scene and method: least cost with events right to ``DEFAULT`` s, over the series engine's at its default.

    Costs are those of a further second (`costs`).
    """
    found: dict[str, dict[str, float]] = {}
    for scene in (str(name) for name in dataset["scene"].values if str(name) in JUDGED):
        part = dataset.sel(scene=scene)
        own = right(part.sel(solver="series")) & (part.sel(solver="series")["value"].values == DEFAULT)
        if not own.any():
            continue
        cost = float(costs(part.sel(solver="series"))[own][0])
        found[scene] = {}
        for method in map(str, part["solver"].values):
            line = part.sel(solver=method)
            if right(line).any():
                found[scene][method] = float(costs(line)[right(line)].min()) / cost
    return found


def costs(line: xr.Dataset) -> np.ndarray:
    """Cost of a further simulated second, setting up left out; where that was not measured, that of the whole run.

    Shape as the line's.  A run so long that only its whole was measured has next to no setting up.
    """
    further = line["marginal_cost"].values
    return np.where(np.isfinite(further), further, line["cost"].values)


def right(line: xr.Dataset) -> np.ndarray:
    """Which points of a line have all events within ``DEFAULT`` s."""
    return (line["verdict"].values == int(Verdict.CONVERGED)) & (line["event_error"].values <= DEFAULT)


def _headline_text(dataset: xr.Dataset) -> Iterator[str]:
    for scene, ratios in headline(dataset).items():
        others = sorted((ratio, METHODS[name].label) for name, ratio in ratios.items() if name != "series")
        if others:
            listed = ", ".join(f"{label} {ratio:.3g}" for ratio, label in others)
            yield f"Times slower than the series engine at its default, {scenes.TITLES[scene]}, event-time error within"
            yield from (f"1e-10 s: {listed}.", "")


def _arithmetic_text(dataset: xr.Dataset) -> Iterator[str]:
    if "flops" not in dataset:
        return
    for scene in (str(name) for name in dataset["scene"].values if np.isfinite(dataset["flops"].sel(scene=name))):
        line, flops = dataset.sel(scene=scene, solver="series"), float(dataset["flops"].sel(scene=scene))
        cost = float(line["cost"].values[line["value"].values == DEFAULT][0])
        yield f"{scenes.TITLES[scene]}: {flops / 1e6:.1f} MFlop in vectors per simulated second at tol=1e-10,"
        yield from (f"{flops / cost / 1e9:.1f} GFlop/s.", "")


def table(dataset: xr.Dataset) -> pd.DataFrame:
    """One row per measured point, with the ratio of its cost to the series engine's at the same event-time error.

    ``times_series`` is cost over the cost at which the series engine (interpolated in log-log between its points, or
    its finest point if it is more accurate than asked) reaches the same or a smaller event-time error.
    """
    rows = [row for scene in dataset["scene"].values for row in _scene_rows(dataset, str(scene))]
    return pd.DataFrame(rows)


def _scene_rows(dataset: xr.Dataset, scene: str) -> Iterator[dict[str, Any]]:
    part = dataset.sel(scene=scene)
    yardstick = _cost_at(part.sel(solver="series")) if "series" in part["solver"].values else None
    for method in part["solver"].values:
        line = part.sel(solver=method)
        for i in range(line.sizes["point"]):
            point = line.isel(point=i)
            if int(point["verdict"]) == Verdict.NOT_RUN:
                continue
            error = float(point["event_error"])
            yield {
                "scene": scene,
                "method": str(method),
                "setting": f"{METHODS[str(method)].setting}={float(point['value']):.3g}",
                "verdict": VERDICT_WORDS[int(point["verdict"])],
                "seconds_per_simulated_second": float(point["cost"]),
                "event_time_error": error,
                "state_error": float(point["state_error"]),
                "events": int(point["events"]),
                "separations": int(point["separations"]),
                "order_event": float(line["order_event"]),
                "order_state": float(line["order_state"]),
                "order_theory": float(line["order_theory"]),
                "times_series": float(point["cost"]) / yardstick(error) if yardstick else math.nan,
                "repeats": int(point["repeats"]),
            }


def _cost_at(line: xr.Dataset) -> Callable[[float], float]:
    """Cost of the cheapest point of a line whose event-time error is at most the one asked for."""
    good = np.isfinite(line["event_error"].values)
    error, cost = line["event_error"].values[good], line["cost"].values[good]

    def cost_at(wanted: float) -> float:
        if not math.isfinite(wanted) or error.size == 0:
            return math.nan
        reached = cost[error <= wanted]
        return float(reached.min()) if reached.size else float(cost[np.argmin(error)])

    return cost_at


def to_markdown(dataset: xr.Dataset) -> str:
    """The table as Markdown, a section a scene, with the machine above and the orders beside each method."""
    frame = table(dataset)
    text = ["# Speed against accuracy", "", f"Machine: {dataset.attrs['machine']}, one core. Medians of repeats.", ""]
    text += [*_headline_text(dataset), *_arithmetic_text(dataset)]
    text += [
        "Cost is seconds of wall time per simulated second; `x series` is cost over that of the series engine at the",
        "same or a smaller event-time error, in the same run. A dash: events are missing or invented.",
        "",
    ]
    for scene in dict.fromkeys(frame["scene"]):
        text += [f"## {scenes.TITLES[scene]}", ""]
        rows = (
            (
                METHODS[row.method].label,
                row.setting,
                row.verdict.replace("_", " "),
                _short(row.seconds_per_simulated_second),
                _short(row.event_time_error),
                _short(row.state_error),
                row.events,
                _order_text(row.order_event, row.order_theory),
                _short(row.times_series),
            )
            for row in frame[frame["scene"] == scene].itertuples()
        )
        text += [*markdown_table(HEAD, rows), ""]
    return "\n".join(text)


def _short(x: float) -> str:
    return f"{x:.2g}" if math.isfinite(x) else "-"


def _order_text(found: float, theory: float) -> str:
    if not math.isfinite(found):
        return "-"
    return f"{found:.1f} ({theory:.2g})" if math.isfinite(theory) else f"tol^{found:.2f}"
