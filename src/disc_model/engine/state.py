"""The state of a motion: where each number stands, and how Python reads and writes it.

A state has an array of the disc's modes and one of scalars. In the array of modes stand the
displacements of the pairs in lanes (see `model`), their velocities, then displacements and
velocities of the modes without nodal diameter. A column of `tangent` has the same order, followed
by psi, f, u and u'. All index arithmetic with these places is in this module.
"""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from .jit import inlined
from .jit.packing import packed
from .jit.simd import WIDTH, aligned
from .stick_modes import padded

HALF = WIDTH // 2

# Phases, in the order of ``disc_model.data.variables.PHASES``.
STICK, SLIP, SEPARATION = range(3)

# Places of the scalars. The first four are those of the slider, which a column has, too. PHI_RATE:
# rate g of the contact over the material, which is the slider's f but for v_s / r_0 of a moving
# surface. SLIDER: how many they are.
PSI, PHI_RATE, U, U_VELOCITY, SLIDER = range(5)
# The time is TIME + TIME_LOW, summed with compensation: event times stay exact to rounding after
# hours. DIRECTION: sign of g in slip, else 0.
TIME, TIME_LOW, PHASE, DIRECTION = range(SLIDER, SLIDER + 4)
# Multiplicities of the roots with which the phase began, of its event function and of the contact
# force.
KNOWN, KNOWN_FORCE = range(SLIDER + 4, SLIDER + 6)
# FORCE: contact force after an event. PROPAGATED: not 0 if stick has used its closed form as far as
# possible, see `step`. IN_A_ROW: number of events at this instant. DRIVE, LOAD: Omega and N now, on
# a ramp. SURFACE_TURN: angle by which the surface has turned under the slider, integral of v_s / r_0.
FORCE, PROPAGATED, IN_A_ROW, DRIVE, LOAD, SURFACE_TURN, SCALARS = range(SLIDER + 6, SLIDER + 13)


@packed()
class EngineState(NamedTuple):
    """State of the system."""

    disc: np.ndarray  # all of the disc, in whole blocks of lanes; the next four are views of it
    z: np.ndarray  # displacements of the pairs: a, b in lanes, m sqrt(kg)
    e: np.ndarray  # velocities of the pairs: alpha, beta in lanes, m/s sqrt(kg)
    y: np.ndarray  # displacements of the modes without nodal diameter
    g: np.ndarray  # their velocities
    x: np.ndarray  # scalars, at the places above
    membrane: np.ndarray  # work space of `stretching`, for one order; empty if no plate stretches


# ---- Places in the array of modes, and in columns


@inlined
def velocity_place(model, j):
    """Place of the velocity of lane j, whose displacement stands at j."""
    return len(model.mode_amplitude) + j


@inlined
def displacement0_place(model, j):
    """Place of the displacement of mode j without nodal diameter."""
    return 2 * len(model.mode_amplitude) + j


@inlined
def velocity0_place(model, j):
    """Place of the velocity of mode j without nodal diameter."""
    return 2 * len(model.mode_amplitude) + len(model.mode_amplitude0) + j


@inlined
def slider_place(model, scalar):
    """Place, in a column, of one of the scalars ``PSI`` to ``U_VELOCITY``: behind the disc's."""
    return 2 * len(model.mode_amplitude) + 2 * len(model.mode_amplitude0) + scalar


@inlined
def other_lane(j):
    """Lane of the other component of the pair whose a or b is in lane j."""
    return j + HALF if j % WIDTH < HALF else j - HALF


