"""`simulate`, the one function that runs the engine, and states at chosen times."""

from __future__ import annotations

import math
import warnings
from contextlib import suppress
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from disc_model.errors import Fault, ParameterError, as_text, raise_faults, require, violations
from disc_model.parameters import Parameters, foreign_case
from disc_model.simulation import states
from disc_model.simulation.case import (
    Execution,
    Poincare,
    Ramp,
    Windows,
    ramp_faults,
    resolved_windows,
)
from disc_model.simulation.result import Result
from disc_model.simulation.run import Request, Run
from disc_model.simulation.states import State
from disc_model.units import TOLERANCES, in_si, limits_faults, number

_PLAIN = Execution()


def simulate(  # noqa: PLR0913
    case: Parameters,
    t_end: float | str | None = None,
    windows: Windows | None = None,
    *,
    duration: float | str | None = None,
    events: bool = True,
    tol: float = 1e-10,
    initial_state: State | None = None,
    stop_at: str | None = None,
    ramps: Ramp | tuple[Ramp, ...] = (),
    execution: Execution = _PLAIN,
) -> Result:
    """Simulate from the static start (or ``initial_state``) to the time ``t_end``, or for a
    ``duration``.

    Parameters
    ----------
    case : the case
    t_end : s, absolute, greater than the initial state's time; or a text with a unit, such as "2 min"
    duration : s, from the initial state's time, instead of t_end
    windows : samples to keep, by name: a `Window` at a fixed rate, or `Poincare` for one sample a turn
    events : whether to keep the table of events (events are always counted)
    tol : expected error of event times after one second of motion, s, 1e-15 to 1e-2. Near a resonance of the
        stick-slip rate with the fastest mode, under any law, errors are up to 60 times as large (docs/verification.md).
        Instead of a larger value than 1.25e-7 (2e-6 on a compliant contact), this limit is used, with a warning,
        and recorded in the result
    initial_state : state at the start, such as one of `disc_model.initial_state` or a `final_state`; None is the static
        start (static equilibrium, stick, spring relaxed)
    stop_at : None, or "first_separation" to end at the first loss of contact
    ramps : slow changes of Omega or N, in absolute time: a ramp may have begun before the initial state's time
    execution : progress, largest number of steps and audit of energies, see `Execution`

    Returns
    -------
    Result
        It is also returned if the run ended early: ``status`` and ``message`` then give the time, phase and reason.

    Raises
    ------
    ParameterError
        If an argument breaks a rule; the message names the argument, its value and the rule.

    Examples
    --------
    >>> import disc_model as dm
    >>> case = dm.Parameters(N=385, Omega=15.1)
    >>> run = dm.simulate(case, 60, windows={"late": dm.Window(last=0.1, rate=2e4)})
    >>> run
    Result(N=385 N, Omega=15.1 rad/s: ok at 60 s, first separation at 54.418906 s, 9546 events, 1 window)
    >>> run["late"]["P"].sizes, run["late"]["P"].attrs["units"]
    (Frozen({'time': 2001}), 'N')
    """
    if isinstance(ramps, Ramp):
        ramps = (ramps,)
    start, end, faults = _span(t_end, duration, initial_state)
    stops = stop_at is None or (isinstance(stop_at, str) and stop_at == "first_separation")
    wrong = violations(
        (isinstance(events, bool), "events", events, "must be True or False"),
        (
            isinstance(initial_state, State | None),
            "initial_state",
            initial_state,
            "must be a State",
        ),
        (stops, "stop_at", stop_at, "must be None or 'first_separation'"),
        (isinstance(execution, Execution), "execution", execution, "must be an Execution"),
    )
    raise_faults([*foreign_case(case), *limits_faults("tol", tol, TOLERANCES), *faults, *wrong])

    # windows and ramps have rules on the times of the run, which are valid from here on
    sampled = _sampled(windows, start, end, stop_at)
    sections = any(isinstance(window, Poincare) for window in sampled.values())
    raise_faults([*ramp_faults(case, ramps, poincare=sections)])

    loosest = states.loosest_tolerance(case)
    if tol > loosest:
        used = f"tol={tol:g}: the series need {loosest:g} at most, which is used"
        warnings.warn(used, stacklevel=3)
    request = Request(
        parameters=case,
        start=start,
        t_end=end,
        tol=min(float(tol), loosest),
        windows=sampled,
        events=events,
        initial_state=initial_state,
        stop_at=stop_at,
        ramps=ramps,
        execution=execution,
    )
    return Run(request).complete()


