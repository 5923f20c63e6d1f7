"""Verdicts follow the evidence: the rows of the ledger judged by motions made up to fit them, and not to fit them."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from disc_model import Parameters
from disc_model.data.dataset import Missing
from disc_model.disc.plate import plate_modes
from disc_model.paper import measures, normalisation, section2, section41, section44
from disc_model.paper.ledger import ROWS
from disc_model.paper.measures import CaseView, views
from disc_model.paper.model import FALSE, NOT_COMPUTED, PART, TRUE, VERDICTS
from tests.damages import DAMAGES, Groups, damaged
from tests.paper import made_up
from tests.paper.made_up import AS_TOLD, TO_THE_CONTRARY, Story

pytestmark = pytest.mark.usefixtures("cycles_as_told")
BY_NAME = {row.id: row for row in ROWS if row.check}


@dataclass(frozen=True)
class World:
    """Made-up evidence for rows, all of them unless some are named."""

    stories: Mapping[str, Story]
    cycle: Callable[[Parameters], Any] = made_up.cycle_as_told
    course: Callable[[Parameters, float], Any] = made_up.course_as_told
    scans: Mapping[str, xr.Dataset] = field(default_factory=made_up.scans)
    disc: Mapping[str, Callable[[Parameters], Any]] = field(default_factory=dict)
    rows: tuple[str, ...] = tuple(BY_NAME)

    def verdicts(self) -> dict[str, str]:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(measures, "cycle_of", self.cycle)
            patch.setattr(section41, "course", self.course)
            for name, function in self.disc.items():
                for module in (section2, section44):
                    patch.setattr(module, name, function, raising=False)
            cases = made_up.cases(self.stories, self.scans)
            return {name: BY_NAME[name].judge(cases).verdict for name in self.rows}


def a_disc(*rows: str, **functions: Callable[[Parameters], Any]) -> World:
    """Another disc, and no motion."""
    return World({}, disc=functions, rows=rows)


def slower(p: Parameters) -> pd.DataFrame:
    """A disc on which a load is critical at 608 rad/s."""
    modes = plate_modes(p)
    paired = modes[modes["diameters"] > 0]
    return modes.assign(omega=modes["omega"] * 608 / (paired["omega"] / paired["diameters"]).min())


WORLDS = {
    "as told": World(AS_TOLD),
    "to the contrary": World(
        TO_THE_CONTRARY,
        made_up.cycle_to_the_contrary,
        made_up.course_to_the_contrary,
        made_up.scans(**made_up.TEXTS["scans to the contrary"]),
    ),
    "a slower disc": a_disc("P07", plate_modes=slower),
    "no slider": a_disc("P04", coupled_natural_frequencies=lambda p: np.repeat(plate_modes(p)["omega"], 2)[1:]),
    "normalised modes": a_disc("eq17", norms=lambda p: np.ones(5)),
    "a plate without mass and stiffness": a_disc(
        "E17", plate_modes=lambda p: plate_modes(p).assign(omega=np.sqrt(p.D))
    ),
    "natural frequencies where the lines are": World(
        {"F13": AS_TOLD["F13"]},
        disc={"coupled_natural_frequencies": lambda p: 2 * np.pi * np.array([135.3, 202.9, 270.5])},
        rows=("T2e",),
    ),
    "a soft disc with the frequency of the stiff one": World(
        {"F21": AS_TOLD["F21"]},
        disc={"plate_modes": lambda p: plate_modes(p.replace(E=150e9))},
        rows=("F29",),
    ),
}
for name, text in made_up.TEXTS["worlds"].items():
    cases, scans = made_up.stories(text["cases"], AS_TOLD), made_up.scans(**text.get("scans", {}))
    WORLDS[name] = World(cases, scans=scans, rows=tuple(text["rows"].split()))


def test_every_row_can_be_true_and_can_be_otherwise() -> None:
    """A check that comes out the same whatever was computed decides nothing."""
    verdicts = {name: world.verdicts() for name, world in WORLDS.items()}
    for row in BY_NAME:
        every = {each[row] for each in verdicts.values() if row in each}
        assert TRUE in every, (row, every)
        assert every - {TRUE, NOT_COMPUTED}, (row, every)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("damage", ["no events", "two samples", "nothing moves"])
def test_what_a_study_lacks_ends_no_table(damage: str, told: xr.DataTree) -> None:
    """This used to be a KeyError, IndexError, ValueError or ZeroDivisionError."""
    cases = {name: CaseView(name, damaged(node, DAMAGES[damage])) for name, node in told.children.items()}
    findings = [row.judge(cases) for row in ROWS]
    assert {each.verdict for each in findings} <= {*VERDICTS}
    assert any(each.verdict == NOT_COMPUTED and each.here.startswith("case ") for each in findings)


def growing_in_the_end(groups: Groups) -> Groups:
    """Ranges of the last 20 s a twentieth wider: no motion that has come to rest in a steady state."""
    if "history" not in groups:
        return groups
    history = groups["history"]
    last = 0.05 * (history["time"] > float(history["time"][-1]) - 20)
    wider = {
        f"{x}_max": history[f"{x}_max"] + last * (history[f"{x}_max"] - history[f"{x}_min"]) for x in ("P", "w_point")
    }
    return groups | {"history": history.assign(wider)}


def test_a_motion_that_still_grows_has_no_steady_state(told: xr.DataTree) -> None:
    """Late stretches used to be called steady because they were late."""
    cases = {name: CaseView(name, damaged(node, growing_in_the_end)) for name, node in told.children.items()}
    cases |= made_up.cases({}, made_up.scans())
    steady = [row for row in ROWS if row.steady]
    assert len(steady) > 10
    for row in steady:
        result = row.judge(cases)
        assert result.verdict == NOT_COMPUTED, row.id
        assert "has not settled in" in result.here, row.id


@pytest.mark.parametrize("case", made_up.TEXTS["verdicts"], ids=lambda case: f"{case['row']}: {case['verdict']}")
def test_a_verdict_follows_from_what_there_is(case: dict[str, Any]) -> None:
    stories = made_up.stories(case["cases"], AS_TOLD) if "cases" in case else AS_TOLD
    given = case.get("scans", {})
    cases = made_up.cases(stories, made_up.scans(**given) if given is not None else None)
    changes = {name: made_up.root_with(**values) for name, values in case.get("says", {}).items()}
    cases |= {name: CaseView(name, damaged(cases[name].node, change)) for name, change in changes.items()}
    result = BY_NAME[case["row"]].judge(cases)
    assert result.verdict == case["verdict"], result
    assert case.get("phrase", "") in f"{result.here} {result.notes}"


# ----------------------------------------------------------------------------------------------------
# Both normalisations


def test_the_two_normalisations_side_by_side(monkeypatch: pytest.MonkeyPatch) -> None:
    def cycle(p: Parameters) -> Any:
        if p.contact == "bilateral":
            raise Missing("no stick-slip cycle")
        return made_up.cycle_as_told(p)

    monkeypatch.setattr(measures, "cycle_of", cycle)
    names = ("F02", "F02free", "F04", "F13", "F17", "F18", "F20", "T2kp18", "S43N550", "S43N550a")
    here, there = (made_up.made_up({name: told[name] for name in names}) for told in (AS_TOLD, TO_THE_CONTRARY))
    there = made_up.orthonormal(there)
    there["F20"] = damaged(there["F20"], DAMAGES["failed"])
    parts = normalisation.compare(views({"cases": here}), views({"cases": there}))
    brief, modes, table, instead, changed = (part for _, _, part in parts.values())
    assert [*parts] == ["brief", "modes", "cases", "instead", "verdicts"]
    ratios = modes["ratio"].astype(float)
    assert ratios[1] == pytest.approx(14, abs=1)  # how much too strong the mode with one nodal diameter is
    assert ratios.drop(1).between(0.2, 0.8).all()
    rows = table.set_index("Case")
    assert not {"F02free", "S43N550a"} & set(rows.index), "the same cases once more"
    assert rows.loc["F17", "First separation, as published"] == "810.00 s"
    new = "First separation, Eq. (17)"
    assert [rows.loc[name, new] for name in ("F17", "F04", "F20")] == ["none in 1240 s", "ignored", "failed"]
    assert rows.loc["F04", "Growth, Eq. (17) (1/s)"] == rows.loc["T2kp18", "P in the end, Eq. (17) (N)"] == "–"
    assert list(instead["Case"]) == ["X30"]
    assert {TRUE, PART, FALSE} >= set(changed["As published"])
    assert changed.loc["F13", "With Eq. (17)"] == FALSE
    counts = brief.set_index("").T
    assert list(counts["cases that separate, of 7"]) == ["4", "2"]
    assert list(counts["first separation, 200 N, 15 rad/s"]) == ["810.00 s", "none in 1240 s"]
    assert "Without a result: F20." in parts["brief"][1]
    assert not any(table.map(lambda cell: "nan" in str(cell)).any(axis=None) for _, _, table in parts.values())
