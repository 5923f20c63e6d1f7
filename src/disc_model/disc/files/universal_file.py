"""Discs from universal files of modal tests and finite elements."""

from __future__ import annotations

import itertools
import math
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator

from disc_model.disc.files.circle import Circle, find_circle
from disc_model.disc.files.harmonics import (
    IN_PLANE,
    NO_WAVE,
    Motion,
    Wave,
    disc_likeness,
    find_wave,
    grouped,
    is_one_half,
    mean_of,
    origin_of,
    without_unmoved,
)
from disc_model.disc.files.universal_geometry import (
    FileUnits,
    Nodes,
    System,
    directions,
    have_own_systems,
    positions,
    read_nodes,
    read_systems,
    read_units,
)
from disc_model.disc.files.universal_modes import (
    FileMode,
    Shape,
    normalised,
    poles_in_hertz,
    read_modes,
    with_modal_mass,
    with_pole_in_radians,
)
from disc_model.disc.files.universal_sets import DataSet, read_sets
from disc_model.disc.given import SAME_PAIR, DiscReport
from disc_model.disc.plate import Array
from disc_model.display import counted
from disc_model.errors import Fault, ParameterError
from disc_model.parameters import Disc
from disc_model.units import Finite, Positive, Strict, Unit, in_si

if TYPE_CHECKING:
    import os

BETTER = 1e-4  # by how much another reading of coordinate systems must look more like a disc
TOLD_APART = 0.2  # relative difference of frequencies within which two single halves are doubted
FAR_FACE = 0.01  # ratio of tangential to normal amplitudes above which the axis is doubted
LARGE = 1e-2  # of the largest amplitude: motion of a mode that a reader would miss


def _axis(value: Any) -> Any:
    """The unit vector of an axis, from a word such as "-z" or three numbers."""
    rule = 'must be "x", "y", "z", one of these with a minus, or three numbers that are not all 0'
    if isinstance(value, str):
        word = value.strip().lower()
        if word.lstrip("+-") in ("x", "y", "z") and len(word) <= 2:
            vector = np.eye(3)["xyz".index(word[-1])]
            return tuple((-vector if word.startswith("-") else vector).tolist())
        value = value.split(",")
    try:
        vector = np.array([float(part) for part in value])
    except (TypeError, ValueError, OverflowError):
        raise ValueError(rule) from None
    length = float(np.linalg.norm(vector)) if vector.shape == (3,) else 0.0
    if not 0 < length < math.inf:
        raise ValueError(rule)
    return tuple((vector / length).tolist())


def _point(value: Any) -> Any:
    """Three numbers, also from a text with commas."""
    if isinstance(value, str):
        value = value.split(",")
    rule = "must be three numbers, x, y and z in m"
    try:
        numbers = tuple(float(part) for part in value)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(rule) from None
    if len(numbers) != 3:
        raise ValueError(rule)
    return numbers


def _two_units(value: Any) -> Any:
    """m and N in units of length and force, such as ("mm", "N")."""
    rule = 'must be units of length and of force, such as ("mm", "N")'
    parts = value.split(",") if isinstance(value, str) else value
    try:
        length, force = parts
    except (TypeError, ValueError):
        raise ValueError(rule) from None
    faults: list[Fault] = []
    in_m = in_si(f"1 {length}", "m", faults, ())
    in_newton = in_si(f"1 {force}", "N", faults, ())
    if faults or not (isinstance(in_m, float) and isinstance(in_newton, float)):
        raise ValueError(rule)
    return in_m, in_newton


class Place(Strict):
    """Where the slider runs in the coordinates of a file, and units where the file has none.

    Attributes
    ----------
    r_0 : m, radius of the slider's circle
    axis : unit vector from the disc to the slider; found if it is None
    centre : m, a point on the axis; found if it is None
    units : m and N in units of length and force
    modal_mass : of modes whose modal mass or modal A is 0, in the file's unit of mass; None to refuse these
    """

    r_0: Annotated[Positive, Unit("m")]
    axis: Annotated[tuple[Finite, Finite, Finite], BeforeValidator(_axis)] | None = None
    centre: Annotated[tuple[Finite, Finite, Finite], BeforeValidator(_point), Unit("m")] | None = (
        None
    )
    units: Annotated[tuple[Positive, Positive], BeforeValidator(_two_units)] | None = None
    modal_mass: Positive | None = None

    @classmethod
    def of(cls, *, r_0: Any, **options: Any) -> Self:
        """The place of arguments, of which those that are None are left out."""
        given = options
        return cls(r_0=r_0, **{name: value for name, value in given.items() if value is not None})


