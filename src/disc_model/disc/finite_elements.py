"""Modes of an axisymmetric solid by finite elements of its section: from the drawing of a disc with a hat to a `Disc`.

With u_r cos(l theta), u_z cos(l theta) and u_theta sin(l theta) the elasticity of a solid of revolution separates into
one problem on the section for each number l of nodal diameters.  Shapes are mass-normalised over the whole solid.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from disc_model.disc.plate import Array
from disc_model.disc.plausibility import warn_of_doubts
from disc_model.errors import Fault, ParameterError, require
from disc_model.parameters import Disc, Parameters
from disc_model.units import is_number

if TYPE_CHECKING:
    from skfem import MeshQuad

SAME_PLACE = 1e-9  # m; the slider must run through a node of the mesh
# more indicate a mistake in units
MOST_ELEMENTS = 100_000  # in the rectangle around a section
MOST_MODES = 64  # with equal nodal diameters


def section(rectangles: Iterable[tuple[float, float, float, float]], size: float) -> MeshQuad:
    """A mesh of a union of rectangles (r from, r to, z from, z to), m, with a line of nodes along every edge of each;
    `size`: m, largest edge of an element."""
    mesh_type = _skfem().MeshQuad
    numbers = [tuple(map(float, rectangle)) for rectangle in rectangles]
    for i, box in enumerate(numbers or [()]):
        if not (len(box) == 4 and 0 < box[0] < box[1] < math.inf and -math.inf < box[2] < box[3] < math.inf):
            rule = "must be (r from, r to, z from, z to) with 0 < r from < r to and z from < z to"
            raise ParameterError(Fault.of(("rectangles", str(i)), box, rule))
    require((is_number(size) and size > 0, "size", size, "must be > 0"))
    inner, outer, low, high = zip(*numbers, strict=True)
    count = (max(outer) - min(inner)) / size * ((max(high) - min(low)) / size)
    rule = f"must give at most {MOST_ELEMENTS:,} elements, not {count:.2g}: size and rectangles are in m"
    require((count <= MOST_ELEMENTS, "size", size, rule))
    axes = [_divided({edge for box in numbers for edge in box[i : i + 2]}, size) for i in (0, 2)]
    mesh = mesh_type.init_tensor(*axes)
    r, z = mesh.p[:, mesh.t].mean(axis=1)
    inside = np.any([(a < r) & (r < b) & (c < z) & (z < d) for a, b, c, d in numbers], axis=0)
    return mesh.remove_elements(np.flatnonzero(~inside))


def _divided(edges: set[float], size: float) -> Array:
    """Coordinates with every edge among them, and no gap larger than ``size``."""
    ends = sorted(edges)
    parts = [np.linspace(a, b, math.ceil((b - a) / size) + 1)[:-1] for a, b in itertools.pairwise(ends)]
    return np.concatenate([*parts, ends[-1:]])


def disc_of_section(
    mesh: MeshQuad, material: Mapping[str, Any], clamped: Callable[[Array], Any], slider: Any, highest_Hz: float
) -> Disc:
    """The modes of a solid of revolution that move under the slider, see `disc_model.Disc.from_section`."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    skfem = _skfem()
    iron = Parameters(N=0, Omega=0, normalization="orthonormal", **material)
    is_point = isinstance(slider, tuple | list) and len(slider) == 2 and all(map(is_number, slider))
    is_mesh = isinstance(mesh, skfem.MeshQuad)
    require(
        (is_mesh, "section", mesh, "must be rectangles, with their size of an element, or a mesh of quadrilaterals"),
        (is_point, "slider", slider, "must be two numbers, r and z"),
        (is_number(highest_Hz) and 0 < highest_Hz < math.inf, "highest_Hz", highest_Hz, "must be finite and > 0"),
    )
    element = skfem.ElementComposite(*[skfem.ElementQuad2()] * 3)
    basis = skfem.Basis(mesh, element, intorder=6)
    _, vertical, circular = basis.split_indices()
    apart = np.hypot(*(basis.doflocs[:, vertical] - np.array(slider)[:, None]))
    level = np.flatnonzero(np.abs(basis.doflocs[1, vertical] - slider[1]) < SAME_PLACE)
    radii, first = np.unique(basis.doflocs[0, vertical[level]], return_index=True)
    nearest = int(np.argmin(np.hypot(*(basis.doflocs[:, circular] - np.array(slider)[:, None]))))
    measured = np.array([vertical[int(np.argmin(apart))], circular[nearest], *vertical[level[first]]])
    links = coo_matrix((np.ones(mesh.facets.shape[1]), mesh.facets), shape=(mesh.p.shape[1],) * 2)
    pieces = len(np.unique(connected_components(links, directed=False)[1][mesh.t]))  # that have no node in common
    held = basis.get_dofs(lambda x: np.broadcast_to(clamped(x), x.shape[1:])).all()
    require(
        (apart.min() < SAME_PLACE, "slider", slider, "must be a node of the mesh"),
        (len(held) > 0, "clamped", len(held), "must hold nodes of the section: coordinates are in m"),
        (pieces == 1, "mesh", pieces, "must be one piece: the rectangles must share edges"),
    )
    warn_of_doubts(iron)
    rows: list[tuple[float, int, int, float, float, list[float]]] = []
    for l in range(61):
        omega, moves = _harmonic(basis, l, (iron.E, iron.nu, iron.rho), held, measured, math.tau * highest_Hz)
        if l > 1 and len(omega) == 0:  # more nodal diameters only stiffen the disc
            break
        # the sine of a mode has the displacement -v(sin(l theta) to cos(l theta)) along theta
        rows += [(w, l, i, a, 0.0 - v, shape) for i, (w, (a, v, *shape)) in enumerate(zip(omega, moves, strict=True))]
    largest = max((row[3] for row in rows), default=0.0)
    transverse = sorted(row for row in rows if row[3] > 1e-6 * largest)  # others move in the plane of the disc alone
    require((transverse, "highest_Hz", highest_Hz, "must be above a mode that moves under the slider"))
    omegas, diameters, circles, amplitudes, tangential, shapes = zip(*transverse, strict=True)
    return Disc(
        omega=omegas, diameters=diameters, circles=circles, amplitude=amplitudes, tangential=tangential,
        shapes=shapes, radii=radii.tolist(), damping_ratio=[float(material["damping_ratio"])] * len(transverse),
    )  # fmt: skip


