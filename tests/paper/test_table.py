"""The table of claims: complete, computed, and honest about what it lacks."""

import re
from collections.abc import Callable
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any
from unittest.mock import Mock

import numpy as np
import pandas as pd
import pytest
import xarray as xr
import yaml
from pydantic import ValidationError

from disc_model import Parameters
from disc_model.data.dataset import Missing
from disc_model.paper import SCANS, disc, measures, section41, section42, section43, section44, survival
from disc_model.paper.ledger import CLAIMS, check_claims, views
from disc_model.paper.measures import CaseView
from disc_model.paper.model import (
    FAILS,
    HOLDS,
    NOT_COMPUTED,
    REMARK,
    UNDECIDED,
    Answer,
    Claim,
    ClaimError,
    Finding,
    claims,
    paper_cases,
)
from disc_model.paper.pages import to_markdown
from disc_model.paper.survival import CONCLUSIONS
from disc_model.simulation.api import run_case
from disc_model.stability.cycle import floquet
from disc_model.studies.study import parse_study
from tests.paper.made_up import kept_events
from tests.paper.test_pages import COLUMNS


def tree_of(**cases: dict[str, Any]) -> xr.DataTree:
    """Merged cases of a study with these cases."""
    from disc_model.studies.cases import merge_cases

    study = parse_study({"study": "x", "cases": {name: {"title": ""} | case for name, case in cases.items()}})
    return merge_cases({name: run_case(spec) for name, spec in study.specs.items()}, study.labels)


@pytest.fixture(scope="module")
def table() -> pd.DataFrame:
    return check_claims(
        tree_of(
            F13={"parameters": {"N": 385, "Omega": 15.1}, "t_end": 60, "record": {"events": False}},
            F11={"parameters": {"N": 385, "Omega": 15}, "t_end": 1},
            F16={"parameters": {"N": 60, "Omega": 15}, "t_end": 1},
        )
    ).set_index("id")


@pytest.mark.compiled
def test_table_has_every_claim_once(table: pd.DataFrame) -> None:
    assert [*table.reset_index().columns] == COLUMNS
    assert list(table.index) == [claim.id for claim in CLAIMS]
    assert table.index.is_unique


def test_cases_are_those_that_the_texts_speak_of() -> None:
    count = 0
    for claim in CLAIMS:
        if phrase := re.match(r"(?:.*, )?N = ([\d.]+) N, (?:Omega = )?([\d.]+) rad/s", claim.claim):
            found = {(p["N"], p["Omega"]) for p in (paper_cases()[name]["parameters"] for name in claim.cases)}
            assert tuple(map(float, phrase.groups())) in found, claim.id
            count += 1
    assert count > 10


def test_the_workflow_is_told_of_every_scan() -> None:
    named = {name for claim in CLAIMS for name in claim.scans + claim.beside}
    assert sorted(named | {"basins"}) == sorted(SCANS)  # of which every claim may have a remark


@pytest.mark.compiled
def test_what_is_computed_is_said(table: pd.DataFrame) -> None:
    computed = ~table["verdict"].str.startswith(NOT_COMPUTED)
    assert table["ours"][computed].str.len().gt(0).all()
    assert table["ours"][~computed].eq("").all()
    assert table["remark"][table["verdict"] == REMARK].str.len().gt(0).all()
    rows = [line for line in to_markdown(table.reset_index()).splitlines() if line.startswith("|")]
    assert len(rows) == len(CLAIMS) + 2
    assert {len(re.findall(r"(?<!\\)\|", row)) for row in rows} == {len(COLUMNS) + 1}


