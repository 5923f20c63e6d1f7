"""The ledger's table: complete, computed, and honest about what it lacks."""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import FunctionType, ModuleType, SimpleNamespace
from typing import Any, NoReturn

import numpy as np
import pandas as pd
import pytest

from disc_model import Parameters, simulate, steady_sliding
from disc_model.analysis.spectra import Line
from disc_model.studies.study import load_study
from tests.paper import evidence
from tests.paper.known import known
from workflow.paper import (
    JUDGING_TABLES,
    SCANS,
    SURVIVAL_GRIDS,
    TABLE_CASES,
    energy,
    judging_tables,
    paper_tables,
    section41,
    survival,
)
from workflow.paper.energy import Powers
from workflow.paper.ledger import COLUMNS, MODULES, ROWS, check_claims, tables_of
from workflow.paper.measures import Absent, CaseView
from workflow.paper.model import FALSE, NOT_COMPUTED, TRUE, VERDICTS, Answer, Row

ROOT = Path(__file__).parents[2]
STUDY = load_study(ROOT / "config" / "paper.yaml")


def labelled(name: str, **attrs: str) -> CaseView:
    """Return a case whose file says otherwise what it is."""
    groups = dict(evidence.groups_of(name))
    groups[""] = groups[""].assign_attrs(attrs)
    return evidence.view(name, groups)


# ---- Rows


def test_there_are_few_enough_rows_to_read_each_with_its_quotation() -> None:
    assert len(ROWS) <= 84  # five of the last sentences had no row
    assert len({row.quote for row in ROWS}) == len(ROWS)
    assert len({row.id for row in ROWS}) == len(ROWS)


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.id)
def test_a_row_quotes_says_why_it_matters_and_how_it_is_judged(row: Row) -> None:
    assert len(row.quote.split()) >= 4
    assert row.matters.endswith(".")
    if row.check:
        assert row.judged
    else:
        assert row.verdict in VERDICTS
    code = re.search(r"\b[FSTP]\d\d", f"{row.matters} {row.rule} {row.note}")
    assert code is None, "a name of ours that readers do not know"


def test_the_pictures_that_rows_name_are_drawn() -> None:
    grids, *_ = STUDY.grids((ROOT,))
    drawn = {*STUDY.figures}
    for grid in grids.values():
        drawn.update(grid.plots)
    for row in ROWS:
        assert {*row.figures} <= drawn, row.id


def test_the_workflow_is_told_of_every_scan() -> None:
    scans = {name for row in ROWS for name in row.scans + row.optional_scans}
    assert sorted(scans) == sorted(SCANS)
    of_survival = {name for row in survival.CONCLUSIONS for name in row.scans}
    assert of_survival == {*SURVIVAL_GRIDS}


def test_the_workflow_is_told_of_every_table_that_a_check_is_given() -> None:
    tables = {name for row in ROWS for name in row.from_tables}
    assert sorted(tables) == sorted(JUDGING_TABLES)
    for row in ROWS:
        for name in row.from_tables:
            assert {*TABLE_CASES[name]} == {*row.cases}, row.id


@pytest.mark.parametrize(
    ("modules", "rows"),
    [(MODULES, ROWS), ((survival,), survival.CONCLUSIONS)],
    ids=["ledger", "survival"],
)
def test_every_check_has_a_row(modules: Sequence[ModuleType], rows: Sequence[Row]) -> None:
    checks = set()
    for module in modules:
        for function in vars(module).values():
            returned = getattr(function, "__annotations__", {}).get("return")
            if isinstance(function, FunctionType) and returned is Answer:
                checks.add(function)
    assert checks == {row.check for row in rows if row.check}


# ---- The table