def _sampled(windows: Windows | None, start: float, end: float, stop_at: str | None) -> Windows:
    """Return the windows of a run by name, with absolute times."""
    if windows is None:
        return {}
    sampled = resolved_windows(windows, start, end)
    if stop_at is not None:
        backward = [name for name, each in windows.items() if getattr(each, "last", None)]
        rule = "must not be given with stop_at: where the run ends is not known before"
        raise_faults([Fault(("windows", name, "last"), "", rule) for name in backward])
    return sampled


def _span(t_end: Any, duration: Any, initial_state: Any) -> tuple[float, float, list[str]]:
    """Return the times of a run from an end or a duration, s, one of which must be given, and what is wrong with
    them. They are plain floats: others would make the engine compile again, and would round differently."""
    if t_end is None and duration is None:
        raise ParameterError(Fault(("t_end",), "", "is required, or duration instead of it"))
    alone = t_end is None or duration is None
    require((alone, "t_end", t_end, f"must be left out beside {duration=!s}"))

    # the start is 0 until its fault is reported
    time: Any = getattr(initial_state, "time", 0.0)
    is_time = states.is_finite(time)
    start = 0.0
    if is_time:
        start = float(time)
    name, value, begin = "t_end", t_end, 0.0
    if t_end is None:
        name, value, begin = "duration", duration, start
    end = math.nan
    with suppress(ValueError):  # of what is no number
        end = begin + number(in_si(value, "s", [], ()))
    rule = (
        f"must be finite, in s or as '2 min', and > {as_text(start)}, the time of the initial state"
    )
    faults = violations(
        (is_time, "initial_state.time", time, "must be finite"),
        (start < end < math.inf, name, value, rule),
    )
    return start, end, faults


def snapshots(
    case: Parameters,
    times: ArrayLike,
    *,
    tol: float = 1e-10,
    initial_state: State | None = None,
    ramps: Ramp | tuple[Ramp, ...] = (),
) -> tuple[State, ...]:
    """States of the system at given times, with its modal coordinates.

    Parameters
    ----------
    case : the case
    times : s, ascending, shape (n,); none before the initial state's
    tol, initial_state, ramps : as in `disc_model.simulate`

    Returns
    -------
    tuple of State
        One for each time.

    Raises
    ------
    ParameterError
        If times are not ascending finite numbers, or begin too early; and as `disc_model.simulate`.
    SimulationError
        If the motion ends before the last time.

    Examples
    --------
    >>> import disc_model as dm
    >>> [state.phase for state in dm.snapshots(dm.Parameters(N=385, Omega=15.1), [0.0, 0.006])]
    ['stick', 'slip']
    """
    raise_faults(foreign_case(case))
    numbers = states.finite_numbers(in_si(times, "s", [], ()))
    ascend = numbers is not None and not np.any(np.diff(numbers) < 0)
    require(
        (
            isinstance(initial_state, State | None),
            "initial_state",
            initial_state,
            "must be a State",
        ),
        (ascend, "times", times, "must be finite and ascend"),
    )
    if isinstance(ramps, Ramp):
        ramps = (ramps,)
    raise_faults(
        [*ramp_faults(case, ramps, poincare=False), *limits_faults("tol", tol, TOLERANCES)]
    )
    assert numbers is not None
    wanted = numbers.tolist()
    state = initial_state or states.static_start(case)
    rule = f"must be >= {as_text(state.time)} (the time of the initial state)"
    require(*((time >= state.time, "times", time, rule) for time in wanted[:1]))
    reached: list[State] = []
    for time in wanted:
        if time > state.time:
            run = simulate(case, time, tol=tol, events=False, initial_state=state, ramps=ramps)
            state = run.raise_for_status().final_state
        reached.append(state)
    return tuple(reached)
