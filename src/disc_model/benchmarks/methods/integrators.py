"""The contract of methods, and all of them: the engine, fixed-step Runge-Kutta, scipy's
integrators, heyoka and CVODE.

A method is a function ``(problem, value, budget, *arguments)`` that advances a `Problem`, with its
one setting equal to ``value``, for at most about ``budget`` seconds, and returns a `MethodResult`,
also if it failed on the way.
"""

from __future__ import annotations

import ctypes
import enum
import math
import time as clock
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cache, lru_cache, partial
from typing import Any

import numba
import numpy as np
from numba import carray, types
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicHermiteSpline

from disc_model.benchmarks.methods import kernels
from disc_model.benchmarks.methods.kernels import SHIFT, Array, Physics
from disc_model.data.variables import EVENT_KINDS, PHASES
from disc_model.errors import Status
from disc_model.parameters import Parameters
from disc_model.simulation.api import Execution, simulate
from disc_model.simulation.case import Window
from disc_model.simulation.states import State


class RunStatus(enum.StrEnum):
    FINISHED = "finished"  # reached t_end
    NON_FINITE = "non_finite"  # the numbers overflowed
    STALLED = "stalled"  # switches without the clock moving, over and over
    TOO_SLOW = "too_slow"  # the budget of seconds was used up
    FAILED = "failed"  # the integrator itself gave up, or the model has no solution


@dataclass(frozen=True, eq=False)
class Problem:
    """An initial-value problem: start and end of the motion."""

    parameters: Parameters
    start: State
    t_end: float  # s, absolute, greater than start.time
    stop: bool = False  # whether to end at the first separation
    watched: bool = (
        False  # whether the range of the disc is requested, which costs some methods time
    )
    max_step: float = math.inf  # s, longest step of methods that would miss events with longer ones

    @property
    def span(self) -> float:
        """Simulated time, s."""
        return self.t_end - self.start.time


@dataclass(frozen=True, eq=False)
class MethodResult:
    times: Array  # of events, s, (n_events,)
    kinds: tuple[str, ...]  # of events, words of `disc_model.data.variables.EVENT_KINDS`
    final: State  # at t_end, or where the method stopped
    seconds: float  # processor time of the integration
    work: int  # number of right-hand sides, or of steps for methods that work with series
    outcome: RunStatus
    message: str = ""
    longest_step: float = math.nan  # s; nan if not known
    heights: tuple[float, float] = (
        math.nan,
        math.nan,
    )  # m, least and greatest w under the slider; nan if not watched
    glue: float = (
        math.nan
    )  # s of them spent in Python between compiled phases; nan where that was not measured


class GaveUp(Exception):
    """Raised inside a run that cannot go on: its status and the reason."""


class Meter:
    """The constants of a run, and what it comes to: right-hand sides, time and, if requested, the
    disc's range."""

    def __init__(self, problem: Problem, budget: float) -> None:
        self.problem, self.physics, self.budget = problem, Physics(problem.parameters), budget
        self.work, self.longest_step, self.low, self.high = 0, math.nan, math.nan, math.nan
        self.outcome, self.message = RunStatus.FINISHED, ""

    @contextmanager
    def running(self) -> Iterator[None]:
        """Time the integration; everything before was preparation."""
        self.began, wall = clock.thread_time(), clock.perf_counter()
        try:
            yield
        except GaveUp as reason:
            self.outcome, self.message = reason.args
        self.seconds, self.wall = clock.thread_time() - self.began, clock.perf_counter() - wall

    def result(
        self, times: Sequence[float] | Array, kinds: Sequence[str], final: State
    ) -> MethodResult:
        """The result of a method with the meter's counts; times are those from the start on."""
        seconds, work, heights = self.seconds, self.work, (self.low, self.high)
        motion = self.problem.start.time + np.array(times), tuple(kinds), final
        return MethodResult(
            *motion, seconds, work, self.outcome, self.message, self.longest_step, heights
        )

    def steps(self, times: Array, states: Array) -> None:
        """Record steps of one phase by ``times`` (s, shape (k,)) and states (k, size), and the
        range of w."""
        if len(times) > 1:
            self.longest_step = float(np.fmax(self.longest_step, np.max(np.diff(times))))
        if not self.problem.watched:
            return
        q = self.physics
        w = states[:, q.a] @ q.shape
        rate = states[:, q.alpha] @ q.shape + states[:, q.f] * (states[:, q.b] @ q.slope)
        steps = np.flatnonzero((np.diff(times, append=math.inf) > 0.0) & np.isfinite(w + rate))
        if len(steps) > 1:  # w between them is a cubic
            cubics = CubicHermiteSpline(times[steps], w[steps], rate[steps])
            w = np.concatenate([w, cubics(cubics.derivative().roots(extrapolate=False))])
        self.low, self.high = (
            float(np.fmin.reduce(w, initial=self.low)),
            float(np.fmax.reduce(w, initial=self.high)),
        )

    def check(self) -> None:
        if clock.thread_time() - self.began > self.budget:
            raise GaveUp(RunStatus.TOO_SLOW, f"not finished after {self.budget:g} s")

    def counted(self, function: Callable[[float, Array], Array]) -> Callable[[float, Array], Array]:
        """``function``, counting its calls and looking at the clock every 64 of them."""

        def wrapped(t: float, y: Array) -> Array:
            self.work += 1
            if self.work & 63 == 0:
                self.check()
            return function(t, y)

        return wrapped


