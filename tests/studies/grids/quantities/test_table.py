"""A point that fails costs its own row, not the batch."""

from __future__ import annotations

import math

import numpy as np
import pytest

from disc_model.data.variables import Variable
from disc_model.errors import DiscModelError
from disc_model.studies.grids.quantities.table import STATUS, STATUSES, Column, tabulate

COLUMNS = {"status": Column(STATUS), "value": Column(Variable("1", "a number"))}


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

    def compute_one(point: str):
        return {"status": "ok", "value": 1.0 if point == "good" else fail()}, ""

    table = tabulate(compute_one, ["good", "bad", "good"], COLUMNS, {})
    assert [STATUSES[i] for i in table.arrays["status"]] == ["ok", "failed", "ok"]
    np.testing.assert_array_equal(table.arrays["value"], [1.0, math.nan, 1.0])
    assert table.messages == ["", message, ""]


def test_a_mistake_in_the_program_is_no_status() -> None:
    def compute_one(_):
        raise KeyError("horizon")

    with pytest.raises(KeyError):
        tabulate(compute_one, [1], COLUMNS, {})


def test_a_point_without_parameters_is_one_that_failed() -> None:
    table = tabulate(lambda _: ({"status": "ok"}, ""), [DiscModelError("no modes")], COLUMNS, {})
    assert table.messages == ["DiscModelError: no modes"]
    assert STATUSES[table.arrays["status"][0]] == "failed"
