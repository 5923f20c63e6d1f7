"""Units, coordinate systems and nodes of universal files: datasets 164, 18 and 2420, 15 and
2411."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from disc_model.disc.files.universal_sets import DataSet, integers, numbers_in, reals
from disc_model.disc.plate import Array
from disc_model.errors import Fault, ParameterError

FOOT = 1 / 0.3048  # per metre
POUND = 1 / 4.4482216152605  # per newton
KILOGRAM = 1 / 9.80665  # kilograms of force per newton
UNIT_CODES = {
    1: (1.0, 1.0),
    2: (FOOT, POUND),
    3: (1.0, KILOGRAM),
    4: (FOOT, POUND * 32.17404855643045),  # poundals
    5: (1e3, 1e3),
    6: (1e2, 1e2),
    7: (12 * FOOT, POUND),
    8: (1e3, KILOGRAM),
    9: (1.0, 1.0),
}
"""Units of length and force per m and N by the code of dataset 164, for files that leave out the
factors; I-deas takes centi-newtons with cm."""
CYLINDRICAL = 1  # type of a coordinate system; 0 is Cartesian, 2 spherical
SPHERICAL = 2
NOT_SQUARE = 1e-3  # greatest error of the products of a system's axes


class FileUnits(NamedTuple):
    """Units of a file: m and N in one of its units of length and force, and how they are known."""

    length: float
    force: float
    source: str

    @property
    def mass(self) -> float:
        """kg in the file's unit of mass, which is consistent: force times s^2 over length."""
        return self.force / self.length


class System(NamedTuple):
    """A coordinate system: its type, its axes in rows, and its origin in the file's unit."""

    kind: int
    axes: Array
    origin: Array

    @property
    def is_global(self) -> bool:
        """Whether it is the global system itself."""
        same = np.allclose(self.axes, np.eye(3), atol=1e-9) and not self.origin.any()
        return self.kind == 0 and bool(same)


@dataclass(frozen=True)
class Nodes:
    """The nodes of a file.

    Attributes
    ----------
    labels : (n,), numbers of the nodes
    coordinates : (n, 3), as they are written, in the file's unit of length
    defined_in, moves_in : (n,), numbers of the systems of coordinates and of displacements
    in_system : whether the format has coordinates in the systems of definition, dataset 15
    """

    labels: NDArray[np.int64]
    coordinates: Array
    defined_in: NDArray[np.int64]
    moves_in: NDArray[np.int64]
    in_system: NDArray[np.bool_]


def read_units(sets: Iterable[DataSet], stated: tuple[float, float] | None) -> FileUnits:
    """Read the units of a file; `stated`: m and N in units of a file that has no dataset 164."""
    found = {_units_of(data) for data in sets if data.number == 164}
    if found and stated is not None:
        rule = "must be left out: the file states its units in dataset 164"
        raise ParameterError(Fault.of(("units",), stated, rule))
    if len(found) > 1:
        raise ParameterError(Fault((), "", "must have one system of units, dataset 164"))
    if found:
        per_metre, per_newton = found.pop()
        text = f"{1 / per_metre:.6g} m and {1 / per_newton:.6g} N (dataset 164)"
        return FileUnits(1 / per_metre, 1 / per_newton, text)
    if stated is not None:
        length, force = stated
        return FileUnits(length, force, f"{length:.6g} m and {force:.6g} N, as stated")
    return FileUnits(1.0, 1.0, "m and N, because the file has no dataset 164")


def _units_of(data: DataSet) -> tuple[float, float]:
    """Units of length and force per m and N of a dataset 164."""
    head = "".join(data.lines[:1])[:10].strip()
    factors = numbers_in(data, 1)[:2].tolist()
    if len(factors) == 2 and all(0 < factor < math.inf for factor in factors):
        return factors[0], factors[1]
    if not head.isdigit() or int(head) not in UNIT_CODES:
        raise data.fault("must have the factors of its units, or a code from 1 to 9")
    return UNIT_CODES[int(head)]


def read_systems(sets: Iterable[DataSet]) -> dict[int, System]:
    """Read coordinate systems by their numbers."""
    systems: dict[int, System] = {}
    for data in sets:
        if data.number == 2420:
            systems |= _transformations(data)
        if data.number == 18:
            systems |= _systems_by_points(data, systems)
    return systems


def _transformations(data: DataSet) -> dict[int, System]:
    """Systems of a dataset 2420: each by its axes in the rows of a matrix, and its origin."""
    systems = {}
    for i in range(2, len(data.lines), 6):
        label, kind = integers(data, i, 2)[:2]
        rows = DataSet(data.number, data.place, data.lines[i + 2 : i + 6])
        matrix = numbers_in(rows, 0)
        if matrix.size != 12:
            raise data.fault(f"must have 12 numbers for coordinate system {label}")
        matrix = matrix.reshape(4, 3)
        axes = matrix[:3]
        if not np.allclose(axes @ axes.T, np.eye(3), atol=NOT_SQUARE):
            raise data.fault(f"must have perpendicular unit axes for coordinate system {label}")
        systems[label] = System(kind, axes, matrix[3])
    return systems


