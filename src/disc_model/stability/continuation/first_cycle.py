"""The cycle from which a branch begins, and the problem whose zero it is, by the kind of cycle."""

from disc_model.errors import Fault, ParameterError
from disc_model.parameters import Parameters
from disc_model.simulation.states import State
from disc_model.stability.continuation.problem import CycleProblem, another_start
from disc_model.stability.cycle import SLIPPING, FloquetResult, find_cycle
from disc_model.stability.return_map import Counts
from disc_model.stability.slipping import SlippingMap, find_slipping_cycle


def first_cycle(
    p: Parameters,
    names: tuple[str, ...],
    scale: float | None,
    tol: float,
    guess: State | None,
    releases: int,
    kind: str,
) -> tuple[CycleProblem, FloquetResult]:
    """The problem of the cycles of a kind in the free parameters `names`, and the cycle of the case
    `p` from which they are followed; the other arguments are those of `CycleProblem` and
    `disc_model.floquet`.

    Raises `ParameterError` if there is no cycle that slips all the time.
    """
    if kind == SLIPPING:
        slipping = find_slipping_cycle(p, tol, guess)
        if slipping.state is None:
            rule = "must have a cycle that slips all the time"
            found = f"but the search ended with {slipping.message}"
            raise ParameterError(Fault(("case",), "", f"{rule}, {found}; {another_start(names)}"))
        return CycleProblem(p, names, scale, tol, make_map=SlippingMap), slipping

    cycle = find_cycle(p, tol, guess, releases)
    order = None
    if guess is not None:
        order = Counts(*(getattr(cycle, event) for event in Counts._fields))
    return CycleProblem(p, names, scale, tol, order), cycle
