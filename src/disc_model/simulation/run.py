"""One run of the engine: the arrays that it works on, its pauses, what it records, and its result."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from disc_model.arrays import Array
from disc_model.data.variables import PHASES
from disc_model.engine import audit, loop, record, transitions
from disc_model.engine import state as motion
from disc_model.engine.jit import compiled_for
from disc_model.engine.jit.cache import compiling
from disc_model.engine.model import blocks_of, flags_of, on_ramp, slope_under_slider
from disc_model.engine.stick_modes import LONGEST_STICK
from disc_model.errors import Status, require
from disc_model.parameters import Parameters
from disc_model.provenance import content_key
from disc_model.simulation import states
from disc_model.simulation.case import Execution, Ramp, Windows, angle_of_drive, pieces
from disc_model.simulation.result import BIN_ROW, FOLDED, SAMPLE_ROW, Result
from disc_model.simulation.states import State

MOST_STEPS = 2**62  # largest number of steps that the engine can count
MOST_SAMPLES = 10**9  # of a window: far more than memory holds
# steps between two pauses of the engine where a step is cheapest: about 0.1 s of work
STEPS_PER_PAUSE = 100_000
# rows of samples between two pauses: large enough for cheap draining, small enough for the cache
BUFFER = 1 << 15
# events between two pauses: a larger buffer takes longer to make than a short simulation
EVENT_BUFFER = 1 << 10
# Where a ramp stops the drive, the time of a release is an angle over a speed that goes to 0: errors grow so
# many times (measured, up to 40).
STOPPING = 64.0

_STATUS = {
    transitions.TIME_OVER: Status.OK,
    transitions.STOPPED: Status.STOPPED,
    transitions.STEP_LIMIT: Status.STEP_LIMIT,
    transitions.NO_SOLUTION: Status.PARADOX,
    transitions.STALLED: Status.STALLED,
    transitions.NON_FINITE: Status.NON_FINITE,
}
BALANCES = {
    "transverse": (audit.TRANSVERSE, audit.TRANSVERSE_SCALE, audit.TRANSVERSE_TURNOVER),
    "inplane": (audit.INPLANE, audit.INPLANE_SCALE, audit.INPLANE_TURNOVER),
}
"""Places of the sum of residuals of a balance, the largest energy present, and all energy exchanged."""
# compiled, by blocks of lanes, laws of contact and ramp
_ENGINES: dict[tuple[Any, ...], Callable[..., int]] = {}


@dataclass
class Run:
    """One run: what it is asked for, as `disc_model.simulate` has checked it, with absolute times; the
    engine's arrays, and the buffers that collect rows."""

    parameters: Parameters
    t_end: float
    windows: Windows
    events: bool
    tol: float
    initial_state: State | None
    stop_at: str | None
    ramps: tuple[Ramp, ...]
    execution: Execution

    def __post_init__(self) -> None:
        self.case = states.engine_case(self.parameters)
        self.key = self.case.key
        if self.ramps:
            self.key = content_key(self.case.key + repr(self.ramps))
        self.pieces = pieces(self.parameters, self.ramps)
        self.first_separation = math.nan  # s
        self.event_rows: list[Array] = []

        # the engine's arrays, at the initial state
        self.order = states.series_order(self.tol)
        self.state, self.probe, self.series = states.take_workspace(self.case, self.order)
        initial = self.initial_state
        at_switch = initial is not None and states.write_state(
            self.case, initial, self.state, self.key, is_start=True
        )

        # of the drive over its angle by this run's Omega and ramps alone, after another history
        start = self.time
        self.lead = 0.0
        if initial is not None and initial.drive_angle is not None:
            self.lead = float(initial.drive_angle) - angle_of_drive(self.pieces, start)
        self.limits = self._first_limits(start)
        self.samples: dict[str, Samples] = {}
        self.buffers = self._new_buffers(start)

        self._enter(next(i for i, piece in enumerate(self.pieces) if start < piece.end))
        if at_switch:
            self._begin_at_switch()

    def _new_buffers(self, start: float) -> record.RunBuffers:
        """Return the buffers of the engine for the windows."""
        # the engine pauses between steps only, so one step's samples must fit above ``capacity``
        longest = LONGEST_STICK * self.case.model.unit + record.SAME_INSTANT * self.t_end
        per_step = 0
        grids = []
        for name, window in self.windows.items():
            grid = window.grid(self.parameters, start, self.t_end)
            # the engine knows the angle without the lead
            grids.append(grid._replace(theta=grid.theta - self.lead))
            per_step += 1 + math.ceil(min(longest / grid.interval, grid.number))
            rule = f"must have {MOST_SAMPLES:.0e} samples at most"
            require((grid.number <= MOST_SAMPLES, f"windows.{name}", window, rule))
            self.samples[name] = Samples(getattr(window, "envelope", None) or 1)
        capacity = BUFFER if grids else 0
        return record.RunBuffers(
            np.zeros(record.N_COUNTERS, np.int64),
            np.zeros(3),
            np.zeros(audit.N_SUMS),
            np.array(grids).reshape(-1, 5),
            np.zeros(len(grids), np.int64),
            np.empty((capacity + per_step, len(record.SAMPLE_ROW))),
            capacity,
            np.empty((EVENT_BUFFER, len(record.EVENT_ROW))),
        )

    def _first_limits(self, start: float) -> loop.Limits:
        """Return the limits of the engine to the end of the run."""
        model = self.case.model
        most: float | None = self.execution.max_steps
        if most is None:
            # twenty for each radian of the highest mode, far more than any published case takes
            most = 10_000 + 20 * (self.t_end - start) / model.unit

        compliant = self.parameters.contact_compliance != 0
        tolerance = states.series_tolerance(self.tol, compliant)
        if any(ramp.parameter == "Omega" and ramp.to == 0 for ramp in self.ramps):
            tolerance /= STOPPING

        # pauses serve Ctrl-C; there are fewer steps between them where a step costs
        # more. A compliant contact takes about four times as many steps per second
        step_cost = blocks_of(model)
        audit_every = 256
        if self.execution.audit_every_step:
            step_cost = 6 * step_cost
            audit_every = 1
        return loop.Limits(
            order=self.order,
            tolerance=tolerance,
            t_end=self.t_end,
            may_separate=self.stop_at is None,
            max_steps=int(min(most, MOST_STEPS)),
            pause_after=max(1, STEPS_PER_PAUSE // step_cost),
            audit_every=audit_every,
        )

    def _enter(self, index: int) -> None:
        """Continue with another piece of the ramps."""
        piece = self.pieces[index]
        self.index = index
        self.model = self.case.model
        kind = self.case.kind
        self.limits = self.limits._replace(t_end=min(self.t_end, piece.end))
        if index > 0:  # the first piece has the Omega and N of the case
            rates = {name: getattr(piece, name) for name in ("Omega", "Omega_rate", "N", "N_rate")}
            self.model = on_ramp(self.model, piece.begin, piece.angle, **rates)
            kind = flags_of(self.model)
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

    @property
    def time(self) -> float:
        """The time reached, s."""
        return motion.time_of(self.state)

    def complete(self) -> Result:
        """Compute to the end, and empty the buffers in each pause of the engine."""
        code = transitions.PAUSED
        while code == transitions.PAUSED:
            code = self.engine(*self._arguments())
            if code == transitions.TIME_OVER and self.limits.t_end < self.t_end:
                self._enter(self.index + 1)
                code = transitions.PAUSED
            self._drain()
        return self._result(_STATUS[code])

    def _arguments(self) -> tuple[Any, ...]:
        return self.model, self.series, self.state, self.probe, self.limits, self.buffers

    def _drain(self) -> None:
        """Copy the rows from the buffers and empty them."""
        counters = self.buffers.counters
        events = self.buffers.event_rows[: counters[record.EVENT_ROWS]]
        rows = self.buffers.sample_rows[: counters[record.SAMPLE_ROWS]]
        counters[record.EVENT_ROWS] = counters[record.SAMPLE_ROWS] = 0
        if counters[record.SEPARATIONS] > 0 and math.isnan(self.first_separation):
            self.first_separation = events[events[:, 1] == record.LOSS_OF_CONTACT][0, 0].item()
        self.event_rows.append(events.copy() if self.events else events[:0])
        for i, samples in enumerate(self.samples.values()):
            samples.add(rows[rows[:, 0] == i, 1:])

    def _result(self, status: Status) -> Result:
        """Assemble the result of the run, which ends here: other runs of the case may use its
        arrays."""
        angle = angle_of_drive(self.pieces, self.time) + self.lead
        final_state = states.read_state(self.case, self.state, self.key, drive_angle=angle)
        message = f"at t = {self.time:.9g} s in {final_state.phase}"
        # the drive has stopped, and neither it nor the preload will change
        last = self.pieces[-1]
        if status is Status.OK and last.Omega == 0 and last.begin <= self.time:
            message += ", the drive stands still"
            if final_state.phase == "stick":
                status = Status.AT_REST
        if status is Status.PARADOX:
            slope = slope_under_slider(self.model, self.state)
            message += f", psi = {final_state.psi:.6g} rad, f = {final_state.f:.6g} rad/s, slope B = {slope:.6g}"
        self.case.idle[self.order].append((self.state, self.probe, self.series))
        return Result(
            parameters=self.parameters,
            t_end=self.t_end,
            tol=self.tol,
            windows=self.windows,
            status=status,
            message=f"{status.value}: {message}",
            event_rows=np.concatenate(self.event_rows),
            first_separation=self.first_separation,
            final_state=final_state,
            u_0=self.model.u_0,
            statistics=self._statistics(),
            samples={name: samples.arrays() for name, samples in self.samples.items()},
            ramps=self.ramps,
            initial_state=self.initial_state,
        )

    def _statistics(self) -> dict[str, float]:
        """Return the `Result.statistics`."""
        count = self.buffers.counters.tolist()
        total = self.buffers.audit.tolist()
        times = zip(PHASES, self.buffers.phase_times.tolist(), strict=True)
        statistics: dict[str, float] = {
            "steps": count[record.STEPS],
            "n_events": count[record.EVENTS],
            "n_separations": count[record.SEPARATIONS],
            **{f"time_{phase}": time for phase, time in times},
            "energy_residual": math.nan,
            "audited_steps": int(total[audit.STEPS]),
            "surface_speed": math.nan,
        }
        if total[audit.STEPS]:
            statistics["energy_residual"] = total[audit.WORST]
        if self.model.has_moving_surface:
            statistics["surface_speed"] = total[audit.SURFACE]
        for name, (residual, scale, turnover) in BALANCES.items():
            share = math.nan  # energies need the sums over every step
            if self.execution.audit_every_step:
                share = abs(total[residual]) / (total[scale] + total[turnover] or 1.0)
            statistics[f"energy_residual_{name}"] = share
        return statistics


class Samples:
    """Samples of a window, or the bins of an envelope of so many samples each."""

    def __init__(self, fold: int) -> None:
        self.fold = fold
        self.names = BIN_ROW if fold > 1 else SAMPLE_ROW
        self.parts = [np.empty((0, len(self.names)))]
        self.rest = np.empty((0, len(SAMPLE_ROW)))  # rows of the bin that is not full

    def add(self, rows: Array) -> None:
        """Take in rows of the engine in order of time."""
        if self.fold > 1:
            rows = np.concatenate([self.rest, rows])
            whole = len(rows) // self.fold * self.fold
            self.rest = rows[whole:]
            rows = _fold(rows[:whole].reshape(-1, self.fold, len(SAMPLE_ROW)))
        self.parts.append(rows)

    def arrays(self) -> dict[str, Array]:
        """What was recorded, by name."""
        columns = np.concatenate([part.T for part in self.parts], axis=1)
        return dict(zip(self.names, columns, strict=True))


def _fold(cells: Array) -> Array:
    """Rows of mean time and (min, max) of each folded column, from cells of shape (n, samples,
    columns)."""
    folded = [cells[:, :, SAMPLE_ROW.index("time")].mean(axis=1)]
    for name in FOLDED:
        column = cells[:, :, SAMPLE_ROW.index(name)]
        folded += [column.min(axis=1), column.max(axis=1)]
    return np.stack(folded, axis=1)
