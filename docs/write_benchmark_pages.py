"""Write what README and docs say about speed and the number of modes, from the datasets of one run of the benchmark.

The numbers of the run are stored as ``docs/benchmark.json`` and ``docs/contact_truncation.json``. All passages are
written from these files, by ``benchmark_passages.jinja``, so that one run refreshes every number, and a test detects
outdated pages. What was not measured is left as it was.
"""

import json
import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import jinja2
import numpy as np
import pandas as pd
import xarray as xr
from docs.make_gallery import shrink

from disc_model.benchmarks.answers import QUESTIONS, in_words
from disc_model.benchmarks.methods import METHODS
from disc_model.benchmarks.scenes import CONVERGED, JUDGED
from disc_model.benchmarks.truncation import CONTACTS
from disc_model.benchmarks.work_precision import DEFAULT, at_default, cost_at, headline, measured_points
from disc_model.data.dataset import load, markdown_table
from disc_model.errors import DiscModelError, script

SPEED = {"work_precision", "work_precision_avx2", "answers"}
"""Measurements for the passages on speed."""
STORED = ("benchmark", "contact_truncation")
"""Files of the numbers of a run: on speed, and on the number of modes."""
PAGES = ("README.md", "docs/method.md", "docs/benchmark.md", "docs/truncation.md")
"""Pages with passages."""
FIGURES = ("overview", "failure_maps", "answers", "prices", "answer_maps", "contact_truncation")
"""Figures that are shown in docs/gallery."""
LETTERS = dict(zip(JUDGED, "ab", strict=True))
"""Panel letters of the scenes in the overview."""
Rows = list[dict[str, Any]]
Table = dict[str, dict[Any, Any]]
"""Cells by the names of line and column."""


class Column(NamedTuple):
    """A quantity of the table: its title, and the relative tolerance within which models agree.

    It is 1 % or better for the motion in contact, and 10 % for values from ten seconds of an irregular motion.
    """

    title: str
    tolerance: float


TABLED = {
    "lowest_coupled": Column("lowest frequency", 1e-3),
    "growth_rate": Column("growth", 1e-2),
    "first_separation": Column("first separation", 1e-2),
    "separations": Column("separations per s", 1e-1),
    "separated_share": Column("time in separation", 1e-1),
    "u_range": Column("range", 1e-1),
    "force_max_separating": Column("largest force", 1e-1),
}
LATE = ("separations", "separated_share", "u_range", "force_max_separating")
"""Quantities after the first separation."""
FEWEST = 3
"""Number of models that must agree: one, and two larger ones."""
NOT = "**not**"


# ----------------------------------------------------------------------------------------------------
# Numbers of a run


def speed_numbers(work_precision: xr.Dataset, as_avx2: xr.Dataset, answers: xr.Dataset) -> dict[str, Any]:
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
    return {
        "machine": machines.pop(),
        "versions": json.loads(work_precision.attrs["versions"]),
        "own": _own(points),
        "narrow": _own(narrow),
        "narrowly": [{"times": times["heyoka"]} for times in headline(narrow).values() if "heyoka" in times],
        "glue": _glue(points[points["solver"] == "heyoka"]),
        "call": _whole_call(points[points["scene"] == JUDGED[0]]),
        "costs": _costs(points),
        "answers": _answers(in_words(answers)),
    }


def _own(points: pd.DataFrame) -> Rows:
    """Cost (ms) and error (s) of the series engine at its default, by scene."""
    found = at_default(points[points["scene"].isin(JUDGED)])
    return [
        {"letter": LETTERS[p["scene"]], "ms": 1e3 * p["further"], "error": p["event_error"]}
        for p in found.to_dict("records")
    ]


def _whole_call(points: pd.DataFrame) -> Rows:
    """Milliseconds of a whole call of `simulate` for the first scene's second, and the ratio of heyoka's time to it.

    heyoka's time is that of its integration alone, at the error of `headline`.
    """
    rival = cost_at(points[points["solver"] == "heyoka"], DEFAULT, "seconds")
    calls = points["whole_call"].dropna().head(1)
    return [{"ms": 1e3 * call, "times": rival / call} for call in calls if math.isfinite(rival)]


