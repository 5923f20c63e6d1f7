"""Exponents as a quantity."""

import pytest

from disc_model.studies.quantities.lyapunov import Lyapunov
from disc_model.studies.quantity import Point
from tests.stability.test_attractor import paradox


def test_a_transient_that_cannot_be_simulated_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    p, start = paradox()
    monkeypatch.setattr("disc_model.simulation.api.make_initial_state", lambda *_: start)
    values, message = Lyapunov(transient=0.1, duration=1).compute_point(Point(p))
    assert values == {"status": "paradox"}
    assert "Painleve" in message
