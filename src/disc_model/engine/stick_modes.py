"""The modes of stick, for the closed form of `stick_propagator`.

With f = 0, disc and slider are one linear system.  In deviations d from the static equilibrium,

    (1 + m psi psi^T) d'' + (2 xi omega + c psi psi^T) d' + (omega^2 + k psi psi^T) d = 0

for the a-components and l = 0, and without the slider for the b-components; a compliant contact
adds the coordinate u. The modes are q_i(x) = q_i(0) exp(lambda_i x).  Complex numbers are lanes of
real parts, then of imaginary parts.
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
    stick has no closed form. The two responses to friction are empty if friction does not bend the
    disc."""

    decay: np.ndarray  # Re lambda in 1 / time unit, shape (n,)
    turn: np.ndarray  # Im lambda, likewise
    gain: np.ndarray  # |dP / dq|, shape (n,)
    powers: np.ndarray  # exp(lambda QUANTUM 2^i), shape (powers * 2 * n,)
    enter: np.ndarray  # q of a unit change of each state, shape (L * 2 * n,)
    offset: np.ndarray  # q of the zero state, shape (2 * n,)
    leave: np.ndarray  # state of a unit of Re q, then of Im q, shape (2 * n * L,)
    rest: np.ndarray  # static equilibrium, shape (L,)
    friction_offset: np.ndarray  # -q of ``friction_rest``, shape (2 * 2 * n,)
    friction_rest: np.ndarray  # disc's response to T = 1 N and to T' = 1 N/s, shape (2 * L,)


class Components(NamedTuple):
    """The coordinates of stick, arrays of shape (n,): components a of the pairs, modes without
    nodal diameter, components b."""

    omega: np.ndarray  # rad/s
    damping: np.ndarray  # 2 xi omega, 1/s
    shape: np.ndarray  # amplitude under the slider, 0 for components b
    arm: np.ndarray  # of friction, 0 for all but components b


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
    slider : k, c, m and N by name
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
    numbers = map(float, (slider["k"], slider["c"], slider["m"], unit, compliance))
    modes = _under_unit_load(values, where, length, *numbers)
    return modes._replace(rest=slider["N"] * modes.rest, offset=slider["N"] * modes.offset)


@lru_cache(maxsize=256)
def _under_unit_load(values, where, length, k, c, m, unit, compliance) -> StickModes:
    """Return the modes for N = 1.

    values : those of `Components`
    where : places of displacements d, then of velocities d', in `EngineState.disc`; on a compliant
        contact the last entry of d is u
    length : of `EngineState.disc`
    """
    components = Components(*map(np.array, values))
    displacements, velocities = np.split(np.array(where), 2)
    system = _compliant_system if compliance else _rigid_system
    stiffness, damping, scale, force = system(components, k, c, m, unit, compliance)
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
    friction = _friction_response(components, displacements, velocities, length)
    unpadded = StickModes(
        decay=rates.real,
        turn=rates.imag,
        gain=2.0 * np.abs(force @ vectors),
        powers=powers,
        enter=enter,
        offset=-np.tensordot(rest, enter, 1),
        leave=leave,
        rest=rest,
        friction_offset=-np.tensordot(friction, enter, 1),
        friction_rest=friction,
    )
    return StickModes(*map(_in_lanes, unpadded))


def _rigid_system(components, k, c, m, unit, compliance):
    """Matrices of stiffness and damping over the masses, scale of displacements, and change of P
    with d and d', of stick in rigid contact; ``compliance`` is 0."""
    omega, rates, shape, _ = components
    mobility = 1.0 + m * shape @ shape
    rank_one = np.outer(shape, shape)
    inverse_mass = np.eye(len(omega)) - rank_one * (m / mobility)
    stiffness = np.diag(omega**2) + k * rank_one
    damping = np.diag(rates) + c * rank_one
    by_displacement = shape * (k - m * omega**2)
    by_velocity = shape * (c - m * rates)
    force = np.concatenate([by_displacement, by_velocity]) / mobility
    return inverse_mass @ stiffness, inverse_mass @ damping, omega * unit, force


def _compliant_system(components, k, c, m, unit, compliance):
    """As `_rigid_system`, on a compliant contact, with u as last coordinate."""
    omega, rates, shape, _ = components
    stretch = np.append(shape, -1.0)  # of the contact, w - u
    mass = np.append(np.ones(len(omega)), m)
    stiffness = np.diag(np.append(omega**2, k)) + np.outer(stretch, stretch) / compliance
    damping = np.diag(np.append(rates, c / m))
    scale = np.append(omega, np.sqrt(stiffness[-1, -1] / m)) * unit
    force = np.concatenate([shape / compliance, [-1.0 / compliance], np.zeros(len(omega) + 1)])
    return stiffness / mass[:, None], damping, scale, force


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


def _friction_response(components: Components, displacements, velocities, length) -> np.ndarray:
    """Response to friction T = 1 N, and to T' = 1 N/s, shape (2, length), or (0, length) if it does
    not bend the disc: d'' + damping d' + omega^2 d = -arm T with T'' = 0.

    displacements, velocities : places of d and d'
    """
    omega, damping, _, arm = components
    if not arm.any():
        return np.zeros((0, length))
    n = len(omega)
    give = arm / omega**2
    response = np.zeros((2, length))
    response[0, displacements[:n]] = -give
    response[1, velocities[:n]] = -give
    response[1, displacements[:n]] = give * damping / omega**2
    return response


def _in_lanes(a: np.ndarray) -> np.ndarray:
    """Flat copy, padded to whole blocks of lanes."""
    out = aligned(padded(a.size))
    out[: a.size] = a.ravel()
    return out
