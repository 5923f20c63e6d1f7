"""Rayleigh-Ritz eigenvalues of the annular plate: no Bessel functions, no root search, nothing to
miss."""

from functools import lru_cache

import numpy as np
from numpy.polynomial import legendre
from scipy import linalg


@lru_cache
def _basis(count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Gauss nodes and weights (k,), and P_0..P_{count-1} with two derivatives there, (3, count,
    k)."""
    nodes, weights = legendre.leggauss(2 * count + 20)
    rows = np.eye(count)
    polynomials = [
        [legendre.legval(nodes, legendre.legder(row, d)) for row in rows] for d in range(3)
    ]
    return nodes, weights, np.array(polynomials)


def ritz_lambdas(inner: float, nu: float, l: int, count: int, n_basis: int = 60) -> np.ndarray:
    """The lowest `count` lambda = beta b for `l` nodal diameters, radii `inner` and 1, clamped and
    free.

    Basis (x - inner)^2 P_n: clamped inside by construction, free outside as the energy's natural
    condition.
    """
    nodes, weights, polynomials = _basis(n_basis)
    half = (1 - inner) / 2
    x = inner + half * (nodes + 1)
    s = x - inner
    value, first, second = (polynomials[d] / half**d for d in range(3))
    R, dR, d2R = (
        s**2 * value,
        2 * s * value + s**2 * first,
        2 * value + 4 * s * first + s**2 * second,
    )
    w = weights * half * x
    bend, twist = dR / x - l**2 * R / x**2, l * (dR / x - R / x**2)
    laplacian = d2R + bend
    cross = (d2R * w) @ bend.T
    stiffness = (laplacian * w) @ laplacian.T - (1 - nu) * (
        cross + cross.T - 2 * (twist * w) @ twist.T
    )
    mass = (R * w) @ R.T
    scale = 1 / np.sqrt(np.diag(stiffness))
    inverse = linalg.eigh(
        scale[:, None] * mass * scale, scale[:, None] * stiffness * scale, eigvals_only=True
    )
    return np.sort(inverse[::-1][:count] ** -0.25)
