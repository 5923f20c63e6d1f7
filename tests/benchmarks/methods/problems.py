"""Short problems for rival methods, from states in which every term of the equations counts."""

from __future__ import annotations

from disc_model.benchmarks.methods import kernels
from disc_model.benchmarks.methods.base import Problem
from disc_model.benchmarks.methods.physics import Physics
from disc_model.parameters import Parameters
from tests.references.printed import P, lively

BASE = Parameters(N=385.0, Omega=15.1)


def task(phase="slip", direction=1, span=1e-4, p=P):
    """A motion of one phase."""
    return Problem(p, lively(phase, direction, p), span)


def vector(start, p=P):
    """The physics, a state as a vector, and the tables of the compiled equations."""
    physics = Physics(p)
    return physics, physics.pack(start), *kernels.tables(physics)
