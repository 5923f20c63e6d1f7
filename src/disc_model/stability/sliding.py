"""Steady sliding, f = Omega: equilibrium of the equations of slip (docs/model.md, Slip), its
eigenvalues and modes.

With d = 2 xi omega the disc's response to the force that rotates over it at the rate g is

    a_l = (gap psi_l V + lag t_l H) / (gap^2 + lag^2),  gap = l^2 g^2 - omega^2,
    b_l = (lag psi_l V - gap t_l H) / (gap^2 + lag^2),  lag = d l g,

with V and H for the vertical and horizontal forces, t_l for the tangential amplitude of a mode where
friction acts, and g = Omega - v_s / r_0, v_s = g sum l t_l a_l, which is Omega if the surface does not
move.  With C for the contact's compliance, V = N + k (w - C V - u_0). R = V and H = mu R (mu = mu_k,
unless it falls with the speed); under the normal force, with beta = B / r_0, V = R (1 - mu beta) and
H = (mu + beta) R. The spring in the plane holds H = r_0 F.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from disc_model.arrays import Array, ComplexArray, EqualByValue
from disc_model.data.variables import values_text
from disc_model.disc.flexibility import contact_compliance
from disc_model.disc.plate import Modes, modal_damping, mode_arrays, tangential_amplitudes
from disc_model.disc.stretched import membrane_forces
from disc_model.display import Summarised, drawings, number_text
from disc_model.errors import StatusBase, raise_faults, require
from disc_model.parameters import Parameters, foreign_case
from disc_model.simulation.states import engine_case
from disc_model.stability.python_laws import LAWS
from disc_model.stability.stretched_sliding import stretched_equilibrium

_MOST_ITERATIONS = 30  # of Newton's method: a few suffice, where there is an equilibrium
_SETTLED = 1e-14  # relative change at which it ends


class SlidingStatus(StatusBase):
    """Whether steady sliding exists; `advice` says what that means."""

    OK = "ok", "Steady sliding exists; its growth rate says whether it is stable."
    FURTHER = (
        "further",
        "Steady sliding exists; the plate stretches, and a further equilibrium cannot be excluded.",
    )
    NO_CONTACT = (
        "no_contact",
        "The equilibrium would need a contact force that is not positive: lower Omega or k.",
    )
    NO_LOAD = "no_load", "Nothing presses the slider onto the disc (N = 0): raise N."
    AT_REST = "at_rest", "The disc is not driven (Omega = 0): nothing slides."
    NO_SPRING = (
        "no_spring",
        "Without the spring in the plane (k_p = 0) nothing balances friction or the disc's slope.",
    )
    PARADOX = (
        "paradox",
        "Painleve's paradox: rigid friction on this slope has no solution; lower mu_k or N.",
    )

    @property
    def exists(self) -> bool:
        """Whether there is an equilibrium, and its numbers are known."""
        return self in (SlidingStatus.OK, SlidingStatus.FURTHER)


@dataclass(frozen=True, eq=False, repr=False)
class SteadySliding(Summarised, EqualByValue):
    """The sliding equilibrium.

    Attributes
    ----------
    status, message : whether the equilibrium exists, or why not; numbers are then nan and arrays empty
    contact_force : N; it is P, or R under the normal force
    psi : rad, angle of the drive point ahead of the slider
    a, b, alpha, beta : shape (n_modes,), rows of `plate_modes`
    eigenvalues : 1/s, complex, largest real part first; (4 per pair of modes + 2 per axisymmetric mode + 2,),
        plus 2 on a compliant contact
    growth_rate : 1/s, largest real part of the eigenvalues, and exactly 0 where that is nothing but rounding
    jacobian : Jacobian of the equations of slip; rows a and alpha of all modes, b and beta of the pairs, psi, f, and
        u, u' on a compliant contact
    parameters : as given to `steady_sliding`
    """

    status: SlidingStatus
    message: str
    contact_force: float = math.nan
    psi: float = math.nan
    a: Array = field(default_factory=lambda: np.zeros(0), repr=False)
    b: Array = field(default_factory=lambda: np.zeros(0), repr=False)
    alpha: Array = field(default_factory=lambda: np.zeros(0), repr=False)
    beta: Array = field(default_factory=lambda: np.zeros(0), repr=False)
    eigenvalues: ComplexArray = field(default_factory=lambda: np.zeros(0, complex), repr=False)
    growth_rate: float = math.nan
    jacobian: Array = field(default_factory=lambda: np.zeros((0, 0)), repr=False)
    parameters: Parameters | None = None

    def __repr__(self) -> str:
        if not self.eigenvalues.size:
            return f"SteadySliding({self.message})"
        numbers = f"growth rate {self.rate_text}, {self.eigenvalues.size} eigenvalues"
        return f"SteadySliding({self.message}, {numbers})"

    def _summary(self) -> Iterator[tuple[str, object]]:
        if self.parameters is not None:
            yield "case", values_text(dict(self.parameters))
        yield "status", self.message
        yield "contact force", number_text(self.contact_force, "N")
        yield "angle psi", number_text(self.psi, "rad")
        yield "growth rate", self.rate_text
        growing = self.growing
        yield "unstable modes", growing.size if self.eigenvalues.size else ""
        frequencies = [number_text(value.imag / math.tau, "Hz") for value in growing]
        yield "growing frequencies", ", ".join(frequencies)

    @property
    def rate_text(self) -> str:
        """The growth rate with its unit; "" if there is none."""
        return number_text(self.growth_rate, "1/s")

    @property
    def stable(self) -> bool:
        """Whether the growth rate is negative by more than rounding, so that small disturbances
        decay; False if neutral, as with an undamped slider (c_p = 0) when no mode grows."""
        return self.growth_rate < 0

    @property
    def growing(self) -> ComplexArray:
        """Eigenvalues of modes that grow by more than rounding, 1/s, (n,); of a conjugate pair the
        upper one."""
        grows = growth_rates(self.eigenvalues) > 0
        return self.eigenvalues[grows & (self.eigenvalues.imag >= 0)]

    @property
    def neutral(self) -> ComplexArray:
        """Eigenvalues of modes that neither grow nor decay by more than rounding, 1/s, (n,); of a
        conjugate pair the upper one."""
        rests = growth_rates(self.eigenvalues) == 0
        return self.eigenvalues[rests & (self.eigenvalues.imag >= 0)]

    def plot(self, ax: Any = None, **look: Any) -> Any:
        """Draw the frequencies of the modes over their growth rates, with rings around those that
        grow, on axes or in a new figure; returns the axes.

        `look` is as in `FloquetResult.plot`. Raises `ParameterError` without steady sliding.

        Examples
        --------
        >>> import disc_model as dm
        >>> dm.steady_sliding(dm.Parameters(N=385, Omega=15)).plot().get_ylabel()
        'Frequency (Hz)'
        """
        rule = f"there are no eigenvalues: {self.message}"
        require((self.eigenvalues.size, "status", self.status.value, rule))
        return drawings().eigenvalues(ax, self, **look)


def _rounding(eigenvalues: ComplexArray) -> float:
    """Error of eigenvalues, 1/s: a solver rounds relative to the largest, once for each of n
    rows."""
    return float(np.finfo(float).eps * np.abs(eigenvalues).max(initial=0) * eigenvalues.size)


def growth_rates(eigenvalues: ComplexArray) -> Array:
    """The real parts of all eigenvalues of a matrix, 1/s, and exactly 0 where they are nothing but
    rounding, so that their signs tell growth from decay."""
    rates = np.asarray(eigenvalues.real, dtype=float)
    return np.where(np.abs(rates) <= _rounding(eigenvalues), 0.0, rates)


def steady_sliding(case: Parameters) -> SteadySliding:
    """Find steady sliding, the equilibrium f = Omega, and its eigenvalues.

    Parameters
    ----------
    case : the case

    Returns
    -------
    SteadySliding
        It is also returned if there is no such equilibrium: `status` and `message` then say why.

    Raises
    ------
    ParameterError
        If `case` is not a `Parameters`, or has no modes.

    Examples
    --------
    >>> import disc_model as dm
    >>> sliding = dm.steady_sliding(dm.Parameters(N=385, Omega=15))
    >>> print(sliding.message, f"{sliding.growth_rate:.4f} 1/s")
    steady sliding with P = 384.977 N, not stable 0.0339 1/s
    """
    found = linearised(case)
    if isinstance(found, SlidingStatus):
        return absent(case, found)
    return described(case, found, np.linalg.eigvals(found.jacobian))


class Linearised(NamedTuple):
    """The equilibrium and its Jacobian, by the names of `SteadySliding`."""

    contact_force: float
    psi: float
    a: Array
    b: Array
    alpha: Array
    beta: Array
    jacobian: Array
    alone: bool  # whether a further equilibrium is excluded


def linearised(case: Parameters) -> Linearised | SlidingStatus:
    """The equations of slip about their equilibrium, or why there is none."""
    raise_faults(foreign_case(case))
    if case.Omega == 0:
        return SlidingStatus.AT_REST
    modes = mode_arrays(case)
    model = engine_case(case).model
    compliance = contact_compliance(case)
    alone = True
    if model.has_stretching:
        a, b, vertical, rate, alone = stretched_equilibrium(case)
    else:
        a, b, vertical, rate = _equilibrium(case, modes, compliance)
    if not (math.isfinite(vertical) and vertical > 0) and case.contact != "bilateral":
        return SlidingStatus.NO_CONTACT if case.N > 0 else SlidingStatus.NO_LOAD
    alpha = -modes.diameters * rate * b
    beta = modes.diameters * rate * a
    height: tuple[float, ...] = ()
    if compliance:
        height = (float(modes.psi @ a) - compliance * vertical, 0.0)

    def rows_at(psi: float) -> Array:
        return join_rows(modes, (a, alpha, b, beta), (psi, case.Omega), height)

    i, _ = _slip(case, rows_at(0.0)[:, None])
    friction = float(LAWS.friction_coefficient(model, 1.0, rate))
    if LAWS.slip_denominator(model, case.m, friction, i.dw_dtheta[0]) <= 1e-6:
        return SlidingStatus.PARADOX
    # V and H of a unit force
    share, braking, _ = (float(part[0]) for part in LAWS.slip_rates(model, i, friction, np.ones(1)))
    force = vertical / share
    if case.k_p > 0:
        psi = braking * force / (case.r_0 * case.k_p)
        rows = rows_at(psi)
    elif braking == 0:  # no friction at this speed, and no slope: both are exactly zero then
        psi = math.nan
        rows = rows_at(0.0)
    else:
        return SlidingStatus.NO_SPRING
    _, rates = _slip(case, rows[:, None] + 1j * LAWS.TINY * np.eye(len(rows)))
    jacobian = rates.imag / LAWS.TINY
    return Linearised(force, psi, a, b, alpha, beta, jacobian, alone)


def described(case: Parameters, found: Linearised, values: np.ndarray) -> SteadySliding:
    """Steady sliding with the eigenvalues of its Jacobian, in any order."""
    eigenvalues = values.astype(complex)
    eigenvalues = eigenvalues[np.argsort(-eigenvalues.real, kind="stable")]
    symbol = "R" if case.contact_force == "normal" else "P"
    force = f"{symbol} = {found.contact_force:.6g} N"
    growth_rate = float(growth_rates(eigenvalues)[0])
    numbers = found._asdict()
    alone = numbers.pop("alone")
    return SteadySliding(
        status=SlidingStatus.OK if alone else SlidingStatus.FURTHER,
        message=f"steady sliding with {force}, {_verdict(growth_rate)}",
        eigenvalues=eigenvalues,
        growth_rate=growth_rate,
        parameters=case,
        **numbers,
    )


def _verdict(growth_rate: float) -> str:
    """The stability of an equilibrium in a word, from its growth rate."""
    if growth_rate == 0:
        return "neutral"
    return "stable" if growth_rate < 0 else "not stable"


def absent(p: Parameters, status: SlidingStatus) -> SteadySliding:
    """The result for a case without steady sliding."""
    return SteadySliding(status, status.advice, parameters=p)


def _equilibrium(
    p: Parameters, modes: Modes, compliance: float
) -> tuple[Array, Array, float, float]:
    """Modal coordinates a, b (n_modes,), the vertical force and the rate g at the equilibrium."""
    static = float(np.sum(modes.psi**2 / modes.omega**2)) + compliance
    load = p.N * (1 + p.k * static)  # N - k u_0
    tangential = tangential_amplitudes(p)
    with np.errstate(divide="ignore", invalid="ignore"):
        a, b = _response(p, modes, p.Omega, 1.0, 0.0)
        force = load / (1 - p.k * (float(np.sum(modes.psi * a)) - compliance))
        if not tangential.any():
            return a * force, b * force, force, p.Omega
        model = engine_case(p).model
        leans = modes.diameters * modes.psi / p.r_0
        if p.contact_force != "normal":
            leans = np.zeros_like(modes.psi)

        def residual(x: ComplexArray) -> ComplexArray:
            """What the spring's load, the law of friction and the slip speed leave over."""
            rate, V, H = x
            a, b = _response(p, modes, rate, V, H)
            mu = LAWS.friction_coefficient(model, 1.0, rate)
            beta = leans @ b
            surface = rate * (modes.diameters * tangential) @ a
            lifted = V + p.k * (compliance * V - modes.psi @ a) - load
            return np.array(
                [rate + surface / p.r_0 - p.Omega, lifted, H * (1 - mu * beta) - (mu + beta) * V]
            )

        rate, V, H = _zero(
            residual,
            np.array([p.Omega, force, LAWS.friction_coefficient(model, 1.0, p.Omega) * force]),
        )
        a, b = _response(p, modes, rate, V, H)
    return a, b, V, rate


