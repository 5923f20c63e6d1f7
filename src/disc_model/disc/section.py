"""Discs from a drawing with a hat: modes of a solid of revolution by finite elements of its
section.

With u_r cos(l theta), u_z cos(l theta) and u_theta sin(l theta) the elasticity of a solid of
revolution separates into one problem on the section for each number l of nodal diameters. Shapes
are mass-normalised over the whole solid.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from itertools import pairwise
from typing import Any

import numpy as np
import pandas as pd
from scipy.sparse import coo_matrix, csgraph, linalg

from disc_model.arrays import Array, Indices
from disc_model.display import brought
from disc_model.errors import require
from disc_model.parameters import Disc, Parameters
from disc_model.units import is_number

MOST_ELEMENTS = 100_000  # in the rectangle around a section; more indicate a mistake in units
SAME_PLACE = 1e-9  # m; the slider must run through a node of the mesh
MOST_EQUAL = 64  # modes of equal nodal diameters; more indicate a mistake in units
MOST_DIAMETERS = 60  # of the modes of a `Disc`
UNMOVED = 1e-6  # share of the largest amplitude below which a mode moves in the disc's plane alone


def disc_of_section(
    rectangles: Iterable[Iterable[float]],
    size: float,
    material: Mapping[str, Any],
    clamped: Callable[[Array], Any],
    slider: Any,
    highest_Hz: float,
) -> Disc:
    """Find the modes of a solid of revolution that move under the slider, see
    `disc_model.Disc.from_section`."""
    solid = Parameters(N=0, Omega=0, normalization="orthonormal", **material)
    is_frequency = is_number(highest_Hz) and 0 < highest_Hz < math.inf
    require((is_frequency, "highest_Hz", highest_Hz, "must be finite and > 0"))
    mesh = mesh_of(rectangles, size)
    skfem = brought("skfem", "fe")
    element = skfem.ElementComposite(*[skfem.ElementQuad2()] * 3)
    basis = skfem.Basis(mesh, element, intorder=6)
    measured, radii, side = _measured(basis, slider)
    held = basis.get_dofs(lambda x: np.broadcast_to(clamped(x), x.shape[1:])).all()
    rule = "must hold nodes of the section: coordinates are in m"
    require((len(held) > 0, "clamped", len(held), rule))

    tables = []
    for l in range(MOST_DIAMETERS + 1):
        omega, moves = _harmonic(basis, l, solid, held, measured, math.tau * highest_Hz)
        if l > 1 and len(omega) == 0:  # more nodal diameters only stiffen the disc
            break
        columns = {
            "omega": omega,
            "diameters": l,
            "circles": range(len(omega)),
            "amplitude": moves[:, 0],
            # the half of a pair that moves as sin(l theta) has u_theta = -v cos(l theta); seen from
            # below, displacement towards the slider and the sense of rotation are reversed
            "tangential": side * moves[:, 1],
            "shapes": moves[:, 2:].tolist(),
        }
        tables.append(pd.DataFrame(columns))
    modes = pd.concat(tables).sort_values("omega")
    moving = modes[modes["amplitude"] > UNMOVED * modes["amplitude"].max()]
    rule = "must be above a mode that moves under the slider"
    require((len(moving), "highest_Hz", highest_Hz, rule))
    damping_ratios = [solid.damping_ratio] * len(moving)
    fields: Any = moving.to_dict("list")
    return Disc(**fields, damping_ratio=damping_ratios, radii=radii.tolist())


def mesh_of(rectangles: Iterable[Iterable[float]], size: float) -> Any:
    """Mesh a union of rectangles (r from, r to, z from, z to), m, with a line of nodes along every
    edge of each; `size`: m, largest edge of an element."""
    boxes = np.array([*rectangles], float).reshape(-1, 4)
    inner, outer, low, high = boxes.T
    is_section = boxes.size and np.all((inner > 0) & (inner < outer) & (low < high))
    rule = (
        "must be rectangles (r from, r to, z from, z to) with 0 < r from < r to and z from < z to"
    )
    is_size = is_number(size) and size > 0
    require((is_section, "section", rectangles, rule), (is_size, "size", size, "must be > 0"))
    elements = np.ptp(boxes[:, :2]) * np.ptp(boxes[:, 2:]) / size**2
    rule = f"must give at most {MOST_ELEMENTS:,} elements: size and rectangles are in m"
    require((elements <= MOST_ELEMENTS, "size", size, rule))

    def is_inside(middle: Array) -> Any:
        r, z = middle[..., None]
        return np.any((inner < r) & (r < outer) & (low < z) & (z < high), axis=1)

    lines = [_divided(ends, size) for ends in (boxes[:, :2], boxes[:, 2:])]
    mesh = brought("skfem", "fe").MeshQuad.init_tensor(*lines).restrict(is_inside)
    links = coo_matrix((np.ones(mesh.facets.shape[1]), mesh.facets), shape=[mesh.p.shape[1]] * 2)
    is_whole = csgraph.connected_components(links, directed=False)[0] == 1
    rule = "must be one piece: the rectangles must share edges"
    require((is_whole, "section", rectangles, rule))
    return mesh


def _divided(ends: Array, size: float) -> Array:
    """Coordinates with all ends among them, and no gap larger than `size`."""
    gaps = pairwise(np.unique(ends))
    parts = [np.linspace(a, b, math.ceil((b - a) / size) + 1) for a, b in gaps]
    return np.unique(np.concatenate(parts))


def _measured(basis: Any, slider: Any) -> tuple[Indices, Array, int]:
    """What is read from the shapes of the section: the numbers of the unknowns, namely displacement of the
    slider's node normal to the disc and along its path, then vertical displacements of the nodes at
    its height; radii of these nodes, m; and 1 if the slider is on the lower face, -1 on the upper one."""
    mesh = basis.mesh
    require((np.shape(slider) == (2,), "slider", slider, "must be two numbers, r and z"))
    apart = np.hypot(*(mesh.p.T - slider).T)
    node = apart.argmin()
    require((apart[node] < SAME_PLACE, "slider", slider, "must be a node of the mesh"))

    touching = mesh.t[:, np.any(mesh.t == node, axis=0)]
    side = 2 * int(mesh.p[1, touching].mean() > slider[1]) - 1
    vertical = basis.split_indices()[1]
    r, z = basis.doflocs[:, vertical]
    level = np.abs(z - slider[1]) < SAME_PLACE
    radii, first = np.unique(r[level], return_index=True)
    return np.concatenate([basis.nodal_dofs[1:, node], vertical[level][first]]), radii, side


def _harmonic(
    basis: Any, l: int, solid: Parameters, held: Any, measured: Indices, highest: float
) -> tuple[Array, Array]:
    """Find the modes with l nodal diameters up to the highest frequency (rad/s): their frequencies,
    and values of the measured unknowns (modes, unknowns), of which the first is not negative."""
    stiffness, mass = _matrices(basis, l, solid)
    if l == 0:  # rotation about the axis is uncoupled from the other displacements
        held = np.union1d(held, basis.split_indices()[2])
    free = basis.complement_dofs(held)
    K, M = (matrix[free][:, free].tocsc() for matrix in (stiffness, mass))

    # twice as many modes, until one is above the highest frequency
    count = 4
    most = min(MOST_EQUAL, len(free) - 1)
    squares = shapes = np.zeros(0)
    while count < 2 * most and not squares.max(initial=0.0) > highest**2:
        squares, shapes = linalg.eigsh(K, min(count, most), M, sigma=0.0, v0=np.ones(len(free)))
        count *= 2
    is_above = squares.max() > highest**2 or most < MOST_EQUAL
    rule = (
        f"must be below {most} modes of {l} nodal diameters: lengths in m, E in Pa, rho in kg/m^3"
    )
    require((is_above, "highest_Hz", highest / math.tau, rule))

    order = np.argsort(squares)
    order = order[squares[order] <= highest**2]
    whole = np.zeros((basis.N, len(order)))
    whole[free] = shapes[:, order]
    moves = whole[measured].T
    return np.sqrt(squares[order]), np.where(moves[:, :1] < 0, -moves, moves)


def _matrices(basis: Any, l: int, solid: Parameters) -> tuple[Any, Any]:
    """Stiffness and mass matrices of the solid for one harmonic."""
    form = brought("skfem", "fe").BilinearForm
    lame = solid.E * solid.nu / ((1 + solid.nu) * (1 - 2 * solid.nu))
    shear = solid.E / 2 / (1 + solid.nu)
    angle = math.pi * (1 + (l == 0))  # of cos^2(l theta)

    def strains(r: Any, u: Any, w: Any, v: Any) -> Array:
        """Three normal strains, then the doubled shear strains, of u_r, u_z and u_theta."""
        normal = (u.grad[0], w.grad[1], (u + l * v) / r)
        in_section = u.grad[1] + w.grad[0]
        in_plane = v.grad[0] - (l * u + v) / r
        across = v.grad[1] - l * w / r
        return np.array([*normal, in_section, in_plane, across])

    def energy(*shapes: Any) -> Any:
        r = shapes[-1].x[0]
        one, other = strains(r, *shapes[:3]), strains(r, *shapes[3:6])
        product = one * other
        of_volume = lame * one[:3].sum(axis=0) * other[:3].sum(axis=0)
        of_shape = shear * (2 * product[:3].sum(axis=0) + product[3:].sum(axis=0))
        return r * (of_volume + of_shape)

    def inertia(*shapes: Any) -> Any:
        r = shapes[-1].x[0]
        return solid.rho * r * sum(a * b for a, b in zip(shapes[:3], shapes[3:6], strict=True))

    return form(energy).assemble(basis) * angle, form(inertia).assemble(basis) * angle
