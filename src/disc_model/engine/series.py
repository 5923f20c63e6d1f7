"""Taylor coefficients of one step: where they stand, and how they are read and written.

Coefficient k multiplies (time / unit)**k, so that none overflows, however stiff the disc is. Those
of the pairs stand as [block of lanes][row][lane], all others as [quantity][order].
"""

from typing import NamedTuple

import numpy as np

from .jit import inlined
from .jit.packing import Part, packed
from .jit.simd import WIDTH, aligned, load, store
from .model import ROWS, Model, drive_now, load_now, work_space
from .state import PHI_RATE, PSI, SURFACE_TURN, U_VELOCITY, U
from .stick_modes import padded

# Rows of ``Series.modes``: displacements and velocities of each order in turn, then what one order
# of the recurrence hands to the next (see `modes`): inner terms of a pair of orders, the sum s_k,
# and the three rows of constants of the step.
(
    INNER_VELOCITY,
    INNER_DISPLACEMENT,
    CARRIED,
    BY_VELOCITY,
    BY_DISPLACEMENT,
    ALONG_BY_VELOCITY,
    _N_ROWS,
) = range(2 * ROWS, 2 * ROWS + 7)
ORDER = 2 * WIDTH  # places from a coefficient of a pair to that of the next order

_QUANTITIES = (
    "psi", "f", "u", "v", "P", "switch", "switch2", "powers", "up", "down",
    "slope", "drive", "preload", "friction", "coefficient", "share", "lever", "weakening", "sensitivity",
    "V", "slider", "turn", "hold",
)  # fmt: skip
_PLACES = {name: Part("quantities", ROWS * i, ROWS) for i, name in enumerate(_QUANTITIES)}
_ROOT_ROWS = 7 * WIDTH


@packed(_PLACES)
class Series(NamedTuple):
    """Series of one step, and the tables and work space of its recurrences."""

    modes: np.ndarray  # pairs, as [block][row][lane]
    y: np.ndarray  # displacements of the modes without nodal diameter
    g: np.ndarray  # their velocities
    quantities: (
        np.ndarray
    )  # what has a coefficient an order: those from psi to hold are parts of it
    psi: np.ndarray
    f: np.ndarray  # rate of the contact over the material, g
    u: np.ndarray  # of the slider
    v: np.ndarray  # u'
    P: np.ndarray  # contact force; R under the normal force in slip, V in stick
    switch: (
        np.ndarray
    )  # direction * f in slip, gap in separation, forward release function in stick
    switch2: np.ndarray  # the backward release function
    powers: np.ndarray  # of the place that was looked at last, in time units
    up: np.ndarray  # unit / (k + 1), which integrates
    down: np.ndarray  # (k + 1) / unit, which differentiates
    slope: np.ndarray  # B / r_0 under the normal force
    drive: np.ndarray  # Omega, in which only orders 0 and 1 are not zero
    preload: np.ndarray  # N - k u_0, likewise
    friction: np.ndarray  # T where friction depends on the speed
    coefficient: np.ndarray  # of that friction
    share: np.ndarray  # phi, by which it has not fallen yet
    lever: np.ndarray  # of phi in its recurrence
    weakening: np.ndarray  # change of T with f by phi
    sensitivity: np.ndarray  # change of T with f
    V: np.ndarray  # vertical force of a compliant contact
    slider: np.ndarray  # its own rate where the surface on which friction acts moves
    turn: np.ndarray  # integral of v_s / r_0, likewise; 0 if that does not move
    hold: np.ndarray  # H in stick, likewise
    roots: np.ndarray  # work space of `roots.first_root`
    amplitudes: (
        np.ndarray
    )  # of the modes of stick: real, imaginary parts; then those at a later time
    membrane: np.ndarray  # work space of `stretching`


def build_series(model: Model, order: int) -> Series:
    """Return empty series of degree ``order`` for a model."""
    width = len(model.shift)
    n_single = len(model.mode_amplitude0)
    quantities = aligned(len(_QUANTITIES) * ROWS)
    rows = dict(zip(_QUANTITIES, quantities.reshape(-1, ROWS), strict=True))
    counts = np.arange(1.0, ROWS + 1.0)
    rows["up"][:] = model.unit / counts
    rows["down"][:] = counts / model.unit
    modes = aligned(_N_ROWS * width)
    return Series(
        modes=modes,
        y=aligned(ROWS * n_single),
        g=aligned(ROWS * n_single),
        roots=aligned(_ROOT_ROWS * (padded(order + 1) + WIDTH)).reshape(_ROOT_ROWS, -1),
        amplitudes=aligned(4 * len(model.modes.gain)),
        membrane=aligned(work_space(model, ROWS)),
        quantities=quantities,
        **rows,
    )


@inlined
def load_state(model, series, state):
    """Set the coefficients 0 to a state."""
    x = state.x
    for b in range(0, len(state.z), WIDTH):
        put_displacement(series, 0, b, load(state.z, b))
        put_velocity(series, 0, b, load(state.e, b))
    for j in range(len(state.y)):
        series.y[j * ROWS] = state.y[j]
        series.g[j * ROWS] = state.g[j]
    series.psi[0] = x[PSI]
    series.f[0] = x[PHI_RATE]
    series.turn[0] = x[SURFACE_TURN]
    series.u[0] = x[U]
    series.v[0] = x[U_VELOCITY]
    series.drive[0] = drive_now(model, state)
    series.preload[0] = load_now(model, state) - model.k * model.u_0
    series.drive[1] = model.Omega_rate * model.unit
    series.preload[1] = model.N_rate * model.unit


@inlined
def load_at_start(model, series):
    """Return N at the start of the step."""
    return series.preload[0] + model.k * model.u_0 if model.has_ramp else model.N


# ---- Coefficients of the pairs: blocks that begin at lane b, or those of lane j


@inlined
def displacement_at(k, b):
    """Return where the displacements of order k stand in ``Series.modes``; velocities follow
    ``WIDTH`` places later."""
    return b * _N_ROWS + k * ORDER


@inlined
def velocity_at(k, b):
    """Return where the velocities of order k stand in ``Series.modes``."""
    return displacement_at(k, b) + WIDTH


@inlined
def displacement_of_lane(k, j):
    """Return where the displacement of order k in lane j stands in ``Series.modes``; the velocity
    follows ``WIDTH`` places later."""
    lane = j % WIDTH
    return displacement_at(k, j - lane) + lane


@inlined
def displacement(series, k, b):
    """Return the displacements of order k."""
    return load(series.modes, displacement_at(k, b))


@inlined
def put_displacement(series, k, b, value):
    """Set the displacements of order k."""
    store(series.modes, displacement_at(k, b), value)


@inlined
def velocity(series, k, b):
    """Return the velocities of order k."""
    return load(series.modes, velocity_at(k, b))


@inlined
def put_velocity(series, k, b, value):
    """Set the velocities of order k."""
    store(series.modes, velocity_at(k, b), value)


@inlined
def handed_on(series, row, b):
    """Return a row of what one order of the recurrence hands to the next."""
    return load(series.modes, b * _N_ROWS + row * WIDTH)


@inlined
def hand_on(series, row, b, value):
    """Set a row of what one order of the recurrence hands to the next."""
    store(series.modes, b * _N_ROWS + row * WIDTH, value)
