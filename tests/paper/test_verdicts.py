"""Verdicts follow the evidence.

Rows of the ledger are judged by the paper's cases, as simulated and as they are not.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from disc_model import Parameters
from disc_model.disc.modes import plate_modes
from tests.damages import DAMAGES, damaged
from tests.paper import evidence
from workflow.paper import growth, ledger, section2, section44
from workflow.paper.measures import CaseView, views
from workflow.paper.model import FALSE, NOT_COMPUTED, PART, TRUE, VERDICTS, Answer

pytestmark = pytest.mark.compiled
BY_NAME = {row.id: row for row in ledger.ROWS if row.check}


# ---- Rows come out in more than one way


@dataclass(frozen=True)
class World:
    """Evidence for rows; what is not given is simulated.

    Attributes
    ----------
    cases : stories of cases, by one name or several
    scans : grid studies by name
    functions : of modules, by module and name
    tables : tables that checks are given, by name
    rows : the rows that are judged, all of them unless some are named
    """

    cases: Mapping[str, Any] = field(default_factory=dict)
    scans: Mapping[str, xr.Dataset] = field(default_factory=evidence.scans)
    functions: Mapping[Any, Mapping[str, Callable[..., Any]]] = field(default_factory=dict)
    tables: Mapping[str, pd.DataFrame] = field(default_factory=evidence.tables)
    rows: tuple[str, ...] = tuple(BY_NAME)

    def verdicts(self) -> dict[str, str]:
        """Return the verdicts of the rows in this world."""
        with pytest.MonkeyPatch.context() as patch:
            for module, functions in self.functions.items():
                for name, function in functions.items():
                    patch.setattr(module, name, function)
            cases = evidence.cases(self.cases, self.scans)
            return {name: BY_NAME[name].judge(cases, self.tables).verdict for name in self.rows}


def mirrored(p: Parameters, growth_of: Callable[[Parameters], float] = growth.growth_of) -> float:
    """Return the growth of a case, negative instead of positive."""
    return -growth_of(p)


def slower(p: Parameters) -> pd.DataFrame:
    """Return modes of a disc on which a load is critical at 608 rad/s."""
    modes = plate_modes(p)
    paired = modes[modes["diameters"] > 0]
    critical = (paired["omega"] / paired["diameters"]).min()
    return modes.assign(omega=modes["omega"] * 608 / critical)


def alone(p: Parameters) -> np.ndarray:
    """Return natural frequencies of the disc without the slider, rad/s."""
    return np.repeat(plate_modes(p)["omega"], 2)[1:]


def massless(p: Parameters) -> pd.DataFrame:
    """Return modes for which the second relation of Eq. (17) holds as printed."""
    return plate_modes(p).assign(omega=np.sqrt(p.D))


def without_contact(
    case: CaseView, kind: str, times_of: Callable[[CaseView, str], Any] = CaseView.times_of
) -> Any:
    """Return the times of a case's events of one kind, as if no separation ended."""
    times = times_of(case, kind)
    return times[:0] if kind == "reattachment" else times


def of_a_disc(row: str, **functions: Callable[[Parameters], Any]) -> World:
    """Return the world of another disc, for one row.

    Parameters
    ----------
    row : its name
    functions : by which its module judges it
    """
    module = section2
    if row in ("T2e", "F29", "C5"):
        module = section44
    return World(functions={module: functions}, rows=(row,))


def of_sliding(*rows: tuple[float, float, float, float]) -> World:
    """Return the world in which sliding grows so, for the rows on the precursor."""
    tables = {"precursor": evidence.sliding_growths(*rows)}
    return World(tables=tables, rows=("A98i", "A98r"))


def told(text: Mapping[str, Any]) -> World:
    """Return a world of stories.yaml."""
    stories = text["cases"]
    if "all" in stories:
        stories = {" ".join(evidence.SPECS): stories["all"]}
    rows = tuple(BY_NAME)
    if "rows" in text:
        rows = tuple(text["rows"].split())
    return World(stories, evidence.scans(**text.get("scans", {})), rows=rows)