def _harmonic(
    basis: Any, l: int, material: tuple[float, float, float], held: Any, measured: NDArray[np.intp], highest: float
) -> tuple[list[float], list[list[float]]]:
    """Frequencies up to the highest (rad/s) of the modes with l nodal diameters, and their values of the measured
    unknowns, the first of which the sign of a mode makes positive."""
    from scipy.sparse.linalg import eigsh

    stiffness, mass = _matrices(basis, l, *material)
    if l == 0:  # rotation about the axis is uncoupled from the other displacements
        held = np.union1d(held, basis.split_indices()[2])
    free, count = basis.complement_dofs(held), 4
    K, M = stiffness[free][:, free].tocsc(), mass[free][:, free].tocsc()
    while True:
        squares, shapes = eigsh(K, min(count, len(free) - 1), M, sigma=0.0, v0=np.ones(len(free)))
        if squares.max() > highest**2 or count >= len(free) - 1:
            break
        if count >= MOST_MODES:
            most = math.sqrt(squares.max()) / math.tau
            rule = f"must be below the {count} lowest modes of {l} nodal diameters, which end at {most:.3g} Hz: "
            rule += "lengths are in m, E in Pa, rho in kg/m^3"
            raise ParameterError(Fault.of(("highest_Hz",), highest / math.tau, rule))
        count *= 2
    order = np.argsort(squares)
    order = order[squares[order] <= highest**2]
    whole = np.zeros((basis.N, len(order)))
    whole[free] = shapes[:, order]
    moves = whole[measured].T
    return np.sqrt(squares[order]).tolist(), (np.where(moves[:, :1] < 0, -moves, moves)).tolist()


def _matrices(basis: Any, l: int, E: float, nu: float, rho: float) -> tuple[Any, Any]:
    """Stiffness and mass matrices of the solid for one harmonic."""
    form = _skfem().BilinearForm
    lame, shear = E * nu / ((1 + nu) * (1 - 2 * nu)), E / 2 / (1 + nu)
    angle = math.pi if l else 2 * math.pi  # of cos^2(l theta)

    def strain(u: Any, w: Any, v: Any, r: Any) -> tuple[Any, ...]:
        """Three normal strains, then the doubled shear strains; u, w, v are u_r, u_z, u_theta."""
        normal = (u.grad[0], w.grad[1], (u + l * v) / r)
        return (*normal, u.grad[1] + w.grad[0], v.grad[0] - (l * u + v) / r, v.grad[1] - l * w / r)

    def energy(u: Any, w: Any, v: Any, u_: Any, w_: Any, v_: Any, point: Any) -> Any:
        first, second = strain(u, w, v, point.x[0]), strain(u_, w_, v_, point.x[0])
        factors = [2 * shear] * 3 + [shear] * 3
        doubled = sum(c * a * b for c, a, b in zip(factors, first, second, strict=True))
        return (lame * sum(first[:3]) * sum(second[:3]) + doubled) * point.x[0]

    def inertia(u: Any, w: Any, v: Any, u_: Any, w_: Any, v_: Any, point: Any) -> Any:
        return rho * (u * u_ + w * w_ + v * v_) * point.x[0]

    return form(energy).assemble(basis) * angle, form(inertia).assemble(basis) * angle


def _skfem() -> Any:
    try:
        import skfem
    except ModuleNotFoundError:
        raise ModuleNotFoundError("finite elements need scikit-fem: pip install 'disc_model[fe]'") from None
    return skfem
