"""The modes of stick, for the closed form of ``dense_output``.

With f = 0, disc and slider are one linear system.  In deviations d from the static equilibrium,

    (1 + m psi psi^T) d'' + (2 xi omega + c psi psi^T) d' + (omega^2 + k psi psi^T) d = 0

for the a-components and l = 0, and without the slider for the b-components; a compliant contact
adds the coordinate u. The modes are q_i(x) = q_i(0) exp(lambda_i x).  Complex numbers are lanes of
real parts, then of imaginary parts.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from .jit.packing import packed
from .jit.simd import WIDTH, aligned

# exp(lambda x) is the product of POWERS tabled powers of exp(lambda QUANTUM) and of a series of
# degree DEGREE for the rest; with abs(lambda) < LARGEST_RATE the series is good to 1e-17.
# LONGEST_STICK bounds the table (2**POWERS quanta exceed it), and the samples that fall into one
# advance in closed form.  (Time units.)
QUANTUM, LONGEST_STICK, LARGEST_RATE = 0.25, 512.0, 1.5
DEGREE, POWERS = 12, 12
MOST_MODES = 64  # the matrices are dense: with more modes the series are as fast
WORST_CONDITION = (
    100.0  # nearly parallel eigenvectors (modes near critical damping) would lose digits
)


@packed
class StickModes(NamedTuple):
    """n modes, padded with zeros to whole blocks of lanes; L = len(State.disc).  Empty if stick has
    no closed form."""

    decay: np.ndarray  # Re lambda in 1 / time unit, shape (n,)
    turn: np.ndarray  # Im lambda, likewise
    gain: np.ndarray  # |dP / dq|, shape (n,)
    powers: np.ndarray  # exp(lambda QUANTUM 2^i), shape (powers * 2 * n,)
    enter: np.ndarray  # q of a unit change of each state, shape (L * 2 * n,)
    offset: np.ndarray  # q of the zero state, shape (2 * n,)
    leave: np.ndarray  # state of a unit change of the real parts, then of the imaginary parts of q, shape (2 * n * L,)
    rest: np.ndarray  # static equilibrium, shape (L,)
    friction_offset: (
        np.ndarray
    )  # q of minus the response to T = 1 N, and to T' = 1 N/s, shape (2 * 2 * n,)
    friction_rest: (
        np.ndarray
    )  # that response of the disc, shape (2 * L,); both are empty without the couple


def padded(n: int) -> int:
    """n rounded up to whole blocks of lanes."""
    return -(-n // WIDTH) * WIDTH


def no_modes() -> StickModes:
    return StickModes(*(np.zeros(0) for _ in StickModes._fields))


def _decomposed(stiffness, damping, scale, unit):
    """Modes of d'' = -stiffness d - damping d', both matrices over the masses: lambda (n,) in 1 /
    ``unit``, V (2n, n) and W (n, 2n) of (d, d') = 2 Re V q, q = W (d, d').  ``scale`` of
    displacements gives both halves of an eigenvector similar size.  None if a mode does not
    oscillate, is too fast for the series, or nearly parallel to another."""
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
    rates, vectors = rates[up], vectors[:, up]
    both = np.hstack([vectors, vectors.conj()])
    if np.linalg.cond(both) > WORST_CONDITION:
        return None
    decay = np.where(rates.real > -1e-15, 0.0, rates.real)
    back = np.concatenate(
        [scale, np.full(n, unit)]
    )  # to displacements and to velocities per second
    return decay + 1j * rates.imag, vectors / back[:, None], np.linalg.inv(both)[:n] * back


def build_stick_modes(components, places, slider, *, u, length, unit, compliance) -> StickModes:
    """Modes of stick for the model of `layout.build_model`. components: omega, damping, shape, arm
    of friction of the components a, modes without nodal diameter, components b, the shape being 0
    for the last, the arm for the others; places: shape (2, n), of their displacements and
    velocities in `EngineState.disc`, whose ``length`` is given; u: index of u there, followed by
    u', where contact is compliant."""
    omega, n = components[0], len(components[0])
    if not (n or compliance) or n > MOST_MODES or not (omega > 0.0).all():
        return no_modes()
    if compliance:
        places = np.hstack([places, [[u], [u + 1]]])
    arrays = tuple(tuple(a.tolist()) for a in (*components, places.ravel()))
    numbers = map(float, (slider["k"], slider["c"], slider["m"], unit, compliance))
    modes = _under_unit_load(arrays, length, *numbers)
    return modes._replace(rest=slider["N"] * modes.rest, offset=slider["N"] * modes.offset)


