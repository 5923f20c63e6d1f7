"""The table of claims: complete, computed, and honest about what it lacks."""

import re
from collections.abc import Callable
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

import numpy as np
import pytest
import xarray as xr
import yaml

from disc_model.paper import SCANS, SURVIVAL_GRIDS, disc, section41, section42, section43, section44, survival
from disc_model.paper.ledger import CLAIMS, COLUMNS, check_claims
from disc_model.paper.measures import CaseView, views
from disc_model.paper.model import (
    FAILS,
    HOLDS,
    NOT_COMPUTED,
    REMARK,
    UNDECIDED,
    Answer,
    Claim,
    Finding,
    claims,
)
from disc_model.paper.survival import CONCLUSIONS
from disc_model.simulation.api import run_case
from disc_model.studies.merge import merge_cases
from disc_model.studies.study import load_study, parse_study
from tests.paper.made_up import kept_events


def cases_of(**cases: dict[str, Any]) -> dict[str, CaseView]:
    """Views of the merged cases of a study."""
    study = parse_study({"study": "x", "cases": {name: {"title": ""} | case for name, case in cases.items()}})
    tree = merge_cases({name: run_case(spec) for name, spec in study.specs.items()}, study.labels)
    return views({"cases": tree})


def test_cases_are_those_that_the_texts_speak_of() -> None:
    specs = load_study(Path(__file__).parents[2] / "config" / "paper.yaml").specs
    count = 0
    for claim in CLAIMS:
        if phrase := re.match(r"(?:.*, )?N = ([\d.]+) N, (?:Omega = )?([\d.]+) rad/s", claim.claim):
            parameters = [specs[name].parameters for name in claim.cases]
            assert tuple(map(float, phrase.groups())) in {(p.N, p.Omega) for p in parameters}, claim.id
            count += 1
    assert count > 10


@pytest.mark.compiled
def test_the_table_has_every_claim_once_and_says_what_it_lacks() -> None:
    cases = cases_of(
        F13={"parameters": {"N": 385, "Omega": 15.1}, "t_end": 60, "record": {"events": False}},
        F11={"parameters": {"N": 385, "Omega": 15}, "t_end": 1},
        F16={"parameters": {"N": 60, "Omega": 15}, "t_end": 1},
    )
    table = check_claims(cases)
    assert [*table.columns] == COLUMNS
    assert list(table["id"]) == [claim.id for claim in CLAIMS]
    table = table.set_index("id")
    computed = ~table["verdict"].str.startswith(NOT_COMPUTED)
    assert table["ours"][computed].str.len().gt(0).all()
    assert table["ours"][~computed].eq("").all()
    assert table["remark"][table["verdict"] == REMARK].str.len().gt(0).all()
    expected = {"F13": REMARK, "P01": REMARK, "P02": HOLDS, "P04": REMARK, "P06": UNDECIDED, "P07": FAILS}
    assert table["verdict"][list(expected)].to_dict() == expected
    assert table.loc["F13", "ours"] == "first separation at 54.42 s"
    assert table.loc["P04", "ours"].startswith("850.86, 1492.55, 1516.76, 1814.90")
    assert table.loc["P07", "ours"] == "911.94 rad/s"
    for claim, reason in (
        ("F04", "F04 is not in this study"),
        ("F11", "F11 ends at 1 s"),
        ("F16", "F16 has another N"),
    ):
        assert table.loc[claim, "verdict"].startswith(f"{NOT_COMPUTED}: case {reason}")


def test_a_case_that_starts_elsewhere_is_not_the_papers() -> None:
    case = {"parameters": {"N": 385, "Omega": 15}, "t_end": 0.01, "start": {"perturbation": {"f": 1.0}}}
    claim = Claim(id="x", check=lambda _: Answer(True), location="", claim="", cases={"F11": 0}, ours="")
    reason = "case F11 does not begin with the static start in this study"
    assert claim.evaluate(cases_of(F11=case)).verdict == f"{NOT_COMPUTED}: {reason}"
    assert claim.evaluate(cases_of(F11=case | {"start": {}})).verdict == HOLDS


