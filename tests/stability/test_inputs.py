"""Bad input to the stability functions, named in full."""

from __future__ import annotations

import math

import pytest

from disc_model import ParameterError, Parameters, floquet, steady_sliding
from disc_model.stability.bifurcation import bifurcation_samples
from disc_model.stability.continuation import continue_cycle
from disc_model.stability.lyapunov import lyapunov_exponents

P = Parameters(N=200, Omega=20, n_diameters=1)


def faults_of(function, *arguments, **options) -> list[str]:
    with pytest.raises(ParameterError) as error:
        function(*arguments, **options)
    return [fault.partition("=")[0].partition(":")[0] for fault in error.value.faults]


def test_every_fault_is_named():
    assert faults_of(floquet, "x", tol=1, releases=0) == ["p", "tol", "releases"]
    assert faults_of(floquet, P, releases=2) == ["releases"]
    assert faults_of(floquet, P, near="x", releases=1.5) == ["near", "releases"]
    assert faults_of(continue_cycle, P, "Omega", (1, 2), near="x", releases=0, start=[1]) == [
        "near",
        "start",
        "releases",
    ]
    assert faults_of(continue_cycle, "x", "nu", (1, 2), releases=2) == ["p", "names", "releases"]
    assert faults_of(steady_sliding, "x") == ["p"]
    assert faults_of(lyapunov_exponents, "x", -1, transient=math.nan, count=9, interval=0) == [
        "p", "duration", "transient", "count", "interval",
    ]  # fmt: skip
    assert faults_of(bifurcation_samples, "x", "E", [], transient=-1, samples=0) == [
        "p", "values", "transient", "samples",
    ]  # fmt: skip
    assert faults_of(bifurcation_samples, P, "contact", [1.0], transient=0, samples=1) == ["name"]
    assert faults_of(bifurcation_samples, P, "Omega", [0.0], transient=0, samples=1) == ["Omega"]
