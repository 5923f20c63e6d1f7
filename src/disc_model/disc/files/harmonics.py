"""Modes of an axisymmetric disc from shapes at nodes: nodal diameters, amplitudes, and pairs.

Along the slider's circle the normal motion of a mode is a cos(l theta - turn), and its tangential
motion v sin(l theta - turn). The other half of the pair is turned by a quarter of a wave.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from disc_model.disc.files.circle import SAME_RADIUS, Circle
from disc_model.disc.given import SAME_PAIR, ModeOrigin, relative_difference
from disc_model.disc.plate import Array

MOST_DIAMETERS = 60  # of the modes of a `Disc`
IN_PLANE = 1e-3  # share of the motion in the plane below which normal motion is none
UNMOVED = 1e-6  # share of the largest amplitude below which a mode is unmoved under the slider
NORMAL_WEIGHT = 0.1  # of the share of motion along the axis, in the likeness to a disc
FOLLOWED = 0.5  # least share of the normal motion that has the mode's nodal diameters
IN_PHASE = 0.75  # least share of a shape that is in phase: within 30 degrees
NO_WAVE = "mode with less than half of its motion in one number of nodal diameters"
SAME_FREQUENCY = 1e-2  # relative difference within which a mode may be there several times
SAME_AMPLITUDE = 0.2  # relative difference of amplitudes within which it is
SAME_HALF = 0.5  # likeness of waves above which they are the same half of a pair


@dataclass(frozen=True)
class Wave:
    """A mode as a wave along the slider's circle.

    Attributes
    ----------
    diameters : number of nodal diameters
    omega, damping_ratio : rad/s, 1
    amplitude, tangential : kg^-1/2, of the normal motion and of that along the slider's path, as
        `disc_model.Disc` has them
    in_plane : kg^-1/2, largest motion in the plane at these nodes
    turn : rad, angle of an antinode times the number of diameters
    radii, shape : m and kg^-1/2, the normal motion on other circles at the turn
    followed, in_phase : shares of the normal motion with these diameters, and in phase
    """

    diameters: int
    omega: float
    damping_ratio: float
    amplitude: float
    tangential: float
    in_plane: float
    turn: float
    radii: Array
    shape: Array
    followed: float
    in_phase: float


@dataclass(frozen=True)
class Motion:
    """What a shape moves at the nodes: components (n, 3), radial, tangential, axial, nan where
    nothing is known; rad/s, damping ratio, and the share that is in phase."""

    omega: float
    damping_ratio: float
    components: Array
    in_phase: float


def find_wave(motion: Motion, circle: Circle, places: Array) -> tuple[Wave | None, str]:
    """Find the nodal diameters of a mode; the wave, or None and the reason to leave it out."""
    known = np.isfinite(motion.components[:, 2])
    chosen = circle.members & known
    in_plane = motion.components[chosen, :2]
    normal = motion.components[chosen, 2]
    if np.any(chosen != circle.members):
        part = circle.of_nodes(chosen, places)
        if part is None or not part.covers:
            return None, "mode without nodes around the slider's circle"
        circle = part
    if motion.in_phase < IN_PHASE:
        return None, "mode whose motion is not in phase by its modal A"
    if np.linalg.norm(normal) <= IN_PLANE * np.linalg.norm(in_plane):
        return None, "mode in the plane of the disc"
    angles = circle.frame.angles(places)
    l, cosine, sine, followed = _best_harmonic(angles[chosen], normal, circle.most_diameters)
    if followed < FOLLOWED:
        return None, f"{NO_WAVE}, up to {circle.most_diameters}"

    turn = math.atan2(sine, cosine)
    along_path = 0.0
    if l > 0:
        across = np.sin(l * angles[chosen] - turn)
        along_path = float(in_plane[:, 1] @ across / (across @ across))
    radii, shape = _shape(motion.components[:, 2], circle, places, l, turn)
    return Wave(
        diameters=l,
        omega=motion.omega,
        damping_ratio=motion.damping_ratio,
        amplitude=math.hypot(cosine, sine),
        # of the half that moves normally as sin(l theta), it is that of -cos(l theta)
        tangential=0.0 - along_path,
        in_plane=float(np.abs(in_plane).max()),
        turn=turn,
        radii=radii,
        shape=shape,
        followed=followed,
        in_phase=motion.in_phase,
    ), ""


def _best_harmonic(angles: Array, normal: Array, most: int) -> tuple[int, float, float, float]:
    """The harmonic with most of the motion: its number, its cosine and sine, and its share of the
    sum of squares."""
    best = (0, 0.0, 0.0, -1.0)
    total = float(normal @ normal)
    for l in range(min(most, MOST_DIAMETERS) + 1):
        cosine, sine, rest = _harmonic(angles, normal, l)
        if 1 - rest / total > best[3]:
            best = (l, cosine, sine, 1 - rest / total)
    return best


def _harmonic(angles: Array, values: Array, l: int) -> tuple[float, float, float]:
    """Cosine and sine of a harmonic by least squares, and the sum of squares that it leaves."""
    waves = np.stack([np.cos(l * angles), np.sin(l * angles)], axis=1)
    if l == 0:
        waves = waves[:, :1]
    solution, *_ = np.linalg.lstsq(waves, values, rcond=None)
    rest = values - waves @ solution
    cosine, sine = [*solution.tolist(), 0.0][:2]
    return cosine, sine, float(rest @ rest)


def _rest(angles: Array, values: Array, l: int) -> float:
    """The sum of squares of three components (n, 3) that a harmonic leaves."""
    return sum(_harmonic(angles, column, l)[2] for column in values.T)


def disc_likeness(motion: Motion, circle: Circle, places: Array) -> float:
    """How much motion on the circle, of three components, looks like that of a disc, 0 to 1: above
    all by the share that one number of nodal diameters explains, then by that along the axis."""
    chosen = circle.members & np.isfinite(motion.components[:, 2])
    values = motion.components[chosen]
    total = float(np.sum(values**2))
    if total == 0:
        return 0.0
    angles = circle.frame.angles(places)[chosen]
    orders = range(min(circle.most_diameters, MOST_DIAMETERS) + 1)
    rests = [_rest(angles, values, l) for l in orders]
    explained = 1 - min(rests) / total
    normal = float(np.sum(values[:, 2] ** 2)) / total
    return (1 - NORMAL_WEIGHT) * explained + NORMAL_WEIGHT * normal


def _shape(
    normal: Array, circle: Circle, places: Array, l: int, turn: float
) -> tuple[Array, Array]:
    """Radii of circles at the slider's height with enough nodes, and the normal motion there, in
    phase with that under the slider."""
    radii = circle.frame.radii(places)
    same = SAME_RADIUS * float(radii[circle.members].mean())
    at_height = np.isfinite(normal)
    if math.isfinite(circle.height):
        at_height &= np.abs(circle.frame.heights(places) - circle.height) < same
    wave = np.cos(l * circle.frame.angles(places) - turn)
    found = []
    values = []
    order = np.unique(np.round(radii[at_height], 6))
    for radius in order[np.diff(order, prepend=-1.0) > same]:
        ring = at_height & (np.abs(radii - radius) < same)
        if ring.sum() > 2 * l:
            found.append(float(radius))
            of_wave = wave[ring]
            projection = of_wave @ normal[ring] / (of_wave @ of_wave)
            values.append(float(projection))
    return np.array(found), np.array(values)


# ---- Pairs


def without_unmoved(waves: Sequence[Wave], left_out: Counter[str]) -> list[Wave]:
    """The waves that move under the slider; others are counted."""
    largest = max((wave.amplitude for wave in waves), default=0.0)
    moving = [wave for wave in waves if wave.amplitude > UNMOVED * largest]
    if len(waves) > len(moving):
        left_out["mode that does not move under the slider"] += len(waves) - len(moving)
    return moving


def grouped(waves: Iterable[Wave]) -> list[list[Wave]]:
    """Waves that are one mode of the disc: the halves of a pair, and repetitions."""
    groups: list[list[Wave]] = []
    for wave in sorted(waves, key=lambda wave: wave.omega):
        group = next((group for group in groups if _belongs(wave, group)), None)
        if group is None:
            groups.append([wave])
        else:
            group.append(wave)
    return groups


def _belongs(wave: Wave, group: list[Wave]) -> bool:
    """Whether a wave is a repetition of a mode, its other half, or both halves combined, as
    references elsewhere see them."""
    first = group[0]
    apart = (wave.omega - first.omega) / wave.omega
    if wave.diameters != first.diameters or apart >= SAME_PAIR:
        return False
    close = [other for other in group if (wave.omega - other.omega) / wave.omega < SAME_FREQUENCY]
    if any(_have_one_amplitude(wave, other) for other in close):
        return True
    return wave.diameters > 0 and is_one_half(group) and not is_one_half([first, wave])


def is_one_half(group: Sequence[Wave]) -> bool:
    """Whether a group of equal diameters has one half of a pair only."""
    return all(_likeness(group[0], other) > SAME_HALF for other in group)


def _likeness(one: Wave, other: Wave) -> float:
    """Square of the cosine of the angle between two waves of equal diameters."""
    return math.cos(one.turn - other.turn) ** 2


def _have_one_amplitude(one: Wave, other: Wave) -> bool:
    return abs(one.amplitude / other.amplitude - 1) < SAME_AMPLITUDE


def mean_of(group: Sequence[Wave], name: str) -> Any:
    """Mean of an attribute over the halves of a pair, each of which may be there several times."""
    first = [getattr(wave, name) for wave in group if _likeness(wave, group[0]) > SAME_HALF]
    second = [getattr(wave, name) for wave in group if _likeness(wave, group[0]) <= SAME_HALF]
    means = [np.mean(half, axis=0) for half in (first, second) if half]
    return np.mean(means, axis=0)


def origin_of(group: Sequence[Wave]) -> ModeOrigin:
    """What a mode of the disc is made of."""
    frequencies = [wave.omega for wave in group]
    return ModeOrigin(
        diameters=group[0].diameters,
        lower=min(frequencies),
        upper=max(frequencies),
        shapes=len(group),
        followed=min(wave.followed for wave in group),
        in_phase=min(wave.in_phase for wave in group),
        amplitude_split=relative_difference([abs(wave.amplitude) for wave in group]),
        damping_split=relative_difference([wave.damping_ratio for wave in group]),
    )
