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
    stick = 2 * drop / speed
    friction = 2 * p.mu_k - p.mu_s
    force = friction * p.N
    return StickSlip(slip, stick, force / p.k_p)


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
    speed = p.r_0 * p.Omega
    slope = friction_slope(p, speed)
    damping = p.c_p + p.N * slope
    return np.roots([p.m, damping, p.k_p]).astype(complex)


def hopf_speed(p: Parameters) -> float:
    """The speed V at which the damping c_p + N mu'(V) of steady sliding vanishes, m/s."""
    drop = (p.mu_s - p.mu_k) * p.N
    ratio = drop * p.friction_decay / (p.c_p + p.N * p.viscous_friction)
    if p.friction_law == "exponential":
        return math.log(ratio) / p.friction_decay
    return (math.sqrt(ratio) - 1) / p.friction_decay


def slip_until(p: Parameters, stretch: float, slip_speed: float, event, direction, count=1):
    """Time (s), stretch (m) and slip speed (m/s) where a function of stretch, slip speed and the
    rate of that, m/s^2, crosses zero in a direction for the ``count``-th time in a slip."""
    speed = p.r_0 * p.Omega

    def rates(_, state):
        stretch, slip_speed = state
        growth = speed - slip_speed
        friction = friction_coefficient(p, slip_speed) * p.N
        return [growth, (p.k_p * stretch + p.c_p * growth - friction) / p.m]

    def met(time, state):
        return event(*state, rates(time, state)[1])

    met.direction = direction
    met.terminal = count
    run = solve_ivp(
        rates,
        (0.0, 10 * math.tau * math.sqrt(p.m / p.k_p)),
        [stretch, slip_speed],
        method="DOP853",
        rtol=1e-13,
        atol=1e-16,
        events=met,
    )
    return float(run.t_events[0][-1]), *run.y_events[0][-1].tolist()


def next_extreme_pull(p: Parameters, stretch: float) -> tuple[float, float]:
    """Time (s) and stretch (m) at the next largest stretch of a motion that slips on from one, where
    v = V, as it is at the start; falling friction."""
    speed = p.r_0 * p.Omega
    time, largest, _ = slip_until(p, stretch, speed, lambda _, v, __: v - speed, 1, count=2)
    return time, largest


def least_slip_speed(p: Parameters) -> float:
    """The first minimum of the slip speed after a release, m/s; stick-slip ends where it is zero."""
    speed = p.r_0 * p.Omega
    release = (p.mu_s * p.N - p.c_p * speed) / p.k_p
    # from a small speed: at rest the release may be an equilibrium of the force
    return slip_until(p, release, 1e-12 * speed, lambda _, __, rate: rate, 1)[2]


def slipping_cycle(p: Parameters, low: float, high: float) -> tuple[float, float]:
    """Period (s) and largest stretch (m) of the cycle that slips all the time, whose largest
    stretch is between two values from which motions decay and grow."""

    def growth(stretch: float) -> float:
        return next_extreme_pull(p, stretch)[1] - stretch

    stretch = float(brentq(growth, low, high, xtol=1e-16, rtol=1e-14))
    return next_extreme_pull(p, stretch)[0], stretch


# ---- Run-up and stop, without falling friction


def release_on_run_up(p: Parameters, acceleration: float) -> float:
    """Time (s) at which a block is released whose drive starts from rest with an acceleration
    (m/s^2): k_p V t / 2 + c_p V = mu_s N."""
    by_speed = p.c_p * acceleration
    by_way = 0.5 * p.k_p * acceleration
    root = math.sqrt(by_speed**2 + 4 * by_way * p.mu_s * p.N)
    return 2 * p.mu_s * p.N / (by_speed + root)


class Stop(NamedTuple):
    """Where a block comes to rest: time in s, stretch of the spring in m."""

    time: float
    stretch: float


def stop_of_overdamped_block(p: Parameters, deceleration: float) -> Stop:
    """The stop of a block that slides steadily until the time 0, where the drive begins to slow down
    by a deceleration (m/s^2), until it stands still.

    In slip m y'' + c_p y' + k_p y = mu_k N - m abs(V'), of which both solutions decay.
    """
    damping = p.c_p / (2 * p.m)
    root = math.sqrt(damping**2 - p.k_p / p.m)
    rates = np.array([-damping + root, -damping - root])
    shift = p.m * deceleration / p.k_p  # of the equilibrium under way
    standstill = p.r_0 * p.Omega / deceleration

    # y from the equilibrium under way, at rest there but for the shift
    shares = shift * np.array([-rates[1], rates[0]]) / (rates[0] - rates[1])
    then = shares * np.exp(rates * standstill)
    # y from the equilibrium that follows, whose y' is the same
    away = then.sum() - shift
    speed = (rates * then).sum()
    later = np.array([speed - rates[1] * away, rates[0] * away - speed]) / (rates[0] - rates[1])
    # y' vanishes, and the block with it
    time = math.log(-later[1] * rates[1] / (later[0] * rates[0])) / (rates[0] - rates[1])
    stretch = p.mu_k * p.N / p.k_p + (later * np.exp(rates * time)).sum()
    return Stop(standstill + time, float(stretch))


def stop_of_released_block(p: Parameters, stretch: float) -> Stop:
    """The stop of an undamped block without a drive that is let go at a stretch: friction takes
    2 mu_k N / k_p of the stretch in each half of a period, until it can hold the rest."""
    halves = 0
    while abs(stretch) > p.mu_s * p.N / p.k_p:
        stretch = -(stretch - math.copysign(2 * p.mu_k * p.N / p.k_p, stretch))
        halves += 1
    return Stop(halves * math.pi * math.sqrt(p.m / p.k_p), stretch)