@pytest.mark.compiled
def test_the_table_has_every_row_once_and_says_what_it_lacks() -> None:
    cases = evidence.cases({"F11": {"says": {"time_reached": 1.0}}})
    del cases["F04"]
    cases["F16"] = labelled("F16", parameters=Parameters(N=60, Omega=15).canonical_json)
    table = check_claims(cases, evidence.tables())
    assert [*table.columns] == COLUMNS
    assert list(table["id"]) == [row.id for row in ROWS]
    table = table.set_index("id")
    assert table["here"].str.len().gt(0).all()

    expected = {"F13": TRUE, "P04": TRUE, "P07": FALSE, "eq17": FALSE}
    assert table["verdict"][list(expected)].to_dict() == expected
    assert table.loc["F13", "here"].startswith("Contact is lost at 54.42 s")
    assert "frequencies are 850.86, 1492.55, 1516.76, 1814.90, " in table.loc["P04", "here"]

    lacking = {
        "F04": "F04 is not in this study",
        "F11": "F11 ends at 1 s",
        "F16": "F16 has another N",
    }
    for row, reason in lacking.items():
        assert table.loc[row, "verdict"] == NOT_COMPUTED
        assert table.loc[row, "here"].startswith(f"case {reason}")


def test_a_case_that_starts_elsewhere_is_not_the_papers() -> None:
    elsewhere = labelled("F11", start='{"perturbation": {"f": 1.0}}')
    row = Row(id="x", check=lambda _: Answer(True, ""), place="", cases={"F11": 0})
    assert row.judge({"F11": elsewhere}).here == "case F11 has another start in this study."
    assert row.judge({"F11": labelled("F11")}).verdict == TRUE


# ---- Tables of what results rest on


@pytest.mark.compiled
def test_the_table_of_impacts_has_what_follows_them_or_why_not() -> None:
    cases = evidence.cases({"P03res": "F11"})
    table = paper_tables.impact_law(cases)
    case = cases["P03l8"]
    row = table.set_index("modes").loc["8 nodal diameters"]
    assert row["rate_Hz"] == pytest.approx(case.rate_of("separation"), rel=1e-12)
    assert row["longest_ms"] == pytest.approx(1e3 * case.longest_separation, rel=1e-12)
    assert np.isnan(table["rate_Hz"].iloc[-1])
    assert "separation" in table["releases"].iloc[-1]


def test_a_motion_of_few_releases_is_undecided() -> None:
    motion, _ = paper_tables.motion_to(Parameters(N=300, Omega=20), 0.1)
    assert str(motion) == "undecided"


class Case(dict[str, float]):
    """A case of the paper without its results."""

    parameters = Parameters(N=300, Omega=20)


def repeating(
    p: Parameters, t_end: float, tol: float = 1e-10, start: object = None
) -> tuple[object, object]:
    """Return a motion of period 45 from 0.01 rad/s below its speed to 0.02 above."""
    change = p.Omega - Case.parameters.Omega
    repeats = -0.01 < change < 0.02 and p.n_diameters != 8
    period = 0
    if repeats:
        period = 45
    motion = SimpleNamespace(period=period, kind="irregular")
    return motion, SimpleNamespace(time=t_end)


