"""Tiles of a plane: what is computed of them, presumed and filled, with made-up motions and
cycles."""

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from disc_model.data.variables import CycleStatus, Outcome
from disc_model.parameters import Parameters
from disc_model.stability.linear_motion import NearCycle
from disc_model.stability.outcome import OutcomeResult, Stage
from disc_model.studies import refinement
from disc_model.studies.refinement import Tile

Index = tuple[int, int]
NO_CYCLE = SimpleNamespace(motion=CycleStatus.NO_CYCLE)


def place(p: Parameters) -> Index:
    """The place of a case, whose load and speed count rows and columns from 1."""
    return int(p.N) - 1, int(p.Omega) - 1


def near(*, stable: bool = False, slow: bool = False, x: float = 0.0) -> NearCycle:
    """A cycle that the static start follows; `slow` if it grows too slowly to leave it."""
    cycle: Any = SimpleNamespace(
        stable=stable, slow=slow, growth_rate=0.1, period=0.015, releases=1, separations=0,
        parameters=Parameters(N=100, Omega=10),
    )  # fmt: skip
    map_: Any = SimpleNamespace(deflection=1.0)
    at = np.array([x, 0.0])
    return NearCycle(cycle, True, map_, at, np.zeros(2), np.eye(2))


class MadeUp:
    """A plane in which outcomes and starts are as said, and the places that were computed."""

    def __init__(self) -> None:
        self.outcome: Callable[[Index, float], OutcomeResult] = lambda index, furthest: quiet()
        self.starts: dict[Index, NearCycle] = {}
        self.computed: list[Index] = []
        self.whole: list[Index] = []

    def find_outcome(self, p: Parameters, horizon: float, **how: Any) -> OutcomeResult:
        index = place(p)
        (self.computed if how["furthest"] else self.whole).append(index)
        return self.outcome(index, how["furthest"])

    def start(self, p: Parameters) -> Any:
        return self.starts.get(place(p), NO_CYCLE)

    def tile(self, rows: int, columns: int, cell: int) -> Tile:
        points = [[Parameters(N=i + 1, Omega=j + 1) for j in range(columns)] for i in range(rows)]
        options = SimpleNamespace(initial_cell_size=cell, horizon=100.0, tol=1e-8)
        return Tile(points, [], options)


def quiet() -> OutcomeResult:
    return OutcomeResult(Outcome.QUIET, 1.0)


def separation() -> OutcomeResult:
    return OutcomeResult(Outcome.SEPARATION, 1.0)


def growing(*, extrapolated: bool = False) -> OutcomeResult:
    cycle = near() if extrapolated else None
    return OutcomeResult(Outcome.GROWING, 1.0, extrapolated=cycle)


@pytest.fixture
def plane(monkeypatch: pytest.MonkeyPatch) -> MadeUp:
    made = MadeUp()
    monkeypatch.setattr(refinement, "find_outcome", made.find_outcome)
    monkeypatch.setattr(refinement, "cycle_of_static_start", made.start)
    monkeypatch.setattr(refinement, "newton", lambda *_, **__: None)
    monkeypatch.setattr(NearCycle, "stays_linear_until", lambda self, horizon: self.cycle.slow)
    return made


def row_at(tile: Tile, index: Index) -> dict[str, Any]:
    row, _ = tile.rows()[index[0]][index[1]]
    return dict(row)


def test_multipliers_decide_where_the_start_stays_near_its_cycle(plane: MadeUp) -> None:
    plane.starts = {(0, 0): near(stable=True), (0, 1): near(slow=True)}
    tile = plane.tile(1, 2, 1)
    assert plane.computed == []
    rows = [row_at(tile, (0, j)) for j in (0, 1)]
    assert [row["outcome"] for row in rows] == [Outcome.QUIET, Outcome.GROWING]
    assert {row["method"] for row in rows} == {"multipliers"}


