"""Bad input to the stability functions, named in full; and what can be said without computing a cycle."""

from __future__ import annotations

import math

import numpy as np
import pytest

from disc_model import ParameterError, Parameters, floquet, steady_sliding
from disc_model.stability.bifurcation import bifurcation_samples
from disc_model.stability.lyapunov import lyapunov_exponents
from disc_model.stability.return_map import ReturnMap, _solve
from disc_model.stability.sliding import SlidingStatus
from tests.stability.test_small_cycles import Affine

P = Parameters(N=200, Omega=20, n_diameters=1)


def faults_of(function, *arguments, **options) -> list[str]:
    with pytest.raises(ParameterError) as error:
        function(*arguments, **options)
    return [fault.partition("=")[0].partition(":")[0] for fault in error.value.faults]


def test_every_fault_is_named():
    assert faults_of(floquet, "x", tol=1, releases=0) == ["p", "tol", "releases"]
    assert faults_of(floquet, P, releases=2) == ["releases"]
    assert faults_of(steady_sliding, "x") == ["p"]
    assert faults_of(lyapunov_exponents, "x", -1, transient=math.nan, count=9, interval=0) == [
        "p", "duration", "transient", "count", "interval",
    ]  # fmt: skip
    assert faults_of(bifurcation_samples, "x", "E", [], transient=-1, samples=0) == [
        "p", "values", "transient", "samples",
    ]  # fmt: skip
    assert faults_of(bifurcation_samples, P, "contact", [1.0], transient=0, samples=1) == ["name"]
    assert faults_of(bifurcation_samples, P, "Omega", [0.0], transient=0, samples=1) == ["Omega"]


def test_steady_sliding_says_why_there_is_none():
    assert steady_sliding(P.replace(Omega=0)).status is SlidingStatus.AT_REST
    # above a resonance the disc yields upwards, and the slider's spring with it
    assert steady_sliding(P.replace(Omega=1520.0)).status is SlidingStatus.NO_CONTACT
    assert steady_sliding(P.replace(Omega=1520.0, contact="bonded")).status is SlidingStatus.OK
    # a bond that pulls tilts the disc against the slip
    steep = steady_sliding(P.replace(Omega=1520.0, contact="bonded", N=1e6, D_star=2e-4))
    assert steep.status is SlidingStatus.PARADOX
    assert steep.message == steep.status.advice
    assert not steep.stable
    assert math.isnan(steep.contact_force)
    # the damper alone cannot balance friction at f = Omega, where it does nothing; without friction it need not
    assert steady_sliding(P.replace(k_p=0, c_p=0.5)).status is SlidingStatus.NO_SPRING
    assert steady_sliding(P.replace(k_p=0, c_p=0.5, mu_s=0, mu_k=0)).status is SlidingStatus.OK
    fine = steady_sliding(P)
    assert fine.status is SlidingStatus.OK
    assert fine.stable == (fine.growth_rate < 0)


def test_attractors_are_those_that_are_stable():
    quiet = floquet(P.replace(N=50, Omega=15))
    assert quiet.attractors[0] == "stick_slip"
    assert quiet.raise_for_status() is quiet
    assert floquet(P.replace(N=300)).attractors == ()


def test_a_singular_step_is_the_shortest():
    matrix = np.diag([2.0, 0.0])
    np.testing.assert_allclose(_solve(matrix, np.array([4.0, 0.0])), [2.0, 0.0])


def test_the_map_is_iterated_until_it_does_not_return(monkeypatch):
    toy = Affine([[0.5, 0.0], [0.0, 0.5]], [1.0, 1.0], lost_at=(3,))
    monkeypatch.setattr(ReturnMap, "evaluate", lambda self, x, **_: toy.evaluate(x))
    flight, x = ReturnMap(P).iterate(np.zeros(2), 5)
    assert flight.outcome != 0
    assert toy.calls == 3
    assert np.all(x > 1)
