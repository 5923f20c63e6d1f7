"""Discs given by their modes: tables as CSV files, universal files of modal tests, and finite
elements."""

from __future__ import annotations

import csv
import itertools
import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from disc_model.disc.plate import Array, modal_damping, mode_arrays, modes_of_table
from disc_model.disc.plausibility import warn_of_doubts
from disc_model.display import brought
from disc_model.errors import Fault, ParameterError, as_text, raise_faults, require, suggestion
from disc_model.parameters import Disc, Parameters
from disc_model.units import is_number

if TYPE_CHECKING:
    import os

    from skfem import MeshQuad

COLUMNS = {
    "diameters": ("diameters", 1.0),
    "frequency_Hz": ("omega", math.tau),
    "omega_rad_per_s": ("omega", 1.0),
    "amplitude_per_sqrt_kg": ("amplitude", 1.0),
    "damping_ratio": ("damping_ratio", 1.0),
    "circles": ("circles", 1.0),
    "tangential_per_sqrt_kg": ("tangential", 1.0),
}
"""Field of a `Disc` that each column of a table gives, and the factor on its values; shapes have further columns."""
SHAPE = re.compile(
    r"shape_at_(\d*\.?\d+(?:e-?\d+)?)_m"
)  # name of the column with the shapes at a radius
STATIC_COMPLIANCE = "static_compliance_m_per_N"  # value that a comment line may give
SAME_RADIUS = 1e-3  # relative difference of the radii of nodes on one circle
SAME_PAIR = 0.05  # relative difference of the frequencies of the two halves of a pair


def read_disc(path: str | os.PathLike[str]) -> Disc:
    """Read a disc from a table of its modes, see `disc_model.Disc.from_csv`."""
    try:
        lines = Path(path).read_text(encoding="utf-8-sig").splitlines()
    except (OSError, ValueError) as error:
        raise _fault(path, f"must be a text file that can be read ({error})") from None
    stated = re.compile(rf"\s*#\s*{STATIC_COMPLIANCE}\s*[:=]\s*(\S+)\s*")
    static = [match[1] for line in lines if (match := stated.fullmatch(line))]
    # empty rows, which spreadsheets append, are skipped
    cells = csv.reader(
        [line for line in lines if not line.lstrip().startswith("#")], skipinitialspace=True
    )
    table = [row for row in ([cell.strip() for cell in row] for row in cells) if any(row)]
    try:
        return _disc(*(table or [[]]), static_compliance=static[0] if static else None)
    except ParameterError as error:
        raise ParameterError(
            *(fault.inside((Path(path).name,)) for fault in error.faults)
        ) from None


def read_uff(path: str | os.PathLike[str], r_0: float) -> Disc:
    """Read mode shapes from a universal file, see `disc_model.Disc.from_uff`."""
    pyuff = brought("pyuff", "uff")
    try:
        sets = np.atleast_1d(pyuff.UFF(str(path)).read_sets()).tolist()
    except Exception as error:  # pyuff raises what the text of the file happens to lead to
        raise _fault(path, f"must be a universal file that can be read ({error})") from None
    positions = {
        int(number): position
        for data in sets
        if data["type"] in (15, 2411)
        for number, *position in zip(
            *(data[name] for name in ("node_nums", "x", "y", "z")), strict=True
        )
    }
    modes = [_uff_mode(data, positions, r_0, path) for data in sets if data["type"] == 55]
    pairs: list[list[dict[str, Any]]] = []
    for mode in sorted((mode for mode in modes if mode), key=lambda mode: mode["omega"]):
        alone = (
            pair
            for pair in pairs
            if len(pair) == 1 and pair[0]["diameters"] == mode["diameters"] > 0
        )
        near = [
            pair for pair in alone if mode["omega"] - pair[0]["omega"] < SAME_PAIR * mode["omega"]
        ]
        if near:
            near[0].append(mode)
        else:
            pairs.append([mode])
    if not pairs:
        raise _fault(path, "must hold a mode across the disc, as a dataset 55")
    radii = sorted(set.intersection(*({*half["shape"]} for pair in pairs for half in pair)))
    shapes = [
        [float(np.mean([half["shape"][r] for half in pair])) for r in radii] for pair in pairs
    ]
    means: dict[str, Any] = {
        name: [float(np.mean([half[name] for half in pair])) for pair in pairs]
        for name in ("omega", "damping_ratio", "amplitude")
    }
    known: dict[str, Any] = {"radii": radii, "shapes": shapes} if len(radii) > 1 else {}
    return Disc(diameters=[pair[0]["diameters"] for pair in pairs], **means, **known)


