"""The paper's Eqs. (18)-(37) written down literally: complex modes, disc's frame, nothing
eliminated by hand.

State: q_l and q_l' for l = -n..n (each complex, conjugate symmetry Eq. (23) not used), phi, phi',
and u, u' of the slider. The accelerations come from the coupled linear system, assembled as printed
and solved numerically. Slow and readable on purpose; the one change to the print is the ">=" that
belongs into Eq. (24).

One phase at a time, integrated by scipy's DOP853.
"""

import numpy as np
from scipy.integrate import solve_ivp

from disc_model import plate_modes


def signed_diameters(diameters):
    """l of every complex mode (-d and d for d > 0) and the row it comes from."""
    pairs = [
        (l, row) for row, d in enumerate(diameters) for l in ((0,) if d == 0 else (-int(d), int(d)))
    ]
    return np.array([l for l, _ in pairs], int), np.array([row for _, row in pairs], int)


class Literal:
    """A case of disc_model `Parameters`, with the modes of `plate_modes` (amplitudes made
    positive).

    The drive point is at the angle 0 at the local time 0; the preload's u_0 = w_0 is that of the
    static equilibrium.
    """

    def __init__(self, p):
        modes = plate_modes(p)
        self.l, rows = signed_diameters(modes["diameters"])
        self.omega = modes["omega"].to_numpy()[rows]
        self.Psi = modes["psi"].abs().to_numpy()[rows] / np.where(self.l == 0, 1.0, np.sqrt(2.0))
        self.damping = p.D_star / p.D * self.omega**2  # 2 xi omega
        self.p = p.model_dump()
        self.w_0 = -p.N * float((self.Psi**2 / self.omega**2).sum())

    # ---- pieces of the equations
    def unpack(self, y):
        n = len(self.l)
        z = y[: 4 * n].view(complex)
        return z[:n], z[n:], y[4 * n], y[4 * n + 1], y[4 * n + 2], y[4 * n + 3]

    def psi(self, t, phi):
        return self.p["Omega"] * t - phi  # Eq. (4)

    def disc(self, q, q_rate, phi, phi_rate):
        """w, w_theta and the velocity (Eq. 34) of the disc under the slider."""
        shape = self.Psi * np.exp(1j * self.l * phi)
        slope = (1j * self.l * shape * q).sum()
        return (shape * q).sum().real, slope.real, (phi_rate * slope + (shape * q_rate).sum()).real

    def accelerations(self, t, y, phase):
        """q'' and phi'', u'' of `phase` ("stick", "slip+", "slip-", "separation") and the contact
        force P."""
        p, l = self.p, self.l
        q, v, phi, rate, u, u_rate = self.unpack(y)
        psi, psi_rate = self.psi(t, phi), p["Omega"] - rate
        free = -self.damping * v - self.omega**2 * q
        if phase == "separation":  # Eqs. (25)-(27)
            phi_acc = (p["c_p"] * psi_rate + p["k_p"] * psi) / p["m"]
            u_acc = -(p["c"] * u_rate + p["k"] * (u - self.w_0) + p["N"]) / p["m"]
            return free, phi_acc, u_acc, 0.0
        e = self.Psi * np.exp(1j * l * phi)  # multiplies q_rs in the sums
        test = self.Psi * np.exp(-1j * l * phi)  # multiplies the projected load
        n = len(l)
        matrix, right = np.zeros((n + 1, n + 1), complex), np.zeros(n + 1, complex)
        # the part of the bracket {m[...] + c(...) + k ...} without q'' and phi''
        known = (
            e
            * (
                p["m"] * (2j * l * rate * v - l**2 * rate**2 * q)
                + p["c"] * (v + 1j * l * rate * q)
                + p["k"] * q
            )
        ).sum()
        preload = p["N"] - p["k"] * self.w_0
        # Eq. (18) / (21): q'' + test * sum e m (q'' + i s phi'' q) = free - test * (preload +
        # known)
        matrix[:n, :n] = np.eye(n) + p["m"] * np.outer(test, e)
        matrix[:n, n] = test * p["m"] * (e * 1j * l * q).sum()
        right[:n] = free - test * (preload + known)
        if phase == "stick":  # Eq. (19): phi is constant
            matrix[n, n] = 1.0
        else:  # Eq. (22)
            friction = p["mu_k"] * (1 if phase == "slip+" else -1)
            matrix[n, :n] = friction * p["m"] * e
            matrix[n, n] = p["r_0"] * p["m"] + friction * p["m"] * (e * 1j * l * q).sum()
            right[n] = p["r_0"] * (p["c_p"] * psi_rate + p["k_p"] * psi) - friction * (
                preload + known
            )
        solution = np.linalg.solve(matrix, right)
        q_acc, phi_acc = solution[:n], solution[n]
        P = preload + known + p["m"] * (e * (q_acc + 1j * l * phi_acc * q)).sum()
        return q_acc, phi_acc.real, 0.0, P.real

    def derivative(self, phase):
        n = len(self.l)

        def rhs(t, y):
            q_acc, phi_acc, u_acc, _ = self.accelerations(t, y, phase)
            out = np.empty_like(y)
            z = out[: 4 * n].view(complex)
            z[:n], z[n:] = y[: 4 * n].view(complex)[n:], q_acc
            out[4 * n :] = y[4 * n + 1], phi_acc, y[4 * n + 3], u_acc
            return out

        return rhs

    # ---- forces
    def pull(self, t, y):
        _, _, phi, rate, _, _ = self.unpack(y)
        return self.p["c_p"] * (self.p["Omega"] - rate) + self.p["k_p"] * self.psi(t, phi)

    def contact(self, t, y, phase):
        return self.accelerations(t, y, phase)[3]

    # ---- integration of one phase
    def fresh(self, phase, t0, y0, t):
        """y(t) integrated from (t0, y0)."""
        how = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-19, "max_step": 1e-4}
        return solve_ivp(self.derivative(phase), (t0, t), y0, **how).y[:, -1]

    # ---- switching
    def impact(self, y):
        """Eqs. (36) and (37)."""
        q, v, phi, rate, _, u_rate = self.unpack(y)
        shape, m = self.Psi * np.exp(1j * self.l * phi), self.p["m"]
        conjugate = shape.conj()
        moving = (shape * v + rate * 1j * self.l * shape * q).sum()
        below = 1 + m * (shape * conjugate).sum()
        after = y.copy()
        after[: 4 * len(self.l)].view(complex)[len(self.l) :] = (
            v - m * (moving - u_rate) / below * conjugate
        )
        after[-1] = ((m * u_rate * shape * conjugate).sum() + moving).real / below.real
        return after


def from_slider_frame(state, diameters):
    """Phase and vector in the disc's frame, drive point at the angle 0, from a `stored.State`."""
    a, b, alpha, beta = (np.asarray(x, float) for x in (state.a, state.b, state.alpha, state.beta))
    phi = -float(state.psi)
    l, rows = signed_diameters(diameters)

    def complex_modes(
        x, y
    ):  # w = sum psi_l (x cos + y sin) l(theta - phi), psi_l = sqrt(2) Psi_l for l >= 1
        z = np.where(l == 0, x[rows], (x[rows] - 1j * np.sign(l) * y[rows]) / np.sqrt(2))
        return z * np.exp(-1j * l * phi)

    phase = state.phase if state.phase != "slip" else ("slip+" if state.direction > 0 else "slip-")
    modes = (
        np.concatenate([complex_modes(a, b), complex_modes(alpha, beta)])
        .astype(complex)
        .view(float)
    )
    return phase, np.concatenate(
        [modes, [phi, float(state.f), float(state.u), float(state.u_velocity)]]
    )
