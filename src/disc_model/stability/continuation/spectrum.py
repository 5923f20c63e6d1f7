"""Multipliers of a cycle with their eigenvectors, followed from one point of a branch to the
next.

A multiplier keeps its eigenvector while its angle turns.  The vector thus tells the sense in which
it turned, which the set of multipliers, symmetric about the real axis, does not.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from disc_model.arrays import Array, ComplexArray

STRONGLY_DAMPED = 0.5  # modulus below which a multiplier causes neither a resonance nor a loss


class Spectrum(NamedTuple):
    """Eigenvalues of the return map's Jacobian, (n,); right eigenvectors as columns, and left ones
    as rows with the product one, (n, n) each."""

    values: ComplexArray
    right: ComplexArray
    left: ComplexArray


class Passing(NamedTuple):
    """A resonance that is passed between two points: the sum or the difference of the angles of two
    multipliers comes to a multiple of 2 pi.

    share : of the way at which it is passed, if angles change evenly
    distance : of that sum or difference from the resonance at the nearer point, rad
    width : the sum of the distances of both moduli from one there: within it the resonance shows
    forced : whether a multiplier passes 1, where the cycle itself responds
    """

    share: float
    distance: float
    width: float
    forced: bool


def spectrum_of(jacobian: Array) -> Spectrum:
    """The spectrum of a Jacobian (n, n)."""
    values, right = np.linalg.eig(jacobian)
    right = right.astype(complex)
    try:
        left = np.linalg.inv(right)
    except np.linalg.LinAlgError:  # two multipliers with one eigenvector, as where a pair parts
        left = np.linalg.pinv(right)
    return Spectrum(values.astype(complex), right, left)


def follow_multipliers(before: Spectrum, after: Spectrum) -> NDArray[np.intp]:
    """Numbers of the multipliers `after` that continue those `before`, by their eigenvectors."""
    resemblance = np.abs(before.left @ after.right)
    return np.asarray(linear_sum_assignment(-resemblance)[1])


class Turns(NamedTuple):
    """Those multipliers of one point of modulus above `STRONGLY_DAMPED` and positive imaginary
    part, their angles, by which angle each turns up to another point, at most pi, and the distances
    of their moduli from one at both."""

    angles: Array
    turns: Array
    damping: Array
    later_damping: Array


def turns_between(before: Spectrum, after: Spectrum) -> Turns:
    """How multipliers turn between two points."""
    return turns_of(before.values, after.values[follow_multipliers(before, after)])


def turns_of(multipliers: ComplexArray, successors: ComplexArray) -> Turns:
    """How multipliers turn, each beside the one that it becomes."""
    followed = are_slow(multipliers, successors) & (multipliers.imag > 0)
    values = multipliers[followed]
    later = successors[followed]
    return Turns(
        angles=np.angle(values),
        turns=np.angle(later / values),
        damping=np.abs(1 - np.abs(values)),
        later_damping=np.abs(1 - np.abs(later)),
    )


def are_slow(multipliers: ComplexArray, successors: ComplexArray) -> NDArray[np.bool_]:
    """Whether multipliers, and those that they become, are damped so little that they may cause a
    loss of stability."""
    return np.asarray(np.minimum(np.abs(multipliers), np.abs(successors)) > STRONGLY_DAMPED)


def passings(between: Turns) -> list[Passing]:
    """The resonances that are passed between two points, in their order.

    The sum of an angle with itself comes to a multiple of 2 pi where a multiplier meets its
    conjugate, at 1 or at -1.
    """
    first, second = np.triu_indices(len(between.angles))
    different = first != second
    found = list[Passing]()
    for sign, i, j in ((1, first, second), (-1, first[different], second[different])):
        starts = (between.angles[i] + sign * between.angles[j]) / math.tau
        changes = (between.turns[i] + sign * between.turns[j]) / math.tau
        levels = np.maximum(np.floor(starts), np.floor(starts + changes))
        for k in np.flatnonzero(np.floor(starts) != np.floor(starts + changes)):
            distances = math.tau * np.abs(
                [levels[k] - starts[k], levels[k] - starts[k] - changes[k]]
            )
            at_end = int(distances[1] < distances[0])
            damping = (between.damping, between.later_damping)[at_end]
            found.append(
                Passing(
                    share=float((levels[k] - starts[k]) / changes[k]),
                    distance=float(distances[at_end]),
                    width=float(damping[i[k]] + damping[j[k]]),
                    forced=bool(i[k] == j[k] and levels[k] % 2 == 0),
                )
            )
    return sorted(found)
