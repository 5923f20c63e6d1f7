"""The modes of stick, for the closed form of `stick_propagator`.

In stick, disc and slider are one linear system.  In deviations d from the static equilibrium,

    (1 + m psi psi^T) d'' + (2 xi omega + c psi psi^T) d' + (omega^2 + k psi psi^T) d = 0

for the a-components and l = 0; a compliant contact adds the coordinate u. The b-components,

    (1 + m t t^T) d'' + (2 xi omega + c_p t t^T) d' + (omega^2 + k_p t t^T) d = t Q,

carry the slider along if they move the surface, t being their amplitudes there. Q is the pull of
the spring and the damper in the plane as if the surface rested, and grows steadily with the drive.
The modes are q_i(x) = q_i(0) exp(lambda_i x).  Complex numbers are lanes of real parts, then of
imaginary parts.
"""

from collections.abc import Mapping
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from .jit.packing import packed
from .jit.simd import WIDTH, aligned

# exp(lambda x) is the product of POWERS tabled powers of exp(lambda QUANTUM) and of a series of
# degree DEGREE for the rest; with abs(lambda) < LARGEST_RATE the series is good to 1e-17.
# LONGEST_STICK bounds the table (2**POWERS quanta exceed it), and the samples that fall into one
# advance in closed form.  (Time units.)
QUANTUM = 0.25
LONGEST_STICK = 512.0
LARGEST_RATE = 1.5
DEGREE = 12
POWERS = 12
# The matrices are dense: with more modes the series are as fast.
MOST_MODES = 64
# Condition of the eigenvectors: nearly parallel ones (modes near critical damping) lose digits.
WORST_CONDITION = 100.0


@packed()
class StickModes(NamedTuple):
    """n modes, padded with zeros to whole blocks of lanes; L = len(EngineState.disc). Empty if
    stick has no closed form. Those of Q and H are empty if the surface does not move."""

    decay: np.ndarray  # Re lambda in 1 / time unit, shape (n,)
    turn: np.ndarray  # Im lambda, likewise
    gain: np.ndarray  # |dP / dq|, shape (n,)
    powers: np.ndarray  # exp(lambda QUANTUM 2^i), shape (powers * 2 * n,)
    enter: np.ndarray  # q of a unit change of each state, shape (L * 2 * n,)
    offset: np.ndarray  # q of the zero state, shape (2 * n,)
    leave: np.ndarray  # state of a unit of Re q, then of Im q, shape (2 * n * L,)
    rest: np.ndarray  # static equilibrium, shape (L,)
    pull_offset: np.ndarray  # -q of ``pull_rest``, shape (2 * 2 * n,)
    pull_rest: np.ndarray  # disc's response to Q = 1 N and to Q' = 1 N/s, shape (2 * L,)
    hold: np.ndarray  # H in these responses, but for vibration, shape (2,)
    hold_gain: np.ndarray  # |dH / dq|, shape (n,)


class Components(NamedTuple):
    """The coordinates of stick, arrays of shape (n,): components a of the pairs, modes without
    nodal diameter, components b."""

    omega: np.ndarray  # rad/s
    damping: np.ndarray  # 2 xi omega, 1/s
    shape: np.ndarray  # amplitude under the slider, 0 for components b
    tangential: np.ndarray  # amplitude of the surface, 0 for all but components b


class Springs(NamedTuple):
    """What the slider adds to the disc; k_p and c_p are 0 if the surface does not move."""

    k: float  # N/m
    c: float  # N s/m
    k_p: float  # N/m
    c_p: float  # N s/m
    m: float  # kg


