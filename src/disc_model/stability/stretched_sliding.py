"""Steady sliding on a plate that stretches: the equilibrium by continuation in the load from the
linear one, and by a scan of the rate g at which the contact travels over the material.

Under the load s (N - k u_0), s from 0 to 1, at a rate g,

    (l^2 g^2 - omega^2) a + d l g b - F^a - psi V = 0
    (l^2 g^2 - omega^2) b - d l g a - F^b + t H   = 0

with the forces V and H of the spring and of the law of friction, as in `sliding`.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np

from disc_model.arrays import Array
from disc_model.disc.flexibility import contact_compliance
from disc_model.disc.membrane import quartic_form
from disc_model.disc.plate import modal_damping, mode_arrays, tangential_amplitudes
from disc_model.disc.stretched import membrane_forces
from disc_model.parameters import Parameters
from disc_model.simulation.states import engine_case
from disc_model.stability.python_laws import LAWS

LOADS = 24  # shares of the load
RATES = np.arange(1, 101) / 50  # of the scan, over Omega
_MOST_ITERATIONS = 30
_SETTLED = 1e-13  # change of Newton's method, over the largest number of its kind, at which it ends
_MOST_HALVINGS = 60


class _Balance:
    """The equations of the equilibrium at a rate in x = a of all modes, b of the pairs, V and H."""

    def __init__(self, p: Parameters) -> None:
        modes = mode_arrays(p)
        self.p = p
        self.model = engine_case(p).model
        self.l = modes.diameters[:, None]
        self.pairs = modes.diameters > 0
        self.psi = modes.psi[:, None]
        self.w2 = modes.omega[:, None] ** 2
        self.d = modal_damping(p)[:, None]
        self.t = tangential_amplitudes(p)[:, None]
        self.compliance = contact_compliance(p)
        self.load = p.N - p.k * self.model.u_0
        self.size = len(modes.psi) + int(np.count_nonzero(self.pairs)) + 2

    def split(self, x: Any) -> tuple[Any, Any, Any, Any]:
        """a and b of all modes, V and H, of x in columns."""
        n = len(self.psi)
        b = np.zeros_like(x[:n])
        b[self.pairs] = x[n:-2]
        return x[:n], b, x[-2], x[-1]

    def left(self, x: Any, rate: float, share: float) -> Any:
        """What the equations leave over, for x in columns."""
        a, b, V, H = self.split(x)
        p = self.p
        turned = self.l * rate
        along, across = membrane_forces(p, a, b)
        by_a = (turned**2 - self.w2) * a + self.d * turned * b - along - self.psi * V
        by_b = (turned**2 - self.w2) * b - self.d * turned * a - across + self.t * H
        lifted = V - p.k * (np.sum(self.psi * a, axis=0) - self.compliance * V)
        mu = LAWS.friction_coefficient(self.model, 1.0, rate)
        beta = 0.0
        if p.contact_force == "normal":
            beta = np.sum(self.l * self.psi * b, axis=0) / p.r_0
        law = H * (1 - mu * beta) - (mu + beta) * V
        return np.vstack([by_a, by_b[self.pairs], lifted - share * self.load, law])

    def solve(self, x: Array, rate: float, share: float = 1.0) -> Array:
        """The equilibrium near x (size,), by Newton's method; nan if there is none."""
        steps = 1j * LAWS.TINY * np.eye(self.size)
        for _ in range(_MOST_ITERATIONS):
            left = self.left(x[:, None] + steps, rate, share)
            if not np.isfinite(left).all():
                break
            change = np.linalg.solve(left.imag / LAWS.TINY, left.real[:, 0])
            x = x - change
            close = np.abs(change[:-2]).max() <= _SETTLED * np.abs(x[:-2]).max()
            if close and np.abs(change[-2:]).max() <= _SETTLED * np.abs(x[-2:]).max():
                return x
        return np.full(self.size, np.nan)

    def excess(self, x: Array, rate: float) -> float:
        """The slider's rate over that of the drive, rad/s."""
        surface = rate * float(np.sum(self.l * self.t * x[: len(self.t), None]))
        return rate + surface / self.p.r_0 - self.p.Omega

    def is_alone(self, rate: float) -> bool:
        """Whether this is proved to be the only equilibrium at a rate on a surface that does not
        move: within the distance of all equilibria from zero, the stiffness of plate and spring is
        larger than what a membrane under pressure can take from it."""
        p = self.p
        psi = np.append(self.psi, np.zeros(self.size - 2 - len(self.psi)))
        held = (self.w2 - (self.l * rate) ** 2)[:, 0]
        grip = 1.0 / (1.0 + p.k * self.compliance)
        stiffness = np.diag(np.append(held, held[self.pairs])) + p.k * grip * np.outer(psi, psi)
        values, vectors = np.linalg.eigh(stiffness)
        if self.t.any() or not values[0] > 0:
            return False
        scale = vectors / np.sqrt(values)
        reach = grip * self.load * np.linalg.norm(psi @ scale)
        T = quartic_form(p)
        n = len(T)
        twice = np.kron(scale, scale)
        least = np.linalg.eigvalsh(twice.T @ T.reshape(n * n, -1) @ twice)[0]
        return bool(1 + 3 * least * reach**2 > 0)


def stretched_equilibrium(p: Parameters) -> tuple[Array, Array, float, float, bool]:
    """Modal coordinates a, b (n_modes,), the vertical force and the rate g at the equilibrium, nan
    where none is found; and whether a further one is excluded."""
    balance = _Balance(p)
    x = np.zeros(balance.size)
    for share in np.arange(1, LOADS + 1) / LOADS:
        x = balance.solve(x, p.Omega, share)
    rate = p.Omega
    alone = balance.is_alone(rate)
    if balance.t.any():
        found = list(_on_moving_surface(balance, x))
        rate, x = min(found, key=lambda one: abs(one[0] - p.Omega), default=(np.nan, x * np.nan))
    a, b, V, _ = balance.split(x[:, None])
    return a[:, 0], b[:, 0], float(V[0]), rate, alone


def _on_moving_surface(balance: _Balance, start: Array) -> Iterator[tuple[float, Array]]:
    """Rates at which the slider is as fast as the drive, and equilibria there, in a scan on both
    sides of that of the drive, where ``start`` is the equilibrium."""
    Omega = balance.p.Omega
    up = [share for share in RATES if share >= 1]
    down = [share for share in RATES[::-1] if share <= 1]
    for shares in (up, down):
        before = start, Omega, balance.excess(start, Omega)
        for share in shares:
            x = balance.solve(before[0], share * Omega)
            now = x, share * Omega, balance.excess(x, share * Omega)
            if before[2] * now[2] < 0 or (now[2] == 0 and shares is up):
                yield _between(balance, before, now)
            before = now


def _between(balance: _Balance, low: Any, high: Any) -> tuple[float, Array]:
    """The rate between two at which the excess changes its sign, and the equilibrium there."""
    for _ in range(_MOST_HALVINGS):
        x, rate, excess = low
        other, other_rate, other_excess = high
        middle = rate - excess * (other_rate - rate) / (other_excess - excess)
        if not min(rate, other_rate) < middle < max(rate, other_rate):
            break
        x = balance.solve(x, middle)
        now = x, middle, balance.excess(x, middle)
        if now[2] * excess > 0:  # the other end counts half, so that it moves, too (Illinois)
            low, high = now, (other, other_rate, other_excess / 2)
        else:
            low, high = now, low
        if abs(now[2]) <= _SETTLED * balance.p.Omega:
            break
    return low[1], low[0]