class Placed(NamedTuple):
    """The modes of a file in cylindrical coordinates.

    places : (n, 3), m, nodes that move
    circle : those under the slider
    motions : of each mode
    systems : how coordinate systems were understood; "" if all are global
    """

    places: Array
    circle: Circle
    motions: list[Motion]
    systems: str


class Reading(NamedTuple):
    """One understanding of coordinate systems: positions (n, 3) and directions of displacements
    (n, 3, 3) of all nodes, and words for it."""

    places: Array
    rows: Array
    text: str


def read_uff(path: str | os.PathLike[str], place: Place) -> Disc:
    """Read a disc from a universal file, see `disc_model.Disc.from_uff`."""
    name = Path(path).name
    try:
        return _disc(read_sets(path), place, name)
    except ParameterError as error:
        raise ParameterError(*(_inside(fault, name) for fault in error.faults)) from None


def _inside(fault: Fault, name: str) -> Fault:
    """A fault with the name of the file in front of it."""
    return fault.inside((name,)) if not fault.path else Fault((name,), "", str(fault))


def _disc(sets: list[DataSet], place: Place, name: str) -> Disc:
    """The disc of the datasets of a file, with its report."""
    units = read_units(sets, place.units)
    modes, left_out = read_modes(sets)
    if not modes:
        raise ParameterError(
            Fault((), "", f"must hold modes at nodes. {_contents(sets, left_out)}")
        )
    doubts: list[str] = []
    in_hertz = poles_in_hertz(modes)
    if in_hertz:
        modes = [with_pole_in_radians(mode) for mode in modes]
        doubts.append(f"the poles of {name} are taken to be in Hz: {in_hertz}")
    if place.modal_mass is not None:
        modes = [with_modal_mass(mode, place.modal_mass) for mode in modes]
    shapes = [normalised(mode, units.mass) for mode in modes]

    axis = None if place.axis is None else np.array(place.axis)
    placed = _placed(shapes, sets, units, place, axis)
    waves, unresolved = _waves(placed, left_out)
    if axis is None and _is_far_face(waves):
        # the axis was found, and its sense follows from the motion
        placed = _placed(shapes, sets, units, place, -placed.circle.frame.axis)
        waves, unresolved = _waves(placed, Counter())
    if not waves:
        raise ParameterError(
            Fault((), "", f"must hold modes across the disc. {_contents(sets, left_out)}")
        )
    groups = grouped(waves)
    doubts += _few_nodes(waves, placed.circle, unresolved)
    doubts += _single_halves(groups)
    tangential = _has_motion_in_plane(waves)
    if _is_far_face(waves):
        text = "the surface moves as that of a face away from the slider: the axis "
        text += f"{placed.circle.frame.text} must point from the disc to the slider"
        doubts.append(text)
    report = DiscReport(
        source=name,
        modes=tuple(origin_of(group) for group in groups),
        left_out=dict(left_out),
        notes=tuple(_notes(placed, units, modes, tangential)),
        doubts=tuple(doubts),
    )
    return _disc_of(groups, tangential).with_report(report)


def _disc_of(groups: Sequence[Sequence[Wave]], tangential: bool) -> Disc:
    """The disc of waves that are grouped into modes."""
    means = {
        name: [float(mean_of(group, name)) for group in groups]
        for name in ("omega", "damping_ratio", "amplitude", "tangential")
    }
    if not tangential:
        means["tangential"] = []
    diameters = [group[0].diameters for group in groups]
    radii = _common_radii(groups)
    if len(radii) < 2:
        radii = []
    shapes = [mean_of([_at(wave, radii) for wave in group], "shape").tolist() for group in groups]
    return Disc(
        diameters=diameters,
        circles=[diameters[:i].count(l) for i, l in enumerate(diameters)],
        omega=means["omega"],
        damping_ratio=means["damping_ratio"],
        amplitude=means["amplitude"],
        tangential=means["tangential"],
        radii=radii,
        shapes=shapes if radii else [],
    )


def _contents(sets: Iterable[DataSet], left_out: Counter[str]) -> str:
    """What a file holds, for messages."""
    counts = Counter(data.number for data in sets)
    texts = [
        f"{number} ({count})" if count > 1 else f"{number}" for number, count in counts.items()
    ]
    text = f"The file has datasets {', '.join(texts)}"
    if left_out:
        text += f"; left out: {', '.join(f'{n} x {reason}' for reason, n in left_out.items())}"
    return text


# ---- Nodes


