"""Samples for bifurcation diagrams."""

import math
from unittest import mock

import numpy as np
import pytest

from disc_model import ParameterError, Parameters, Poincare, Record, simulate
from disc_model.stability import bifurcation
from disc_model.stability.bifurcation import STATUS_NAMES, bifurcation_samples
from tests.stability.test_attractor import paradox

BASE = Parameters(N=200, Omega=50, n_diameters=1)


def test_samples_are_those_of_the_simulator():
    data = bifurcation_samples(BASE, "N", [150.0, 200.0], transient=0.1, samples=2, tol=1e-9)
    turn = 2 * math.pi / BASE.Omega
    run = simulate(BASE, 2.6 * turn, tol=1e-9, record=Record(poincare=Poincare(start=0.9 * turn)))
    np.testing.assert_allclose(data["psi"].sel(N=200.0), run.poincare["psi"][:2], rtol=0, atol=1e-7)
    assert [STATUS_NAMES[i] for i in data["status"].values] == ["ok", "ok"]
    assert data["N"].attrs["units"] == "N"
    later = bifurcation_samples(BASE, "N", [150.0, 200.0], transient=0.1, samples=2, tol=1e-9, initial_state="previous")
    assert np.array_equal(data["psi"][0], later["psi"][0])
    assert not np.allclose(data["psi"][1], later["psi"][1])


def test_samples_that_are_not_reached_are_missing():
    p, start = paradox()
    data = bifurcation_samples(p, "N", [100.0], transient=0.1, samples=2, initial_state=start)
    assert STATUS_NAMES[int(data["status"][0])] == "paradox"
    assert np.isnan(data["psi"]).all()
    assert (data["phase"] == -1).all()


def test_all_values_are_looked_at_before_anything_runs():
    with (
        mock.patch.object(bifurcation, "simulate", side_effect=AssertionError("before all values were looked at")),
        pytest.raises(ParameterError, match="N=-1: must be >= 0"),
    ):
        bifurcation_samples(BASE, "N", [100.0, -1.0], transient=1, samples=1)
