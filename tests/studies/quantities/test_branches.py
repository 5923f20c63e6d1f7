"""Branches of cycles against one parameter, beside a sweep."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from disc_model.analysis.classify import Settled, Settling
from disc_model.parameters import Parameters
from disc_model.stability import attractors, cycle
from disc_model.stability.attractors import Arrival
from disc_model.stability.floquet import floquet
from disc_model.stability.segments import Segment
from disc_model.studies.quantities import branches
from disc_model.studies.quantities.branches import Branches
from disc_model.studies.quantity import Point
from tests.studies.conftest import Table, compute

OPTIONS = {
    "scan": {"start": 14.75, "stop": 15.25, "step": 0.25},
    "dwell": 60,
    "evaluation_time": 1,
    "max_points": 60,
}


@pytest.fixture(scope="module")
def table() -> Table:
    """N = 385 N about the fold."""
    options = Branches.model_validate(OPTIONS)
    return compute(options, [Point(Parameters(N=385, Omega=0, normalization="as_published"))])


@pytest.mark.compiled
def test_the_quiet_branch_turns_at_the_fold(table: Table) -> None:
    """Its place is that of `continue_cycle`, located to rounding: 15.0949 rad/s."""
    value, growth = (table.arrays[name][0, 0] for name in ("value", "growth_rate"))
    assert table.arrays["separations"][0, 0] == 0
    assert np.nanmax(value) == pytest.approx(15.0949, abs=1e-3)  # points lie beside the fold
    last = int(np.nanargmax(value))
    assert growth[last] == 0.0
    assert growth[last - 5] < 0 < growth[last + 5] or growth[last + 5] < 0 < growth[last - 5]


@pytest.mark.compiled
def test_a_branch_has_a_point_where_it_loses_stability() -> None:
    """Only folds were among its points, so that stable stretches seemed to end before."""
    case = Parameters(N=385, Omega=12.7, normalization="orthonormal")
    scan = {"start": 12.7, "stop": 12.9, "step": 0.1}
    options = Branches.model_validate(OPTIONS | {"scan": scan})
    cycle = floquet(case)
    [row] = branches._branch(cycle, False, options)
    growth = row["growth_rate"]
    changes = row["value"][growth == 0]
    located = [12.830348, 12.836321]
    assert changes == pytest.approx(located, abs=1e-6)  # as they are written
    assert len(growth) == len(row["range"])


@pytest.mark.compiled
def test_a_sweep_jumps_to_a_branch_that_separates(table: Table) -> None:
    """Above the fold there is no other; on the way down the sweep stays with it."""
    assert table.arrays["status"][0] == 0
    up, down = table.arrays["sweep_separation_rate"][0] > 0
    assert up.tolist() == [False, False, True]
    assert down.all()
    count = int(table.arrays["n_branches"][0])
    separating = np.flatnonzero(table.arrays["separations"][0, :count] > 0)
    ranges = [
        np.interp(15.25, *(table.arrays[name][0, i] for name in ("value", "range")))
        for i in separating
        if np.all(
            np.diff(table.arrays["value"][0, i][np.isfinite(table.arrays["value"][0, i])]) > 0
        )
    ]
    assert (
        np.min(np.abs(np.array(ranges) / table.arrays["sweep_range"][0, 0, 2] - 1)) < 0.01
    )  # as samples see a range


ROW = {
    "value": np.array([1.0, 2.0, 4.0]),
    "period": np.exp([0.0, 1.0, 2.0]),
    "range": np.exp([0.0, -1.0, -2.0]),
}
"""A branch whose logarithms of period and range are straight between its points."""


@pytest.mark.parametrize(
    ("value", "period", "size", "passes"),
    [
        (1.25, 0.25, -0.25, True),
        (3.5, 1.75, -1.75, True),
        (3.5, 1.75 + 1.9e-4, -1.75, True),
        (3.5, 1.75 + 2.1e-4, -1.75, False),
        (3.5, 1.75, -1.36, True),
        (3.5, 1.75, -1.34, False),
        (4.5, 2.25, -2.25, False),  # beyond its last point
        (1.0, 0.0, 0.0, True),
    ],
)
def test_a_branch_passes_a_cycle_of_about_its_period_and_range(
    value: float, period: float, size: float, passes: bool
) -> None:
    assert branches._passes(ROW, value, np.exp(period), np.exp(size)) is passes


def test_stretches_of_one_number_of_separations_are_joined() -> None:
    points = [
        branches._BranchPoint(float(i), 1.0, -0.1, 0.01, separations)
        for i, separations in enumerate([0, 0, 2, 2, 2, 1])
    ]
    found = branches._stretches(points)
    assert [[point.value for point in stretch] for stretch in found] == [
        [0, 1],
        [1, 2, 3, 4],
        [4, 5],
    ]
    for stretch, separations in zip(found, (0, 2, 1), strict=True):
        assert {point.separations for point in stretch} == {separations}


def test_folds_have_room_among_the_points_of_a_branch() -> None:
    """One of at least six points may be a fold."""
    for most in (3, 60, 300):
        options = Branches.model_validate(OPTIONS | {"max_points": most})
        found = branches._most_points(options)
        assert found + found // 5 <= max(most, 3)
    assert branches._most_points(Branches.model_validate(OPTIONS | {"max_points": 300})) == 250


@pytest.mark.parametrize(("sweep_from", "first"), [(None, 0), (15.0, 1), (14.9, 1), (15.25, 2)])
def test_the_rising_sweep_begins_at_the_value_that_is_asked_for(
    sweep_from: float | None, first: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[Any] = []

    def sweep(p: Parameters, name: str, values: list[float], *how: Any) -> list[Arrival]:
        asked.append((name, values, *how))
        return []

    monkeypatch.setattr(attractors, "sweep", sweep)
    options = Branches.model_validate({**OPTIONS, "sweep_from": sweep_from, "max_dwell": 90})
    values, _ = options.compute_point(Point(Parameters(N=385, Omega=0)))
    assert asked == [("Omega", [14.75, 15.0, 15.25], 60, 90, 1, 1e-10, first)]
    assert values["n_branches"] == 0
    assert len(values["sliding_growth_rate"]) == 3


def test_what_a_sweep_finds_is_stored_by_its_direction_and_value(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It ends at 15 rad/s on the way down."""
    case = Parameters(N=385, Omega=15)
    settled = Arrival(Settling(Settled.SETTLED))
    values = {"u_max": 0.003, "separation_rate": 40.0, "separation_fraction": 0.2}
    late = Segment(**dict.fromkeys(Segment.__dataclass_fields__, 0.0) | values)
    good: Any = SimpleNamespace(parameters=case, message="")
    lost: Any = SimpleNamespace(parameters=case, message="no steps")
    steps = [((0, 2), good, late, settled), ((1, 1), lost, None, settled)]
    monkeypatch.setattr(attractors, "sweep", lambda *how: steps)
    none = SimpleNamespace(state=None)
    monkeypatch.setattr(cycle, "find_cycle", lambda p: none)
    options = Branches.model_validate(OPTIONS)
    found, message = options.compute_point(Point(case))
    assert message == "Omega = 15 rad/s: no steps"
    assert found["status"] == "failed"
    assert found["sweep_range"][0, 2] == 0.003
    assert found["sweep_separation_rate"][0, 2] == 40.0
    assert np.isfinite(found["sweep_range"]).sum() == 1
    assert np.isfinite(found["sweep_separation_rate"]).sum() == 1
