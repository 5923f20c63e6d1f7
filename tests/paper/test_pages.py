"""Tables and pages made of claims and cases."""

import re

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from disc_model import Parameters
from disc_model.paper.measures import CaseView
from disc_model.paper.model import FAILS, HOLDS, NOT_COMPUTED, REMARK
from disc_model.paper.pages import ledger, table_page
from disc_model.paper.paper_tables import LISTED, TABLE_1, UNNAMED, table_1, table_2, table_2_or_why

COLUMNS = [
    "id",
    "location",
    "claim",
    "paper_value",
    "ours",
    "tolerance",
    "reason",
    "verdict",
    "remark",
    "apart",
    "robust",
]
F_S, OMEGA = 67.63, 15.1
DRIVE = OMEGA / (2 * np.pi)


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
    np.testing.assert_allclose(table["predicted_Hz"], expected, atol=0.02)
    assert table["level_dB"].iloc[1] == pytest.approx(20 * np.log10(3e-2), abs=0.3)


def test_a_line_off_all_combinations_is_not_named_by_the_nearest(f13: CaseView) -> None:
    window = f13.node["spectrum_a"]
    window["w_point"] = window["w_point"] + 1e-4 * np.cos(2 * np.pi * (4 * F_S - DRIVE + 1.0) * window["time"])
    table = table_2(f13)
    assert table["ours_is"].tolist().count(UNNAMED) == 1
    assert table["ours_is"].iloc[7] == UNNAMED


def test_table_2_of_a_case_without_its_window_says_why(f13: CaseView) -> None:
    """A window that begins later passed the check of the study and ended the table's job."""
    late = f13.node["spectrum_a"].to_dataset().assign_coords(time=f13.node["spectrum_a"]["time"] + 50)
    later = CaseView("F13", xr.DataTree.from_dict({"/": f13.node.to_dataset(), "/spectrum_a": late}))
    table, missing = table_2_or_why(later)
    assert missing == "Not computed: case F13 has no samples in spectrum_a from 0 to 10 s."
    assert list(table.columns) == list(table_2(f13).columns)
    assert table["ours_Hz"].isna().all()
    assert tuple(table["paper_Hz"]) == LISTED
    assert table_2_or_why(f13)[1] == ""


def test_table_1_is_what_is_computed_with() -> None:
    table = table_1(Parameters(N=200, Omega=20)).set_index("symbol")
    assert list(table["paper"]) == list(table["ours"])
    assert set(table.index) == set(TABLE_1)
    assert table.loc["E", "unit"] == "Pa"


def test_the_ledger_counts_and_escapes() -> None:
    verdicts = (HOLDS, HOLDS, REMARK, FAILS, f"{NOT_COMPUTED}: no case")
    rows = [
        {name: f"{name} <{i}>" for name in COLUMNS} | {"verdict": v, "apart": "", "robust": "stable"}
        for i, v in enumerate(verdicts)
    ]
    rows.append(rows[0] | {"apart": "a misprint"})
    text = ledger(pd.DataFrame(rows))
    assert f"6 statements; {HOLDS}: 2" in text
    assert f"{FAILS}: 1" in text
    assert text.count("stable") == 6
    assert "not counted, for they repeat others or are misprints: 1." in text
    assert "&lt;3&gt;" in text
    assert not re.search(r"<\d>", text)
    assert text.count("<tr>") == 7
    assert not re.search(r"(src|href)=", text), "self-contained"


def test_a_table_page_leaves_unknown_numbers_empty() -> None:
    text = table_page("T", "", pd.DataFrame({"x": [1.5, np.nan]}))
    assert '<td class="number">1.5</td>' in text
    assert '<td class="number"></td>' in text