def _response(p: Parameters, modes: Modes, rate: Any, V: Any, H: Any) -> tuple[Any, Any]:
    """Modal coordinates a, b (n_modes,) under forces V and H that rotate at a rate (rad/s)."""
    turned = modes.diameters * rate
    gap = turned**2 - modes.omega**2
    lag = modal_damping(p) * turned
    size = gap**2 + lag**2
    tangential = tangential_amplitudes(p)
    along = (modes.psi * gap * V + tangential * lag * H) / size
    across = (modes.psi * lag * V - tangential * gap * H) / size
    return along, across


def _zero(residual: Callable[[ComplexArray], ComplexArray], x: Array) -> Array:
    """A zero of a function near x (n,), by Newton's method with complex steps; nan if none is
    found."""
    steps = 1j * LAWS.TINY * np.eye(len(x))
    for _ in range(_MOST_ITERATIONS):
        slopes: Array = np.array([residual(x + step).imag for step in steps]).T / LAWS.TINY
        if not np.isfinite(slopes).all():
            break
        left: Array = residual(np.asarray(x, dtype=complex)).real
        change = np.linalg.solve(slopes, left)
        x = x - change
        if np.all(np.abs(change) <= _SETTLED * np.abs(x)):
            return x
    return np.full(len(x), np.nan)


