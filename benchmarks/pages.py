"""Tables of README and of the benchmark's page, written from one run::

    python -m benchmarks.pages results/bench/work_precision.csv README.md docs/benchmark.md

A page has them between ``<!-- bench NAME -->`` and ``<!-- end -->``.
"""

import re
from collections.abc import Mapping
from pathlib import Path

import pandas as pd

from benchmarks.methods import METHODS
from benchmarks.scenes import JUDGED
from benchmarks.work_precision import at_default, costs_of_methods
from disc_model.data.dataset import markdown_table
from disc_model.errors import DiscModelError, script

SHORT = ("series", "heyoka", "RK4", "LSODA")
"""Methods of README's table."""


def passages(points: pd.DataFrame) -> dict[str, str]:
    """Return the passages of the pages by name, from the table of `work_precision`."""
    costs = costs_of_methods(points)
    own = at_default(points).set_index("scene").loc[[*JUDGED]]
    times, errors = (
        " and ".join(f"{value:{form}}" for value in own[column] * scale)
        for column, scale, form in (("further", 1e3, ".2g"), ("event_error", 1.0, ".0e"))
    )
    labels = [METHODS[str(name)].label for name in costs.index]
    cells = costs.map(plain).assign(method=labels)[["method", *costs.columns]]
    long = cells.set_axis(["method", "(a), times", "(b), times", "(d), ms"], axis=1)
    short = cells.loc[[name for name in SHORT if name in cells.index], ["method", *JUDGED]]
    short = short.set_axis(["method", "stick-slip", "with separations"], axis=1)
    return {
        "machine": str(points["machine"].iloc[0]),
        "own": f"{times} ms for (a) and (b) per simulated second, with errors of event times of {errors} s",
        "speed": f"\n\n{markdown(long)}\n\n",
        "speed_short": f"\n\n{markdown(short)}\n\n",
    }


def markdown(table: pd.DataFrame) -> str:
    """Return a table as Markdown."""
    return "\n".join(markdown_table(table.columns, table.itertuples(index=False)))


def plain(number: float) -> str:
    """Return a number with two digits and without a power of ten, or a dash for nan."""
    return "-" if pd.isna(number) else f"{float(f'{number:.2g}'):,.10g}"


def filled(page: str, known: Mapping[str, str]) -> str:
    """Return a page with its passages written anew; raises `DiscModelError` for an unknown name."""

    def passage(match: re.Match[str]) -> str:
        name = match["name"]
        if name not in known:
            raise DiscModelError(f"no passage is called {name!r}; there are {', '.join(known)}")
        return f"<!-- bench {name} -->{known[name]}<!-- end -->"

    return re.sub(r"<!-- bench (?P<name>\w+) -->.*?<!-- end -->", passage, page, flags=re.DOTALL)


@script
def main(table: str, *pages: str) -> None:
    known = passages(pd.read_csv(table))
    for page in pages:
        path = Path(page)
        path.write_text(filled(path.read_text(encoding="utf-8"), known), encoding="utf-8")
