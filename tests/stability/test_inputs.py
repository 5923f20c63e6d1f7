"""Bad input to the stability functions, named in full."""

import math

import numba
import numpy as np
import pytest

from disc_model import ParameterError, Parameters, floquet, steady_sliding
from disc_model.engine import variational
from disc_model.stability.bifurcation import bifurcation_samples
from disc_model.stability.continuation import continue_cycle
from disc_model.stability.lyapunov import lyapunov_exponents
from disc_model.stability.return_map import ReturnMap
from tests.studies.refused import faults_of

P = Parameters(N=200, Omega=20, n_diameters=1)


@pytest.mark.parametrize(
    ("call", "faults"),
    [
        (lambda: floquet("x", tol=0.5, releases=0), "p='x' tol=0.5 releases=0"),
        (lambda: floquet(P, releases=2), "releases=2"),
        (lambda: continue_cycle("x", "nu", (1, 2), releases=2), "p='x' name='nu' releases=2"),
        (
            lambda: lyapunov_exponents("x", -1, transient=math.nan, count=9, interval=0),
            "p='x' duration=-1 transient=nan count=9 interval=0",
        ),
        # intervals that would take a gigabyte and an hour, and bounds of other functions
        (
            lambda: lyapunov_exponents(P, 1.0, interval=1e-9, tol=1e3, leave_out_trivial="x"),
            "interval=1e-09 leave_out_trivial='x' tol=1000",
        ),
        (lambda: bifurcation_samples("x", "E", [], transient=-1, samples=0), "p='x' values=[] transient=-1 samples=0"),
        (lambda: bifurcation_samples(P, "contact", [1.0], transient=0, samples=1), "name='contact'"),
        (lambda: bifurcation_samples(P, "Omega", [0.0], transient=0, samples=1), "Omega=0"),
    ],
)
def test_every_fault_is_named(call, faults):
    assert " ".join(fault.partition(": must")[0] for fault in faults_of(call)) == faults


@pytest.mark.skipif(bool(numba.config.DISABLE_JIT), reason="nothing is compiled")
def test_the_return_map_is_compiled_for_doubles_alone() -> None:
    """Numbers of another type had all of it compiled for them, and rounded in other ways."""
    usual = ReturnMap(P, 2.0**-30)
    flight, end, jacobian, _ = usual.evaluate(usual.static)
    compiled = len(variational._flight.signatures)
    odd = ReturnMap(P, np.float32(2.0**-30))
    static = np.repeat(usual.static, 2)[::2]
    static.setflags(write=False)
    again = odd.evaluate(static, releases=np.int8(1))
    assert len(variational._flight.signatures) == compiled
    assert again[0] == flight
    np.testing.assert_array_equal(again[1], end)
    np.testing.assert_array_equal(again[2], jacobian)
    assert floquet(P, releases=np.int64(1)).period == floquet(P).period


@pytest.mark.parametrize("law", [{}, {"contact_compliance": 1e-7}])
def test_a_rigid_disc_has_nothing_to_lose(law):
    p = Parameters(N=385.0, Omega=15.1, n_diameters=-1, **law)
    for analysis in (floquet, steady_sliding, lambda p: lyapunov_exponents(p, 1.0)):
        with pytest.raises(ParameterError, match=r"n_diameters=-1: must be >= 0: .* needs modes of the disc"):
            analysis(p)
