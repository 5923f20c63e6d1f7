"""Discs from a drawing with a hat: modes of a solid of revolution by finite elements of its
section.

With u_r cos(l theta), u_z cos(l theta) and u_theta sin(l theta) the elasticity of a solid of
revolution separates into one problem on the section for each number l of nodal diameters. Shapes
are mass-normalised over the whole solid.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from disc_model.arrays import Array
from disc_model.disc.files.mesh import pieces_of
from disc_model.display import brought
from disc_model.errors import Fault, ParameterError, require
from disc_model.parameters import Disc, Parameters
from disc_model.units import is_number

if TYPE_CHECKING:
    from skfem import MeshQuad

SAME_PLACE = 1e-9  # m; the slider must run through a node of the mesh
MOST_EQUAL = 64  # modes of equal nodal diameters; more indicate a mistake in units
MOST_DIAMETERS = 60  # of the modes of a `Disc`
UNMOVED = 1e-6  # share of the largest amplitude below which a mode moves in the disc's plane alone


class Material(NamedTuple):
    """An isotropic material: Pa, 1, kg/m^3."""

    E: float
    nu: float
    rho: float


class Points(NamedTuple):
    """What is read from the shapes of the section: numbers of unknowns of the finite elements.

    vertical, circular : displacements of the slider's node, normal to the disc and along its path
    level : vertical displacements of the nodes at the slider's height
    radii : m, where these nodes are
    below : whether the slider is on the lower face of the disc
    """

    vertical: int
    circular: int
    level: NDArray[np.intp]
    radii: Array
    below: bool

    @property
    def unknowns(self) -> NDArray[np.intp]:
        """All of them, in the order of the fields."""
        return np.concatenate([[self.vertical, self.circular], self.level])


class SectionMode(NamedTuple):
    """A mode of the solid: rad/s, its numbers of diameters and circles, and kg^-1/2."""

    omega: float
    diameters: int
    circles: int
    amplitude: float
    tangential: float
    shape: list[float]


def disc_of_section(
    mesh: MeshQuad,
    material: Mapping[str, Any],
    clamped: Callable[[Array], Any],
    slider: Any,
    highest_Hz: float,
) -> Disc:
    """Find the modes of a solid of revolution that move under the slider, see
    `disc_model.Disc.from_section`."""
    checked = Parameters(N=0, Omega=0, normalization="orthonormal", **material)
    _check_section(mesh, slider, highest_Hz)

    skfem = brought("skfem", "fe")
    element = skfem.ElementComposite(*[skfem.ElementQuad2()] * 3)
    basis = skfem.Basis(mesh, element, intorder=6)
    points = _points(basis, slider)
    held = basis.get_dofs(lambda x: np.broadcast_to(clamped(x), x.shape[1:])).all()
    rule = "must hold nodes of the section: coordinates are in m"
    pieces = pieces_of(mesh)
    require(
        (len(held) > 0, "clamped", len(held), rule),
        (pieces == 1, "mesh", pieces, "must be one piece: the rectangles must share edges"),
    )

    iron = Material(checked.E, checked.nu, checked.rho)
    modes = _modes(basis, iron, held, points, math.tau * highest_Hz)
    largest = max((mode.amplitude for mode in modes), default=0.0)
    moving = sorted(mode for mode in modes if mode.amplitude > UNMOVED * largest)
    rule = "must be above a mode that moves under the slider"
    require((moving, "highest_Hz", highest_Hz, rule))
    return Disc(
        omega=[mode.omega for mode in moving],
        diameters=[mode.diameters for mode in moving],
        circles=[mode.circles for mode in moving],
        amplitude=[mode.amplitude for mode in moving],
        tangential=[mode.tangential for mode in moving],
        damping_ratio=[float(material["damping_ratio"])] * len(moving),
        radii=points.radii.tolist(),
        shapes=[mode.shape for mode in moving],
    )


def _check_section(mesh: Any, slider: Any, highest_Hz: Any) -> None:
    """Refuse what is no mesh, no point or no frequency."""
    is_mesh = isinstance(mesh, brought("skfem", "fe").MeshQuad)
    is_point = isinstance(slider, tuple | list) and len(slider) == 2 and all(map(is_number, slider))
    is_frequency = is_number(highest_Hz) and 0 < highest_Hz < math.inf
    rule = "must be rectangles, with their size of an element, or a mesh of quadrilaterals"
    require(
        (is_mesh, "section", mesh, rule),
        (is_point, "slider", slider, "must be two numbers, r and z"),
        (is_frequency, "highest_Hz", highest_Hz, "must be finite and > 0"),
    )


def _points(basis: Any, slider: tuple[float, float]) -> Points:
    """The unknowns of the slider's node, and those at its height."""
    _, vertical, circular = basis.split_indices()
    places = basis.doflocs[:, vertical]
    apart = np.hypot(places[0] - slider[0], places[1] - slider[1])
    require((apart.min() < SAME_PLACE, "slider", slider, "must be a node of the mesh"))

    nearest = int(np.argmin(apart))  # unknowns of each displacement are in the same order
    level = np.flatnonzero(np.abs(places[1] - slider[1]) < SAME_PLACE)
    radii, first = np.unique(places[0, level], return_index=True)
    return Points(
        vertical=int(vertical[nearest]),
        circular=int(circular[nearest]),
        level=vertical[level[first]],
        radii=radii,
        below=_is_below(basis.mesh, slider),
    )


