"""Tiles of a plane: what is computed of them, presumed and filled, with made-up motions and
cycles."""

from collections.abc import Callable, Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from disc_model.analysis.spectra import modes_at_rest
from disc_model.data.variables import CycleStatus, Outcome
from disc_model.figures.looks import LOOKS
from disc_model.parameters import Parameters
from disc_model.stability.cycle import find_cycle
from disc_model.stability.follower import NearCycle
from disc_model.stability.follower import OutcomeResult
from disc_model.studies import refinement
from disc_model.studies.quantities.regions import Regions
from disc_model.studies.refinement import Tile, TileOptions

Index = tuple[int, int]
NO_CYCLE = SimpleNamespace(motion=CycleStatus.NO_CYCLE)


def place(p: Parameters) -> Index:
    """The place of a case, whose load and speed count rows and columns from 1."""
    return int(p.N) - 1, int(p.Omega) - 1


def near(
    *, stable: bool = False, slow: bool = False, x: float = 0.0, deflection: float = 1.0
) -> NearCycle:
    """A cycle that the static start follows; `slow` if it grows too slowly to leave it."""
    cycle: Any = SimpleNamespace(
        stable=stable, slow=slow, growth_rate=0.1, period=0.015, releases=1, separations=0,
        parameters=Parameters(N=100, Omega=10),
    )  # fmt: skip
    map_: Any = SimpleNamespace(deflection=deflection)
    at = np.array([x, 0.0])
    return NearCycle(cycle, True, map_, at, np.zeros(2), np.eye(2))


class MadeUp:
    """A plane in which outcomes and starts are as said, and the places that were computed."""

    def __init__(self) -> None:
        self.outcome: Callable[[Index], OutcomeResult] = lambda index: quiet()
        self.starts: dict[Index, NearCycle] = {}
        self.computed: list[Index] = []
        self.extrapolate = True
        self.compared: list[tuple[float, ...]] = []

    def find_outcome(
        self, p: Parameters, horizon: float, *, compared_with: tuple[float, ...], **_: Any
    ) -> OutcomeResult:
        index = place(p)
        self.compared.append(compared_with)
        self.computed.append(index)
        return self.outcome(index)

    def start(self, p: Parameters) -> Any:
        return self.starts.get(place(p), NO_CYCLE)

    def tile(self, rows: int, columns: int, cell: int, sampled: Sequence[Index] = ()) -> Tile:
        points = [[Parameters(N=i + 1, Omega=j + 1) for j in range(columns)] for i in range(rows)]
        options = TileOptions(
            horizon=100.0, tol=1e-8, extrapolate=self.extrapolate, initial_cell_size=cell
        )
        tile = Tile(points, sampled, options)
        tile.compute()
        return tile


def quiet() -> OutcomeResult:
    return OutcomeResult(Outcome.STICK_SLIP, 1.0)


def separation() -> OutcomeResult:
    return OutcomeResult(Outcome.SEPARATION, 1.0)


def growing() -> OutcomeResult:
    return OutcomeResult(Outcome.GROWING, 1.0)


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
    assert [row["outcome"] for row in rows] == [Outcome.STICK_SLIP, Outcome.GROWING]
    assert {row["method"] for row in rows} == {"multipliers"}


@pytest.mark.parametrize(("simulated", "method"), [(100.0, "simulation"), (0.0, "multipliers")])
def test_a_row_says_how_its_outcome_is_known(plane: MadeUp, simulated: float, method: str) -> None:
    plane.outcome = lambda index: OutcomeResult(Outcome.OTHER_CYCLE, simulated)
    assert row_at(plane.tile(1, 1, 1), (0, 0))["method"] == method


@pytest.mark.parametrize(("extrapolate", "compared"), [(True, (100.0,)), (False, ())])
def test_separations_are_only_compared_with_the_horizon_unless_their_times_are_asked_for(
    plane: MadeUp, extrapolate: bool, compared: tuple[float, ...]
) -> None:
    plane.extrapolate = extrapolate
    plane.tile(1, 1, 1)
    assert plane.compared == [compared]


def test_a_separation_at_a_marked_place_is_timed(plane: MadeUp) -> None:
    """Tables of the paper's cases had no times of marked points that were extrapolated."""
    plane.tile(1, 2, 1, sampled=[(0, 1)])
    compared = dict(zip(plane.computed, plane.compared, strict=True))
    assert compared == {(0, 0): (100.0,), (0, 1): ()}


