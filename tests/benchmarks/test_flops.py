"""Counting the engine's arithmetic."""

from __future__ import annotations

import numba
import pytest

from disc_model import Parameters, simulate
from disc_model.benchmarks import flops, scenes
from disc_model.benchmarks.flops import vector_flops
from disc_model.benchmarks.methods.base import Problem


@pytest.mark.compiled
def test_arithmetic_is_that_of_the_convolutions_and_some_more():
    """A slip step of order 22 has two products (f e, f z) of 231 inner terms on eight lanes, multiply and add."""
    flops = vector_flops("stick_slip", 1e-10)
    steps = 677  # of slip in this second
    assert steps * 7392 < flops < 3 * steps * 7392


@pytest.mark.skipif(not numba.config.DISABLE_JIT, reason="operations of compiled code cannot be counted")
def test_arithmetic_is_counted(monkeypatch):
    """A vector operation of each kind by hand; then a run of a few steps, each of which has some hundred of them."""
    from disc_model.engine import coasting, dense_output, polynomial, series

    for module in (dense_output, coasting, polynomial, series):
        for name in flops._OPERATIONS:
            if hasattr(module, name):
                monkeypatch.setattr(module, name, getattr(module, name))  # put back what counting replaces
    small = Parameters(N=200, Omega=50, n_diameters=1)
    start = simulate(small, 0.02).final_state
    monkeypatch.setattr(scenes, "problem", lambda name: Problem(small, start, start.time + 0.01))
    found = flops._count("any", 1e-9) * 0.01
    steps = simulate(small, 0.03, tol=1e-9, initial_state=start).statistics["steps"]
    assert 1000 * steps < found < 50_000 * steps
    assert found == pytest.approx(round(found), rel=1e-12)