WORLDS = {
    "as simulated": World(),
    "other grids and cycles": World(
        scans=evidence.scans(**evidence.TEXTS["scans to the contrary"]),
        functions={growth: {"growth_of": mirrored}},
        # more than half of the surplus is withheld, and the negative force supplies energy
        tables=evidence.tables(supplied=2.5, pulls=1.0),
    ),
    "growth with the stiffness": World(
        functions={growth: {"growth_of": lambda p: p.k_p}}, rows=("S43kpg",)
    ),
    "a slower disc": of_a_disc("P07", plate_modes=slower),
    "no slider": of_a_disc("P04", coupled_natural_frequencies=alone),
    "normalised modes": of_a_disc("eq17", norms=lambda p: np.ones(5)),
    "a plate without mass and stiffness": of_a_disc("E17", plate_modes=massless),
    "natural frequencies where the lines are": of_a_disc(
        "T2e", coupled_natural_frequencies=lambda p: 2 * np.pi * np.array([135.3, 202.9, 270.5])
    ),
    "lines at natural frequencies": of_a_disc(
        "C5", close_to_natural=lambda case, within: Answer(TRUE, far=(0, 6))
    ),
    "separations without an end": World(
        functions={CaseView: {"times_of": without_contact}}, rows=("C1r",)
    ),
    "the stiff disc": of_a_disc("F29", plate_modes=lambda p: plate_modes(p.replace(E=150e9))),
    "friction that changes nothing": of_sliding((500.0, -1.0, -1.0, -1.0), (1500.0, 1.0, 1.0, 1.0)),
    "friction as the precursor has it": of_sliding(
        (500.0, -0.1, 0.2, 0.3), (1500.0, 0.1, -0.2, -0.2)
    ),
    **{name: told(text) for name, text in evidence.TEXTS["worlds"].items()},
}


def test_every_row_can_come_out_in_another_way() -> None:
    """A check that comes out the same whatever was computed decides nothing."""
    verdicts = [world.verdicts() for world in WORLDS.values()]
    for row in BY_NAME:
        found = {each[row] for each in verdicts if row in each}
        assert len(found - {NOT_COMPUTED}) > 1, (row, found)


# ---- What evidence lacks


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("damage", ["no events", "two samples"])
def test_what_a_study_lacks_ends_no_table(damage: str) -> None:
    """This used to be a KeyError, IndexError, ValueError or ZeroDivisionError."""
    cases = {}
    for name, node in evidence.simulated().items():
        cases[name] = CaseView(name, damaged(node, DAMAGES[damage]))
    answers = [row.judge(cases, evidence.tables()) for row in ledger.ROWS]
    assert {answer.verdict for answer in answers} <= {*VERDICTS}
    lacking = [answer for answer in answers if answer.verdict == NOT_COMPUTED]
    assert any(answer.here.startswith("case ") for answer in lacking)


def growing_in_the_end(groups: evidence.Groups) -> evidence.Groups:
    """Return groups with ranges of the last 20 s a twentieth wider: no steady state."""
    if "history" not in groups:
        return groups
    history = groups["history"]
    late = history["time"] > float(history["time"][-1]) - 20
    for name in ("P", "w_point"):
        high = history[f"{name}_max"]
        width = high - history[f"{name}_min"]
        history = history.assign({f"{name}_max": high + 0.05 * late * width})
    return {**groups, "history": history}


def test_a_motion_that_still_grows_has_no_steady_state() -> None:
    """Late stretches used to be called steady because they were late."""
    cases = evidence.cases({}, evidence.scans())
    for name in evidence.SPECS:
        cases[name] = evidence.view(name, growing_in_the_end(evidence.groups_of(name)))
    steady = [row for row in ledger.ROWS if row.steady]
    assert len(steady) > 10
    for row in steady:
        answer = row.judge(cases, evidence.tables())
        assert answer.verdict == NOT_COMPUTED, row.id
        assert "has not settled in" in answer.here, row.id


# ---- Single verdicts


def name_of(case: Mapping[str, Any]) -> str:
    """Return the row and the verdict of a case of stories.yaml."""
    return f"{case['row']}: {case['verdict']}"


