"""Rival methods behind one interface, each as a competent user would write it; see `base` for the contract.

    >>> from disc_model.benchmarks.methods import METHODS
    >>> METHODS["RK4"].solve(problem, 1e-5)

They share the physics (`physics`, and `kernels` for the compiled ones), not the engine.  heyoka and SUNDIALS come with
the extra `bench`; without them their `unavailable()` says so and `solve` raises `MethodUnavailable`.
"""

from __future__ import annotations

from disc_model.benchmarks.methods.base import Method, MethodResult, MethodUnavailable, Outcome, Problem
from disc_model.benchmarks.methods.cvode import Cvode
from disc_model.benchmarks.methods.regularised import Regularised
from disc_model.benchmarks.methods.rk4 import FixedStep
from disc_model.benchmarks.methods.series import Series
from disc_model.benchmarks.methods.solve_ivp import SolveIvp
from disc_model.benchmarks.methods.taylor_heyoka import Heyoka

METHODS: dict[str, Method] = {
    method.name: method
    for method in (
        Series(),
        FixedStep(),
        SolveIvp("RK45", 5),
        SolveIvp("DOP853", 8),
        SolveIvp("LSODA", float("nan")),
        SolveIvp("Radau", 5),
        Regularised(),
        Heyoka(),
        Heyoka(guard=0.0),
        Cvode(),
        Cvode("BDF"),
    )
}

__all__ = ["METHODS", "Method", "MethodResult", "MethodUnavailable", "Outcome", "Problem"]