# ---- Methods that integrate one phase at a time and stop at its end
CROWD = 50  # greatest number of events at one instant; with more the method is stuck
NOT_FINITE = "the state is no longer finite"
ENDS = (3, 2, 1)
"""By the number of a phase in `kernels`: functions of the state that end it where they fall through zero, ties in this
order: the contact force (1 if bonded) or the gap; f in slip, or the margins of friction forwards and backwards."""
Ended = tuple[int | None, float, Array]
"""Index of the function that ended a phase (None at t_end), local time (s), and a state that the caller may change."""
Advance = Callable[[int, int, float, Array, float], Ended]
"""Integrates a phase ``(phase, direction, t, y, t_end)``, given by its number in `kernels` and the sign of f in it (0
except in slip), from local time ``t`` (s, 0 at the start) on; ``y`` is not changed."""


def run_phases(advance: Advance, meter: Meter) -> MethodResult:
    problem, physics, modes, c = meter.problem, meter.physics, meter.physics.modes, meter.physics.c
    phase, direction = PHASES.index(problem.start.phase), problem.start.direction
    t, y, span = 0.0, physics.pack(problem.start), problem.span
    new = np.zeros(2, np.int64)
    for compiled in (kernels.rate, kernels.switch_values):
        compiled(modes, c, 1, 1, y, np.empty_like(y))
    kernels.jacobian(modes, c, 1, 1, y, np.empty((len(y), len(y))))
    kernels.switch(modes, c, kernels.SEPARATION, 0, y.copy(), new)
    times: list[float] = []
    kinds: list[str] = []
    crowd = 0
    with meter.running():
        while True:
            if len(times) & 15 == 0:  # the clock takes as long as a phase of some methods
                meter.check()
            cause, t, y = advance(phase, direction, t, y, span)
            if cause is None:
                break
            phase, direction, added = kernels.switch(modes, c, phase, cause, y, new)
            if added < 0:
                raise GaveUp(RunStatus.NON_FINITE, NOT_FINITE)
            crowd = crowd + 1 if times and t - times[-1] < 1e-12 else 0  # s, at one instant
            for index in range(added):
                times.append(t)
                kinds.append(EVENT_KINDS[new[index]])
            if problem.stop and phase == kernels.SEPARATION:
                break
            if crowd > CROWD:
                raise GaveUp(RunStatus.STALLED, f"more than {CROWD} events at one instant")
        if not math.isfinite(y.sum()):
            raise GaveUp(RunStatus.NON_FINITE, NOT_FINITE)
    return meter.result(
        times, kinds, physics.unpack(problem.start.time + t, PHASES[phase], direction, y)
    )