def _glue(heyoka: pd.DataFrame) -> Rows:
    """Percentage of heyoka's time spent in Python between its phases, by scene, at the setting nearest to `DEFAULT`."""
    known = heyoka[heyoka["glue"].notna() & heyoka["scene"].isin(JUDGED)]
    off = np.abs(np.log(known["event_error"] / DEFAULT))
    nearest = known.loc[off.groupby(known["scene"], sort=False).idxmin()]
    return [{"letter": LETTERS[p["scene"]], "share": 100.0 * p["glue"]} for p in nearest.to_dict("records")]


def _costs(points: pd.DataFrame) -> Table:
    """Cost by method, cheapest first: times that of the series engine, and on the almost rigid disc in ms a second."""
    times = {f"({LETTERS[scene]}), times": pd.Series(found) for scene, found in headline(points).items()}
    rigid = points[points["scene"] == "rigid"].groupby("solver")
    stiff = pd.Series({name: 1e3 * cost_at(line, CONVERGED, "cost") for name, line in rigid}, dtype=float)
    table = pd.DataFrame({**times, "(d), ms": stiff})
    table = table.assign(least=table[[*times]].min(axis=1)).sort_values(["least", "(d), ms"]).drop(columns="least")
    return {METHODS[str(name)].label: line.dropna().to_dict() for name, line in table.iterrows() if line.notna().any()}


def _answers(found: pd.DataFrame) -> Table:
    """By line and question: cheapest correct answer, and settings that answer wrongly without a warning.

    Of models: the numbers of nodal diameters with which they answer correctly.
    """
    table: Table = {}
    for (label, line, name), part in found.groupby(["label", "line", "answer"], sort=False):
        right, wrong = (part[part["verdict"] == verdict] for verdict in ("right", "wrong"))
        best = right.nsmallest(1, "seconds")[["seconds", "at"]].to_dict("records")
        cell = {"wrong": wrong["setting"].tolist()} | (best[0] if best else {})
        numbers = ", ".join(f"{count:.0f}" for count in right["setting"])
        table.setdefault(str(label), {})[name] = numbers if line in CONTACTS else cell
    return table


def mode_numbers(study: xr.Dataset) -> dict[str, Any]:
    """Numbers of a run for the pages: a row for each case, contact and model, None where there is no value."""
    frame = study[["modes", *TABLED]].to_dataframe(dim_order=["case", "contact", "model"])
    rounded = frame.map(lambda value: float(f"{value:.5g}")).astype(object)
    return {
        "machine": study.attrs["machine"],
        "most_growth": float(study.attrs["most_growth"]),
        "values": rounded.where(frame.notna(), None).reset_index().to_dict("split", index=False),
    }


def settled(values: Sequence[float | None], tolerance: float) -> int | None:
    """The first model from which on all agree with the largest within a relative tolerance, or like it have no value.

    Parameters
    ----------
    values : by size of the model, None or nan where a model has no such quantity

    Returns
    -------
    int or None
        Its index in the list; None if it would not have two larger ones.
    """
    line = np.array(values, float)
    off = np.flatnonzero(~np.isclose(line, line[-1], rtol=tolerance, atol=0.0, equal_nan=True))
    first = int(off[-1]) + 1 if off.size else 0
    return first if len(line) - first >= FEWEST else None


# ----------------------------------------------------------------------------------------------------
# Passages


def stored_passages(docs: Path) -> dict[str, str]:
    """All passages of the stored run, by the name that pages refer to."""
    return passages(*(json.loads((docs / f"{name}.json").read_text(encoding="utf-8")) for name in STORED))


def passages(speed: Mapping[str, Any], modes: Mapping[str, Any]) -> dict[str, str]:
    """Texts by name, from `speed_numbers` and `mode_numbers`."""
    answers = speed["answers"]
    heads = [*(f"({row['letter']}), times" for row in speed["own"]), "(d), ms"]
    titles = {
        name: f"{question.title}, to {_within(question.enough, question.units)}"
        for name, question in QUESTIONS.items()
        if any(name in line for line in answers.values())
    }
    values = _convergence(modes) | {
        "speed": speed,
        "cycle_growth": answers["series, from the cycle itself"]["growth_rate"],
        "costs_table": _printed(speed["costs"], {head: head for head in heads}),
        "answers_table": _printed(answers, titles),
    }
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(Path(__file__).parent), undefined=jinja2.StrictUndefined, autoescape=False
    )
    environment.filters["each"] = lambda rows, text, between=" and ": between.join(text.format(**row) for row in rows)
    environment.filters["times"] = lambda number: f"{plain(number)} times" if number else "-"
    template = environment.get_template("benchmark_passages.jinja")
    return {name: "".join(block(template.new_context(values))) for name, block in template.blocks.items()}


