"""SUNDIALS CVODE (in extra `bench`, with scikit-sundae) with its own root finding, restarted at every event.

The library is called directly: scikit-sundae calls Python for every right-hand side, which takes three times as long.
Right-hand side, event functions and Jacobian are compiled; they read and write CVODE's own memory.
"""

# mypy: disable-error-code="no-untyped-def"
import ctypes
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any

import numba
import numpy as np
from numba import carray, types

from disc_model.benchmarks.methods import kernels
from disc_model.benchmarks.methods.base import ENDS, Ended, GaveUp, Meter, MethodResult, Problem, run_phases
from disc_model.benchmarks.methods.kernels import Array
from disc_model.benchmarks.methods.scipy_ivp import absolute_scale

STEPS_PER_LOOK = 5_000
"""Number of steps between two checks of the clock."""
FAMILIES = {"Adams": 1, "BDF": 2}
NORMAL, ONE_STEP = 1, 2
REACHED, ROOT_FOUND, TOO_MUCH_WORK = 1, 2, -1
HEAD = 3
"""Number of entries before the scalars in the callbacks' data: phase, direction, modes."""


def solve(problem: Problem, value: float, budget: float, family: str) -> MethodResult:
    """Variable-order multistep methods: Adams with fixed-point iteration, BDF with Newton's where all is stiff."""
    meter = Meter(problem, budget)
    n, scale = meter.physics.n, value * absolute_scale(meter.physics)
    state, constants = np.zeros(4 * n + 4), np.concatenate([[0.0, 0.0, n], meter.c, meter.modes.ravel()])
    time, evaluations, roots = ctypes.c_double(), ctypes.c_long(), (ctypes.c_int * 3)()
    falling = (ctypes.c_int * 3)(-1, -1, -1)
    call, switches = _library(), _callbacks()[1]

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
            raise GaveUp(f"CVODE returned {flag}")
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
        getattr(library, name).restype = ctypes.c_void_p
    return library


@cache
def _callbacks() -> tuple[ctypes.c_void_p, ...]:
    """Addresses of right-hand side, event functions and Jacobian."""
    # a vector or dense matrix of SUNDIALS begins with a pointer to its content, whose second word is the data pointer
    owner = types.CPointer(types.CPointer(types.CPointer(types.float64)))
    data, scalars, rows = types.CPointer(types.float64), len(kernels.CONSTANTS), len(kernels.ROWS)

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

    _callbacks.kept = rate, switches, jacobian  # type: ignore[attr-defined]
    return tuple(ctypes.c_void_p(callback.address) for callback in _callbacks.kept)  # type: ignore[attr-defined]


@contextmanager
def _solver(
    family: str, y: Array, tol: float, atol: Array, constants: Array
) -> Iterator[tuple[ctypes.c_void_p, ctypes.c_void_p]]:
    """CVODE's memory and the vector over ``y``; tolerances relative and (shape of ``y``) absolute."""
    call = _library()
    rate, _, jacobian = _callbacks()
    context, size = ctypes.c_void_p(), len(y)
    call.SUNContext_Create(0, ctypes.byref(context))
    call.SUNContext_ClearErrHandlers(context)
    vector, least = (
        ctypes.c_void_p(call.N_VMake_Serial(size, x.ctypes.data_as(ctypes.c_void_p), context)) for x in (y, atol)
    )
    memory = ctypes.c_void_p(call.CVodeCreate(FAMILIES[family], context))
    call.CVodeInit(memory, rate, ctypes.c_double(0.0), vector)
    call.CVodeSVtolerances(memory, ctypes.c_double(tol), least)
    call.CVodeSetUserData(memory, constants.ctypes.data_as(ctypes.c_void_p))
    call.CVodeSetMaxNumSteps(memory, ctypes.c_long(STEPS_PER_LOOK))
    if family == "Adams":
        iteration = ctypes.c_void_p(call.SUNNonlinSol_FixedPoint(vector, 0, context))
        call.CVodeSetNonlinearSolver(memory, iteration)
        made = [("SUNNonlinSolFree", iteration)]
    else:
        matrix = ctypes.c_void_p(call.SUNDenseMatrix(size, size, context))
        linear = ctypes.c_void_p(call.SUNLinSol_Dense(vector, matrix, context))
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
