"""Exponents and samples of short motions of small models."""

from __future__ import annotations

import math

import numpy as np
import pytest

from disc_model import Parameters, Poincare, Record, plate_modes, simulate
from disc_model.stability.bifurcation import STATUS_NAMES, bifurcation_samples
from disc_model.stability.lyapunov import LyapunovStatus, lyapunov_exponents
from tests.stability.test_settling import paradox


def test_exponents_of_stick_are_those_of_the_coupled_mode():
    """Stick is linear: the exponents are 0, of the spring that is wound up, and the decay rate of one coupled mode."""
    p = Parameters(N=300, Omega=1e-3, n_diameters=0, c=3.0, D_star=2e-4)
    omega, psi = (float(plate_modes(p)[name].iloc[0]) for name in ("omega", "psi"))
    decay = (p.D_star / p.D * omega**2 + p.c * psi**2) / (2 * (1 + p.m * psi**2))
    found = lyapunov_exponents(p, 0.1, count=3, interval=0.005)
    assert found.status is LyapunovStatus.OK
    assert found.duration == pytest.approx(0.1)
    assert found.history.shape == (16, 3)
    # the two of the pair take turns; their sum does not
    assert found.exponents.sum() == pytest.approx(-2 * decay, rel=1e-6)
    assert abs(found.exponents[0]) < decay
    assert not found.chaotic
    assert found.separations == 0
    assert found.final_state.time == pytest.approx(0.125)


def test_exponents_from_a_state_after_a_transient():
    p = Parameters(N=200, Omega=20, n_diameters=1, c=5.0, D_star=1e-3)
    start = simulate(p, 0.02, tol=1e-9).final_state
    found = lyapunov_exponents(p, 0.05, transient=0.01, count=1, initial_state=start, tol=1e-9)
    assert found.final_state.time == pytest.approx(0.02 + 0.01 + 0.05 * 1.25)
    assert found.exponents[0] < 50
    sliding = start.replace(phase="separation", direction=0, f=5.0, u=start.u + 1e-4)
    through = lyapunov_exponents(p, 0.05, count=2, initial_state=sliding, tol=1e-9)
    assert through.separations >= 0
    assert np.all(np.isfinite(through.exponents))


def test_a_motion_that_cannot_go_on_has_no_exponents():
    p, start = paradox()
    found = lyapunov_exponents(p, 0.1, initial_state=start)
    assert found.status is LyapunovStatus.PARADOX
    assert found.status.advice.startswith("Painleve")
    assert np.isnan(found.exponents).all()
    assert found.duration == 0
    assert not found.chaotic


def test_a_transient_that_cannot_be_finished_leaves_no_exponents():
    p, start = paradox()
    found = lyapunov_exponents(p, 0.1, transient=0.1, initial_state=start)
    assert found.status is LyapunovStatus.PARADOX
    assert np.isnan(found.exponents).all()
    assert found.final_state.time < start.time + 0.1


BASE = Parameters(N=200, Omega=50, n_diameters=1)


def test_samples_are_those_of_the_simulator():
    data = bifurcation_samples(BASE, "N", [150.0, 200.0], transient=0.1, samples=2, tol=1e-9)
    turn = 2 * math.pi / BASE.Omega
    run = simulate(BASE, 2.6 * turn, tol=1e-9, record=Record(poincare=Poincare(start=0.9 * turn)))
    np.testing.assert_allclose(data["psi"].sel(N=200.0), run.poincare["psi"][:2], rtol=0, atol=1e-7)
    assert [STATUS_NAMES[i] for i in data["status"].values] == ["ok", "ok"]
    assert data["N"].attrs["units"] == "N"
    followed = bifurcation_samples(BASE, "N", [150.0, 200.0], transient=0.1, samples=2, tol=1e-9, follow=True)
    assert np.array_equal(data["psi"][0], followed["psi"][0])
    assert not np.allclose(data["psi"][1], followed["psi"][1])


def test_samples_that_are_not_reached_are_missing():
    p, start = paradox()
    data = bifurcation_samples(p, "N", [100.0], transient=0.1, samples=2, initial_state=start)
    assert STATUS_NAMES[int(data["status"][0])] == "paradox"
    assert np.isnan(data["psi"]).all()
    assert (data["phase"] == -1).all()
