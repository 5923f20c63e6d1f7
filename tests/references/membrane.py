"""Membrane energy of an annular plate by collocation: an own computation, apart from the package's.

The harmonics of a deflection stretch the plate.  Here the equilibrium of the plate in its plane is
solved in its strong form, N_r' + (N_r - N_t - n S)/r = 0 and S' + (n N_t + 2 S)/r = 0, at Chebyshev
points, with the edges' conditions as equations; the energy is the work of the forces N_P on the
deflection's own strains of another pair P', because strains of displacements do no work in
equilibrium.  The package's modes, which have references of their own, are differentiated at these points.
"""

import numpy as np
from numpy.polynomial import chebyshev

from disc_model.disc.plate import mode_shapes

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


class Membrane:
    """Coefficients G^n of the plate of a case without nodal circles, whose amplitudes at r_0 are
    positive."""

    def __init__(self, p, edge, points=POINTS):
        self.p = p
        self.clamped = edge == "clamped"
        self.ring = Ring(p.a, p.b, points)
        shapes = mode_shapes(p, np.append(self.ring.r, p.r_0))
        self.modes = {}
        for l, shape in enumerate(shapes):
            R = shape[:-1] * np.sign(shape[-1])
            self.modes[l] = self.modes[-l] = R, self.ring.derivative @ R

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