def _slip(p: Parameters, rows: Any) -> tuple[Any, Any]:
    """Arguments of the laws of contact, and rates of slip, at states in the rows of
    `SteadySliding.jacobian`."""
    modes = mode_arrays(p)
    model = engine_case(p).model
    (a, alpha, b, beta), (psi, f), height = split_rows(modes, rows)
    l = modes.diameters[:, None]
    weight = modes.psi[:, None]
    tangential = tangential_amplitudes(p)[:, None]
    w2 = modes.omega[:, None] ** 2
    d = modal_damping(p)[:, None]
    surface = np.sum(tangential * beta, axis=0)
    g = f - surface / p.r_0
    rate_a = alpha + l * g * b
    rate_b = beta - l * g * a
    free_along = l * g * beta - d * alpha - w2 * a
    free_across = -l * g * alpha - d * beta - w2 * b
    if model.has_stretching:
        along, across = membrane_forces(p, a, b)
        free_along = free_along - along
        free_across = free_across - across
    w = np.sum(weight * a, axis=0)
    velocity = np.sum(weight * rate_a, axis=0)
    u = w
    v = velocity
    if len(height):
        u, v = height
    i = LAWS.Instant(
        N=p.N,
        k=p.k,
        c=p.c,
        m=p.m,
        k_p=p.k_p,
        c_p=p.c_p,
        Omega=p.Omega,
        compliance=contact_compliance(p),
        psi=psi,
        g=g,
        w=w,
        w_velocity=velocity,
        dw_dtheta=np.sum(weight * (l * b), axis=0),
        free=np.sum(weight * (free_along + l * g * rate_b), axis=0),
        surface_velocity=surface,
        surface_free=np.sum(tangential * free_across, axis=0),
        u=u,
        u_velocity=v,
    )
    friction = LAWS.friction_coefficient(model, 1.0, g)
    denominator = LAWS.slip_denominator(model, p.m, friction, i.dw_dtheta)
    V, H, rate_g = LAWS.slip_rates(model, i, friction, LAWS.slip_numerator(model, i) / denominator)
    free_across = free_across + tangential * H
    rate_f = rate_g + np.sum(tangential * free_across, axis=0) / p.r_0
    disc = (rate_a, free_along - weight * V, rate_b, free_across)
    acceleration = (V - p.N - p.k * (u - model.u_0) - p.c * v) / p.m
    lift = (v, acceleration)[: len(height)]
    return i, join_rows(modes, disc, (p.Omega - f, rate_f), lift)


