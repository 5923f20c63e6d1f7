"""Rows of the ledger: which cases count as the paper's, and what is said of settled motions."""

import json
from types import SimpleNamespace
from typing import Any

import pytest
import xarray as xr

from disc_model.data.dataset import Missing
from tests.paper.known import known
from workflow.paper.model import (
    PART,
    TRUE,
    Answer,
    Evidence,
    Row,
    graded,
    paper_cases,
    parameters_of,
    partly,
    required_case,
)

NAME = "F13"


def paper_case(end: float, **changes: Any) -> Any:
    """The case of a figure, simulated to a time in s."""
    start = paper_cases()[NAME].get("start", {})
    members = {
        "status": "ok",
        "parameters": parameters_of(NAME, "as_published"),
        "node": SimpleNamespace(attrs={"start": json.dumps(start)}),
        **changes,
    }
    return known({"time_reached": end}, **members)


def test_a_case_that_ends_at_the_time_asked_for_is_long_enough() -> None:
    case = paper_case(80.0)
    cases = {NAME: case}
    assert required_case(cases, NAME, 80.0) is case
    with pytest.raises(Missing, match=f"^case {NAME} ends at 80 s, 90 s are needed$"):
        required_case(cases, NAME, 90.0)


def test_a_case_that_was_to_stop_may_end_early() -> None:
    case = paper_case(80.0, status="stopped")
    found = required_case({NAME: case}, NAME, 90.0)
    assert found is case


def test_a_case_with_another_parameter_is_none_of_the_paper() -> None:
    usual = parameters_of(NAME, "as_published")
    case = paper_case(80.0, parameters=usual.replace(c=0.1, k_p=1e4))
    with pytest.raises(Missing, match=f"^case {NAME} has another c, k_p in this study$"):
        required_case({NAME: case}, NAME, 10.0)


STUDY = xr.Dataset(attrs={"base": "{}", "options": "{}"})


@pytest.mark.parametrize(
    ("settled", "studies", "text"),
    [
        (0, [], ""),
        (1, [], "The motion has settled."),
        (1, [STUDY], "The motion has settled."),
        (2, [], "All motions judged here have settled."),
        (2, [STUDY], "All motions of the named cases have settled."),
    ],
)
def test_it_is_said_which_motions_have_settled(
    settled: int, studies: list[xr.Dataset], text: str
) -> None:
    cases = [known() for _ in range(settled)]
    evidence = Evidence(cases, cases, studies, [], {})
    row = Row(id="x", place="Sec. 1")
    answer = Answer(True, "It grows.")
    found = row._put_in_words(answer, evidence)
    assert found.here == "It grows."
    assert found.notes == text


def test_a_verdict_in_part_needs_one_of_several_parts() -> None:
    assert graded([True, True]) == TRUE
    assert graded([True, False]) == PART
    assert partly(True, True) == PART
    assert partly(True, False) == TRUE
