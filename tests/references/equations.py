"""The equations of docs/model.md as they stand there, a function for each section; numpy, one state at a time.

Read beside the page: names are its symbols, sums run over the rows of `plate_modes`, `s` is a `disc_model.State`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import special
from scipy.integrate import quad

from disc_model import Parameters, State, plate_modes

BESSEL = (
    (special.jv, special.jvp, -1),
    (special.yv, special.yvp, -1),
    (special.iv, special.ivp, 1),
    (special.kv, special.kvp, 1),
)
"""Each with its derivative, and the sign of its Laplacian."""


@dataclass(frozen=True)
class Disc:
    """What the equations need of the modes: l, omega (rad/s), Psi (kg^-1/2), 2 xi omega (1/s), each (n_modes,)."""

    l: np.ndarray
    omega: np.ndarray
    Psi: np.ndarray
    damping: np.ndarray

    @property
    def S(self):
        return np.sum(self.Psi**2)


def modal_damping(p: Parameters) -> Disc:
    """Modal damping: what the equations need of the modes."""
    modes = plate_modes(p)
    omega = modes["omega"].to_numpy()
    return Disc(modes["diameters"].to_numpy(), omega, modes["psi"].to_numpy(), p.D_star / p.D * omega**2)


def in_plane_force(p: Parameters, s: State):
    """Sketch, frames and signs: F, N/m."""
    return p.k_p * s.psi + p.c_p * (p.Omega - s.f)


def modal_rates(d: Disc, s: State, P):
    """Disc in the slider's frame: rates of a, b, alpha, beta."""
    return {
        "a": s.alpha + d.l * s.f * s.b,
        "b": s.beta - d.l * s.f * s.a,
        "alpha": -d.damping * s.alpha - d.omega**2 * s.a + d.l * s.f * s.beta - d.Psi * P,
        "beta": -d.damping * s.beta - d.omega**2 * s.b - d.l * s.f * s.alpha,
    }


def displacement(d: Disc, s: State, angle):
    """Disc in the slider's frame: w(r_0, theta) at theta - phi = `angle`."""
    return np.sum(d.Psi * (s.a * np.cos(d.l * angle) + s.b * np.sin(d.l * angle)))


def vertical_motion(d: Disc, s: State):
    """Vertical motion of the point under the slider: w, its velocity, A, B."""
    w = np.sum(d.Psi * s.a)
    velocity = np.sum(d.Psi * (s.alpha + d.l * s.f * s.b))
    A = np.sum(d.Psi * (-d.damping * s.alpha - d.omega**2 * s.a + 2 * d.l * s.f * s.beta - d.l**2 * s.f**2 * s.a))
    B = np.sum(d.l * d.Psi * s.b)
    return w, velocity, A, B


def slip(p: Parameters, d: Disc, s: State, u_0):
    """Slip: P and the rates of psi and f."""
    u, velocity, A, B = vertical_motion(d, s)
    F = in_plane_force(p, s)
    P = (p.N + p.k * (u - u_0) + p.c * velocity + p.m * A + B * F) / painleve_denominator(p, d, s)
    return P, {"psi": p.Omega - s.f, "f": F / p.m - s.direction * p.mu_k * P / (p.m * p.r_0)}


def stick(p: Parameters, d: Disc, s: State, u_0):
    """Stick: P and the rates of psi and f."""
    u, velocity, A, _ = vertical_motion(d, s)
    P = (p.N + p.k * (u - u_0) + p.c * velocity + p.m * A) / (1 + p.m * d.S)
    return P, {"psi": p.Omega, "f": 0.0}


def force_after_release(p: Parameters, d: Disc, s: State, P_stick):
    """Stick: P just after a release, from P just before."""
    _, _, _, B = vertical_motion(d, s)
    direction = np.sign(in_plane_force(p, s))
    share = 1 + p.m * d.S
    return P_stick * (share + direction * p.mu_s * B / p.r_0) / (share + direction * p.mu_k * B / p.r_0)


def separation(p: Parameters, d: Disc, s: State, u_0):
    """Separation: P and the rates of psi, f, u and u'."""
    F = in_plane_force(p, s)
    acceleration = -(p.c * s.u_velocity + p.k * (s.u - u_0) + p.N) / p.m
    return 0.0, {"psi": p.Omega - s.f, "f": F / p.m, "u": s.u_velocity, "u_velocity": acceleration}


