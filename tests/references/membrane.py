"""Membrane energy of an annular plate by collocation: an own computation, apart from the package's.

The harmonics of a deflection stretch the plate.  Here the equilibrium of the plate in its plane is
solved in its strong form, N_r' + (N_r - N_t - n S)/r = 0 and S' + (n N_t + 2 S)/r = 0, at Chebyshev
points, with the edges' conditions as equations; the energy is the work of the forces N_P on the
deflection's own strains of another pair P', because strains of displacements do no work in
equilibrium.  Modes come from scipy's Bessel functions, with integrals by Gauss' rule.
"""

from functools import lru_cache

import numpy as np
from numpy.polynomial import chebyshev
from scipy import optimize, special

POINTS = 48


class Ring:
    """Chebyshev points from a to b (m), the matrix that differentiates there, and weights of the
    integral."""

    def __init__(self, a, b, points=POINTS):
        x = np.cos(np.pi * np.arange(points) / (points - 1))
        series = np.linalg.inv(chebyshev.chebvander(x, points - 1))
        slopes = np.array(
            [chebyshev.chebval(x, chebyshev.chebder(row)) for row in np.eye(points)]
        ).T
        half = (b - a) / 2
        self.r = a + half * (x + 1)
        self.derivative = slopes @ series / half
        k = np.arange(points)
        means = np.where(k % 2, 0.0, 2 / (1 - k.astype(float) ** 2 + (k % 2)))
        self.weights = half * (means @ series)


def edge_matrix(l, beta, a, b, nu):
    """Conditions at both edges on the coefficients of J, Y, I, K: R and R' at a, moment and
    Kirchhoff shear at b."""
    functions = (special.jv, special.yv, special.iv, special.kv)
    slopes = (special.jvp, special.yvp, special.ivp, special.kvp)
    signs = np.array([-1.0, -1.0, 1.0, 1.0])
    R = np.array([f(l, beta * b) for f in functions])
    D = beta * np.array([f(l, beta * b) for f in slopes])
    laplacian = signs * beta**2
    moment = laplacian * R - (1 - nu) * (D / b - l**2 * R / b**2)
    shear = laplacian * D - (1 - nu) * l**2 / b**2 * (D - R / b)
    inner = [f(l, beta * a) for f in functions]
    return np.array([inner, [beta * f(l, beta * a) for f in slopes], moment, shear])


@lru_cache
def shape(l, a, b, nu):
    """beta and the coefficients of J, Y, I, K of the mode without nodal circle."""

    def determinant(beta):
        matrix = edge_matrix(l, beta, a, b, nu)
        scaled = matrix / abs(matrix).max(axis=0)
        return np.linalg.det(scaled / abs(scaled).max(axis=1)[:, None])

    start = 0.5 / (b - a) if l < 2 else (0.02 + 0.3 * (l - 1)) / b
    grid = start + 0.05 / (b - a) * np.arange(400)
    values = [determinant(beta) for beta in grid]
    first = next(i for i in range(399) if values[i] * values[i + 1] < 0)
    beta = optimize.brentq(determinant, grid[first], grid[first + 1], xtol=1e-13, rtol=1e-15)
    matrix = edge_matrix(l, beta, a, b, nu)
    scale = abs(matrix).max(axis=0)
    scaled = matrix / scale
    vector = np.linalg.svd(scaled / abs(scaled).max(axis=1)[:, None])[2][-1] / scale
    return beta, vector


def radial(l, r, a, b, nu):
    """R and R' at radii r, normalised by 2 pi / b^2 times the integral of R^2 r; positive at b."""
    beta, vector = shape(l, a, b, nu)
    functions = (special.jv, special.yv, special.iv, special.kv)
    slopes = (special.jvp, special.yvp, special.ivp, special.kvp)

    def value(x):
        return sum(c * f(l, beta * x) for c, f in zip(vector, functions, strict=True))

    nodes, weights = np.polynomial.legendre.leggauss(60)
    nodes = a + (b - a) / 2 * (nodes + 1)
    norm = 2 * np.pi / b**2 * (b - a) / 2 * (weights * nodes) @ value(nodes) ** 2
    norm = np.sqrt(norm) * np.sign(value(b))
    slope = beta * sum(c * f(l, beta * r) for c, f in zip(vector, slopes, strict=True))
    return value(r) / norm, slope / norm


