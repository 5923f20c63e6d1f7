"""Continuation of a cycle in one parameter, and of its stability borders in two, by pseudo-arclength.

`continue_cycle` follows the cycle along F = 0 of `disc_model.stability.branch`; a fold, where two cycles meet, is a
regular point of that curve. `continue_border` follows neutral curves and folds in the plane of two parameters.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Literal

import numpy as np
from scipy.optimize import brentq

from disc_model.engine.jit.cache import compiling
from disc_model.errors import ParameterError, raise_faults, violations
from disc_model.parameters import Parameters, foreign_case
from disc_model.simulation.api import simulate
from disc_model.simulation.result import Result
from disc_model.simulation.states import State
from disc_model.stability.branch import (
    Branch,
    CorrectorFailed,
    CyclePoint,
    CycleProblem,
    Place,
    Reordered,
    StepControl,
    branch_of,
    continue_curve,
    free_faults,
    is_interval,
    newton_step,
    starting_point,
)
from disc_model.stability.cycle import find_cycle, guess_faults
from disc_model.stability.return_map import Array, ComplexArray, Counts, multipliers
from disc_model.units import CYCLE_TOLERANCES, is_number, limits_faults

# ----------------------------------------------------------------------------------------------------
# One parameter


CYCLE = StepControl()
BORDER = StepControl(step=0.01, longest=0.05, shortest=1e-6, max_points=400, growth=1.4, easy=0.98, sharpest=0.8)
"""Steps along borders, where each point costs several cycles."""
UNLOCATED = "a fold that cannot be located"
"""Beginning of one of the reasons for which a branch ends."""


@compiling()
def continue_cycle(
    p: Parameters,
    name: str,
    bounds: tuple[float, float],
    *,
    direction: int = 1,
    guess: State | None = None,
    releases: int = 1,
    tol: float = 1e-12,
    steps: StepControl = CYCLE,
) -> Branch:
    """Follow a cycle in one parameter by pseudo-arclength, through folds, until it leaves `bounds`.

    From a state `guess` the cycle may lose contact. It is followed with its impacts as long as its events keep their
    order. If an event would appear or vanish, the return map has a corner: the branch ends and names that event.

    Parameters
    ----------
    p : case whose cycle is the first point
    name : the free parameter, one of `Parameters.numbers`
    bounds : values of the parameter between which the cycle is followed
    direction : 1 to begin with increasing values, -1 with decreasing ones
    guess, releases, tol : as in `floquet`
    steps : length and number of the steps

    Raises
    ------
    ParameterError
        If an argument breaks a rule, or no cycle is found to start from.

    Examples
    --------
    The fold of the cycle at 385 N:

    >>> import disc_model as dm
    >>> branch = dm.continue_cycle(dm.Parameters(N=385, Omega=14.9), "Omega", (14.8, 15.2))
    >>> branch
    Branch(16 cycles, Omega from 14.7024 to 15.0949, 1 fold: Omega has left 14.8 .. 15.2)
    """
    wrong = violations(
        (is_interval(bounds), "bounds", bounds, "must be two ascending finite numbers"),
        (isinstance(steps, StepControl), "steps", steps, "must be StepControl"),
        (is_number(direction) and abs(direction) == 1, "direction", direction, "must be 1 or -1"),
    )
    wrong += limits_faults("tol", tol, CYCLE_TOLERANCES) + guess_faults(guess, releases)
    raise_faults(foreign_case(p) or wrong + free_faults(p, [name]))
    cycle = find_cycle(p, tol, guess, releases)
    order = None if guess is None else Counts(*(getattr(cycle, name) for name in Counts._fields))
    problem = CycleProblem(p, (name,), steps.scale, tol, order)
    point = starting_point(problem, cycle)
    tangent = problem.tangents(point)[0]
    tangent *= direction * (1.0 if tangent[-1] >= 0 else -1.0)
    low, high = (bound / problem.scales[0] for bound in bounds)
    folds: list[float] = []

    def ends(places: list[Place], new: Place, ds: float) -> str:
        before = places[-1]
        if new.tangent[-1] * before.tangent[-1] < 0:
            try:
                folds.append(_locate_fold(problem, before.point, new.point, before.tangent) * problem.scales[0])
            except CorrectorFailed as lost:
                where = before.point.z[-1] * problem.scales[0]
                raise CorrectorFailed(f"{UNLOCATED} near {name}={where:.6g}: {lost}") from None
        return "" if low <= new.point.z[-1] <= high else f"{name} has left {bounds[0]:g} .. {bounds[1]:g}"

    places, ended = continue_curve(Place(point, tangent), partial(_next, problem), steps, ends)
    points = [place.point for place in places]
    if isinstance(ended, Reordered):
        duration = 2 * points[-1].flight.period  # an event may be missing at the end of a period
        motions = (
            simulate(problem.case(z), duration, tol=tol, initial_state=problem.state(z))
            for z in (points[-1].z, ended.z)
        )
        ended = f"{ended}; {changed_event(*motions)}"
    return branch_of(problem, points, np.array(folds).reshape(-1, 1), str(ended))


def changed_event(cycle: Result, other: Result) -> str:
    """The event that appears or disappears between a cycle and a motion just beyond the end of its branch.

    Up to this event, which grazes between the two, their events are the same.
    """
    names = {"stick_to_slip": "release", "slip_to_stick": "stop", "slip_reversal": "slip reversal"}
    same = 0.01 * cycle.t_end / len(cycle.events)  # far more than the small difference of parameters changes times by
    events = (zip(run.events["kind"].to_list(), run.events["time"].to_list(), strict=True) for run in (cycle, other))
    for (kind, time), (other_kind, other_time) in zip(*events, strict=False):
        if kind != other_kind or abs(time - other_time) > same:
            changed, how = (other_kind, "appears") if other_time < time else (kind, "disappears")
            return f"a {names.get(changed, changed)} {how}"
    return "what grazes was not found"


def _next(problem: CycleProblem, here: Place, ds: float) -> Place:
    """The place at arclength ds along the tangent."""
    tangent = here.tangent
    new = problem.correct(here.point.z + ds * tangent, tangent[None, :], np.array([tangent @ here.point.z + ds]))
    return Place(new, problem.tangents(new)[0])


def _locate_fold(problem: CycleProblem, before: CyclePoint, after: CyclePoint, tangent: Array) -> float:
    """Scaled parameter at the fold between two points, where the tangent has no component along the parameter."""
    length = float(tangent @ (after.z - before.z))
    chord = (after.z - before.z) / length

    def at(s: float) -> CyclePoint:
        return problem.correct(before.z + s * chord, tangent[None, :], np.array([tangent @ before.z + s]))

    def turned(s: float) -> float:
        """The parameter's component of the curve's tangent."""
        tangent_there = problem.tangents(at(s))[0]
        return float(tangent_there[-1] / (tangent_there @ tangent))

    return float(at(brentq(turned, 0.0, length, xtol=1e-12, rtol=1e-12)).z[-1])


# ----------------------------------------------------------------------------------------------------
# Two parameters

Kind = Literal["neutral", "fold"]
CLOSED = "the curve is closed"


def _evaluate_test(kind: Kind, jacobian: Array, former: complex) -> tuple[float, complex]:
    """Value of a test function that vanishes on the curve, and the multiplier nearest to `former`, which gives it.

    For a neutral curve it is the logarithm of the multiplier's modulus, for a fold the real multiplier less one.
    """
    values = np.linalg.eigvals(jacobian).astype(complex)
    if kind == "fold":
        values = values[values.imag == 0]
        if len(values) == 0:
            raise CorrectorFailed("no multiplier is real any more")
    mu = complex(values[np.argmin(np.abs(values - former))])
    return (mu.real - 1.0 if kind == "fold" else math.log(abs(mu))), mu


def continue_border(
    kind: Kind,
    p: Parameters,
    names: tuple[str, str],
    bounds: Mapping[str, tuple[float, float]],
    *,
    guess: Array | None = None,
    tol: float = 1e-12,
    steps: StepControl = BORDER,
) -> Branch:
    """Follow a border of stability in two parameters, in both directions from a place near a case.

    The arguments are those that `disc_model.stability.curves.neutral_curves` has checked.

    Parameters
    ----------
    kind : "neutral", the curve on which the leading multiplier of the first cycle has modulus one; or "fold", the
        curve on which a multiplier is one, starting from the point of a branch nearest to its fold
    p, guess : a case near the curve, and the point of the section near which its cycle is sought; by default the
        static equilibrium
    names : the free parameters, two of `Parameters.numbers`
    bounds : bounds of both parameters; the curve is followed until it leaves them, closes or ends
    tol, steps : as in `continue_cycle`; the number of points is that in each direction

    Raises
    ------
    ParameterError
        If no cycle is found to start from, or no curve of this kind is near it.
    """
    problem = CycleProblem(p, names, None, tol)
    point = starting_point(problem, find_cycle(p, tol, guess))
    mu = complex(multipliers(point.jacobian)[0]) if kind == "neutral" else 1.0 + 0j
    try:
        first = _reach(problem, point, kind, mu)
    except CorrectorFailed as lost:
        raise ParameterError(f"p: must be near a curve of this kind, but {lost}") from None
    lead = first.tangent[problem.n] if abs(first.tangent[problem.n]) > 1e-12 else first.tangent[problem.n + 1]
    onward = first.tangent * math.copysign(1.0, lead)
    limits = np.array([bounds[name] for name in names]) / problem.scales[:, None]

    def ends(places: list[_OnBorder], new: _OnBorder, ds: float) -> str:
        q = new.point.z[problem.n :]
        if np.any(q < limits[:, 0]) or np.any(q > limits[:, 1]):
            return f"{' or '.join(names)} has left the bounds"
        if len(places) >= 8 and np.linalg.norm(new.point.z - first.point.z) < 0.6 * ds:
            return CLOSED
        return ""

    take = partial(_next_on_border, problem, kind)
    places, ended = continue_curve(replace(first, tangent=-onward), take, steps, ends)
    if ended != CLOSED:
        ahead, ended = continue_curve(replace(first, tangent=onward), take, steps, ends)
        places = [*places[:0:-1], *ahead]
    return branch_of(problem, [place.point for place in places], np.zeros((0, 2)), str(ended))


_DIFFERENCE = 1e-4
"""Arclength of the finite difference for a multiplier's gradient along the surface."""


