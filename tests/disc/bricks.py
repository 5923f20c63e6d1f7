"""Modes of a ring by three-dimensional finite elements, which share nothing with those of its
section, exported as a universal file."""

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import eigsh

from tests.disc.universal import END, Dialect, begin, whole


class Ring(NamedTuple):
    """A ring that is held inside: radii (m) of the edges of its elements, half its thickness (m),
    sectors, and Pa, 1, kg/m^3."""

    radii: tuple[float, ...] = (0.06, 0.08, 0.1, 0.12)
    half: float = 0.006
    sectors: int = 24
    E: float = 110e9
    nu: float = 0.26
    rho: float = 7200.0


class BrickModes(NamedTuple):
    """Frequencies (rad/s), places of nodes (n, 3) and mass-normalised displacements
    (n, 3, modes)."""

    omega: Any
    places: Any
    motion: Any


def brick_modes(ring: Ring, count: int) -> BrickModes:
    """The lowest modes, by elements of 27 nodes."""
    import skfem
    from skfem.helpers import ddot, dot, sym_grad, trace

    flat = skfem.MeshHex.init_tensor(
        np.array(ring.radii),
        np.linspace(0, 2 * np.pi, ring.sectors + 1),
        np.array([-ring.half, ring.half]),
    )
    straight = skfem.MeshHex2.from_mesh(flat)
    r, angle, height = straight.doflocs
    round_ = np.stack([r * np.cos(angle), r * np.sin(angle), height])
    mesh = skfem.MeshHex2(doflocs=round_, t=straight.t)
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementHex2()), intorder=4)

    lame = ring.E * ring.nu / ((1 + ring.nu) * (1 - 2 * ring.nu))
    shear = ring.E / (2 * (1 + ring.nu))

    def energy(u: Any, v: Any, _: Any) -> Any:
        normal = lame * trace(sym_grad(u)) * trace(sym_grad(v))
        return normal + 2 * shear * ddot(sym_grad(u), sym_grad(v))

    stiffness = skfem.BilinearForm(energy).assemble(basis)
    mass = skfem.BilinearForm(lambda u, v, _: ring.rho * dot(u, v)).assemble(basis)

    # the first and the last sector share the nodes between them
    component = np.zeros(basis.N, int)
    for i in range(3):
        component[basis.get_dofs(elements=True).all([f"u^{i + 1}"])] = i
    keys = np.vstack([np.round(basis.doflocs * 1e6), component]).astype(int)
    _, first, inverse = np.unique(keys.T, axis=0, return_index=True, return_inverse=True)
    entries = (np.ones(basis.N), (np.arange(basis.N), inverse.ravel()))
    join = coo_matrix(entries, shape=(basis.N, len(first))).tocsc()
    places = basis.doflocs[:, first]
    component = component[first]

    free = np.flatnonzero(np.hypot(*places[:2]) > ring.radii[0] + 1e-9)
    K = (join.T @ stiffness @ join).tocsc()[free][:, free]
    M = (join.T @ mass @ join).tocsc()[free][:, free]
    squares, shapes = eigsh(K, count, M, sigma=0.0, v0=np.ones(len(free)))
    whole_shapes = np.zeros((len(first), count))
    whole_shapes[free] = shapes
    motion = np.stack([whole_shapes[component == i] for i in range(3)], axis=1)
    return BrickModes(np.sqrt(squares), places[:, component == 0].T, motion)


def export(path: Path, modes: BrickModes, dialect: Dialect) -> Path:
    """A universal file of these modes as finite elements write them."""
    lines = begin(dialect.nodes)
    for i, place in enumerate(modes.places, 1):
        head = whole(i, 0, 0, 8)
        if dialect.nodes == 15:
            lines.append(head + dialect.real(*place))
        else:
            lines += [head, dialect.real(*place, width=25, digits=16)]
    lines.append(END)
    for k, omega in enumerate(modes.omega):
        frequency = omega / (2 * np.pi)
        if dialect.results == 55:
            lines += [*begin(55), *["NONE"] * 5, whole(1, 2, 2, 8, 2, 3), whole(2, 4, 1, k + 1)]
            lines.append(dialect.real(frequency, 1.0, 1e-3, 0.0))
        else:
            lines += [*begin(2414), whole(k + 1), "modes", whole(1), *["NONE"] * 5]
            lines += [whole(1, 2, 2, 8, 2, 3), whole(0, 0, 1, 0, 0, k + 1, 0, 0), whole(0, 0)]
            lines += [dialect.real(0, frequency, 0, 1.0, 1e-3, 0), dialect.real(*[0.0] * 6)]
        for i, row in enumerate(modes.motion[:, :, k], 1):
            lines += [whole(i), dialect.real(*row)]
        lines.append(END)
    path.write_text("\n".join([*lines, ""]))
    return path
