"""The request to `disc_model.simulate`: how a run is carried out, and its checked arguments."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from typing import Annotated, Any, NamedTuple

from pydantic import Field

from disc_model.errors import Fault, ParameterError, as_text, raise_faults, violations
from disc_model.parameters import Parameters, foreign_case
from disc_model.simulation.case import (
    Poincare,
    Ramp,
    Windows,
    faults_of_lengths,
    ramp_faults,
    resolved_windows,
)
from disc_model.simulation.states import State, is_finite
from disc_model.units import TOLERANCES, Count, Strict, in_si, limits_faults, number


class Execution(Strict):
    """How a run is carried out. No setting changes the motion, but a run ends early after
    `max_steps`.

    Attributes
    ----------
    audit_every_step : whether to audit both energy balances on every step instead of every 256th
        (the run takes about ten times as long)
    progress : function that is called repeatedly with the time reached
    max_steps : largest number of steps; None sets a generous limit from the highest frequency

    Examples
    --------
    >>> import disc_model as dm
    >>> short = dm.simulate(dm.Parameters(N=385, Omega=15.1), 60, execution=dm.Execution(max_steps=100))
    >>> short.status.value
    'step_limit'
    """

    audit_every_step: bool = False
    progress: Callable[[float], object] | None = None
    max_steps: Annotated[Count, Field(ge=1)] | None = None


class Request(NamedTuple):
    """What a run is to compute. Every value obeys the rules of `disc_model.simulate`.

    Attributes
    ----------
    parameters : the case
    start, t_end : s, absolute times of the run's first and last instant
    tol : expected error of event times after one second of motion, s, as given
    windows : samples to keep, by name, with absolute times
    events : whether to keep the table of events
    initial_state : state at ``start``; None is the static start
    stop_at : None, or "first_separation"
    ramps : slow changes of Omega or N
    execution : how the run is carried out
    """

    parameters: Parameters
    start: float
    t_end: float
    tol: float
    windows: Windows
    events: bool
    initial_state: State | None
    stop_at: str | None
    ramps: tuple[Ramp, ...]
    execution: Execution


def checked_request(  # noqa: PLR0913
    p: Parameters,
    *,
    t_end: float | str | None,
    duration: float | str | None,
    windows: Windows | None,
    events: bool,
    tol: float,
    initial_state: State | None,
    stop_at: str | None,
    ramps: Ramp | tuple[Ramp, ...],
    execution: Execution,
) -> Request:
    """Return the request of the arguments of `disc_model.simulate`; raises `ParameterError` with
    all of their faults that can be seen at once."""
    span = _span_of(t_end, duration, initial_state)
    raise_faults(
        [
            *foreign_case(p),
            *limits_faults("tol", tol, TOLERANCES),
            *span.faults,
            *_option_faults(events, initial_state, stop_at, execution),
        ]
    )

    # windows and ramps have rules on the times of the run, which are valid from here on
    sampled: Windows = {}
    if windows is not None:
        sampled = resolved_windows(windows, span.start, span.end)
        raise_faults(faults_of_lengths(windows, span.start, span.end))
    if isinstance(ramps, Ramp):
        ramps = (ramps,)
    sections = any(isinstance(window, Poincare) for window in sampled.values())
    raise_faults([*ramp_faults(p, ramps, poincare=sections)])

    return Request(
        parameters=p,
        start=span.start,
        t_end=span.end,
        tol=float(tol),
        windows=sampled,
        events=events,
        initial_state=initial_state,
        stop_at=stop_at,
        ramps=ramps,
        execution=execution,
    )


class _Span(NamedTuple):
    """The times of a run, s, and what is wrong with them."""

    start: float
    end: float
    faults: list[str]


def _span_of(t_end: Any, duration: Any, initial_state: Any) -> _Span:
    """Return the times of a run from an end or a duration, one of which must be given. They are
    plain floats: others would make the engine compile again, and would round differently."""
    if t_end is None and duration is None:
        raise ParameterError(Fault(("t_end",), "", "is required, or duration instead of it"))
    if t_end is not None and duration is not None:
        rule = f"must be left out beside {duration=!s}"
        raise ParameterError(Fault.of(("t_end",), t_end, rule))

    # the start, which is 0 until its fault is reported
    time: Any = 0.0
    if isinstance(initial_state, State):
        time = initial_state.time
    start = 0.0
    if is_finite(time):
        start = float(time)

    name = "t_end"
    value = t_end
    if t_end is None:
        name = "duration"
        value = duration
    end = math.nan
    with suppress(ValueError):  # of what is no number
        end = number(in_si(value, "s", [], ()))
    if duration is not None:
        end += start

    faults = violations((is_finite(time), "initial_state.time", time, "must be finite"))
    if not start < end < math.inf:
        rule = "must be finite, in s or as '2 min', and > "
        rule += f"{as_text(start)}, the time of the initial state"
        faults.append(Fault.of((name,), value, rule))
    return _Span(start, end, faults)


def _option_faults(
    events: object, initial_state: object, stop_at: object, execution: object
) -> list[str]:
    """Return the faults of the options of `disc_model.simulate` by themselves."""
    stops = stop_at is None or (isinstance(stop_at, str) and stop_at == "first_separation")
    starts = initial_state is None or isinstance(initial_state, State)
    return violations(
        (isinstance(events, bool), "events", events, "must be True or False"),
        (starts, "initial_state", initial_state, "must be a State"),
        (stops, "stop_at", stop_at, "must be None or 'first_separation'"),
        (isinstance(execution, Execution), "execution", execution, "must be an Execution"),
    )
