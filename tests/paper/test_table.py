"""The ledger's table: complete, computed, and honest about what it lacks."""

import re
from pathlib import Path
from types import FunctionType, SimpleNamespace

import numpy as np
import pytest

from disc_model import Parameters
from disc_model.paper import SCANS, SURVIVAL_GRIDS, paper_tables, survival
from disc_model.paper.ledger import COLUMNS, MODULES, ROWS, check_claims
from disc_model.paper.measures import CaseView
from disc_model.paper.model import FALSE, NOT_COMPUTED, TRUE, VERDICTS, Answer, Row
from disc_model.paper.paper_tables import impact_law
from disc_model.paper.survival import CONCLUSIONS
from disc_model.studies.study import load_study
from tests.paper import evidence

ROOT = Path(__file__).parents[2]
STUDY = load_study(ROOT / "config" / "paper.yaml")


def labelled(name: str, **attrs: str) -> CaseView:
    """A case whose file says otherwise what it is."""
    groups = evidence.groups_of(name)
    return evidence.view(name, groups | {"": groups[""].assign_attrs(attrs)})


def test_rows_quote_say_why_and_show() -> None:
    """There are few enough to read; each has a quotation of its own, and the pictures that it names
    are drawn."""
    assert len(ROWS) <= 80
    assert len({row.quote for row in ROWS}) == len({row.id for row in ROWS}) == len(ROWS)
    drawn = {
        *STUDY.figures,
        *(name for grid in STUDY.grids((ROOT,))[0].values() for name in grid.plots),
    }
    for row in ROWS:
        assert len(row.quote.split()) >= 4, row.id
        assert row.matters.endswith("."), row.id
        assert row.judged if row.check else row.verdict in VERDICTS, row.id
        assert {*row.figures} <= drawn, row.id
        assert not re.search(r"\b[FSTP]\d\d", f"{row.matters} {row.rule} {row.note}"), (
            f"{row.id}: a code of ours"
        )


@pytest.mark.compiled
def test_the_table_of_impacts_has_what_follows_them_or_why_not() -> None:
    cases = evidence.cases({"P03res": "F11"})
    table = impact_law(cases)
    case = cases["P03l8"]
    row = table.set_index("modes").loc["8 nodal diameters"]
    assert row["rate_Hz"] == pytest.approx(case.rate_of("separation"), rel=1e-12)
    assert row["longest_ms"] == pytest.approx(1e3 * case.longest_separation, rel=1e-12)
    assert np.isnan(table["rate_Hz"].iloc[-1])
    assert "separation" in table["releases"].iloc[-1]


def test_a_period_is_told_with_the_speeds_between_which_it_is_the_same(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Known to an eighth: of a motion of period 45 from 0.01 rad/s below to 0.02 above."""

    class Case(dict[str, float]):
        parameters = Parameters(N=300, Omega=20)

    def motion_to(
        p: Parameters, t_end: float, tol: float = 1e-10, start: object = None
    ) -> tuple[object, object]:
        period = 45 * (-0.01 < p.Omega - 20 < 0.02 and p.n_diameters != 8)
        return SimpleNamespace(period=period, kind="irregular"), SimpleNamespace(time=t_end)

    assert str(paper_tables.motion_to(Case.parameters, 0.1)[0]) == "undecided"  # too few releases
    monkeypatch.setattr(paper_tables, "motion_to", motion_to)
    table = paper_tables.periods(dict.fromkeys(("F02", "F07", "F22"), Case(t_end=100.0)))
    assert table["case"].tolist() == [*["300 N, 20 rad/s"] * 2, "300 N, 20 rad/s, k_p = 20 kN/m"]
    assert (set(table["one nodal circle"]), set(table["8 nodal diameters"])) == (
        {"45"},
        {"irregular"},
    )
    assert 0.03 * 7 / 8 < table["width"][0] < 0.03


@pytest.mark.compiled
def test_the_table_has_every_row_once_and_says_what_it_lacks() -> None:
    cases = evidence.cases({"F11": {"says": {"time_reached": 1.0}}})
    del cases["F04"]
    cases["F16"] = labelled("F16", parameters=Parameters(N=60, Omega=15).canonical_json)
    table = check_claims(cases)
    assert [*table.columns] == COLUMNS
    assert list(table["id"]) == [row.id for row in ROWS]
    table = table.set_index("id")
    assert table["here"].str.len().gt(0).all()
    expected = {"F13": TRUE, "P04": TRUE, "P07": FALSE, "eq17": FALSE}
    assert table["verdict"][list(expected)].to_dict() == expected
    assert table.loc["F13", "here"].startswith("Contact is lost at 54.42 s")
    assert "frequencies are 850.86, 1492.55, 1516.76, 1814.90, " in table.loc["P04", "here"]
    for row, reason in (
        ("F04", "F04 is not in this study"),
        ("F11", "F11 ends at 1 s"),
        ("F16", "F16 has another N"),
    ):
        assert table.loc[row, "verdict"] == NOT_COMPUTED
        assert table.loc[row, "here"].startswith(f"case {reason}")


def test_a_case_that_starts_elsewhere_is_not_the_papers() -> None:
    elsewhere = labelled("F11", start='{"perturbation": {"f": 1.0}}')
    row = Row(id="x", check=lambda _: Answer(True, ""), place="", cases={"F11": 0})
    assert row.judge({"F11": elsewhere}).here == "case F11 has another start in this study."
    assert row.judge({"F11": labelled("F11")}).verdict == TRUE


def test_the_workflow_is_told_of_every_scan_and_every_check_has_a_row() -> None:
    assert sorted(set().union(*(row.scans + row.beside for row in ROWS))) == sorted(SCANS)
    assert {*SURVIVAL_GRIDS} == {name for row in CONCLUSIONS for name in row.scans}
    for modules, rows in ((MODULES, ROWS), ((survival,), CONCLUSIONS)):
        functions = {
            one
            for module in modules
            for one in vars(module).values()
            if isinstance(one, FunctionType)
        }
        checks = {one for one in functions if one.__annotations__.get("return") is Answer}
        assert checks == {row.check for row in rows if row.check}
