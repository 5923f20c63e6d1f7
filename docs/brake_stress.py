"""How much stress the vibration of the brake-like disc means, by finite elements.

python docs/brake_stress.py    needs scikit-fem; writes brake_stress.csv: frequency in Hz, share of the volume,
                               and stress in Pa s/m that it exceeds

The vibration is linear, so stress is proportional to the speed of the surface in the plane.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from scipy.sparse.linalg import eigsh

from disc_model.disc.section import _matrices, _measured, mesh_of
from disc_model.parameters import Parameters

TABLE = Path(__file__).with_suffix(".csv")
DRAWING = (
    (0.075, 0.100, 0.000, 0.012),
    (0.100, 0.135, 0.000, 0.012),
    (0.067, 0.075, -0.040, 0.012),
    (0.035, 0.067, -0.040, -0.032),
)
"""Section of docs/brake_disc.md: r from, r to, z from, z to in m."""
IRON = Parameters(N=0, Omega=0, E=110e9, nu=0.26, rho=7200)
SLIDER = (0.1, 0.012)
CLAMPED = 0.035
"""Radius at which the hat is held, m."""
DIAMETERS = 1
SHARES = (0.01, 0.05, 0.2)
"""Of the volume."""
SIZES = (0.004, 0.002, 0.001)
"""Of elements, m."""
HIGHEST = math.tau * 2000
"""rad/s, above the mode at 1.76 kHz and below the next one of a nodal diameter."""


def stress_per_speed(size: float) -> tuple[float, np.ndarray]:
    """Return the frequency of the mode that friction feeds in Hz, and its von Mises stress in Pa where its
    surface moves with 1 m/s in the plane, with elements of a size in m.

    The sharp corner between ring and neck has no greatest stress, which rises as elements become
    smaller, so that stress is that which the `SHARES` of the volume exceed.
    """
    import skfem

    mesh = mesh_of(DRAWING, size)
    element = skfem.ElementComposite(*[skfem.ElementQuad2()] * 3)
    basis = skfem.Basis(mesh, element, intorder=6)
    along_path = _measured(basis, SLIDER)[0][1]
    held = basis.get_dofs(lambda x: x[0] < CLAMPED + 1e-9).all()
    stiffness, mass = _matrices(basis, DIAMETERS, IRON)
    free = basis.complement_dofs(held)
    squares, shapes = eigsh(
        stiffness[free][:, free].tocsc(), 4, mass[free][:, free].tocsc(), sigma=0.0
    )
    fed = np.flatnonzero(squares < HIGHEST**2)[-1]
    omega = math.sqrt(squares[fed])
    shape = np.zeros(basis.N)
    shape[free] = shapes[:, fed]

    # the speed of the surface is omega times its displacement
    shape /= omega * abs(shape[along_path])
    stress = _von_mises(basis, shape)
    r = basis.global_coordinates().value[0]
    weights = (basis.dx * r).ravel()
    order = np.argsort(-stress.ravel())
    exceeding = np.cumsum(weights[order]) / weights.sum()
    by_share = np.interp(SHARES, exceeding, stress.ravel()[order])
    return omega / math.tau, by_share


def _von_mises(basis: Any, shape: np.ndarray) -> np.ndarray:
    """Return the largest von Mises stress round the disc at each quadrature point, Pa.

    Normal stresses and that in the section vary as cos(theta), the others as sin(theta); a standing
    wave has the former at its antinodes and the latter at its nodes.
    """
    u, w, v = basis.interpolate(shape)
    r = basis.global_coordinates().value[0]
    normal = np.array([u.grad[0], w.grad[1], (u.value + DIAMETERS * v.value) / r])
    deviator = normal - normal.mean(axis=0)
    in_section = u.grad[1] + w.grad[0]
    in_plane = v.grad[0] - (DIAMETERS * u.value + v.value) / r
    across = v.grad[1] - DIAMETERS * w.value / r

    at_antinodes = np.sum(deviator**2, axis=0) + in_section**2 / 2
    at_nodes = (in_plane**2 + across**2) / 2
    squares = 1.5 * np.maximum(at_antinodes, at_nodes)
    return IRON.E / (1 + IRON.nu) * np.sqrt(squares)


def main() -> None:
    for size in SIZES:
        frequency, by_share = stress_per_speed(size)
        stress = ", ".join(f"{1e-6 * each:.0f}" for each in by_share)
        print(f"elements of {1e3 * size:g} mm, {frequency:.0f} Hz: {stress} MPa s/m")
    # of the finest elements, which come last
    pd.DataFrame({"frequency": frequency, "share": SHARES, "stress_per_speed": by_share}).to_csv(
        TABLE, index=False, float_format="%.6g"
    )


if __name__ == "__main__":
    main()
