"""Columns, which are small changes of the state along a motion, and where their numbers stand.

Columns are stored side by side in blocks of eight lanes. The rows of a column are in the order of
`state`: the disc's, then psi, f, u and u' of the slider. In rigid contact u, u' are the disc's and
have a meaning in separation only. A column may also carry the change of a parameter, in rows of
inputs. All index arithmetic with these places is in this module.
"""

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from .jit import inlined
from .jit.packing import packed
from .jit.simd import WIDTH, aligned, load, store
from .laws import N_ENTRIES
from .model import Model
from .state import PHASE, PHI_RATE, PSI, SLIDER, STICK, U_VELOCITY, EngineState, U, clear
from .stick_modes import padded

# Rows of the inputs, in the order of an `Instant`: changes of N - k u_0, k, c, m, k_p, c_p, Omega,
# and of the compliance relative to it; after them of stiffness and damping of all lanes and of the
# modes without nodal diameter.
INPUTS = ("load", "k", "c", "m", "k_p", "c_p", "Omega", "compliance")
D_LOAD, D_K, D_C, D_M, D_K_P, D_C_P, D_OMEGA, D_COMPLIANCE, N_INPUTS = range(9)

# Entries of ``Tangent.log``: times in all and by phase (s), events, steps.
DURATION, STICK_TIME, SLIP_TIME, SEPARATION_TIME = range(4)
RELEASES, BACK_RELEASES, REVERSALS, SEPARATIONS, STICKS, N_STEPS = range(4, 10)


@packed()
class Tangent(NamedTuple):
    """Columns and their work space.  ``columns`` is a multiple of eight."""

    series: np.ndarray  # [block][order][row][8]
    force: np.ndarray  # [block][order][8] of P (R under the normal force)
    slope: np.ndarray  # [block][order][8] of B
    friction: np.ndarray  # [block][order][8] of T, where it has a series of its own
    now: np.ndarray  # [block][row][8]
    inputs: np.ndarray  # [block][input][8], changes of parameters
    before: np.ndarray  # [row][8], rates before an event in the first lane
    after: np.ndarray  # [row][8], rates after an event in the first lane
    change: np.ndarray  # [entry of an Instant][8], of a block of columns
    gradient: np.ndarray  # [2][entry of an Instant], derivatives of laws
    tau: np.ndarray  # [column], change of an event's time, s
    log: np.ndarray  # see ``DURATION``
    motion_slope: np.ndarray  # [order], B of the motion
    columns: int
    plain: int  # columns before this one carry no change of a parameter
    rows: int  # of a column
    orders: int  # of series
    input_rows: int


def n_rows(model: Model) -> int:
    """Return the number of rows of a column."""
    return 2 * len(model.mode_amplitude) + 2 * len(model.mode_amplitude0) + SLIDER


def build_tangent(model: Model, columns: int, order: int, inputs: int = 0) -> Tangent:
    """Return work space for columns of changes of the state, and, from ``Tangent.plain`` on, for
    ``inputs`` columns that also change a parameter; both in whole blocks."""
    plain = padded(columns)
    columns = plain + padded(inputs)
    rows = n_rows(model)
    orders = order + 2
    input_rows = N_INPUTS + rows - SLIDER
    return Tangent(
        series=aligned(orders * rows * columns),
        force=aligned(orders * columns),
        slope=aligned(orders * columns),
        friction=aligned(orders * columns),
        now=aligned(rows * columns),
        inputs=aligned(input_rows * columns),
        before=aligned(rows * WIDTH),
        after=aligned(rows * WIDTH),
        change=aligned(N_ENTRIES * WIDTH),
        gradient=aligned(2 * N_ENTRIES),
        tau=aligned(columns),
        log=aligned(N_STEPS + 1),
        motion_slope=aligned(orders),
        columns=columns,
        plain=plain,
        rows=rows,
        orders=orders,
        input_rows=input_rows,
    )


# ---- Addresses of lanes, for a block of columns


@inlined
def entry(rows, at, row):
    """Return a row of the block that begins at ``at`` of an array [row][8]."""
    return load(rows, at + row * WIDTH)


@inlined
def put_entry(rows, at, row, value):
    """Set a row of the block that begins at ``at`` of an array [row][8]."""
    store(rows, at + row * WIDTH, value)


@inlined
def now_at(tangent, block):
    """Return where a block begins in ``Tangent.now``."""
    return block * tangent.rows * WIDTH


@inlined
def inputs_at(tangent, block):
    """Return where a block begins in ``Tangent.inputs``."""
    return block * tangent.input_rows * WIDTH


@inlined
def order_at(tangent, block, k):
    """Return where order k of a block begins in ``Tangent.series``."""
    return (block * tangent.orders + k) * tangent.rows * WIDTH


