"""Steady sliding: the slider rests in space, f = Omega, and the disc stands still in the slider's frame.

The equilibrium of the equations of slip (docs/model.md, Slip) and its stability.  With d = 2 xi omega the disc's
response to the force P that rotates over it is

    b_l = d l Omega a_l / (l^2 Omega^2 - omega^2),
    a_l = psi_l P / (l^2 Omega^2 - omega^2 + d^2 l^2 Omega^2 / (l^2 Omega^2 - omega^2)),

so that u = chi P and P = (N - k u_0) / (1 - k chi).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from disc_model.errors import ParameterError, StatusBase
from disc_model.parameters import Parameters
from disc_model.plate import Modes, modal_damping, mode_arrays
from disc_model.stability.contact import check_contact

Array = NDArray[np.float64]


class SlidingStatus(StatusBase):
    """Whether steady sliding exists; `advice` says what that means."""

    OK = "ok", "Steady sliding exists; its growth rate says whether it is stable."
    NO_CONTACT = "no_contact", "The equilibrium would need a contact force that is not positive: lower Omega."
    AT_REST = "at_rest", "The disc is not driven (Omega = 0): nothing slides."
    NO_SPRING = "no_spring", "Without the spring in the plane (k_p = 0) nothing balances friction."
    PARADOX = "paradox", "Painleve's paradox: rigid friction on this slope has no solution; lower mu_k or N."


@dataclass(frozen=True, eq=False)
class SteadySliding:
    """The sliding equilibrium.

    Attributes
    ----------
    status, message : whether it exists and why not; otherwise numbers are nan and arrays empty
    contact_force : N
    psi : rad, angle of the drive point ahead of the slider
    a, b, alpha, beta : shape (n_modes,), rows of `plate_modes`
    eigenvalues : 1/s, complex, largest real part first; (4 per pair of modes + 2 per axisymmetric mode + 2,)
    growth_rate : 1/s, largest real part
    """

    status: SlidingStatus
    message: str
    contact_force: float
    psi: float
    a: Array
    b: Array
    alpha: Array
    beta: Array
    eigenvalues: NDArray[np.complex128]
    growth_rate: float

    @property
    def stable(self) -> bool:
        """Whether small disturbances die out: the growth rate is negative."""
        return self.growth_rate < 0


def steady_sliding(p: Parameters) -> SteadySliding:
    """Equilibrium f = Omega and its eigenvalues.

    Raises
    ------
    ParameterError
        If `p` is no `Parameters`.
    """
    if not isinstance(p, Parameters):
        raise ParameterError(f"p={p!r}: must be Parameters")
    check_contact(p, "steady_sliding")
    if p.Omega == 0:
        return _absent(SlidingStatus.AT_REST)
    if p.k_p == 0 and p.mu_k > 0:
        return _absent(SlidingStatus.NO_SPRING)
    modes = mode_arrays(p)
    damping = modal_damping(p)
    a, b, force = _equilibrium(p, modes, damping)
    if not (math.isfinite(force) and force > 0) and p.contact != "bonded":
        return _absent(SlidingStatus.NO_CONTACT)
    l = modes.diameters
    alpha, beta = -l * p.Omega * b, l * p.Omega * a
    slope = float(np.sum(l * modes.psi * b))
    denominator = 1 + p.m * float(np.sum(modes.psi**2)) + p.mu_k * slope / p.r_0
    if denominator <= 1e-6:
        return _absent(SlidingStatus.PARADOX)
    eigenvalues = np.linalg.eigvals(_jacobian(p, modes, damping, a, b, beta, slope, denominator)).astype(complex)
    eigenvalues = eigenvalues[np.argsort(-eigenvalues.real, kind="stable")]
    # F = mu_k P / r_0 and F = k_p psi
    psi = p.mu_k * force / (p.r_0 * p.k_p) if p.k_p > 0 else math.nan
    growth = float(eigenvalues[0].real)
    message = f"steady sliding with P = {force:.6g} N, {'stable' if growth < 0 else 'not stable'}"
    return SteadySliding(SlidingStatus.OK, message, force, psi, a, b, alpha, beta, eigenvalues, growth)


def _absent(status: SlidingStatus) -> SteadySliding:
    nothing, none = np.zeros(0), np.zeros(0, complex)
    return SteadySliding(status, status.advice, math.nan, math.nan, nothing, nothing, nothing, nothing, none, math.nan)


def _equilibrium(p: Parameters, modes: Modes, damping: Array) -> tuple[Array, Array, float]:
    """a, b (n_modes,) and P."""
    turned = modes.diameters * p.Omega
    gap = turned**2 - modes.omega**2
    with np.errstate(divide="ignore", invalid="ignore"):
        by_force = modes.psi * gap / (gap**2 + (damping * turned) ** 2)
        static = float(np.sum(modes.psi**2 / modes.omega**2))
        force = p.N * (1 + p.k * static) / (1 - p.k * float(np.sum(modes.psi * by_force)))
        across = modes.psi * damping * turned / (gap**2 + (damping * turned) ** 2)
    return by_force * force, across * force, force


def _jacobian(
    p: Parameters, modes: Modes, damping: Array, a: Array, b: Array, beta: Array, slope: float, denominator: float
) -> Array:
    """Of the equations of slip at the equilibrium; rows a, alpha of all modes, b, beta of the pairs, psi, f."""
    n, pairs = len(modes.omega), np.flatnonzero(modes.diameters > 0)
    m = len(pairs)
    l, w2, weight = modes.diameters.astype(float), modes.omega**2, modes.psi
    at_alpha, at_b, at_beta, at_psi, at_f = n, 2 * n, 2 * n + m, 2 * n + 2 * m, 2 * n + 2 * m + 1
    A = np.zeros((at_f + 1, at_f + 1))
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
    pull = np.zeros(at_f + 1)
    pull[at_psi], pull[at_f] = p.k_p, -p.c_p
    force = slope * pull  # the terms with the change of B cancel: F = mu_k P / r_0
    force[i] += p.k * weight - p.m * weight * (w2 + turned**2)
    force[at_alpha + i] += (p.c - p.m * damping) * weight
    force[at_b + j] += p.c * weight[pairs] * turned[pairs]
    force[at_beta + j] += 2 * p.m * weight[pairs] * turned[pairs]
    by_f = p.c * weight * l * b + p.m * weight * (2 * l * beta - 2 * l**2 * p.Omega * a)
    force[at_f] += float(np.sum(by_f))
    force /= denominator
    A[at_alpha + i] -= weight[:, None] * force
    A[at_f] = (pull - p.mu_k / p.r_0 * force) / p.m
    return A
