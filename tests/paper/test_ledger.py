"""The top of the ledger's page: what is counted, what is said, and where words lead."""

import math
from typing import Any

import pandas as pd
import pytest

from disc_model.parameters import Parameters
from tests.paper.known import known
from workflow.paper import ledger
from workflow.paper.ledger import ROWS, check_claims, summary
from workflow.paper.model import FALSE, NOT_COMPUTED, PART, TRUE
from workflow.paper.section43 import PLACE

NUMBERS = " ".join(str(number) for number in range(1, 40))
TEXTS = ledger.read_texts("ledger.yaml")


@pytest.fixture(scope="module")
def undecided() -> pd.DataFrame:
    """The table without a verdict."""
    return check_claims({}).assign(verdict=NOT_COMPUTED)


def said(table: pd.DataFrame, part: str) -> list[str]:
    return [item["id"] for item in summary(table)[part]]


@pytest.mark.parametrize(
    ("part", "verdict", "other"),
    [("headline", TRUE, FALSE), ("stands", TRUE, FALSE), ("falls", FALSE, TRUE)],
)
def test_a_sentence_is_said_if_its_row_has_the_verdict_of_which_it_speaks(
    undecided: pd.DataFrame, part: str, verdict: str, other: str
) -> None:
    row, *others = TEXTS[part]
    table = undecided.set_index("id")
    table.loc[row, ["verdict", "here"]] = [verdict, NUMBERS]
    for further in others:
        table.loc[further, "verdict"] = other
    assert said(table.reset_index(), part) == [row]
    assert said(undecided, part) == []


def test_no_template_is_left_in_the_texts(undecided: pd.DataFrame) -> None:
    """Consequences and places are no templates, and a row once printed one."""
    for column in undecided.columns:
        for text in undecided[column].astype(str):
            assert "{{" not in text
            assert "{%" not in text


def test_the_limit_of_places_is_stated_once_and_is_that_of_the_checks() -> None:
    """Three rows had two limits."""
    assert (
        f"differ by more than {100 * PLACE:g} % of the range" in TEXTS["terms"]["different places"]
    )
    assert not any("of the range of these points" in row.judged for row in ROWS)


def test_errors_in_print_are_counted_apart(undecided: pd.DataFrame) -> None:
    in_print = [row.id for row in ROWS if row.print_error]
    assert in_print
    found = summary(undecided)
    assert found["errors"] == len(in_print)
    assert sum(found["counts"].values()) == len(ROWS) - len(in_print)
    assert found["counts"][NOT_COMPUTED] == len(ROWS) - len(in_print)
    assert found["parts"].to_numpy().sum() == len(ROWS) - len(in_print)
    counts = undecided.set_index("id")["counts"]
    for row in ROWS:
        expected = "after the fact" if row.after_the_fact else ""
        if row.print_error:
            expected = "error in print"
        assert counts[row.id] == expected


def test_words_of_figures_and_data_lead_to_their_files(undecided: pd.DataFrame) -> None:
    assert ledger._link("fig07") == "figures/fig07.png"
    assert ledger._link("map_N") == "../map_N/figures/map_N.png"
    table = undecided.set_index("id")
    links: dict[str, str] = {}
    for row in ROWS:
        links.update(table.loc[row.id, "figures"])
        data = table.loc[row.id, "data"]
        for name in row.cases:
            assert data[name] == f"cases/{name}.nc"
        for name in row.scans:
            assert data[name] == f"../{name}/{name}.nc"
    assert links["Fig. 7"] == "figures/fig07.png"
    assert links["Fig. 10"] == "figures/fig10.png"
    assert not any(words.startswith("Fig. 0") for words in links)


def test_a_verdict_that_only_one_normalisation_has_changes_if_the_first_has_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A statement that was not computed as published has no verdict that could change."""
    verdicts = pd.DataFrame(
        {ledger.OLD: [NOT_COMPUTED, TRUE, TRUE], ledger.NEW: [TRUE, NOT_COMPUTED, TRUE]},
        index=["appears", "vanishes", "stays"],
    )
    monkeypatch.setattr(ledger, "_verdicts", lambda *_: verdicts)
    _, _, changed = ledger.compare({}, {})["verdicts"]
    assert [*changed.index] == ["vanishes"]


def test_the_brief_counts_verdicts_of_both_normalisations() -> None:
    verdicts = pd.DataFrame(
        {
            ledger.OLD: [TRUE, TRUE, FALSE, NOT_COMPUTED, PART],
            ledger.NEW: [TRUE, FALSE, FALSE, FALSE, PART],
        }
    )
    table = ledger._brief([], verdicts).set_index("")
    rows = {
        "statements that are true, of 5 that are judged by cases": ["2", "1"],
        "statements that are false": ["1", "3"],
        "statements that no motion decides": ["1", "0"],
    }
    for name, counts in rows.items():
        assert list(table.loc[name]) == counts


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({}, "none in 60 s"),
        ({"first": 12.345}, "12.35 s"),
        ({"bilateral": True}, "ignored"),
        ({"status": "failed"}, "failed"),
    ],
)
def test_the_page_says_when_contact_is_first_lost(changes: dict[str, Any], text: str) -> None:
    """Of a case of 100 s that reached 60 s."""
    usual = {"first": math.nan, "bilateral": False, "status": "stopped"}
    case = {**usual, **changes}
    scalars = {"first_separation": case["first"], "time_reached": 60.0, "t_end": 100.0}
    view = known(scalars, bilateral=case["bilateral"], status=case["status"])
    assert ledger._first_separation(view) == text


@pytest.mark.parametrize(
    ("bilateral", "text"),
    [(False, "N = 385 N, Ω = 20 rad/s"), (True, "N = 385 N, Ω = 20 rad/s, separation ignored")],
)
def test_the_page_says_whether_separation_is_ignored(bilateral: bool, text: str) -> None:
    p = Parameters(N=385, Omega=20)
    case = known({}, parameters=p, bilateral=bilateral)
    assert ledger._parameters_text(case) == text
