"""Cycles and their multipliers, tabulated."""

from __future__ import annotations

import numpy as np
import pytest

from disc_model.data.variables import flag_names
from disc_model.parameters import Parameters
from disc_model.studies.grids.quantities import floquet
from disc_model.studies.grids.quantities.schema import FloquetOptions
from disc_model.studies.grids.run import compute
from tests.studies.grids.conftest import SMALL, computed


def test_cycles_are_tabulated_with_their_status() -> None:
    found = computed(quantity="floquet", options={}, base={"Omega": 20} | SMALL, axes={"N": [0, 200]})
    assert flag_names(found["status"]).tolist() == ["no_stick_slip", "ok"]
    assert np.isfinite(found["growth_rate"].sel(N=200))
    assert str(found["message"].sel(N=0).item())


@pytest.mark.compiled
def test_floquet_gives_a_status_where_there_is_no_cycle() -> None:
    found = compute(floquet, [Parameters(N=385, Omega=15), Parameters(N=0, Omega=15)], FloquetOptions())
    assert floquet.STATUSES[found.arrays["status"][0]] == "ok"
    assert found.arrays["growth_rate"][0] == pytest.approx(-0.1055, abs=1e-3)
    assert floquet.STATUSES[found.arrays["status"][1]] != "ok"
    assert found.messages[1]
