"""Where a benchmark runs, and how much arithmetic the engine does there."""

from __future__ import annotations

import os

import numba
import pytest

from disc_model import Parameters, simulate
from disc_model.benchmarks import machine as here
from disc_model.benchmarks import scenes
from disc_model.benchmarks.machine import machine, one_core, vector_flops
from disc_model.benchmarks.methods.base import Problem


def test_the_machine_is_named() -> None:
    assert "cores" in machine()


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="this system does not bind processes to cores")
def test_a_process_is_on_one_core_meanwhile_and_has_all_of_them_back() -> None:
    before = os.sched_getaffinity(0)

    @one_core()
    def broken_off() -> None:
        assert len(os.sched_getaffinity(0)) == 1
        raise KeyError("broken off")

    with pytest.raises(KeyError, match="broken off"):
        broken_off()
    assert os.sched_getaffinity(0) == before


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
        for name in here._OPERATIONS:
            if hasattr(module, name):
                monkeypatch.setattr(module, name, getattr(module, name))  # put back what counting replaces
    small = Parameters(N=200, Omega=50, n_diameters=1)
    start = simulate(small, 0.02).final_state
    monkeypatch.setattr(scenes, "problem", lambda name: Problem(small, start, start.time + 0.01))
    found = here._count("any", 1e-9) * 0.01
    steps = simulate(small, 0.03, tol=1e-9, initial_state=start).statistics["steps"]
    assert 1000 * steps < found < 50_000 * steps
    assert found == pytest.approx(round(found), rel=1e-12)