@lru_cache(maxsize=256)
def _under_unit_load(arrays, length, k, c, m, unit, compliance) -> StickModes:
    """`StickModes` for N = 1, shared by many cases. ``arrays``: omega, damping, shape and arm of
    `build_stick_modes`, and the indices of (d, d') in `EngineState.disc`; on a compliant contact
    the last entry of d is u."""
    omega, damping, shape, arm, where = map(np.array, arrays)
    rest = aligned(length)
    rest[where[: len(omega)]] = -shape / omega**2
    # the matrices over the masses; dP of a unit change of each displacement and velocity
    if compliance:
        rest[where[len(omega)]] = -(np.sum((shape / omega) ** 2) + compliance)
        stretch, mass = np.append(shape, -1.0), np.append(np.ones(len(omega)), m)
        stiffness = np.diag(np.append(omega**2, k)) + np.outer(stretch, stretch) / compliance
        scale = np.append(omega, np.sqrt(stiffness[-1, -1] / m)) * unit
        modes = _decomposed(
            stiffness / mass[:, None], np.diag(np.append(damping, c / m)), scale, unit
        )
        force = np.concatenate([shape / compliance, [-1.0 / compliance], np.zeros(len(omega) + 1)])
    else:
        rank_one = np.outer(shape, shape)
        inverse = np.eye(len(omega)) - rank_one * (m / (1.0 + m * shape @ shape))
        stiffness = np.diag(omega**2) + k * rank_one
        modes = _decomposed(
            inverse @ stiffness, inverse @ (np.diag(damping) + c * rank_one), omega * unit, unit
        )
        force = np.concatenate([shape * (k - m * omega**2), shape * (c - m * damping)]) / (
            1.0 + m * shape @ shape
        )
    if modes is None:
        return no_modes()
    # d'' + damping d' + omega^2 d = -arm T with T'' = 0
    friction = np.zeros((2, length) if arm.any() else (0, length))
    if len(friction):
        give, count = arm / omega**2, len(where) // 2
        friction[0, where[: len(omega)]] = friction[1, where[count:][: len(omega)]] = -give
        friction[1, where[: len(omega)]] = give * damping / omega**2
    rates, vectors, to_modes = modes
    n = len(rates)
    enter = np.zeros((length, 2, padded(n)))
    enter[where, 0, :n], enter[where, 1, :n] = to_modes.real.T, to_modes.imag.T
    leave = np.zeros((2, padded(n), length))
    leave[0][:n, where], leave[1][:n, where] = 2.0 * vectors.real.T, -2.0 * vectors.imag.T
    powers = np.zeros((POWERS, 2, padded(n)))
    tabled = np.exp(np.outer(QUANTUM * 2.0 ** np.arange(POWERS), rates))
    powers[:, 0, :n], powers[:, 1, :n] = tabled.real, tabled.imag
    unpadded = StickModes(
        decay=rates.real, turn=rates.imag, gain=2.0 * np.abs(force @ vectors), powers=powers,
        enter=enter, offset=-np.tensordot(rest, enter, 1), leave=leave, rest=rest,
        friction_offset=-np.tensordot(friction, enter, 1), friction_rest=friction,
    )  # fmt: skip
    return StickModes(*map(_in_lanes, unpadded))


def _in_lanes(a: np.ndarray) -> np.ndarray:
    """Flat copy, padded to whole blocks of lanes."""
    out = aligned(padded(a.size))
    out[: a.size] = a.ravel()
    return out