# ---- scipy's integrators, phase by phase
def solve_by_scipy(problem: Problem, value: float, budget: float, algorithm: str) -> MethodResult:
    """`scipy.integrate.solve_ivp` with a compiled right-hand side and, where one is used, a
    compiled Jacobian."""
    meter, margins = Meter(problem, budget), np.empty(3)
    scale, least = meter.physics.scale(), 2.3e-14  # scipy accepts no smaller relative tolerance

    def advance(phase: int, direction: int, t: float, y: Array, t_end: float) -> Ended:
        modes, c = meter.physics.modes, meter.physics.c

        def rate(_t: float, y: Array) -> Array:
            dy = np.empty_like(y)
            kernels.rate(modes, c, phase, direction, y, dy)
            return dy

        def slopes(_t: float, y: Array) -> Array:
            J = np.empty((len(y), len(y)))
            kernels.jacobian(modes, c, phase, direction, y, J)
            return J

        def margin(index: int, _t: float, y: Array) -> float:
            kernels.switch_values(modes, c, phase, direction, y, margins)
            return float(margins[index])

        more = (
            {"jac": slopes} if algorithm in ("LSODA", "Radau") else {"max_step": problem.max_step}
        )
        events = [_event(partial(margin, index), -1, last=True) for index in range(ENDS[phase])]
        with np.errstate(over="ignore", invalid="ignore"):
            solution = solve_ivp(
                meter.counted(rate), (t, t_end), y,
                method=algorithm, rtol=max(value, least), atol=value * scale, events=events, **more,
            )  # fmt: skip
        meter.steps(solution.t, solution.y.T)
        if solution.status == -1:
            raise GaveUp(RunStatus.FAILED, solution.message)
        cause = next((i for i, times in enumerate(solution.t_events) if len(times)), None)
        return cause, float(solution.t[-1]), solution.y[:, -1].copy()

    return run_phases(advance, meter)


def _event(function: Callable[[float, Array], float], direction: int, *, last: bool) -> Any:
    """An event in scipy's form: the sign of the change of ``function`` (0: either), and whether it
    is terminal."""
    event: Any = partial(function)
    event.terminal, event.direction = last, direction
    return event


# ---- The regularised model
PENALTY = 1e7  # N/m times rad/s: K eps; the damping C is critical for the slider against the disc
CREEP = 3.0  # abs(f)/eps below which the slider counts as sticking
RTOL = 1e-8


def solve_regularised(
    problem: Problem, value: float, budget: float, algorithm: str
) -> MethodResult:
    """An algorithm of scipy on a model without events, one stiff ODE, `kernels.smooth_rate`;
    ``value`` is eps (rad/s). Its error is about eps^(2/3): stick ends by slow passage through a
    fold, the maximum of the law of friction."""
    meter, p, start = Meter(problem, budget), problem.parameters, problem.start
    physics, stiffness = meter.physics, PENALTY / value
    damping = 2.0 * math.sqrt(stiffness / (1.0 / p.m + physics.compliance))
    case = (
        physics.modes,
        physics.c,
        np.array([value, _excess(p.mu_s, p.mu_k), stiffness, damping]),
    )

    def force(_t: float, y: Array) -> float:
        return float(kernels.smooth_force(*case, y))

    def rate(_t: float, y: Array) -> Array:
        dy = np.empty_like(y)
        kernels.smooth_rate(*case, y, dy)
        return dy

    t, y = 0.0, physics.pack(start)
    if start.phase != "separation":  # the penetration carries the contact force
        y[physics.u], y[physics.v] = physics.disc_point(y)
        y[physics.u] -= kernels.contact(physics.modes, physics.c, start.direction, y)[0] / stiffness
    rate(t, y)  # compiles
    creep = _event(lambda _t, y: abs(y[physics.f]) - CREEP * value, 0, last=False)
    events = [
        creep,
        _event(force, 0, last=False),
        *([_event(force, -1, last=True)] if problem.stop else []),
    ]
    switches: list[tuple[float, str]] = []
    with meter.running(), np.errstate(over="ignore", invalid="ignore"):
        solution = solve_ivp(
            meter.counted(rate), (t, problem.span), y,
            method=algorithm, rtol=RTOL, atol=RTOL * physics.scale(), events=events,
        )  # fmt: skip
        meter.steps(solution.t, solution.y.T)
        t, y = float(solution.t[-1]), solution.y[:, -1]
        for time, state in zip(solution.t_events[0], solution.y_events[0], strict=True):
            if force(time, state) > 0:  # in separation a zero of f is no event
                leaving = np.sign(state[physics.f]) * rate(time, state)[physics.f] > 0
                switches.append((float(time), "stick_to_slip" if leaving else "slip_to_stick"))
        for time, state in zip(solution.t_events[1], solution.y_events[1], strict=True):
            rising = force(time, state + 1e-9 * rate(time, state)) > force(time, state)
            switches.append((float(time), "reattachment" if rising else "separation"))
        if solution.status < 0:
            raise GaveUp(RunStatus.FAILED, solution.message)
    if not np.all(np.isfinite(y)):
        meter.outcome = RunStatus.NON_FINITE
    merged, f = _merged(switches), float(y[physics.f])
    phase = "separation" if force(t, y) <= 0 else "stick" if abs(f) < CREEP * value else "slip"
    direction = (1 if f > 0 else -1) if phase == "slip" else 0
    final = physics.unpack(start.time + t, phase, direction, y)
    return meter.result([time for time, _ in merged], [kind for _, kind in merged], final)


