"""Curves of cycles: what is known along one, and the walk that all continuations share."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from disc_model.errors import ParameterError
from disc_model.parameters import Parameters
from disc_model.stability.cycle import find_cycle
from disc_model.stability.cycle_problem import CyclePoint, CycleProblem, Lost
from disc_model.stability.multipliers import kind_of, multipliers
from disc_model.stability.return_map import PARAMETERS

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class Branch:
    """Cycles along a curve.

    Attributes
    ----------
    parameters : names of the free ones
    values : shape (n_points, n_parameters), in SI units
    period : s; stick_fraction; growth_rate : 1/s; each (n_points,)
    multipliers : complex, (n_points, n), largest modulus first
    diameters : int, (n_points,), nodal diameters of the modes that have most energy in the leading multiplier's vector
    points : (n_points, n), on the section, in the coordinates of `ReturnMap` for the case followed
    folds : (n_folds, n_parameters), values where the first parameter turns, located to rounding; on a branch in one
        parameter only
    ended : why it ends, in words
    """

    parameters: tuple[str, ...]
    values: Array
    period: Array
    stick_fraction: Array
    growth_rate: Array
    multipliers: ComplexArray
    diameters: NDArray[np.int64]
    points: Array
    folds: Array
    ended: str

    def __len__(self) -> int:
        return len(self.period)

    def kinds(self) -> list[str]:
        """Of each point: the bifurcation its leading multiplier stands for."""
        return [kind_of(complex(m[0])) for m in self.multipliers]


def check(p: object, names: tuple[str, ...], count: int) -> None:
    faults = []
    if not isinstance(p, Parameters):
        faults.append(f"p={p!r}: must be Parameters")
    if len(names) != count or len(set(names)) != len(names) or not set(names) <= set(PARAMETERS):
        faults.append(f"names={names!r}: must be {count} of {', '.join(PARAMETERS)}")
    if faults:
        raise ParameterError(*faults)


def starting_point(problem: CycleProblem, start: Array | None) -> CyclePoint:
    """The cycle that Newton's method finds from ``start``; raises `ParameterError` if there is none to follow."""
    cycle = find_cycle(problem.base, problem.tol, start)
    if cycle.state is None:
        found = cycle.message.removeprefix(f"{cycle.status}: ")
        raise ParameterError(f"p: must have a cycle to start from, but {found}")
    if cycle.releases != 1:
        raise ParameterError("p: must have a cycle with a single release to start from")
    try:
        return problem.evaluate(problem.unknowns(cycle.state))
    except Lost as lost:
        raise ParameterError(f"p: must have a cycle to start from, but {lost}") from None


def branch_of(problem: CycleProblem, points: Sequence[CyclePoint], folds: Array, ended: str) -> Branch:
    values = [multipliers(point.jacobian) for point in points]
    period = np.array([point.flight.period for point in points])
    return Branch(
        parameters=problem.names,
        values=np.array([point.z[problem.n :] * problem.scales for point in points]),
        period=period,
        stick_fraction=np.array([point.flight.stick_time for point in points]) / period,
        growth_rate=np.array([math.log(abs(v[0])) for v in values]) / period,
        multipliers=np.array(values),
        diameters=np.array([problem.leading_diameters(point.jacobian) for point in points]),
        points=np.array([point.z[: problem.n] * problem.size for point in points]),
        folds=folds,
        ended=ended,
    )


@dataclass(frozen=True)
class Place:
    """A point of a curve, and the curve's unit tangent there."""

    point: CyclePoint
    tangent: Array


AnyPlace = TypeVar("AnyPlace", bound=Place)


class Stride(NamedTuple):
    """Arclengths of the first step, the longest and the shortest.

    A step grows by `growth` where the cosine of the tangent's turn in it is above `easy`.
    """

    first: float
    longest: float
    shortest: float
    growth: float
    easy: float


def walk(
    start: AnyPlace,
    take: Callable[[AnyPlace, float], AnyPlace],
    stride: Stride,
    max_points: int,
    *,
    meet: Callable[[AnyPlace, AnyPlace], None],
    leaves: Callable[[list[AnyPlace], float], str],
) -> tuple[list[AnyPlace], str]:
    """Places along a curve, and why they end.

    Parameters
    ----------
    take : the next place at an arclength; raises `Lost` where a shorter step may do
    meet : is told of each step's two ends; raises `Lost` where the curve has to end at the first
    leaves : why the curve ends at the last of the places, given also the last step's arclength; "" if it goes on
    """
    places, ds = [start], stride.first
    while len(places) < max_points:
        here = places[-1]
        try:
            new, ds = shortened(partial(take, here), ds, stride.shortest)
            meet(here, new)
        except Lost as lost:
            return places, str(lost)
        places.append(new)
        if reason := leaves(places, ds):
            return places, reason
        if new.tangent @ here.tangent > stride.easy:
            ds = min(stride.longest, stride.growth * ds)
    return places, "the number of points allowed is reached"


def shortened(take: Callable[[float], T], ds: float, shortest: float) -> tuple[T, float]:
    """What ``take`` finds at arclength ``ds``, halved as often as it is lost; raises Lost below ``shortest``."""
    while True:
        try:
            return take(ds), ds
        except Lost:
            ds /= 2
            if ds < shortest:
                raise
