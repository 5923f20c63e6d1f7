"""Write what README and docs say about speed, and their pictures of it, from the datasets of one
run of the benchmark.

The numbers of the run are stored as ``docs/benchmark.json``. All passages are written from this
file, by ``benchmark_passages.jinja``, so that one run refreshes every number, and a test detects
outdated pages. What was not measured is left as it was.
"""

import json
import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import jinja2
import numpy as np
import pandas as pd
import xarray as xr
from docs.make_gallery import shrink

from disc_model.benchmarks.answers import in_words
from disc_model.benchmarks.methods import METHODS
from disc_model.benchmarks.scenes import CONVERGED, JUDGED
from disc_model.benchmarks.work_precision import DEFAULT, cost_at, measured_points
from disc_model.data.dataset import load, markdown_table
from disc_model.errors import DiscModelError, script

SPEED = {"work_precision", "work_precision_avx2", "answers"}
"""Measurements for the passages on speed."""
PAGES = ("README.md", "docs/method.md", "docs/benchmark.md")
"""Pages with passages."""
FIGURES = ("overview", "failure_maps", "prices", "answer_maps", "contact_truncation", "scaling")
"""Figures that are shown in docs/gallery."""
LETTERS = dict(zip(JUDGED, "ab", strict=True))
"""Panel letters of the scenes in the overview."""
Rows = list[dict[str, Any]]
Table = dict[str, dict[Any, Any]]
"""Cells by the names of line and column."""


# ----------------------------------------------------------------------------------------------------
# Numbers of a run


