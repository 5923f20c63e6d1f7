"""Discs from universal files of modal tests and finite elements."""

from __future__ import annotations

import itertools
import math
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from disc_model.disc.files.circle import Circle
from disc_model.disc.files.harmonics import (
    IN_PLANE,
    NO_WAVE,
    Motion,
    Wave,
    find_wave,
    grouped,
    is_one_half,
    mean_of,
    origin_of,
    without_unmoved,
)
from disc_model.disc.files.place import Place
from disc_model.disc.files.universal_geometry import FileUnits, read_units
from disc_model.disc.files.universal_modes import (
    FileMode,
    Shape,
    normalised,
    poles_in_hertz,
    read_modes,
    with_modal_mass,
    with_pole_in_radians,
)
from disc_model.disc.files.universal_motion import Placed, contents_of, placed_modes
from disc_model.disc.files.universal_sets import DataSet, read_sets
from disc_model.disc.given import SAME_PAIR, DiscReport
from disc_model.display import counted
from disc_model.errors import Fault, ParameterError
from disc_model.parameters import Disc

if TYPE_CHECKING:
    import os

TOLD_APART = 0.2  # relative difference of frequencies within which two single halves are doubted
FAR_FACE = 0.01  # ratio of tangential to normal amplitudes above which the axis is doubted
LARGE = 1e-2  # of the largest amplitude: motion of a mode that a reader would miss


def read_uff(path: str | os.PathLike[str], place: Place) -> Disc:
    """Read a disc from a universal file, see `disc_model.Disc.from_uff`."""
    name = Path(path).name
    try:
        return _disc(read_sets(path), place, name)
    except ParameterError as error:
        raise ParameterError(*(_inside(fault, name) for fault in error.faults)) from None


def _inside(fault: Fault, name: str) -> Fault:
    """A fault with the name of the file in front of it."""
    return Fault((name,), "", str(fault))


def _disc(sets: list[DataSet], place: Place, name: str) -> Disc:
    """The disc of the datasets of a file, with its report."""
    units = read_units(sets, place.units)
    modes, left_out = read_modes(sets)
    if not modes:
        raise _nothing("must hold modes at nodes", sets, left_out)
    modes, doubts = _in_radians(modes, name)
    if place.modal_mass is not None:
        modes = [with_modal_mass(mode, place.modal_mass) for mode in modes]
    shapes = [normalised(mode, units.mass) for mode in modes]

    placed = _placed(shapes, sets, place, units.length)
    waves, unresolved = _waves(placed, left_out)
    if not waves:
        raise _nothing("must hold modes across the disc", sets, left_out)
    groups = grouped(waves)
    doubts += _few_nodes(waves, placed.circle, unresolved)
    doubts += _single_halves(groups)
    doubts += _far_face(waves, placed.circle)

    tangential = _has_motion_in_plane(waves)
    report = DiscReport(
        source=name,
        modes=tuple(origin_of(group) for group in groups),
        left_out=dict(left_out),
        notes=tuple(_notes(placed, units, modes, tangential)),
        doubts=tuple(doubts),
    )
    return _disc_of(groups, tangential).with_report(report)


def _in_radians(modes: list[FileMode], name: str) -> tuple[list[FileMode], list[str]]:
    """The modes with poles in rad/s, and a doubt if the file seems to have them in Hz."""
    reason = poles_in_hertz(modes)
    if not reason:
        return modes, []
    doubt = f"the poles of {name} are taken to be in Hz: {reason}"
    return [with_pole_in_radians(mode) for mode in modes], [doubt]


def _placed(shapes: Sequence[Shape], sets: list[DataSet], place: Place, length: float) -> Placed:
    """The modes around the axis of the disc; if that is found, its sense follows from the
    motion."""
    axis, centre = place.vectors
    placed = placed_modes(shapes, sets, place.r_0, length, axis, centre)
    if axis is None and _is_far_face(_waves(placed, Counter())[0]):
        turned = -placed.circle.frame.axis
        placed = placed_modes(shapes, sets, place.r_0, length, turned, centre)
    return placed


def _nothing(rule: str, sets: Iterable[DataSet], left_out: Counter[str]) -> ParameterError:
    """The error that a file does not hold what a disc needs, but other things."""
    text = f"{rule}. {contents_of(sets)}"
    if left_out:
        others = ", ".join(f"{count} x {reason}" for reason, count in left_out.items())
        text += f"; left out: {others}"
    return ParameterError(Fault((), "", text))


