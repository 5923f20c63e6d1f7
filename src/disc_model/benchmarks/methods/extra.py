"""Integrators of the extra `bench`: heyoka's compiled Taylor series, and SUNDIALS CVODE with scikit-sundae.

heyoka's equations are arranged for the least work, with no event for loss of contact in stick, which ends before.
CVODE's library is called directly, with compiled callbacks that read and write its own memory: scikit-sundae calls
Python for every right-hand side, which takes three times as long.
"""

# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

import ctypes
import time as clock
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import cache, lru_cache
from typing import Any

import numba
import numpy as np
from numba import carray, types

from disc_model.benchmarks.methods import kernels
from disc_model.benchmarks.methods.base import ENDS, Ended, GaveUp, Meter, MethodResult, Problem, RunStatus, run_phases
from disc_model.benchmarks.methods.kernels import SHIFT, Array, Physics
from disc_model.data.variables import PHASES
from disc_model.parameters import Parameters

HEYOKA_STEPS = 100_000  # number of steps between two checks of the clock


def solve_by_heyoka(problem: Problem, value: float, budget: float, mode: str = "") -> MethodResult:
    """heyoka's adaptive Taylor integrator; ``mode`` "compact": it compiles sooner and takes longer."""
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
    for ends, integrator in zip(ENDS, _integrators(p.replace(N=1.0, Omega=1.0), value, mode == "compact"), strict=True):
        integrator.pars[:2] = drive
        skipped = ends - len(integrator.t_events)  # with fewer events, the last ones of ENDS
        prepared.append((integrator, integrator.propagate_until, integrator.state, len(integrator.state), skipped))

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
    """Compiled integrators by phase; cases that differ in load and speed of the drive share them, see `system`."""
    import heyoka as hy

    made = []
    for phase in PHASES:
        rows, functions = system(Physics(p), phase)
        falling = [hy.t_event(g, direction=hy.event_direction.negative, cooldown=0.0) for g in functions]
        state, options = np.zeros(len(rows)), {"tol": tol, "compact_mode": compact, "fast_math": True}
        made.append(hy.taylor_adaptive(rows, state, t_events=falling, **options))
    return made


def system(physics: Physics, phase: str) -> tuple[list[Any], list[Any]]:
    """Equations of a phase as heyoka expressions, in the order of the state vector, and the last of `base.ENDS`.
    Parameters at run time: N - k u_0, Omega and, in slip, its direction."""
    import heyoka as hy

    p, n, s = physics.p, physics.n, physics.shape
    load, drive, sign = (hy.par[i] for i in range(3))
    a, b, alpha, beta = ([hy.make_vars(f"{letter}{i}") for i in range(n)] for letter in "abpq")
    psi, f, u, v = hy.make_vars("psi", "f", "u", "v")
    fa, fb, falpha, fbeta = ([f * x for x in each] for each in (a, b, alpha, beta))
    sticks, touches = phase == "stick", phase != "separation"
    l, paired, below = (0.0 if sticks else 1.0) * physics.l, 1.0 * (physics.l > 0), 1.0 + p.m * physics.compliance
    by = s / below

    def total(*terms: tuple[Any, Any]) -> Any:
        """Sum of products of factors and variables, without those that vanish."""
        used = [float(c) * x for factors, xs in terms for c, x in zip(factors, xs, strict=True) if c]
        return hy.sum(used) if used else hy.expression(0.0)

    def each(*terms: tuple[Any, Any]) -> list[Any]:
        return [total(*((c[i : i + 1], x[i : i + 1]) for c, x in terms)) for i in range(n)]

    F = total(((p.k_p, p.c_p, 0.0 if sticks else -p.c_p), (psi, drive, f)))
    P, f_rate = hy.expression(0.0), hy.expression(0.0) if sticks else F / p.m
    if touches:
        held = ((p.k - p.m * physics.stiffness) * by, a), ((p.c - p.m * physics.damping) * by, alpha)
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


# ---- SUNDIALS CVODE, with scikit-sundae
Pointer = ctypes.c_void_p
CVODE_STEPS = 5_000  # number of steps between two checks of the clock
FAMILIES = {"Adams": 1, "BDF": 2}
NORMAL, ONE_STEP = 1, 2
REACHED, ROOT_FOUND, TOO_MUCH_WORK = 1, 2, -1
HEAD = 3  # number of entries before the scalars in the callbacks' data: phase, direction, modes


def solve_by_cvode(problem: Problem, value: float, budget: float, family: str) -> MethodResult:
    """Variable-order multistep methods: Adams with fixed-point iteration, BDF with Newton's where all is stiff."""
    meter = Meter(problem, budget)
    physics, n, scale = meter.physics, meter.physics.n, value * meter.physics.scale()
    state, constants = np.zeros(4 * n + 4), np.concatenate([[0.0, 0.0, n], physics.c, physics.modes.ravel()])
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
            meter.steps(np.array([time for time, _ in path]), np.array([state for _, state in path]))
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
    for name in ("CVodeCreate", "N_VMake_Serial", "SUNNonlinSol_FixedPoint", "SUNDenseMatrix", "SUNLinSol_Dense"):
        getattr(library, name).restype = Pointer
    return library


@cache
def _callbacks() -> tuple[Any, ...]:
    """Right-hand side, event functions and Jacobian."""
    # a vector or dense matrix of SUNDIALS begins with a pointer to its content, whose second word is the data pointer
    owner = types.CPointer(types.CPointer(types.CPointer(types.float64)))
    data, scalars, rows = types.CPointer(types.float64), kernels.SCALARS, len(kernels.ROWS)

    @numba.njit(forceinline=True)
    def case(data):
        n = int(data[2])
        constants = carray(data, HEAD + scalars + rows * n)
        modes = constants[HEAD + scalars :].reshape((rows, n))
        return modes, constants[HEAD : HEAD + scalars], int(data[0]), int(data[1]), 4 * n + 4

    @numba.cfunc(types.int32(types.float64, owner, owner, data), error_model="numpy")
    def rate(_t, y, dy, data):
        modes, c, phase, direction, size = case(data)
        kernels.rate(modes, c, phase, direction, carray(y[0][1], size), carray(dy[0][1], size))
        return 0

    @numba.cfunc(types.int32(types.float64, owner, data, data), error_model="numpy")
    def switches(_t, y, out, data):
        modes, c, phase, direction, size = case(data)
        kernels.switch_values(modes, c, phase, direction, carray(y[0][1], size), carray(out, 3))
        return 0

    @numba.cfunc(types.int32(types.float64, owner, owner, owner, data, owner, owner, owner), error_model="numpy")
    def jacobian(_t, y, _dy, J, data, _1, _2, _3):
        modes, c, phase, direction, size = case(data)
        by_columns = carray(J[0][1], (size, size))
        kernels.jacobian(modes, c, phase, direction, carray(y[0][1], size), by_columns.T)
        return 0

    return rate, switches, jacobian


@contextmanager
def _solver(family: str, y: Array, tol: float, atol: Array, constants: Array) -> Iterator[tuple[Pointer, Pointer]]:
    """CVODE's memory and the vector over ``y``; tolerances relative and (shape of ``y``) absolute."""
    call = _library()
    rate, _, jacobian = (Pointer(callback.address) for callback in _callbacks())
    context, size = Pointer(), len(y)
    call.SUNContext_Create(0, ctypes.byref(context))
    call.SUNContext_ClearErrHandlers(context)
    vector, least = (Pointer(call.N_VMake_Serial(size, x.ctypes.data_as(Pointer), context)) for x in (y, atol))
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