@pytest.mark.parametrize("case", evidence.TEXTS["verdicts"], ids=name_of)
def test_a_verdict_follows_from_what_there_is(case: dict[str, Any]) -> None:
    stories = dict(case.get("cases", {}))
    for name, values in case.get("says", {}).items():
        stories[name] = {"says": values}
    changes = case.get("scans", {})
    scans = None
    if changes is not None:
        scans = evidence.scans(**changes)
    answer = BY_NAME[case["row"]].judge(evidence.cases(stories, scans), evidence.tables())
    assert answer.verdict == case["verdict"], vars(answer)
    assert case.get("phrase", "") in f"{answer.here} {answer.notes}"


# ---- The two normalisations


@pytest.fixture(scope="module")
def sections() -> dict[str, Any]:
    """The page of ten cases under both normalisations: one failed, and one the paper has not."""
    names = ("F02", "F02free", "F04", "F13", "F17", "F18", "F20", "T2kp18", "S43N550", "S43N550a")
    published = {name: evidence.simulated()[name] for name in names}
    orthonormal = dict(evidence.simulated(*names, normalization="orthonormal"))
    orthonormal["F20"] = damaged(orthonormal["F20"], DAMAGES["failed"])
    orthonormal["X30"] = orthonormal["F02"]
    both = []
    for nodes in (published, orthonormal):
        tree = xr.DataTree.from_dict({f"/{name}": node for name, node in nodes.items()})
        both.append(views({"cases": tree}))
    return ledger.compare(*both)


def test_the_page_of_normalisations_has_all_parts_and_no_nan(sections: dict[str, Any]) -> None:
    assert [*sections] == ["brief", "modes", "cases", "instead", "verdicts"]
    for _, _, table in sections.values():
        assert not table.map(lambda cell: "nan" in str(cell)).any(axis=None)


def test_the_mode_with_one_diameter_is_too_strong_as_published(sections: dict[str, Any]) -> None:
    ratios = sections["modes"][2]["ratio"].astype(float)
    assert ratios[1] == pytest.approx(14, abs=1)
    assert ratios.drop(1).between(0.2, 0.8).all()


def test_cases_stand_beside_those_by_eq_17(sections: dict[str, Any]) -> None:
    rows = sections["cases"][2].set_index("Case")
    assert not {"F02free", "S43N550a"} & set(rows.index), "the same cases once more"
    assert rows.loc["F17", "First separation, as published"] == "810.15 s"
    new = rows["First separation, Eq. (17)"]
    assert new["F17"] == "none in 1240 s"
    assert new["F04"] == "ignored"
    assert new["F20"] == "failed"
    assert rows.loc["F13", "Growth, as published (1/s)"] == "–"
    assert rows.loc["T2kp18", "P in the end, Eq. (17) (N)"] == "–"
    assert list(sections["instead"][2]["Case"]) == ["X30"]


def test_statements_change_their_verdict(sections: dict[str, Any]) -> None:
    changed = sections["verdicts"][2]
    assert {TRUE, PART, FALSE} >= set(changed["As published"])
    assert changed.loc["F02a", "With Eq. (17)"] == FALSE


def test_the_brief_counts_cases_and_names_failures(sections: dict[str, Any]) -> None:
    _, text, table = sections["brief"]
    counts = table.set_index("").T
    assert list(counts["cases that separate, of 7"]) == ["5", "1"]
    assert list(counts["first separation, 200 N, 15 rad/s"]) == ["810.15 s", "none in 1240 s"]
    [cycles] = [name for name in counts if name.startswith("cases whose stick-slip cycle")]
    rows = sections["cases"][2].set_index("Case").drop("F20")
    before = rows["Growth, as published (1/s)"]
    after = rows["Growth, Eq. (17) (1/s)"]
    known = (before != "–") & (after != "–")
    assert not known.all()
    assert f"of {known.sum()} that have one under both" in cycles
    grows = [before[known].str.startswith("+"), after[known].str.startswith("+")]
    assert list(counts[cycles]) == [str(each.sum()) for each in grows]
    assert "Without a result: F20." in text
