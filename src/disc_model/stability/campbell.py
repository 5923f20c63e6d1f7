"""Frequencies of steady sliding, and the corresponding frequencies of the stick-slip cycle's multipliers.

A multiplier's angle gives a frequency modulo that of the cycle, f = (angle / 2 pi + n) / T. Its sign is undetermined,
because multipliers come in conjugate pairs.  One assignment matches all multipliers to the modes of sliding by the
modal assurance criterion. Of two conjugates, the one that resembles the mode of positive frequency counts. The whole
number n brings f nearest to the frequency of the mode.
"""

import math
from dataclasses import dataclass

import numpy as np

from disc_model.data.variables import CycleStatus
from disc_model.disc.plate import mode_arrays
from disc_model.engine.jit.cache import compiling
from disc_model.parameters import Parameters
from disc_model.simulation.states import State
from disc_model.stability.cycle import FloquetResult, floquet
from disc_model.stability.return_map import Array, ComplexArray, ReturnMap
from disc_model.stability.sliding import SlidingModes, sliding_modes, split_rows


@dataclass(frozen=True, eq=False)
class Frequencies:
    """Modes of steady sliding, by ascending frequency in the slider's frame, and the multipliers that match them.

    Attributes
    ----------
    cycle : the stick-slip cycle of the case
    modes : of steady sliding, by ascending frequency
    cycle_frequency, cycle_growth_rate : Hz, 1/s, (n,), of the multipliers matched to each mode, the larger growth rate
        of two; nan without a cycle, and for the slider's in-plane motion, which stick resets
    mac : (n,), modal assurance criterion between the shapes of the mode and of its multiplier
    """

    cycle: FloquetResult
    modes: SlidingModes
    cycle_frequency: Array
    cycle_growth_rate: Array
    mac: Array


@compiling()
def frequencies(p: Parameters, *, tol: float = 1e-12) -> Frequencies:
    """Frequencies of steady sliding and of the stick-slip cycle near the static start; empty without steady sliding."""
    cycle = floquet(p, tol=tol)
    modes = sliding_modes(p, cycle.sliding)
    columns = np.full((3, len(modes.frequency)), math.nan)
    if cycle.status is CycleStatus.OK and len(modes.frequency):
        disc = modes.diameters >= 0
        disc_rows, _, height = split_rows(mode_arrays(p), modes.shapes[:, disc])
        shapes = np.vstack([*disc_rows, height if len(height) else np.zeros((2, disc.sum()))])
        columns[:, disc] = _of_cycle(p, cycle, modes.frequency[disc], shapes, tol)
    return Frequencies(cycle, modes, *columns)


def _of_cycle(p: Parameters, cycle: FloquetResult, seen: Array, shapes: ComplexArray, tol: float) -> Array:
    """Frequency, growth rate and mac, shape (3, n), for modes of the disc of frequencies and shapes."""
    assert cycle.state is not None
    map_ = ReturnMap(p, tol)
    flight = map_.evaluate(map_.point(cycle.state), releases=cycle.releases)
    multipliers, vectors = np.linalg.eig(flight.jacobian)
    shapes = np.array([_on_section(map_, cycle.state, shape) for shape in shapes.T]).T
    shapes = shapes / np.linalg.norm(shapes, axis=0)
    # two multipliers may match a mode: one resembles its shape, one the conjugate
    mac = np.abs(np.hstack([shapes.conj(), shapes]).T @ (vectors / np.linalg.norm(vectors, axis=0))) ** 2
    from scipy.optimize import linear_sum_assignment

    rows, columns = linear_sum_assignment(-mac)
    matched = np.full(len(mac), -1)
    matched[rows] = columns
    first, other = matched[: shapes.shape[1]], matched[shapes.shape[1] :]
    rate = 1 / cycle.period
    angle = np.angle(multipliers[first]) / (2 * math.pi)
    with np.errstate(divide="ignore"):
        growth = np.log(np.abs(multipliers)) * rate
    frequency = (angle + np.round(seen / rate - angle)) * rate
    values = np.array([frequency, np.maximum(growth[first], growth[other]), mac[np.arange(len(first)), first]])
    # with fewer multipliers than places, some modes have none
    values[:, (first < 0) | (other < 0)] = math.nan
    return values


def _on_section(map_: ReturnMap, state: State, shape: ComplexArray) -> ComplexArray:
    """A shape in the coordinates of the return map's section, (n,); these are linear in it."""
    parts = []
    for part in (shape.real, shape.imag):
        a, alpha, b, beta = part[:-2].reshape(4, -1)
        # in separation, because in contact the height would be the disc's
        separated = state.replace(phase="separation", direction=0, a=a, b=b, alpha=alpha, beta=beta, _roots=(0, 0))
        parts.append(map_.point(separated.replace(u=float(part[-2]), u_velocity=float(part[-1]))))
    return np.asarray(parts[0] + 1j * parts[1], dtype=complex)
