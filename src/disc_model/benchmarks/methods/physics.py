"""The equations of motion in plain numpy, as a user would write them (docs: model, Disc in the slider's frame).

One vector holds the state in every phase:

    y = (a, b, alpha, beta, psi, f, u, u'),  shape (4 n + 4,), n = number of modes

where u and u' are integrated only in separation; in contact they are the disc's and rest unused.  Nothing is shared
with `disc_model.engine`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from disc_model.parameters import Parameters
from disc_model.plate import modal_damping, mode_arrays
from disc_model.simulation.result import State

Array = NDArray[np.float64]


class Physics:
    """Constants of a case and the right-hand sides of its phases.  SI units throughout."""

    def __init__(self, p: Parameters) -> None:
        modes = mode_arrays(p)
        self.p = p
        self.n = n = len(modes.omega)
        self.l = modes.diameters.astype(float)
        self.shape = modes.psi.copy()  # psi_l, kg^-1/2
        self.omega = modes.omega.copy()
        self.stiffness = modes.omega**2
        self.damping = modal_damping(p)
        self.slope = self.l * self.shape
        self.bend = self.l * self.slope
        self.compliance = float(np.sum(self.shape**2))  # S2, 1/kg
        self.u_0 = -p.N * float(np.sum(self.shape**2 / self.stiffness))
        self.a, self.b = slice(0, n), slice(n, 2 * n)
        self.alpha, self.beta = slice(2 * n, 3 * n), slice(3 * n, 4 * n)
        self.psi, self.f, self.u, self.v = range(4 * n, 4 * n + 4)

    # ---- states
    def pack(self, state: State) -> Array:
        """`State` as a vector."""
        tail = (state.psi, state.f, state.u, state.u_velocity)
        return np.concatenate([state.a, state.b, state.alpha, state.beta, tail])

    def unpack(self, time: float, phase: str, direction: int, y: Array) -> State:
        """A vector as `State`, u and u' being the disc's in contact."""
        u, v = (y[self.u], y[self.v]) if phase == "separation" else self.disc_point(y)
        modal = {name: y[getattr(self, name)].copy() for name in ("a", "b", "alpha", "beta")}
        return State(time, phase, direction, float(y[self.psi]), float(y[self.f]), float(u), float(v), **modal)

    # ---- formulas at an instant
    def disc_point(self, y: Array) -> tuple[float, float]:
        """w and dw/dt of the disc under the moving slider."""
        slope = self.slope @ y[self.b]
        return float(self.shape @ y[self.a]), float(self.shape @ y[self.alpha] + y[self.f] * slope)

    def force(self, y: Array, direction: int) -> float:
        """Contact force P; ``direction`` 0 is stick."""
        return self._contact(y, direction)[0]

    def _pull(self, y: Array) -> float:
        """F = k_p psi + c_p (Omega - f)."""
        return float(self.p.k_p * y[self.psi] + self.p.c_p * (self.p.Omega - y[self.f]))

    def _contact(self, y: Array, direction: int) -> tuple[float, float]:
        """P and F."""
        p, f, a, alpha = self.p, y[self.f], y[self.a], y[self.alpha]
        slope = self.slope @ y[self.b]
        w = self.shape @ a
        velocity = self.shape @ alpha + f * slope
        A = -self.shape @ (self.damping * alpha + self.stiffness * a)
        A += f * (2.0 * self.slope @ y[self.beta] - f * (self.bend @ a))
        F = self._pull(y)
        top = p.N + p.k * (w - self.u_0) + p.c * velocity + p.m * A
        below = 1.0 + p.m * self.compliance
        if direction == 0:
            return top / below, F
        return (top + slope * F) / (below + direction * p.mu_k * slope / p.r_0), F

    # ---- right-hand sides
    def rate(self, phase: str, direction: int, y: Array) -> Array:
        """dy/dt, shape of ``y``."""
        p, f, dy = self.p, y[self.f], np.zeros_like(y)
        a, b, alpha, beta = y[self.a], y[self.b], y[self.alpha], y[self.beta]
        turn = self.l * f
        dy[self.a] = alpha + turn * b
        dy[self.b] = beta - turn * a
        dy[self.alpha] = -self.damping * alpha - self.stiffness * a + turn * beta
        dy[self.beta] = -self.damping * beta - self.stiffness * b - turn * alpha
        dy[self.psi] = p.Omega - f
        if phase == "separation":
            dy[self.f] = self._pull(y) / p.m
            dy[self.u] = y[self.v]
            dy[self.v] = -(p.N + p.k * (y[self.u] - self.u_0) + p.c * y[self.v]) / p.m
            return dy
        P, F = self._contact(y, direction)
        dy[self.alpha] -= self.shape * P
        if phase == "slip":
            dy[self.f] = F / p.m - direction * p.mu_k * P / (p.m * p.r_0)
        return dy

    # ---- how far two states are apart
    def distance(self, one: State, other: State) -> float:
        """Energy norm of the difference of two states over that of ``other``, without dimension.

        Displacement and velocity of every mode, of the in-plane motion and, where either is separated, of the
        slider's height, each weighted as it stands in the energy.
        """
        right = self.pack(other)
        return float(np.sqrt(self._energy(self.pack(one) - right) / self._energy(right)))

    def _energy(self, y: Array) -> float:
        p, squares = self.p, y**2
        disc = np.sum(squares[self.alpha] + squares[self.beta] + self.stiffness * (squares[self.a] + squares[self.b]))
        plane = p.r_0**2 * (p.m * squares[self.f] + p.k_p * squares[self.psi])
        height = p.m * squares[self.v] + p.k * squares[self.u]
        return 0.5 * float(disc + plane + height)