def test_a_period_is_told_with_the_speeds_between_which_it_is_the_same(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(paper_tables, "motion_to", repeating)
    case = Case(t_end=100.0)
    table = paper_tables.periods({"F02": case, "F07": case, "F22": case})
    place = "300 N, 20 rad/s"
    assert table["case"].tolist() == [place, place, f"{place}, k_p = 20 kN/m"]
    assert set(table["one nodal circle"]) == {"45"}
    assert set(table["8 nodal diameters"]) == {"irregular"}
    # known to an eighth
    assert 0.03 * 7 / 8 < table["width"][0] < 0.03


# ---- Table 2

F_S = 67.0
"""Frequency of stick and slip in the spectra that are made up, Hz."""


class Spectrum:
    """Spectra of a case: of psi with f_s, and of the disc's point near the frequencies of Table 2.

    What is asked of the latter is kept.
    """

    drive = 15 / (2 * np.pi)

    def __init__(self) -> None:
        self.searched: dict[float, float] = {}

    def signal(self, window: str, start: float, stop: float, name: str = "w_point") -> object:
        assert window == "spectrum_a"
        assert start == 0
        assert stop == 10
        if name == "psi":
            return SimpleNamespace(lines=self.lines_of_psi)
        return SimpleNamespace(strongest=self.strongest)

    def lines_of_psi(self, count: int, above: float) -> list[Line]:
        assert count == 1
        assert above == 20.0
        return [Line(F_S, 0.3)]

    def strongest(self, near: float, within: float) -> Line:
        self.searched[near] = within
        return self.lines[near]

    @property
    def lines(self) -> dict[float, Line]:
        """The drive's line, two of which the stronger is ten times as high, and weak ones."""
        weak = {listed: Line(listed + 0.5, 1e-3) for listed in paper_tables.LISTED}
        known = {
            2.4: Line(self.drive, 0.01),
            65.5: Line(F_S - self.drive + 0.29, 0.1),
            133.0: Line(2 * F_S, 0.001),
            138.0: Line(2 * F_S + 2 * self.drive - 0.31, 0.02),
        }
        return weak | known


def test_table_2_has_levels_in_decibels_of_amplitude_and_names_of_lines() -> None:
    case = Spectrum()
    table = paper_tables.table_2(case).set_index("paper_Hz")
    assert [*table.reset_index()[paper_tables.COLUMNS]] == paper_tables.COLUMNS
    # a factor of ten in amplitude is 20 dB, relative to the drive's line
    levels = table["level_dB"][[2.4, 65.5, 133.0]]
    assert levels.tolist() == pytest.approx([0, 20, -20])
    assert table["level_dB"][138.0] == pytest.approx(20 * np.log10(2))
    assert table["ours_Hz"][133.0] == 2 * F_S
    assert table["ours_is"][2.4] == "f_Ω"
    # named up to 0.3 Hz from a combination
    assert table["ours_is"][65.5] == "f_s − f_Ω"
    assert table["ours_is"][133.0] == "2 f_s"
    assert table["ours_is"][138.0] == paper_tables.UNNAMED
    assert table["predicted_Hz"][138.0] == pytest.approx(2 * F_S + 2 * case.drive)
    assert table["predicted_Hz"][65.5] == pytest.approx(F_S - case.drive)
    # the drive's line is near others
    assert case.searched == {2.4: 0.5, **dict.fromkeys(paper_tables.LISTED[1:], 2.0)}


def test_table_1_has_the_papers_value_beside_that_of_a_case() -> None:
    table = paper_tables.table_1(Parameters(N=200, Omega=20, k_p=1e4)).set_index("symbol")
    assert table.loc["k_p", ["unit", "paper", "ours"]].tolist() == ["N/m", 2e4, 1e4]
    assert table.loc["a", ["unit", "paper", "ours"]].tolist() == ["m", 0.044, 0.044]
    same = table.drop("k_p")
    assert (same["paper"] == same["ours"]).all()


def test_a_table_that_is_not_given_is_made_of_its_cases(monkeypatch: pytest.MonkeyPatch) -> None:
    def names(cases: Mapping[str, CaseView]) -> pd.DataFrame:
        return pd.DataFrame({"case": [*cases]})

    for name in JUDGING_TABLES:
        monkeypatch.setitem(paper_tables.TABLES, name, names)
    cases = {name: labelled(name) for name in ("F11", "F13", "F16")}
    given = names({"F12": cases["F11"]})
    tables = tables_of(cases, {"precursor": given})
    # there is none of energies, whose cases are not there
    assert tables.keys() == {"precursor", "small_changes"}
    assert tables["precursor"] is given
    assert list(tables["small_changes"]["case"]) == ["F11", "F13"]


def test_a_check_is_given_its_tables_or_says_which_is_missing() -> None:
    def judged(case: CaseView, *, listed: pd.DataFrame) -> Answer:
        return Answer(list(listed["case"]) == [case.name])

    row = Row(id="x", check=judged, place="", cases={"F11": 0}, from_tables=("listed",))
    cases = {"F11": labelled("F11")}
    assert row.judge(cases, {"listed": pd.DataFrame({"case": ["F11"]})}).verdict == TRUE
    assert row.judge(cases, {"listed": pd.DataFrame({"case": ["F12"]})}).verdict == FALSE
    assert row.judge(cases).here == "table listed is not among those of this run."


@pytest.mark.compiled
def test_small_changes_say_when_contact_is_lost(monkeypatch: pytest.MonkeyPatch) -> None:
    """At 385 N, 15.1 rad/s it is lost at 54 s, and a smaller preload keeps it for longer."""
    monkeypatch.setattr(judging_tables, "FOLLOWED", 60.0)
    monkeypatch.setattr(judging_tables, "PHYSICAL", ("N", "mu_k"))
    p = Parameters(N=385, Omega=15.1)
    table = judging_tables.small_changes({"here": known(name="here", parameters=p)})
    assert [*table["case"]] == ["here", "here"]
    for row in table.itertuples():
        changed = p.replace(**{row.parameter: 1.001 * getattr(p, row.parameter)})
        run = simulate(changed, 60.0, stop_at="first_separation")
        # the same simulation: equal but for the sum of equal steps
        assert row.first_s == pytest.approx(run.first_separation, rel=1e-12, nan_ok=True)
    assert table["first_s"].notna().any()


def test_energies_are_of_pairs_and_say_what_they_lack(monkeypatch: pytest.MonkeyPatch) -> None:
    bilateral = Parameters(N=200, Omega=20, contact="bilateral")
    free = known(
        {"time_reached": 10.0},
        name="free",
        bilateral=False,
        parameters=bilateral.replace(contact="unilateral"),
        intervals=lambda kind: np.array([7e-3, 9e-3]),
    )
    at_end = SimpleNamespace(final_state="at the end")
    run = SimpleNamespace(raise_for_status=lambda: at_end)
    monkeypatch.setattr(judging_tables, "simulate", lambda p, until, events: run)
    kept = known({"time_reached": 20.0}, name="kept", bilateral=True, parameters=bilateral)
    steady = Powers(3e-3, 0.5, 0.0, 0.3, 0.0)
    grown = Powers(3e-3, 0.9, 0.0, 0.3, 0.6)

    def at_range(
        p: Parameters, until: float, width: float, stages: Sequence[Powers]
    ) -> tuple[Powers, float]:
        assert (p.contact, until, width) == ("bilateral", 20.0, 3e-3)
        assert stages == [late] * 4
        return grown, 15.0

    def history(p: Parameters, until: float) -> list[Powers]:
        return [steady if p.contact == "unilateral" else late] * 4

    late = Powers(9e-3, 4.0, -3.0, 1.0, 0.0)
    monkeypatch.setattr(energy, "power_history", history)

    def soft(p: Parameters, state: str) -> np.ndarray:
        assert (p.contact, state) == ("unilateral", "at the end")
        return np.array([0.2, 0.3, 0.4])

    monkeypatch.setattr(energy, "at_range", at_range)
    monkeypatch.setattr(energy, "taken_in_compliant_contact", soft)
    row = judging_tables.energies({"free": free, "kept": kept}).iloc[0]
    # mJ in a period of 8 ms
    expected = [4.0, 7.2, 2.4, 1.6, 4.8]
    assert row[judging_tables.ENERGIES].to_list() == pytest.approx(expected, rel=1e-12)
    assert row[judging_tables.COMPLIANT].to_list() == pytest.approx([2.4, 1.6, 3.2], rel=1e-12)
    assert row[judging_tables.POWERS].to_list() == [4.0, -3.0]
    assert pd.isna(row["remark"])

    def too_small(*_: Any) -> NoReturn:
        raise Absent("maintained contact comes to 1 mm only")

    monkeypatch.setattr(energy, "at_range", too_small)
    table = judging_tables.energies({"free": free, "kept": kept})
    assert table["remark"].to_list() == ["maintained contact comes to 1 mm only"]
    pairs = section41.pairs([free, kept])
    with pytest.raises(Absent, match="1 mm only"):
        section41.excites_less(*pairs[0], energies=table, share=0.5)


def test_growth_of_sliding_is_that_of_three_models(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(judging_tables, "SPEEDS", np.array([1000.0]))
    monkeypatch.setitem(judging_tables.PRECURSOR, "loads", [50])
    (row,) = judging_tables.precursor({}).itertuples(index=False)
    p = Parameters(N=50, Omega=1000, contact="bilateral", c_p=5, friction_decay=0.02)
    models = (p.replace(mu_s=0, mu_k=0), p, p.replace(c=0.5))
    rates = [steady_sliding(model).growth_rate for model in models]
    assert [*row] == pytest.approx([50, 1000, *rates], rel=1e-12)
    assert len({*rates}) == 3
