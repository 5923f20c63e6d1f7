"""Exponents as a quantity."""

import json

import numpy as np
import pytest

from disc_model.studies.document import LyapunovOptions
from disc_model.studies.grids.points import Point
from disc_model.studies.grids.quantities import lyapunov
from tests.stability.test_attractor import paradox
from tests.studies.grids.conftest import computed

AFTER = {"prerun": {"parameters": {"N": 385, "Omega": 15.1}, "time": 56}, "transient": 1}


def test_a_transient_that_cannot_be_simulated_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    p, start = paradox()
    monkeypatch.setattr("disc_model.simulation.api.make_initial_state", lambda *_: start)
    values, message = lyapunov.compute_point(Point(p), LyapunovOptions(transient=0.1, duration=1))
    assert values == {"status": "paradox"}
    assert "Painleve" in message


@pytest.mark.compiled
def test_exponents_are_stored_with_their_errors() -> None:
    raw = {"study": "l", "quantity": "lyapunov", "base": {"N": 385}, "axes": {"Omega": [15]}}
    found = computed(**(raw | {"options": AFTER | {"duration": 2, "exponents": 3}})).isel(Omega=0)
    assert found["exponent"].shape == (3,)
    assert np.all(np.isfinite(found["exponent"]))
    assert np.all(found["exponent_error"] > 0)
    assert float(found["averaging_time"]) == pytest.approx(2)
    assert json.loads(found.attrs["options"])["prerun"]["time"] == 56
