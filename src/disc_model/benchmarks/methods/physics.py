"""Constants of a case and states as vectors, common to all methods (docs: model, Disc in the slider's frame).

One vector holds the state in every phase:

    y = (a, b, alpha, beta, psi, f, u, u'),  shape (4 n + 4,), n = number of modes

where u and u' are integrated only in separation; in contact they equal the disc's and are unused. The module shares no
code with `disc_model.engine`.
"""

import numpy as np
from numpy.typing import NDArray

from disc_model.parameters import Parameters
from disc_model.plate import modal_damping, mode_arrays
from disc_model.simulation.result import State

Array = NDArray[np.float64]


class Physics:
    """Constants of a case, in SI units; `kernels` has the equations."""

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
        self.compliance = float(np.sum(self.shape**2))  # S2, 1/kg
        self.u_0 = -p.N * float(np.sum(self.shape**2 / self.stiffness))
        self.a, self.b = slice(0, n), slice(n, 2 * n)
        self.alpha, self.beta = slice(2 * n, 3 * n), slice(3 * n, 4 * n)
        self.psi, self.f, self.u, self.v = range(4 * n, 4 * n + 4)

    def pack(self, state: State) -> Array:
        """The vector of a `State`."""
        tail = (state.psi, state.f, state.u, state.u_velocity)
        return np.concatenate([state.a, state.b, state.alpha, state.beta, tail])

    def unpack(self, time: float, phase: str, direction: int, y: Array) -> State:
        """The `State` of a vector; in contact u and u' are the disc's."""
        u, v = (y[self.u], y[self.v]) if phase == "separation" else self.disc_point(y)
        modal = {name: y[getattr(self, name)].copy() for name in ("a", "b", "alpha", "beta")}
        return State(time, phase, direction, float(y[self.psi]), float(y[self.f]), float(u), float(v), **modal)

    def disc_point(self, y: Array) -> tuple[float, float]:
        """w and dw/dt of the disc under the moving slider."""
        slope = self.slope @ y[self.b]
        return float(self.shape @ y[self.a]), float(self.shape @ y[self.alpha] + y[self.f] * slope)

    def distance(self, one: State, other: State) -> float:
        """Energy norm of the difference of two states divided by that of ``other``; dimensionless.

        The norm includes displacement and velocity of every mode and of the in-plane motion, weighted as in the energy.
        If either state is separated, it includes those of the slider's height too.
        """
        right = self.pack(other)
        return float(np.sqrt(self._energy(self.pack(one) - right) / self._energy(right)))

    def _energy(self, y: Array) -> float:
        p, squares = self.p, y**2
        disc = np.sum(squares[self.alpha] + squares[self.beta] + self.stiffness * (squares[self.a] + squares[self.b]))
        plane = p.r_0**2 * (p.m * squares[self.f] + p.k_p * squares[self.psi])
        height = p.m * squares[self.v] + p.k * squares[self.u]
        return 0.5 * float(disc + plane + height)
