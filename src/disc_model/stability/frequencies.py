"""Frequencies of the multipliers of the stick-slip cycle, matched to the modes of steady sliding.

A multiplier gives a frequency (angle / 2 pi + n) / T.  One assignment matches all multipliers to
the modes of sliding by the modal assurance criterion (MAC); n brings the frequency nearest to the
mode's.
"""

import math

import numpy as np
from scipy.optimize import linear_sum_assignment

from disc_model.arrays import Array
from disc_model.engine.jit.cache import compiling
from disc_model.parameters import Parameters
from disc_model.stability.cycle import SAME_POINT, FloquetResult, find_cycle
from disc_model.stability.return_map import ReturnMap, newton
from disc_model.stability.sliding import SlidingModes, sliding_modes

SETTLED = 300
"""Releases after which the motion is compared with a cycle: after fewer it may still be on its way."""
GROWTH = 37.0
"""Growth rate times the time of these releases, beyond which even a difference by rounding, 1e-16, would have
taken a motion away from the cycle."""


@compiling()
def frequencies(p: Parameters, *, tol: float = 1e-12) -> tuple[FloquetResult, SlidingModes, Array]:
    """The stick-slip cycle near the static start, and the modes of steady sliding. Of the
    multipliers matched to each mode, (3, n): frequency (Hz), larger growth rate of two (1/s) and
    MAC of the shapes; nan without a cycle, and for the slider's in-plane motion."""
    cycle = find_cycle(p, tol)
    modes = sliding_modes(p, cycle.sliding)
    columns = np.full((3, len(modes.frequency)), math.nan)
    disc = modes.diameters >= 0
    if cycle.state is None or not disc.any():
        return cycle, modes, columns
    map_ = ReturnMap(p, tol)
    orbit = map_.evaluate(map_.point(cycle.state), releases=cycle.releases)
    multipliers, vectors = np.linalg.eig(orbit.jacobian)
    shapes = np.transpose([map_.point_of(shape) for shape in modes.shapes[:, disc].T])
    shapes /= np.linalg.norm(shapes, axis=0)

    # two multipliers may match a mode: one resembles its shape, one the conjugate
    both = np.hstack([shapes.conj(), shapes])
    mac = np.abs(both.T @ (vectors / np.linalg.norm(vectors, axis=0))) ** 2
    rows, assigned = linear_sum_assignment(-mac)
    matched = np.full(len(mac), -1)
    matched[rows] = assigned
    first, other = matched.reshape(2, -1)

    rate = 1 / cycle.period
    angle = np.angle(multipliers[first]) / (2 * math.pi)
    turns = np.round(modes.frequency[disc] / rate - angle)
    frequency = (angle + turns) * rate
    with np.errstate(divide="ignore"):
        growth = np.log(np.abs(multipliers)) * rate
    larger_growth = np.maximum(growth[first], growth[other])
    values = np.array([frequency, larger_growth, mac[np.arange(len(first)), first]])
    # with fewer multipliers than shapes, some modes have none
    values[:, (first < 0) | (other < 0)] = math.nan
    columns[:, disc] = values
    return cycle, modes, columns


def may_be_near(cycle: FloquetResult) -> bool | None:
    """Whether the motion from the static start may be near an unstable cycle, by `SETTLED` releases: its
    crossings are then those of the motion. None of a stable cycle, and without one."""
    if cycle.state is None or cycle.stable or cycle.releases > 1:
        return None
    map_ = ReturnMap(cycle.parameters, cycle.tol)
    if not map_.first_release.reached:
        return True
    motion = map_.evaluate(map_.first_release.x, releases=SETTLED, tangent=False)
    own = map_.point(cycle.state)
    apart = SAME_POINT * np.linalg.norm(own)
    distance = np.linalg.norm(motion.end - own)
    if not motion.returned or distance <= apart:
        return True
    other = newton(map_, motion.end)
    is_near_another = (
        other is not None
        and np.linalg.norm(other.start - own) > apart
        and np.linalg.norm(other.start - motion.end) < distance
    )
    return not is_near_another and bool(cycle.growth_rate * motion.period < GROWTH)
