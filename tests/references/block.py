"""A block on a rigid disc, which is the textbook friction oscillator: closed forms, and motions by a
method that shares nothing with the engine.

The spring of stiffness k_p and the damper c_p pull a block of mass m, which the load N presses on a
surface that stands still; their other end travels with the speed V. With the stretch y of the
spring and the slip speed v = V - y' the block obeys m v' = k_p y + c_p y' - mu(v) N.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from disc_model import Parameters


class StickSlip(NamedTuple):
    """A cycle of stick and slip: times in s, the stretch at the stop in m."""

    slip: float
    stick: float
    stretch_at_stop: float

    @property
    def period(self) -> float:
        return self.slip + self.stick


# N = m = k_p = r_0 = 1, mu = 1 / (1 + 3 abs(v)), V = 0.2: Leine and others (1998), to ten digits
LEINE = StickSlip(4.2959995255, 7.7050317694, -0.5410063539)


def undamped_stick_slip(p: Parameters) -> StickSlip:
    """The cycle with a jump of friction and without damping: during slip the stretch oscillates
    about that of mu_k with the amplitude that it has at the release."""
    speed = p.r_0 * p.Omega
    omega = math.sqrt(p.k_p / p.m)
    drop = (p.mu_s - p.mu_k) * p.N / p.k_p
    slip = 2 * (math.pi - math.atan(drop * omega / speed)) / omega
    return StickSlip(slip, 2 * drop / speed, (2 * p.mu_k - p.mu_s) * p.N / p.k_p)


def friction_coefficient(p: Parameters, speed: float) -> float:
    """The coefficient of friction at a slip speed > 0, m/s, where it falls gradually."""
    share = 1 / (1 + p.friction_decay * speed)
    if p.friction_law == "exponential":
        share = np.exp(-p.friction_decay * speed)
    return p.mu_k + (p.mu_s - p.mu_k) * share + p.viscous_friction * speed


def friction_slope(p: Parameters, speed: float) -> float:
    """Slope of the coefficient of friction over the slip speed, s/m."""
    d = p.friction_decay
    steepness = d / (1 + d * speed) ** 2
    if p.friction_law == "exponential":
        steepness = d * np.exp(-d * speed)
    return -(p.mu_s - p.mu_k) * steepness + p.viscous_friction


def sliding_eigenvalues(p: Parameters) -> np.ndarray:
    """Roots of m s^2 + (c_p + N mu'(V)) s + k_p = 0, those of steady sliding, 1/s, (2,)."""
    return np.roots([p.m, p.c_p + p.N * friction_slope(p, p.r_0 * p.Omega), p.k_p]).astype(complex)


def hopf_speed(p: Parameters) -> float:
    """The speed V at which the damping c_p + N mu'(V) of steady sliding vanishes, m/s."""
    drop = (p.mu_s - p.mu_k) * p.N
    ratio = drop * p.friction_decay / (p.c_p + p.N * p.viscous_friction)
    if p.friction_law == "exponential":
        return math.log(ratio) / p.friction_decay
    return (math.sqrt(ratio) - 1) / p.friction_decay


def next_extreme_pull(p: Parameters, stretch: float) -> tuple[float, float]:
    """Time (s) and stretch (m) at the next largest stretch of a motion that slips on from one, where
    v = V; falling friction."""
    speed = p.r_0 * p.Omega

    def rates(_, state):
        stretch, slip_speed = state
        mu = friction_coefficient(p, slip_speed)
        growth = speed - slip_speed
        return [growth, (p.k_p * stretch + p.c_p * growth - mu * p.N) / p.m]

    def excess(_, state):
        return state[1] - speed

    excess.direction = 1
    excess.terminal = 2  # the first one is the start
    run = solve_ivp(
        rates,
        (0.0, 10 * math.tau * math.sqrt(p.m / p.k_p)),
        [stretch, speed],
        method="DOP853",
        rtol=1e-13,
        atol=1e-16,
        events=excess,
    )
    return float(run.t_events[0][-1]), float(run.y_events[0][-1][0])


def slipping_cycle(p: Parameters, low: float, high: float) -> tuple[float, float]:
    """Period (s) and largest stretch (m) of the cycle that slips all the time, whose largest
    stretch is between two values from which motions decay and grow."""

    def growth(stretch: float) -> float:
        return next_extreme_pull(p, stretch)[1] - stretch

    stretch = float(brentq(growth, low, high, xtol=1e-16, rtol=1e-14))
    return next_extreme_pull(p, stretch)[0], stretch
