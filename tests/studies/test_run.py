"""A point that fails costs its own row, not the batch."""

import math
from collections.abc import Callable
from types import SimpleNamespace

import numpy as np
import pytest

from disc_model.data.variables import Variable
from disc_model.errors import DiscModelError
from disc_model.parameters import Parameters
from disc_model.studies.quantity import STATUS, STATUSES, Point, quantity_of
from tests.studies.conftest import SCAN, compute

P, Q = (Point(Parameters(N=N, Omega=1)) for N in (1, 0))


def quantity(compute_point: Callable[..., object]) -> SimpleNamespace:
    """A quantity of one number."""
    columns = {"status": STATUS, "value": Variable("1", "a number")}
    return SimpleNamespace(COLUMNS=columns, COORDINATES={}, compute_point=compute_point)


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

    def compute_point(point: Point):
        N = point.parameters.N
        return {"status": "ok", "value": fail() if N == 0 else N}, ""

    table = compute(quantity(compute_point), [P, Q, P])
    assert [STATUSES[i] for i in table.arrays["status"]] == ["ok", "failed", "ok"]
    np.testing.assert_array_equal(table.arrays["value"], [1.0, math.nan, 1.0])
    assert table.messages == ["", message, ""]


def test_a_mistake_in_the_program_is_no_status() -> None:
    def compute_point(point: Point):
        raise KeyError("horizon")

    with pytest.raises(KeyError):
        compute(quantity(compute_point), [P])


@pytest.mark.parametrize(
    ("quantity", "options", "statuses"),
    [
        ("critical_speed", {"horizons": [900], "scan": SCAN}, {"status", "scan_status"}),
        ("hysteresis", {"scan": SCAN, "dwell": 60}, {"status", "sweep_status"}),
        ("outcome", {"horizon": 9}, {"status"}),
    ],
    ids=["critical_speed", "hysteresis", "outcome"],
)
def test_of_a_failed_point_nothing_is_known(quantity, options, statuses, fake_motions: None) -> None:
    """Nor is anything computed for what stands in the place of parameters that could not be made."""
    kind = quantity_of(quantity)
    table = compute(kind.model_validate(options), [DiscModelError("no modes")])
    assert table.messages == ["DiscModelError: no modes"]
    for name, array in table.arrays.items():
        flags = kind.COLUMNS[name].flags
        if flags:
            assert {flags[i] for i in array.ravel()} == {"failed" if name in statuses else flags[0]}
        elif array.dtype.kind == "f":
            assert np.isnan(array).all()
