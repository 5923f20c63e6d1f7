"""Steady sliding: the slider rests in space, f = Omega, and the disc stands still in the slider's frame.

The module computes the equilibrium of the equations of slip (docs/model.md, Slip) and its stability.  With
d = 2 xi omega the disc's response to the force P that rotates over it is

    b_l = d l Omega a_l / (l^2 Omega^2 - omega^2),
    a_l = psi_l P / (l^2 Omega^2 - omega^2 + d^2 l^2 Omega^2 / (l^2 Omega^2 - omega^2)),

so that w = chi P.  With V for the vertical force, C for the contact's compliance and u = w - C V,
V = (N - k u_0) / (1 - k chi + k C); under the normal force, with beta = B / r_0, R = V / (1 - mu_k beta) and
r_0 F = (mu_k + beta) R.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from types import FunctionType, ModuleType, SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from disc_model.disc.flexibility import contact_compliance
from disc_model.disc.plate import Modes, modal_damping, mode_arrays
from disc_model.engine import laws
from disc_model.errors import StatusBase, raise_faults
from disc_model.parameters import Parameters
from disc_model.simulation.states import engine_case
from disc_model.stability.return_map import Array, case_faults


def _in_python(module: ModuleType) -> Any:
    """The compiled functions of a module as functions of Python, which need no compilation for complex arrays."""
    names = {**vars(module)}
    compiled = {name: law.py_func.__code__ for name, law in names.items() if hasattr(law, "py_func")}
    names |= {name: FunctionType(code, names) for name, code in compiled.items()}
    return SimpleNamespace(**names)


_LAWS = _in_python(laws)


class SlidingStatus(StatusBase):
    """Whether steady sliding exists; `advice` says what that means."""

    OK = "ok", "Steady sliding exists; its growth rate says whether it is stable."
    NO_CONTACT = "no_contact", "The equilibrium would need a contact force that is not positive: lower Omega."
    AT_REST = "at_rest", "The disc is not driven (Omega = 0): nothing slides."
    NO_SPRING = "no_spring", "Without the spring in the plane (k_p = 0) nothing balances friction on a slider at rest."
    PARADOX = "paradox", "Painleve's paradox: rigid friction on this slope has no solution; lower mu_k or N."


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
    a: Array = field(default_factory=lambda: np.zeros(0), repr=False)
    b: Array = field(default_factory=lambda: np.zeros(0), repr=False)
    alpha: Array = field(default_factory=lambda: np.zeros(0), repr=False)
    beta: Array = field(default_factory=lambda: np.zeros(0), repr=False)
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
    raise_faults(case_faults(p, "steady_sliding"))
    if p.Omega == 0:
        return _absent(SlidingStatus.AT_REST)
    if p.k_p == 0 and (p.mu_k > 0 or (p.contact_force == "normal" and p.D_star > 0)):
        return _absent(SlidingStatus.NO_SPRING)
    modes, model, compliance = mode_arrays(p), engine_case(p).model, contact_compliance(p)
    a, b, vertical = _equilibrium(p, modes, compliance)
    if not (math.isfinite(vertical) and vertical > 0) and p.contact != "bonded":
        return _absent(SlidingStatus.NO_CONTACT)
    alpha, beta = -modes.diameters * p.Omega * b, modes.diameters * p.Omega * a
    height = (modes.psi @ a - compliance * vertical, 0.0) if compliance else ()

    def at(psi: float) -> Array:
        return join_rows(modes, (a, alpha, b, beta), (psi, p.Omega), height)

    i, _ = _slip(p, at(0.0)[:, None])
    if _LAWS.slip_denominator(model, p.m, 1.0, i.dw_dtheta[0]) <= 1e-6:
        return _absent(SlidingStatus.PARADOX)
    # V and f' of a unit force, without F
    share, slowing = (float(part[0]) for part in _LAWS.slip_rates(model, i, 1.0, np.ones(1)))
    force = vertical / share
    psi = -p.m * slowing * force / p.k_p if p.k_p > 0 else math.nan
    rows = at(psi if p.k_p > 0 else 0.0)
    _, rates = _slip(p, rows[:, None] + 1j * laws.TINY * np.eye(len(rows)))
    jacobian = rates.imag / laws.TINY
    eigenvalues = np.linalg.eigvals(jacobian).astype(complex)
    eigenvalues = eigenvalues[np.argsort(-eigenvalues.real, kind="stable")]
    growth = float(eigenvalues[0].real)
    name = "R" if p.contact_force == "normal" else "P"
    message = f"steady sliding with {name} = {force:.6g} N, {'stable' if growth < 0 else 'not stable'}"
    return SteadySliding(SlidingStatus.OK, message, force, psi, a, b, alpha, beta, eigenvalues, growth, jacobian)


def _absent(status: SlidingStatus) -> SteadySliding:
    return SteadySliding(status, status.advice)


def _equilibrium(p: Parameters, modes: Modes, compliance: float) -> tuple[Array, Array, float]:
    """Modal coordinates a, b (n_modes,) and the vertical force at the equilibrium."""
    turned = modes.diameters * p.Omega
    gap, lag = turned**2 - modes.omega**2, modal_damping(p) * turned
    with np.errstate(divide="ignore", invalid="ignore"):
        along, across = (modes.psi * part / (gap**2 + lag**2) for part in (gap, lag))
        static = float(np.sum(modes.psi**2 / modes.omega**2)) + compliance
        force = p.N * (1 + p.k * static) / (1 - p.k * (float(np.sum(modes.psi * along)) - compliance))
    return along * force, across * force, force


def _slip(p: Parameters, rows: Any) -> tuple[Any, Any]:
    """Arguments of the laws of contact, and rates of slip, at states in the rows of `SteadySliding.jacobian`."""
    modes, model = mode_arrays(p), engine_case(p).model
    (a, alpha, b, beta), (psi, f), height = split_rows(modes, rows)
    l, weight, w2, d = (each[:, None] for each in (modes.diameters, modes.psi, modes.omega**2, modal_damping(p)))
    rate_a, rate_b = alpha + l * f * b, beta - l * f * a
    free_along, free_across = l * f * beta - d * alpha - w2 * a, -l * f * alpha - d * beta - w2 * b
    w, velocity, slope, free = (
        np.sum(weight * part, axis=0) for part in (a, rate_a, l * b, free_along + l * f * rate_b)
    )
    u, v = height if len(height) else (w, velocity)
    i = laws.Instant(
        p.N, p.k, p.c, p.m, p.k_p, p.c_p, p.Omega, contact_compliance(p), psi, f, w, velocity, slope, free, u, v
    )  # fmt: skip
    force = _LAWS.slip_numerator(model, i) / _LAWS.slip_denominator(model, p.m, 1.0, slope)
    V, rate_f = _LAWS.slip_rates(model, i, 1.0, force)
    lift = (v, (V - p.N - p.k * (u - model.u_0) - p.c * v) / p.m)[: len(height)]
    return i, join_rows(modes, (rate_a, free_along - weight * V, rate_b, free_across), (p.Omega - f, rate_f), lift)


def split_rows(modes: Modes, rows: Any) -> tuple[Any, Any, Any]:
    """Rows of steady sliding's Jacobian as a, alpha, b, beta of all modes; psi, f; u, u' on a compliant contact."""
    pairs = np.flatnonzero(modes.diameters > 0)
    n, m = len(modes.omega), len(pairs)
    a, alpha, b_pairs, beta_pairs, slider, height = np.split(rows, np.cumsum([n, n, m, m, 2]))
    b, beta = np.zeros_like(a), np.zeros_like(a)
    b[pairs], beta[pairs] = b_pairs, beta_pairs
    return (a, alpha, b, beta), slider, height


def join_rows(modes: Modes, disc: Sequence[Any], slider: Sequence[Any], height: Sequence[Any]) -> Any:
    """Rows of steady sliding's Jacobian from the parts that `split_rows` returns."""
    a, alpha, b, beta = disc
    pairs = modes.diameters > 0
    return np.concatenate([a, alpha, b[pairs], beta[pairs], slider, *([height] if len(height) else [])])