def _within(enough: float, units: str) -> str:
    """Tolerance of an answer as text."""
    unit = units.replace("rad s-1", "rad/s").replace("s-1", "1/s")
    return f"{enough:g}" if units == "1" else f"{enough:g} {unit}"


def _printed(table: Table, titles: Mapping[str, str]) -> str:
    rows = ({title: _cell(line.get(name)) for name, title in titles.items()} for line in table.values())
    return as_markdown(pd.DataFrame([{"method": label} | row for label, row in zip(table, rows, strict=True)]))


def plain(number: float) -> str:
    """A number with two digits, without a power of ten."""
    return f"{float(f'{number:.2g}'):,.10g}"


def _cell(found: Any) -> str:
    """A cost, the cheapest answer with its setting, or numbers of diameters."""
    if found is None or isinstance(found, float):
        return "-" if found is None else plain(found)
    if isinstance(found, str):
        return found or "no number"
    wrong = f"wrong at {', '.join(f'{setting:g}' for setting in found['wrong'])}" if found["wrong"] else ""
    if "seconds" not in found:
        return wrong or "no answer"
    return f"{plain(found['seconds'])} s ({'; '.join(filter(None, (found['at'], wrong)))})"


def _convergence(run: Mapping[str, Any]) -> dict[str, Any]:
    """The table on the number of modes from which on each quantity is settled."""
    study = pd.DataFrame(**run["values"]).set_index(["case", "contact", "model"]).astype(float)
    rows = []
    for (case, contact), models in study.groupby(["case", "contact"], sort=False):
        row = {"case": case, "contact": contact}
        for name, column in TABLED.items():
            line = _known(models, name, run["most_growth"])
            first = settled(line.tolist(), column.tolerance)
            row[f"{column.title}, to {100 * column.tolerance:g} %"] = _from_where(line, first)
        rows.append(row)
    table = pd.DataFrame(rows)
    numbers = (table.set_index(["case", "contact"]) != NOT).stack().groupby("contact", sort=False).agg(["sum", "size"])
    counts = [
        {"contact": contact, "settled": part["sum"], "count": part["size"]} for contact, part in numbers.iterrows()
    ]
    return {
        "settled_table": as_markdown(table),
        "most": f"{study['modes'].iloc[-1]:g}",
        "counts": counts,
    }


def _known(models: pd.DataFrame, name: str, most_growth: float) -> "pd.Series[float]":
    """A quantity by the number of modes, without models for which it was not looked for.

    These have too many modes for a growth rate, or lose contact and could then not be followed.
    """
    line = models.set_index("modes")
    if name == "growth_rate":
        return line[name][line.index <= most_growth]
    return line[name][line[name].notna() | line["first_separation"].isna() | (name not in LATE)]


def _from_where(line: "pd.Series[float]", place: int | None) -> str:
    if place is None:
        return NOT
    where = f"from {line.index[place]:g}"
    if not math.isnan(line.iloc[place]):
        return where
    return f"none {where}" if place else "none"


def as_markdown(frame: pd.DataFrame) -> str:
    """A table in Markdown."""
    return "\n".join(markdown_table(frame.columns, frame.itertuples(index=False)))


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


# ----------------------------------------------------------------------------------------------------
# Files


def _store(run: Mapping[str, Any], path: Path) -> None:
    path.write_text(json.dumps(run, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


@script
def main(bench: str = "results/bench", root: str = "") -> None:
    folder, top = Path(bench), Path(root)
    measured = {name: folder / f"{name}.nc" for name in (*sorted(SPEED), "contact_truncation")}
    there = {name: load(path).to_dataset() for name, path in measured.items() if path.is_file()}
    if not there:
        raise DiscModelError(f"{bench} holds no measurements: make bench")
    docs = top / "docs"
    if there.keys() >= SPEED:
        run = speed_numbers(there["work_precision"], there["work_precision_avx2"], there["answers"])
        _store(run, docs / "benchmark.json")
    if "contact_truncation" in there:
        _store(mode_numbers(there["contact_truncation"]), docs / "contact_truncation.json")
    known = stored_passages(docs)
    for page in (top / name for name in PAGES):
        page.write_text(fill(page.read_text(encoding="utf-8"), known), encoding="utf-8")
    for name in FIGURES:
        source = folder / "figures" / f"{name}.png"
        if source.is_file():  # else the picture stays as it was
            shrink(source, docs / "gallery" / f"{name}.png")