@pytest.mark.parametrize(
    ("stage", "simulated", "method"),
    [
        (Stage.STEADY, 400.0, "settled"),
        (Stage.HORIZON, 100.0, "simulation"),
        (Stage.SETTLED, 0.0, "multipliers"),
    ],
)
def test_a_row_says_how_its_outcome_is_known(
    plane: MadeUp, stage: Stage, simulated: float, method: str
) -> None:
    result = OutcomeResult(Outcome.OTHER_CYCLE, simulated, stage=stage)
    plane.outcome = lambda index, furthest: result
    assert row_at(plane.tile(1, 1, 1), (0, 0))["method"] == method


@pytest.mark.parametrize("right", [Outcome.SEPARATION, Outcome.GROWING])
def test_an_extrapolated_outcome_is_confirmed_between_two_equal_others(
    plane: MadeUp, right: Outcome
) -> None:
    """Between neighbours that differ a border passes, and there is nothing to doubt."""

    def outcome(index: Index, furthest: float) -> OutcomeResult:
        if index[1] == 0 or furthest == 0:
            return separation()
        return growing(extrapolated=True) if index[1] == 1 else OutcomeResult(right, 1.0)

    plane.outcome = outcome
    tile = plane.tile(1, 3, 1)
    confirmed = right is Outcome.SEPARATION
    assert plane.whole == ([(0, 1)] if confirmed else [])
    expected = Outcome.SEPARATION if confirmed else Outcome.GROWING
    row = row_at(tile, (0, 1))
    assert row["outcome"] == expected
    assert row["simulated_time"] == (2.0 if confirmed else 1.0)


def test_stripes_of_separation_between_growing_corners_are_looked_for(plane: MadeUp) -> None:
    plane.outcome = lambda index, _: separation() if index == (2, 2) else growing()
    tile = plane.tile(9, 9, 8)
    assert row_at(tile, (2, 2))["outcome"] == Outcome.SEPARATION
    assert row_at(tile, (7, 7))["method"] == "inferred"


def test_a_growing_cycle_inside_a_calm_cell_is_computed(plane: MadeUp) -> None:
    plane.starts = {(1, 1): near()}
    plane.outcome = lambda index, _: growing() if index == (1, 1) else quiet()
    tile = plane.tile(5, 5, 4)
    assert row_at(tile, (1, 1))["outcome"] == Outcome.GROWING
    assert row_at(tile, (3, 3))["outcome"] == Outcome.QUIET
    assert (3, 3) not in plane.computed


def test_an_edge_between_equal_corners_of_a_small_cell_is_presumed(plane: MadeUp) -> None:
    plane.outcome = lambda index, _: quiet() if index[0] < 2 else separation()
    tile = plane.tile(3, 3, 2)
    assert sorted(plane.computed) == [(0, 0), (0, 2), (1, 0), (1, 1), (1, 2), (2, 0), (2, 2)]
    for index, expected in {(0, 1): Outcome.QUIET, (2, 1): Outcome.SEPARATION}.items():
        row = row_at(tile, index)
        assert (row["outcome"], row["method"]) == (expected, "inferred")


@pytest.mark.parametrize(
    ("apart", "found", "joined"),
    [(0.001, None, "yes"), (0.1, None, "no"), (0.1, 0.1, "yes"), (0.1, 0.05, "no")],
)
def test_cycles_are_joined_if_they_are_close_or_newton_s_method_leads_from_one_to_the_other(
    plane: MadeUp, apart: float, found: float | None, joined: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    orbit = None if found is None else SimpleNamespace(start=np.array([found, 0.0]))
    monkeypatch.setattr(refinement, "newton", lambda *_, **__: orbit)
    plane.starts = {(0, 0): near(stable=True), (0, 1): near(stable=True, x=apart)}
    row = row_at(plane.tile(1, 2, 1), (0, 0))
    assert row["branch_continues_second"] == joined
    assert row["branch_continues_first"] == "no"