def speed_numbers(
    work_precision: xr.Dataset, as_avx2: xr.Dataset, answers: xr.Dataset
) -> dict[str, Any]:
    """Numbers of a run for the pages; ``as_avx2`` is of kernels compiled for a processor with AVX2
    only.

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
    return {
        "machine": machines.pop(),
        "versions": json.loads(work_precision.attrs["versions"]),
        "own": _own(points),
        "narrow": _own(narrow),
        "narrowly": [
            {"times": times["heyoka"]} for times in headline(narrow).values() if "heyoka" in times
        ],
        "glue": _glue(points[points["solver"] == "heyoka"]),
        "call": _whole_call(points[points["scene"] == JUDGED[0]]),
        "costs": _costs(points),
        "cycle": _cycle(in_words(answers)),
    }


def at_default(points: pd.DataFrame) -> pd.DataFrame:
    return points[(points["solver"] == "series") & (points["value"] == DEFAULT)]


def headline(points: pd.DataFrame) -> dict[str, dict[str, float]]:
    """Cost of a further second with events correct to `DEFAULT` s, or to the series engine's own
    error if that is larger, over the cost of the series engine at its default, by scene and
    method."""
    ratios: dict[str, dict[str, float]] = {}
    for scene in JUDGED:
        part = points[points["scene"] == scene]
        for _, series in at_default(part).dropna(subset="event_error").iterrows():
            error = max(DEFAULT, series["event_error"])
            costs = {
                str(name): cost_at(line, error) for name, line in part.groupby("solver", sort=False)
            }
            costs["series"] = series["further"]
            ratios[scene] = {
                name: cost / costs["series"] for name, cost in costs.items() if math.isfinite(cost)
            }
    return ratios


def _own(points: pd.DataFrame) -> Rows:
    """Cost (ms) and error (s) of the series engine at its default, by scene."""
    found = at_default(points[points["scene"].isin(JUDGED)])
    return [
        {"letter": LETTERS[p["scene"]], "ms": 1e3 * p["further"], "error": p["event_error"]}
        for p in found.to_dict("records")
    ]


def _whole_call(points: pd.DataFrame) -> Rows:
    """Milliseconds of a whole call of `simulate` for the first scene's second, and the ratio of
    heyoka's time to it.

    heyoka's time is that of its integration alone, at the error of `headline`.
    """
    rival = cost_at(points[points["solver"] == "heyoka"], DEFAULT, "seconds")
    calls = points["whole_call"].dropna().head(1)
    return [{"ms": 1e3 * call, "times": rival / call} for call in calls if math.isfinite(rival)]


def _glue(heyoka: pd.DataFrame) -> Rows:
    """Percentage of heyoka's time spent in Python between its phases, by scene, at the setting
    nearest to `DEFAULT`."""
    known = heyoka[heyoka["glue"].notna() & heyoka["scene"].isin(JUDGED)]
    off = np.abs(np.log(known["event_error"] / DEFAULT))
    nearest = known.loc[off.groupby(known["scene"], sort=False).idxmin()]
    return [
        {"letter": LETTERS[p["scene"]], "share": 100.0 * p["glue"]}
        for p in nearest.to_dict("records")
    ]


def _costs(points: pd.DataFrame) -> Table:
    """Cost by method, cheapest first: times that of the series engine, and on the almost rigid disc
    in ms a second."""
    times = {
        f"({LETTERS[scene]}), times": pd.Series(found) for scene, found in headline(points).items()
    }
    rigid = points[points["scene"] == "rigid"].groupby("solver")
    stiff = pd.Series(
        {name: 1e3 * cost_at(line, CONVERGED, "cost") for name, line in rigid}, dtype=float
    )
    table = pd.DataFrame({**times, "(d), ms": stiff})
    table = (
        table.assign(least=table[[*times]].min(axis=1))
        .sort_values(["least", "(d), ms"])
        .drop(columns="least")
    )
    return {
        METHODS[str(name)].label: line.dropna().to_dict()
        for name, line in table.iterrows()
        if line.notna().any()
    }


def _cycle(found: pd.DataFrame) -> Rows:
    """Least time of a correct growth rate from the cycle itself, ms."""
    right = found[
        (found["line"] == "cycle")
        & (found["answer"] == "growth_rate")
        & (found["verdict"] == "right")
    ]
    return [{"ms": 1e3 * seconds} for seconds in right["seconds"].nsmallest(1)]


def scaling_numbers(scaling: xr.Dataset) -> dict[str, dict[str, Rows]]:
    """Rows of `disc_model.benchmarks.scaling`, with the ms of a point, by what varies and the
    quantity."""
    numbers: dict[str, Any] = {}
    for row in scaling.to_dataframe().to_dict("records"):
        row["ms"] = 1e3 * row["seconds"] / row["points"]
        numbers.setdefault(row.pop("varies"), {}).setdefault(row.pop("quantity"), []).append(row)
    return numbers


# ----------------------------------------------------------------------------------------------------
# Passages


def passages(speed: Mapping[str, Any]) -> dict[str, str]:
    """Texts from `speed_numbers`, by the names that pages refer to."""
    heads = [*(f"({row['letter']}), times" for row in speed["own"]), "(d), ms"]
    rows = [
        {"method": label} | {head: _cell(line.get(head)) for head in heads}
        for label, line in speed["costs"].items()
    ]
    frame = pd.DataFrame(rows)
    table = "\n".join(markdown_table(frame.columns, frame.itertuples(index=False)))
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(Path(__file__).parent),
        undefined=jinja2.StrictUndefined,
        autoescape=False,
    )
    environment.filters["each"] = lambda rows, text, between=" and ": between.join(
        text.format(**row) for row in rows
    )
    environment.filters["times"] = lambda number: f"{plain(number)} times" if number else "-"
    template = environment.get_template("benchmark_passages.jinja")
    context = template.new_context({"speed": speed, "costs_table": table})
    return {name: "".join(block(context)) for name, block in template.blocks.items()}


def plain(number: float) -> str:
    """A number with two digits, without a power of ten."""
    return f"{float(f'{number:.2g}'):,.10g}"


def _cell(cost: float | None) -> str:
    return "-" if cost is None else plain(cost)


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
            raise DiscModelError(
                f"no passage of the benchmark is called {name!r}; there are {', '.join(known)}"
            )
        return f"<!-- bench {name} -->{known[name]}<!-- end -->"

    return re.sub(r"<!-- bench (?P<name>\w+) -->.*?<!-- end -->", passage, text, flags=re.DOTALL)


# ----------------------------------------------------------------------------------------------------
# Files


@script
def main(bench: str = "results/bench", root: str = "") -> None:
    folder, top = Path(bench), Path(root)
    measured = {name: folder / f"{name}.nc" for name in sorted(SPEED)}
    there = {name: load(path).to_dataset() for name, path in measured.items() if path.is_file()}
    stored = top / "docs" / "benchmark.json"
    run = json.loads(stored.read_text(encoding="utf-8"))
    if there.keys() == SPEED:
        run |= speed_numbers(
            there["work_precision"], there["work_precision_avx2"], there["answers"]
        )
    if (scaling := folder / "scaling.nc").is_file():
        run["scaling"] = scaling_numbers(load(scaling).to_dataset())
    stored.write_text(json.dumps(run, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    known = passages(run)
    for page in (top / name for name in PAGES):
        page.write_text(fill(page.read_text(encoding="utf-8"), known), encoding="utf-8")
    for name in FIGURES:
        source = folder / "figures" / f"{name}.png"
        if source.is_file():  # else the picture stays as it was
            shrink(source, top / "docs" / "gallery" / f"{name}.png")
