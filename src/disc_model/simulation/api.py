"""`simulate`, the one function that runs the engine; states at chosen times; a case of a study as a
dataset."""

from __future__ import annotations

import dataclasses
import logging
import math
import os
import time as clock
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from disc_model.data.variables import PHASES
from disc_model.engine import audit, loop, record, transitions
from disc_model.engine import state as motion
from disc_model.engine.jit import compiled_for
from disc_model.engine.jit.cache import compiling
from disc_model.engine.model import blocks_of, flags_of, on_ramp, slope_under_slider
from disc_model.engine.stick_modes import LONGEST_STICK
from disc_model.errors import (
    DiscModelError,
    Fault,
    ParameterError,
    Status,
    as_text,
    raise_faults,
    require,
    violations,
)
from disc_model.parameters import Parameters, foreign_case
from disc_model.simulation import states
from disc_model.simulation.case import (
    CaseSpec,
    Ramp,
    SampleTimes,
    Start,
    Window,
    Windows,
    angle_of_drive,
    pieces,
    ramp_faults,
    resolved_windows,
)
from disc_model.simulation.request import Execution, Request, checked_request
from disc_model.simulation.result import BIN_ROW, FOLDED, SAMPLE_ROW, Result
from disc_model.simulation.states import Array, State
from disc_model.sources import git_commit, source_hash, versions
from disc_model.units import content_key, in_si

if TYPE_CHECKING:
    import xarray as xr

log = logging.getLogger(__name__)

MOST_STEPS = 2**62  # largest number of steps that the engine can count
STEPS_PER_PAUSE = (
    100_000  # steps between two pauses of the engine where a step is cheapest: about 0.1 s of work
)

_EXITS = (  # in the order of `Status`
    transitions.TIME_OVER, transitions.STOPPED, transitions.STEP_LIMIT, transitions.NO_SOLUTION, transitions.STALLED,
    transitions.NON_FINITE,
)  # fmt: skip
_STATUS = dict(zip(_EXITS, Status, strict=True))


_PLAIN = Execution()


