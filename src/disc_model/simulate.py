"""`simulate`: the engine behind one function."""

from __future__ import annotations

import math
import time as clock
from collections.abc import Callable

import numpy as np
import pandas as pd

from disc_model.collect import Collector
from disc_model.engine import audit, layout, machine
from disc_model.errors import ParameterError
from disc_model.parameters import Parameters
from disc_model.plate import mode_arrays
from disc_model.record import Record
from disc_model.result import EVENT_KINDS, PHASES, Result, State, Status
from disc_model.states import read_state, write_state
from disc_model.tolerance import series_order, series_tolerance

TOLERANCES = (1e-15, 1e-2)
AUDIT_EVERY = 64
STEPS_PER_PAUSE = 200_000

_STATUS = {
    machine.FINISHED: Status.OK,
    machine.STOPPED: Status.STOPPED,
    machine.STEP_LIMIT: Status.STEP_LIMIT,
    machine.NO_SOLUTION: Status.PARADOX,
    machine.STALLED: Status.STALLED,
    machine.NON_FINITE: Status.NON_FINITE,
}


def simulate(
    p: Parameters,
    t_end: float,
    *,
    tol: float = 1e-10,
    initial_state: State | None = None,
    record: Record | None = None,
    stop_at: str | None = None,
    max_steps: int | None = None,
    progress: Callable[[float], object] | None = None,
) -> Result:
    """Simulate from the static equilibrium (or ``initial_state``) to the absolute time ``t_end``.

    Parameters
    ----------
    p : the case
    t_end : s, greater than the initial state's time
    tol : relative truncation error of a step, 1e-15 to 1e-2; event times over a second of motion are about as good
    initial_state : where to start; None is the published start (static equilibrium, stick, spring relaxed)
    record : what to keep; None keeps events and statistics
    stop_at : None, or "first_separation" to end at the first loss of contact
    max_steps : bound on the number of steps; None bounds it generously by the highest frequency
    progress : called now and then with the time reached

    Returns
    -------
    Result
        Also if the run could not go on: its ``status`` and ``message`` then say at what time, in what phase and why.

    Raises
    ------
    ParameterError
        Bad input; the message names the argument, its value and the rule.
    """
    record = Record() if record is None else record
    start = 0.0 if initial_state is None else initial_state.time
    _check_arguments(p, t_end, tol, start, record, stop_at, max_steps)
    model = build_model(p)
    order = series_order(tol)
    series, state, probe = layout.build_series(model, order), layout.build_state(model), layout.build_state(model)
    if initial_state is not None:
        write_state(p, model, initial_state, state)
    collector = Collector(p, record, start, t_end, longest_step=machine.LONGEST_STEP * model.unit)
    counters, phase_times, sums = np.zeros(machine.N_COUNTERS, np.int64), np.zeros(3), np.zeros(audit.N_SUMS)
    limit = _step_limit(model, t_end - start) if max_steps is None else max_steps

    def advance(limit: int) -> int:
        code: int = machine.run(
            model, series, state, probe, order, series_tolerance(tol), float(t_end), stop_at is not None, limit,
            STEPS_PER_PAUSE, 1 if record.energy else AUDIT_EVERY, counters, phase_times, sums,
            collector.samplers, collector.sampled, collector.capacity, collector.rows, collector.event_rows,
        )  # fmt: skip
        return code

    if not _compiled_for(model):
        advance(limit=0)  # compiles, so that the wall time below is the simulation's own
    began = clock.perf_counter()
    code = machine.PAUSED
    while code == machine.PAUSED:
        code = advance(limit)
        collector.drain(counters)
        if progress is not None:
            progress(float(state.x[layout.TIME]))
    wall_time = clock.perf_counter() - began
    samples, poincare = collector.finish()
    status = _STATUS[code]
    return Result(
        parameters=p,
        t_end=float(t_end),
        tol=float(tol),
        status=status,
        message=_message(status, state, model),
        events=_events_frame(collector.events()),
        first_separation=collector.first_separation,
        final_state=read_state(p, model, state),
        u_0=model.u_0,
        statistics=_statistics(counters, phase_times, sums, record.energy, wall_time),
        samples=samples,
        poincare=poincare,
    )


def _compiled_for(model: layout.Model, _seen: set[int] = set()) -> bool:  # noqa: B006 - the set is the memory
    """Whether the engine was used before for a model of this type (one block of lanes, or more)."""
    kind = len(model.more_blocks)
    known = kind in _seen
    _seen.add(kind)
    return known


