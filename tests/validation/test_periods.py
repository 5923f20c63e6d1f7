"""Long periods are no artefact of the engine: the paper's own method, from the same state, repeats after as many."""

import numpy as np
import pytest

from disc_model import Parameters
from disc_model.analysis.classify import CLOSES, shortest_period
from disc_model.benchmarks.methods import METHODS
from disc_model.benchmarks.methods.base import Problem
from disc_model.paper.model import paper_cases
from disc_model.paper.paper_tables import motion_to

STEP = 2e-5
"""s: its errors, some 1e-11 s an interval, are far below the tolerance to which intervals repeat."""


@pytest.mark.compiled
@pytest.mark.parametrize(("name", "releases", "length"), [("F02", 180, 30.0), ("F07", 45, 10.0), ("F22", 280, 28.0)])
def test_the_papers_method_finds_the_same_period(name: str, releases: int, length: float) -> None:
    case = paper_cases()[name]
    p = Parameters(**case["parameters"], normalization="as_published")
    motion, state = motion_to(p, case["t_end"])
    assert motion.period == releases
    run = METHODS["RK4"].solve(Problem(p, state, state.time + length), STEP)
    intervals = np.diff(run.times[np.array(run.kinds) == "stick_to_slip"])
    assert len(intervals) >= 2 * releases
    assert shortest_period(intervals, CLOSES) == releases
