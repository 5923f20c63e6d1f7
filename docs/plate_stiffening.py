"""How far membrane stresses stiffen the disc: one mode by von Karman's equations."""

import math

import numpy as np

import disc_model as dm
from disc_model.disc.plate import mode_arrays, mode_shapes

NODES = 60
"""Gauss nodes along the radius."""
POLYNOMIALS = 8
"""Polynomials of the radial displacement."""


def stiffness_ratio(p: dm.Parameters, thicknesses: float) -> float:
    """Return the static stiffness of the lowest axisymmetric mode over that of linear theory.

    The radial displacement of the mode, by polynomials, is clamped inside and free outside.

    Parameters
    ----------
    p : the case
    thicknesses : deflection of the disc at the slider's radius
    """
    modes = mode_arrays(p)
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    width = p.b - p.a
    r = p.a + width * (nodes + 1) / 2
    area = weights * width / 2 * math.tau * r

    # strains by bending, radial and tangential, for a unit deflection at the slider's radius
    fine = np.linspace(p.a, p.b, 2001)
    shape = mode_shapes(p, fine)[0] / modes.psi[0]
    slope = np.interp(r, fine, np.gradient(shape, fine, edge_order=2))
    bent = np.stack([slope**2 / 2, 0 * slope])

    # strains by polynomials of the radial displacement
    powers = np.arange(1, POLYNOMIALS + 1)
    part = ((r - p.a) / width)[:, None]
    radial = powers * part ** (powers - 1) / width
    tangential = part**powers / r[:, None]
    strains = np.stack([radial, tangential])

    # the displacement of least membrane energy, and this energy
    law = p.E * p.h / (1 - p.nu**2) * np.array([[1, p.nu], [p.nu, 1]])
    matrix = np.einsum("k,ab,aki,bkj->ij", area, law, strains, strains)
    load = np.einsum("k,ab,ak,bki->i", area, law, bent, strains)
    strain = strains @ np.linalg.solve(matrix, -load) + bent
    energy = np.einsum("k,ab,ak,bk->", area, law, strain, strain) / 2

    deflection = p.h * thicknesses
    linear_stiffness = modes.omega[0] ** 2 / modes.psi[0] ** 2
    return float(1 + 4 * energy * deflection**2 / linear_stiffness)
