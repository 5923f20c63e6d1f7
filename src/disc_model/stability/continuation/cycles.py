"""`continue_cycle`: a cycle followed in one parameter, both ways from a case."""

from collections.abc import Sequence

import numpy as np

from disc_model.display import progress_bar
from disc_model.engine.jit.cache import compiling
from disc_model.errors import violations
from disc_model.parameters import Parameters, Quantity
from disc_model.simulation.states import State
from disc_model.stability.continuation import ends, special
from disc_model.stability.continuation.arguments import ROUNDING, read_values
from disc_model.stability.continuation.branch import CHANGES, Branch, SpecialPoint
from disc_model.stability.continuation.course import SAME_VALUE, Course, Search
from disc_model.stability.continuation.curve import CurvePoint, StepControl
from disc_model.stability.continuation.first_cycle import first_cycle
from disc_model.stability.continuation.problem import (
    CycleProblem,
    growth_rate,
    parameter_scale,
    stretch_of,
)
from disc_model.stability.cycle import STICK_SLIP, guess_faults, multipliers
from disc_model.units import CYCLE_TOLERANCES, is_number, limits_faults

CYCLE = StepControl()


@compiling()
def continue_cycle(  # noqa: PLR0913
    case: Parameters,
    name: str,
    bounds: tuple[Quantity, Quantity],
    *,
    direction: int = 0,
    guess: State | None = None,
    releases: int = 1,
    tol: float = 1e-12,
    steps: StepControl = CYCLE,
    values: Sequence[Quantity] = (),
    stop_at: str | None = None,
    kind: str = STICK_SLIP,
    progress: bool = False,
) -> Branch:
    """Follow a cycle in one parameter by pseudo-arclength, through folds, until it leaves `bounds`.

    The branch goes both ways from the case. From a state `guess` the cycle may lose contact; with
    its impacts it is followed as long as the motion depends continuously on the parameter. Where a
    switch is grazed, the return map jumps: the branch ends, and says which event appears or
    vanishes there. A branch that closes ends where it began.

    Parameters
    ----------
    case : case whose cycle is followed; its value of the parameter must lie within the bounds
    name : the free parameter, one of `Parameters.numbers`
    bounds : values of the parameter between which the cycle is followed; SI units, or texts with units
    direction : 0 for both ways; 1 to begin with increasing values alone, -1 with decreasing ones
    guess, releases, tol : as in `floquet`; with the state of a period doubling and twice its releases, the branch that
        begins there is followed, one way
    steps : length and number of the steps
    values : of the parameter, within the bounds; the branch has a cycle at exactly each of them, as often as it passes;
        those that it never passes are its `not_reached`
    stop_at : "fold", "period_doubling" or "neimark_sacker" to end at the first such point, in each direction
    kind : "stick_slip"; or "slipping" for the cycle of `floquet(case, kind="slipping")`, which slips all the time, from
        the Hopf point of steady sliding to where it touches zero slip speed
    progress : whether standard error shows how many cycles are found, and at which value of the parameter; how many
        there will be is not known

    Returns
    -------
    Branch
        The cycles in their order along the curve; its folds and other special points; and in `ended` why it ends; if
        for two reasons, that of its first point, then that of its last.

    Raises
    ------
    ParameterError
        If an argument breaks a rule, or no cycle is found to start from.

    Examples
    --------
    The fold of the cycle at 385 N:

    >>> import disc_model as dm
    >>> branch = dm.continue_cycle(dm.Parameters(N=385, Omega=14.9), "Omega", (14.8, 15.2), values=[15.0])
    >>> branch
    Branch(... cycles, Omega from 14.8 to 15.09..., 1 fold; ended: the bound Omega = 14.8 rad/s was reached)
    >>> print(f"{branch.folds[0, 0]:.6f} rad/s")
    15.094912 rad/s
    >>> branch.growth_rate[branch.values[:, 0] == 15.0].round(4).tolist()
    [-0.1055, 0.5751]
    """
    ways = is_number(direction) and direction in (-1, 0, 1)
    stops = stop_at is None or (isinstance(stop_at, str) and stop_at in CHANGES)
    wrong = violations(
        (isinstance(steps, StepControl), "steps", steps, "must be StepControl"),
        (ways, "direction", direction, "must be -1, 0 or 1"),
        (stops, "stop_at", stop_at, f"must be None or one of {', '.join(CHANGES)}"),
        (isinstance(progress, bool), "progress", progress, "must be True or False"),
    )
    wrong += limits_faults("tol", tol, CYCLE_TOLERANCES) + guess_faults(guess, releases, kind)
    span, wanted = read_values(case, name, bounds, values, wrong)
    tol = float(tol)
    start = case.numbers[name]

    scale, steps = _scaled(case, name, span, steps)
    problem, cycle = first_cycle(case, (name,), scale, tol, guess, releases, kind)
    rising = np.zeros(problem.n + 1)
    rising[-1] = 1.0
    with progress_bar("continue_cycle", None, progress) as bar:

        def tell(point: CurvePoint) -> None:
            bar.describe(f"continue_cycle at {problem.words(point)}")
            bar.advance()

        search = Search(problem, steps, span, stop_at, tell)
        course = search.follow(problem.start(cycle, rising), int(direction))
        course = search.with_values(course, wanted)
    return branch_of(problem, course, (*span, start), wanted)