def _excess(mu_s: float, mu_k: float) -> float:
    """Height of the Stribeck peak over kinetic friction for which the law's maximum is the static
    friction."""
    x = np.linspace(0.0, 2.0 * kernels.STRIBECK, 20_001)
    rise, fall = np.tanh(x), np.exp(-((x / kernels.STRIBECK) ** 2))
    excess = mu_s - mu_k
    for _ in range(50):
        excess += mu_s - float(np.max(rise * (mu_k + excess * fall)))
    return excess


def _merged(events: list[tuple[float, str]]) -> list[tuple[float, str]]:
    """Events in order of time; a stick shorter than a microsecond, in which f only passes zero, is
    a slip reversal."""
    merged: list[tuple[float, str]] = []
    for t, kind in sorted(events):
        if (
            kind == "stick_to_slip"
            and merged
            and merged[-1][1] == "slip_to_stick"
            and t - merged[-1][0] < 1e-6
        ):
            merged[-1] = (merged[-1][0], "slip_reversal")
        else:
            merged.append((t, kind))
    return merged


# ---- Whole runs in one compiled call: the package's own engine, and the paper's fixed-step
# Runge-Kutta
SERIES_STEPS_PER_SECOND = (
    300_000  # steps per second of budget: the engine stops by steps, not by the clock
)
WATCH_RATE = 2e4
"""Sampling rate, 1/s: after a separation the disc vibrates by 0.04 rad a sample, and its range is accurate to 2e-4."""
STABILITY_LIMIT = 2.0 * math.sqrt(
    2.0
)  # largest omega h at which RK4 does not let an undamped oscillation grow
RK4_STEPS_PER_SECOND = 1_000_000
MAX_EVENTS = 20_000


def solve_by_series(problem: Problem, value: float, budget: float) -> MethodResult:
    """The engine of `disc_model.simulation.api`: Taylor series of high order, events as roots of
    polynomials."""
    steps = int(max(1, min(budget, 1e6) * SERIES_STEPS_PER_SECOND))
    windows = {}
    if problem.watched:  # in one bin over the whole run
        samples = max(2, round(WATCH_RATE * problem.span))
        window = Window(
            start=problem.start.time, stop=problem.t_end, rate=WATCH_RATE, envelope=samples
        )
        windows = {"whole": window}
    began = clock.thread_time()
    result = simulate(
        problem.parameters, problem.t_end, windows, tol=value, initial_state=problem.start,
        stop_at="first_separation" if problem.stop else None, execution=Execution(max_steps=steps),
    )  # fmt: skip
    failures = {Status.STEP_LIMIT: RunStatus.TOO_SLOW, Status.PARADOX: RunStatus.FAILED}
    status, seen = result.status, result.samples.get("whole", {})
    reached = len(seen.get("w_min", ()))  # of a bin that a run ends before, there is nothing
    return MethodResult(
        times=result.events["time"].to_numpy(),
        kinds=tuple(result.events["kind"]),
        final=result.final_state,
        # the time of the steps; of a long run, which other processes may have interrupted, that of
        # the call
        seconds=min(result.statistics["wall_time"], clock.thread_time() - began),
        work=int(result.statistics["steps"]),
        outcome=RunStatus.FINISHED
        if status.complete
        else failures.get(status) or RunStatus(status.value),
        message=result.message,
        heights=(float(seen["w_min"].min()), float(seen["w_max"].max()))
        if reached
        else (math.nan, math.nan),
    )