class Membrane:
    """Coefficients G^n of the plate of a case without nodal circles, orthonormal."""

    def __init__(self, p, edge, points=POINTS):
        self.p = p
        self.clamped = edge == "clamped"
        self.ring = Ring(p.a, p.b, points)
        self.modes = {}
        for l in range(p.n_diameters + 1):
            around = np.sqrt(2.0) if l else 1.0
            scale = around / np.sqrt(p.rho * p.h * p.b**2)
            R, D = radial(l, self.ring.r, p.a, p.b, p.nu)
            self.modes[l] = self.modes[-l] = scale * R, scale * D

    def pairs(self, n):
        """Unordered pairs (p, q), p <= q, of harmonics whose sum is n."""
        most = self.p.n_diameters
        return [(q, n - q) for q in range(-most, most + 1) if q <= n - q <= most]

    def strains(self, pair):
        """e_r, e_t and gamma / i of the deflection's pair itself."""
        p, q = pair
        (g_p, d_p), (g_q, d_q) = self.modes[p], self.modes[q]
        half = 0.5 if p == q else 1.0
        r = self.ring.r
        along = half * d_p * d_q
        around = -half * p * q * g_p * g_q / r**2
        return along, around, half * (p * g_p * d_q + q * g_q * d_p) / r

    def forces(self, n, pair):
        """N_r, N_t and S = N_rt / i in equilibrium with the pair's strains."""
        p = self.p
        ring = self.ring
        r = ring.r
        one = np.eye(len(r))
        by_r = np.diag(1 / r)
        zero = np.zeros_like(one)
        C = p.E * p.h / (1 - p.nu**2)
        # strains of U, V: columns are their values at the points
        e_r = np.hstack([ring.derivative, zero])
        e_t = np.hstack([by_r, -n * by_r])
        gamma = np.hstack([n * by_r, ring.derivative - by_r])
        own_r, own_t, own_gamma = self.strains(pair)

        def stress(x, y, z):
            return C * (x + p.nu * y), C * (y + p.nu * x), C * (1 - p.nu) / 2 * z

        N_r, N_t, S = stress(e_r, e_t, gamma)
        own = stress(own_r, own_t, own_gamma)

        def balance(N_r, N_t, S):
            along = ring.derivative @ N_r + by_r @ (N_r - N_t - n * S)
            return along, ring.derivative @ S + by_r @ (n * N_t + 2 * S)

        rows = np.vstack(balance(N_r, N_t, S))
        right = -np.concatenate(balance(*own))
        m = len(r)
        # point 0 is at b, the last one at a
        ends = [(0, True), (m - 1, not self.clamped)]
        for at, is_free in ends:
            for part, offset in ((0, 0), (2, m)):
                row = offset + at
                if is_free:
                    rows[row] = (N_r, N_t, S)[part][at]
                    right[row] = -own[part][at]
                else:
                    rows[row] = np.eye(2 * m)[row]
                    right[row] = 0.0
        scale = abs(rows).max(axis=1)
        found = np.linalg.lstsq(rows / scale[:, None], right / scale, rcond=1e-13)[0]
        return [matrix @ found + part for matrix, part in zip((N_r, N_t, S), own, strict=True)]

    def coefficients(self, n):
        """Pairs and G^n, N m^-3 kg^-2."""
        pairs = self.pairs(n)
        forces = [self.forces(n, pair) for pair in pairs]
        strains = [self.strains(pair) for pair in pairs]
        weights = self.ring.weights * self.ring.r * np.pi * (1 if n == 0 else 2)
        G = [
            [
                weights @ sum(N * e for N, e in zip(*both, strict=True))
                for both in ((force, strain) for strain in strains)
            ]
            for force in forces
        ]
        return pairs, np.array(G)