def _systems_by_points(data: DataSet, known: dict[int, System]) -> dict[int, System]:
    """Systems of a dataset 18: each by its origin, a point on its x axis, and one in its x-z
    plane."""
    systems: dict[int, System] = {}
    for i in range(0, len(data.lines) - 3, 4):
        label, kind, reference = integers(data, i, 3)[:3]
        points = np.array([*reals(data, i + 2), *reals(data, i + 3)])
        if points.size != 9:
            raise data.fault(f"must have nine coordinates for coordinate system {label}")
        origin, on_x, on_xz = points.reshape(3, 3)
        base = (known | systems).get(reference)
        if base is not None:
            origin, on_x, on_xz = (
                point @ base.axes + base.origin for point in (origin, on_x, on_xz)
            )
        x = on_x - origin
        y = np.cross(on_xz - origin, x)
        axes = np.stack([x, y, np.cross(x, y)])
        lengths = np.linalg.norm(axes, axis=1, keepdims=True)
        if not np.all(lengths > 0):
            raise data.fault(f"must have three points apart for coordinate system {label}")
        systems[label] = System(kind, axes / lengths, origin)
    return systems


def read_nodes(sets: Iterable[DataSet]) -> Nodes:
    """Read the nodes of all datasets 15 and 2411; of one that is there twice the last counts."""
    rows: dict[int, tuple[Array, bool]] = {}
    for data in sets:
        if data.number not in (15, 2411):
            continue
        values = numbers_in(data, 0)
        if values.size % 7:
            raise data.fault("must have seven numbers for each node: four whole ones, x, y and z")
        for row in values.reshape(-1, 7):
            rows[int(row[0])] = (row, data.number == 15)
    table = np.array([row for row, _ in rows.values()]).reshape(-1, 7)
    if not np.all(np.isfinite(table)):
        raise ParameterError(Fault((), "", "must have finite coordinates of nodes"))
    return Nodes(
        labels=table[:, 0].astype(np.int64),
        coordinates=table[:, 4:],
        defined_in=table[:, 1].astype(np.int64),
        moves_in=table[:, 2].astype(np.int64),
        in_system=np.array([in_system for _, in_system in rows.values()], dtype=bool),
    )


def positions(nodes: Nodes, systems: dict[int, System], in_systems: NDArray[np.bool_]) -> Array:
    """Global positions of nodes (n, 3), where ``in_systems`` by their systems of definition."""
    places = nodes.coordinates.copy()
    for label in np.unique(nodes.defined_in[in_systems]):
        system = systems.get(int(label))
        if system is not None:
            chosen = in_systems & (nodes.defined_in == label)
            places[chosen] = _cartesian(system, places[chosen]) @ system.axes + system.origin
    return places


def _cartesian(system: System, coordinates: Array) -> Array:
    """Coordinates of a system as x, y, z along its axes."""
    if system.kind == SPHERICAL:
        rule = "must have nodes in Cartesian or cylindrical coordinate systems, not spherical ones"
        raise ParameterError(Fault((), "", rule))
    if system.kind != CYLINDRICAL:
        return coordinates
    r, angle, z = coordinates.T
    if np.abs(angle).max(initial=0.0) > math.tau * 1.01:  # degrees, as I-deas writes them
        angle = np.radians(angle)
    return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=1)


def directions(nodes: Nodes, systems: dict[int, System], places: Array) -> Array:
    """Global directions of the three displacements of nodes in their own systems, in rows:
    (n, 3, 3)."""
    rows = np.broadcast_to(np.eye(3), (len(places), 3, 3)).copy()
    for label in np.unique(nodes.moves_in):
        system = systems.get(int(label))
        if system is None:
            continue
        chosen = nodes.moves_in == label
        rows[chosen] = system.axes
        if system.kind == CYLINDRICAL:
            local = (places[chosen] - system.origin) @ system.axes.T
            angle = np.arctan2(local[:, 1], local[:, 0])
            cosine = np.cos(angle)[:, None]
            sine = np.sin(angle)[:, None]
            x, y, z = system.axes
            radial = cosine * x + sine * y
            tangential = cosine * y - sine * x
            axial = np.broadcast_to(z, (len(angle), 3))
            rows[chosen] = np.stack([radial, tangential, axial], axis=1)
    return rows


def have_own_systems(labels: Sequence[int], systems: dict[int, System]) -> bool:
    """Whether any of these systems differs from the global one."""
    chosen = [systems[label] for label in labels if label in systems]
    return not all(system.is_global for system in chosen)
