"""Exponents as a quantity."""

import json

import numpy as np
import pytest

from disc_model.studies.quantities.lyapunov import Lyapunov
from disc_model.studies.quantity import Point
from tests.stability.test_attractor import paradox
from tests.studies.conftest import computed

AFTER = {"prerun": {"parameters": {"N": 385, "Omega": 15.1}, "time": 56}, "transient": 1}


def test_a_transient_that_cannot_be_simulated_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    p, start = paradox()
    monkeypatch.setattr("disc_model.simulation.api.make_initial_state", lambda *_: start)
    values, message = Lyapunov(transient=0.1, duration=1).compute_point(Point(p))
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
