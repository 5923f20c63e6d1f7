"""Choice of the number of modes that a case needs for a given quantity: `choose_modes`.

The choice by ``frequencies`` needs no simulation (`disc_model.disc.truncation`).  The choice by a quantity of the
motion takes the first model with which two larger ones agree. Without agreement there is no choice, and the error gives
the difference of the largest models.  For a disc given by a table, the last candidate is the whole table.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from disc_model.disc.truncation import (
    FREQUENCIES,
    ModeChoice,
    ModeRequest,
    by_frequencies,
    count_modes,
    counts,
    resized,
)
from disc_model.errors import DiscModelError, ParameterError, raise_faults, violations
from disc_model.parameters import Parameters

if TYPE_CHECKING:
    from disc_model.simulation.result import Result

CANDIDATES = ((1, 0), (2, 0), (3, 0), (4, 0), (6, 0), (8, 0), (6, 1), (8, 1))
"""Diameters and circles of the candidates by a quantity of the motion: the last is compared with 99 modes."""
GIVEN_UP = (4, 0)
"""The search ends here if no model so far, of up to 34 modes, has the quantity: neither the candidates nor the models
with which they are compared."""
HORIZON = 600.0
"""s, simulated at most until the first separation."""


def choose_modes(
    case: Parameters | Mapping[str, Any], tolerance: float | None = None, *, quantity: str = FREQUENCIES
) -> ModeChoice:
    """Find the model with the fewest real modes whose error of a quantity is within ``tolerance``.

        >>> disc_model.choose_modes({"N": 385, "Omega": 15.1}, 1e-3).parameters.n_diameters
        3

    Parameters
    ----------
    case : `Parameters`, or a mapping of their values; n_diameters and n_circles are ignored.  With
        ``contact_compliance="residual"`` each model has the flexibility of the modes that it leaves out
    tolerance : relative, at least 1e-4; None is 1e-3 for frequencies, 1e-2 for the growth rate and the first
        separation, 0.1 for the rate of separations
    quantity : "frequencies", the coupled frequencies of disc and slider at rest up to twice the lowest one of the disc,
        compared with those of 20 diameters and 6 circles; "growth", the growth rate of the stick-slip cycle;
        "first_separation", its time within 600 s; "separation_rate", separations per second from 20 to 30 s after the
        first one.  All but the first need simulations

    Raises
    ------
    ParameterError
        If a value of the case breaks a rule, the quantity is unknown, or the tolerance is below 1e-4.
    DiscModelError
        If no model meets the tolerance, or no model agrees with two larger ones, or the quantity does not exist. A
        growth rate needs a cycle, and a first separation a motion that separates.
    """
    faults: list[str] = []
    try:
        request = ModeRequest(quantity=quantity, **({} if tolerance is None else {"tolerance": tolerance}))
    except ParameterError as error:
        faults += error.faults
    known = isinstance(case, Parameters | Mapping)
    raise_faults(faults + violations((known, "case", case, "must be Parameters, or a mapping of names to values")))
    if not isinstance(case, Parameters):
        sizes = ("n_diameters", "n_circles")
        case = Parameters.model_validate({name: x for name, x in case.items() if name not in sizes})
    return chosen_modes(case, request)


def choose_when_run(p: Parameters, request: str) -> tuple[Parameters, str]:
    """A case with the modes that the text `CaseSpec.modes` asks for, and how they were chosen, as JSON."""
    choice = chosen_modes(p, ModeRequest(**json.loads(request)))
    return choice.parameters, choice.to_json()


def chosen_modes(p: Parameters, request: ModeRequest) -> ModeChoice:
    """The requested choice: by a quantity of the motion, the first candidate with which larger models agree.

    Raises `DiscModelError` if there is none.
    """
    if request.quantity == FREQUENCIES:
        return by_frequencies(p, request.tolerance)
    values: dict[tuple[int, ...], float] = {}
    for group in _compared(p):
        size, *others = group
        values |= {each: MEASURES[request.quantity](resized(p, each)) for each in group if each not in values}
        if (p.disc is not None or size == GIVEN_UP) and all(map(math.isnan, values.values())):
            raise DiscModelError(f"n_diameters: undecided: no {request.quantity} to choose by with {_listed(p, group)}")
        change = max(_change(values[size], values[other]) for other in others or group)
        if change <= request.tolerance:
            count, chosen = count_modes(p, size), resized(p, size)
            return ModeChoice(chosen, request.tolerance, change, count, group[-1], request.quantity, values)
    changes = f"by {change:.2g} of itself" if math.isfinite(change) else "between being there and being not"
    raise DiscModelError(
        f"n_diameters: undecided: {request.quantity} still changes {changes} among {_listed(p, group)}, more than the "
        f"tolerance {request.tolerance:g}; give the number of modes, a larger tolerance"
        + ("" if p.contact_compliance else ", or contact_compliance='residual'")
    )


def _compared(p: Parameters) -> Iterator[tuple[tuple[int, ...], ...]]:
    """Candidates, each with the larger models for comparison.

    The first modes of a table are compared with twice as many and with all; the last candidate is the whole table.
    """
    if p.disc is None:
        yield from (((l, c), (2 * l, c), (2 * l, c + 1)) for l, c in CANDIDATES)
        return
    most, count = counts(p.disc)[-1], counts(p.disc)[0]
    while count < most:
        yield tuple(dict.fromkeys([(count,), (min(2 * count, most),), (most,)]))
        count += (count + 1) // 2
    yield ((most,),)


def _change(mine: float, other: float) -> float:
    """Change relative to the larger model; infinite if the quantity is missing in one model or in both."""
    if mine == other:
        return 0.0
    return abs(mine / other - 1.0) if math.isfinite(mine) and math.isfinite(other) and other else math.inf


def _listed(p: Parameters, sizes: tuple[tuple[int, ...], ...]) -> str:
    return ", ".join(str(count_modes(p, size)) for size in sizes) + " modes"


# ----------------------------------------------------------------------------------------------------
# Quantities of the motion.  Simulation is imported inside the functions, because most importers do not need it.


def growth(p: Parameters) -> float:
    """Growth rate of the stick-slip cycle, 1/s; nan without a cycle."""
    from disc_model.stability.cycle import floquet

    return float(floquet(p).growth_rate)


def first_separation(p: Parameters) -> float:
    """Time of the first loss of contact, s; nan if there is none within `HORIZON`."""
    return _run(p, HORIZON, stop_at="first_separation").first_separation


def separation_rate(p: Parameters) -> float:
    """Separations per second from 20 to 30 s after the first one; nan if there is none within `HORIZON`."""
    first = _run(p, HORIZON, stop_at="first_separation")
    if not math.isfinite(first.first_separation):
        return math.nan
    start, length = first.first_separation + 20.0, 10.0
    late = _run(p, start, initial_state=first.final_state).final_state
    return float(_run(p, start + length, initial_state=late).statistics["separations"]) / length


def _run(p: Parameters, t_end: float, **how: Any) -> Result:
    """A complete simulation without a record of events."""
    from disc_model.simulation.api import simulate
    from disc_model.simulation.case import Record

    return simulate(p, t_end, record=Record(events=False), **how).raise_for_status()


MEASURES: dict[str, Callable[[Parameters], float]] = {
    "growth": growth,
    "first_separation": first_separation,
    "separation_rate": separation_rate,
}
