"""Rayleigh-Ritz eigenvalues of the annular plate: no Bessel functions, no root search to miss one."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre
from scipy import linalg


class Basis(NamedTuple):
    """Legendre polynomials at Gauss nodes."""

    nodes: np.ndarray
    weights: np.ndarray
    polynomials: np.ndarray
    """P_0, P_1, ... with two derivatives, (3, count, nodes)."""


@lru_cache
def _basis(count: int) -> Basis:
    """Return a number of polynomials at enough nodes."""
    nodes, weights = legendre.leggauss(2 * count + 20)
    polynomials = np.empty((3, count, nodes.size))
    for derivative in range(3):
        for degree, row in enumerate(np.eye(count)):
            series = legendre.legder(row, derivative)
            polynomials[derivative, degree] = legendre.legval(nodes, series)
    return Basis(nodes, weights, polynomials)


def ritz_lambdas(inner: float, nu: float, l: int, count: int, n_basis: int = 60) -> np.ndarray:
    """Return the lowest lambda = beta b, clamped inside and free outside.

    The basis (x - inner)^2 P_n is clamped by construction; the free edge is the energy's natural
    condition.

    Parameters
    ----------
    inner : inner radius; the outer one is 1
    nu : Poisson's ratio
    l : nodal diameters
    count : number of eigenvalues
    n_basis : number of polynomials
    """
    nodes, weights, polynomials = _basis(n_basis)
    half = (1 - inner) / 2
    x = inner + half * (nodes + 1)
    s = x - inner
    value = polynomials[0]
    first = polynomials[1] / half
    second = polynomials[2] / half**2
    R = s**2 * value
    dR = 2 * s * value + s**2 * first
    d2R = 2 * value + 4 * s * first + s**2 * second

    # the energy of bending and twisting
    w = weights * half * x
    bend = dR / x - l**2 * R / x**2
    twist = l * (dR / x - R / x**2)
    laplacian = d2R + bend
    cross = (d2R * w) @ bend.T
    twisting = (twist * w) @ twist.T
    saddle = cross + cross.T - 2 * twisting
    stiffness = (laplacian * w) @ laplacian.T - (1 - nu) * saddle
    mass = (R * w) @ R.T

    scale = 1 / np.sqrt(np.diag(stiffness))
    scaled_mass = scale[:, None] * mass * scale
    scaled_stiffness = scale[:, None] * stiffness * scale
    inverse = linalg.eigh(scaled_mass, scaled_stiffness, eigvals_only=True)
    return np.sort(inverse[::-1][:count] ** -0.25)