@inlined
def chain_at(tangent, block, k):
    """Return where order k of a block stands in ``Tangent.force``, ``slope`` and ``friction``."""
    return (block * tangent.orders + k) * WIDTH


@inlined
def has_inputs(tangent, block):
    """Return whether the columns of a block change parameters."""
    return block * WIDTH >= tangent.plain


@inlined
def column_entry(tangent, column, row):
    """Return the place, in ``Tangent.now``, of a row of one column."""
    return now_at(tangent, column // WIDTH) + row * WIDTH + column % WIDTH


# ---- What Python reads and writes

COLUMNS_AT_ONCE = WIDTH  # so many cost as much as one


def coordinate_rows(model: Model, slider: tuple[str, ...] = ("psi", "f", "u", "u_velocity")):
    """Return the rows of a column but for those of empty lanes, in which rounding errors would stay
    for ever; of the slider only those named, which come last."""
    lanes = np.flatnonzero(model.shift)
    width = len(model.mode_amplitude)
    n = n_rows(model)
    modes = np.concatenate([lanes, width + lanes, np.arange(2 * width, n - SLIDER)])
    places = {"psi": PSI, "f": PHI_RATE, "u": U, "u_velocity": U_VELOCITY}
    return np.append(modes, [n - SLIDER + places[name] for name in slider]).astype(np.intp)


def diameters_of_rows(model: Model) -> np.ndarray:
    """Return the nodal diameters of the mode of each row of a column, shape (rows,); 0 for the
    slider's."""
    l = np.abs(model.shift).astype(np.int64)
    others = np.zeros(n_rows(model) - 2 * len(l), np.int64)
    return np.concatenate([l, l, others])


def energy_scale(model: Model) -> np.ndarray:
    """Return the square root of twice the energy of a unit of each row of a column, shape
    (rows,)."""
    rates = np.ones(len(model.mode_amplitude))
    rates0 = np.ones(len(model.mode_amplitude0))
    stiffness = np.where(model.stiffness > 0, model.stiffness, 1.0)
    contact = 1 / model.compliance if model.has_compliance else 0.0
    slider = [
        model.r_0 * math.sqrt(model.k_p or model.m),
        model.r_0 * math.sqrt(model.m),
        math.sqrt(model.k + contact or model.m),
        math.sqrt(model.m),
    ]
    return np.concatenate([np.sqrt(stiffness), rates, np.sqrt(model.stiffness0), rates0, slider])


def column_of(state: EngineState, model: Model) -> np.ndarray:
    """Return the entries of a state in the order of a column, shape (rows,)."""
    n_disc = n_rows(model) - SLIDER
    return np.concatenate([state.disc[:n_disc], state.x[PSI : PSI + SLIDER]])


def put_column(state: EngineState, model: Model, column: np.ndarray) -> None:
    """Set a state in stick at time 0 to a column of its entries."""
    n_disc = n_rows(model) - SLIDER
    clear(state)
    state.disc[:n_disc] = column[:n_disc]
    state.x[PSI : PSI + SLIDER] = column[n_disc:]
    state.x[PHASE] = STICK


def input_column(
    model: Model,
    scalars: Mapping[str, float],
    stiffness: tuple[np.ndarray | float, np.ndarray | float] = (0.0, 0.0),
    damping: tuple[np.ndarray | float, np.ndarray | float] = (0.0, 0.0),
) -> np.ndarray:
    """Return a change of the model's parameters as a column of ``Tangent.inputs``.

    scalars : changes by `INPUTS`
    stiffness, damping : changes of the arrays of these names in the model, of lanes and of modes
        without nodal diameter
    """
    width = len(model.mode_amplitude)
    n_single = len(model.mode_amplitude0)
    column = np.zeros(N_INPUTS + 2 * width + 2 * n_single)
    for name, value in scalars.items():
        column[INPUTS.index(name)] = value
    ends = N_INPUTS + np.cumsum([0, width, width, n_single])
    _, of_z, of_e, of_y, of_g = np.split(column, ends)
    of_z[:], of_y[:] = stiffness
    of_e[:], of_g[:] = damping
    return column


def put_input_column(tangent: Tangent, column: int, change: np.ndarray) -> None:
    """Let a column, counted from ``Tangent.plain`` on, carry a change of parameters."""
    at = tangent.plain + column
    blocks = tangent.inputs.reshape(-1, tangent.input_rows, WIDTH)
    blocks[at // WIDTH, :, at % WIDTH] = change


def block_of_columns(tangent: Tangent, block: int = 0) -> np.ndarray:
    """Return a view of a block of columns, shape (rows, `COLUMNS_AT_ONCE`)."""
    return tangent.now.reshape(-1, tangent.rows, WIDTH)[block]
