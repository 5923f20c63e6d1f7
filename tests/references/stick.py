"""Stick under a drive that stands still, which is linear, by the matrix exponential of its equations.

With V the vertical force on slider and modes and H the one along the path, the equations are

    a'' + 2 xi omega a' + omega^2 a = -psi V,    b'' + 2 xi omega b' + omega^2 b = t H,
    m u'' = V - N - k (u - u_0) - c u',    m sum t b'' = r_0 k_p psi - c_p sum t b' - H,
    r_0 psi' = -sum t b',

with u = sum psi a in rigid contact, and V = (sum psi a - u) / C on a compliant one.
"""

import numpy as np
from scipy.linalg import expm

from disc_model import Parameters, State
from disc_model.disc.flexibility import contact_compliance
from disc_model.disc.plate import modal_damping, mode_arrays, tangential_amplitudes


def margin_of_stick(p: Parameters, state: State, duration: float, samples: int) -> float:
    """The least of mu_s R - abs(T) at evenly spaced times, N: friction holds as long as it is
    positive. T and R are the tangential and the normal force, as far as `p` tells them apart."""
    modes = mode_arrays(p)
    n = len(modes.psi)
    t = tangential_amplitudes(p)
    damping = modal_damping(p)
    compliance = contact_compliance(p)
    flexibility = float(np.sum((modes.psi / modes.omega) ** 2)) + compliance
    u_0 = -p.N * flexibility

    # rows of the state (a, a', b, b', u, u', psi, 1) that give a force or an acceleration
    size = 4 * n + 4
    a, rate_a, b, rate_b = (np.eye(size)[i * n : (i + 1) * n] for i in range(4))
    u, rate_u, turn, one = np.eye(size)[4 * n :]
    free_a = -damping[:, None] * rate_a - modes.omega[:, None] ** 2 * a
    free_b = -damping[:, None] * rate_b - modes.omega[:, None] ** 2 * b
    if compliance:
        V = (modes.psi @ a - u) / compliance
    else:
        u = modes.psi @ a
        rate_u = modes.psi @ rate_a
        load = p.N * one + p.k * (u - u_0 * one) + p.c * rate_u
        V = (load + p.m * modes.psi @ free_a) / (1 + p.m * modes.psi @ modes.psi)
    pull = p.r_0 * p.k_p * turn - p.c_p * t @ rate_b
    H = (pull - p.m * t @ free_b) / (1 + p.m * t @ t)
    lift = (V - p.N * one - p.k * (u - u_0 * one) - p.c * rate_u) / p.m

    matrix = np.zeros((size, size))
    matrix[:n] = rate_a
    matrix[n : 2 * n] = free_a - np.outer(modes.psi, V)
    matrix[2 * n : 3 * n] = rate_b
    matrix[3 * n : 4 * n] = free_b + np.outer(t, H)
    if compliance:
        matrix[4 * n] = rate_u
        matrix[4 * n + 1] = lift
    matrix[4 * n + 2] = -(t @ rate_b) / p.r_0

    slope = (modes.diameters * modes.psi) @ b / p.r_0
    if p.contact_force != "normal":
        slope = 0 * slope
    step = expm(matrix * duration / samples)
    x = np.concatenate(
        [state.a, state.alpha, state.b, state.beta, [state.u, state.u_velocity, state.psi, 1.0]]
    )
    least = np.inf
    for _ in range(samples):
        beta = slope @ x
        # T (1 + beta^2) and R (1 + beta^2)
        along = H @ x - beta * (V @ x)
        across = V @ x + beta * (H @ x)
        least = min(least, (p.mu_s * across - abs(along)) / (1 + beta**2))
        x = step @ x
    return float(least)
