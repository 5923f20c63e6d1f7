"""The paper's Eqs. (18)-(37) written down literally: complex modes, the disc's frame, no elimination.

The state is q_l and q_l' for l = -n..n (each complex, the symmetry of Eq. (23) not used), phi, phi',
and u, u' of the slider. The accelerations come from the coupled linear system, assembled as printed
and solved numerically. Slow and readable on purpose; the one change to the print is the ">=" that
belongs into Eq. (24).

One phase at a time is integrated, by scipy's DOP853.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from disc_model import plate_modes


def signed_diameters(diameters):
    """Return l of every complex mode (-d and d for d > 0), and the row of its real mode."""
    signed = []
    rows = []
    for row, d in enumerate(diameters):
        waves = (-int(d), int(d))
        if d == 0:
            waves = (0,)
        for l in waves:
            signed.append(l)
            rows.append(row)
    return np.array(signed, int), np.array(rows, int)


class Unpacked(NamedTuple):
    """The parts of a vector of state."""

    q: np.ndarray
    q_rate: np.ndarray
    phi: float
    phi_rate: float
    u: float
    u_rate: float


class Accelerations(NamedTuple):
    """Second derivatives, and the contact force."""

    q: np.ndarray
    phi: float
    u: float
    P: float


class Literal:
    """A case of disc_model `Parameters`, with the modes of `plate_modes` (amplitudes made positive).

    The drive point is at the angle 0 at the local time 0; the preload's u_0 = w_0 is that of the
    static equilibrium. Phases are "stick", "slip+", "slip-" and "separation".
    """

    def __init__(self, p):
        modes = plate_modes(p)
        self.l, rows = signed_diameters(modes["diameters"])
        self.omega = modes["omega"].to_numpy()[rows]
        halved = np.where(self.l == 0, 1.0, np.sqrt(2.0))
        self.Psi = modes["psi"].abs().to_numpy()[rows] / halved
        self.damping = p.D_star / p.D * self.omega**2  # 2 xi omega
        self.p = p.model_dump()
        self.w_0 = -p.N * float((self.Psi**2 / self.omega**2).sum())

    # ---- pieces of the equations

    def unpack(self, y) -> Unpacked:
        """Return the parts of a vector."""
        n = len(self.l)
        z = y[: 4 * n].view(complex)
        return Unpacked(z[:n], z[n:], *y[4 * n : 4 * n + 4])

    def psi(self, t, phi):
        """Return the angle by which the drive leads, Eq. (4)."""
        return self.p["Omega"] * t - phi

    def disc(self, q, q_rate, phi, phi_rate):
        """Return w, w_theta and the velocity (Eq. 34) of the disc under the slider."""
        shape = self.Psi * np.exp(1j * self.l * phi)
        slope = (1j * self.l * shape * q).sum()
        velocity = phi_rate * slope + (shape * q_rate).sum()
        return (shape * q).sum().real, slope.real, velocity.real

    def accelerations(self, t, y, phase) -> Accelerations:
        """Return q'', phi'', u'' and the contact force P of a phase."""
        if phase == "separation":
            return self._separated(t, y)
        return self._in_contact(t, y, phase)

    def _separated(self, t, y) -> Accelerations:
        """Return accelerations by Eqs. (25)-(27)."""
        p = self.p
        q, v, phi, rate, u, u_rate = self.unpack(y)
        psi_rate = p["Omega"] - rate
        q_acc = -self.damping * v - self.omega**2 * q
        phi_acc = (p["c_p"] * psi_rate + p["k_p"] * self.psi(t, phi)) / p["m"]
        u_acc = -(p["c"] * u_rate + p["k"] * (u - self.w_0) + p["N"]) / p["m"]
        return Accelerations(q_acc, phi_acc, u_acc, 0.0)

    def _in_contact(self, t, y, phase) -> Accelerations:
        """Return accelerations by Eqs. (18)-(22), with q'' and phi'' as unknowns."""
        p = self.p
        l = self.l
        n = len(l)
        q, v, phi, rate, _, _ = self.unpack(y)
        e = self.Psi * np.exp(1j * l * phi)  # multiplies q_rs in the sums
        test = self.Psi * np.exp(-1j * l * phi)  # multiplies the projected load
        turned = (e * 1j * l * q).sum()  # multiplies phi'' in the bracket

        # the part of the bracket {m[...] + c(...) + k ...} without q'' and phi''
        inertia = p["m"] * (2j * l * rate * v - l**2 * rate**2 * q)
        damper = p["c"] * (v + 1j * l * rate * q)
        spring = p["k"] * q
        known = (e * (inertia + damper + spring)).sum()
        load = p["N"] - p["k"] * self.w_0 + known

        # Eq. (18) / (21): q'' + test * sum e m (q'' + i s phi'' q) = free - test * load
        matrix = np.zeros((n + 1, n + 1), complex)
        right = np.zeros(n + 1, complex)
        matrix[:n, :n] = np.eye(n) + p["m"] * np.outer(test, e)
        matrix[:n, n] = test * p["m"] * turned
        right[:n] = -self.damping * v - self.omega**2 * q - test * load
        if phase == "stick":  # Eq. (19): phi is constant
            matrix[n, n] = 1.0
        else:  # Eq. (22)
            sense = -1
            if phase == "slip+":
                sense = 1
            friction = p["mu_k"] * sense
            drive = p["c_p"] * (p["Omega"] - rate) + p["k_p"] * self.psi(t, phi)
            matrix[n, :n] = friction * p["m"] * e
            matrix[n, n] = p["r_0"] * p["m"] + friction * p["m"] * turned
            right[n] = p["r_0"] * drive - friction * load
        solution = np.linalg.solve(matrix, right)

        q_acc = solution[:n]
        phi_acc = solution[n]
        P = load + p["m"] * (e * (q_acc + 1j * l * phi_acc * q)).sum()
        return Accelerations(q_acc, phi_acc.real, 0.0, P.real)

    def derivative(self, phase) -> Callable:
        """Return the right-hand side of a phase."""
        n = len(self.l)

        def rhs(t, y):
            acceleration = self.accelerations(t, y, phase)
            state = self.unpack(y)
            out = np.empty_like(y)
            z = out[: 4 * n].view(complex)
            z[:n] = state.q_rate
            z[n:] = acceleration.q
            out[4 * n] = state.phi_rate
            out[4 * n + 1] = acceleration.phi
            out[4 * n + 2] = state.u_rate
            out[4 * n + 3] = acceleration.u
            return out

        return rhs

    # ---- forces

    def pull(self, t, y):
        """Return the force of spring and damper in the plane, N."""
        state = self.unpack(y)
        damper = self.p["c_p"] * (self.p["Omega"] - state.phi_rate)
        return damper + self.p["k_p"] * self.psi(t, state.phi)

    def contact(self, t, y, phase):
        """Return the contact force, N."""
        return self.accelerations(t, y, phase).P

    # ---- integration of one phase

    def fresh(self, phase, t0, y0, t):
        """Return y(t), integrated from (t0, y0)."""
        solution = solve_ivp(
            self.derivative(phase),
            (t0, t),
            y0,
            method="DOP853",
            rtol=1e-13,
            atol=1e-19,
            max_step=1e-4,
        )
        return solution.y[:, -1]

    # ---- switching

    def impact(self, y):
        """Return the state after an impact, Eqs. (36) and (37)."""
        m = self.p["m"]
        n = len(self.l)
        q, v, phi, rate, _, u_rate = self.unpack(y)
        shape = self.Psi * np.exp(1j * self.l * phi)
        conjugate = shape.conj()
        moving = (shape * v + rate * 1j * self.l * shape * q).sum()
        shared = m * shape * conjugate
        below = 1 + m * (shape * conjugate).sum()
        after = y.copy()
        z = after[: 4 * n].view(complex)
        z[n:] = v - m * (moving - u_rate) / below * conjugate
        after[-1] = ((u_rate * shared).sum() + moving).real / below.real
        return after


def from_slider_frame(state, diameters):
    """Return phase and vector in the disc's frame, drive point at the angle 0.

    Parameters
    ----------
    state : a `stored.State`
    diameters : nodal diameters of its modes
    """
    phi = -float(state.psi)
    l, rows = signed_diameters(diameters)
    # w = sum psi_l (x cos + y sin) l(theta - phi), psi_l = sqrt(2) Psi_l for l >= 1
    turned = np.exp(-1j * l * phi)

    def complex_modes(x, y):
        x = np.asarray(x, float)[rows]
        y = np.asarray(y, float)[rows]
        paired = (x - 1j * np.sign(l) * y) / np.sqrt(2)
        return np.where(l == 0, x, paired) * turned

    phase = state.phase
    if phase == "slip":
        phase = "slip-"
        if state.direction > 0:
            phase = "slip+"
    displacement = complex_modes(state.a, state.b)
    velocity = complex_modes(state.alpha, state.beta)
    modes = np.concatenate([displacement, velocity]).astype(complex).view(float)
    slider = [phi, float(state.f), float(state.u), float(state.u_velocity)]
    return phase, np.concatenate([modes, slider])
