"""First separations by a Runge-Kutta method of fixed steps, with the couple of friction; and the consistent law.

By the model's law (docs/model.md) friction turns with the slider's speed f, and in stick f = 0, though the surface
under the slider moves at v_s = sum t_l beta_l.  By the consistent law the slip speed is r_0 f - v_s, and in stick
r_0 f = v_s.  Rigid contact, vertical force.  To print what the consistent law changes (some minutes)::

    python -m tests.references.fixed_step
"""

import numpy as np
from numba import njit

#: s; 0.05 rad of the fastest of nine modes: first separations change in their eighth digit if it is halved
STEP = 1e-5


@njit
def motion(q, modes, y, side, consistent, out):
    """Fills rates of a, b, alpha, beta, psi, f; returns P, T, the slip speed and v_s.  ``side`` is 0 in stick."""
    N, Omega, m, k, c, k_p, c_p, _, mu_k, r_0, u_0 = q
    w2, s, l, d, t = modes
    n = len(s)
    f = y[4 * n + 1]
    F, w, v, A, B, S2, T2, drift, surface = k_p * y[4 * n] + c_p * (Omega - f), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(n):
        a, b, alpha, beta, turn = y[i], y[n + i], y[2 * n + i], y[3 * n + i], l[i] * f
        out[i], out[n + i] = alpha + turn * b, beta - turn * a
        out[2 * n + i] = -d[i] * alpha - w2[i] * a + turn * beta
        out[3 * n + i] = -d[i] * beta - w2[i] * b - turn * alpha
        w, v, B = w + s[i] * a, v + s[i] * out[i], B + l[i] * s[i] * b
        A += s[i] * (out[2 * n + i] + turn * out[n + i])
        S2, T2, drift, surface = S2 + s[i] ** 2, T2 + t[i] ** 2, drift + t[i] * out[3 * n + i], surface + t[i] * beta
    load = N + k * (w - u_0) + c * v + m * A
    if side == 0:
        # consistent: r_0 f' = v_s' = drift + T2 T
        T = (r_0 * F - m * drift) / (1 + m * T2) if consistent else r_0 * F
        rate = (drift + T2 * T) / r_0 if consistent else 0.0
        P = (load + m * B * rate) / (1 + m * S2)
    else:
        P = (load + B * F) / (1 + m * S2 + side * mu_k * B / r_0)
        T = side * mu_k * P
        rate = (F - T / r_0) / m
    out[4 * n], out[4 * n + 1] = Omega - f, rate
    for i in range(n):
        out[2 * n + i] -= s[i] * P
        out[3 * n + i] += t[i] * T
    return P, T, r_0 * f - (surface if consistent else 0.0), surface


@njit
def advance(q, modes, y, side, consistent, h):
    """The state after h, and what may be negative there if the phase has ended before."""
    k1, k2, k3, k4 = np.empty_like(y), np.empty_like(y), np.empty_like(y), np.empty_like(y)
    motion(q, modes, y, side, consistent, k1)
    motion(q, modes, y + h / 2 * k1, side, consistent, k2)
    motion(q, modes, y + h / 2 * k2, side, consistent, k3)
    motion(q, modes, y + h * k3, side, consistent, k4)
    y = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    P, T, speed, _ = motion(q, modes, y, side, consistent, k1)
    return y, min(P, q[7] * P - abs(T) if side == 0 else side * speed)


@njit
def follow(q, modes, y, t_end, h, consistent):
    """From stick to the first separation: its time or nan, range of P in the last tenth, and the largest abs(v_s)."""
    t, side, low, high, fastest, out = 0.0, 0.0, np.inf, -np.inf, 0.0, np.empty_like(y)
    while t < t_end:
        before, (y, margin) = y, advance(q, modes, y, side, consistent, h)
        if margin < 0:
            left, right = 0.0, h
            while right - left > 1e-15:
                middle = (left + right) / 2
                y, margin = advance(q, modes, before, side, consistent, middle)
                left, right = (left, middle) if margin < 0 else (middle, right)
            y, margin = advance(q, modes, before, side, consistent, right)
            t += right
            P, T, speed, _ = motion(q, modes, y, side, consistent, out)
            if P < 0:
                return t, low, high, fastest
            if side == 0:
                side = np.sign(T)
            else:
                y[-1] -= speed / q[9]
                P, T, _, _ = motion(q, modes, y, 0.0, consistent, out)
                side = 0.0 if abs(T) < q[7] * P else np.sign(T)
        else:
            t += h
        P, _, _, surface = motion(q, modes, y, side, consistent, out)
        fastest = max(fastest, abs(surface))
        if t > 0.9 * t_end:
            low, high = min(low, P), max(high, P)
    return np.nan, low, high, fastest


def first_separation(problem, t_end, h=STEP, consistent=False):
    """Of a `taylor.Problem`, from the static start: `follow`, the last over r_0 Omega."""
    names = ("N", "Omega", "m", "k", "c", "k_p", "c_p", "mu_s", "mu_k", "r_0", "u_0")
    q = np.array([float(getattr(problem, name)) for name in names])
    modes = np.array([problem.w2, problem.s, problem.l, problem.d, problem.t], float)
    start = np.zeros(4 * len(problem.s) + 2)
    start[: len(problem.s)] = problem.equilibrium().a
    time, low, high, fastest = follow(q, modes, start, float(t_end), h, consistent)
    return time, low, high, fastest / (q[9] * q[1])


CASES = [(385, 10), (385, 15), (385, 20), (600, 15), (600, 20), (200, 20), (200, 30)]
"""N and rad/s; the paper's disc with orthonormal modes, friction half a thickness above its middle plane."""


def compare_laws():
    """Prints, for both laws, the first separation within 80 s or the range of P, and largest abs(v_s)/(r_0 Omega)."""
    from disc_model import Parameters
    from tests.references.taylor import problem_of

    for N, Omega in CASES:
        p = Parameters(N=N, Omega=Omega, normalization="orthonormal", friction_offset="surface")
        for consistent in (False, True):
            time, low, high, share = first_separation(problem_of(p), 80, STEP, consistent)
            outcome = f"P {low:.0f} to {high:.0f} N" if np.isnan(time) else f"separates at {time:.2f} s"
            law = "consistent" if consistent else "model's"
            print(
                f"N={N} Omega={Omega} {law:10} {outcome}, surface at most {share:.4f} of the drive's speed", flush=True
            )


if __name__ == "__main__":
    compare_laws()