def simulate(  # noqa: PLR0913
    p: Parameters,
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
    p : the case
    t_end : s, absolute, greater than the initial state's time; or a text with a unit, such as "2 min"
    duration : s, from the initial state's time, instead of t_end
    windows : samples to keep, by name: a `Window` at a fixed rate, or `Poincare` for one sample a turn
    events : whether to keep the table of events (events are always counted)
    tol : expected error of event times after one second of motion, s, 1e-15 to 1e-2 (docs/accuracy.md). Instead of
        a larger value than 1.25e-7 (2e-6 on a compliant contact), this limit is used, and recorded in the result
    initial_state : state at the start; None is the static start (static equilibrium, stick, spring relaxed)
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
    request = checked_request(
        p,
        t_end=t_end,
        duration=duration,
        windows=windows,
        events=events,
        tol=tol,
        initial_state=initial_state,
        stop_at=stop_at,
        ramps=ramps,
        execution=execution,
    )
    if stop_at is not None and windows is not None:
        request = _with_windows_to_the_stop(request, windows)
    return _Run(request).complete()


def _with_windows_to_the_stop(request: Request, windows: Windows) -> Request:
    """Return the request with absolute times of the windows that count back from the end of a run
    that may stop earlier. When it stops is found by a run that records nothing."""
    from_the_end = {
        name: window
        for name, window in windows.items()
        if isinstance(window, Window) and window.last is not None
    }
    if not from_the_end:
        return request

    unrecorded = dataclasses.replace(request, windows={}, events=False)
    stopped = _Run(unrecorded).complete().final_state.time
    if stopped <= request.start:
        return request
    resolved = resolved_windows(from_the_end, request.start, stopped)
    return dataclasses.replace(request, windows={**request.windows, **resolved})


def snapshots(
    p: Parameters,
    times: ArrayLike,
    *,
    tol: float = 1e-10,
    initial_state: State | None = None,
    ramps: Ramp | tuple[Ramp, ...] = (),
) -> tuple[State, ...]:
    """States of the system at given times, with its modal coordinates.

    Parameters
    ----------
    p : the case
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
    ramps = (ramps,) if isinstance(ramps, Ramp) else ramps
    numbers = states.finite_numbers(in_si(times, "s", [], ()))
    ascend = numbers is not None and not np.any(np.diff(numbers) < 0)
    starts = initial_state is None or isinstance(initial_state, State)
    wrong = violations(
        (starts, "initial_state", initial_state, "must be a State"),
        (ascend, "times", times, "must be finite and ascend"),
    )
    raise_faults(foreign_case(p) + wrong)
    raise_faults([*ramp_faults(p, ramps, poincare=False)])
    wanted: list[float] = [] if numbers is None else numbers.tolist()
    state = initial_state
    if state is None:
        state = states.static_start(p)
    reached: list[State] = []
    rule = f"must be >= {as_text(state.time)} (the time of the initial state)"
    require(*((time >= state.time, "times", time, rule) for time in wanted[:1]))
    for time in wanted:
        if time > state.time:
            state = (
                simulate(p, time, tol=tol, events=False, initial_state=state, ramps=ramps)
                .raise_for_status()
                .final_state
            )
        reached.append(state)
    return tuple(reached)


class _Run:
    """One run: its request, the engine's arrays, and the buffers that collect rows."""

    def __init__(self, request: Request) -> None:
        p = request.parameters
        self.request = request
        self.case = states.engine_case(p)
        self.key = self.case.key
        if request.ramps:
            self.key = content_key(self.case.key + repr(request.ramps))
        self.compliant = p.contact_compliance != 0
        self.pieces = pieces(p, request.ramps)
        self.wall_time = 0.0

        # the engine's arrays, at the initial state
        initial = request.initial_state
        order = states.series_order(request.tol)
        self.state, self.probe, self.series = states.take_workspace(self.case, order)
        at_switch = initial is not None and states.write_state(
            self.case, initial, self.state, self.key
        )
        start = self.time

        # of the drive over its angle by this run's Omega and ramps alone, after another history
        self.lead = 0.0
        if initial is not None and initial.drive_angle is not None:
            self.lead = float(initial.drive_angle) - angle_of_drive(self.pieces, start)
        self.collector = self._new_collector()
        self.limits = self._first_limits(order)

        # in reverse order, so that the first piece is current at the end; compiling here keeps it
        # out of the wall time
        for index, piece in reversed(tuple(enumerate(self.pieces))):
            if start < piece.end and piece.begin < request.t_end:
                self._enter(index)
        if at_switch:
            self._begin_at_switch()

    def _new_collector(self) -> Collector:
        """Return the buffers for the windows of the request, from the time of the state on."""
        request = self.request
        grids: dict[str, SampleTimes] = {}
        for name, window in request.windows.items():
            grid = window.grid(request.parameters, self.time, request.t_end)
            # the engine knows the angle without the lead
            grids[name] = grid._replace(theta=grid.theta - self.lead)
        longest = LONGEST_STICK * self.case.model.unit
        return Collector(grids, request.windows, request.events, request.t_end, longest)

    def _first_limits(self, order: int) -> loop.Limits:
        """Return the limits of the engine for series of an order, to the end of the run."""
        request = self.request
        model = self.case.model
        execution = request.execution
        most: float | None = execution.max_steps
        if most is None:
            # twenty for each radian of the highest mode, far more than any published case takes
            most = 10_000 + 20 * (request.t_end - self.time) / model.unit

        # pauses serve progress and Ctrl-C; there are fewer steps between them where a step costs
        # more. A compliant contact takes about four times as many steps per second
        step_cost = blocks_of(model)
        audit_interval = 256
        if execution.audit_every_step:
            step_cost *= 6
            audit_interval = 1
        return loop.Limits(
            order,
            states.series_tolerance(request.tol, self.compliant),
            request.t_end,
            request.stop_at is None,
            int(min(most, MOST_STEPS)),
            max(1, STEPS_PER_PAUSE // step_cost),
            audit_interval,
        )

    def _enter(self, index: int) -> None:
        """Continue with another piece of the ramps."""
        piece = self.pieces[index]
        self.index = index
        self.model = self.case.model
        if self.request.ramps:
            self.limits = self.limits._replace(t_end=min(self.request.t_end, piece.end))
        if index > 0:  # the first piece has the Omega and N of the case
            rates = {name: getattr(piece, name) for name in ("Omega", "Omega_rate", "N", "N_rate")}
            self.model = on_ramp(self.model, piece.begin, piece.angle, **rates)
        kind = flags_of(self.model)  # they determine the types of all arguments
        if kind not in _ENGINES:
            with compiling():
                _ENGINES[kind] = compiled_for(loop.run, self._arguments())
        self.engine = _ENGINES[kind]

    def _begin_at_switch(self) -> None:
        """Let the engine determine the phase at this instant, by a run of zero duration that
        records nothing."""
        model, series, state, probe, limits, buffers = self._arguments()
        low = motion.scalars_of(state)["time_low"]
        motion.set_time_low(state, 0.0)
        buffers = buffers._replace(samplers=buffers.samplers[:0], sampled=buffers.sampled[:0])
        self.engine(model, series, state, probe, limits._replace(t_end=self.time), buffers)
        motion.set_time_low(state, low)
        motion.clear_switch(state)
        for sums in (buffers.counters, buffers.phase_times, buffers.audit):
            sums.fill(0)

    def complete(self) -> Result:
        """Compute to the end, and tell the progress."""
        tell = self.request.execution.progress or (lambda _: None)
        code = self.advance()
        while code == transitions.PAUSED:
            tell(self.time)
            code = self.advance()
        tell(self.time)
        return self.result(_STATUS[code])

    @property
    def time(self) -> float:
        """The time reached, s."""
        return motion.time_of(self.state)

    def advance(self) -> int:
        """Compute until the engine pauses or ends, and empty its buffers.  Returns the exit
        code."""
        began = clock.perf_counter()
        code = self.engine(*self._arguments())
        if code == transitions.TIME_OVER and self.limits.t_end < self.request.t_end:
            self._enter(self.index + 1)
            code = transitions.PAUSED
        self.collector.drain()
        self.wall_time += clock.perf_counter() - began
        return code

    def _arguments(self) -> tuple[Any, ...]:
        return self.model, self.series, self.state, self.probe, self.limits, self.collector.buffers

    def result(self, status: Status) -> Result:
        """Assemble the result of the run, which ends here: other runs of the case may use its
        arrays."""
        request = self.request
        phase = PHASES[motion.phase_of(self.state)]
        message = f"{status.value}: at t = {self.time:.9g} s in {phase}"
        if status is Status.PARADOX:
            scalars = motion.scalars_of(self.state)
            slope = slope_under_slider(self.model, self.state)
            message += f", psi = {scalars['psi']:.6g} rad, f = {scalars['f']:.6g} rad/s"
            message += f", slope B = {slope:.6g}"
        result = Result(
            parameters=request.parameters,
            t_end=request.t_end,
            tol=min(request.tol, states.LOOSEST / states.LOCAL[self.compliant]),
            windows=request.windows,
            status=status,
            message=message,
            event_rows=np.concatenate(self.collector.events),
            first_separation=self.collector.first_separation,
            final_state=dataclasses.replace(
                states.read_state(self.case, self.state, self.key),
                drive_angle=angle_of_drive(self.pieces, self.time) + self.lead,
            ),
            u_0=self.model.u_0,
            statistics=self._statistics(),
            samples={name: samples.arrays() for name, samples in self.collector.samples.items()},
            ramps=request.ramps,
            initial_state=request.initial_state,
        )
        self.case.idle[self.limits.order].append((self.state, self.probe, self.series))
        return result

    def _statistics(self) -> dict[str, float]:
        def relative(residual: int, scale: int, turnover: int) -> float:
            """Sum of the residuals over the largest energy present plus all energy exchanged."""
            size = total[scale] + total[turnover] if every_step else math.nan
            return abs(total[residual]) / size if size else 0.0

        buffers = self.collector.buffers
        every_step = self.request.execution.audit_every_step
        coupled = bool(self.model.has_couple)
        count = buffers.counters.tolist()
        total = buffers.audit.tolist()
        return {
            "steps": count[record.STEPS],
            "events": count[record.EVENTS],
            "separations": count[record.SEPARATIONS],
            **{
                f"time_{phase}": time
                for phase, time in zip(PHASES, buffers.phase_times.tolist(), strict=True)
            },
            "energy_residual": total[audit.WORST] if total[audit.STEPS] else math.nan,
            "energy_residual_transverse": relative(
                audit.TRANSVERSE, audit.TRANSVERSE_SCALE, audit.TRANSVERSE_TURNOVER
            ),
            "energy_residual_inplane": relative(
                audit.INPLANE, audit.INPLANE_SCALE, audit.INPLANE_TURNOVER
            ),
            "audited_steps": int(total[audit.STEPS]),
            "couple_work": total[audit.COUPLE] if coupled and every_step else math.nan,
            "surface_speed": total[audit.SURFACE] if coupled else math.nan,
            "wall_time": self.wall_time,
        }


_ENGINES: dict[
    tuple[Any, ...], Callable[..., int]
] = {}  # compiled, by blocks of lanes, laws of contact and ramp


# ---- Recorded rows of a run: buffers between the engine and the arrays of a result

BUFFER = (
    1 << 15
)  # rows of samples between two pauses: large enough for cheap draining, small enough for the cache
EVENT_BUFFER = (
    1 << 10
)  # events between two pauses: a larger buffer takes longer to make than a short simulation


class Collector:
    """Provides the engine's `buffers`, empties them at each pause, and assembles the recorded
    arrays."""

    def __init__(
        self,
        grids: Mapping[str, SampleTimes],
        windows: Windows,
        events: bool,
        t_end: float,
        longest_step: float,
    ) -> None:
        # the engine pauses between steps only, so one step's samples must fit above ``capacity``
        longest = longest_step + record.SAME_INSTANT * t_end
        per_step = 0
        folds: dict[str, int] = {}
        rows: dict[str, float] = {}
        for name, grid in grids.items():
            per_step += 1 + math.ceil(min(longest / grid.interval, grid.number))
            folds[name] = getattr(windows[name], "envelope", None) or 1
            rows[name] = float(grid.number) / folds[name]
        size = 8.0 * len(record.SAMPLE_ROW) * (sum(rows.values()) + per_step)
        if rows and size > (room := _memory()):
            rule = f"must fit into memory: {size / 1e9:.3g} GB of samples in all, and there are {room / 1e9:.3g} GB"
            raise ParameterError(Fault(("windows", max(rows, key=rows.__getitem__)), "", rule))
        self.samples = {name: _Samples(grid.number, folds[name]) for name, grid in grids.items()}
        self.first_separation = math.nan  # s
        self.keeps_events = events
        self.events: list[Array] = []
        capacity = BUFFER if grids else 0
        self.buffers = record.RunBuffers(
            np.zeros(record.N_COUNTERS, np.int64),
            np.zeros(3),
            np.zeros(audit.N_SUMS),
            np.array([*grids.values()]) if grids else np.zeros((0, 5)),
            np.zeros(len(grids), np.int64),
            np.empty((capacity + per_step, len(record.SAMPLE_ROW))),
            capacity,
            np.empty((EVENT_BUFFER, len(record.EVENT_ROW))),
        )

    def drain(self) -> None:
        """Copy the rows from the buffers and empty them."""
        counters = self.buffers.counters
        events = self.buffers.event_rows[: counters[record.EVENT_ROWS]]
        rows = self.buffers.sample_rows[: counters[record.SAMPLE_ROWS]]
        counters[record.EVENT_ROWS] = counters[record.SAMPLE_ROWS] = 0
        if counters[record.SEPARATIONS] > 0 and math.isnan(self.first_separation):
            self.first_separation = events[events[:, 1] == record.LOSS_OF_CONTACT][0, 0].item()
        self.events.append(events.copy() if self.keeps_events else events[:0])
        for i, samples in enumerate(self.samples.values()):
            if len(new := rows[rows[:, 0] == i]):
                samples.add(new)


class _Samples:
    """Samples of a window, or bins of an envelope, in columns for as many as there may be, of which
    some are filled."""

    def __init__(self, count: int, fold: int) -> None:
        names = SAMPLE_ROW if fold == 1 else BIN_ROW
        self.columns = {name: np.empty(count // fold) for name in names}
        self.fold = fold
        self.filled = 0
        self.rest = np.empty((0, len(record.SAMPLE_ROW)))  # rows of the bin that is not full

    def add(self, rows: Array) -> None:
        """Take in rows of the engine in order of time."""
        rows = np.concatenate([self.rest, rows]) if self.fold > 1 else rows
        whole = len(rows) // self.fold * self.fold
        self.rest, rows = rows[whole:], rows[:whole]
        done = _fold(rows.reshape(-1, self.fold, rows.shape[1])) if self.fold > 1 else rows[:, 1:]
        for column, values in zip(self.columns.values(), done.T, strict=True):
            column[self.filled : self.filled + len(done)] = values
        self.filled += len(done)

    def arrays(self) -> dict[str, Array]:
        """What was recorded, by name."""
        return {name: column[: self.filled] for name, column in self.columns.items()}


def _fold(cells: Array) -> Array:
    """Rows of mean time and (min, max) of each folded column, from cells of shape (n, samples,
    columns)."""
    columns = [cells[:, :, record.SAMPLE_ROW.index(name)] for name in ("time", *FOLDED)]
    ranges = [bound for column in columns[1:] for bound in (column.min(axis=1), column.max(axis=1))]
    return np.stack([columns[0].mean(axis=1), *ranges], axis=1)


def _memory() -> float:
    """Size of this machine's memory in bytes; infinite where the system does not tell it."""
    try:
        return float(os.sysconf("SC_PAGE_SIZE")) * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, ValueError, OSError):
        return math.inf


# ---- Initial states, and a named case of a study


def make_initial_state(p: Parameters, start: Start, tol: float) -> State | None:
    """The initial state of a motion of case `p`, at time 0; None is the static start. Raises
    `SimulationError` if the preceding motion ends early, `ParameterError` if its disc has another
    number of modes."""
    kick = {name: value for name, value in start.perturbation.items() if value}
    state = None
    if start.prerun is not None:
        other = p.replace(**start.prerun.parameters)
        sizes = [
            (name, getattr(other, name), getattr(p, name)) for name in ("n_diameters", "n_circles")
        ]
        path = "start.prerun.parameters."
        rule = "must be that of the case, "
        require(
            *(
                (count == needed, path + name, count, f"{rule}{needed}")
                for name, count, needed in sizes
            )
        )
        state = states.transfer_state(p, _end_of(other, start.prerun.time, tol))
    return (
        states.perturb(p, states.static_start(p) if state is None else state, **kick)
        if kick
        else state
    )


def state_after(p: Parameters, start: Start, time: float, tol: float) -> State:
    """The state of case `p` at a time (s) after its start; raises `SimulationError`."""
    run = simulate(p, time, tol=tol, initial_state=make_initial_state(p, start, tol), events=False)
    return run.raise_for_status().final_state


@lru_cache(maxsize=8)
def _end_of(p: Parameters, time: float, tol: float) -> State:
    return simulate(p, time, tol=tol).raise_for_status().final_state


def run_case(spec: CaseSpec, choose: Any = None) -> xr.DataTree:
    """Simulate a named case of a study, in the layout of `disc_model.data.dataset`; a failure is
    recorded as a status. `choose` is `disc_model.mode_choice.choose_when_run`, which only a case
    with `modes` needs."""
    import xarray as xr

    from disc_model.data.dataset import json_attribute, scalars_dataset

    needed = "must be `disc_model.mode_choice.choose_when_run`, as the case leaves its modes to be chosen"
    require((callable(choose) or not spec.modes, "choose", choose, needed))
    p = spec.parameters
    truncation = ""  # how the number of modes was chosen, as JSON, if it was
    try:
        if spec.modes:
            p, truncation = choose(p, spec.modes)
            log.info("modes chosen: %s", truncation)
        start = make_initial_state(p, spec.start, spec.tol)
        result = simulate(
            p, spec.t_end, spec.sections, events=spec.events is not None, tol=spec.tol, initial_state=start,
            stop_at=spec.stop_at, ramps=spec.ramps, execution=Execution(audit_every_step=spec.audit_every_step),
        )  # fmt: skip
    except DiscModelError as error:
        log.error("no result: %s", error)
        known = {"t_end": spec.t_end, "tol": spec.tol}
        tree = xr.DataTree(scalars_dataset(p, known, "failed", f"{type(error).__name__}: {error}"))
    else:
        log.info(
            "%s, first separation %s s, %s",
            result.status.value,
            result.first_separation,
            result.statistics,
        )
        tree = result.to_tree()
        events = tree["events"].to_dataset()
        within = slice(0)
        span: dict[str, float] = {}
        if spec.events is not None:
            within = slice(*events["time"].values.searchsorted(spec.events))
            span = dict(zip(("kept_from", "kept_until"), spec.events, strict=True))
        tree["events"].dataset = events.isel(event=within).assign_attrs(span)
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
