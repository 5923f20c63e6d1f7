"""Motions by a Runge-Kutta method of fixed steps, by the laws of docs/model.md in material
coordinates.

The modes are resolved about the material point of contact, over which the slider moves at the rate
g = f - v_s/r_0; friction follows the slip speed r_0 g, and in stick g = 0.  Contact is rigid or
compliant, its force vertical or normal to the bent disc.  Friction is mu_k
at any slip speed.  Nothing is shared with the engine or with the other references.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

#: s; 0.05 rad of the fastest of nine modes: first separations change in their eighth digit if it is halved
STEP = 1e-5

STICK = 0.0
SEPARATION = 2.0
"""Beside the sign of the slip speed, 1 or -1, a phase's ``side``."""


class Case(NamedTuple):
    """Numbers of a case, SI units; ``compliance`` is 0 if contact is rigid."""

    N: float
    Omega: float
    m: float
    k: float
    c: float
    k_p: float
    c_p: float
    mu_s: float
    mu_k: float
    r_0: float
    u_0: float
    compliance: float
    normal: bool


class Modes(NamedTuple):
    """Squares of frequencies, amplitudes, diameters, damping 2 xi omega, tangential amplitudes."""

    w2: np.ndarray
    s: np.ndarray
    l: np.ndarray
    d: np.ndarray
    t: np.ndarray


class Contact(NamedTuple):
    """What an instant is judged by."""

    R: float  # normal force, N
    T: float  # friction, N
    slip_speed: float  # m/s
    w: float  # displacement of the disc under the slider, m
    w_rate: float  # m/s


@njit(cache=True)
def motion(case, modes, y, side, rates):
    """Fill the rates of a, b, alpha, beta, psi, f, u, u'; return the `Contact`.

    u and u' are those of the disc in rigid contact, where their entries have no meaning."""
    n = len(modes.s)
    a = y[:n]
    b = y[n : 2 * n]
    alpha = y[2 * n : 3 * n]
    beta = y[3 * n : 4 * n]
    psi = y[4 * n]
    f = y[4 * n + 1]
    u = y[4 * n + 2]
    u_rate = y[4 * n + 3]
    s = modes.s
    l = modes.l
    t = modes.t
    r_0 = case.r_0
    m = case.m

    surface = np.sum(t * beta)
    if side == STICK:
        g = 0.0
    else:
        g = f - surface / r_0
    w = np.sum(s * a)
    slope = np.sum(l * s * b) / r_0
    w_rate = np.sum(s * alpha) + g * slope * r_0
    F = case.k_p * psi + case.c_p * (case.Omega - f)

    # accelerations without forces: of the modes, and of the disc's point up and along the path
    along = -modes.d * alpha - modes.w2 * a + l * g * beta
    across = -modes.d * beta - modes.w2 * b - l * g * alpha
    A = np.sum(s * (along + l * g * beta - (l * g) ** 2 * a))
    G = np.sum(t * across)
    vertical = 1.0 + m * np.sum(s**2)
    horizontal = 1.0 + m * np.sum(t**2)

    rigid = case.compliance == 0.0
    if rigid and side != SEPARATION:
        u = w
        u_rate = w_rate
    height = case.N + case.k * (u - case.u_0) + case.c * u_rate
    lean = 0.0
    if case.normal:
        lean = slope

    V = 0.0
    H = 0.0
    R = 0.0
    T = 0.0
    if side == STICK:
        if rigid:
            V = (height + m * A) / vertical
        else:
            V = (w - u) / case.compliance
        H = (r_0 * F - m * G) / horizontal
        T = (H - V * lean) / (1.0 + lean**2)
        R = V + T * lean
    elif side != SEPARATION:
        mu = side * case.mu_k
        if rigid:
            share = mu * slope * horizontal
            if case.normal:
                share = -mu * slope * vertical + slope * (mu + slope) * horizontal
            R = (height + m * A + slope * (r_0 * F - m * G)) / (vertical + share)
        else:
            R = (w - u) / case.compliance / (1.0 - mu * lean)
        T = mu * R
        V = R - T * lean
        H = T + R * lean

    rates[:n] = alpha + l * g * b
    rates[n : 2 * n] = beta - l * g * a
    rates[2 * n : 3 * n] = along - s * V
    rates[3 * n : 4 * n] = across + t * H
    rates[4 * n] = case.Omega - f
    rates[4 * n + 1] = (F - H / r_0) / m
    rates[4 * n + 2] = u_rate
    rates[4 * n + 3] = (V - height) / m
    return Contact(R, T, r_0 * g, w, w_rate)


