"""Write what README and docs say about speed, and their pictures of it, from one run of the benchmark.

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

from benchmarks import work_precision
from benchmarks.answers import in_words
from benchmarks.methods import METHODS
from benchmarks.scenes import CONVERGED, JUDGED
from disc_model.data.dataset import load_tree, markdown_table
from disc_model.errors import DiscModelError, script

SPEED = {"work_precision", "work_precision_avx2", "answers"}
"""Measurements for the passages on speed."""
PAGES = ("README.md", "docs/method.md", "docs/benchmark.md")
"""Pages with passages."""
FIGURES = ("overview",)
"""Figures that are shown in docs/gallery."""
LETTERS = dict(zip(JUDGED, "ab", strict=True))
"""Panel letters of the scenes in the overview."""
PARTS_OF_TIME = {
    "simulation": "simulation",
    "newton": "Newton's method",
    "return_maps": "other return maps",
    "rest": "everything else",
}
"""Heads of a table by variables of `benchmarks.shares`."""
Rows = list[dict[str, Any]]
Table = dict[str, dict[Any, Any]]
"""Cells by the names of line and column."""


# ---- Numbers of a run


def speed_numbers(measured: xr.Dataset, as_avx2: xr.Dataset, answers: xr.Dataset) -> dict[str, Any]:
    """Return numbers of a run for the pages.

    Parameters
    ----------
    measured : speed against accuracy
    as_avx2 : the same of kernels compiled for a processor with AVX2 only
    answers : costs of answers

    Raises
    ------
    disc_model.errors.DiscModelError
        If they were not measured on the same machine.
    """
    machines = {dataset.attrs["machine"] for dataset in (measured, as_avx2, answers)}
    if len(machines) > 1:
        raise DiscModelError(
            f"the datasets are of one machine each, {' and '.join(sorted(machines))}: measure all anew"
        )
    points = work_precision.measured_points(measured)
    narrow = work_precision.measured_points(as_avx2)
    narrowly = []
    for times in headline(narrow).values():
        if "heyoka" in times:
            narrowly.append({"times": times["heyoka"]})
    return {
        "machine": machines.pop(),
        "versions": json.loads(measured.attrs["versions"]),
        "own": _own(points),
        "narrow": _own(narrow),
        "narrowly": narrowly,
        "glue": _glue(points[points["solver"] == "heyoka"]),
        "call": _whole_call(points[points["scene"] == JUDGED[0]]),
        "costs": _costs(points),
        "cycle": _cycle(in_words(answers)),
    }


def at_default(points: pd.DataFrame) -> pd.DataFrame:
    """Return the points of the series engine at its default tolerance."""
    default = points["value"] == work_precision.DEFAULT
    return points[(points["solver"] == "series") & default]


def headline(points: pd.DataFrame) -> dict[str, dict[str, float]]:
    """Return costs of a further second over that of the series engine, by scene and method.

    Events are correct to `work_precision.DEFAULT` s, or to the series engine's own error if that is
    larger.
    """
    ratios: dict[str, dict[str, float]] = {}
    for scene in JUDGED:
        part = points[points["scene"] == scene]
        for series in at_default(part).dropna(subset="event_error").to_dict("records"):
            error = max(work_precision.DEFAULT, series["event_error"])
            costs = {}
            for name, line in part.groupby("solver", sort=False):
                costs[str(name)] = work_precision.cost_at(line, error)
            costs["series"] = series["further"]
            ratios[scene] = {
                name: cost / costs["series"] for name, cost in costs.items() if math.isfinite(cost)
            }
    return ratios


def _own(points: pd.DataFrame) -> Rows:
    """Return cost (ms) and error (s) of the series engine at its default, by scene."""
    rows = []
    for point in at_default(points[points["scene"].isin(JUDGED)]).to_dict("records"):
        rows.append(
            {
                "letter": LETTERS[point["scene"]],
                "ms": 1e3 * point["further"],
                "error": point["event_error"],
            }
        )
    return rows


def _whole_call(points: pd.DataFrame) -> Rows:
    """Return the time of a whole call of `simulate` for the first scene's second, ms.

    With it comes heyoka's time over it: that of its integration alone, at the error of `headline`.
    """
    heyoka = points[points["solver"] == "heyoka"]
    rival = work_precision.cost_at(heyoka, work_precision.DEFAULT, "seconds")
    calls = points["whole_call"].dropna()
    if calls.empty or not math.isfinite(rival):
        return []
    call = calls.iloc[0]
    return [{"ms": 1e3 * call, "times": rival / call}]


def _glue(heyoka: pd.DataFrame) -> Rows:
    """Return the percentage of heyoka's time that is spent in Python, by scene.

    It is that at the setting nearest to an error of `work_precision.DEFAULT`.
    """
    known = heyoka[heyoka["glue"].notna() & heyoka["scene"].isin(JUDGED)]
    off = np.abs(np.log(known["event_error"] / work_precision.DEFAULT))
    nearest = known.loc[off.groupby(known["scene"], sort=False).idxmin()]
    rows = []
    for point in nearest.to_dict("records"):
        rows.append({"letter": LETTERS[point["scene"]], "share": 100.0 * point["glue"]})
    return rows


def _costs(points: pd.DataFrame) -> Table:
    """Return costs by method, cheapest first.

    They are times that of the series engine, and on the almost rigid disc ms a second.
    """
    columns = {}
    for scene, ratios in headline(points).items():
        columns[f"({LETTERS[scene]}), times"] = pd.Series(ratios)
    on_rigid_disc = {}
    for name, line in points[points["scene"] == "rigid"].groupby("solver"):
        on_rigid_disc[name] = 1e3 * work_precision.cost_at(line, CONVERGED, "cost")
    table = pd.DataFrame({**columns, "(d), ms": pd.Series(on_rigid_disc, dtype=float)})
    least = table[[*columns]].min(axis=1)
    table = table.assign(least=least).sort_values(["least", "(d), ms"]).drop(columns="least")
    costs: Table = {}
    for method, row in table.iterrows():
        cells = row.dropna().to_dict()
        if cells:
            costs[METHODS[str(method)].label] = cells
    return costs


def _cycle(found: pd.DataFrame) -> Rows:
    """Return the least time of a correct growth rate from the cycle itself, ms."""
    rates = found[(found["line"] == "cycle") & (found["answer"] == "growth_rate")]
    right = rates[rates["verdict"] == "right"]
    return [{"ms": 1e3 * seconds} for seconds in right["seconds"].nsmallest(1)]


def scaling_numbers(scaling: xr.Dataset) -> dict[str, dict[str, Rows]]:
    """Return rows of `benchmarks.scaling` by what varies and the quantity.

    Each has the time of a point, ms.
    """
    numbers: dict[str, Any] = {}
    for row in scaling.to_dataframe().to_dict("records"):
        row["ms"] = 1e3 * row["seconds"] / row["points"]
        of_varied = numbers.setdefault(row.pop("varies"), {})
        of_varied.setdefault(row.pop("quantity"), []).append(row)
    return numbers


def share_numbers(shares: xr.Dataset) -> Rows:
    """Return rows of `benchmarks.shares`, each with percentages of its time."""
    rows = []
    for record in shares.to_dataframe().to_dict("records"):
        row = {str(name): value for name, value in record.items()}
        for part in PARTS_OF_TIME:
            row[part] = 100 * row[part] / row["seconds"]
        rows.append(row)
    return rows


# ---- Passages


def passages(speed: Mapping[str, Any]) -> dict[str, str]:
    """Return texts from `speed_numbers`, by the names that pages refer to."""
    heads = [*(f"({row['letter']}), times" for row in speed["own"]), "(d), ms"]
    rows = []
    for label, line in speed["costs"].items():
        row = {"method": label}
        for head in heads:
            row[head] = _cell(line.get(head))
        rows.append(row)
    frame = pd.DataFrame(rows)
    table = "\n".join(markdown_table(frame.columns, frame.itertuples(index=False)))

    template = _environment().get_template("benchmark_passages.jinja")
    numbers = {"speed": speed, "costs_table": table, "shares_table": _shares_table(speed["shares"])}
    context = template.new_context(numbers)
    return {name: "".join(block(context)) for name, block in template.blocks.items()}


def _shares_table(shares: Rows) -> str:
    """Return the table of where the time of quantities goes, the costliest points first."""
    heads = ["quantity", "s a point", "simulated s a point", *PARTS_OF_TIME.values()]
    rows = []
    for row in sorted(shares, key=lambda row: -row["seconds"] / row["points"]):
        cells = [f"`{row['quantity']}`"]
        cells += [plain(row[name] / row["points"]) for name in ("seconds", "simulated")]
        cells += [f"{row[part]:.0f} %" for part in PARTS_OF_TIME]
        rows.append(cells)
    return "\n".join(markdown_table(heads, rows))


def _environment() -> jinja2.Environment:
    """Return the environment of the passages, with its filters."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(Path(__file__).parent),
        undefined=jinja2.StrictUndefined,
        autoescape=False,
    )
    environment.filters["each"] = each
    environment.filters["times"] = times
    return environment


