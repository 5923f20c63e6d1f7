"""Regions of outcomes: which cells are divided, and how tiles make a plane."""

import json
import math
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from disc_model.data.variables import CycleStatus, Outcome, flag_names
from disc_model.errors import ParameterError
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.states import static_start
from disc_model.stability.follower import OutcomeResult
from disc_model.studies import grid, refinement
from disc_model.studies.quantities.regions import Regions
from disc_model.studies.quantity import Point
from tests.studies.conftest import computed
from tests.studies.refused import parse_grid

ROUND = {"Omega": (28.0, 14.0), "N": (300.0, 160.0)}
"""Middle and half axis of the ellipse within which the made-up motion separates."""
PLANE = ["N", "Omega"]


def separates(p: Parameters) -> bool:
    return math.hypot(*((getattr(p, name) - at) / size for name, (at, size) in ROUND.items())) < 1


def wrong(study: xr.Dataset) -> np.ndarray:
    """Where a plane says otherwise than the made-up motion does."""
    speeds = study["Omega"].values
    expected = [
        [separates(Parameters(N=N, Omega=Omega)) for Omega in speeds] for N in study["N"].values
    ]
    return (flag_names(study["outcome"].transpose("N", "Omega")) == "separation") != expected


@pytest.fixture
def made_up(monkeypatch: pytest.MonkeyPatch) -> list[Parameters]:
    """Motions that separate within an ellipse and, by their multipliers, stay on their cycle outside;
    those asked."""
    asked: list[Parameters] = []

    def trend(tile: refinement.Tile, point: refinement.TilePoint) -> str:
        if separates(point.parameters):
            return ""
        return Outcome.STICK_SLIP

    def find_outcome(p: Parameters, horizon: float, **_) -> OutcomeResult:
        asked.append(p)
        return OutcomeResult(
            Outcome.SEPARATION if separates(p) else Outcome.STICK_SLIP,
            1.0,
            None,
            first_separation=p.N,
        )

    nothing = SimpleNamespace(motion=CycleStatus.NO_CYCLE)
    monkeypatch.setattr(refinement, "cycle_of_static_start", lambda p: nothing)
    monkeypatch.setattr(refinement, "find_outcome", find_outcome)
    monkeypatch.setattr(refinement.Tile, "_trend", trend)
    return asked


def raw(**changes) -> dict:
    study = {
        "study": "small",
        "quantity": "regions",
        "options": {"horizon": 10, "initial_cell_size": 8},
        "axes": {
            "Omega": {"start": 5, "stop": 50, "count": 65},
            "N": {"start": 50, "stop": 600, "count": 49},
            "normalization": ["as_published"],
        },
        "batch": {"over": PLANE},
    }
    return study | changes


@pytest.mark.parametrize("tile", [16, 32, 64])
def test_a_region_is_found_as_by_brute_force_with_fewer_points(made_up, tile: int) -> None:
    study = computed(**raw(batch={"over": PLANE, "size": tile**2})).isel(normalization=0)
    assert not wrong(study).any()
    origin = flag_names(study["method"])
    assert set(np.unique(origin)) == {"simulation", "inferred", "multipliers"}
    inside = flag_names(study["outcome"]) == "separation"
    assert (origin[~inside] == "multipliers").all()
    assert (origin == "simulation").sum() < 0.5 * inside.sum()
    # what was not computed has no time of its own
    assert (np.isfinite(study["first_separation"].values) == (origin == "simulation")).all()