@pytest.mark.compiled
def test_claims_about_the_disc_need_no_simulation(table: pd.DataFrame) -> None:
    assert table.loc["F13", "ours"] == "first separation at 54.42 s"
    expected = {
        "F13": REMARK,
        "P01": REMARK,
        "P02": HOLDS,
        "P04": REMARK,
        "P05": REMARK,
        "P06": UNDECIDED,
        "P07": FAILS,
    }
    assert table["verdict"][list(expected)].to_dict() == expected
    assert table.loc["P04", "ours"].startswith("850.86, 1492.55, 1516.76, 1814.90")
    assert "1178.65, 1500.28, 1723.08, 2575.73, 4111.83" in table.loc["P04", "remark"]
    assert table.loc["P07", "ours"] == "911.94 rad/s"
    assert "607.96" in table.loc["P07", "remark"]


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("claim", "reason"),
    [
        ("F04", "case F04 is not in this study"),
        ("F11", "case F11 ends at 1 s"),
        ("F16", "case F16 has another N in this study"),
        ("F14", "case F13 ends at 60 s"),
    ],
)
def test_what_is_missing_is_said(table: pd.DataFrame, claim: str, reason: str) -> None:
    assert table.loc[claim, "verdict"].startswith(f"{NOT_COMPUTED}: {reason}")


def test_a_case_that_starts_elsewhere_is_not_the_papers() -> None:
    case = {"parameters": {"N": 385, "Omega": 15}, "t_end": 0.01, "start": {"perturbation": {"f": 1.0}}}
    claim = Claim(id="x", check=lambda _: Answer(True), location="", claim="", cases={"F11": 0}, ours="")
    phrase = "case F11 does not begin with the static start in this study"
    assert claim.evaluate(views(tree_of(F11=case))).verdict == f"{NOT_COMPUTED}: {phrase}"
    assert claim.evaluate(views(tree_of(F11=case | {"start": {}}))).verdict == HOLDS


TEXT = {
    "check": "A",
    "location": "Sec. 1",
    "claim": "It moves",
    "ours": "by {mm:.1f} mm; {rows}",
    "parts": {"rows": "{N:g} N"},
}


def claims_from(tmp_path: Path, checks: dict[str, Callable[..., Answer]], **texts: object) -> tuple[Claim, ...]:
    (tmp_path / "x.yaml").write_text(yaml.safe_dump(texts, sort_keys=False), encoding="utf-8")
    module = ModuleType("x")
    vars(module).update(checks, __file__=str(tmp_path / "x.py"))
    return claims(module)


def claim_of(tmp_path: Path, check: Callable[..., Answer], **more: object) -> Claim:
    (claim,) = claims_from(tmp_path, {"A": check}, X=TEXT | more)
    return claim


def test_a_text_is_filled_with_the_numbers_of_its_check(tmp_path: Path) -> None:
    check = lambda least: Answer(True, mm=[1, 2.25], rows=[{"N": 3}, {"N": 5}], why=least > 1, chaos=0)  # noqa: E731
    extra = {"bounds": {"least": 2.0}, "remarks": {"why": "beyond {least:g}", "chaos": None}}
    first, second = claims_from(tmp_path, {"A": check}, X=TEXT | extra, Y=TEXT | {"bounds": {"least": 1.0}})
    assert first.judge() == Finding("by 1.0, 2.2 mm; 3 N; 5 N", REMARK, "beyond 2")
    assert second.judge() == Finding("by 1.0, 2.2 mm; 3 N; 5 N", HOLDS)


def test_an_open_question_says_why(tmp_path: Path) -> None:
    check = lambda: Answer(None, "chaos", mm=1, rows=[], other=True)  # noqa: E731
    claim = claim_of(tmp_path, check, remarks={"other": "but"}, undecided={"chaos": None})
    assert claim.judge() == Finding("by 1.0 mm; ", UNDECIDED, "the 0-1 test lies between regular and chaotic motion")


@pytest.mark.parametrize(
    ("bounds", "turned"),
    [
        ({"most": 10.0}, "stable"),  # the value is 3
        ({"most": 5.0}, "does not hold with most = 2.5"),
        ({"most": 2.0}, "holds with most = 4"),
        ({"most": 1.6}, "holds with most = 3.2"),
        ({"most": 5.0, "share": 1.2}, "does not hold with most = 2.5; undecided with share = 1.4"),
        ({}, ""),
    ],
)
def test_a_verdict_says_which_bound_it_turns_on(tmp_path: Path, bounds: dict[str, float], turned: str) -> None:
    check = lambda most=9, share=0: Answer(None if share > 1.3 else most > 3, "chaos", mm=3, rows=[])  # noqa: E731
    claim = claim_of(tmp_path, check, bounds=bounds, undecided={"chaos": None})
    found, by = claim.settle(lambda one, *changed: one.evaluate({}, *changed))
    assert by == turned
    hangs = turned not in ("", "stable")
    assert (found.verdict == UNDECIDED, turned in found.remark) == (hangs, hangs or not turned)


