"""Tables and pages made of claims and cases."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from disc_model import Parameters
from disc_model.data.texts import fill, write_page
from tests.paper import evidence
from workflow.paper import ledger
from workflow.paper.ledger import COLUMNS, ROWS, summary
from workflow.paper.model import FALSE, NOT_COMPUTED, PART, TRUE, Row
from workflow.paper.paper_tables import LISTED, TABLE_1, UNNAMED, table_1, table_2

F_S = 67.6493
"""Releases per second at 385 N and 15.1 rad/s in the first ten seconds."""
DRIVE = 15.1 / (2 * np.pi)


@pytest.mark.compiled
def test_table_2_names_the_lines() -> None:
    table = table_2(evidence.view("F13", evidence.groups_of("F13")))
    names = ["f_Ω"]
    expected = [DRIVE]
    for n, prefix in enumerate(("", "2 ", "3 ", "4 "), 1):
        names += [f"{prefix}f_s − f_Ω", f"{prefix}f_s + f_Ω"]
        expected += [n * F_S - DRIVE, n * F_S + DRIVE]
    assert list(table["ours_is"]) == names
    assert list(table["paper_Hz"]) == list(LISTED)
    # a tenth of what ten seconds resolve
    np.testing.assert_allclose(table["ours_Hz"], expected, atol=0.01)


@pytest.mark.compiled
def test_a_line_off_all_combinations_is_not_named_by_the_nearest() -> None:
    groups = dict(evidence.groups_of("F13"))
    window = groups["spectrum_a"]
    frequency = 4 * F_S - DRIVE + 1.0
    other = 2e-5 * np.cos(2 * np.pi * frequency * window["time"])
    groups["spectrum_a"] = window.assign(w_point=window["w_point"] + other)
    table = table_2(evidence.view("F13", groups))
    assert [*np.flatnonzero(table["ours_is"] == UNNAMED)] == [7]


def test_table_1_is_what_is_computed_with() -> None:
    table = table_1(Parameters(N=200, Omega=20)).set_index("symbol")
    assert list(table["paper"]) == list(table["ours"])
    assert set(table.index) == set(TABLE_1)


# ---- The ledger's page

VERDICTS = {"F13": TRUE, "F15b": TRUE, "C3s": PART, "eq17": NOT_COMPUTED}
"""Verdicts of some rows in a made-up table; the others are false."""


def made_up(row: Row) -> dict[str, Any]:
    """Return the entry of a row in a made-up table, with signs that a page must escape."""
    return {
        **{name: f"{name} <b>" for name in COLUMNS},
        "id": row.id,
        "verdict": VERDICTS.get(row.id, FALSE),
        "here": "1 <2> 3 4 5 6 7",
        "section": row.place[:7],
        "counts": "",
        "figures": {"Fig. 1": "figures/fig01.png"},
        "data": {},
        "computed": f"<{row.id}>",
    }


@pytest.fixture(scope="module")
def table() -> pd.DataFrame:
    """A table whose last row is an error in print."""
    entries = [made_up(row) for row in ROWS]
    entries[-1]["counts"] = "error in print"
    return pd.DataFrame(entries)


def test_the_summary_counts_verdicts_without_errors_in_print(table: pd.DataFrame) -> None:
    found = summary(table)
    assert found["counts"] == {
        TRUE: 2,
        PART: 1,
        FALSE: len(ROWS) - 5,
        "ambiguous in the paper": 0,
        "cause not tested": 0,
        NOT_COMPUTED: 1,
    }
    assert found["errors"] == 1


def test_the_summary_says_what_stands_and_falls_by_the_verdicts(table: pd.DataFrame) -> None:
    found = summary(table)
    falls = [item["id"] for item in found["falls"]]
    assert falls == ["P07", "F05"], "eq17 is not computed"
    stands = [item["id"] for item in found["stands"]]
    assert stands == ["F13", "F15b"], "C3s is true in part"
    assert found["stands"][0]["text"].endswith("separation begins at 1 s, where the paper has 2 s.")


def test_the_summary_takes_the_period_of_its_row(table: pd.DataFrame) -> None:
    """It once said the numbers of the preload and of the speed."""
    template = next(row.here for row in ROWS if row.id == "F05")
    motion = "periodic: it repeats after 8 releases and 9 separations, every 1.23 s"
    here = fill(template, rows=[("200 N, 20 rad/s", motion)])
    found = summary(table.assign(here=table["here"].where(table["id"] != "F05", here)))
    [text] = [item["text"] for item in found["falls"] if item["id"] == "F05"]
    assert text.endswith("repeats every 1.23 s.")


def test_the_page_links_and_escapes(table: pd.DataFrame, tmp_path: Path) -> None:
    for file in ("x.html", "x.md"):
        write_page(
            tmp_path / file, "T", ("", summary(table), table), template=Path(ledger.__file__)
        )
    x_path = tmp_path / "x.html"
    html = x_path.read_text()
    assert html.count('class="row"') == len(ROWS)
    assert html.count('href="figures/fig01.png"') == len(ROWS)
    assert "&lt;b&gt;" in html
    assert "<b>" not in html
    x_file = tmp_path / "x.md"
    markdown = x_file.read_text()
    assert markdown.count("[Fig. 1](figures/fig01.png)") == len(ROWS)
    assert markdown.count("why it matters: ") == len(ROWS)
    assert markdown.count("Data: computed for this row: <") == len(ROWS)
    assert html.count("Data: computed for this row: &lt;") == len(ROWS)


def test_a_page_is_the_same_as_markdown_and_as_html(tmp_path: Path) -> None:
    table = pd.DataFrame({"x": [1.5, np.nan], "a|b": ["<", "|"]})
    for file in ("x.md", "x.html"):
        write_page(tmp_path / file, "T", ("H & H", "some", table), ("", "more", table))
    rows = "| x | a\\|b |\n| --- | --- |\n| 1.5 | < |\n|  | \\| |\n"
    x_path = tmp_path / "x.md"
    markdown = x_path.read_text()
    assert markdown == f"# T\n\n## H & H\n\nsome\n\n{rows}\nmore\n\n{rows}"
    x_file = tmp_path / "x.html"
    html = x_file.read_text()
    assert '<td class="number">1.5</td><td>&lt;</td>' in html
    assert '<td class="number"></td><td>|</td>' in html
    assert html.count("<h2>H &amp; H</h2>") == 1
    assert html.count("<h2>") == 1