def _uff_mode(
    data: dict[str, Any], positions: dict[int, list[float]], r_0: float, path: object
) -> dict[str, Any] | None:
    """Diameters, frequency, damping, amplitude and shape of a dataset 55; None of one that moves in
    the plane."""
    if data["analysis_type"] == 2:
        omega, damping, mass = math.tau * data["freq"], data["modal_damp_vis"], data["modal_m"]
    else:  # a complex mode: its pole, and modal a
        pole = complex(data["eig"])
        omega, damping = abs(pole), -pole.real / abs(pole)
        mass = (complex(data["modal_a"]) / (2j * pole.imag)).real
    moves = np.real(data["r3"])
    known = [i for i, node in enumerate(data["node_nums"]) if int(node) in positions]
    x, y, _ = np.transpose(
        [positions[int(data["node_nums"][i])] for i in known] or np.zeros((0, 3))
    )
    radius, angle, moves = np.hypot(x, y), np.arctan2(y, x), moves[known]
    circle = np.abs(radius - r_0) < SAME_RADIUS * r_0
    rule = (
        f"must give coordinates in m of 3 or more nodes at the radius {r_0:g} m, dataset 15 or 2411"
    )
    require((circle.sum() >= 3, Path(str(path)).name, int(circle.sum()), rule))
    require((mass > 0, "modal mass", mass, "must be > 0: shapes need a scale"))
    fits = []  # of each harmonic: the sum of squares that it leaves, its number, and its cosine and sine
    for order in range(min(60, (int(circle.sum()) - 1) // 2) + 1):
        waves = np.stack([np.cos(order * angle), np.sin(order * angle)], axis=1)[circle]
        solution = np.linalg.lstsq(waves, moves[circle], rcond=None)[0]
        fits.append(
            (float(np.sum((moves[circle] - waves @ solution) ** 2)), order, *solution.tolist())
        )
    rest, l, cosine, sine = min(fits)
    if rest > 0.5 * float(np.sum(moves[circle] ** 2)):
        return None
    amplitude, turn, scale = math.hypot(cosine, sine), math.atan2(sine, cosine), 1 / math.sqrt(mass)
    shape = {}
    for r in np.unique(np.round(radius, 6)):
        on_radius = np.abs(radius - r) < SAME_RADIUS * r_0
        if on_radius.sum() > 2 * l:
            wave = np.cos(l * angle[on_radius] - turn)
            shape[float(r)] = scale * float(wave @ moves[on_radius] / (wave @ wave))
    numbers = {"omega": omega, "damping_ratio": float(damping), "amplitude": scale * amplitude}
    return {"diameters": l, "shape": shape, **numbers}


def _disc(names: list[str], *rows: list[str], static_compliance: str | None) -> Disc:
    """The disc of a table; a fault in a number names its column, mode and cell."""
    rule = f"values: must be as many as columns, {len(names)}"
    uneven = [
        f"mode {i} has {len(row)} {rule}" for i, row in enumerate(rows, 1) if len(row) != len(names)
    ]
    raise_faults(_column_faults(names) or uneven[:3])
    cells = {name: [row[i] for row in rows] for i, name in enumerate(names)}
    values: dict[str, Any] = {"static_compliance": static_compliance}
    for name, (field, factor) in COLUMNS.items():
        if name in cells:
            values[field] = [_number(cell, factor) for cell in cells[name]]
    shapes = sorted(
        (float(match[1]), i) for i, name in enumerate(names) if (match := SHAPE.fullmatch(name))
    )
    if shapes:
        values["radii"] = [r for r, _ in shapes]
        values["shapes"] = [[_number(row[i]) for _, i in shapes] for row in rows]
    try:
        disc = Disc(**values)
    except ParameterError as error:
        raise ParameterError(*(_of_table(fault, cells) for fault in error.faults)) from None
    static, modal = disc.static_compliance, modes_of_table(disc).flexibility
    if static is not None and static < modal * (
        1 - 1e-9
    ):  # both may be the same sum with different rounding
        rule = f"must not be less than what the modes give at the slider, {modal:.6g} m/N"
        raise ParameterError(Fault.of((STATIC_COMPLIANCE,), static, rule))
    return disc


def _number(cell: str, factor: float = 1.0) -> float | str:
    """The number in a cell; `Disc` refuses other text."""
    try:
        return float(cell) * factor
    except ValueError:
        return cell


def _of_table(fault: Fault, columns: Mapping[str, Sequence[str]]) -> Fault:
    """A fault in a number of a `Disc` with column, cell and mode of the table."""
    name = next(
        (name for name in columns if name in COLUMNS and COLUMNS[name][0] == fault.path[0]), ""
    )
    if not name or len(fault.path) != 2:
        return fault
    i = int(fault.path[1])
    unit = " rad/s" if name == "frequency_Hz" and "within" in fault.rule else ""
    return Fault.of((name,), columns[name][i], f"{fault.rule}{unit} (mode {i + 1})")


def damping_ratios(p: Parameters) -> Array:
    """Damping ratios of the modes of a case; of a disc that is given by a table, exactly those of
    the table."""
    if p.disc is not None:
        return np.array(p.disc.damping_ratio)
    with np.errstate(invalid="ignore"):
        return modal_damping(p) / (2 * mode_arrays(p).omega)


def table_text(disc: Disc) -> str:
    """A disc as a table."""
    fields = ("diameters", "circles", "omega", "amplitude", "damping_ratio", "tangential")
    names = {field: name for name, (field, factor) in COLUMNS.items() if factor == 1.0}
    columns: dict[str, Any] = {
        names[field]: column for field in fields if (column := getattr(disc, field))
    }
    columns |= {
        f"shape_at_{r}_m": shape
        for r, shape in zip(disc.radii, zip(*disc.shapes, strict=True), strict=True)
    }
    rows = [[*columns], *zip(*columns.values(), strict=True)]
    comment = (
        ""
        if disc.static_compliance is None
        else f"# {STATIC_COMPLIANCE}: {disc.static_compliance}\n"
    )
    return comment + "".join(",".join(map(str, row)) + "\n" for row in rows)


def _column_faults(names: list[str]) -> list[Fault]:
    """Faults of the names of the columns."""
    faults = []
    for name in names:
        if name not in COLUMNS and not SHAPE.fullmatch(name):
            if ";" in name or "\t" in name:
                return [
                    Fault.of(
                        ("columns",), name, "must be separated by commas, with points in numbers"
                    )
                ]
            faults.append(
                Fault.of(("columns",), name, f"unknown column{suggestion(name, list(COLUMNS))}")
            )
    targets = [COLUMNS[name][0] for name in names if name in COLUMNS]
    for target in dict.fromkeys(["diameters", "omega", "amplitude", *targets]):
        if (count := targets.count(target)) != 1:
            wanted = " or ".join(name for name, (which, _) in COLUMNS.items() if which == target)
            rule = f"must have one column {wanted}" + (f", and not {count}" if count else "")
            faults.append(Fault(("columns",), "", rule))
    return faults


def _fault(path: object, rule: str) -> ParameterError:
    return ParameterError(Fault((as_text(str(path)),), "", rule))


# ---- From the drawing of a disc with a hat: modes of an axisymmetric solid by finite elements of
# its section. With u_r cos(l theta), u_z cos(l theta) and u_theta sin(l theta) the elasticity of a
# solid of revolution separates into one problem on the section for each number l of nodal
# diameters. Shapes are mass-normalised over the whole solid.

SAME_PLACE = 1e-9  # m; the slider must run through a node of the mesh
# more indicate a mistake in units
MOST_ELEMENTS = 100_000  # in the rectangle around a section
MOST_EQUAL = 64  # modes with equal nodal diameters


def section(rectangles: Iterable[tuple[float, float, float, float]], size: float) -> MeshQuad:
    """A mesh of a union of rectangles (r from, r to, z from, z to), m, with a line of nodes along
    every edge of each; `size`: m, largest edge of an element."""
    mesh_type = brought("skfem", "fe").MeshQuad
    numbers = [tuple(map(float, rectangle)) for rectangle in rectangles]
    for i, box in enumerate(numbers or [()]):
        if not (
            len(box) == 4
            and 0 < box[0] < box[1] < math.inf
            and -math.inf < box[2] < box[3] < math.inf
        ):
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
    parts = [
        np.linspace(a, b, math.ceil((b - a) / size) + 1)[:-1] for a, b in itertools.pairwise(ends)
    ]
    return np.concatenate([*parts, ends[-1:]])


def disc_of_section(
    mesh: MeshQuad,
    material: Mapping[str, Any],
    clamped: Callable[[Array], Any],
    slider: Any,
    highest_Hz: float,
) -> Disc:
    """The modes of a solid of revolution that move under the slider, see
    `disc_model.Disc.from_section`."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    skfem = brought("skfem", "fe")
    iron = Parameters(N=0, Omega=0, normalization="orthonormal", **material)
    is_point = isinstance(slider, tuple | list) and len(slider) == 2 and all(map(is_number, slider))
    is_mesh = isinstance(mesh, skfem.MeshQuad)
    require(
        (
            is_mesh,
            "section",
            mesh,
            "must be rectangles, with their size of an element, or a mesh of quadrilaterals",
        ),
        (is_point, "slider", slider, "must be two numbers, r and z"),
        (
            is_number(highest_Hz) and 0 < highest_Hz < math.inf,
            "highest_Hz",
            highest_Hz,
            "must be finite and > 0",
        ),
    )
    element = skfem.ElementComposite(*[skfem.ElementQuad2()] * 3)
    basis = skfem.Basis(mesh, element, intorder=6)
    _, vertical, circular = basis.split_indices()
    apart = np.hypot(*(basis.doflocs[:, vertical] - np.array(slider)[:, None]))
    level = np.flatnonzero(np.abs(basis.doflocs[1, vertical] - slider[1]) < SAME_PLACE)
    radii, first = np.unique(basis.doflocs[0, vertical[level]], return_index=True)
    nearest = int(np.argmin(apart))  # unknowns of each displacement are in the same order
    measured = np.array([vertical[nearest], circular[nearest], *vertical[level[first]]])
    links = coo_matrix((np.ones(mesh.facets.shape[1]), mesh.facets), shape=(mesh.p.shape[1],) * 2)
    pieces = len(
        np.unique(connected_components(links, directed=False)[1][mesh.t])
    )  # that have no node in common
    held = basis.get_dofs(lambda x: np.broadcast_to(clamped(x), x.shape[1:])).all()
    require(
        (apart.min() < SAME_PLACE, "slider", slider, "must be a node of the mesh"),
        (
            len(held) > 0,
            "clamped",
            len(held),
            "must hold nodes of the section: coordinates are in m",
        ),
        (pieces == 1, "mesh", pieces, "must be one piece: the rectangles must share edges"),
    )
    warn_of_doubts(iron)
    rows: list[tuple[float, int, int, float, float, list[float]]] = []
    for l in range(61):
        omega, moves = _harmonic(
            basis, l, (iron.E, iron.nu, iron.rho), held, measured, math.tau * highest_Hz
        )
        if l > 1 and len(omega) == 0:  # more nodal diameters only stiffen the disc
            break
        # the sine of a mode has the displacement -v(sin(l theta) to cos(l theta)) along theta
        rows += [
            (w, l, i, a, 0.0 - v, shape)
            for i, (w, (a, v, *shape)) in enumerate(zip(omega, moves, strict=True))
        ]
    largest = max((row[3] for row in rows), default=0.0)
    transverse = sorted(
        row for row in rows if row[3] > 1e-6 * largest
    )  # others move in the plane of the disc alone
    require(
        (transverse, "highest_Hz", highest_Hz, "must be above a mode that moves under the slider")
    )
    omegas, diameters, circles, amplitudes, tangential, shapes = zip(*transverse, strict=True)
    return Disc(
        omega=omegas, diameters=diameters, circles=circles, amplitude=amplitudes, tangential=tangential,
        shapes=shapes, radii=radii.tolist(), damping_ratio=[float(material["damping_ratio"])] * len(transverse),
    )  # fmt: skip


def _harmonic(
    basis: Any,
    l: int,
    material: tuple[float, float, float],
    held: Any,
    measured: NDArray[np.intp],
    highest: float,
) -> tuple[list[float], list[list[float]]]:
    """Frequencies up to the highest (rad/s) of the modes with l nodal diameters, and their values
    of the measured unknowns, the first of which the sign of a mode makes positive."""
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
        if count >= MOST_EQUAL:
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
    form = brought("skfem", "fe").BilinearForm
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