def test_the_workflow_is_told_of_every_scan_and_every_check_has_a_text() -> None:
    assert sorted({"basins"}.union(*(claim.scans + claim.beside for claim in CLAIMS))) == sorted(SCANS)
    assert {*SURVIVAL_GRIDS} == {name for claim in CONCLUSIONS for name in claim.scans}
    for modules, texts in (((disc, section41, section42, section43, section44), CLAIMS), ((survival,), CONCLUSIONS)):
        functions = {one for module in modules for one in vars(module).values() if isinstance(one, FunctionType)}
        checks = {one for one in functions if one.__annotations__.get("return") is Answer}
        assert checks == {claim.check for claim in texts}


# ----------------------------------------------------------------------------------------------------
# Texts

TEXT = {
    "check": "A",
    "location": "Sec. 1",
    "claim": "It moves",
    "ours": "by {{ width|as('.1f mm') }}; {{ rows }}",
    "parts": {"rows": "{{ N|as('g') }} N"},
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
    check = lambda least: Answer(True, width=[1e-3, 2e-3], rows=[{"N": 3}, {"N": 5}], why=least > 1, chaos=0)  # noqa: E731
    extra = {"bounds": {"least": 2.0}, "remarks": {"why": "beyond {{ least|as('g') }}", "chaos": None}}
    first, second = claims_from(tmp_path, {"A": check}, X=TEXT | extra, Y=TEXT | {"bounds": {"least": 1.0}})
    assert first.evaluate({}) == Finding("by 1.0 mm, 2.0 mm; 3 N; 5 N", REMARK, "beyond 2")
    assert second.evaluate({}) == Finding("by 1.0 mm, 2.0 mm; 3 N; 5 N", HOLDS)
    open_ = claim_of(tmp_path, lambda: Answer(None, "chaos", width=[], rows=[]), undecided={"chaos": None})
    chaos = "the 0-1 test lies between regular and chaotic motion"  # a text that claims share
    assert open_.evaluate({}) == Finding("by none; ", UNDECIDED, chaos)


@pytest.mark.parametrize(
    ("bounds", "turned"),
    [
        ({"most": 10.0}, "stable"),  # the value is 3
        ({"most": 5.0}, "does not hold with most = 2.5"),
        ({"most": 2.0}, "holds with most = 4"),
        ({"most": 5.0, "share": 1.2}, "does not hold with most = 2.5; undecided with share = 1.4"),
        ({}, ""),
    ],
)
def test_a_verdict_says_which_bound_it_turns_on(tmp_path: Path, bounds: dict[str, float], turned: str) -> None:
    check = lambda most=9, share=0: Answer(None if share > 1.3 else most > 3, "chaos", width=3, rows=[])  # noqa: E731
    result = claim_of(tmp_path, check, bounds=bounds, undecided={"chaos": None}).judge({})
    assert result.robust == turned
    hangs = turned not in ("", "stable")
    assert (result.verdict == UNDECIDED, turned in result.remark) == (hangs, hangs or not turned)


# ----------------------------------------------------------------------------------------------------
# Measures


def test_durations_and_shares_of_phases() -> None:
    events = [(1.0, "reattachment", "slip"), (2.0, "separation", "separation"), (2.5, "reattachment", "slip")]
    events += [(3.0, "separation", "separation"), (3.25, "reattachment", "slip"), (4.0, "separation", "separation")]
    groups = {"/": xr.Dataset({"time_reached": 5.0}), "/events": kept_events(events, 0.0, 5.0)}
    case = CaseView("X", xr.DataTree.from_dict(groups))
    durations, still_open = case.separation_durations()
    np.testing.assert_array_equal(durations, [0.5, 0.25])
    assert still_open == 1.0
    assert case.rate_of("separation") == pytest.approx(3 / 5)
    assert case.phase_share("slip") == pytest.approx((1 + 0.5 + 0.75) / 4)
