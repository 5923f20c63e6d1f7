"""Motions by a Runge-Kutta method of fixed steps, with the couple of friction; and the consistent
law.

By the model's law (docs/model.md) friction turns with the slider's speed f, and in stick f = 0,
though the surface under the slider moves at v_s = sum t_l beta_l.  By the consistent law the slip
speed is r_0 f - v_s, and in stick r_0 f = v_s.  Rigid contact, vertical force.  To print what the
consistent law changes (a quarter of an hour)::

    python -m tests.references.fixed_step
"""

from pathlib import Path

import numpy as np
from numba import njit

#: s; 0.05 rad of the fastest of nine modes: first separations change in their eighth digit if it is halved
STEP = 1e-5


@njit
def motion(q, modes, y, side, consistent, out):
    """Fills rates of a, b, alpha, beta, psi, f, u, u'; returns P, T, the slip speed, v_s, w and w'
    under the slider.

    ``side`` is the sign of the slip speed, 0 in stick and 2 in separation; u and u' count in
    separation only."""
    N, Omega, m, k, c, k_p, c_p, _, mu_k, r_0, u_0 = q
    w2, s, l, d, t = modes
    n = len(s)
    f = y[-3]
    F = k_p * y[-4] + c_p * (Omega - f)
    w = 0.0
    v = 0.0
    A = 0.0
    B = 0.0
    S2 = 0.0
    T2 = 0.0
    drift = 0.0
    surface = 0.0
    for i in range(n):
        a = y[i]
        b = y[n + i]
        alpha = y[2 * n + i]
        beta = y[3 * n + i]
        turn = l[i] * f
        out[i] = alpha + turn * b
        out[n + i] = beta - turn * a
        out[2 * n + i] = -d[i] * alpha - w2[i] * a + turn * beta
        out[3 * n + i] = -d[i] * beta - w2[i] * b - turn * alpha
        w = w + s[i] * a
        v = v + s[i] * out[i]
        B = B + l[i] * s[i] * b
        A += s[i] * (out[2 * n + i] + turn * out[n + i])
        S2 = S2 + s[i] ** 2
        T2 = T2 + t[i] ** 2
        drift = drift + t[i] * out[3 * n + i]
        surface = surface + t[i] * beta
    load = N + k * (w - u_0) + c * v + m * A
    P = 0.0
    T = 0.0
    rate = F / m
    if side == 0:
        # consistent: r_0 f' = v_s' = drift + T2 T
        if consistent:
            T = (r_0 * F - m * drift) / (1 + m * T2)
        else:
            T = r_0 * F
        rate = 0.0
        if consistent:
            rate = (drift + T2 * T) / r_0
        P = (load + m * B * rate) / (1 + m * S2)
    elif side != 2:
        P = (load + B * F) / (1 + m * S2 + side * mu_k * B / r_0)
        T = side * mu_k * P
        rate = (F - T / r_0) / m
    out[-4] = Omega - f
    out[-3] = rate
    out[-2] = y[-1]
    out[-1] = -(N + k * (y[-2] - u_0) + c * y[-1]) / m
    for i in range(n):
        out[2 * n + i] -= s[i] * P
        out[3 * n + i] += t[i] * T
    return P, T, r_0 * f - (surface if consistent else 0.0), surface, w, v


@njit
def advance(q, modes, y, side, consistent, bilateral, h):
    """The state after h, and what may be negative there if the phase has ended before."""
    k1 = np.empty_like(y)
    k2 = np.empty_like(y)
    k3 = np.empty_like(y)
    k4 = np.empty_like(y)
    motion(q, modes, y, side, consistent, k1)
    motion(q, modes, y + h / 2 * k1, side, consistent, k2)
    motion(q, modes, y + h / 2 * k2, side, consistent, k3)
    motion(q, modes, y + h * k3, side, consistent, k4)
    y = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    P, T, speed, _, w, _ = motion(q, modes, y, side, consistent, k1)
    if side == 2:
        return y, y[-2] - w
    if side == 0:
        margin = q[7] * P - abs(T)
    else:
        margin = side * speed
    if bilateral:
        return y, margin
    return y, min(P, margin)


