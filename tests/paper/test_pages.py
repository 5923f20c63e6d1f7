"""Tables and pages made of claims and cases."""

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from disc_model import Parameters
from disc_model.data.texts import write_page
from disc_model.paper.ledger import COLUMNS, verdict_counts
from disc_model.paper.measures import CaseView
from disc_model.paper.model import FAILS, HOLDS, NOT_COMPUTED, REMARK
from disc_model.paper.paper_tables import LISTED, TABLE_1, UNNAMED, table_1, table_2

F_S, DRIVE = 67.63, 15.1 / (2 * np.pi)


@pytest.fixture
def f13(told: xr.DataTree) -> CaseView:
    """A disc that vibrates at n f_s -/+ f_drive in its first ten seconds, and a slider at f_s."""
    return CaseView("F13", told["F13"].copy(deep=True))


def test_table_2_names_the_lines(f13: CaseView) -> None:
    table = table_2(f13)
    pairs = [f"{n}f_s {sign} f_Ω" for n in ("", "2 ", "3 ", "4 ") for sign in ("−", "+")]
    assert list(table["ours_is"]) == ["f_Ω", *pairs]
    assert list(table["paper_Hz"]) == list(LISTED)
    expected = [DRIVE] + [n * F_S + side * DRIVE for n in range(1, 5) for side in (-1, 1)]
    np.testing.assert_allclose(table["ours_Hz"], expected, atol=0.01)
    assert table["level_dB"].iloc[1] == pytest.approx(20 * np.log10(3e-2), abs=0.3)
    # a line off all combinations is not named by the nearest
    window = f13.node["spectrum_a"]
    window["w_point"] = window["w_point"] + 1e-4 * np.cos(2 * np.pi * (4 * F_S - DRIVE + 1.0) * window["time"])
    assert [*np.flatnonzero(table_2(f13)["ours_is"] == UNNAMED)] == [7]


def test_table_1_is_what_is_computed_with() -> None:
    table = table_1(Parameters(N=200, Omega=20)).set_index("symbol")
    assert list(table["paper"]) == list(table["ours"])
    assert set(table.index) == set(TABLE_1)


def test_the_ledger_counts_and_escapes(tmp_path: Path) -> None:
    verdicts = (HOLDS, HOLDS, REMARK, FAILS, f"{NOT_COMPUTED}: no case")
    rows = [
        {name: f"{name} <{i}>" for name in COLUMNS} | {"verdict": v, "apart": "", "robust": "stable"}
        for i, v in enumerate(verdicts)
    ]
    table = pd.DataFrame([*rows, rows[0] | {"apart": "a misprint"}])
    counts = verdict_counts(table)
    assert counts.startswith(f"{HOLDS}: 2, ")
    assert counts.endswith("; not counted, for they repeat others or are misprints: 1")
    write_page(tmp_path / "x.html", "T", ("", counts, table), template="paper/ledger")
    text = (tmp_path / "x.html").read_text()
    assert (text.count("stable"), text.count("<tr>"), text.count('"verdict good"')) == (6, 7, 3)
    assert "&lt;3&gt;" in text
    assert not re.search(r"<\d|(src|href)=", text), "escaped and self-contained"


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