def build_model(p: Parameters) -> layout.Model:
    """The engine's constants of a case."""
    modes = mode_arrays(p)
    return layout.build_model(
        modes.diameters,
        modes.omega,
        modes.psi,
        p.D_star / p.D * modes.omega**2,
        N=p.N,
        Omega=p.Omega,
        k=p.k,
        c=p.c,
        m=p.m,
        k_p=p.k_p,
        c_p=p.c_p,
        mu_s=p.mu_s,
        mu_k=p.mu_k,
        r_0=p.r_0,
        bonded=p.contact == "bonded",
    )


def _check_arguments(
    p: object, t_end: float, tol: float, start: float, record: object, stop_at: str | None, max_steps: int | None
) -> None:
    """Raise one ParameterError that lists every fault."""
    faults = []
    if not isinstance(p, Parameters):
        faults.append(f"p={p!r}: must be Parameters")
    if not isinstance(record, Record):
        faults.append(f"record={record!r}: must be a Record")
    if not _is_number(t_end) or not math.isfinite(t_end) or t_end <= start:
        faults.append(f"t_end={t_end!r}: must be finite and > {start:g} (the time of the initial state)")
    if not _is_number(tol) or not TOLERANCES[0] <= tol <= TOLERANCES[1]:
        faults.append(f"tol={tol!r}: must be within {TOLERANCES[0]:g} and {TOLERANCES[1]:g}")
    if stop_at not in (None, "first_separation"):
        faults.append(f"stop_at={stop_at!r}: must be None or 'first_separation'")
    if max_steps is not None and (not isinstance(max_steps, int) or max_steps < 1):
        faults.append(f"max_steps={max_steps!r}: must be a whole number >= 1")
    if faults:
        raise ParameterError(*faults)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float | np.floating | np.integer) and not isinstance(value, bool)


def _step_limit(model: layout.Model, duration: float) -> int:
    """Twenty steps for each radian of the highest mode, far more than any of the published cases takes."""
    return int(min(10_000 + 20 * duration / model.unit, 2**62))


def _events_frame(rows: np.ndarray) -> pd.DataFrame:
    columns = {name: rows[:, i] for i, name in enumerate(machine.EVENT_ROW)}
    kind = _categories(columns["kind"], EVENT_KINDS)
    phase = _categories(columns["phase"], PHASES)
    kept = {name: columns[name] for name in ("psi", "f", "u", "u_velocity", "P")}
    return pd.DataFrame({"time": columns["time"], "kind": kind, "phase": phase, **kept})


def _categories(codes: np.ndarray, names: tuple[str, ...]) -> pd.Categorical[str]:
    return pd.Categorical.from_codes(codes.astype(np.int64), categories=pd.Index(list(names)))


def _message(status: Status, state: layout.State, model: layout.Model) -> str:
    time, phase = state.x[layout.TIME], PHASES[int(state.x[layout.PHASE])]
    text = f"{status}: at t = {time:.9g} s in {phase}"
    if status is Status.PARADOX:
        slope = float(np.dot(model.slope, state.z))
        text += f", psi = {state.x[layout.PSI]:.6g} rad, f = {state.x[layout.SPEED]:.6g} rad/s, slope B = {slope:.6g}"
    return text


def _statistics(
    counters: np.ndarray, phase_times: np.ndarray, sums: np.ndarray, energy: bool, wall: float
) -> dict[str, float]:
    def relative(residual: int, scale: int, turnover: int) -> float:
        """Sum of the residuals over the largest energy present plus all energy exchanged."""
        size = float(sums[scale] + sums[turnover])
        if not energy:
            return math.nan
        return abs(float(sums[residual])) / size if size > 0 else 0.0

    return {
        "steps": int(counters[machine.STEPS]),
        "rejected": 0,  # a Taylor step is sized after its series is known: none is ever rejected
        "events": int(counters[machine.EVENTS]),
        "separations": int(counters[machine.SEPARATIONS]),
        "time_stick": float(phase_times[layout.STICK]),
        "time_slip": float(phase_times[layout.SLIP]),
        "time_separation": float(phase_times[layout.SEPARATION]),
        "energy_residual": float(sums[audit.WORST]) if sums[audit.STEPS] else math.nan,
        "energy_transverse": relative(audit.TRANSVERSE, audit.TRANSVERSE_SCALE, audit.TRANSVERSE_TURNOVER),
        "energy_inplane": relative(audit.INPLANE, audit.INPLANE_SCALE, audit.INPLANE_TURNOVER),
        "audited_steps": int(sums[audit.STEPS]),
        "wall_time": wall,
    }
