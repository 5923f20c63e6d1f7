"""Tables and pages made of claims and cases."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from disc_model import Parameters
from disc_model.data.texts import write_page
from disc_model.paper.ledger import COLUMNS, ROWS, summary
from disc_model.paper.model import FALSE, NOT_COMPUTED, PART, TRUE
from disc_model.paper.paper_tables import LISTED, TABLE_1, UNNAMED, table_1, table_2
from tests.paper import evidence

F_S, DRIVE = 67.6493, 15.1 / (2 * np.pi)


@pytest.mark.compiled
def test_table_2_names_the_lines() -> None:
    """Of the first ten seconds at 385 N and 15.1 rad/s, where the slider is released 67.65 times a
    second."""
    f13 = evidence.view("F13", evidence.groups_of("F13"))
    table = table_2(f13)
    pairs = [f"{n}f_s {sign} f_Ω" for n in ("", "2 ", "3 ", "4 ") for sign in ("−", "+")]
    assert list(table["ours_is"]) == ["f_Ω", *pairs]
    assert list(table["paper_Hz"]) == list(LISTED)
    expected = [DRIVE] + [n * F_S + side * DRIVE for n in range(1, 5) for side in (-1, 1)]
    np.testing.assert_allclose(
        table["ours_Hz"], expected, atol=0.01
    )  # a tenth of what ten seconds resolve
    # a line off all combinations is not named by the nearest
    groups = dict(evidence.groups_of("F13"))
    window = groups["spectrum_a"]
    other = 2e-5 * np.cos(2 * np.pi * (4 * F_S - DRIVE + 1.0) * window["time"])
    groups["spectrum_a"] = window.assign(w_point=window["w_point"] + other)
    assert [*np.flatnonzero(table_2(evidence.view("F13", groups))["ours_is"] == UNNAMED)] == [7]


def test_table_1_is_what_is_computed_with() -> None:
    table = table_1(Parameters(N=200, Omega=20)).set_index("symbol")
    assert list(table["paper"]) == list(table["ours"])
    assert set(table.index) == set(TABLE_1)


def test_the_ledger_counts_links_and_escapes(tmp_path: Path) -> None:
    verdicts = dict(
        zip(("F13", "F15b", "C3s", "eq17"), (TRUE, TRUE, PART, NOT_COMPUTED), strict=True)
    )
    here = "1 <2> 3 4 5 6 7"
    rows = [
        {name: f"{name} <b>" for name in COLUMNS}
        | {
            "id": row.id,
            "verdict": verdicts.get(row.id, FALSE),
            "here": here,
            "section": row.place[:7],
            "counts": "",
        }
        | {"figures": {"Fig. 1": "figures/fig01.png"}, "data": {}}
        for row in ROWS
    ]
    table = pd.DataFrame([*rows[:-1], rows[-1] | {"counts": "error in print"}])
    found = summary(table)
    assert found["counts"] == {
        TRUE: 2,
        PART: 1,
        FALSE: len(ROWS) - 5,
        "ambiguous in the paper": 0,
        NOT_COMPUTED: 1,
    }
    assert found["errors"] == 1
    assert [item["id"] for item in found["falls"]] == ["P07", "T2e", "F10e", "F05"], (
        "eq17 is not computed"
    )
    assert [item["id"] for item in found["stands"]] == ["F13", "F15b"], "C3s is true in part"
    assert found["stands"][0]["text"].endswith("separation begins at 1 s, where the paper has 2 s.")
    for file in ("x.html", "x.md"):
        write_page(tmp_path / file, "T", ("", found, table), template="paper/ledger")
    text = (tmp_path / "x.html").read_text()
    assert text.count('class="row"') == text.count('href="figures/fig01.png"') == len(ROWS)
    assert ("&lt;b&gt;" in text, "<b>" in text) == (True, False)
    page = (tmp_path / "x.md").read_text()
    assert page.count("[Fig. 1](figures/fig01.png)") == page.count("why it matters: ") == len(ROWS)


def test_a_page_is_the_same_as_markdown_and_as_html(tmp_path: Path) -> None:
    table = pd.DataFrame({"x": [1.5, np.nan], "a|b": ["<", "|"]})
    for file in ("x.md", "x.html"):
        write_page(tmp_path / file, "T", ("H & H", "some", table), ("", "more", table))
    rows = "| x | a\\|b |\n| --- | --- |\n| 1.5 | < |\n|  | \\| |\n"
    assert (tmp_path / "x.md").read_text() == f"# T\n\n## H & H\n\nsome\n\n{rows}\nmore\n\n{rows}"
    text = (tmp_path / "x.html").read_text()
    assert '<td class="number">1.5</td><td>&lt;</td>' in text
    assert '<td class="number"></td><td>|</td>' in text
    assert (text.count("<h2>H &amp; H</h2>"), text.count("<h2>")) == (1, 1)
