"""`simulate`, the one function that runs the engine, and states at chosen times."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BeforeValidator, InstanceOf, PlainValidator, StrictBool, TypeAdapter

from disc_model.errors import as_text, require
from disc_model.parameters import Parameters
from disc_model.simulation import states
from disc_model.simulation.case import (
    Execution,
    Poincare,
    Ramp,
    Window,
    WindowName,
    check_ramps,
    resolved_windows,
)
from disc_model.simulation.result import Result
from disc_model.simulation.run import Run
from disc_model.simulation.states import State
from disc_model.units import Seconds, Tolerance, checked

_PLAIN = Execution()


Asked = Mapping[WindowName, InstanceOf[Window] | InstanceOf[Poincare]]
"""Samples to keep, by names of windows."""
Ramps = Annotated[
    Any,
    PlainValidator(TypeAdapter(tuple[InstanceOf[Ramp], ...]).validate_python),
    BeforeValidator(lambda ramps: (ramps,) if isinstance(ramps, Ramp) else ramps),
]
"""One ramp, or a tuple of several."""


@checked
def simulate(  # noqa: PLR0913
    case: Parameters,
    t_end: Seconds | None = None,
    windows: Asked | None = None,
    *,
    duration: Seconds | None = None,
    events: StrictBool = True,
    tol: Tolerance = 1e-10,
    initial_state: InstanceOf[State] | None = None,
    stop_at: Literal["first_separation"] | None = None,
    ramps: Ramps = (),
    execution: InstanceOf[Execution] = _PLAIN,
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
    execution : largest number of steps and audit of energies, see `Execution`

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
    rule = "is required, or duration instead of it, and not both"
    require(((t_end is None) != (duration is None), "t_end", t_end, rule))
    start = 0.0 if initial_state is None else float(initial_state.time)
    end = t_end or start + (duration or 0.0)
    rule = f"must be > {as_text(start)}, the time of the initial state"
    require((start < end < math.inf, "t_end", t_end, rule))

    asked = windows or {}
    rule = "must not be given with stop_at: where the run ends is not known before"
    for name, window in asked.items():
        known = window.last is None or stop_at is None
        require((known, f"windows.{name}.last", window.last, rule))
    sampled = resolved_windows(asked, start, end)
    check_ramps(case, ramps, sampled)

    loosest = states.loosest_tolerance(case)
    if tol > loosest:
        used = f"tol={tol:g}: the series need {loosest:g} at most, which is used"
        warnings.warn(used, stacklevel=4)
    run = Run(
        parameters=case,
        t_end=end,
        windows=sampled,
        events=events,
        tol=min(tol, loosest),
        initial_state=initial_state,
        stop_at=stop_at,
        ramps=ramps,
        execution=execution,
    )
    return run.complete()


@checked
def snapshots(
    case: Parameters,
    times: states.Times,
    *,
    tol: Tolerance = 1e-10,
    initial_state: InstanceOf[State] | None = None,
    ramps: Ramps = (),
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
    state = initial_state or states.static_start(case)
    rule = f"must be >= {as_text(state.time)} (the time of the initial state), and ascend"
    require((np.all(np.diff(times, prepend=state.time) >= 0), "times", times, rule))
    reached: list[State] = []
    for time in times.tolist():
        if time > state.time:
            run = simulate(case, time, tol=tol, events=False, initial_state=state, ramps=ramps)
            state = run.raise_for_status().final_state
        reached.append(state)
    return tuple(reached)