@njit
def change(q, modes, y, side, consistent, bilateral):
    """The next phase at an event, where contact may be lost or slip may end or turn; changes the
    state."""
    out = np.empty_like(y)
    n = len(modes[1])
    P, T, speed, _, w, v = motion(q, modes, y, side, consistent, out)
    if side == 2:  # a plastic impact
        y[2 * n : 3 * n] -= modes[1] * (v - y[-1]) / (np.sum(modes[1] ** 2) + 1 / q[2])
        side = np.sign(speed)
        P, _, _, _, w, v = motion(q, modes, y, side, consistent, out)
        if P >= 0:
            return side
    if P < 0 and not bilateral:
        y[-2] = w
        y[-1] = v
        return 2.0
    if side == 0:
        return np.sign(T)
    y[-3] -= speed / q[9]
    P, T, _, _, _, _ = motion(q, modes, y, 0.0, consistent, out)
    if abs(T) < q[7] * P:
        return 0.0
    return np.sign(T)


@njit
def follow(q, modes, y, t_end, h, consistent, bilateral, stop):
    """From stick: first separation or nan, range of u in the last second, largest abs(v_s) before
    the separation; with ``stop`` no further than to the separation."""
    t = 0.0
    side = 0.0
    low = np.inf
    high = -np.inf
    fastest = 0.0
    first = np.nan
    out = np.empty_like(y)
    while t < t_end:
        before = y
        y, margin = advance(q, modes, y, side, consistent, bilateral, h)
        step = h
        if margin < 0:
            left = 0.0
            right = h
            while right - left > 1e-15:
                middle = (left + right) / 2
                y, margin = advance(q, modes, before, side, consistent, bilateral, middle)
                if margin < 0:
                    right = middle
                else:
                    left = middle
            y, margin = advance(q, modes, before, side, consistent, bilateral, right)
            side = change(q, modes, y, side, consistent, bilateral)
            step = right
            if side == 2 and np.isnan(first):
                first = t + right
                if stop:
                    break
            if right < 1e-9:  # leads away from an event at the start of a phase
                y = advance(q, modes, y, side, consistent, bilateral, 1e-9)[0]
                step = right + 1e-9
        t += step
        _, _, _, surface, w, _ = motion(q, modes, y, side, consistent, out)
        if np.isnan(first):
            fastest = max(fastest, abs(surface))
        if t > t_end - 1:
            if side == 2:
                w = y[-2]
            low = min(low, w)
            high = max(high, w)
    return first, high - low, fastest


def first_separation(problem, t_end, h=STEP, consistent=False, bilateral=False, stop=True):
    """Of a `taylor.Problem`, from the static start: `follow`, the last over r_0 Omega."""
    names = ("N", "Omega", "m", "k", "c", "k_p", "c_p", "mu_s", "mu_k", "r_0", "u_0")
    q = np.array([float(getattr(problem, name)) for name in names])
    modes = np.array([problem.w2, problem.s, problem.l, problem.d, problem.t], float)
    start = np.zeros(4 * len(problem.s) + 4)
    start[: len(problem.s)] = problem.equilibrium().a
    time, width, fastest = follow(q, modes, start, float(t_end), h, consistent, bilateral, stop)
    return time, width, fastest / (q[9] * q[1])


CASES = [(385, 10), (385, 15), (385, 20), (600, 15), (600, 20), (200, 20), (200, 30)]
"""N and rad/s; the paper's disc with orthonormal modes, friction half a thickness above its middle plane."""
BRAKE = [(N, Omega) for N in (8000, 16000) for Omega in (20, 40, 60, 80, 120)]
"""The same on the disc of config/discs/brake.csv (docs/details_friction.md)."""


def compare_laws():
    """Prints, for both laws, first separations, ranges of u in the end, and largest abs(v_s)/(r_0
    Omega) before."""
    from disc_model import Disc, Parameters
    from tests.references.taylor import problem_of

    brake = {
        "disc": Disc.from_csv(Path(__file__).parents[2] / "config" / "discs" / "brake.csv"),
        "r_0": 0.1,
        "k": 1e6,
    }
    brake |= {"k_p": 1e6, "m": 0.5, "mu_s": 0.45, "mu_k": 0.35}
    for N, Omega in CASES + BRAKE:
        values, t_end, h = (
            (brake, 40, 4e-6)
            if (N, Omega) in BRAKE
            else ({"normalization": "orthonormal"}, 80, STEP)
        )
        p = Parameters(N=N, Omega=Omega, friction_offset="surface", **values)
        for consistent in (False, True):
            time, width, share = first_separation(problem_of(p), t_end, h, consistent, False, False)
            held = first_separation(problem_of(p), t_end, h, consistent, True)[1]
            print(
                f"N={N} Omega={Omega} {'consistent' if consistent else 'model'}: separates at {time:.2f} s,",
                end=" ",
            )
            print(
                f"range {1e3 * width:.3g} mm, bilateral {1e3 * held:.3g} mm, surface before {share:.3f}",
                flush=True,
            )


if __name__ == "__main__":
    compare_laws()
