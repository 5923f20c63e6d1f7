"""One run of the engine: the arrays that it works on, its pauses, and its result."""

from __future__ import annotations

import math
import time as clock
from collections.abc import Callable
from typing import Any

import numpy as np

from disc_model.data.variables import PHASES
from disc_model.engine import audit, loop, record, transitions
from disc_model.engine import state as motion
from disc_model.engine.jit import compiled_for
from disc_model.engine.jit.cache import compiling
from disc_model.engine.model import blocks_of, flags_of, on_ramp, slope_under_slider
from disc_model.engine.stick_modes import LONGEST_STICK
from disc_model.errors import Status
from disc_model.hashing import content_key
from disc_model.simulation import states
from disc_model.simulation.case import SampleTimes, angle_of_drive, pieces
from disc_model.simulation.collector import Collector
from disc_model.simulation.request import Request
from disc_model.simulation.result import Result, Totals

MOST_STEPS = 2**62  # largest number of steps that the engine can count
# steps between two pauses of the engine where a step is cheapest: about 0.1 s of work
STEPS_PER_PAUSE = 100_000

_STATUS = {
    transitions.TIME_OVER: Status.OK,
    transitions.STOPPED: Status.STOPPED,
    transitions.STEP_LIMIT: Status.STEP_LIMIT,
    transitions.NO_SOLUTION: Status.PARADOX,
    transitions.STALLED: Status.STALLED,
    transitions.NON_FINITE: Status.NON_FINITE,
}
# compiled, by blocks of lanes, laws of contact and ramp
_ENGINES: dict[tuple[Any, ...], Callable[..., int]] = {}


class Run:
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
            order=order,
            tolerance=states.series_tolerance(request.tol, self.compliant),
            t_end=request.t_end,
            may_separate=request.stop_at is None,
            max_steps=int(min(most, MOST_STEPS)),
            pause_after=max(1, STEPS_PER_PAUSE // step_cost),
            audit_every=audit_interval,
        )

    def _enter(self, index: int) -> None:
        """Continue with another piece of the ramps."""
        piece = self.pieces[index]
        self.index = index
        self.model = self.case.model
        kind = self.case.kind
        if self.request.ramps:
            self.limits = self.limits._replace(t_end=min(self.request.t_end, piece.end))
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
        final_state = states.read_state(
            self.case,
            self.state,
            self.key,
            drive_angle=angle_of_drive(self.pieces, self.time) + self.lead,
        )
        stopped = status is Status.OK and self._drive_stands_still()
        if stopped and final_state.phase == "stick":
            status = Status.AT_REST
        message = f"{status.value}: at t = {self.time:.9g} s in {final_state.phase}"
        if stopped:
            message += ", the drive stands still"
        if status is Status.PARADOX:
            end = states.read_state(self.case, self.state)
            slope = slope_under_slider(self.model, self.state)
            message += f", psi = {end.psi:.6g} rad, f = {end.f:.6g} rad/s"
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
            final_state=final_state,
            u_0=self.model.u_0,
            statistics=self._statistics(),
            samples={name: samples.arrays() for name, samples in self.collector.samples.items()},
            ramps=request.ramps,
            initial_state=request.initial_state,
        )
        self.case.idle[self.limits.order].append((self.state, self.probe, self.series))
        return result

    def _drive_stands_still(self) -> bool:
        """Return whether the drive has stopped, and neither it nor the preload will change."""
        last = self.pieces[-1]
        return last.Omega == 0 and last.begin <= self.time

    def _statistics(self) -> Totals:
        """Return the `Result.statistics`."""
        buffers = self.collector.buffers
        every_step = self.request.execution.audit_every_step
        count = buffers.counters.tolist()
        total = buffers.audit.tolist()
        statistics = Totals(
            steps=count[record.STEPS],
            n_events=count[record.EVENTS],
            n_separations=count[record.SEPARATIONS],
        )
        for phase, duration in zip(PHASES, buffers.phase_times.tolist(), strict=True):
            statistics[f"time_{phase}"] = duration

        # energies, which need the sums over every step, but for the worst of the audited ones
        statistics |= dict.fromkeys(_ENERGIES, math.nan)
        statistics["audited_steps"] = int(total[audit.STEPS])
        if total[audit.STEPS]:
            statistics["energy_residual"] = total[audit.WORST]
        if every_step:
            statistics["energy_residual_transverse"] = _relative(
                total[audit.TRANSVERSE],
                total[audit.TRANSVERSE_SCALE] + total[audit.TRANSVERSE_TURNOVER],
            )
            statistics["energy_residual_inplane"] = _relative(
                total[audit.INPLANE], total[audit.INPLANE_SCALE] + total[audit.INPLANE_TURNOVER]
            )
        if self.model.has_moving_surface:
            statistics["surface_speed"] = total[audit.SURFACE]
        statistics["wall_time"] = self.wall_time
        return statistics


_ENERGIES = (
    "energy_residual",
    "energy_residual_transverse",
    "energy_residual_inplane",
    "audited_steps",
    "surface_speed",
)


def _relative(residual: float, size: float) -> float:
    """Return the sum of residuals over the largest energy present plus all energy exchanged."""
    if not size:
        return 0.0
    return abs(residual) / size
