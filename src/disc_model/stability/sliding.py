"""Steady sliding: the slider rests in space, f = Omega, and the disc stands still in the slider's frame.

The module computes the equilibrium of the equations of slip (docs/model.md, Slip) and its stability.  With
d = 2 xi omega the disc's response to the force P that rotates over it is

    b_l = d l Omega a_l / (l^2 Omega^2 - omega^2),
    a_l = psi_l P / (l^2 Omega^2 - omega^2 + d^2 l^2 Omega^2 / (l^2 Omega^2 - omega^2)),

so that w = chi P.  With V for the vertical force, C for the contact's compliance and u = w - C V,
V = (N - k u_0) / (1 - k chi + k C); under the normal force, with beta = B / r_0, R = V / (1 - mu_k beta) and
r_0 F = (mu_k + beta) R.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from disc_model.errors import StatusBase, refuse
from disc_model.flexibility import contact_give
from disc_model.parameters import Parameters
from disc_model.plate import Modes, modal_damping, mode_arrays
from disc_model.stability.return_map import Array, case_faults


class SlidingStatus(StatusBase):
    """Whether steady sliding exists; `advice` says what that means."""

    OK = "ok", "Steady sliding exists; its growth rate says whether it is stable."
    NO_CONTACT = "no_contact", "The equilibrium would need a contact force that is not positive: lower Omega."
    AT_REST = "at_rest", "The disc is not driven (Omega = 0): nothing slides."
    NO_SPRING = "no_spring", "Without the spring in the plane (k_p = 0) nothing balances friction."
    PARADOX = "paradox", "Painleve's paradox: rigid friction on this slope has no solution; lower mu_k or N."


def _no_numbers() -> Array:
    return np.zeros(0)


@dataclass(frozen=True, eq=False)
class SteadySliding:
    """The sliding equilibrium.

    Attributes
    ----------
    status, message : whether the equilibrium exists, or why not; numbers are then nan and arrays empty
    contact_force : N; it is P, or R under the normal force
    psi : rad, angle of the drive point ahead of the slider
    a, b, alpha, beta : shape (n_modes,), rows of `plate_modes`
    eigenvalues : 1/s, complex, largest real part first; (4 per pair of modes + 2 per axisymmetric mode + 2,),
        plus 2 on a compliant contact
    growth_rate : 1/s, largest real part of the eigenvalues
    jacobian : Jacobian of the equations of slip; rows a and alpha of all modes, b and beta of the pairs, psi, f, and
        u, u' on a compliant contact
    """

    status: SlidingStatus
    message: str
    contact_force: float = math.nan
    psi: float = math.nan
    a: Array = field(default_factory=_no_numbers, repr=False)
    b: Array = field(default_factory=_no_numbers, repr=False)
    alpha: Array = field(default_factory=_no_numbers, repr=False)
    beta: Array = field(default_factory=_no_numbers, repr=False)
    eigenvalues: NDArray[np.complex128] = field(default_factory=lambda: np.zeros(0, complex), repr=False)
    growth_rate: float = math.nan
    jacobian: Array = field(default_factory=lambda: np.zeros((0, 0)), repr=False)

    @property
    def stable(self) -> bool:
        """Whether small disturbances decay: the growth rate is negative."""
        return self.growth_rate < 0


def steady_sliding(p: Parameters) -> SteadySliding:
    """Find the equilibrium f = Omega and its eigenvalues.

    Raises
    ------
    ParameterError
        If `p` is not a `Parameters`, or has no modes.
    """
    refuse(case_faults(p, "steady_sliding"))
    if p.Omega == 0:
        return _absent(SlidingStatus.AT_REST)
    if p.k_p == 0 and (p.mu_k > 0 or (p.contact_force == "normal" and p.D_star > 0)):
        return _absent(SlidingStatus.NO_SPRING)
    modes = mode_arrays(p)
    damping = modal_damping(p)
    a, b, force = _equilibrium(p, modes, damping)  # the vertical force
    if not (math.isfinite(force) and force > 0) and p.contact != "bonded":
        return _absent(SlidingStatus.NO_CONTACT)
    l = modes.diameters
    alpha, beta = -l * p.Omega * b, l * p.Omega * a
    slope = float(np.sum(l * modes.psi * b))
    law = _Law(p, float(np.sum(modes.psi**2)), slope / p.r_0, force)
    if law.denominator <= 1e-6:
        return _absent(SlidingStatus.PARADOX)
    jacobian = _jacobian(p, modes, damping, a, b, beta, slope, law)
    eigenvalues = np.linalg.eigvals(jacobian).astype(complex)
    eigenvalues = eigenvalues[np.argsort(-eigenvalues.real, kind="stable")]
    # F = k_p psi
    psi = law.resistance * law.force / (p.r_0 * p.k_p) if p.k_p > 0 else math.nan
    growth = float(eigenvalues[0].real)
    name = "R" if law.normal else "P"
    message = f"steady sliding with {name} = {law.force:.6g} N, {'stable' if growth < 0 else 'not stable'}"
    return SteadySliding(SlidingStatus.OK, message, law.force, psi, a, b, alpha, beta, eigenvalues, growth, jacobian)


class _Law:
    """The law of contact at the equilibrium.

    beta : B / r_0, but 0 under the vertical force, which does not depend on it
    resistance : in-plane force on the slider over the contact force
    force : contact force: P, or R under the normal force
    denominator : denominator of the contact force in slip
    """

    def __init__(self, p: Parameters, S2: float, beta: float, vertical: float) -> None:
        self.give, self.normal = contact_give(p), p.contact_force == "normal"
        self.beta = beta if self.normal else 0.0
        self.resistance = p.mu_k + self.beta
        self.share = 1 - p.mu_k * self.beta  # V / R
        self.force = vertical / self.share
        mobility = 1 + p.m * S2
        # by beta: of R, besides that of the numerator without B F: F r_0 = resistance R cancels for the vertical force
        if self.give:
            self.denominator, by_beta = self.share, p.mu_k * self.force
        else:
            self.denominator = mobility * self.share + self.resistance * beta
            by_beta = self.force * (mobility * p.mu_k - self.beta)
        self.by_beta = by_beta if self.normal else 0.0


def _absent(status: SlidingStatus) -> SteadySliding:
    return SteadySliding(status, status.advice)


def _equilibrium(p: Parameters, modes: Modes, damping: Array) -> tuple[Array, Array, float]:
    """Modal coordinates a, b (n_modes,) and the vertical force at the equilibrium."""
    turned = modes.diameters * p.Omega
    gap = turned**2 - modes.omega**2
    with np.errstate(divide="ignore", invalid="ignore"):
        by_force = modes.psi * gap / (gap**2 + (damping * turned) ** 2)
        give = contact_give(p)
        static = float(np.sum(modes.psi**2 / modes.omega**2)) + give
        force = p.N * (1 + p.k * static) / (1 - p.k * (float(np.sum(modes.psi * by_force)) - give))
        across = modes.psi * damping * turned / (gap**2 + (damping * turned) ** 2)
    return by_force * force, across * force, force


def _jacobian(
    p: Parameters, modes: Modes, damping: Array, a: Array, b: Array, beta: Array, slope: float, law: _Law
) -> Array:
    """Jacobian of the equations of slip at the equilibrium.

    Rows a, alpha of all modes, b, beta of the pairs, psi, f, and u, u' on a compliant contact.
    """
    n, pairs = len(modes.omega), np.flatnonzero(modes.diameters > 0)
    m = len(pairs)
    l, w2, weight = modes.diameters.astype(float), modes.omega**2, modes.psi
    at_alpha, at_b, at_beta, at_psi, at_f = n, 2 * n, 2 * n + m, 2 * n + 2 * m, 2 * n + 2 * m + 1
    size = at_f + 1 + (2 if law.give else 0)
    A = np.zeros((size, size))
    i, j = np.arange(n), np.arange(m)
    turned = l * p.Omega
    A[i, at_alpha + i] = 1
    A[at_alpha + i, i], A[at_alpha + i, at_alpha + i] = -w2, -damping
    A[pairs, at_b + j], A[pairs, at_f] = turned[pairs], l[pairs] * b[pairs]
    A[at_alpha + pairs, at_beta + j], A[at_alpha + pairs, at_f] = turned[pairs], l[pairs] * beta[pairs]
    A[at_b + j, at_beta + j], A[at_b + j, pairs], A[at_b + j, at_f] = 1, -turned[pairs], -l[pairs] * a[pairs]
    A[at_beta + j, at_beta + j], A[at_beta + j, at_b + j] = -damping[pairs], -w2[pairs]
    A[at_beta + j, at_alpha + pairs] = -turned[pairs]
    # alpha = -l Omega b at the equilibrium
    A[at_beta + j, at_f] = l[pairs] * turned[pairs] * b[pairs]
    A[at_psi, at_f] = -1
    pull, lift, force = np.zeros(size), np.zeros(size), np.zeros(size)
    pull[at_psi], pull[at_f] = p.k_p, -p.c_p
    lift[at_b + j] = l[pairs] * weight[pairs] / p.r_0  # of B / r_0
    if law.give:
        force[i], force[at_f + 1] = weight / law.give, -1 / law.give
    else:
        force += slope * pull
        force[i] += p.k * weight - p.m * weight * (w2 + turned**2)
        force[at_alpha + i] += (p.c - p.m * damping) * weight
        force[at_b + j] += p.c * weight[pairs] * turned[pairs]
        force[at_beta + j] += 2 * p.m * weight[pairs] * turned[pairs]
        by_f = p.c * weight * l * b + p.m * weight * (2 * l * beta - 2 * l**2 * p.Omega * a)
        force[at_f] += float(np.sum(by_f))
    force = (force + law.by_beta * lift) / law.denominator
    vertical, held = force, p.mu_k * force
    if law.normal:
        vertical = law.share * force - p.mu_k * law.force * lift
        held = law.resistance * force + law.force * lift
    A[at_alpha + i] -= weight[:, None] * vertical
    A[at_f] = (pull - held / p.r_0) / p.m
    if law.give:
        A[at_f + 1, at_f + 2] = 1
        A[at_f + 2] = vertical / p.m
        A[at_f + 2, at_f + 1 :] -= np.array([p.k, p.c]) / p.m
    return A
