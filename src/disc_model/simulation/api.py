"""`simulate`, the one function that runs the engine; initial states of motions; a case of a study as a dataset."""

from __future__ import annotations

import logging
import math
import time as clock
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from disc_model.data.provenance import git_commit, versions
from disc_model.data.variables import PHASES
from disc_model.engine import audit, event_loop, exit_codes, layout
from disc_model.engine.compile import compiled_for
from disc_model.errors import DiscModelError, Status, as_text, raise_faults, violations
from disc_model.parameters import Parameters, foreign_case
from disc_model.progress import Progress, compiling, simulating
from disc_model.simulation import ramps as courses
from disc_model.simulation.case import CaseSpec, Record, Start, Window
from disc_model.simulation.ramps import Ramp
from disc_model.simulation.recorder import Collector
from disc_model.simulation.result import Result
from disc_model.simulation.states import (
    State,
    engine_case,
    is_finite,
    perturb,
    read_state,
    series_order,
    series_tolerance,
    static_start,
    take_workspace,
    transfer_state,
    used_tolerance,
    write_state,
)
from disc_model.sources import source_hash
from disc_model.units import TOLERANCES, content_key, in_si, is_number, is_whole, limits_faults

if TYPE_CHECKING:
    import xarray as xr

log = logging.getLogger(__name__)

Choose = Callable[[Parameters, str], tuple[Parameters, str]]
"""Maps a case and the JSON text of its choice of modes to the case with its modes and a record of the choice."""

MOST_STEPS = 2**62
"""Largest number of steps that the engine can count."""
STEPS_PER_PAUSE = 100_000
"""Steps between two pauses of the engine where a step is cheapest: about 0.1 s of work."""

_EVENTS_ALONE = Record()
_STATUS = {
    exit_codes.TIME_OVER: Status.OK,
    exit_codes.STOPPED: Status.STOPPED,
    exit_codes.STEP_LIMIT: Status.STEP_LIMIT,
    exit_codes.NO_SOLUTION: Status.PARADOX,
    exit_codes.STALLED: Status.STALLED,
    exit_codes.NON_FINITE: Status.NON_FINITE,
}


@dataclass(frozen=True, kw_only=True)
class Execution:
    """How a run is carried out. Nothing of it changes results, except that a run ends early after `max_steps`.

    Attributes
    ----------
    progress : function that is called repeatedly with the time reached. None shows the progress of a long run and of
        compilation; False shows nothing
    max_steps : largest number of steps; None sets a generous limit from the highest frequency
    """

    progress: Progress = None
    max_steps: int | None = None


_PLAIN = Execution()


def simulate(
    p: Parameters,
    t_end: float | str,
    *,
    tol: float = 1e-10,
    initial_state: State | None = None,
    record: Record | Window | None = None,
    stop_at: str | None = None,
    ramps: Ramp | tuple[Ramp, ...] = (),
    execution: Execution = _PLAIN,
) -> Result:
    """Simulate from the static equilibrium (or ``initial_state``) to the absolute time ``t_end``.

    Parameters
    ----------
    p : the case
    t_end : s, greater than the initial state's time; or a text with a unit, such as "2 min"
    tol : expected error of event times after one second of motion, s, 1e-15 to 1e-2 (docs/accuracy.md). A value above
        1.25e-7 (2e-6 on a compliant contact) is computed as that, and recorded as that in the result
    initial_state : state at the start; None is the static start (static equilibrium, stick, spring relaxed)
    record : quantities to keep, or a single window; None keeps events and statistics
    stop_at : None, or "first_separation" to end at the first loss of contact
    ramps : slow changes of Omega or N, in absolute time: a ramp may have begun before the initial state's time
    execution : progress and largest number of steps, see `Execution`

    Returns
    -------
    Result
        It is also returned if the run ended early: ``status`` and ``message`` then give the time, phase and reason.

    Raises
    ------
    ParameterError
        If an argument breaks a rule; the message names the argument, its value and the rule.
    """
    record = _EVENTS_ALONE if record is None else Record(windows=(record,)) if isinstance(record, Window) else record
    ramps = (ramps,) if isinstance(ramps, Ramp) else ramps
    asked = _Request(p, in_si(t_end, "s", [], ()), tol, initial_state, record, stop_at, ramps, execution)
    raise_faults(asked.faults())
    # numbers of other types would make the engine compile again, and would round differently
    start, end, asked.tol = asked.start, float(asked.t_end), float(tol)
    asked.t_end, asked.record = end, record.resolved(start, end)
    run = _Run(asked)
    for window in asked.record.outside(start, end):
        warnings.warn(f"{window}: stays empty, the run is from {start:g} to {end:g} s", stacklevel=2)
    code = run.advance()
    if code == exit_codes.PAUSED or callable(execution.progress):  # a short run has no progress to show
        with simulating(execution.progress, end) as tell:
            while code == exit_codes.PAUSED:
                tell(run.time)
                code = run.advance()
            tell(run.time)
    result = run.result(_STATUS[code])
    run.case.idle[run.limits.order].append((run.state, run.probe, run.series))
    return result


