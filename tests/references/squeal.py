"""Complex eigenvalues of steady sliding as brake engineers compute them: matrices of mass, damping and
stiffness, M x'' + C x' + K x = 0 with x = (a, b of the pairs, psi), linearised by hand; only numpy.

From docs/model.md, friction on the surface and friction that falls with the speed: rigid contact,
vertical force, a plate that does not stretch. Where g is the rate of the contact over the disc,

    a'' part     alpha' + d alpha + omega^2 a - l g beta + psi V = 0,    alpha = a' - l g b
    b'' part     beta' + d beta + omega^2 b + l g alpha - t H = 0,       beta = b' + l g a
    psi'' part   m r_0 psi'' + r_0 (k_p psi + c_p psi') - H = 0,         f = Omega - psi'
    contact      V = N + k (u - u_0) + c u' + m u'',  H = mu(r_0 g) V,   g = f - sum(t beta) / r_0
"""

import numpy as np


class Squeal:
    """A case by the names of `Parameters`, and its modes: frequency omega (rad/s), amplitudes psi and
    t under the slider (1/sqrt(kg)), nodal diameters l, damping d = 2 xi omega (1/s)."""

    def __init__(self, p, omega, psi, l, d, t):
        self.p = p
        self.w2 = np.asarray(omega, float) ** 2
        self.psi, self.l, self.d, self.t = (np.asarray(x, float) for x in (psi, l, d, t))
        self.n = len(self.l)

    def friction(self, v):
        """Coefficient of friction at a slip speed (m/s), and its slope (s/m)."""
        p = self.p
        more = p.mu_s - p.mu_k
        fall, slope = 0.0, 0.0
        if np.isfinite(p.friction_decay):
            d = p.friction_decay
            fall, slope = 1 / (1 + d * v), -d / (1 + d * v) ** 2
            if p.friction_law == "exponential":
                fall, slope = np.exp(-d * v), -d * np.exp(-d * v)
        return p.mu_k + more * fall + p.viscous_friction * v, more * slope + p.viscous_friction

    def equilibrium(self):
        """Rate g, a, b and V where nothing moves in space: linear at a given rate, which is iterated."""
        p, n = self.p, self.n
        u_0 = -p.N * np.sum(self.psi**2 / self.w2)
        g = p.Omega
        for _ in range(100):
            mu, _ = self.friction(p.r_0 * g)
            turned = self.l * g
            left = np.zeros((2 * n + 1, 2 * n + 1))
            left[:n, :n] = left[n:-1, n:-1] = np.diag(self.w2 - turned**2)
            left[:n, n:-1] = np.diag(-self.d * turned)
            left[n:-1, :n] = np.diag(self.d * turned)
            left[:n, -1] = self.psi
            left[n:-1, -1] = -self.t * mu
            left[-1, :n] = -p.k * self.psi
            left[-1, -1] = 1
            found = np.linalg.solve(left, np.append(np.zeros(2 * n), p.N - p.k * u_0))
            a, b, V = found[:n], found[n:-1], found[-1]
            g = p.Omega / (1 + np.sum(self.t * self.l * a) / p.r_0)
        return g, a, b, V

    def matrices(self):
        """M, C, K, stacked. Each motion below is such a stack: rows for the shares of x'', x' and x."""
        p, n = self.p, self.n
        g, a, b, V = self.equilibrium()
        mu, slope = self.friction(p.r_0 * g)
        one = np.eye(2 * n + 1)
        A, B, psi = one[:n], one[n:-1], one[-1:]  # rows that pick a, b, psi out of x
        l = self.l[:, None]
        t = self.t[:, None]

        def rate_of(motion):
            assert not motion[0].any()
            return np.array([motion[1], motion[2], 0 * motion[0]])

        moving = (t.T @ B) / p.r_0 + psi
        carried = g * (l * t).T @ A / p.r_0
        spread = 1 + np.sum(self.t * self.l * a) / p.r_0
        of_g = -np.array([0 * psi, moving, carried]) / spread
        alpha = np.array([0 * A, A, -g * l * B]) - (self.l * b)[:, None] * of_g
        beta = np.array([0 * B, B, g * l * A]) + (self.l * a)[:, None] * of_g

        height = self.psi[None] @ A
        of_V = np.array([p.m * height, p.c * height, p.k * height])
        of_H = mu * of_V + slope * p.r_0 * V * of_g
        along = rate_of(alpha) + self.d[:, None] * alpha - g * l * beta
        along += self.psi[:, None] * of_V - (self.l**2 * g * a)[:, None] * of_g
        along[2] += self.w2[:, None] * A
        across = rate_of(beta) + self.d[:, None] * beta + g * l * alpha
        across += -t * of_H - (self.l**2 * g * b)[:, None] * of_g
        across[2] += self.w2[:, None] * B
        slider = p.r_0 * np.array([p.m * psi, p.c_p * psi, p.k_p * psi]) - of_H
        kept = np.concatenate([np.ones(n, bool), self.l > 0, [True]])
        return np.concatenate([along, across, slider], axis=1)[:, kept][:, :, kept]

    def eigenvalues(self):
        """All eigenvalues (1/s), largest real part first."""
        M, C, K = self.matrices()
        n = len(M)
        top = np.hstack([np.zeros((n, n)), np.eye(n)])
        below = -np.linalg.solve(M, np.hstack([K, C]))
        values = np.linalg.eigvals(np.vstack([top, below]))
        return values[np.argsort(-values.real)]
