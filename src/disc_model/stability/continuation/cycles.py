"""`continue_cycle`: a cycle followed in one parameter, both ways from a case."""

from collections.abc import Sequence

from disc_model.display import progress_bar
from disc_model.engine.jit.cache import compiling
from disc_model.errors import violations, with_known_names
from disc_model.parameters import Parameters, Quantity
from disc_model.simulation.states import State
from disc_model.stability.continuation.arguments import STOPS, read_values, stop_kinds
from disc_model.stability.continuation.branch import Branch
from disc_model.stability.continuation.course import Search
from disc_model.stability.continuation.curve import CurvePoint, StepControl
from disc_model.stability.continuation.first_cycle import first_cycle
from disc_model.stability.continuation.found import branch_of
from disc_model.stability.continuation.problem import parameter_scale, stretch_of
from disc_model.stability.cycle import STICK_SLIP, guess_faults
from disc_model.units import CYCLE_TOLERANCES, is_number, limits_faults

CYCLE = StepControl()


@compiling()
@with_known_names
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
    stop_at: str | Sequence[str] | None = None,
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
    stop_at : "fold", "period_doubling" or "neimark_sacker", or the label "LP", "PD" or "TR", to end at the first such
        point, in each direction; several of them to end at the first of any
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
    Branch(... cycles, Omega from 14.8 to 15.09... rad/s, 1 fold; ended: the bound Omega = 14.8 rad/s was reached)
    >>> print(f"{branch.folds[0, 0]:.6f} rad/s")
    15.094912 rad/s
    >>> branch.growth_rate[branch.at(15.0)].round(4).tolist()
    [-0.1055, 0.5751]
    """
    ways = is_number(direction) and direction in (-1, 0, 1)
    stops = stop_kinds(stop_at)
    wrong = violations(
        (isinstance(steps, StepControl), "steps", steps, "must be StepControl"),
        (ways, "direction", direction, "must be -1, 0 or 1"),
        (stops is not None, "stop_at", stop_at, STOPS),
        (isinstance(progress, bool), "progress", progress, "must be True or False"),
    )
    wrong += limits_faults("tol", tol, CYCLE_TOLERANCES) + guess_faults(guess, releases, kind)
    span, wanted = read_values(case, name, bounds, values, wrong)
    tol = float(tol)
    start = case.numbers[name]

    scale, steps = _scaled(case, name, span, steps)
    problem, cycle = first_cycle(case, (name,), scale, tol, guess, releases, kind)
    with progress_bar("continue_cycle", None, progress) as bar:

        def tell(point: CurvePoint) -> None:
            bar.describe(f"continue_cycle at {problem.words(point)}")
            bar.advance()

        search = Search(problem, steps, span, stops or frozenset(), tell)
        course = search.follow_cycle(cycle, int(direction))
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