@dataclass(eq=False)
class _Request:
    """Arguments of `simulate`, with a `Record` and a tuple of ramps in every case."""

    p: Parameters
    t_end: Any
    tol: float = 1e-10
    initial_state: State | None = None
    record: Record = _EVENTS_ALONE
    stop_at: str | None = None
    ramps: tuple[Ramp, ...] = ()
    execution: Execution = _PLAIN

    @property
    def start(self) -> float:
        """Time at the start, s."""
        return 0.0 if self.initial_state is None else float(self.initial_state.time)

    def faults(self) -> list[str]:
        """Every fault of the arguments."""
        t_end, stop_at, state = self.t_end, self.stop_at, self.initial_state
        how = self.execution if isinstance(self.execution, Execution) else _PLAIN
        starts = state is None or isinstance(state, State)
        time = state.time if isinstance(state, State) else 0.0
        timed = is_finite(time)
        start = time if timed else 0.0
        later, rule = is_number(t_end) and start < t_end < math.inf, ""
        if not later:
            rule = f"must be finite and > {as_text(start)} (the time of the initial state)"
            rule = "must be a number in s, or with a unit of its kind" if isinstance(t_end, str) else rule
        found = foreign_case(self.p) + violations(
            (isinstance(self.record, Record), "record", self.record, "must be a Record or a Window"),
            (starts, "initial_state", state, "must be a State"),
            (timed, "initial_state.time", time, "must be finite"),
            (later, "t_end", t_end, rule),
        )
        stops = stop_at is None or (isinstance(stop_at, str) and stop_at == "first_separation")
        counts = how.max_steps is None or (is_whole(how.max_steps) and how.max_steps >= 1)
        shows = how.progress is None or isinstance(how.progress, bool) or callable(how.progress)
        found += limits_faults("tol", self.tol, TOLERANCES) + violations(
            (stops, "stop_at", stop_at, "must be None or 'first_separation'"),
            (how is self.execution, "execution", self.execution, "must be an Execution"),
            (counts, "max_steps", how.max_steps, "must be a whole number >= 1"),
            (shows, "progress", how.progress, "must be a function of the time, or False"),
        )
        if isinstance(self.p, Parameters) and not (isinstance(self.ramps, tuple) and not self.ramps):
            found += courses.faults(self.p, self.ramps, poincare=getattr(self.record, "poincare", None) is not None)
        return found


