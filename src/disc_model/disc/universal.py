"""Discs from universal files of modal tests and finite elements, which pyuff reads.

Along the slider's circle the normal motion of a mode is a cos(l theta - turn), and its motion along
the slider's path v sin(l theta - turn). The other half of the pair is turned by a quarter of a wave.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np
import pandas as pd

from disc_model.arrays import Array
from disc_model.display import brought
from disc_model.errors import Fault, ParameterError, require
from disc_model.parameters import Disc
from disc_model.units import Finite, Positive, Strict, Unit, size_of_unit

SAME_PLACE = 1e-3  # of r_0: difference of radii on one circle, and of heights on one face
SAME_PAIR = 0.05  # greatest relative difference of the frequencies of the halves of a pair
SAME_HALF = 0.5  # squared cosine between two waves above which they are the same half of a pair
SAME_UNIT = 1e-3  # relative difference of a unit that is given from that of dataset 164
FOLLOWED = 0.5  # least share of the squared normal motion in the harmonic of a mode
UNMOVED = 1e-3  # share of the motion below which that along the axis, or in the plane, is none
ROUNDING = 1e-9  # of half a turn over the largest gap between nodes
MOST_DIAMETERS = 60  # of the modes of a `Disc`
NODES = (15, 2411)  # datasets
READ = (*NODES, 55, 2414, 18, 2420, 164)  # besides of results, coordinate systems and units

Data = Mapping[str, Any]
"""A dataset, as pyuff has it."""


class Place(Strict):
    """The slider's circle in the coordinates of a file, and the units of the file.

    Attributes
    ----------
    r_0 : m, its radius
    axis : from the disc to the slider
    centre : m, a point on the axis
    units : of length and force
    """

    r_0: Annotated[Positive, Unit("m")]
    axis: tuple[Finite, Finite, Finite]
    centre: Annotated[tuple[Finite, Finite, Finite], Unit("m")]
    units: tuple[str, str]


class Circle(NamedTuple):
    """The nodes on the slider's circle: numbers, angles (rad), directions of the axis (3,) and of the
    path (nodes, 3), and the matrix that fits cosines, plus i times sines, of 0, 1, 2, ... waves."""

    labels: Any
    angles: Array
    axis: Array
    path: Array
    fit: Any


class Wave(NamedTuple):
    """A mode along the circle: fields of a `Disc`, and the angle of an antinode times the diameters."""

    omega: float
    diameters: float
    amplitude: float
    tangential: float
    damping_ratio: float
    turn: float


def disc_of_universal_file(path: str | os.PathLike[str], **place: Any) -> Disc:
    """Read a disc from a universal file, see `disc_model.Disc.from_uff`."""
    checked = Place(**place)
    try:
        return _disc(_sets(path), checked)
    except ParameterError as error:
        faults = error.faults
    except (LookupError, ValueError) as error:
        faults = (Fault((), "", f"has datasets that do not fit together ({error})"),)
    raise ParameterError(*(fault.inside((Path(path).name,)) for fault in faults))


def _sets(path: str | os.PathLike[str]) -> list[Data]:
    """The datasets of a file that are read."""
    pyuff = brought("pyuff", "uff")
    sets = []
    what = "file"
    try:
        end = Path(path).read_bytes().split()[-1:]
        file = pyuff.UFF(str(path))
        for place, number in enumerate(file.get_set_types()):
            what = f"dataset {number}, no. {place + 1} of the file,"
            if number in READ:
                sets.append(file.read_sets(place))
    except Exception as error:  # pyuff has none of its own
        raise ParameterError(Fault((), "", f"{what} cannot be read ({error})")) from None
    rule = "must be a line -1: this is no universal file, or it is cut off"
    require((end == [b"-1"], "end", b"".join(end), rule))
    return sets


def _disc(sets: Sequence[Data], place: Place) -> Disc:
    """The disc of the datasets of a file."""
    length, force = map(size_of_unit, place.units, ("m", "N"))
    rule = 'must be units of length and of force, such as ("mm", "N")'
    require((length * force, "units", place.units, rule))
    for data in sets:
        if data["type"] == 164:
            given = (data["length"], data["force"])  # of them in a metre and in a newton
            fits = np.allclose(np.multiply(given, (length, force)), 1, rtol=SAME_UNIT)
            require((fits, "units", place.units, f"dataset 164 has {given} of them in m and N"))
        kinds = data.get("cs_type", data.get("CS_types", ()))
        require((not any(kinds), "coordinate systems", [*kinds], "must be Cartesian"))
    nodes = [data for data in sets if data["type"] in NODES]
    modes = [data for data in sets if _is_normal_mode(data)]
    found = ", ".join(dict.fromkeys(str(data["type"]) for data in sets))
    rule = "must be nodes, 15 or 2411, and normal modes of displacements, 55 or 2414 (analysis 2, data 8)"
    require((nodes and modes, "datasets", found, rule))

    circle = _circle(nodes, modes[0]["node_nums"], length, place)
    waves = [wave for data in modes if (wave := _wave(data, circle, force / length))]
    require((waves, "modes", len(modes), "must move the slider's circle along the axis"))
    means = [np.mean(halves, axis=0) for halves in _pairs(waves)]
    table = pd.DataFrame(means, columns=Wave._fields).sort_values("omega")
    del table["turn"]
    if table["tangential"].abs().max() < UNMOVED * table["amplitude"].max():
        del table["tangential"]
    columns: Any = table.to_dict("list")
    return Disc(**columns)


def _is_normal_mode(data: Data) -> bool:
    """Whether a dataset has displacements of a normal mode at nodes."""
    if data["type"] not in (55, 2414) or data["data_type"] not in (2, 4):  # of reals
        return False
    kind = data.get("spec_data_type", data.get("result_type"))
    values = data.get("n_data_per_node", data.get("number_of_data_values_for_the_data_component"))
    return (data["analysis_type"], kind) == (2, 8) and values in (3, 6)


# ---- Waves along the circle


def _circle(nodes: Iterable[Data], moved: Array, length: float, place: Place) -> Circle:
    """The nodes on the circle, of those that are moved, on the face towards the slider."""
    axis = np.array(place.axis)
    require((axis.any(), "axis", place.axis, "must not be 0"))
    axis /= np.linalg.norm(axis)
    tables = [pd.DataFrame({x: data[x] for x in "xyz"}, data["node_nums"]) for data in nodes]
    table = pd.concat(tables).sort_index().loc[lambda all_nodes: all_nodes.index.isin(moved)]
    points = table.to_numpy() * length - place.centre
    heights = points @ axis
    outward = points - np.outer(heights, axis)
    radii = np.linalg.norm(outward, axis=1)
    same = SAME_PLACE * place.r_0
    on = np.abs(radii - place.r_0) < same
    nearest = radii[np.abs(radii - place.r_0).argmin()]
    rule = f"must be a radius of nodes that move: the nearest are at {nearest:.4g} m"
    require((on.any(), "r_0", place.r_0, rule))

    on &= heights > heights[on].max() - same
    outward = outward[on] / radii[on, None]
    path = np.cross(axis, outward)
    angles = np.arctan2(outward @ path[0], outward @ outward[0])
    turned = np.sort(angles)
    gap = np.diff(turned, append=turned[0] + math.tau).max()
    # less than half a wave from one node to the next
    most = min(math.ceil(math.pi / gap - ROUNDING) - 1, MOST_DIAMETERS)
    rule = f"must have nodes all around: {len(angles)} leave {math.degrees(gap):.0f} degrees free"
    require((most > 0, "r_0", place.r_0, rule))
    waves = np.outer(angles, np.arange(most + 1))
    cosines, sines = np.split(np.linalg.pinv(np.hstack([np.cos(waves), np.sin(waves)])), 2)
    return Circle(table.index[on], angles, axis, path, cosines + 1j * sines)


def _wave(data: Data, circle: Circle, unit_mass: float) -> Wave | None:
    """A mode along the circle; None if it does not move that along the axis."""
    frequency, mass, viscous, hysteretic, shape = _mode(data)
    require((mass > 0, "modal mass", mass, f"must be > 0 (mode at {frequency:g} Hz)"))
    displacements = pd.DataFrame(shape, data["node_nums"]).loc[circle.labels]
    moved = displacements.to_numpy() / math.sqrt(mass * unit_mass)
    normal = moved @ circle.axis
    total = normal @ normal
    if total <= UNMOVED**2 * np.sum(moved**2):
        return None

    # of cosines, plus i times that of sines: a exp(i turn), and along the path i v exp(i turn)
    waves = circle.fit @ np.stack([normal, np.sum(moved * circle.path, axis=1)], axis=1)
    l = int(np.abs(waves[:, 0]).argmax())
    wave, along = waves[l]
    rest = normal - np.real(wave * np.exp(-1j * l * circle.angles))
    followed = 1 - rest @ rest / total
    rule = f"must have half of its motion in one number of nodal diameters: {l} have {followed:.0%}"
    rule += f", and {len(normal)} nodes tell up to {len(waves) - 1}"
    require((followed > FOLLOWED, "mode", f"{frequency:g} Hz", rule))
    return Wave(
        omega=math.tau * frequency,
        diameters=l,
        amplitude=abs(wave),
        # of the half that moves normally as sin(l theta), it is that of cos(l theta)
        tangential=(l > 0) * (wave * along.conjugate()).imag / abs(wave),
        damping_ratio=viscous + hysteretic / 2,  # the same loss at resonance
        turn=np.angle(wave),
    )


def _mode(data: Data) -> tuple[float, float, float, float, Array]:
    """Frequency (Hz), modal mass, viscous and hysteretic damping, and displacements (nodes, 3)."""
    if data["type"] == 55:
        reals = [data[name] for name in ("freq", "modal_m", "modal_damp_vis", "modal_damp_his")]
        return *reals, np.stack([data["r1"], data["r2"], data["r3"]], axis=1)
    reals = [data[f"record12_field{i}"] for i in (2, 4, 5, 6)]
    return *reals, np.array(data["data_at_node"])[:, :3]


def _pairs(waves: Iterable[Wave]) -> list[list[Wave]]:
    """The waves of each mode of the disc: both halves of a pair, or one."""
    groups: list[list[Wave]] = []
    for wave in sorted(waves):
        single = {group[0].diameters: group for group in groups if len(group) == 1}
        near = single.get(wave.diameters, [])
        if not wave.diameters or not near or near[0].omega < (1 - SAME_PAIR) * wave.omega:
            groups.append([wave])
            continue
        is_half = math.cos(wave.turn - near[0].turn) ** 2 < SAME_HALF
        frequency = f"{wave.omega / math.tau:g} Hz"
        rule = (
            "must not be within 5 % of another one with equal diameters and antinodes at one place"
        )
        require((is_half, "mode", frequency, rule))
        near.append(wave)
    return groups
