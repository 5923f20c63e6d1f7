"""A point that fails costs its own row, not the batch."""

import math
from collections.abc import Callable
from types import SimpleNamespace

import numpy as np
import pytest

from disc_model.data.variables import Variable
from disc_model.errors import DiscModelError
from disc_model.parameters import Parameters
from disc_model.studies.document import QUANTITIES
from disc_model.studies.grids.points import STATUS, STATUSES, Point
from disc_model.studies.grids.quantities import critical_speed, hysteresis, outcome
from disc_model.studies.grids.run import module_of, own_coordinates
from tests.studies.grids.conftest import SCAN, compute

P, Q = (Point(Parameters(N=N, Omega=1)) for N in (1, 0))


def quantity(compute_point: Callable[..., object]) -> SimpleNamespace:
    """A quantity that stands for a module."""
    columns = {"status": STATUS, "value": Variable("1", "a number")}
    return SimpleNamespace(COLUMNS=columns, compute_point=compute_point)


@pytest.mark.parametrize(
    ("fail", "message"),
    [
        (lambda: np.linalg.solve(np.zeros((2, 2)), np.ones(2)), "LinAlgError: Singular matrix"),
        (lambda: 1 / 0, "ZeroDivisionError: division by zero"),
        (lambda: math.exp(1e3), "OverflowError: math range error"),
        (lambda: np.linalg.eigvals(np.full((2, 2), math.nan)), "LinAlgError: Array must not contain infs or NaNs"),
    ],
)
def test_a_numerical_failure_is_the_status_of_its_point(fail, message) -> None:
    """One singular matrix used to end all points of a batch."""

    def compute_point(point: Point, options: None):
        N = point.parameters.N
        return {"status": "ok", "value": fail() if N == 0 else N}, ""

    table = compute(quantity(compute_point), [P, Q, P], None)
    assert [STATUSES[i] for i in table.arrays["status"]] == ["ok", "failed", "ok"]
    np.testing.assert_array_equal(table.arrays["value"], [1.0, math.nan, 1.0])
    assert table.messages == ["", message, ""]


def test_a_mistake_in_the_program_is_no_status() -> None:
    def compute_point(point: Point, options: None):
        raise KeyError("horizon")

    with pytest.raises(KeyError):
        compute(quantity(compute_point), [P], None)


@pytest.mark.parametrize(
    ("quantity", "options", "statuses"),
    [
        (critical_speed, {"horizons": [900], "scan": SCAN}, {"status", "scan_status"}),
        (hysteresis, {"scan": SCAN, "dwell": 60}, {"status", "sweep_status"}),
        (outcome, {"horizon": 9}, {"status"}),
    ],
    ids=["critical_speed", "hysteresis", "outcome"],
)
def test_of_a_failed_point_nothing_is_known(quantity, options, statuses, fake_motions: None) -> None:
    """Nor is anything computed for what stands in the place of parameters that could not be made."""
    entry = QUANTITIES[quantity.__name__.rpartition(".")[2]]
    table = compute(quantity, [DiscModelError("no modes")], entry.options.model_validate(options))
    assert table.messages == ["DiscModelError: no modes"]
    for name, array in table.arrays.items():
        flags = quantity.COLUMNS[name].flags
        if flags:
            assert {flags[i] for i in array.ravel()} == {"failed" if name in statuses else flags[0]}
        elif array.dtype.kind == "f":
            assert np.isnan(array).all()


@pytest.mark.parametrize(
    ("quantity", "options", "firsts"),
    [
        ("bifurcation", {"samples": 3}, {"sample": 0}),
        ("lyapunov", {"exponents": 2}, {"exponent_number": 0}),
        ("campbell", {"modes": 3}, {"mode": 1}),
        ("basins", {"energies": (0.0,), "n_starts": 1}, {"start": 0, "attractor": 1}),
        ("stability_curves", {"max_curves": 2, "max_points": 2}, {"curve": 0, "curve_point": 0}),
    ],
)
def test_own_dimensions_are_numbered_as_in_earlier_files(
    quantity: str, options: dict[str, object], firsts: dict[str, int]
) -> None:
    own = own_coordinates(module_of(quantity), SimpleNamespace(**options))
    assert {name: own[name].values[0] for name in firsts} == firsts