@njit(cache=True)
def advance(case, modes, y, side, h):
    """Return the state after h, and what is negative there if the phase has ended before."""
    k1 = np.empty_like(y)
    k2 = np.empty_like(y)
    k3 = np.empty_like(y)
    k4 = np.empty_like(y)
    motion(case, modes, y, side, k1)
    motion(case, modes, y + h / 2 * k1, side, k2)
    motion(case, modes, y + h / 2 * k2, side, k3)
    motion(case, modes, y + h * k3, side, k4)
    y = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    now = motion(case, modes, y, side, k1)
    if side == SEPARATION:
        return y, y[-2] - now.w
    if side == STICK:
        margin = case.mu_s * now.R - abs(now.T)
    else:
        margin = side * now.slip_speed
    return y, min(now.R, margin)


@njit(cache=True)
def collide(case, modes, y, now):
    """Carry out a plastic impact."""
    n = len(modes.s)
    slope = np.sum(modes.l * modes.s * y[n : 2 * n]) / case.r_0
    lean = 0.0
    if case.normal:
        lean = slope
    give = np.sum(modes.s**2) + 1.0 / case.m
    give += lean**2 * (1.0 / case.m + np.sum(modes.t**2))
    p = (now.w_rate - y[-1]) / give
    y[2 * n : 3 * n] -= modes.s * p
    y[3 * n : 4 * n] += modes.t * p * lean
    y[-3] -= p * lean / (case.m * case.r_0)


@njit(cache=True)
def change(case, modes, y, side):
    """Return the phase after an event; contact may be lost, slip may end or turn."""
    rates = np.empty_like(y)
    now = motion(case, modes, y, side, rates)
    rigid = case.compliance == 0.0
    if side == SEPARATION:
        if rigid:
            collide(case, modes, y, now)
        now = motion(case, modes, y, side, rates)
        side = np.sign(now.slip_speed)
        now = motion(case, modes, y, side, rates)
        if not rigid or now.R >= 0.0:
            return side
    if now.R <= 0.0:
        if rigid:
            y[-2] = now.w
            y[-1] = now.w_rate
        return SEPARATION
    if side == STICK:
        return np.sign(now.T)
    y[-3] -= now.slip_speed / case.r_0
    now = motion(case, modes, y, STICK, rates)
    if abs(now.T) < case.mu_s * now.R:
        return STICK
    return np.sign(now.T)


@njit(cache=True)
def follow(case, modes, y, side, t_end, h, stop):
    """Follow the motion from a phase.

    Returns its events as rows of time (s) and ``side`` before and after, behind a row of the start;
    with ``stop`` no further than to the first separation."""
    t = 0.0
    found = [(t, side, side)]
    while t < t_end:
        before = y
        step = h
        y, margin = advance(case, modes, before, side, h)
        if margin < 0.0:
            left = 0.0
            right = h
            while right - left > 1e-15:
                middle = (left + right) / 2
                y, margin = advance(case, modes, before, side, middle)
                if margin < 0.0:
                    right = middle
                else:
                    left = middle
            y, margin = advance(case, modes, before, side, right)
            ended = side
            side = change(case, modes, y, ended)
            found.append((t + right, ended, side))
            step = right
            if stop and side == SEPARATION:
                break
            if right < 1e-9:  # leads away from an event at the start of a phase
                y = advance(case, modes, y, side, 1e-9)[0]
                step = right + 1e-9
        t += step
    return found


def case_and_modes(problem):
    """Numbers of a `taylor.Problem` for the functions of this module."""
    names = ("N", "Omega", "m", "k", "c", "k_p", "c_p", "mu_s", "mu_k", "r_0", "u_0", "C")
    numbers = [float(getattr(problem, name)) for name in names]
    case = Case(*numbers, normal=problem.normal)
    modes = Modes(*(np.asarray(getattr(problem, name), float) for name in Modes._fields))
    return case, modes


def start_of(state):
    """Vector and ``side`` of a `stored.State`."""
    slider = [state.psi, state.f, state.u, state.u_velocity]
    y = np.concatenate([state.a, state.b, state.alpha, state.beta, slider]).astype(float)
    sides = {"stick": STICK, "slip": float(state.direction), "separation": SEPARATION}
    return y, sides[state.phase]


def first_separation(problem, t_end):
    """Time (s) of that of a `taylor.Problem`, from the static start, or nan."""
    start = start_of(problem.equilibrium())
    found = follow(*case_and_modes(problem), *start, float(t_end), STEP, True)
    return min((time for time, _, after in found if after == SEPARATION), default=np.nan)


def switches(problem, start, duration, h=STEP):
    """Times since a `stored.State`, s, and kinds of the events."""
    found = follow(*case_and_modes(problem), *start_of(start), float(duration), h, False)
    times = []
    kinds = []
    for time, before, after in found[1:]:
        for kind in _kinds(before, after):
            times.append(time)
            kinds.append(kind)
    return np.array(times), kinds


def _kinds(before, after):
    """Kinds of the events between two phases."""
    if before == SEPARATION:
        return ["reattachment", "separation"][: 1 + (after == SEPARATION)]
    if after == SEPARATION:
        return ["separation"]
    if before == STICK:
        return ["stick_to_slip"]
    return ["slip_to_stick" if after == STICK else "slip_reversal"]
