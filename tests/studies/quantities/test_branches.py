"""Branches of cycles against one parameter, beside a sweep."""

import numpy as np
import pytest

from disc_model.parameters import Parameters
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
    assert growth[last - 5] < 0 < growth[last + 5] or growth[last + 5] < 0 < growth[last - 5]


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