def solve_with_fewest(problem: Problem, value: float, budget: float) -> MethodResult:
    """The same engine without the disc's modes, however fast, if they change the answer by less
    than the tolerance: by about k sum psi^2/omega^2, the disc's deflection over that of the
    slider's spring."""
    physics = Physics(problem.parameters)
    give = problem.parameters.k * float(np.sum(physics.shape**2 / physics.stiffness))
    start = problem.start
    if give > value or start.phase == "separation":
        return solve_by_series(problem, value, budget)
    rigid = start.replace(
        u=0.0, u_velocity=0.0, **dict.fromkeys(("a", "b", "alpha", "beta"), np.empty(0))
    )
    case = problem.parameters.replace(n_diameters=-1)
    result = solve_by_series(replace(problem, parameters=case, start=rigid), value, budget)
    end = result.final
    moved = start.replace(
        time=end.time, phase=end.phase, direction=end.direction, psi=end.psi, f=end.f
    )
    return replace(result, final=moved)


def solve_by_rk4(problem: Problem, value: float, budget: float) -> MethodResult:
    """Classical RK4; ``value`` is the step."""
    meter, start = Meter(problem, budget), problem.start
    y = meter.physics.pack(start)
    track = (np.empty(MAX_EVENTS), np.empty(MAX_EVENTS, np.int64), np.array([math.inf, -math.inf]))
    case = (meter.physics.modes, meter.physics.c, PHASES.index(start.phase), start.direction)
    steps = int(max(1, min(budget, 1e6) * RK4_STEPS_PER_SECOND))
    kernels.rk4_run(*case, y.copy(), (0.0, value, 1, problem.stop), track)  # compiles
    limits = (problem.span, value, steps, problem.stop)
    with meter.running():
        why, t, phase, direction, n, steps = kernels.rk4_run(*case, y, limits, track)
    meter.outcome = (
        RunStatus.FINISHED,
        RunStatus.NON_FINITE,
        RunStatus.STALLED,
        RunStatus.TOO_SLOW,
    )[why]
    meter.work, meter.longest_step, (meter.low, meter.high) = 4 * steps, value, track[2].tolist()
    final = meter.physics.unpack(start.time + t, PHASES[phase], direction, y)
    return meter.result(track[0][:n], [EVENT_KINDS[kind] for kind in track[1][:n]], final)


# ---- heyoka's compiled Taylor series, of the extra `bench`. Its equations are arranged for the
# least work, without an event for loss of contact in stick, which ends before
HEYOKA_STEPS = 100_000  # number of steps between two checks of the clock