def pair_lanes(n_pairs: int) -> np.ndarray:
    """Return the lane of the a-component of each pair, shape (n_pairs,); b follows ``HALF`` lanes
    later."""
    pair = np.arange(n_pairs)
    return WIDTH * (pair // HALF) + pair % HALF


def lanes_for(n_pairs: int) -> int:
    """Return the number of lanes for so many pairs, in whole blocks, at least one."""
    return WIDTH * max(1, -(-n_pairs // HALF))


def disc_size(width: int, n_single: int, compliant: bool) -> int:
    """Return the length of ``EngineState.disc``. On a compliant contact u, u' are stored at its end, for the
    closed form of stick."""
    slider = 2 if compliant else 0
    return padded(2 * (width + n_single) + slider)


def views_of_disc(width: int, n_single: int, compliant: bool, membrane: int = 0) -> EngineState:
    """Return a state of zeros, for so many lanes and modes without nodal diameter; membrane: length
    of its work space."""
    disc = aligned(disc_size(width, n_single, compliant))
    ends = np.cumsum([width, width, n_single, n_single])
    z, e, y, g, _ = np.split(disc, ends)
    return EngineState(disc, z, e, y, g, np.zeros(SCALARS), aligned(membrane))


# ---- What Python reads and writes

_PLACES = {
    "time": TIME,
    "time_low": TIME_LOW,
    "psi": PSI,
    "g": PHI_RATE,
    "u": U,
    "u_velocity": U_VELOCITY,
    "surface_turn": SURFACE_TURN,
}
SCALAR_NAMES = tuple(_PLACES)


def scalars_of(state: EngineState) -> dict[str, float]:
    """Return the scalars of a motion by `SCALAR_NAMES`, in SI units: time (s), what was lost of it
    by rounding, psi (rad), g (rad/s), u (m), u' (m/s), and the surface's turn (rad)."""
    numbers = state.x.tolist()  # at once, which is faster than one by one
    return {name: numbers[place] for name, place in _PLACES.items()}


def put_scalars(state: EngineState, values: Iterable[float]) -> None:
    """Set the scalars of a motion, in the order of `SCALAR_NAMES`."""
    state.x[[*_PLACES.values()]] = list(values)


def time_of(state: EngineState) -> float:
    """Return the time, s, but for what rounding has lost of it."""
    return float(state.x[TIME])


def phase_of(state: EngineState) -> int:
    """Return the phase: STICK, SLIP or SEPARATION."""
    return int(state.x[PHASE])


def direction_of(state: EngineState) -> int:
    """Return the sign of g in slip, else 0."""
    return int(state.x[DIRECTION])


def known_roots(state: EngineState) -> tuple[int, int]:
    """Return the multiplicities of the roots with which the phase began at this instant, of its
    event function and of the contact force."""
    return int(state.x[KNOWN]), int(state.x[KNOWN_FORCE])


def put_phase(
    state: EngineState, phase: int, direction: int, known: tuple[int, int] = (0, 0)
) -> None:
    """Set phase, direction and `known_roots`."""
    state.x[PHASE] = phase
    state.x[DIRECTION] = direction
    state.x[KNOWN], state.x[KNOWN_FORCE] = known


def clear(state: EngineState) -> None:
    """Set all numbers to zero: stick on an unloaded disc at time 0."""
    state.disc.fill(0.0)
    state.x.fill(0.0)


def copy_state(source: EngineState, target: EngineState) -> None:
    """Copy all numbers of a state to another one of the same case."""
    target.disc[:] = source.disc
    target.x[:] = source.x


def set_time_low(state: EngineState, value: float) -> None:
    """Set what rounding has lost of the time, s."""
    state.x[TIME_LOW] = value


def clear_switch(state: EngineState) -> None:
    """Forget that the last step was one of no duration."""
    state.x[PROPAGATED] = 0.0
    state.x[IN_A_ROW] = 0.0


def mode_places(diameters: np.ndarray) -> np.ndarray:
    """Return the places of a, b, alpha and beta in ``EngineState.disc``, shape (4, n_modes); -1 for
    b and beta of modes without nodal diameter."""
    pairs = np.flatnonzero(diameters > 0)
    single = np.flatnonzero(diameters == 0)
    lane = pair_lanes(len(pairs))
    width = lanes_for(len(pairs))
    places = np.full((4, len(diameters)), -1)
    places[0, pairs] = lane
    places[1, pairs] = lane + HALF
    places[2, pairs] = width + lane
    places[3, pairs] = width + lane + HALF
    places[0, single] = 2 * width + np.arange(len(single))
    places[2, single] = 2 * width + len(single) + np.arange(len(single))
    return places