def _is_below(mesh: Any, slider: tuple[float, float]) -> bool:
    """Whether all elements at the slider are above it, so that it runs on the lower face."""
    corners = mesh.p[:, mesh.t]  # (r and z, corner, element)
    low = corners.min(axis=1)
    high = corners.max(axis=1)
    touching = np.all(
        (low <= np.reshape(slider, (2, 1)) + SAME_PLACE)
        & (high >= np.reshape(slider, (2, 1)) - SAME_PLACE),
        axis=0,
    )
    return bool(np.all(low[1, touching] >= slider[1] - SAME_PLACE))


def _modes(
    basis: Any, material: Material, held: Any, points: Points, highest: float
) -> list[SectionMode]:
    """All modes up to the highest frequency (rad/s), by nodal diameters."""
    # the half of a pair that moves as sin(l theta) has u_theta = -v cos(l theta); seen from below,
    # displacement towards the slider and the sense of rotation are reversed
    side = -1.0
    if points.below:
        side = 1.0
    modes = []
    for l in range(MOST_DIAMETERS + 1):
        omega, moves = _harmonic(basis, l, material, held, points.unknowns, highest)
        if l > 1 and len(omega) == 0:  # more nodal diameters only stiffen the disc
            break
        for circles, (frequency, values) in enumerate(zip(omega, moves, strict=True)):
            amplitude, circular, *shape = values.tolist()
            tangential = 0.0 + side * circular  # adding zero turns -0.0 into 0.0
            modes.append(SectionMode(frequency, l, circles, amplitude, tangential, shape))
    return modes


def _harmonic(
    basis: Any, l: int, material: Material, held: Any, measured: NDArray[np.intp], highest: float
) -> tuple[list[float], Array]:
    """Find the modes with l nodal diameters up to the highest frequency (rad/s): their frequencies,
    and values of the measured unknowns (modes, unknowns), of which the first is not negative."""
    from scipy.sparse.linalg import eigsh

    stiffness, mass = _matrices(basis, l, material)
    if l == 0:  # rotation about the axis is uncoupled from the other displacements
        held = np.union1d(held, basis.split_indices()[2])
    free = basis.complement_dofs(held)
    K = stiffness[free][:, free].tocsc()
    M = mass[free][:, free].tocsc()

    # twice as many modes, until one is above the highest frequency
    count = 4
    while True:
        sought = min(count, len(free) - 1)
        start = np.ones(len(free))
        squares, shapes = eigsh(K, sought, M, sigma=0.0, v0=start)
        if squares.max() > highest**2 or count >= len(free) - 1:
            break
        if count >= MOST_EQUAL:
            most = math.sqrt(squares.max()) / math.tau
            rule = f"must be below the {count} lowest modes of {l} nodal diameters, which end at "
            rule += f"{most:.3g} Hz: lengths are in m, E in Pa, rho in kg/m^3"
            raise ParameterError(Fault.of(("highest_Hz",), highest / math.tau, rule))
        count *= 2

    order = np.argsort(squares)
    order = order[squares[order] <= highest**2]
    whole = np.zeros((basis.N, len(order)))
    whole[free] = shapes[:, order]
    moves = whole[measured].T
    omega = np.sqrt(squares[order])
    upwards = np.where(moves[:, :1] < 0, -moves, moves)
    return omega.tolist(), upwards


def _matrices(basis: Any, l: int, material: Material) -> tuple[Any, Any]:
    """Stiffness and mass matrices of the solid for one harmonic."""
    form = brought("skfem", "fe").BilinearForm
    E, nu, rho = material
    lame = E * nu / ((1 + nu) * (1 - 2 * nu))
    shear = E / 2 / (1 + nu)
    angle = math.pi if l else 2 * math.pi  # of cos^2(l theta)

    def strain(u: Any, w: Any, v: Any, r: Any) -> tuple[Any, ...]:
        """Three normal strains, then the doubled shear strains; u, w, v are u_r, u_z, u_theta."""
        normal = (u.grad[0], w.grad[1], (u + l * v) / r)
        in_section = u.grad[1] + w.grad[0]
        in_plane = v.grad[0] - (l * u + v) / r
        across = v.grad[1] - l * w / r
        return (*normal, in_section, in_plane, across)

    def energy(u: Any, w: Any, v: Any, u_: Any, w_: Any, v_: Any, point: Any) -> Any:
        first = strain(u, w, v, point.x[0])
        second = strain(u_, w_, v_, point.x[0])
        factors = [2 * shear] * 3 + [shear] * 3
        terms = zip(factors, first, second, strict=True)
        of_shape = sum(c * a * b for c, a, b in terms)
        of_volume = lame * sum(first[:3]) * sum(second[:3])
        return (of_volume + of_shape) * point.x[0]

    def inertia(u: Any, w: Any, v: Any, u_: Any, w_: Any, v_: Any, point: Any) -> Any:
        return rho * (u * u_ + w * w_ + v * v_) * point.x[0]

    return form(energy).assemble(basis) * angle, form(inertia).assemble(basis) * angle