def test_an_extrapolated_separation_has_no_time(plane: MadeUp) -> None:
    first = separation()
    first.first_separation = 40.0
    plane.outcome = lambda index: first
    assert row_at(plane.tile(1, 1, 1), (0, 0))["first_separation"] == 40.0
    first.extrapolated = True
    row = row_at(plane.tile(1, 1, 1), (0, 0))
    assert row["outcome"] == Outcome.SEPARATION
    assert row["method"] == "extrapolation"
    assert np.isnan(row["first_separation"])


def test_separation_is_inferred_only_in_cells_that_separate_at_corners_and_in_the_middle(
    plane: MadeUp,
) -> None:
    plane.outcome = lambda index: growing() if index == (2, 2) else separation()
    tile = plane.tile(9, 9, 8)
    assert row_at(tile, (2, 2))["outcome"] == Outcome.GROWING
    assert row_at(tile, (2, 2))["method"] == "simulation"
    row = row_at(tile, (7, 6))
    assert row["outcome"] == Outcome.SEPARATION
    assert row["method"] == "inferred"
    assert (7, 6) not in plane.computed


def test_no_other_outcome_is_inferred(plane: MadeUp) -> None:
    plane.outcome = lambda index: growing()
    plane.tile(5, 5, 4)
    assert sorted(plane.computed) == [(i, j) for i in range(5) for j in range(5)]


def test_a_first_cell_is_divided_before_anything_is_inferred(plane: MadeUp) -> None:
    plane.outcome = lambda index: separation()
    tile = plane.tile(5, 5, 4)
    corners = {(i, j) for i in (0, 2, 4) for j in (0, 2, 4)}
    middles = {(i, j) for i in (1, 3) for j in (1, 3)}
    assert set(plane.computed) == corners | middles
    assert row_at(tile, (3, 4))["outcome"] == Outcome.SEPARATION


def test_a_quiet_point_inside_a_cell_that_separates_is_shown_as_quiet(plane: MadeUp) -> None:
    plane.starts = {(1, 2): near(stable=True)}
    plane.outcome = lambda index: separation()
    tile = plane.tile(5, 5, 4)
    assert row_at(tile, (1, 2))["outcome"] == Outcome.STICK_SLIP
    assert (1, 1) in plane.computed


