"""Modes of a universal file as waves along the slider's circle, and the disc that they make."""

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from itertools import chain
from typing import Any

import numpy as np

from disc_model.disc.files.harmonics import (
    IN_PLANE,
    NO_WAVE,
    Motion,
    Wave,
    find_wave,
    mean_of,
    without_unmoved,
)
from disc_model.disc.files.place import Place
from disc_model.disc.files.universal_modes import Shape
from disc_model.disc.files.universal_motion import Placed, placed_modes
from disc_model.disc.files.universal_sets import DataSet
from disc_model.parameters import Disc

FAR_FACE = 0.01  # ratio of tangential to normal amplitudes above which the axis is doubted
LARGE = 1e-2  # of the largest amplitude: motion of a mode that a reader would miss


def placed_towards_slider(
    shapes: Sequence[Shape], sets: list[DataSet], place: Place, length: float
) -> Placed:
    """The modes around the axis of the disc; if that is found, its sense follows from the
    motion."""
    axis, centre = place.vectors
    placed = placed_modes(shapes, sets, place.r_0, length, axis, centre)
    if axis is None and is_far_face(waves_of(placed, Counter())[0]):
        turned = -placed.circle.frame.axis
        placed = placed_modes(shapes, sets, place.r_0, length, turned, centre)
    return placed


def waves_of(placed: Placed, left_out: Counter[str]) -> tuple[list[Wave], list[float]]:
    """The modes that are waves along the slider's circle, and frequencies (Hz) of those that move
    as much and are none; all that are left out are counted."""
    waves: list[Wave] = []
    none: list[Motion] = []
    for motion in placed.motions:
        wave, reason = find_wave(motion, placed.circle, placed.places)
        if wave is None:
            left_out[reason] += 1
        if wave is None and reason.startswith(NO_WAVE):
            none.append(motion)
        if wave is not None:
            waves.append(wave)
    moving = without_unmoved(waves, left_out)
    least = LARGE * max((wave.amplitude for wave in moving), default=0.0)
    members = placed.circle.members
    large = [
        motion.omega / math.tau
        for motion in none
        if np.nanmax(np.abs(motion.components[members, 2]), initial=0.0) > least
    ]
    return moving, large


def _common_radii(groups: Sequence[Sequence[Wave]]) -> list[float]:
    """Radii at which the shapes of all modes are known."""
    known = [set(wave.radii.tolist()) for wave in chain.from_iterable(groups)]
    return sorted(set.intersection(*known))


def _at(wave: Wave, radii: Sequence[float]) -> Wave:
    """A wave with its shape at some of its radii."""
    chosen = np.isin(wave.radii, radii)
    return replace(wave, radii=wave.radii[chosen], shape=wave.shape[chosen])


def have_motion_in_plane(waves: Sequence[Wave]) -> bool:
    """Whether the file has motion in the plane of modes that move across it, and not only what an
    inexact axis makes of motion along it."""
    return any(wave.in_plane > IN_PLANE * wave.amplitude for wave in waves)


def is_far_face(waves: Sequence[Wave]) -> bool:
    """Whether the surface moves as that of a face away from the slider: a bent plate has negative
    tangential amplitudes on the face under the slider and positive ones on the other face."""
    towards = sum(wave.diameters * wave.amplitude * wave.tangential for wave in waves)
    scale = sum(wave.diameters * wave.amplitude**2 for wave in waves)
    return towards > FAR_FACE * scale


# ---- The disc


def disc_of(groups: Sequence[Sequence[Wave]], tangential: bool) -> Disc:
    """The disc of waves that are grouped into modes."""
    diameters = [group[0].diameters for group in groups]
    numbers: dict[str, Any] = {
        "omega": _means(groups, "omega"),
        "damping_ratio": _means(groups, "damping_ratio"),
        "amplitude": _means(groups, "amplitude"),
    }
    if tangential:
        numbers["tangential"] = _means(groups, "tangential")
    radii = _common_radii(groups)
    if len(radii) > 1:
        chosen = []
        for group in groups:
            chosen.append([_at(wave, radii) for wave in group])
        numbers["radii"] = radii
        numbers["shapes"] = _means(chosen, "shape")
    return Disc(
        diameters=diameters,
        circles=[diameters[:i].count(l) for i, l in enumerate(diameters)],
        **numbers,
    )


def _means(groups: Sequence[Sequence[Wave]], name: str) -> list[Any]:
    """Means of an attribute of the waves of each group."""
    return [np.asarray(mean_of(group, name)).tolist() for group in groups]