def _disc_of(groups: Sequence[Sequence[Wave]], tangential: bool) -> Disc:
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


# ---- Modes


def _waves(placed: Placed, left_out: Counter[str]) -> tuple[list[Wave], list[float]]:
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
    known = [set(wave.radii.tolist()) for wave in itertools.chain.from_iterable(groups)]
    return sorted(set.intersection(*known))


def _at(wave: Wave, radii: Sequence[float]) -> Wave:
    """A wave with its shape at some of its radii."""
    chosen = np.isin(wave.radii, radii)
    return replace(wave, radii=wave.radii[chosen], shape=wave.shape[chosen])


def _has_motion_in_plane(waves: Sequence[Wave]) -> bool:
    """Whether the file has motion in the plane of modes that move across it, and not only what an
    inexact axis makes of motion along it."""
    return any(wave.in_plane > IN_PLANE * wave.amplitude for wave in waves)


# ---- What a reader should know


def _few_nodes(waves: Sequence[Wave], circle: Circle, unresolved: Sequence[float]) -> list[str]:
    """Doubts whether the nodes are enough for the modes."""
    most = circle.most_diameters
    text = f"{circle.count} nodes on the circle tell modes of up to "
    text += f"{counted(most, 'nodal diameter')} apart"
    if unresolved:
        frequencies = ", ".join(f"{frequency:.5g}" for frequency in unresolved)
        return [f"{text}: the modes at {frequencies} Hz, which follow none of these, are left out"]
    if max(wave.diameters for wave in waves) >= most:
        return [f"{text}: modes of more may be taken for modes of fewer"]
    return []


def _single_halves(groups: Sequence[Sequence[Wave]]) -> list[str]:
    """Doubts about pairs whose halves are too far apart, so that each half became a mode."""
    doubts = []
    for first, second in itertools.combinations(groups, 2):
        low = first[0]
        high = second[0]
        apart = abs(high.omega - low.omega) / max(high.omega, low.omega)
        single = low.diameters > 0 and is_one_half(first) and is_one_half(second)
        if low.diameters != high.diameters or not single or apart > TOLD_APART:
            continue
        text = f"modes of {counted(low.diameters, 'nodal diameter')} at "
        text += f"{low.omega / math.tau:.5g} and {high.omega / math.tau:.5g} Hz are kept as two, "
        text += f"{100 * apart:.2g} % apart: the "
        doubts.append(f"{text}halves of one pair are within {100 * SAME_PAIR:g} %")
    return doubts


def _far_face(waves: Sequence[Wave], circle: Circle) -> list[str]:
    """Doubts whether the axis points to the slider."""
    if not _is_far_face(waves):
        return []
    text = "the surface moves as that of a face away from the slider: "
    return [f"{text}the axis {circle.frame.text} must point from the disc to the slider"]


def _is_far_face(waves: Sequence[Wave]) -> bool:
    """Whether the surface moves as that of a face away from the slider: a bent plate has negative
    tangential amplitudes on the face under the slider and positive ones on the other face."""
    towards = sum(wave.diameters * wave.amplitude * wave.tangential for wave in waves)
    scale = sum(wave.diameters * wave.amplitude**2 for wave in waves)
    return towards > FAR_FACE * scale


def _notes(
    placed: Placed, units: FileUnits, modes: Sequence[FileMode], tangential: bool
) -> Iterable[str]:
    """How the file was understood."""
    circle = placed.circle
    yield f"units of length and force: {units.source}"
    yield f"axis of the disc, towards the slider: {circle.frame.text}"
    height = "at different heights"
    if math.isfinite(circle.height):
        height = f"at the height {circle.height:.4g} m"
    nodes = f"{circle.count} nodes on the slider's circle, {height}"
    yield f"{nodes}, for up to {circle.most_diameters} nodal diameters"
    if placed.systems:
        yield placed.systems
    kinds = dict.fromkeys(mode.kind for mode in modes)
    yield f"shapes of {' and '.join(kinds)}"
    if tangential:
        yield "tangential amplitudes from the motion of these nodes along the circle"
    else:
        yield "no tangential amplitudes: the file has no motion along the circle"
