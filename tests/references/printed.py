"""The paper's equations of one phase (tests/references/literal.py) in this package's variables, and
where to try them.

The states are lively: no term of the equations is small, all dampers work, slip goes in both
directions, the disc turns quickly under the slider.  Runs from there are so short that they need no
compilation.
"""

import math

import numpy as np

from disc_model import plate_modes
from disc_model.parameters import Parameters
from disc_model.simulation.states import State
from tests.references import stored
from tests.references.literal import Literal, from_slider_frame

P = Parameters(
    N=600.0, Omega=15.1, m=0.3, k=8e4, c=5.0, k_p=3e4, c_p=0.5, mu_s=0.5, mu_k=0.1, D_star=1e-3,
    n_diameters=2, n_circles=1,
)  # fmt: skip
SPAN = 4e-4
"""s; a dozen radians of the highest mode, several steps."""
THETA = 0.7
MOTIONS = [("stick", 0), ("slip", 1), ("slip", -1), ("separation", 0)]


def lively(phase, direction=0, p=P):
    """A state in which every term of the equations counts; no phase ends within `SPAN`."""
    modes, rng = plate_modes(p), np.random.default_rng(5)
    omega, psi, l = (modes[name].to_numpy() for name in ("omega", "psi", "diameters"))
    pair, n = l > 0, len(modes)
    sign, held = np.sign(psi), p.N if phase != "separation" else 0.0
    modal = {
        "a": -held * psi / omega**2 + 1e-5 * rng.normal(size=n) * 1500 / omega,
        "b": (1e-4 * sign * rng.uniform(0.5, 1, n) * 1500 / omega) * pair,
        "alpha": 0.03 * rng.normal(size=n),
        "beta": (0.1 * rng.normal(size=n)) * pair,
    }
    f = {"stick": 0.0, "slip": 40.0 * direction, "separation": 30.0}[phase]
    u = float(psi @ modal["a"])
    velocity = float(psi @ (modal["alpha"] + l * f * modal["b"]))
    if phase == "separation":
        u, velocity = u + 1e-3, velocity + 0.2
    tail = {"psi": 0.004, "f": f, "u": u, "u_velocity": velocity}
    return State(time=0.0, phase=phase, direction=direction, **tail, **modal)


class Printed:
    """The paper's equations of one phase: motion and forces from a `State`, in this package's
    variables."""

    def __init__(self, p, state):
        self.p, self.literal = p, Literal(p)
        self.sign = np.sign(plate_modes(p)["psi"].to_numpy())
        self.phase, self.y = from_slider_frame(
            stored.reference_state(state, p), plate_modes(p)["diameters"]
        )

    def at(self, t):
        """The state a time ``t`` (s) later, as a dict."""
        return self.described(t, self.literal.fresh(self.phase, 0.0, self.y, t))

    def described(self, t, y):
        q, v, phi, rate, u, u_rate = self.literal.unpack(y)
        w, _, velocity = self.literal.disc(q, v, phi, rate)
        if self.phase != "separation":
            u, u_rate = w, velocity
        l = self.literal.l
        point = self.literal.Psi * np.exp(1j * l * THETA)
        return self._across(q, v, phi) | {
            "psi": self.literal.psi(t, phi), "f": rate, "u": u, "u_velocity": u_rate, "w": w,
            "P": self.literal.contact(t, y, self.phase),
            "w_point": (point * q).sum().real, "w_point_velocity": (point * v).sum().real,
        }  # fmt: skip

    def _across(self, q, v, phi):
        """a, b, alpha and beta of every row of `plate_modes`; the inverse of
        `from_slider_frame`."""
        l = self.literal.l
        turning = np.exp(1j * l * phi) * np.where(l > 0, math.sqrt(2), 1.0)
        along, rates = (self.sign * (z * turning)[l >= 0] for z in (q, v))
        return {"a": along.real, "b": -along.imag, "alpha": rates.real, "beta": -rates.imag}

    def force(self):
        """Contact force at the start, N."""
        return self.literal.contact(0.0, self.y, self.phase)

    def rates(self):
        """Rates at the start, the axes of a, b, alpha, beta turning with the slider."""
        q, v, phi, rate, _, u_rate = self.literal.unpack(self.y)
        acceleration, phi_acc, u_acc, _ = self.literal.accelerations(0.0, self.y, self.phase)
        turning = 1j * self.literal.l * rate
        return self._across(v + turning * q, acceleration + turning * v, phi) | {
            "psi": self.p.Omega - rate, "f": phi_acc, "u": u_rate, "u_velocity": u_acc,
        }  # fmt: skip