@pytest.mark.parametrize(
    ("apart", "found", "joined"),
    [(0.001, None, "yes"), (0.1, None, "no"), (0.1, 0.1, "yes"), (0.1, 0.05, "no")],
)
def test_cycles_are_joined_if_they_are_close_or_newton_s_method_leads_from_one_to_the_other(
    plane: MadeUp, apart: float, found: float | None, joined: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    if found is None:
        orbit = None
    else:
        orbit = SimpleNamespace(start=np.array([found, 0.0]))
    monkeypatch.setattr(refinement, "newton", lambda *_, **__: orbit)
    plane.starts = {(0, 0): near(stable=True), (0, 1): near(stable=True, x=apart)}
    row = row_at(plane.tile(1, 2, 1), (0, 0))
    assert row["branch_continues_second"] == joined
    assert row["branch_continues_first"] == "no"


def test_cycles_are_compared_in_units_of_their_own_deflections(plane: MadeUp) -> None:
    plane.starts = {(0, 0): near(stable=True, x=3.0)}
    plane.starts[0, 1] = near(stable=True, x=6.0, deflection=2.0)
    assert row_at(plane.tile(1, 2, 1), (0, 0))["branch_continues_second"] == "yes"


# ---- cells, and what a row says


@pytest.mark.parametrize(
    ("size", "cell", "edges"),
    [(1, 8, [0, 0]), (9, 8, [0, 8]), (10, 8, [0, 4, 9]), (17, 8, [0, 8, 16]), (6, 2, [0, 2, 3, 5])],
)
def test_first_cells_are_at_most_as_long_as_asked_for(
    size: int, cell: int, edges: list[int]
) -> None:
    assert refinement._edges(size, cell) == edges


def test_cells_are_halved_down_to_neighbours() -> None:
    assert refinement._halves(4, 8) == [(4, 6), (6, 8)]
    assert refinement._halves(4, 7) == [(4, 5), (5, 7)]
    assert refinement._halves(4, 5) == [(4, 5)]
    assert refinement._halves(4, 4) == [(4, 4)]


def test_the_middle_of_a_cell_is_the_place_nearest_to_its_centre() -> None:
    cell = [(i, j) for i in range(2, 7) for j in range(3, 6)]
    assert refinement._middle(cell) == (4, 4)
    # of four that are equally near, the first
    assert refinement._middle([(0, 0), (0, 1), (1, 0), (1, 1)]) == (0, 0)


def test_places_that_figures_mark_are_computed_whatever_is_around(plane: MadeUp) -> None:
    plane.outcome = lambda index: separation()
    tile = plane.tile(9, 9, 8, sampled=[(7, 6)])
    assert (7, 6) in plane.computed
    assert row_at(tile, (7, 6))["method"] == "simulation"
    assert row_at(tile, (6, 7))["method"] == "inferred"
    assert len(plane.computed) == len(set(plane.computed)), "none is computed twice"


def test_a_row_has_the_cycle_in_its_own_units(plane: MadeUp) -> None:
    """The period is over that of the lowest mode of disc and slider at rest, in which the slider
    takes part."""
    plane.starts = {(0, 0): near(stable=True)}
    row = row_at(plane.tile(1, 1, 1), (0, 0))
    case = Parameters(N=100, Omega=10)
    lowest = min(mode.frequency for mode in modes_at_rest(case) if mode.bound)
    assert row["period_ratio"] == pytest.approx(0.015 * lowest, rel=1e-12)
    assert row["period"] == 0.015
    assert row["growth_rate"] == 0.1
    assert row["releases"] == 1
    assert row["cycle"] == "followed"


@pytest.mark.parametrize(
    ("start", "outcome", "word"),
    [
        (NO_CYCLE, Outcome.STEADY_SLIDING, "steady_sliding"),
        (NO_CYCLE, Outcome.SEPARATION, "no_cycle"),
        (NearCycle(*[None] * 6), Outcome.SEPARATION, "nearby_only"),
    ],
)
def test_without_a_cycle_to_follow_a_row_says_why(
    plane: MadeUp, start: Any, outcome: Outcome, word: str
) -> None:
    point = refinement.TilePoint(Parameters(N=1, Omega=1), start, "", OutcomeResult(outcome, 1.0))
    assert refinement._word_without_cycle(point) == word


def test_unstable_sliding_is_no_search_that_failed() -> None:
    """A steel disc on which stick ends for good, as sliding grows."""
    steel = {"E": 210e9, "rho": 7850, "nu": 0.3, "h": 6e-3, "damping_ratio": 5e-4}
    slider = {"m": 0.3, "k": 5e5, "k_p": 2e5, "c_p": 20, "mu_s": 0.45, "mu_k": 0.35}
    pad = {"contact_arc": 0.4, "friction_offset": "surface", "normalization": "orthonormal"}
    case = Parameters(N=3000, Omega=80, n_diameters=4, **steel, **slider, **pad)
    search = find_cycle(case)
    assert search.motion == "unstable_sliding"
    for outcome in (Outcome.SEPARATION, Outcome.GROWING):
        point = refinement.TilePoint(case, search, "", OutcomeResult(outcome, 1.0))
        assert refinement._word_without_cycle(point) == search.motion
    classes = Regions.COLUMNS["cycle"].flags
    assert LOOKS[classes[5]].label == "unstable steady sliding"
    assert classes[:5] == ("no_cycle", "followed", "nearby_only", "steady_sliding", "at_rest")


def test_the_cycle_that_a_motion_comes_to_later_is_shown_unless_it_followed_one_before() -> None:
    own = near()
    later = near(x=3.0)
    reached = OutcomeResult(Outcome.SEPARATION, 1.0, near=later)
    point = refinement.TilePoint(Parameters(N=1, Omega=1), own, "", reached)
    assert point.followed is own, "it grew away from that"
    point.result = OutcomeResult(Outcome.STICK_SLIP, 1.0, near=later)
    assert point.followed is later
    point.start = NO_CYCLE
    point.result = reached
    assert point.followed is later
    point.result = None
    assert point.followed is None


def test_other_cycles_are_counted_where_neighbours_lead_to_them(
    plane: MadeUp, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Those carried over that lie apart from the known ones, in units of the deflection, and that
    Newton's method confirms; four at most."""

    def stays(map_: Any, guess: np.ndarray, **_: Any) -> Any:
        return SimpleNamespace(start=guess)

    plane.outcome = lambda index: quiet()
    apart = {(0, 0): near(stable=True), (0, 1): near(stable=True, x=0.03)}
    plane.starts = apart
    monkeypatch.setattr(refinement, "newton", stays)
    assert [row["other_cycles"] for row, _ in plane.tile(1, 2, 1).rows()[0]] == [1, 1]
    plane.starts = {**apart, (0, 1): near(stable=True, x=0.019)}
    assert [row["other_cycles"] for row, _ in plane.tile(1, 2, 1).rows()[0]] == [0, 0]
    plane.starts = {(0, j): near(stable=True, x=float(j)) for j in range(6)}
    counts = [row["other_cycles"] for row, _ in plane.tile(1, 6, 1).rows()[0]]
    assert counts == [3] * 6, "four with its own, carried both ways"
