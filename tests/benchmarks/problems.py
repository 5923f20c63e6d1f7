"""Short problems for rival methods, from states in which every term of the equations counts."""

import math

from disc_model.benchmarks import scenes
from disc_model.benchmarks.methods import METHODS, kernels
from disc_model.benchmarks.methods.base import Problem
from disc_model.benchmarks.methods.kernels import Physics
from disc_model.parameters import Parameters
from tests.references.printed import P, lively

BASE = Parameters(N=385.0, Omega=15.1)


def task(phase="slip", direction=1, span=1e-4, p=P):
    """A motion of one phase."""
    return Problem(p, lively(phase, direction, p), span)


def judge(name, scene, value, budget=math.inf):
    """What a method finds of a scene, and how far off it is."""
    result = METHODS[name].solve(scenes.problem(scene), value, budget)
    return result, scenes.errors(scenes.problem(scene), scenes.answer(scene), result)


def vector(start, p=P):
    """The physics, a state as a vector, and the tables of the compiled equations."""
    physics = Physics(p)
    return physics, physics.pack(start), *kernels.tables(physics)