def split_rows(modes: Modes, rows: Any) -> tuple[Any, Any, Any]:
    """Rows of steady sliding's Jacobian as a, alpha, b, beta of all modes; psi, f; u, u' on a
    compliant contact."""
    pairs = np.flatnonzero(modes.diameters > 0)
    n = len(modes.omega)
    m = len(pairs)
    a, alpha, b_pairs, beta_pairs, slider, height = np.split(rows, np.cumsum([n, n, m, m, 2]))
    b = np.zeros_like(a)
    beta = np.zeros_like(a)
    b[pairs], beta[pairs] = b_pairs, beta_pairs
    return (a, alpha, b, beta), slider, height


def height_of_slider(p: Parameters, sliding: SteadySliding) -> float:
    """Height u of the slider on a compliant contact in steady sliding, m."""
    # the contact's force is that of the slider's spring: (w - u) / compliance = N + k (u - u_0)
    compliance = contact_compliance(p)
    load = p.N - p.k * engine_case(p).model.u_0
    w = float(mode_arrays(p).psi @ sliding.a)
    return (w - compliance * load) / (1 + p.k * compliance)


def join_rows(
    modes: Modes, disc: Sequence[Any], slider: Sequence[Any], height: Sequence[Any]
) -> Any:
    """Rows of steady sliding's Jacobian from the parts that `split_rows` returns."""
    a, alpha, b, beta = disc
    pairs = modes.diameters > 0
    parts = [a, alpha, b[pairs], beta[pairs], slider]
    if len(height):
        parts.append(height)
    return np.concatenate(parts)