def test_only_separation_is_inferred(monkeypatch: pytest.MonkeyPatch) -> None:
    """Between growing points there was separation that no corner of a cell showed: a single row
    and a single point of it are found here."""

    def find_outcome(p: Parameters, horizon: float, **_) -> OutcomeResult:
        lost = p.Omega == 29.0 or (p.Omega, p.N) == (12.0, 180.0)
        kind = Outcome.GROWING
        if lost:
            kind = Outcome.SEPARATION
        return OutcomeResult(kind, 1.0)

    nothing = SimpleNamespace(motion=CycleStatus.NO_CYCLE)
    monkeypatch.setattr(refinement, "cycle_of_static_start", lambda p: nothing)
    monkeypatch.setattr(refinement, "find_outcome", find_outcome)
    points = [[Parameters(N=10.0 * i, Omega=float(j)) for j in range(33)] for i in range(33)]
    rows = Regions(horizon=10).compute_tile(points, [])
    found = np.array([[row["outcome"] for row, _ in line] for line in rows])
    expected = np.full((33, 33), "growing", dtype=object)
    expected[:, 29] = expected[18, 12] = "separation"
    assert (found == expected).all()


def test_a_point_on_the_edge_of_a_cell_that_does_not_separate_opens_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It was computed for the cell beside."""

    def find_outcome(p: Parameters, horizon: float, **_) -> OutcomeResult:
        quiet = p.Omega > 4 or (p.Omega, p.N) == (4.0, 10.0)
        kind = Outcome.SEPARATION
        if quiet:
            kind = Outcome.GROWING
        return OutcomeResult(kind, 1.0)

    nothing = SimpleNamespace(motion=CycleStatus.NO_CYCLE)
    monkeypatch.setattr(refinement, "cycle_of_static_start", lambda p: nothing)
    monkeypatch.setattr(refinement, "find_outcome", find_outcome)
    points = [[Parameters(N=10.0 * i, Omega=float(j)) for j in range(9)] for i in range(5)]
    rows = Regions(horizon=10, initial_cell_size=4).compute_tile(points, [])
    methods = np.array([[row["method"] for row, _ in line] for line in rows])
    assert rows[1][4][0]["outcome"] == "growing"
    # the quarters beside that point have none inferred, the others have
    assert (methods[:3, 2:5] == "simulation").all()
    assert methods[1, 1] == "simulation"
    assert (methods[3:, :3] == "inferred").any()


def test_marked_points_are_worked_out_and_tiles_make_the_grid_once() -> None:
    marks = {"here": {"x": 12.03125, "y": 187.5, "paper_outcome": "stick_slip"}}
    plot = {"kind": "region_map", "x": "Omega", "y": "N", "marks": marks}
    study = parse_grid(raw(figures={"map": plot}))
    texts = [json.loads(text) for text in study.batches.values()]
    assert len(texts) == 2 * 2
    points = [tuple(point) for text in texts for point in text["points"]]
    assert len(points) == len(set(points)) == study.n_points
    sampled = [
        [along[i] for along, i in zip(text["tile"]["along"], place, strict=True)]
        for text in texts
        for place in text["tile"]["sampled"]
    ]
    assert sampled == [[187.5, 12.03125]]
    # only the tile in which the mark lies is another batch
    assert len(study.batches.keys() - parse_grid(raw()).batches.keys()) == 1


def test_a_mark_lies_at_its_own_value_and_at_no_value_beside() -> None:
    close = [1.0, 1.0001, 1.0002]
    assert [grid._index_of(value, close) for value in close] == [0, 1, 2]
    assert grid._index_of(0.1 + 0.2, [0.2, 0.3]) == 1
    assert grid._index_of(1.00005, close) is None


@pytest.mark.compiled
def test_motions_without_a_cycle_and_points_that_fail_are_named() -> None:
    """At rest, in steady sliding, and a case that cannot be computed."""
    p = Parameters(N=50, Omega=15, c_p=0.5)
    (rows,) = Regions(horizon=20).compute_tile(
        [[p.replace(Omega=0), p, ParameterError("N=-1: must be >= 0")]], []
    )
    (rest, _), (slides, _), (wrong, message) = rows
    assert rest["outcome"] == "at_rest"
    assert rest["cycle"] == "at_rest"
    assert slides["outcome"] == "steady_sliding"
    assert slides["cycle"] == "steady_sliding"
    assert wrong["status"] == "failed"
    assert message == "ParameterError: N=-1: must be >= 0"


@pytest.mark.slow
@pytest.mark.compiled
def test_the_map_agrees_with_brute_force_beside_borders_and_inside_undivided_cells() -> None:
    """Points drawn of a map in which all outcomes and a fold occur, simulated from the static start
    throughout."""
    horizon = 400
    axes = {
        "N": {"start": 100, "stop": 500, "count": 17},
        "Omega": {"start": 8, "stop": 24, "count": 17},
    }
    options = {"horizon": horizon, "initial_cell_size": 4}
    study = computed(quantity="regions", options=options, axes=axes, batch={"over": PLANE})
    separates = flag_names(study["outcome"]) == "separation"
    origin = flag_names(study["method"])
    beside = np.zeros_like(separates)
    for axis in (0, 1):
        differs = np.diff(separates, axis=axis)
        for end in (0, differs.shape[axis]):
            beside |= np.insert(differs, end, False, axis=axis)
    rng = np.random.default_rng(0)
    wrong = []
    drawn = 0
    for there in (beside, (origin == "inferred") & ~beside, (origin == "multipliers") & ~beside):
        for i, j in rng.permutation(np.argwhere(there))[:15]:
            p = Parameters(N=study["N"].values[i], Omega=study["Omega"].values[j])
            whole = simulate(p, horizon, events=False, stop_at="first_separation")
            drawn += 1
            if math.isfinite(whole.first_separation) != separates[i, j]:
                wrong.append((p.N, p.Omega, origin[i, j], whole.first_separation))
    assert drawn > 35
    # most are beside borders, where the outcome hangs on the last per cent of a long growth
    assert len(wrong) <= 0.08 * drawn, wrong


@pytest.mark.compiled
def test_the_cycle_is_known_at_every_point_and_goes_on_from_one_to_the_next() -> None:
    axes = {"N": [100, 110], "Omega": [14, 15, 16]}
    study = computed(quantity="regions", options={"horizon": 50}, axes=axes, batch={"over": PLANE})
    assert (flag_names(study["cycle"]) == "followed").all()
    assert (study["growth_rate"].values < 0).all()
    assert (flag_names(study["method"]) == "multipliers").all()
    joined = flag_names(study["branch_continues_second"]) == "yes"
    assert joined[:, :-1].all()
    assert not joined[:, -1].any()
    assert (study["other_cycles"].values == 0).all()
    # just below two oscillations of 135.42 Hz
    assert study["period_ratio"].values == pytest.approx(1.91, abs=0.02)


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("p", "passed", "left"),
    [
        (Parameters(N=341.666666667, Omega=25.390625), 0.413, 0.0665),
        (Parameters(N=300, k_p=12987.6326315, Omega=23.75), 0.170, 0.0303),
    ],
    ids=["preload", "stiffness"],
)
def test_a_cycle_that_is_passed_in_the_first_seconds_is_not_the_one_that_the_start_leaves(
    p: Parameters, passed: float, left: float
) -> None:
    """The motion passes an unstable cycle after 6.5 s; maps had that one's growth rate."""
    (((early, _),),) = Regions(horizon=15).compute_tile([[p]], [(0, 0)])
    (((row, _),),) = Regions(horizon=40).compute_tile([[p]], [(0, 0)])
    assert early["growth_rate"] == pytest.approx(passed, abs=5e-4)
    assert row["growth_rate"] == pytest.approx(left, abs=5e-4)
    assert row["outcome"] == "growing"


def test_the_motion_of_a_separation_begins_five_seconds_after_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    p = Parameters(N=200, Omega=20, n_diameters=1)
    state = static_start(p).replace(time=3.0)
    reached = OutcomeResult(Outcome.SEPARATION, state=state, first_separation=3.0)
    monkeypatch.setattr("disc_model.stability.follower.find_outcome", lambda *_, **__: reached)
    begin = Regions(horizon=500.0).state_at(Point(p))
    assert begin.time == pytest.approx(8.0)