def each(rows: Rows, text: str, between: str = " and ") -> str:
    """Return a text for each row, filled with its values.

    Parameters
    ----------
    rows : of numbers
    text : template
    between : what stands between the texts
    """
    return between.join(text.format(**row) for row in rows)


def times(number: float | None) -> str:
    """Return how many times something is, in words, or a dash."""
    return f"{plain(number)} times" if number else "-"


def plain(number: float) -> str:
    """Return a number with two digits, without a power of ten."""
    rounded = float(f"{number:.2g}")
    return f"{rounded:,.10g}"


def _cell(cost: float | None) -> str:
    """Return a cost as text, or a dash."""
    return "-" if cost is None else plain(cost)


def fill(text: str, known: Mapping[str, str]) -> str:
    """Return a page whose passages, ``<!-- bench NAME -->...<!-- end -->``, are written anew.

    Parameters
    ----------
    text : the page
    known : passages by name

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


# ---- Files


def measured_numbers(folder: Path) -> dict[str, Any]:
    """Return the numbers of what was measured, from the datasets in a folder."""
    datasets = {}
    for name in (*SPEED, "scaling", "shares"):
        path = folder / f"{name}.nc"
        if path.is_file():
            datasets[name] = load_tree(path).to_dataset()
    numbers: dict[str, Any] = {}
    if datasets.keys() >= SPEED:
        numbers = speed_numbers(
            datasets["work_precision"], datasets["work_precision_avx2"], datasets["answers"]
        )
    if "shares" in datasets:
        numbers["shares"] = share_numbers(datasets["shares"])
    if "scaling" in datasets:
        numbers["scaling"] = scaling_numbers(datasets["scaling"])
    return numbers


@script
def main(bench: str = "results/bench", root: str = "") -> None:
    """Write passages and pictures.

    Parameters
    ----------
    bench : folder of the benchmark's results
    root : of the repository
    """
    folder = Path(bench)
    top = Path(root)
    stored = top / "docs" / "benchmark.json"
    run = json.loads(stored.read_text(encoding="utf-8"))
    run.update(measured_numbers(folder))
    stored.write_text(json.dumps(run, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")

    known = passages(run)
    for name in PAGES:
        page = top / name
        page.write_text(fill(page.read_text(encoding="utf-8"), known), encoding="utf-8")
    for name in FIGURES:
        source = folder / "figures" / f"{name}.png"
        if source.is_file():  # else the picture stays as it was
            shrink(source, top / "docs" / "gallery" / f"{name}.png")
