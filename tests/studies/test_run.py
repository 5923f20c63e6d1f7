"""A point that fails costs its own row, not the batch."""

import math
from collections.abc import Callable
from types import SimpleNamespace

import numpy as np
import pytest

from disc_model.data.variables import Variable
from disc_model.parameters import Parameters
from disc_model.studies.quantity import STATUS, STATUSES, Point
from tests.studies.conftest import compute

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
