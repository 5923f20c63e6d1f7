"""Benchmark results in README and docs: numbers, the benchmark's page, and passages of other pages.

`summary` extracts the numbers from the datasets of one run, which are stored as ``docs/benchmark.json``.  All texts are
written from that file, so that one run refreshes every number, and a test detects outdated pages.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from disc_model.benchmarks.answers import report
from disc_model.benchmarks.answers.measure import LINES
from disc_model.benchmarks.answers.questions import QUESTIONS
from disc_model.benchmarks.methods import METHODS
from disc_model.benchmarks.scenes import CONVERGED, JUDGED
from disc_model.benchmarks.table import DEFAULT, at_default, cost_at, headline, measured_points
from disc_model.benchmarks.texts import TEXTS, plain
from disc_model.data.dataset import markdown_table
from disc_model.errors import DiscModelError

LETTERS = dict(zip(JUDGED, "ab", strict=True))
"""Panel letters of the scenes in the overview."""
FIGURES = ("overview", "failure_maps", "answers", "prices", "answer_maps", "contact_truncation")
"""Figures that are shown in docs/gallery."""
Summary = Mapping[str, Any]


def summary(work_precision: xr.Dataset, as_avx2: xr.Dataset, answers: xr.Dataset) -> dict[str, Any]:
    """Numbers of a run for the pages; ``as_avx2`` is of kernels compiled for a processor with AVX2 only.

    Raises
    ------
    disc_model.errors.DiscModelError
        If they were not measured on the same machine.
    """
    machines = {dataset.attrs["machine"] for dataset in (work_precision, as_avx2, answers)}
    if len(machines) > 1:
        raise DiscModelError(
            f"the datasets are of one machine each, {' and '.join(sorted(machines))}: measure all anew"
        )
    points, narrow = measured_points(work_precision), measured_points(as_avx2)
    asked = [name for name in QUESTIONS if name in answers["answer"].values]
    return {
        "machine": machines.pop(),
        "versions": json.loads(work_precision.attrs["versions"]),
        "own": _own(points),
        "times_slower": headline(points),
        "as_avx2": {"own": _own(narrow), "heyoka": {scene: x.get("heyoka") for scene, x in headline(narrow).items()}},
        "glue": _glue(points),
        "whole_call": _whole_call(points),
        "stiff": _stiff(points),
        "models": {name: _models(report.points(answers, name)) for name in asked},
        "prices": {name: _prices(report.points(answers, name)) for name in asked},
    }


def _models(found: pd.DataFrame) -> dict[str, str]:
    """Numbers of nodal diameters with which a reduced model answers correctly, by its contact."""
    lines = {model: found[found["line"] == model] for model in report.MODELS}
    return {model: report.right_numbers(line) for model, line in lines.items() if len(line)}


def _own(points: pd.DataFrame) -> dict[str, dict[str, Any]]:
    """Cost and error of the series engine at its default, by scene."""
    default = at_default(points[points["scene"].isin(JUDGED)])
    return {str(p.scene): {"cost": p.further, "error": p.event_error} for p in default.itertuples()}


def _prices(found: pd.DataFrame) -> dict[str, dict[str, Any]]:
    """Cheapest correct answer, and settings that answer wrongly without a warning, by name of the line."""
    table: dict[str, dict[str, Any]] = {}
    for label, line in found[~found["line"].isin(report.MODELS)].groupby("label", sort=False):
        best = line[line["correct"]].nsmallest(1, "seconds")
        seconds, at = next(zip(best["seconds"], best["at"], strict=True), (None, None))
        table[str(label)] = {"seconds": seconds, "at": at, "wrong": line["setting"][line["wrong"]].tolist()}
    return table


def _whole_call(points: pd.DataFrame) -> dict[str, float]:
    """Seconds of a whole call of `simulate` for the first scene's second, and the ratio of heyoka's time to it.

    heyoka's time is that of its integration alone, at the error of `headline`.
    """
    part = points[points["scene"] == JUDGED[0]]
    if part.empty:
        return {}
    found = {"seconds": float(part["whole_call"].iloc[0])}
    rival = cost_at(part[part["solver"] == "heyoka"], DEFAULT, "seconds")
    return found | ({"heyoka": rival / found["seconds"]} if math.isfinite(rival) else {})


def _glue(points: pd.DataFrame) -> dict[str, float]:
    """Fraction of heyoka's time spent in Python between its phases, by scene, at the setting nearest to `DEFAULT`."""
    own = points[(points["solver"] == "heyoka") & points["scene"].isin(JUDGED) & points["glue"].notna()]
    nearest = np.abs(np.log(own["event_error"] / DEFAULT)).groupby(own["scene"]).idxmin()
    return {scene: float(own["glue"][nearest[scene]]) for scene in JUDGED if scene in nearest}


