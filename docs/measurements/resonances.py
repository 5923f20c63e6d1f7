"""Modes in frequency responses measured at places on a rim, and errors of their shapes."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

SEPARATION = 4.0
"""Distance from a peak at which the search for two modes begins, Hz."""
DAMPING = 0.005
"""Damping ratio with which the search begins."""


class Resonances(NamedTuple):
    """Modes found in a band.

    Parameters
    ----------
    frequency : natural frequencies, Hz
    damping : damping ratios
    rest : root mean square of what the modes leave of the response, over that of the response
    """

    frequency: NDArray[np.float64]
    damping: NDArray[np.float64]
    rest: float

    def of(self, mode: int) -> tuple[float, float]:
        """Return frequency (Hz) and damping ratio of a mode."""
        return float(self.frequency[mode]), float(self.damping[mode])


def resonances(frequency: np.ndarray, response: np.ndarray, modes: int) -> Resonances:
    """Fit one mode or two to responses at all places, in a band around a peak.

    Each place has its own complex residue of each mode, and a constant for all others; a mode has
    one frequency and one damping ratio.

    Parameters
    ----------
    frequency : Hz, an array of the band
    response : accelerations over force, complex, frequency by place
    modes : 1 or 2
    """

    def deviation(x: np.ndarray) -> np.ndarray:
        shapes = _functions(frequency, x[:modes], x[modes:])
        parts, *_ = np.linalg.lstsq(shapes, response, rcond=None)
        rest = (shapes @ parts - response).ravel()
        return np.concatenate([rest.real, rest.imag])

    peak = frequency[np.abs(response).sum(axis=1).argmax()]
    start = [peak] if modes == 1 else [peak - SEPARATION, peak + SEPARATION]
    dampings = [DAMPING] * modes
    scale = [1.0] * modes + [1e-3] * modes
    search = least_squares(deviation, start + dampings, x_scale=scale)
    rest = np.sqrt(np.sum(search.fun**2) / np.sum(np.abs(response) ** 2))
    order = np.argsort(search.x[:modes])
    return Resonances(search.x[:modes][order], search.x[modes:][order], float(rest))


def residues(found: Resonances, frequency: np.ndarray, response: np.ndarray) -> np.ndarray:
    """Return the complex residues of modes, mode by place."""
    shapes = _functions(frequency, found.frequency, found.damping)
    parts, *_ = np.linalg.lstsq(shapes, response, rcond=None)
    return np.asarray(parts[: found.frequency.size])


def _functions(frequency: np.ndarray, natural: np.ndarray, damping: np.ndarray) -> np.ndarray:
    """Return the response of each mode over frequency, and a constant."""
    omega = 2 * np.pi * frequency
    columns = []
    for own, ratio in zip(2 * np.pi * natural, damping, strict=True):
        columns.append(-(omega**2) / (own**2 - omega**2 + 2j * ratio * own * omega))
    columns.append(np.ones_like(columns[0]))
    return np.stack(columns, axis=1)


def harmonic(diameters: int, angles: np.ndarray) -> np.ndarray:
    """Return the model's shape on a circle at angles (rad) from the hammer: 1 under it."""
    return np.cos(diameters * angles)


def shape_error(amplitudes: np.ndarray, shape: np.ndarray) -> float:
    """Return the root mean square difference of amplitudes from a shape.

    The first place, under the hammer, sets the scale of both and is left out.
    """
    return float(np.sqrt(np.mean(np.abs(amplitudes[1:] - shape[1:]) ** 2)))