def _placed(
    shapes: Sequence[Shape], sets: list[DataSet], units: FileUnits, place: Place, axis: Array | None
) -> Placed:
    """The modes in cylindrical coordinates, by the understanding of coordinate systems that makes
    most of them waves."""
    nodes = read_nodes(sets)
    moving = np.isin(nodes.labels, np.concatenate([shape.nodes for shape in shapes]))
    nodes = _chosen(nodes, moving)
    contents = _contents(sets, Counter())
    if len(nodes.labels) < 3:
        rule = "must give coordinates of the nodes that move, datasets 15 or 2411. "
        raise ParameterError(Fault((), "", rule + contents))
    centre = None if place.centre is None else np.array(place.centre)

    readings = [*_readings(nodes, read_systems(sets))]
    best: Placed | None = None
    most = -1.0
    fault: ParameterError | None = None
    for reading in readings:
        places = reading.places * units.length
        try:
            circle = find_circle(places, place.r_0, axis, centre, contents)
        except ParameterError as error:
            fault = fault or error
            continue
        motions = [_motion(shape, nodes, reading, circle, places) for shape in shapes]
        likeness = float(np.mean([disc_likeness(motion, circle, places) for motion in motions]))
        if likeness > most + BETTER:
            text = reading.text if len(readings) > 1 else ""
            best = Placed(places, circle, motions, text)
            most = likeness
    if best is None:
        assert fault is not None
        raise fault
    return best


def _chosen(nodes: Nodes, chosen: NDArray[np.bool_]) -> Nodes:
    """Some of the nodes."""
    return Nodes(
        labels=nodes.labels[chosen],
        coordinates=nodes.coordinates[chosen],
        defined_in=nodes.defined_in[chosen],
        moves_in=nodes.moves_in[chosen],
        in_system=nodes.in_system[chosen],
    )


def _readings(nodes: Nodes, systems: dict[int, System]) -> Iterable[Reading]:
    """Understandings of coordinate systems, that of the format first. In it nodes of dataset 15 are
    in their systems of definition, those of 2411 and all displacements in the global one."""
    everywhere = np.ones(len(nodes.labels), dtype=bool)
    kinds = [nodes.in_system, ~nodes.in_system & everywhere]
    if not have_own_systems(np.unique(nodes.defined_in).tolist(), systems):
        kinds = kinds[:1]
    for i, in_system in enumerate(kinds):
        places = positions(nodes, systems, in_system)
        words = "as the format has them" if i == 0 else "in the other systems than the format has"
        plain = np.broadcast_to(np.eye(3), (len(places), 3, 3))
        yield Reading(places, plain, f"coordinates {words}, displacements global")
        if have_own_systems(np.unique(nodes.moves_in).tolist(), systems):
            rows = directions(nodes, systems, places)
            yield Reading(places, rows, f"coordinates {words}, displacements in systems of nodes")


def _motion(shape: Shape, nodes: Nodes, reading: Reading, circle: Circle, places: Array) -> Motion:
    """A shape at all nodes in cylindrical components; nodes that it leaves out are nan."""
    values = np.full((len(nodes.labels), 3), np.nan)
    order = np.argsort(nodes.labels)
    found = np.searchsorted(nodes.labels[order], shape.nodes)
    found = np.minimum(found, len(order) - 1)
    is_known = nodes.labels[order[found]] == shape.nodes
    values[order[found[is_known]]] = shape.motion[is_known]
    turned = np.einsum("ni,nij->nj", values, reading.rows)
    components = circle.frame.components(places, turned)
    return Motion(shape.omega, shape.damping_ratio, components, shape.in_phase)


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
    text = f"{circle.count} nodes on the circle tell modes of up to {most} nodal diameters apart"
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
        low, high = first[0], second[0]
        apart = abs(high.omega - low.omega) / max(high.omega, low.omega)
        single = low.diameters > 0 and is_one_half(first) and is_one_half(second)
        if low.diameters != high.diameters or not single or apart > TOLD_APART:
            continue
        text = f"modes of {counted(low.diameters, 'nodal diameter')} at {low.omega / math.tau:.5g} and "
        text += f"{high.omega / math.tau:.5g} Hz are kept as two, {100 * apart:.2g} % apart: the "
        doubts.append(f"{text}halves of one pair are within {100 * SAME_PAIR:g} %")
    return doubts


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
    height = f"at the height {circle.height:.4g} m" if math.isfinite(circle.height) else ""
    height = height or "at different heights"
    yield f"{circle.count} nodes on the slider's circle, {height}, for up to {circle.most_diameters} nodal diameters"
    if placed.systems:
        yield placed.systems
    names = {0: "displacement", 1: "velocity", 2: "acceleration"}
    yield "shapes of " + " and ".join(names[order] for order in sorted({m.order for m in modes}))
    if tangential:
        yield "tangential amplitudes from the motion of these nodes along the circle"
    else:
        yield "no tangential amplitudes: the file has no motion along the circle"