def _stiff(points: pd.DataFrame) -> dict[str, float]:
    """Seconds per simulated second with converged events on the almost rigid disc, by method."""
    lines = points[points["scene"] == "rigid"].groupby("solver")
    costs = pd.Series({str(name): cost_at(line, CONVERGED, "cost") for name, line in lines}, dtype=float)
    return dict(costs.dropna().sort_values())


# ----------------------------------------------------------------------------------------------------
# Passages


def passages(run: Summary) -> dict[str, str]:
    """Texts by the name that pages refer to."""
    first = run["prices"]["first_separation"]["series (this package)"]
    cycle = run["prices"]["growth_rate"]["series, from the cycle itself"]
    return {
        "first_separation": f"{1e3 * first['seconds']:.0f} ms with `{first['at']}`",
        "cycle": f"{1e3 * cycle['seconds']:.2g} ms",
        "speed": _speed(run),
        "prices": TEXTS["prices"].text,
    }


def _speed(run: Summary) -> str:
    """Cost of a simulated second, and its ratio for the other methods."""
    own, slower, call, narrow = run["own"], run["times_slower"], run["whole_call"], run["as_avx2"]
    costs = {
        name: [*(found.get(name, math.nan) for found in slower.values()), stiff]
        for name, stiff in _methods(run).items()
    }
    rows = [
        [METHODS[name].label, *("-" if math.isnan(cost) else plain(cost) for cost in line)]
        for name, line in costs.items()
    ]
    head = ("method", *(f"({LETTERS[scene]}), times" for scene in slower), "(d), ms")
    return TEXTS["speed"].fill(
        machine=run["machine"],
        own=_milliseconds(own),
        errors=[{"error": cost["error"]} for cost in own.values()],
        table="\n".join(markdown_table(head, rows)),
        narrow=_milliseconds(narrow["own"]),
        narrowly=[{"times": times} for times in narrow["heyoka"].values() if times],
        glue=[{"letter": LETTERS[scene], "share": 100.0 * share} for scene, share in run["glue"].items()],
        call=[{"ms": 1e3 * call["seconds"], "times": call["heyoka"]}] if "heyoka" in call else [],
    )


def _methods(run: Summary) -> dict[str, float]:
    """Methods with a cost in any scene, cheapest first, and their cost (ms) on the almost rigid disc."""
    slower, stiff = run["times_slower"].values(), run["stiff"]
    times = {name: min(found.get(name, math.inf) for found in slower) for found in slower for name in found}
    names = [*sorted(times, key=lambda name: times[name]), *(name for name in stiff if name not in times)]
    return {name: 1e3 * stiff.get(name, math.nan) for name in names}


def _milliseconds(own: Mapping[str, Mapping[str, float]]) -> list[dict[str, Any]]:
    return [{"ms": 1e3 * cost["cost"], "letter": LETTERS[scene]} for scene, cost in own.items()]


def fill(text: str, known: Mapping[str, str]) -> str:
    """A page whose passages, ``<!-- bench NAME -->...<!-- end -->``, are written anew.

    Raises
    ------
    disc_model.errors.DiscModelError
        For a name that is not known.
    """

    def passage(match: re.Match[str]) -> str:
        name = match["name"]
        if name not in known:
            raise DiscModelError(f"no passage of the benchmark is called {name!r}; there are {', '.join(known)}")
        return f"<!-- bench {name} -->{known[name]}<!-- end -->"

    return re.sub(r"<!-- bench (?P<name>\w+) -->.*?<!-- end -->", passage, text, flags=re.DOTALL)


def page(run: Summary) -> str:
    """The page of the benchmark."""
    lines = dict.fromkeys(label for table in run["prices"].values() for label in table)
    rows = [[label, *(_price(table.get(label)) for table in run["prices"].values())] for label in lines]
    for model in report.MODELS:
        found = (run["models"][name].get(model) for name in run["prices"])
        rows.append([LINES[model][0], *("-" if right is None else right or "no number" for right in found)])
    head = (
        "method",
        *(
            f"{own.title}, to {report.within(own.enough, own.units)}"
            for own in (QUESTIONS[name] for name in run["prices"])
        ),
    )
    table = "\n".join(markdown_table(head, rows))
    return TEXTS["page"].fill(machine=run["machine"], speed=_speed(run), table=table)


def _price(cell: Mapping[str, Any] | None) -> str:
    if cell is None:
        return "-"
    wrong = f"wrong at {', '.join(f'{setting:g}' for setting in cell['wrong'])}" if cell["wrong"] else ""
    if cell["seconds"] is None:
        return wrong or "no answer"
    return f"{plain(cell['seconds'])} s ({'; '.join(filter(None, (cell['at'], wrong)))})"