@dataclass(frozen=True)
class _OnBorder(Place):
    """A place with the multiplier that is followed, and the gradients of the test function and of that multiplier
    within the surface, in the unknowns z."""

    mu: complex
    gradient: Array
    turning: ComplexArray

    def predicted(self, move: Array) -> complex:
        """The multiplier after a move, to first order."""
        return self.mu + complex(self.turning @ move)


def _place(problem: CycleProblem, point: CyclePoint, kind: Kind, mu: complex) -> _OnBorder:
    """A cycle on the surface, with the tangent of the curve on which the test function keeps its value."""
    basis = problem.tangents(point)
    slopes, turns = np.zeros(2), np.zeros(2, complex)
    for i, unit in enumerate(basis):
        ends = [_evaluate_test(kind, problem.evaluate(point.z + s * _DIFFERENCE * unit).jacobian, mu) for s in (-1, 1)]
        slopes[i] = (ends[1][0] - ends[0][0]) / (2 * _DIFFERENCE)
        turns[i] = (ends[1][1] - ends[0][1]) / (2 * _DIFFERENCE)
    size = float(np.linalg.norm(slopes))
    if not size > 0:
        raise CorrectorFailed("the multiplier does not depend on the parameters")
    along = np.array([-slopes[1], slopes[0]]) / size
    return _OnBorder(point, along @ basis, mu, slopes @ basis, np.asarray(turns @ basis, dtype=complex))