def test_texts_and_checks_that_do_not_fit_are_refused_at_once(tmp_path: Path) -> None:
    unknown = TEXT | {"check": "decide"}
    texts = {"Known": TEXT | {"case": {"F02": 1}}, "Undecidable": unknown, "Elsewhere": TEXT | {"cases": {"F99": 1}}}
    with pytest.raises(ValidationError) as refused:
        claims_from(tmp_path, {"A": lambda: Answer(True)}, **texts)
    assert [(".".join(map(str, fault["loc"])), fault["msg"]) for fault in refused.value.errors()] == [
        ("x.yaml: Known.case", "Extra inputs are not permitted"),
        ("x.yaml: Undecidable.check", "Input should be callable"),
        ("x.yaml: Elsewhere.cases", "Value error, no case F99 in the paper's"),
    ]


def test_every_check_has_a_text() -> None:
    for modules, those in (((disc, section41, section42, section43, section44), CLAIMS), ((survival,), CONCLUSIONS)):
        found = {one for module in modules for one in vars(module).values() if isinstance(one, FunctionType)}
        checks = {one for one in found if one.__annotations__.get("return") is Answer}
        assert checks == {claim.check for claim in those}


def test_a_number_that_a_text_lacks_is_named(tmp_path: Path) -> None:
    claim = claim_of(tmp_path, lambda: Answer(True, mm=1))
    with pytest.raises(ClaimError, match=r"^claim X: no value 'rows' among those of its check: cases, mm$"):
        claim.judge()


def case_with(*events: tuple[float, str, str]) -> CaseView:
    """Five seconds with these events."""
    groups = {"/": xr.Dataset({"time_reached": 5.0}), "/events": kept_events(events, 0.0, 5.0)}
    return CaseView("X", xr.DataTree.from_dict(groups))


def test_separation_durations_count_whole_separations() -> None:
    case = case_with(
        (1.0, "reattachment", "slip"),
        (2.0, "separation", "separation"),
        (2.5, "reattachment", "slip"),
        (3.0, "separation", "separation"),
        (3.25, "reattachment", "slip"),
        (4.0, "separation", "separation"),
    )
    durations, still_open = case.separation_durations()
    np.testing.assert_array_equal(durations, [0.5, 0.25])
    assert still_open == 1.0
    assert case.rate_of("separation") == pytest.approx(3 / 5)


def test_phase_share() -> None:
    case = case_with((1.0, "slip_to_stick", "stick"), (2.0, "stick_to_slip", "slip"))
    assert case.phase_share("stick") == pytest.approx(0.25)


def test_growth_is_that_of_the_cycle() -> None:
    p = Parameters(N=200, Omega=20, n_diameters=1)
    found = measures.cycle_of(p)
    assert found is measures.cycle_of(p.replace())
    case = CaseView("X", xr.DataTree(xr.Dataset(attrs={"parameters": p.canonical_json})))
    assert case.growth == f"growth {found.growth_rate:+.4f}/s"
    still = CaseView("Y", xr.DataTree(xr.Dataset(attrs={"parameters": p.replace(Omega=0).canonical_json})))
    assert still.growth == "no stick-slip cycle"
    with pytest.raises(Missing, match="no stick-slip cycle: "):
        measures.cycle_of(still.parameters)


def test_a_search_that_finds_no_cycle_is_made_once(monkeypatch: pytest.MonkeyPatch) -> None:
    searched = Mock(wraps=floquet)
    monkeypatch.setattr("disc_model.stability.cycle.floquet", searched)
    still = Parameters(N=201, Omega=0, n_diameters=1)
    assert np.isnan([measures.growth_or_nan(still), measures.growth_or_nan(still.replace())]).all()
    searched.assert_called_once()
