"""The paper's equations of one phase (tests/references/literal.py) in this package's variables.

Here is also where to try them. The states are lively: no term of the equations is small, all dampers
work, slip goes in both directions, the disc turns quickly under the slider. Runs from there are so
short that they need no compilation.
"""

import math

import numpy as np

from disc_model import plate_modes
from disc_model.disc.plate import tangential_amplitudes
from disc_model.parameters import Parameters
from disc_model.simulation.states import State
from tests.references import stored
from tests.references.literal import Literal, from_slider_frame

P = Parameters(
    N=600.0,
    Omega=15.1,
    m=0.3,
    k=8e4,
    c=5.0,
    k_p=3e4,
    c_p=0.5,
    mu_s=0.5,
    mu_k=0.1,
    D_star=1e-3,
    n_diameters=2,
    n_circles=1,
)
SPAN = 4e-4
"""s; a dozen radians of the highest mode, several steps."""
THETA = 0.7
"""Angle at which the disc is observed, rad."""
MOTIONS = [("stick", 0), ("slip", 1), ("slip", -1), ("separation", 0)]
"""Phases with their directions."""


def lively(phase, direction=0, p=P):
    """Return a state in which every term of the equations counts; no phase ends within `SPAN`.

    Parameters
    ----------
    phase, direction : one of `MOTIONS`
    p : the case
    """
    rng = np.random.default_rng(5)
    modes = plate_modes(p)
    n = len(modes)
    omega = modes["omega"].to_numpy()
    psi = modes["psi"].to_numpy()
    l = modes["diameters"].to_numpy()
    paired = l > 0
    if phase == "separation":
        held = 0.0
    else:
        held = p.N

    a = -held * psi / omega**2 + 1e-5 * rng.normal(size=n) * 1500 / omega
    b = (1e-4 * np.sign(psi) * rng.uniform(0.5, 1, n) * 1500 / omega) * paired
    alpha = 0.03 * rng.normal(size=n)
    beta = (0.1 * rng.normal(size=n)) * paired
    rate = {"stick": 0.0, "slip": 40.0 * direction, "separation": 30.0}[phase]
    u = float(psi @ a)
    velocity = float(psi @ (alpha + l * rate * b))
    if phase == "separation":
        u += 1e-3
        velocity += 0.2
    return State(
        time=0.0,
        phase=phase,
        direction=direction,
        psi=0.004,
        f=rate + float(tangential_amplitudes(p) @ beta) / p.r_0,
        u=u,
        u_velocity=velocity,
        a=a,
        b=b,
        alpha=alpha,
        beta=beta,
    )


class Printed:
    """The paper's equations of one phase from a `State`, in this package's variables."""

    def __init__(self, p, state):
        modes = plate_modes(p)
        own = stored.reference_state(state, p)
        self.p = p
        self.literal = Literal(p)
        self.sign = np.sign(modes["psi"].to_numpy())
        self.phase, self.y = from_slider_frame(own, modes["diameters"])

    def at(self, t):
        """Return the state a time t in s later, by the names of its variables."""
        return self.described(t, self.literal.fresh(self.phase, 0.0, self.y, t))

    def described(self, t, y):
        """Return a vector at a time as variables, by their names."""
        q, v, phi, rate, u, u_rate = self.literal.unpack(y)
        w, _, velocity = self.literal.disc(q, v, phi, rate)
        if self.phase != "separation":
            u = w
            u_rate = velocity
        point = self.literal.Psi * np.exp(1j * self.literal.l * THETA)
        return {
            **self._across(q, v, phi),
            "psi": self.literal.psi(t, phi),
            "f": rate,
            "u": u,
            "u_velocity": u_rate,
            "w": w,
            "P": self.literal.contact(t, y, self.phase),
            "w_point": (point * q).sum().real,
            "w_point_velocity": (point * v).sum().real,
        }

    def _across(self, q, v, phi):
        """Return a, b, alpha and beta of every row of `plate_modes`.

        This is the inverse of `from_slider_frame`.
        """
        l = self.literal.l
        turning = np.exp(1j * l * phi) * np.where(l > 0, math.sqrt(2), 1.0)
        along = self.sign * (q * turning)[l >= 0]
        rates = self.sign * (v * turning)[l >= 0]
        return {"a": along.real, "b": -along.imag, "alpha": rates.real, "beta": -rates.imag}

    def force(self):
        """Return the contact force at the start, N."""
        return self.literal.contact(0.0, self.y, self.phase)

    def rates(self):
        """Return rates at the start, the axes of a, b, alpha, beta turning with the slider."""
        state = self.literal.unpack(self.y)
        acceleration = self.literal.accelerations(0.0, self.y, self.phase)
        turning = 1j * self.literal.l * state.phi_rate
        velocity = state.q_rate + turning * state.q
        change = acceleration.q + turning * state.q_rate
        return {
            **self._across(velocity, change, state.phi),
            "psi": self.p.Omega - state.phi_rate,
            "f": acceleration.phi,
            "u": state.u_rate,
            "u_velocity": acceleration.u,
        }