def _scaled(
    case: Parameters, name: str, span: tuple[float, float], steps: StepControl
) -> tuple[float, StepControl]:
    """The scale of the free parameter, and steps in its arclength."""
    if steps.scale is not None:
        return steps.scale, steps
    stretch = stretch_of(case, name)
    first = steps.step / stretch
    shorter = {
        "step": first,
        "longest": steps.longest / stretch**0.5,
        "shortest": min(steps.shortest, first),
    }
    scale = stretch * parameter_scale(case, name, max(map(abs, span)))
    return scale, steps.replace(**shorter)


def branch_of(
    problem: CycleProblem, course: Course, exact: Sequence[float] = (), wanted: Sequence[float] = ()
) -> Branch:
    """The branch of a course, in SI units. Values of the parameter that scaling has moved by its
    rounding from one of some `exact` or `wanted` ones are these."""
    points = course.points
    values = np.array([point.z[problem.n :] * problem.scales for point in points])
    for value in (*exact, *wanted):
        values[np.abs(values - value) <= SAME_VALUE * abs(value)] = value
    every = [multipliers(point.jacobian) for point in points]
    period = np.array([point.orbit.period for point in points])
    stick_time = np.array([point.orbit.stick_time for point in points])
    growth = [growth_rate(each[0], time) for each, time in zip(every, period, strict=True)]
    rows = _special_points(problem, course)
    folds = [row.values for row in rows if row.kind == special.FOLD]
    reasons = [end.text for end in (course.first, course.last) if end is not None]
    return Branch(
        parameters=problem.names,
        values=values,
        period=period,
        stick_fraction=stick_time / period,
        growth_rate=np.array(growth),
        multipliers=np.array(every),
        diameters=np.array([problem.leading_diameters(point) for point in points]),
        separations=np.array([point.orbit.counts.separations for point in points]),
        releases=np.array([point.orbit.counts.releases for point in points]),
        points=np.array([problem.reference_point(point.z) for point in points]),
        folds=np.array(folds).reshape(-1, len(problem.names)),
        ended="; ".join(dict.fromkeys(reasons)),
        case=problem.base,
        special=rows,
        not_reached=_missed(values, wanted, ROUNDING * problem.scales[0]),
        _make_map=problem.make_map,
    )


def _missed(values: np.ndarray, wanted: Sequence[float], slack: float) -> np.ndarray:
    """Those of some wanted values from which all along a branch differ by more than a slack."""
    nearest = [np.abs(values - value).min() for value in wanted]
    return np.array(wanted, dtype=float)[np.array(nearest) > slack]


def _special_points(problem: CycleProblem, course: Course) -> tuple[SpecialPoint, ...]:
    """The special points of a course, its ends included, in their order."""
    places = list(course.special)
    last = len(course.points) - 1
    closed = course.last.kind == ends.CLOSED
    if not (closed or (course.first is not None and course.first.kind == ends.STOPPED)):
        places.insert(0, _end_of(course.first, course.points[0], 0))
    if not (closed or course.last.kind == ends.STOPPED):
        places.append(_end_of(course.last, course.points[-1], last))
    rows = []
    for place in places:
        z = place.point.z
        orbit = place.point.orbit
        values = z[problem.n :] * problem.scales
        case = problem.base.replace(**dict(zip(problem.names, values.tolist(), strict=True)))
        rows.append(
            SpecialPoint(
                kind=place.kind,
                values=values,
                period=orbit.period,
                stick_fraction=orbit.stick_time / orbit.period,
                growth_rate=growth_rate(special.leading(place.point), orbit.period),
                multiplier=place.multiplier,
                after=place.after,
                case=case,
                modal=problem.reference_point(z) / problem.reference.scale,
                make_map=problem.make_map,
            )
        )
    return tuple(rows)


def _end_of(end: ends.End | None, point: CurvePoint, number: int) -> special.Located:
    """The end of a branch as a special point; without a reason it is the start."""
    kind = "end"
    if end is not None and end.kind in (ends.GRAZED, ends.HOPF, ends.DOUBLED):
        kind = end.kind
    return special.Located(kind, point, special.leading(point), number)