def impact(p: Parameters, d: Disc, s: State):
    """Impact at reattachment: p, alpha and u' after it."""
    _, velocity, _, _ = vertical_motion(d, s)
    impulse = (velocity - s.u_velocity) / (d.S + 1 / p.m)
    return impulse, s.alpha - d.Psi * impulse, s.u_velocity + impulse / p.m


def painleve_denominator(p: Parameters, d: Disc, s: State):
    """Painlevé's paradox: what P is divided by in slip."""
    _, _, _, B = vertical_motion(d, s)
    return 1 + p.m * d.S + s.direction * p.mu_k * B / p.r_0


def energies(p: Parameters, d: Disc, s: State, u_0):
    """Energy: transverse and in the plane, J."""
    u, velocity = s.u, s.u_velocity
    disc = 0.5 * np.sum(s.alpha**2 + s.beta**2 + d.omega**2 * (s.a**2 + s.b**2))
    transverse = disc + 0.5 * p.m * velocity**2 + 0.5 * p.k * (u - u_0) ** 2 + p.N * (u - u_0)
    return transverse, 0.5 * p.m * p.r_0**2 * s.f**2 + 0.5 * p.k_p * p.r_0**2 * s.psi**2


def powers(p: Parameters, d: Disc, s: State, P):
    """Energy: rates of both, W."""
    _, _, _, B = vertical_motion(d, s)
    rubbed = p.mu_k * p.r_0 * P * abs(s.f) if s.phase == "slip" else 0.0
    transverse = P * s.f * B - np.sum(d.damping * (s.alpha**2 + s.beta**2)) - p.c * s.u_velocity**2
    F = in_plane_force(p, s)
    return transverse, p.Omega * p.r_0**2 * F - rubbed - p.c_p * p.r_0**2 * (p.Omega - s.f) ** 2


def ramp(p: Parameters, rates, time):
    """Ramps: the case at a time after the begin of a stretch; rates are those of Omega and N."""
    return p.replace(Omega=p.Omega + rates[0] * time, N=p.N + rates[1] * time)


def power_of_ramp(s: State, u_0, rates):
    """Ramps: what the transverse energy gains besides, W."""
    return rates[1] * (s.u - u_0)


def energy_of_impact(p: Parameters, d: Disc, s: State, impulse):
    """Energy: what an impact adds to the transverse one, J."""
    _, _, _, B = vertical_motion(d, s)
    return -0.5 * impulse**2 * (d.S + 1 / p.m) + impulse * s.f * B


def start(p: Parameters, d: Disc):
    """Start: the static equilibrium and u_0, m."""
    zero, u_0 = np.zeros(len(d.l)), -p.N * np.sum(d.Psi**2 / d.omega**2)
    rest = {"time": 0.0, "phase": "stick", "direction": 0, "psi": 0.0, "f": 0.0, "u_velocity": 0.0}
    return State(u=u_0, a=-p.N * d.Psi / d.omega**2, b=zero, alpha=zero, beta=zero, **rest), u_0


def attached(p: Parameters, d: Disc):
    """Natural frequencies with the slider attached: those of the a_l, rad/s, ascending."""
    outer = np.outer(d.Psi, d.Psi)
    squares = np.linalg.eigvals(np.linalg.solve(np.eye(len(d.l)) + p.m * outer, np.diag(d.omega**2) + p.k * outer))
    return np.sort(np.sqrt(squares.real))


def edge_conditions(p: Parameters, l, omega):
    """Modes of the disc: R, R' at a, moment and shear at b, of J, Y, I, K: (4 conditions, 4 functions)."""
    wave = (p.rho * p.h * omega**2 / p.D) ** 0.25  # lambda / b
    columns = []
    for function, derivative, sign in BESSEL:

        def R(r, order=0, function=function, derivative=derivative):
            return function(l, wave * r) if order == 0 else wave * derivative(l, wave * r)

        laplacian, its_slope = sign * wave**2 * R(p.b), sign * wave**2 * R(p.b, 1)
        moment = laplacian - (1 - p.nu) * (R(p.b, 1) / p.b - l**2 * R(p.b) / p.b**2)
        shear = its_slope - (1 - p.nu) * l**2 / p.b**2 * (R(p.b, 1) - R(p.b) / p.b)
        columns.append([R(p.a), R(p.a, 1), moment, shear])
    return np.array(columns).T