LONGEST_REACH, LARGEST_TURN, REACHES = 0.1, 0.1, 60
"""On the way to a curve: longest step, largest change of the multiplier in a step, and number of steps."""


def _reach(problem: CycleProblem, point: CyclePoint, kind: Kind, mu: complex) -> _OnBorder:
    """Move from a cycle near the curve onto the curve, by the shortest way on the surface."""
    value, mu = _evaluate_test(kind, point.jacobian, mu)
    for _ in range(REACHES):
        here = _place(problem, point, kind, mu)
        if abs(value) < 1e-10:
            return here
        move = -value * here.gradient / (here.gradient @ here.gradient)
        turn = abs(complex(here.turning @ move))
        move *= min(1.0, LONGEST_REACH / float(np.linalg.norm(move)), LARGEST_TURN / max(turn, 1e-300))
        rows = np.vstack([here.tangent, here.gradient / np.linalg.norm(here.gradient)])
        for halvings in range(6):
            guess = here.point.z + move * 0.5**halvings
            try:
                point = problem.correct(guess, rows, rows @ guess)
                value, mu = _evaluate_test(kind, point.jacobian, here.predicted(move * 0.5**halvings))
                break
            except CorrectorFailed:
                if halvings == 5:
                    raise
    raise CorrectorFailed("no point of the curve was found near the first cycle")


def _next_on_border(problem: CycleProblem, kind: Kind, here: _OnBorder, ds: float) -> _OnBorder:
    """The curve's place at arclength ds: F = 0, test = 0, and the plane normal to the tangent."""
    expected = here.predicted(ds * here.tangent)
    if abs(expected - here.mu) > 2 * LARGEST_TURN:
        raise CorrectorFailed("the multiplier turns too fast")
    guess = here.point.z + ds * here.tangent
    rows = here.tangent[None, :]
    point = problem.evaluate(guess)
    value, found = _evaluate_test(kind, point.jacobian, expected)
    gradient = here.gradient
    errors = [math.inf, math.inf]
    for _ in range(12):
        right = np.concatenate([point.residual, [value], rows @ point.z - rows @ guess])
        errors.append(float(np.linalg.norm(right)))
        if errors[-1] < 1e-10:
            return _place(problem, point, kind, found)
        if errors[-1] > 0.9 * errors[-3]:
            break
        before, last = point, value
        point = problem.evaluate(before.z - newton_step(np.vstack([before.by, gradient, rows]), right))
        value, found = _evaluate_test(kind, point.jacobian, found)
        # Broyden's update: a gradient by differences would take four flights at each correction
        move = point.z - before.z
        gradient = gradient + (value - last - gradient @ move) / (move @ move) * move
    raise CorrectorFailed("Newton's method does not converge")