def solve_by_heyoka(problem: Problem, value: float, budget: float, mode: str = "") -> MethodResult:
    """heyoka's adaptive Taylor integrator; ``mode`` "compact": it compiles sooner and takes
    longer."""
    import heyoka as hy

    meter, p = Meter(problem, budget), problem.parameters
    drive = (p.N - p.k * meter.physics.u_0, p.Omega)  # in the order of `system`
    at_end, no_more = int(hy.taylor_outcome.time_limit), int(hy.taylor_outcome.step_limit)
    path: list[tuple[float, Array]] = []
    inside = 0.0

    def note(integrator: Any) -> bool:
        path.append((float(integrator.time), integrator.state.copy()))
        return True

    # called at every step, which takes longer than some steps
    seen = {"callback": note} if problem.watched else {}
    prepared = []
    for ends, integrator in zip(
        ENDS, _integrators(p.replace(N=1.0, Omega=1.0), value, mode == "compact"), strict=True
    ):
        integrator.pars[:2] = drive
        skipped = ends - len(integrator.t_events)  # with fewer events, the last ones of ENDS
        prepared.append(
            (
                integrator,
                integrator.propagate_until,
                integrator.state,
                len(integrator.state),
                skipped,
            )
        )

    def advance(phase: int, direction: int, t: float, y: Array, t_end: float) -> Ended:
        nonlocal inside
        integrator, propagate, state, size, skipped = prepared[phase]
        integrator.time, state[:] = t, y[:size]
        if direction:
            integrator.pars[2] = direction
        path.clear()
        began = clock.perf_counter()
        while True:
            outcome, _, _, steps, _, _ = propagate(t_end, max_steps=HEYOKA_STEPS, **seen)
            meter.work += steps
            if (stop := int(outcome)) != no_more:
                break
            meter.check()
        inside += clock.perf_counter() - began
        cause = None if stop == at_end else skipped - stop - 1
        if cause is not None and not skipped <= cause < ENDS[phase]:
            raise GaveUp(RunStatus.FAILED, str(outcome))
        if problem.watched:
            note(integrator)
            states = np.tile(y, (len(path) + 1, 1))
            states[1:, : len(state)] = [state for _, state in path]
            meter.steps(np.array([t, *(time for time, _ in path)]), states)
        y[:size] = state
        return cause, integrator.time, y

    result = run_phases(advance, meter)
    return replace(result, glue=result.seconds * (1.0 - inside / meter.wall))


@lru_cache(maxsize=32)
def _integrators(p: Parameters, tol: float, compact: bool) -> list[Any]:
    """Compiled integrators by phase; cases that differ in load and speed of the drive share them,
    see `system`."""
    import heyoka as hy

    made = []
    for phase in PHASES:
        rows, functions = system(Physics(p), phase)
        falling = [
            hy.t_event(g, direction=hy.event_direction.negative, cooldown=0.0) for g in functions
        ]
        state, options = (
            np.zeros(len(rows)),
            {"tol": tol, "compact_mode": compact, "fast_math": True},
        )
        made.append(hy.taylor_adaptive(rows, state, t_events=falling, **options))
    return made


def system(physics: Physics, phase: str) -> tuple[list[Any], list[Any]]:
    """Equations of a phase as heyoka expressions, in the order of the state vector, and the last of
    `ENDS`. Parameters at run time: N - k u_0, Omega and, in slip, its direction."""
    import heyoka as hy

    p, n, s = physics.p, physics.n, physics.shape
    load, drive, sign = (hy.par[i] for i in range(3))
    a, b, alpha, beta = ([hy.make_vars(f"{letter}{i}") for i in range(n)] for letter in "abpq")
    psi, f, u, v = hy.make_vars("psi", "f", "u", "v")
    fa, fb, falpha, fbeta = ([f * x for x in each] for each in (a, b, alpha, beta))
    sticks, touches = phase == "stick", phase != "separation"
    l, paired, below = (
        (0.0 if sticks else 1.0) * physics.l,
        1.0 * (physics.l > 0),
        1.0 + p.m * physics.compliance,
    )
    by = s / below

    def total(*terms: tuple[Any, Any]) -> Any:
        """Sum of products of factors and variables, without those that vanish."""
        used = [
            float(c) * x for factors, xs in terms for c, x in zip(factors, xs, strict=True) if c
        ]
        return hy.sum(used) if used else hy.expression(0.0)

    def each(*terms: tuple[Any, Any]) -> list[Any]:
        return [total(*((c[i : i + 1], x[i : i + 1]) for c, x in terms)) for i in range(n)]

    F = total(((p.k_p, p.c_p, 0.0 if sticks else -p.c_p), (psi, drive, f)))
    P, f_rate = hy.expression(0.0), hy.expression(0.0) if sticks else F / p.m
    if touches:
        held = (
            ((p.k - p.m * physics.stiffness) * by, a),
            ((p.c - p.m * physics.damping) * by, alpha),
        )
        P = total(([1.0 / below], [load]), *held, (2.0 * p.m * l * by, fbeta), (p.c * l * by, fb))
    if touches and l.any():
        tilt = total((l * by, b))
        P = P - f * total((p.m * l**2 * by, fa)) + tilt * F
        P = P / (1.0 + sign * (p.mu_k / p.r_0 * tilt))
    if phase == "slip":
        f_rate = f_rate - sign * (p.mu_k / (p.m * p.r_0)) * P

    damping, stiffness = -physics.damping, -physics.stiffness
    rates = each((np.ones(n), alpha), (l, fb)) + each((paired, beta), (-l, fa))
    rates += each((damping, alpha), (stiffness, a), (-s * touches, [P] * n), (l, fbeta))
    rates += each((damping * paired, beta), (stiffness * paired, b), (-l, falpha))
    rates += [drive if sticks else drive - f, f_rate]
    rows = list(zip([*a, *b, *alpha, *beta, psi, f], rates, strict=True))
    if not touches:
        rows += [(u, v), (v, total(((-1.0 / p.m, -p.k / p.m, -p.c / p.m), (load, u, v))))]
        return rows, [SHIFT + u - total((s, a))]
    if sticks:
        return rows, [p.mu_s * P - p.r_0 * F, p.mu_s * P + p.r_0 * F]
    return rows, [sign * f] if p.contact == "bilateral" else [P, sign * f]