def amplitude(p: Parameters, l, omega):
    """Modes of the disc; Two normalisations: |Psi_l|, kg^-1/2."""
    wave = (p.rho * p.h * omega**2 / p.D) ** 0.25
    conditions = edge_conditions(p, l, omega)
    sizes = np.max(np.abs(conditions), axis=0), np.max(np.abs(conditions), axis=1)
    C = np.linalg.svd(conditions / sizes[0] / sizes[1][:, None])[2][-1] / sizes[0]

    def R(r):
        return sum(c * function(l, wave * r) for c, (function, _, _) in zip(C, BESSEL, strict=True))

    if p.normalization == "orthonormal":
        scale = np.sqrt(2 * np.pi / p.b**2 * quad(lambda r: R(r) ** 2 * r, p.a, p.b, epsrel=1e-12)[0])
    else:
        scale = C[0]
    return abs(R(p.r_0) / scale) / np.sqrt(p.rho * p.h * p.b**2) * (np.sqrt(2) if l else 1)


def compliant(p: Parameters, d: Disc, s: State, u_0, C_r):
    """Other laws of contact: P and the rates of u and u'."""
    P = (vertical_motion(d, s)[0] - s.u) / C_r
    return P, {"u": s.u_velocity, "u_velocity": (P - p.N - p.k * (s.u - u_0) - p.c * s.u_velocity) / p.m}


def normal_slip(p: Parameters, d: Disc, s: State, u_0):
    """Other laws of contact: R, T and V in slip on a rigid contact."""
    u, velocity, A, B = vertical_motion(d, s)
    friction, slope = s.direction * p.mu_k, B / p.r_0
    below = (1 - friction * slope) * (1 + p.m * d.S) + (friction + slope) * slope
    R = (p.N + p.k * (u - u_0) + p.c * velocity + p.m * A + B * in_plane_force(p, s)) / below
    return R, friction * R, R - friction * R * slope


def normal_stick(p: Parameters, d: Disc, s: State, u_0):
    """Other laws of contact: R, T and V in stick on a rigid contact."""
    V, _ = stick(p, d, s, u_0)
    slope, F = vertical_motion(d, s)[3] / p.r_0, in_plane_force(p, s)
    R = (V + F * p.r_0 * slope) / (1 + slope**2)
    return R, p.r_0 * F - R * slope, V


def normal_compliant_slip(p: Parameters, d: Disc, s: State, u_0, C_r):
    """Other laws of contact: R, T and V in slip."""
    V, _ = compliant(p, d, s, u_0, C_r)
    R = V / (1 - s.direction * p.mu_k * vertical_motion(d, s)[3] / p.r_0)
    return R, s.direction * p.mu_k * R, V


def normal_turning(p: Parameters, d: Disc, s: State, R, T):
    """Other laws of contact: rate of f."""
    return (p.r_0 * in_plane_force(p, s) - T - R * vertical_motion(d, s)[3] / p.r_0) / (p.m * p.r_0)


def normal_impact(p: Parameters, d: Disc, s: State):
    """Other laws of contact: p, and alpha, u' and f after it."""
    _, velocity, _, B = vertical_motion(d, s)
    impulse = (velocity - s.u_velocity) / (d.S + 1 / p.m + B**2 / (p.m * p.r_0**2))
    return impulse, s.alpha - d.Psi * impulse, s.u_velocity + impulse / p.m, s.f - impulse * B / (p.m * p.r_0**2)


def normal_powers(p: Parameters, d: Disc, s: State, R, T, V):
    """Other laws of contact: rates of both energies, W."""
    transverse, _ = powers(p, d, s, V)
    held_back = p.r_0 * s.f * (T + R * vertical_motion(d, s)[3] / p.r_0)
    return transverse, p.Omega * p.r_0**2 * in_plane_force(p, s) - held_back - p.c_p * p.r_0**2 * (p.Omega - s.f) ** 2


def lost_at_a_normal_impact(p: Parameters, d: Disc, s: State, impulse):
    """Other laws of contact: what an impact takes of both energies together, J."""
    return 0.5 * impulse**2 * (d.S + 1 / p.m + vertical_motion(d, s)[3] ** 2 / (p.m * p.r_0**2))
