"""Bad input to the stability functions, named in full."""

from __future__ import annotations

import math

import pytest

from disc_model import ParameterError, Parameters, floquet, steady_sliding
from disc_model.errors import shown
from disc_model.stability.bifurcation import bifurcation_samples
from disc_model.stability.continuation import continue_cycle
from disc_model.stability.lyapunov import lyapunov_exponents

P = Parameters(N=200, Omega=20, n_diameters=1)


@pytest.mark.parametrize(
    ("call", "faults"),
    [
        (lambda: floquet("x", tol=0.5, releases=0), "p='x' tol=0.5 releases=0"),
        (lambda: floquet(P, releases=2), "releases=2"),
        (lambda: floquet(P, near="x", releases=1.5), "near='x' releases=1.5"),
        (lambda: continue_cycle(P, "k", (1, 2), near="x", releases=0, start=[1]), "near='x' releases=0 start=[1]"),
        (lambda: continue_cycle("x", "nu", (1, 2), releases=2), "p='x' names=('nu',) releases=2"),
        (lambda: steady_sliding("x"), "p='x'"),
        (
            lambda: lyapunov_exponents("x", -1, transient=math.nan, count=9, interval=0),
            "p='x' duration=-1 transient=nan count=9 interval=0",
        ),
        (
            lambda: lyapunov_exponents(P, "1", transient=[], count=True, interval="x", initial_state=5, tol="x"),
            "duration='1' transient=[] count=True interval='x' initial_state=5 tol='x'",
        ),
        # intervals that would take a gigabyte and an hour, and bounds of other functions
        (
            lambda: lyapunov_exponents(P, 1.0, interval=1e-9, tol=1e3, leave_out_trivial="x"),
            "interval=1e-09 leave_out_trivial='x' tol=1000",
        ),
        (
            lambda: lyapunov_exponents(P, 10**400, interval=math.inf, tol=math.nan),
            f"duration={shown(10**400)} interval=inf tol=nan",
        ),
        (lambda: bifurcation_samples("x", "E", [], transient=-1, samples=0), "p='x' values=[] transient=-1 samples=0"),
        (lambda: bifurcation_samples(P, "contact", [1.0], transient=0, samples=1), "name='contact'"),
        (lambda: bifurcation_samples(P, "Omega", [0.0], transient=0, samples=1), "Omega=0"),
    ],
)
def test_every_fault_is_named(call, faults):
    with pytest.raises(ParameterError) as error:
        call()
    assert " ".join(fault.partition(": must")[0] for fault in error.value.faults) == faults
