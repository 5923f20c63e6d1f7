"""SUNDIALS CVODE, of the extra ``bench``, in scikit-sundae's library, phase by phase.

It is called directly, with compiled callbacks that use its own memory: scikit-sundae calls Python
for every right-hand side, which takes three times as long.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from functools import cache
from typing import Any

import numba
import numpy as np
from numba import carray, types

from benchmarks.methods import kernels
from benchmarks.methods.integrators import GaveUp, Meter, MethodResult, Problem, RunStatus
from benchmarks.methods.kernels import Array
from benchmarks.methods.phases import ENDS, Ended, run_phases

Pointer = ctypes.c_void_p
CHECKED_STEPS = 5_000
"""Number of steps between two looks at the clock."""

# constants of SUNDIALS
FAMILIES = {"Adams": 1, "BDF": 2}
NORMAL = 1
REACHED = 1
ROOT_FOUND = 2
TOO_MUCH_WORK = -1
CREATING = (
    "CVodeCreate",
    "N_VMake_Serial",
    "SUNNonlinSol_FixedPoint",
    "SUNDenseMatrix",
    "SUNLinSol_Dense",
)
"""Functions that return a pointer."""

HEAD = 3
"""Number of entries before the scalars in the callbacks' data: phase, direction, modes."""


def solve_by_cvode(problem: Problem, value: float, budget: float, family: str) -> MethodResult:
    """Integrate with variable-order multistep methods.

    Parameters
    ----------
    problem : what is integrated
    value : tolerance
    budget : seconds
    family : "Adams", with fixed-point iteration, or "BDF", with Newton's where all is stiff
    """
    meter = Meter(problem, budget)
    physics = meter.physics
    scale = value * physics.scale()
    state = np.zeros(4 * physics.n + 4)
    constants = np.concatenate([[0.0, 0.0, physics.n], physics.c, physics.modes.ravel()])
    time = ctypes.c_double()
    roots = (ctypes.c_int * 3)()
    falling = (ctypes.c_int * 3)(-1, -1, -1)
    call = _library()
    switches = Pointer(_callbacks()[1].address)

    def advance(phase: int, direction: int, t: float, y: Array, t_end: float) -> Ended:
        state[:] = y
        constants[:2] = (phase, direction)
        time.value = t
        call.CVodeReInit(memory, ctypes.c_double(t), vector)
        call.CVodeRootInit(memory, ENDS[phase], switches)
        call.CVodeSetRootDirection(memory, falling)
        call.CVodeSetStopTime(memory, ctypes.c_double(t_end))

        flag = 0
        while flag in (0, TOO_MUCH_WORK):
            meter.check()
            flag = call.CVode(memory, ctypes.c_double(t_end), vector, ctypes.byref(time), NORMAL)

        if flag < 0:
            raise GaveUp(RunStatus.FAILED)
        if flag == REACHED:
            return None, time.value, state
        call.CVodeGetRootInfo(memory, roots)
        cause = next(i for i, is_root in enumerate(roots) if is_root)
        return cause, time.value, state

    with _solver(family, state, value, scale, constants) as (memory, vector):
        return run_phases(advance, meter)


@cache
def _library() -> Any:
    """Return the SUNDIALS functions in the library that comes with scikit-sundae."""
    import sksundae._cy_cvode as extension

    library = ctypes.CDLL(extension.__file__)
    for name in CREATING:
        getattr(library, name).restype = Pointer
    return library


@cache
def _callbacks() -> tuple[Any, Any, Any]:
    """Compile what CVODE calls: right-hand side, event functions and Jacobian."""
    # a vector or dense matrix of SUNDIALS begins with a pointer to its content, whose second word
    # is the data pointer
    owner = types.CPointer(types.CPointer(types.CPointer(types.float64)))
    data = types.CPointer(types.float64)
    scalars = kernels.SCALARS
    rows = len(kernels.ROWS)

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
def _solver(family: str, y: Array, tol: float, atol: Array, constants: Array) -> Iterator[Any]:
    """Create CVODE for a state, as its memory and its vector over the state, and free it in the end.

    Parameters
    ----------
    family : key of `FAMILIES`
    y : the state, which CVODE changes
    tol, atol : relative tolerance, and absolute ones of the shape of y
    constants : data of the callbacks
    """
    call = _library()
    rate, _, jacobian = _callbacks()
    size = len(y)
    with ExitStack() as cleanup:
        context = Pointer()
        call.SUNContext_Create(0, ctypes.byref(context))
        call.SUNContext_ClearErrHandlers(context)
        cleanup.callback(call.SUNContext_Free, ctypes.byref(context))

        def own(create: Callable[..., Any], free: Callable[..., Any], *args: Any) -> Any:
            """Create an object of SUNDIALS, which is freed in the end."""
            created = Pointer(create(*args))
            cleanup.callback(free, created)
            return created

        def vector_of(array: Array) -> Any:
            memory = array.ctypes.data_as(Pointer)
            return own(call.N_VMake_Serial, call.N_VDestroy, size, memory, context)

        least = vector_of(atol)
        vector = vector_of(y)
        memory = Pointer(call.CVodeCreate(FAMILIES[family], context))
        call.CVodeInit(memory, Pointer(rate.address), ctypes.c_double(0.0), vector)
        call.CVodeSVtolerances(memory, ctypes.c_double(tol), least)
        call.CVodeSetUserData(memory, constants.ctypes.data_as(Pointer))
        call.CVodeSetMaxNumSteps(memory, ctypes.c_long(CHECKED_STEPS))
        if family == "Adams":
            iteration = own(call.SUNNonlinSol_FixedPoint, call.SUNNonlinSolFree, vector, 0, context)
            call.CVodeSetNonlinearSolver(memory, iteration)
        else:
            matrix = own(call.SUNDenseMatrix, call.SUNMatDestroy, size, size, context)
            linear = own(call.SUNLinSol_Dense, call.SUNLinSolFree, vector, matrix, context)
            call.CVodeSetLinearSolver(memory, linear, matrix)
            call.CVodeSetJacFn(memory, Pointer(jacobian.address))
        cleanup.callback(call.CVodeFree, ctypes.byref(memory))
        yield memory, vector