# ---- SUNDIALS CVODE, of the extra `bench`, in scikit-sundae's library. It is called directly, with
# compiled callbacks that use its own memory: scikit-sundae calls Python for every right-hand side,
# which takes three times as long
Pointer = ctypes.c_void_p
CVODE_STEPS = 5_000  # number of steps between two checks of the clock
FAMILIES = {"Adams": 1, "BDF": 2}
NORMAL, ONE_STEP = 1, 2
REACHED, ROOT_FOUND, TOO_MUCH_WORK = 1, 2, -1
HEAD = 3  # number of entries before the scalars in the callbacks' data: phase, direction, modes


def solve_by_cvode(problem: Problem, value: float, budget: float, family: str) -> MethodResult:
    """Variable-order multistep methods: Adams with fixed-point iteration, BDF with Newton's where
    all is stiff."""
    meter = Meter(problem, budget)
    physics, n, scale = meter.physics, meter.physics.n, value * meter.physics.scale()
    state, constants = (
        np.zeros(4 * n + 4),
        np.concatenate([[0.0, 0.0, n], physics.c, physics.modes.ravel()]),
    )
    time, evaluations, roots = ctypes.c_double(), ctypes.c_long(), (ctypes.c_int * 3)()
    falling = (ctypes.c_int * 3)(-1, -1, -1)
    call, switches = _library(), Pointer(_callbacks()[1].address)

    def advance(phase: int, direction: int, t: float, y: Array, t_end: float) -> Ended:
        state[:], constants[:2], time.value = y, (phase, direction), t
        call.CVodeReInit(memory, ctypes.c_double(t), vector)
        call.CVodeRootInit(memory, ENDS[phase], switches)
        call.CVodeSetRootDirection(memory, falling)
        call.CVodeSetStopTime(memory, ctypes.c_double(t_end))
        flag, how, path = 0, ONE_STEP if problem.watched else NORMAL, [(t, y.copy())]
        while flag in (0, TOO_MUCH_WORK):
            meter.check()
            flag = call.CVode(memory, ctypes.c_double(t_end), vector, ctypes.byref(time), how)
            path.append((time.value, state.copy()))
        if problem.watched:
            meter.steps(
                np.array([time for time, _ in path]), np.array([state for _, state in path])
            )
        call.CVodeGetNumRhsEvals(memory, ctypes.byref(evaluations))
        meter.work += evaluations.value
        if flag < 0:
            raise GaveUp(RunStatus.FAILED, f"CVODE returned {flag}")
        if flag == REACHED:
            return None, time.value, state
        call.CVodeGetRootInfo(memory, roots)
        return next(i for i, is_root in enumerate(roots) if is_root), time.value, state

    with _solver(family, state, value, scale, constants) as (memory, vector):
        return run_phases(advance, meter)


@cache
def _library() -> Any:
    """The SUNDIALS functions in the library that comes with scikit-sundae."""
    import sksundae._cy_cvode as extension

    library = ctypes.CDLL(extension.__file__)
    for name in (
        "CVodeCreate",
        "N_VMake_Serial",
        "SUNNonlinSol_FixedPoint",
        "SUNDenseMatrix",
        "SUNLinSol_Dense",
    ):
        getattr(library, name).restype = Pointer
    return library


