"""The modes of a universal file in cylindrical coordinates around the axis of a disc."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from disc_model.disc.files.circle import Circle, find_circle
from disc_model.disc.files.harmonics import Motion, disc_likeness
from disc_model.disc.files.universal_geometry import (
    Nodes,
    System,
    directions,
    have_own_systems,
    positions,
    read_nodes,
    read_systems,
)
from disc_model.disc.files.universal_modes import Shape
from disc_model.disc.files.universal_sets import DataSet
from disc_model.disc.plate import Array
from disc_model.errors import Fault, ParameterError

BETTER = 1e-4  # by how much another reading of coordinate systems must look more like a disc


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


def contents_of(sets: Iterable[DataSet]) -> str:
    """What a file holds, for messages."""
    counts = Counter(data.number for data in sets)
    texts = []
    for number, count in counts.items():
        texts.append(f"{number} ({count})" if count > 1 else f"{number}")
    text = f"The file has datasets {', '.join(texts)}"
    if 164 not in counts:
        text += ", and none with units (164)"
    return text


def placed_modes(
    shapes: Sequence[Shape],
    sets: list[DataSet],
    r_0: float,
    length: float,
    axis: Array | None,
    centre: Array | None,
) -> Placed:
    """Find the slider's circle, and the modes in cylindrical coordinates around its axis, by the
    understanding of coordinate systems in which they look most like those of a disc.

    Parameters
    ----------
    shapes : of the modes
    sets : datasets with nodes and coordinate systems
    r_0 : m
    length : m in the file's unit of length
    axis, centre : unit vector, and point in m; found if they are None

    Raises
    ------
    ParameterError
        If the nodes have no coordinates, or do not lie around the circle.
    """
    nodes = read_nodes(sets)
    moving = np.isin(nodes.labels, np.concatenate([shape.nodes for shape in shapes]))
    nodes = _chosen(nodes, moving)
    contents = contents_of(sets)
    hint = _hint_of_units(sets, length)
    if len(nodes.labels) < 3:
        rule = "must give coordinates of the nodes that move, datasets 15 or 2411. "
        raise ParameterError(Fault((), "", rule + contents))
    readings = [*_readings(nodes, read_systems(sets))]
    best: Placed | None = None
    most = -1.0
    fault: ParameterError | None = None
    for reading in readings:
        places = reading.places * length
        try:
            circle = find_circle(places, r_0, axis, centre, contents + hint)
        except ParameterError as error:
            fault = fault or error
            continue
        motions = [_motion(shape, nodes, reading, circle, places) for shape in shapes]
        likeness = float(np.mean([disc_likeness(motion, circle, places) for motion in motions]))
        if likeness > most + BETTER:
            best = Placed(places, circle, motions, reading.text)
            most = likeness
    if best is None:
        assert fault is not None
        raise fault
    if len(readings) == 1:  # all coordinate systems are the global one
        return best._replace(systems="")
    return best


def _hint_of_units(sets: Iterable[DataSet], length: float) -> str:
    """What to do if a file without units, whose coordinates count as m, has others."""
    states_units = any(data.number == 164 for data in sets)
    if states_units or length != 1.0:
        return ""
    return '; give units=("mm", "N") if the file is in mm'


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
    kinds = {"as the format has them": nodes.in_system}
    if have_own_systems(np.unique(nodes.defined_in).tolist(), systems):
        kinds["in other systems than the format has"] = ~nodes.in_system
    for words, in_system in kinds.items():
        places = positions(nodes, systems, in_system)
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
