"""Eigenvalues of steady sliding from the equations as they stand, nothing eliminated by hand; only
numpy.

The unknowns are the rates of all coordinates, the forces V, H, R and T, and the rate g at which the
contact travels over the material.  The equations of motion, of contact and of friction are one
residual F(x, z) = 0 of the coordinates x and the unknowns z.  About the state in which the slider
rests in space, dz = -(dF/dz)^-1 (dF/dx) dx, with derivatives by complex steps, which have no error
of differences.
"""

import numpy as np

STEP = 1e-30


class SteadySliding:
    """The equations of slip, which is in the direction of the drive unless `direction` is -1.

    values : by the names of `Parameters`; the contact is rigid if ``contact_compliance`` is 0
    omega, psi, l, damping, tangential : of the modes, damping being 2 xi omega (1/s) and tangential
        the amplitudes at the surface of friction (1/sqrt(kg))
    """

    direction = 1

    def __init__(self, values, omega, psi, l, damping, tangential):
        for name in ("N", "Omega", "m", "k", "c", "k_p", "c_p", "mu_s", "mu_k", "r_0"):
            setattr(self, name, float(values[name]))
        self.decay = float(values.get("friction_decay", np.inf))
        self.exponential = values.get("friction_law") == "exponential"
        self.mu_v = float(values.get("viscous_friction", 0))
        self.C = float(values.get("contact_compliance", 0))
        self.normal = values.get("contact_force") == "normal"
        self.w2 = np.asarray(omega, float) ** 2
        self.s, self.l, self.d, self.t = (
            np.asarray(x, float) for x in (psi, l, damping, tangential)
        )
        self.n = len(self.s)
        self.u_0 = -self.N * (np.sum(self.s**2 / self.w2) + self.C)
        # coordinates a, b, alpha, beta, psi, f, (u, v)
        self.size = 4 * self.n + (4 if self.C else 2)

    def friction(self, v):
        """Coefficient at the slip speed v > 0, m/s."""
        if not np.isfinite(self.decay):
            fall = 0.0
        elif self.exponential:
            fall = np.exp(-self.decay * v)
        else:
            fall = 1 / (1 + self.decay * v)
        return self.mu_k + (self.mu_s - self.mu_k) * fall + self.mu_v * v

    def residual(self, x, z):
        """F: one equation for each of the unknowns, for each column of x and z."""
        n = self.n
        s, l, t, d, w2 = (y[:, None] for y in (self.s, self.l, self.t, self.d, self.w2))
        a, b, alpha, beta = x[: 4 * n].reshape(4, n, -1)
        spring, f = x[4 * n : 4 * n + 2]
        a_rate, b_rate, alpha_rate, beta_rate = z[: 4 * n].reshape(4, n, -1)
        spring_rate, f_rate = z[4 * n : 4 * n + 2]
        V, H, R, T, g = z[self.size :]
        F = self.k_p * spring + self.c_p * (self.Omega - f)
        sliding = self.direction * self.friction(self.direction * self.r_0 * g)
        slope = (self.l * self.s) @ b / self.r_0
        if self.C:
            u, v = x[4 * n + 2 :]
            u_rate, climb = z[4 * n + 2 : 4 * n + 4]
        else:
            g_rate = f_rate - self.t @ beta_rate / self.r_0
            u = self.s @ a
            v = self.s @ a_rate
            climb = self.s @ alpha_rate + (self.l * self.s) @ (g_rate * b + g * b_rate)
        lean = slope if self.normal else 0.0
        equations = [
            a_rate - alpha - l * g * b,
            b_rate - beta + l * g * a,
            alpha_rate + d * alpha + w2 * a - l * g * beta + s * V,
            beta_rate + d * beta + w2 * b + l * g * alpha - t * H,
            spring_rate - self.Omega + f,
            self.m * self.r_0 * f_rate - self.r_0 * F + H,
            self.m * climb - V + self.N + self.k * (u - self.u_0) + self.c * v,
            g - f + self.t @ beta / self.r_0,
            T - sliding * R,
            V - R + T * lean,
            H - T - R * lean,
        ]
        if self.C:
            equations += [u_rate - v, self.C * V - self.s @ a + u]
        return np.vstack(equations)

    def jacobian(self, x, z):
        """dF/dx and dF/dz."""
        both = np.concatenate([x, z])
        moved = both[:, None] + 1j * STEP * np.eye(len(both))
        slopes = self.residual(moved[: len(x)], moved[len(x) :]).imag / STEP
        return slopes[:, : len(x)], slopes[:, len(x) :]

    def equilibrium(self):
        """Coordinates and unknowns where nothing changes: Newton's method, in all coordinates but
        f = Omega and the components across of modes without diameters, which stay 0."""
        n = self.n
        free = np.ones(self.size, bool)
        free[n : 2 * n] = free[3 * n : 4 * n] = self.l > 0
        free[4 * n + 1] = False
        if self.C:
            free[4 * n + 3] = False
        x = np.zeros(self.size)
        x[:n] = -self.N * self.s / self.w2
        x[4 * n + 1] = self.Omega
        if self.C:
            x[4 * n + 2] = self.u_0
        friction = self.friction(self.r_0 * self.Omega) * self.N
        x[4 * n] = friction / (self.r_0 * self.k_p)
        z = np.zeros(self.size + 5)
        z[self.size :] = [self.N, friction, self.N, friction, self.Omega]
        forces = np.arange(self.size, self.size + 5)
        sizes = []
        for _ in range(50):
            by_x, by_z = self.jacobian(x, z)
            left = np.hstack([by_x[:, free], by_z[:, forces]])
            right = -self.residual(x[:, None], z[:, None])[:, 0]
            # newtons stand beside micrometres: without scales small singular values would be cut off
            rows = 1 / np.maximum(abs(left).max(axis=1), STEP)
            left = rows[:, None] * left
            columns = 1 / np.maximum(abs(left).max(axis=0), STEP)
            scaled = np.linalg.lstsq(left * columns, rows * right, rcond=None)[0]
            step = columns * scaled
            x[free] += step[: free.sum()]
            z[forces] += step[free.sum() :]
            sizes.append(abs(scaled).max())
            if sizes[-1] < 1e-10 * sizes[0]:  # the next one would be far below rounding
                break
        return x, z

    def eigenvalues(self):
        """Eigenvalues, 1/s, and V, R, T, N."""
        x, z = self.equilibrium()
        by_x, by_z = self.jacobian(x, z)
        rates = -np.linalg.solve(by_z, by_x)[: self.size]
        pair = np.repeat([self.l > 0], 4, axis=0)
        pair[[0, 2]] = True
        kept = np.append(np.flatnonzero(pair.ravel()), np.arange(4 * self.n, self.size))
        V, _, R, T, _ = z[self.size :]
        return np.linalg.eigvals(rates[np.ix_(kept, kept)]), (V, R, T)


def steady_eigenvalues(values, omega, psi, l, damping, tangential):
    """`SteadySliding.eigenvalues` of these arguments."""
    return SteadySliding(values, omega, psi, l, damping, tangential).eigenvalues()


def pad_means(l, arc):
    """Mean of cos(l x) over an arc (rad) about x = 0, by Gauss-Legendre quadrature: the share of an
    amplitude that is left under a pad."""
    nodes, weights = np.polynomial.legendre.leggauss(200)
    return np.cos(np.outer(l, nodes * arc / 2)) @ weights / 2


def couple(offset, psi, l, r_0):
    """Tangential amplitudes of modes at a surface ``offset`` (m) from the middle plane."""
    return -offset / r_0 * np.asarray(l) * np.asarray(psi)