@cache
def _callbacks() -> tuple[Any, ...]:
    """Right-hand side, event functions and Jacobian."""
    # a vector or dense matrix of SUNDIALS begins with a pointer to its content, whose second word
    # is the data pointer
    owner = types.CPointer(types.CPointer(types.CPointer(types.float64)))
    data, scalars, rows = types.CPointer(types.float64), kernels.SCALARS, len(kernels.ROWS)

    @numba.njit(forceinline=True)
    def case(data):  # type: ignore[no-untyped-def]
        n = int(data[2])
        constants = carray(data, HEAD + scalars + rows * n)
        modes = constants[HEAD + scalars :].reshape((rows, n))
        return modes, constants[HEAD : HEAD + scalars], int(data[0]), int(data[1]), 4 * n + 4

    @numba.cfunc(types.int32(types.float64, owner, owner, data), error_model="numpy")
    def rate(_t, y, dy, data):  # type: ignore[no-untyped-def]
        modes, c, phase, direction, size = case(data)
        kernels.rate(modes, c, phase, direction, carray(y[0][1], size), carray(dy[0][1], size))
        return 0

    @numba.cfunc(types.int32(types.float64, owner, data, data), error_model="numpy")
    def switches(_t, y, out, data):  # type: ignore[no-untyped-def]
        modes, c, phase, direction, size = case(data)
        kernels.switch_values(modes, c, phase, direction, carray(y[0][1], size), carray(out, 3))
        return 0

    @numba.cfunc(
        types.int32(types.float64, owner, owner, owner, data, owner, owner, owner),
        error_model="numpy",
    )
    def jacobian(_t, y, _dy, J, data, _1, _2, _3):  # type: ignore[no-untyped-def]
        modes, c, phase, direction, size = case(data)
        by_columns = carray(J[0][1], (size, size))
        kernels.jacobian(modes, c, phase, direction, carray(y[0][1], size), by_columns.T)
        return 0

    return rate, switches, jacobian


@contextmanager
def _solver(
    family: str, y: Array, tol: float, atol: Array, constants: Array
) -> Iterator[tuple[Pointer, Pointer]]:
    """CVODE's memory and the vector over ``y``; tolerances relative and (shape of ``y``)
    absolute."""
    call = _library()
    rate, _, jacobian = (Pointer(callback.address) for callback in _callbacks())
    context, size = Pointer(), len(y)
    call.SUNContext_Create(0, ctypes.byref(context))
    call.SUNContext_ClearErrHandlers(context)
    vector, least = (
        Pointer(call.N_VMake_Serial(size, x.ctypes.data_as(Pointer), context)) for x in (y, atol)
    )
    memory = Pointer(call.CVodeCreate(FAMILIES[family], context))
    call.CVodeInit(memory, rate, ctypes.c_double(0.0), vector)
    call.CVodeSVtolerances(memory, ctypes.c_double(tol), least)
    call.CVodeSetUserData(memory, constants.ctypes.data_as(Pointer))
    call.CVodeSetMaxNumSteps(memory, ctypes.c_long(CVODE_STEPS))
    if family == "Adams":
        iteration = Pointer(call.SUNNonlinSol_FixedPoint(vector, 0, context))
        call.CVodeSetNonlinearSolver(memory, iteration)
        made = [("SUNNonlinSolFree", iteration)]
    else:
        matrix = Pointer(call.SUNDenseMatrix(size, size, context))
        linear = Pointer(call.SUNLinSol_Dense(vector, matrix, context))
        call.CVodeSetLinearSolver(memory, linear, matrix)
        call.CVodeSetJacFn(memory, jacobian)
        made = [("SUNLinSolFree", linear), ("SUNMatDestroy", matrix)]
    try:
        yield memory, vector
    finally:
        call.CVodeFree(ctypes.byref(memory))
        for free, handle in (*made, ("N_VDestroy", vector), ("N_VDestroy", least)):
            getattr(call, free)(handle)
        call.SUNContext_Free(ctypes.byref(context))
