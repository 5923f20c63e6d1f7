"""The mesh of a disc's section: rectangles divided into quadrilaterals."""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from disc_model.arrays import Array
from disc_model.display import brought
from disc_model.errors import Fault, ParameterError, require
from disc_model.units import is_number

if TYPE_CHECKING:
    from skfem import MeshQuad

MOST_ELEMENTS = 100_000  # in the rectangle around a section; more indicate a mistake in units


def mesh_of(rectangles: Iterable[tuple[float, float, float, float]], size: float) -> MeshQuad:
    """Mesh a union of rectangles (r from, r to, z from, z to), m, with a line of nodes along every
    edge of each; `size`: m, largest edge of an element."""
    mesh_type = brought("skfem", "fe").MeshQuad
    boxes = [tuple(map(float, rectangle)) for rectangle in rectangles]
    for i, box in enumerate(boxes or [()]):
        if not _is_rectangle(box):
            rule = "must be (r from, r to, z from, z to) with 0 < r from < r to and z from < z to"
            raise ParameterError(Fault.of(("rectangles", str(i)), box, rule))
    require((is_number(size) and size > 0, "size", size, "must be > 0"))

    inner, outer, low, high = zip(*boxes, strict=True)
    columns = (max(outer) - min(inner)) / size
    rows = (max(high) - min(low)) / size
    count = columns * rows
    rule = f"must give at most {MOST_ELEMENTS:,} elements, not {count:.2g}: "
    rule += "size and rectangles are in m"
    require((count <= MOST_ELEMENTS, "size", size, rule))

    radii = _divided({*inner, *outer}, size)
    heights = _divided({*low, *high}, size)
    mesh = mesh_type.init_tensor(radii, heights)
    r, z = mesh.p[:, mesh.t].mean(axis=1)
    inside = np.zeros(r.shape, dtype=bool)
    for r_from, r_to, z_from, z_to in boxes:
        inside |= (r_from < r) & (r < r_to) & (z_from < z) & (z < z_to)
    return mesh.remove_elements(np.flatnonzero(~inside))


def _is_rectangle(box: tuple[float, ...]) -> bool:
    """Whether these are the edges of a rectangle of finite size beside the axis."""
    if len(box) != 4 or not all(map(math.isfinite, box)):
        return False
    r_from, r_to, z_from, z_to = box
    return 0 < r_from < r_to and z_from < z_to


def _divided(edges: set[float], size: float) -> Array:
    """Coordinates with every edge among them, and no gap larger than `size`."""
    ends = sorted(edges)
    parts = []
    for a, b in pairwise(ends):
        count = math.ceil((b - a) / size)
        parts.append(np.linspace(a, b, count + 1)[:-1])
    return np.concatenate([*parts, ends[-1:]])


def pieces_of(mesh: Any) -> int:
    """Number of parts of a mesh that have no node in common."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    size = mesh.p.shape[1]
    links = coo_matrix((np.ones(mesh.facets.shape[1]), mesh.facets), shape=(size, size))
    _, labels = connected_components(links, directed=False)
    return len(np.unique(labels[mesh.t]))
