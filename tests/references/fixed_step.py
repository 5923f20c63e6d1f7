"""Motions by the paper's method, RK4 of fixed steps, which the benchmark has as a rival.

It shares no code with the engine.
"""

from benchmarks.methods import METHODS
from benchmarks.methods.integrators import Problem

STEP = 1e-5
"""s; 0.05 rad of the fastest of nine modes: first separations change in their eighth digit if it is halved."""


def switches(p, start, duration, step=STEP):
    """Times (s) and kinds of the events of a case, from a state on."""
    found = METHODS["RK4"].solve(Problem(p, start, start.time + duration), step)
    return found.times, list(found.kinds)