class _Run:
    """One run: the engine's arrays, and the buffers that collect recorded rows."""

    def __init__(self, asked: _Request) -> None:
        self.asked, p, ramps, start = asked, asked.p, asked.ramps, asked.start
        self.pieces = courses.pieces(p, ramps)
        self.case = case = engine_case(p)
        self.key = content_key(case.key + repr(ramps)) if ramps else case.key
        model, order = case.model, series_order(asked.tol)
        self.state, self.probe, self.series = take_workspace(case, order)
        at_switch = False
        if asked.initial_state is not None:
            at_switch = write_state(case, asked.initial_state, self.state, self.key)
        longest_step = event_loop.LONGEST_STICK * model.unit
        self.collector = Collector(p, asked.record, start, asked.t_end, longest_step)
        self.wall_time = 0.0
        most, every_step = asked.execution.max_steps, asked.record.audit_every_step
        tolerance = series_tolerance(asked.tol, compliant=p.contact_compliance != 0)
        most_steps = min(_step_limit(model, asked.t_end - start) if most is None else int(most), MOST_STEPS)
        # pauses serve progress and Ctrl-C; there are fewer steps between them where a step costs more
        pause_after = max(1, STEPS_PER_PAUSE // (model.blocks * (6 if every_step else 1)))
        audit_every = 1 if every_step else 256  # a compliant contact takes about four times as many steps per second
        self.limits = event_loop.Limits(
            order, tolerance, asked.t_end, asked.stop_at is not None, most_steps, pause_after, audit_every
        )
        # in reverse order, so that the first piece is current at the end; compiling here keeps it out of the wall time
        for place, piece in reversed(tuple(enumerate(self.pieces))):
            if start < piece.end and piece.begin < asked.t_end:
                self._enter(place)
        if at_switch:
            self._begin_at_switch()

    def _enter(self, place: int) -> None:
        """Continue with another piece of the ramps."""
        self.place, self.model, piece = place, self.case.model, self.pieces[place]
        if self.asked.ramps:
            self.limits = self.limits._replace(t_end=min(self.asked.t_end, piece.end))
        if not piece.constant:
            rates = {name: getattr(piece, name) for name in ("Omega", "Omega_rate", "N", "N_rate")}
            self.model = layout.on_ramp(self.model, piece.begin, piece.angle, **rates)
        self.engine = _engine_for(self.model, self._arguments, report=self.asked.execution.progress is not False)

    def _begin_at_switch(self) -> None:
        """Let the engine determine the phase at this instant, by a run of zero duration that records nothing."""
        model, series, state, probe, limits, kept = self._arguments()
        low, state.x[layout.TIME_LOW] = float(state.x[layout.TIME_LOW]), 0.0
        kept = kept._replace(samplers=kept.samplers[:0], sampled=kept.sampled[:0])
        self.engine(model, series, state, probe, limits._replace(t_end=self.time), kept)
        state.x[layout.TIME_LOW], state.x[layout.PROPAGATED] = low, 0.0
        for counted in (kept.counters, kept.phase_times, kept.audit):
            counted.fill(0)

    @property
    def time(self) -> float:
        """The time reached, s."""
        return float(self.state.x[layout.TIME])

    def advance(self) -> int:
        """Compute until the engine pauses or ends, and empty its buffers.  Returns the exit code."""
        began = clock.perf_counter()
        code = self.engine(*self._arguments())
        if code == exit_codes.TIME_OVER and self.limits.t_end < self.asked.t_end:
            self._enter(self.place + 1)
            code = exit_codes.PAUSED
        self.collector.drain()
        self.wall_time += clock.perf_counter() - began
        return code

    def _arguments(self) -> tuple[Any, ...]:
        """Arguments of `event_loop.run`."""
        return self.model, self.series, self.state, self.probe, self.limits, self.collector.buffers

    def result(self, status: Status) -> Result:
        """Assemble the result of the run."""
        asked = self.asked
        samples, poincare = self.collector.finish()
        return Result(
            parameters=asked.p,
            t_end=asked.t_end,
            tol=used_tolerance(asked.tol, compliant=asked.p.contact_compliance != 0),
            record=asked.record,
            status=status,
            message=_message(status, self.state, self.model),
            event_rows=self.collector.events(),
            first_separation=self.collector.first_separation,
            final_state=read_state(self.case, self.state, self.key),
            u_0=self.model.u_0,
            statistics=_statistics(self.collector.buffers, asked.record.audit_every_step, self.wall_time),
            samples=samples,
            poincare=poincare,
            ramps=asked.ramps,
        )


def _engine_for(model: layout.Model, arguments: Callable[[], tuple[object, ...]], report: bool) -> Callable[..., int]:
    """The engine, compiled for this kind of model: the kind determines the types of all ``arguments`` of a run."""
    kind = model.wide, model.compliant, model.normal, model.ramped
    if kind not in _ENGINES:
        with compiling(report):
            _ENGINES[kind] = compiled_for(event_loop.run, arguments())
    return _ENGINES[kind]


_ENGINES: dict[tuple[tuple[bool, ...], ...], Callable[..., int]] = {}
"""Compiled engines by blocks of lanes, laws of contact and ramp."""


def _step_limit(model: layout.Model, duration: float) -> int:
    """Twenty steps for each radian of the highest mode, far more than any of the published cases takes."""
    return int(min(10_000 + 20 * duration / model.unit, MOST_STEPS))


def _message(status: Status, state: layout.EngineState, model: layout.Model) -> str:
    time, phase = float(state.x[layout.TIME]), PHASES[int(state.x[layout.PHASE])]
    text = f"{status.value}: at t = {time:.9g} s in {phase}"
    if status is Status.PARADOX:
        slope = float(np.dot(model.dw_dtheta, state.z))
        text += f", psi = {state.x[layout.PSI]:.6g} rad, f = {state.x[layout.SPEED]:.6g} rad/s, slope B = {slope:.6g}"
    return text


def _statistics(kept: event_loop.RunBuffers, audit_every_step: bool, wall: float) -> dict[str, float]:
    def relative(residual: int, scale: int, turnover: int) -> float:
        """Sum of the residuals over the largest energy present plus all energy exchanged."""
        size = total[scale] + total[turnover]
        if not audit_every_step:
            return math.nan
        return abs(total[residual]) / size if size > 0 else 0.0

    count, total = kept.counters.tolist(), kept.audit.tolist()
    stick, slip, separation = kept.phase_times.tolist()
    return {
        "steps": count[event_loop.STEPS],
        "events": count[event_loop.EVENTS],
        "separations": count[event_loop.SEPARATIONS],
        "time_stick": stick,
        "time_slip": slip,
        "time_separation": separation,
        "energy_residual": total[audit.WORST] if total[audit.STEPS] else math.nan,
        "energy_residual_transverse": relative(audit.TRANSVERSE, audit.TRANSVERSE_SCALE, audit.TRANSVERSE_TURNOVER),
        "energy_residual_inplane": relative(audit.INPLANE, audit.INPLANE_SCALE, audit.INPLANE_TURNOVER),
        "audited_steps": int(total[audit.STEPS]),
        "wall_time": wall,
    }


# ----------------------------------------------------------------------------------------------------
# Initial states


def make_initial_state(p: Parameters, start: Start, tol: float) -> State | None:
    """The initial state of a motion of case `p`, at time 0; None is the static start.

    Raises `SimulationError` if the preceding motion ends early, `ParameterError` if its parameters break a rule, or its
    disc has another number of modes.
    """
    kick = {name: value for name, value in start.perturbation.items() if value}
    state = None
    if start.prerun is not None:
        other = p.replace(**start.prerun.parameters)
        sizes = [(name, getattr(other, name), getattr(p, name)) for name in ("n_diameters", "n_circles")]
        place, rule = "start.prerun.parameters.", "must be that of the case, "
        raise_faults(violations(*((found == own, place + name, found, f"{rule}{own}") for name, found, own in sizes)))
        state = transfer_state(p, _end_of(other, start.prerun.time, tol))
    return perturb(p, static_start(p) if state is None else state, **kick) if kick else state


def state_after(p: Parameters, start: Start, time: float, tol: float) -> State:
    """The state of case `p` at a time (s) after its start; raises `SimulationError` if the motion ends earlier."""
    run = simulate(p, time, tol=tol, initial_state=make_initial_state(p, start, tol), record=Record(events=False))
    return run.raise_for_status().final_state


@lru_cache(maxsize=8)
def _end_of(p: Parameters, time: float, tol: float) -> State:
    return simulate(p, time, tol=tol).raise_for_status().final_state


# ----------------------------------------------------------------------------------------------------
# A case of a study


def run_case(spec: CaseSpec, choose: Choose | None = None) -> xr.DataTree:
    """Simulate a named case of a study; `disc_model.data.dataset` describes the layout of the tree.

    A failure is recorded as a status in the dataset and does not end the study.

    Parameters
    ----------
    choose : function that chooses the modes by a quantity of the motion, see `disc_model.mode_choice`; needed only
        for a case that asks for such a choice
    """
    from disc_model.data.dataset import json_attribute, scalars_dataset, to_tree

    p, truncation = spec.parameters, spec.truncation
    try:
        if spec.modes:
            if choose is None:
                raise TypeError("choose is needed where the modes are to be chosen")
            p, truncation = choose(p, spec.modes)
            log.info("modes chosen: %s", truncation)
        start = make_initial_state(p, spec.start, spec.tol)
        result = simulate(
            p, spec.t_end, tol=spec.tol, initial_state=start, record=spec.record, stop_at=spec.stop_at,
            ramps=spec.ramps,
        )  # fmt: skip
    except DiscModelError as error:
        log.error("no result: %s", error)
        known = {"t_end": spec.t_end, "tol": spec.tol}
        tree = to_tree({"": scalars_dataset(p, known, "failed", f"{type(error).__name__}: {error}")})
    else:
        log.info("%s, first separation %s s, %s", result.status.value, result.first_separation, result.statistics)
        tree = result.to_tree([name for name, _ in spec.windows])
        tree["events"].dataset = _kept_events(tree["events"].to_dataset(), spec.events)
    if spec.start != Start():
        tree.attrs["start"] = json_attribute(spec.start.model_dump())
    if truncation:
        tree.attrs["truncation"] = truncation
    tree.attrs |= {
        "source_hash": source_hash(__name__),
        "git_commit": git_commit(),
        "versions": json_attribute(versions()),
        "specification": spec.beside,
        "specification_key": spec.key,
    }
    return tree


def _kept_events(events: xr.Dataset, span: tuple[float, float] | None) -> xr.Dataset:
    if span is None:
        return events.isel(event=slice(0))
    kept = events.isel(event=slice(*events["time"].values.searchsorted(span)))
    return kept.assign_attrs(kept_from=span[0], kept_until=span[1])
