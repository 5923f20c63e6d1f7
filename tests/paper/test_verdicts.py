"""Verdicts follow the evidence: rows of the ledger judged by the paper's cases, as simulated and as
they are not."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from disc_model import Parameters
from disc_model.disc.plate import plate_modes
from disc_model.paper import ledger, measures, section2, section41, section44
from disc_model.paper.ledger import ROWS
from disc_model.paper.measures import CaseView, views
from disc_model.paper.model import FALSE, NOT_COMPUTED, PART, TRUE, VERDICTS
from disc_model.paper.section41 import Powers
from tests.damages import DAMAGES, damaged
from tests.paper import evidence

pytestmark = pytest.mark.compiled
BY_NAME = {row.id: row for row in ROWS if row.check}


@dataclass(frozen=True)
class World:
    """Evidence for rows, all of them unless some are named; what is not given is simulated."""

    cases: Mapping[str, Any] = field(default_factory=dict)
    scans: Mapping[str, xr.Dataset] = field(default_factory=evidence.scans)
    functions: Mapping[Any, Mapping[str, Callable[..., Any]]] = field(default_factory=dict)
    rows: tuple[str, ...] = tuple(BY_NAME)

    def verdicts(self) -> dict[str, str]:
        with pytest.MonkeyPatch.context() as patch:
            for module, functions in self.functions.items():
                for name, function in functions.items():
                    patch.setattr(module, name, function)
            cases = evidence.cases(self.cases, self.scans)
            return {name: BY_NAME[name].judge(cases).verdict for name in self.rows}


def mirrored(p: Parameters, growth: Callable[[Parameters], float] = measures.growth_of) -> float:
    """The growth of a case, negative instead of positive."""
    return -growth(p)


def course(p: Parameters, until: float, widest: float = np.inf) -> tuple[Powers, ...]:
    """Powers in W by the square of the width in mm: separation withholds the surplus of maintained
    contact."""
    if p.contact == "bilateral":
        return tuple(Powers(1e-3 * x, 2.0 * x**2, 0.0, x**2, x**2) for x in range(1, 9))
    return (Powers(3.5e-3, 12.25, 0.0, 12.25, 0.0),) * 4


def slower(p: Parameters) -> pd.DataFrame:
    """A disc on which a load is critical at 608 rad/s."""
    modes = plate_modes(p)
    paired = modes[modes["diameters"] > 0]
    return modes.assign(omega=modes["omega"] * 608 / (paired["omega"] / paired["diameters"]).min())


def a_disc(row: str, **functions: Callable[[Parameters], Any]) -> World:
    """Another disc, in the functions of one of the two modules that judge by it."""
    return World(
        functions={section44 if row in ("T2e", "F29") else section2: functions}, rows=(row,)
    )


WORLDS = {
    "as simulated": World(),
    "other grids and cycles": World(
        scans=evidence.scans(**evidence.TEXTS["scans to the contrary"]),
        functions={measures: {"growth_of": mirrored}, section41: {"course": course}},
    ),
    "growth with the stiffness": World(
        functions={measures: {"growth_of": lambda p: p.k_p}}, rows=("S43kpg",)
    ),
    "a slower disc": a_disc("P07", plate_modes=slower),
    "no slider": a_disc(
        "P04", coupled_natural_frequencies=lambda p: np.repeat(plate_modes(p)["omega"], 2)[1:]
    ),
    "normalised modes": a_disc("eq17", norms=lambda p: np.ones(5)),
    "a plate without mass and stiffness": a_disc(
        "E17", plate_modes=lambda p: plate_modes(p).assign(omega=np.sqrt(p.D))
    ),
    "natural frequencies where the lines are": a_disc(
        "T2e", coupled_natural_frequencies=lambda p: 2 * np.pi * np.array([135.3, 202.9, 270.5])
    ),
    "the stiff disc": a_disc("F29", plate_modes=lambda p: plate_modes(p.replace(E=150e9))),
}
for name, growth in {
    "friction that changes nothing": lambda p: p.Omega - 1000.0,
    "friction as the precursor has it": lambda p: (
        p.c + p.mu_s - 0.1 if p.Omega < 1000 else 0.1 - p.mu_s
    ),
}.items():
    changed = {"sliding_growth": growth, "growths": section2.growths.__wrapped__}
    WORLDS[name] = World(functions={section2: changed}, rows=("A98i", "A98r"))
for name, text in evidence.TEXTS["worlds"].items():
    every = {" ".join(evidence.SPECS): motion for motion in [text["cases"].get("all")] if motion}
    rows = tuple(text.get("rows", " ".join(BY_NAME)).split())
    WORLDS[name] = World(every or text["cases"], evidence.scans(**text.get("scans", {})), rows=rows)


def test_every_row_can_come_out_in_another_way() -> None:
    """A check that comes out the same whatever was computed decides nothing."""
    verdicts = {name: world.verdicts() for name, world in WORLDS.items()}
    for row in BY_NAME:
        every = {each[row] for each in verdicts.values() if row in each}
        assert len(every - {NOT_COMPUTED}) > 1, (row, every)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("damage", ["no events", "two samples"])
def test_what_a_study_lacks_ends_no_table(damage: str) -> None:
    """This used to be a KeyError, IndexError, ValueError or ZeroDivisionError."""
    nodes = {name: damaged(node, DAMAGES[damage]) for name, node in evidence.simulated().items()}
    findings = [
        row.judge({name: CaseView(name, node) for name, node in nodes.items()}) for row in ROWS
    ]
    assert {each.verdict for each in findings} <= {*VERDICTS}
    assert any(each.verdict == NOT_COMPUTED and each.here.startswith("case ") for each in findings)


def growing_in_the_end(groups: evidence.Groups) -> evidence.Groups:
    """Ranges of the last 20 s a twentieth wider: no motion that has come to rest in a steady
    state."""
    if "history" not in groups:
        return groups
    history = groups["history"]
    last = 0.05 * (history["time"] > float(history["time"][-1]) - 20)
    wider = {
        x: history[f"{x}_max"] + last * (history[f"{x}_max"] - history[f"{x}_min"])
        for x in ("P", "w_point")
    }
    return groups | {"history": history.assign({f"{x}_max": values for x, values in wider.items()})}


def test_a_motion_that_still_grows_has_no_steady_state() -> None:
    """Late stretches used to be called steady because they were late."""
    cases = evidence.cases({}, evidence.scans())
    cases |= {
        name: evidence.view(name, growing_in_the_end(evidence.groups_of(name)))
        for name in evidence.SPECS
    }
    steady = [row for row in ROWS if row.steady]
    assert len(steady) > 10
    for row in steady:
        result = row.judge(cases)
        assert result.verdict == NOT_COMPUTED, row.id
        assert "has not settled in" in result.here, row.id


@pytest.mark.parametrize(
    "case", evidence.TEXTS["verdicts"], ids=lambda case: f"{case['row']}: {case['verdict']}"
)
def test_a_verdict_follows_from_what_there_is(case: dict[str, Any]) -> None:
    given = case.get("scans", {})
    stories = case.get("cases", {}) | {
        name: {"says": values} for name, values in case.get("says", {}).items()
    }
    cases = evidence.cases(stories, evidence.scans(**given) if given is not None else None)
    result = BY_NAME[case["row"]].judge(cases)
    assert result.verdict == case["verdict"], result
    assert case.get("phrase", "") in f"{result.here} {result.notes}"


def test_the_two_normalisations_side_by_side() -> None:
    names = ("F02", "F02free", "F04", "F13", "F17", "F18", "F20", "T2kp18", "S43N550", "S43N550a")
    here = {name: evidence.simulated()[name] for name in names}
    there = dict(evidence.simulated(*names, normalization="orthonormal"))
    there |= {
        "F20": damaged(there["F20"], DAMAGES["failed"]),
        "X30": there["F02"],
    }  # and a case that the paper has not
    both = [
        xr.DataTree.from_dict({f"/{name}": node for name, node in nodes.items()})
        for nodes in (here, there)
    ]
    parts = ledger.compare(*(views({"cases": cases}) for cases in both))
    brief, modes, table, instead, changed = (part for _, _, part in parts.values())
    assert [*parts] == ["brief", "modes", "cases", "instead", "verdicts"]
    ratios = modes["ratio"].astype(float)
    assert ratios[1] == pytest.approx(
        14, abs=1
    )  # how much too strong the mode with one nodal diameter is
    assert ratios.drop(1).between(0.2, 0.8).all()
    rows = table.set_index("Case")
    assert not {"F02free", "S43N550a"} & set(rows.index), "the same cases once more"
    assert rows.loc["F17", "First separation, as published"] == "810.15 s"
    new = "First separation, Eq. (17)"
    assert [rows.loc[name, new] for name in ("F17", "F04", "F20")] == [
        "none in 1240 s",
        "ignored",
        "failed",
    ]
    assert (
        rows.loc["F13", "Growth, as published (1/s)"]
        == rows.loc["T2kp18", "P in the end, Eq. (17) (N)"]
        == "–"
    )
    assert list(instead["Case"]) == ["X30"]
    assert {TRUE, PART, FALSE} >= set(changed["As published"])
    assert changed.loc["F02a", "With Eq. (17)"] == FALSE
    counts = brief.set_index("").T
    assert list(counts["cases that separate, of 7"]) == ["5", "1"]
    assert list(counts["first separation, 200 N, 15 rad/s"]) == ["810.15 s", "none in 1240 s"]
    assert "Without a result: F20." in parts["brief"][1]
    assert not any(
        table.map(lambda cell: "nan" in str(cell)).any(axis=None) for _, _, table in parts.values()
    )