def padded(n: int) -> int:
    """Return n rounded up to whole blocks of lanes."""
    return -(-n // WIDTH) * WIDTH


def no_modes() -> StickModes:
    """Return the modes of stick that has no closed form."""
    return StickModes(*(np.zeros(0) for _ in StickModes._fields))


def build_stick_modes(
    components: Components,
    places: np.ndarray,
    slider: Mapping[str, float],
    *,
    u: int,
    length: int,
    unit: float,
    compliance: float,
) -> StickModes:
    """Return the modes of stick.

    places : shape (2, n), of displacements and velocities in `EngineState.disc`
    slider : k, c, k_p, c_p, m and N by name
    u : place of u there, followed by u', where contact is compliant
    length : of `EngineState.disc`
    unit : of time, s
    compliance : of the contact, m/N, 0 if rigid
    """
    n = len(components.omega)
    exists = n > 0 or compliance > 0.0
    if not exists or n > MOST_MODES or not (components.omega > 0.0).all():
        return no_modes()
    if compliance:
        places = np.hstack([places, [[u], [u + 1]]])
    # tuples, by which cases that differ in Omega and N share modes
    values = tuple(tuple(component.tolist()) for component in components)
    where = tuple(places.ravel().tolist())
    moves = components.tangential.any()
    in_plane = (slider["k_p"], slider["c_p"]) if moves else (0.0, 0.0)
    springs = Springs(slider["k"], slider["c"], *in_plane, slider["m"])
    modes = _under_unit_load(values, where, length, springs, unit, compliance)
    return modes._replace(rest=slider["N"] * modes.rest, offset=slider["N"] * modes.offset)


@lru_cache(maxsize=256)
def _under_unit_load(values, where, length, slider, unit, compliance) -> StickModes:
    """Return the modes for N = 1.

    values : those of `Components`
    where : places of displacements d, then of velocities d', in `EngineState.disc`; on a compliant
        contact the last entry of d is u
    length : of `EngineState.disc`
    slider : `Springs`
    """
    components = Components(*map(np.array, values))
    displacements, velocities = np.split(np.array(where), 2)
    system = _compliant_system if compliance else _rigid_system
    stiffness, damping, scale, force = system(components, slider, unit, compliance)
    modes = _decomposed(stiffness, damping, scale, unit)
    if modes is None:
        return no_modes()
    rates, vectors, to_modes = modes

    # the state of amplitudes q, and back
    n = len(rates)
    both = np.concatenate([displacements, velocities])
    enter = np.zeros((length, 2, padded(n)))
    enter[both, 0, :n] = to_modes.real.T
    enter[both, 1, :n] = to_modes.imag.T
    leave = np.zeros((2, padded(n), length))
    leave[0][:n, both] = 2.0 * vectors.real.T
    leave[1][:n, both] = -2.0 * vectors.imag.T

    # the table of powers of exp(lambda QUANTUM)
    powers = np.zeros((POWERS, 2, padded(n)))
    tabled = np.exp(np.outer(QUANTUM * 2.0 ** np.arange(POWERS), rates))
    powers[:, 0, :n] = tabled.real
    powers[:, 1, :n] = tabled.imag

    rest = _static_rest(components, displacements, length, compliance)
    moves = components.tangential.any()
    pull, hold = _pull_response(components, slider, displacements, velocities, length)
    hold_force = _hold_force(components, slider, len(displacements))
    unpadded = StickModes(
        decay=rates.real,
        turn=rates.imag,
        gain=2.0 * np.abs(force @ vectors),
        powers=powers,
        enter=enter,
        offset=-np.tensordot(rest, enter, 1),
        leave=leave,
        rest=rest,
        pull_offset=-np.tensordot(pull, enter, 1) if moves else np.zeros(0),
        pull_rest=pull if moves else np.zeros(0),
        hold=hold if moves else np.zeros(0),
        hold_gain=2.0 * np.abs(hold_force @ vectors) if moves else np.zeros(0),
    )
    return StickModes(*map(_in_lanes, unpadded))


def _rigid_system(components, slider, unit, compliance):
    """Matrices of stiffness and damping over the masses, scale of displacements, and change of P
    with d and d', of stick in rigid contact; ``compliance`` is 0."""
    omega, rates, shape, _ = components
    k, c, _, _, m = slider
    mobility = 1.0 + m * shape @ shape
    rank_one = np.outer(shape, shape)
    inverse_mass, stiffness, damping = _disc_in_plane(components, slider)
    inverse_mass -= rank_one * (m / mobility)
    stiffness += k * rank_one
    damping += c * rank_one
    by_displacement = shape * (k - m * omega**2)
    by_velocity = shape * (c - m * rates)
    force = np.concatenate([by_displacement, by_velocity]) / mobility
    return inverse_mass @ stiffness, inverse_mass @ damping, omega * unit, force


def _disc_in_plane(components, slider):
    """Inverse matrix of mass, and matrices of stiffness and damping, of the disc with the slider in
    the plane."""
    omega, rates, _, tangential = components
    rank_one = np.outer(tangential, tangential)
    mobility = 1.0 + slider.m * tangential @ tangential
    inverse_mass = np.eye(len(omega)) - rank_one * (slider.m / mobility)
    stiffness = np.diag(omega**2) + slider.k_p * rank_one
    return inverse_mass, stiffness, np.diag(rates) + slider.c_p * rank_one


def _hold_force(components, slider, n):
    """Change of H in stick with the n coordinates d and their d', shape (2 n,)."""
    omega, rates, _, tangential = components
    _, _, k_p, c_p, m = slider
    mobility = 1.0 + m * tangential @ tangential
    force = np.zeros((2, n))
    force[0, : len(omega)] = tangential * (m * omega**2 - k_p)
    force[1, : len(omega)] = tangential * (m * rates - c_p)
    return force.ravel() / mobility


def _compliant_system(components, slider, unit, compliance):
    """As `_rigid_system`, on a compliant contact, with u as last coordinate."""
    omega, _, shape, _ = components
    k, c, _, _, m = slider
    n = len(omega)
    stretch = np.append(shape, -1.0)  # of the contact, w - u
    inverse_mass, disc_stiffness, disc_damping = _disc_in_plane(components, slider)
    stiffness = np.diag(np.append(np.zeros(n), k))
    stiffness[:n, :n] = disc_stiffness
    stiffness += np.outer(stretch, stretch) / compliance
    damping = np.zeros((n + 1, n + 1))
    damping[:n, :n] = inverse_mass @ disc_damping
    damping[-1, -1] = c / m
    scale = np.append(omega, np.sqrt(stiffness[-1, -1] / m)) * unit
    force = np.concatenate([shape / compliance, [-1.0 / compliance], np.zeros(len(omega) + 1)])
    stiffness[:n] = inverse_mass @ stiffness[:n]
    stiffness[-1] /= m
    return stiffness, damping, scale, force


def _decomposed(stiffness, damping, scale, unit):
    """Return the modes of d'' = -stiffness d - damping d', both matrices over the masses: lambda
    (n,) in 1 / ``unit``, V (2n, n) and W (n, 2n) of (d, d') = 2 Re V q, q = W (d, d').

    ``scale`` of displacements gives both halves of an eigenvector similar size. None if a mode does
    not oscillate, is too fast for the series, or nearly parallel to another.
    """
    n = len(scale)
    A = np.zeros((2 * n, 2 * n))
    A[:n, n:] = np.diag(scale)
    A[n:, :n] = -stiffness * (unit**2 / scale)
    A[n:, n:] = -damping * unit
    if not np.isfinite(A).all():
        return None
    rates, vectors = np.linalg.eig(A)
    up = np.flatnonzero(rates.imag > 0.0)
    if len(up) != n or (rates.real > 1e-12).any() or np.abs(rates).max() > LARGEST_RATE:
        return None
    rates = rates[up]
    vectors = vectors[:, up]
    both = np.hstack([vectors, vectors.conj()])
    if np.linalg.cond(both) > WORST_CONDITION:
        return None
    decay = np.where(rates.real > -1e-15, 0.0, rates.real)
    # back to displacements, and to velocities per second
    back = np.concatenate([scale, np.full(n, unit)])
    return decay + 1j * rates.imag, vectors / back[:, None], np.linalg.inv(both)[:n] * back


def _static_rest(components: Components, displacements, length, compliance) -> np.ndarray:
    """Static equilibrium under N = 1, shape (length,); displacements: places of d."""
    omega, _, shape, _ = components
    rest = aligned(length)
    rest[displacements[: len(omega)]] = -shape / omega**2
    if compliance:
        rest[displacements[-1]] = -(np.sum((shape / omega) ** 2) + compliance)
    return rest


def _pull_response(components: Components, slider, displacements, velocities, length):
    """Response to the pull Q = 1 N, and to Q' = 1 N/s, of the disc in stick but for vibration, shape
    (2, length), and H in it, shape (2,).

    displacements, velocities : places of d and d'
    """
    omega, _, _, tangential = components
    n = len(omega)
    _, stiffness, damping = _disc_in_plane(components, slider)
    by_pull = np.linalg.solve(stiffness, tangential)
    by_rate = -np.linalg.solve(stiffness, damping @ by_pull)
    response = np.zeros((2, length))
    response[0, displacements[:n]] = by_pull
    response[1, velocities[:n]] = by_pull
    response[1, displacements[:n]] = by_rate
    steady = tangential @ by_pull
    hold = [1.0 - slider.k_p * steady, -slider.k_p * tangential @ by_rate - slider.c_p * steady]
    return response, np.array(hold)


def _in_lanes(a: np.ndarray) -> np.ndarray:
    """Flat copy, padded to whole blocks of lanes."""
    out = aligned(padded(a.size))
    out[: a.size] = a.ravel()
    return out
