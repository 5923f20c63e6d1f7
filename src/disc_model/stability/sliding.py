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

Where the surface moves, g is sought up to twice Omega. A plate that stretches adds the forces of its
membrane; its equilibrium is followed from that of no load.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from types import FunctionType, ModuleType, SimpleNamespace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from scipy.optimize import brentq

from disc_model.arrays import Array, ComplexArray, EqualByValue, Indices
from disc_model.disc.flexibility import contact_compliance
from disc_model.disc.plate import Modes, modal_damping, mode_arrays, tangential_amplitudes
from disc_model.disc.stretched import membrane_forces
from disc_model.display import drawings, number_text
from disc_model.engine import laws
from disc_model.errors import StatusBase, require
from disc_model.parameters import Parameters, require_case
from disc_model.simulation.states import State, engine_case

if TYPE_CHECKING:
    from pandas import DataFrame

RATES = np.arange(1, 101) / 50  # at which the rate g is sought, over Omega
# distances from resonances and poles at which it is looked, too, over their rates
BESIDE = np.concatenate([-np.geomspace(1, 1e-9, 28), np.geomspace(1e-9, 1, 28)])
LOADS = 24  # shares of the load by which the equilibrium of a plate that stretches is followed
MOST_ITERATIONS = 30  # of Newton's method: a few suffice, where there is an equilibrium
SETTLED = 1e-10  # relative change at which it ends: what remains is its square
NEARLY = 5e-4  # damping ratio below which a mode nearly grows


def _in_python(module: ModuleType) -> Any:
    """What a module has, with its compiled functions as functions of Python, which need no
    compilation for complex arrays."""
    names = dict(vars(module))
    for name, law in vars(module).items():
        if hasattr(law, "py_func"):
            names[name] = FunctionType(law.py_func.__code__, names)
    return SimpleNamespace(**names)


LAWS = _in_python(laws)
"""The laws of contact, `disc_model.engine.laws`."""


class SlidingStatus(StatusBase):
    """Whether steady sliding exists; `advice` says what that means."""

    OK = "ok", "Steady sliding exists; its growth rate says whether it is stable."
    FURTHER = (
        "further",
        "Steady sliding exists; the plate stretches, and a further equilibrium cannot be excluded.",
    )
    SEVERAL = (
        "several",
        "Steady sliding exists; of several equilibria the one whose rate is nearest to the drive's is given.",
    )
    NOT_FOUND = "not_found", "No equilibrium was found up to twice the drive's rate."
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
        return self in (SlidingStatus.OK, SlidingStatus.FURTHER, SlidingStatus.SEVERAL)


@dataclass(frozen=True, eq=False, repr=False)
class SteadySliding(EqualByValue):
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
    rows, jacobian : the state, and the Jacobian of the equations of slip; rows a and alpha of all modes, b and beta of
        the pairs, psi, f, and u, u' on a compliant contact
    parameters : as given to `steady_sliding`
    rates : rad/s, (n,), rates g over the material of all equilibria that were found, ascending; `rate` is that of
        this one, Omega unless friction moves the surface
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
    rows: Array = field(default_factory=lambda: np.zeros(0), repr=False)
    jacobian: Array = field(default_factory=lambda: np.zeros((0, 0)), repr=False)
    parameters: Parameters | None = None
    rates: Array = field(default_factory=lambda: np.zeros(0), repr=False)
    rate: float = math.nan

    def __repr__(self) -> str:
        if not self.eigenvalues.size:
            return f"SteadySliding({self.message})"
        fastest = f"growth rate {self.growth_rate:.6g} 1/s at {number_text(self.frequency, 'Hz')}"
        return f"SteadySliding({self.message}, {fastest}, {self.eigenvalues.size} eigenvalues)"

    def __str__(self) -> str:
        table = self.modes
        if len(table):
            return f"{self!r}\n{table.to_string()}"
        return repr(self)

    @property
    def frequency(self) -> float:
        """That of the mode with the growth rate, Hz; 0 if it does not oscillate, nan without modes."""
        if self.eigenvalues.size:
            return float(abs(self.eigenvalues[0].imag)) / math.tau
        return math.nan

    @property
    def modes(self) -> "DataFrame":
        """Oscillating modes that grow or nearly do, with a damping ratio below 0.0005: the fastest first.

        Columns are those numbers of `SlidingModes` that each mode has one of: frequency (Hz), growth_rate
        (1/s), damping_ratio, diameters, circles, and the disc's share of the energy.
        """
        from pandas import DataFrame  # slow to import, as most of what follows does without

        p = self.parameters
        table = DataFrame(columns=[*TABLE])
        if self.eigenvalues.size and p is not None:
            found = sliding_modes(p, self)
            table = DataFrame({name: getattr(found, name) for name in TABLE})
        table = table[table["damping_ratio"] < NEARLY]
        return table.sort_values("growth_rate", ascending=False, ignore_index=True)

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


def growth_rates(eigenvalues: ComplexArray) -> Array:
    """The real parts of all eigenvalues of a matrix, 1/s, and exactly 0 where they are nothing but
    rounding, so that their signs tell growth from decay."""
    rates = np.asarray(eigenvalues.real, dtype=float)
    # a solver rounds relative to the largest, once for each of n rows
    rounding = np.finfo(float).eps * np.abs(eigenvalues).max(initial=0) * eigenvalues.size
    return np.where(np.abs(rates) <= rounding, 0.0, rates)


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
    status, slips = _equilibria(case)
    return _described(case, status, slips, np.linalg.eigvals(_jacobian_of(slips)))


def _equilibria(case: Parameters) -> tuple[SlidingStatus, list["_Slip"]]:
    """All equilibria that are found, that whose rate is nearest to the drive's first; or why there is
    none."""
    require_case(case)
    if case.Omega == 0:
        return SlidingStatus.AT_REST, []
    disc = _Response(case)
    linear = disc.equilibria()
    every = [slip for slip in map(disc.slip_at, linear) if slip is not None]
    carried = [each for each in every if each.force > 0 or case.contact == "bilateral"]
    carried.sort(key=lambda each: abs(each.rate - case.Omega))
    if not carried:
        if not case.N > 0:
            return SlidingStatus.NO_LOAD, []
        return (SlidingStatus.NO_CONTACT if every else SlidingStatus.NOT_FOUND), []
    # without a spring, friction at this speed and the slope must both be zero, which is exact then
    balanced = case.k_p != 0 or all(each.H == 0 for each in linear)
    status = _status_of(carried, balanced=balanced, stretches=bool(disc.model.has_stretching))
    return status, carried if status.exists else []


def _status_of(carried: Sequence["_Slip"], *, balanced: bool, stretches: bool) -> SlidingStatus:
    """The status of equilibria in contact, of which the first is nearest to the drive's rate.

    balanced : whether friction is carried by a spring, or is zero; stretches : whether the plate does
    """
    if carried[0].denominator <= 1e-6:
        return SlidingStatus.PARADOX
    if not balanced:
        return SlidingStatus.NO_SPRING
    if len(carried) > 1:
        return SlidingStatus.SEVERAL
    return SlidingStatus.FURTHER if stretches else SlidingStatus.OK


def _jacobian_of(slips: Sequence["_Slip"]) -> Array:
    """The Jacobian at the first of some equilibria; without rows if there is none."""
    return slips[0].jacobian if slips else np.zeros((0, 0))


def _described(
    case: Parameters, status: SlidingStatus, slips: Sequence["_Slip"], values: np.ndarray
) -> SteadySliding:
    """Steady sliding at the first of some equilibria, with the eigenvalues of its Jacobian, in any
    order; or without one."""
    if not slips:
        return SteadySliding(status, status.advice, parameters=case)
    slip = slips[0]
    (a, alpha, b, beta), (psi, _), _ = split_rows(mode_arrays(case), slip.rows)
    eigenvalues = values[np.argsort(-values.real, kind="stable")].astype(complex)
    growth_rate = float(growth_rates(eigenvalues)[0])
    verdict = "neutral"
    if growth_rate > 0:
        verdict = "not stable"
    elif growth_rate < 0:
        verdict = "stable"
    symbol = "R" if case.contact_force == "normal" else "P"
    message = f"steady sliding with {symbol} = {slip.force:.6g} N, {verdict}"
    if status is SlidingStatus.SEVERAL:
        message += f"; the nearest to the drive's rate of {len(slips)} equilibria"
    return SteadySliding(
        status,
        message,
        slip.force,
        float(psi) if case.k_p else math.nan,
        a,
        b,
        alpha,
        beta,
        eigenvalues,
        growth_rate,
        slip.rows,
        slip.jacobian,
        case,
        rates=np.sort([each.rate for each in slips]),
        rate=slip.rate,
    )


# ---- The equilibrium of the disc: by the modal solve at a rate g, and a search for that rate


class Balanced(NamedTuple):
    """The disc in equilibrium under a contact that travels over it: rate g (rad/s), modal coordinates
    a, b (n_modes,), vertical and horizontal force (N)."""

    rate: float
    a: Array
    b: Array
    V: float
    H: float


class _Response:
    """The disc's linear response to a contact that travels over it."""

    def __init__(self, p: Parameters) -> None:
        modes = mode_arrays(p)
        self.p = p
        self.modes = modes
        self.model = engine_case(p).model
        self.w2 = modes.omega**2
        self.d = modal_damping(p)
        self.t = tangential_amplitudes(p)
        self.compliance = contact_compliance(p)
        self.load = p.N - p.k * self.model.u_0
        self.leans = modes.diameters * modes.psi / p.r_0
        if p.contact_force != "normal":
            self.leans = np.zeros_like(modes.psi)

    def equilibria(self) -> list[Balanced]:
        """All equilibria that are found, up to twice the drive's rate."""
        if not (self.load and self.t.any()):
            start = self.solve(self.p.Omega)
            if math.isfinite(start.V):
                return [start]
            return []
        return [self.solve(rate) for rate in _zeros(self.excess, self._grid())]

    def excess(self, rate: float) -> float:
        """The slider's rate over that of the drive at a rate g, rad/s."""
        state = self.solve(rate)
        surface = rate * float((self.modes.diameters * self.t) @ state.a)
        return rate + surface / self.p.r_0 - self.p.Omega

    def _grid(self) -> Array:
        """Rates at which equilibria are sought, closer beside resonances of the disc and where the
        contact force has a pole."""
        pairs = self.modes.diameters > 0
        grid = RATES * self.p.Omega
        grid = _with_beside(grid, self.modes.omega[pairs] / self.modes.diameters[pairs])

        def softness(rate: float) -> float:
            return 1 / self.solve(rate).V

        return _with_beside(grid, np.array(_zeros(softness, grid)))

    @np.errstate(divide="ignore", invalid="ignore")
    def solve(self, rate: float) -> Balanced:
        """The equilibrium at a rate, of which there is one."""
        turned = self.modes.diameters * rate
        receptance = 1 / (turned**2 - self.w2 - 1j * self.d * turned)
        by_V = self.modes.psi * receptance  # a + i b of a unit of V, and of H
        by_H = -1j * self.t * receptance
        k = self.p.k
        from_V = 1 - k * (float(self.modes.psi @ by_V.real) - self.compliance)
        from_H = -k * float(self.modes.psi @ by_H.real)
        mu = float(LAWS.friction_coefficient(self.model, 1.0, rate))
        share = mu  # H over V
        if self.leans.any():
            # with h for this share, beta = (leans b) solves the quadratic equation
            #   h - mu = beta (1 + mu h), beta = (leans b_V + h leans b_H) load / (from_V + h from_H),
            # whose root near mu is that of a small slope
            slope_V = self.load * float(self.leans @ by_V.imag)
            slope_H = self.load * float(self.leans @ by_H.imag)
            square = from_H - mu * slope_H
            linear = from_V - mu * from_H - slope_H - mu * slope_V
            constant = -mu * from_V - slope_V
            root = math.copysign(np.sqrt(linear**2 - 4 * square * constant), linear)
            share = float(-2 * constant / (linear + root))
        V = self.load / (from_V + share * from_H)
        motion = (by_V + share * by_H) * V
        return Balanced(rate, motion.real, motion.imag, V, share * V)

    def slip_at(self, state: Balanced) -> "_Slip | None":
        """Slip at an equilibrium, or at that to which stretching of the plate leads from there."""
        p = self.p
        turned = self.modes.diameters * state.rate
        psi = 0.0
        if p.k_p:
            psi = state.H / (p.r_0 * p.k_p)
        height: tuple[float, ...] = ()
        if self.compliance:
            height = (float(self.modes.psi @ state.a) - self.compliance * state.V, 0.0)
        disc = (state.a, -turned * state.b, state.b, turned * state.a)
        slip = _slip(
            p, np.asarray(join_rows(self.modes, disc, (psi, p.Omega), height), dtype=float)
        )
        if self.model.has_stretching:
            return _stretched(p, slip)
        return slip


def _zeros(function: Callable[[float], float], grid: Array) -> list[float]:
    """Zeros of a function that changes its sign there between two numbers of a grid. At a pole it jumps
    from one sign to the other."""
    values = np.array([function(x) for x in grid])
    found: list[float] = grid[:-1][values[:-1] == 0].tolist()
    for i in np.flatnonzero(values[:-1] * values[1:] < 0):
        zero = float(brentq(function, grid[i], grid[i + 1], xtol=1e-300, rtol=1e-15))
        if abs(function(zero)) < np.abs(values[i : i + 2]).min():
            found.append(zero)
    return found


def _with_beside(grid: Array, places: Array) -> Array:
    """Rates of a grid, and others on both sides of some places within it."""
    beside = (places[:, None] * (1 + BESIDE)).ravel()
    return np.unique(np.append(grid, beside[(beside > grid[0]) & (beside < grid[-1])]))


def _stretched(p: Parameters, slip: "_Slip") -> "_Slip | None":
    """The equilibrium of a plate that stretches, followed from that of one that does not: stretching
    that grows with the square of a share has the effect of a load that grows with it."""
    scale = np.sqrt(energy_weights(p))
    rows = slip.rows
    for share in np.arange(1, LOADS + 1) / LOADS:
        for _ in range(MOST_ITERATIONS):
            slip = _slip(p, rows, float(share**2))
            if not np.isfinite(slip.jacobian).all():
                return None
            change = np.linalg.lstsq(slip.jacobian, slip.rates, rcond=None)[0]
            rows = rows - change
            if np.linalg.norm(scale * change) <= SETTLED * np.linalg.norm(scale * rows):
                break
        else:
            return None
    return _slip(p, rows)


# ---- The equations of slip


class _Slip(NamedTuple):
    """Slip at a state in the rows of `SteadySliding.jacobian`: its rates in these, and their Jacobian;
    the rate g over the material (rad/s), contact force (N), and that force's denominator."""

    rows: Array
    rates: Array
    jacobian: Array
    rate: float
    force: float
    denominator: float


def _slip(p: Parameters, rows: Array, stretching: float = 1.0) -> _Slip:
    """Slip at a state, on a plate that stretches by a share of what it does."""
    modes = mode_arrays(p)
    model = engine_case(p).model
    moved = rows[:, None] + 1j * LAWS.TINY * np.eye(len(rows))
    (a, alpha, b, beta), (psi, f), height = split_rows(modes, moved)
    tangential = tangential_amplitudes(p)
    w2 = modes.omega[:, None] ** 2
    d = modal_damping(p)[:, None]
    surface = tangential @ beta
    g = f - surface / p.r_0
    turned = modes.diameters[:, None] * g
    rate_a = alpha + turned * b
    rate_b = beta - turned * a
    free_along = turned * beta - d * alpha - w2 * a
    free_across = -turned * alpha - d * beta - w2 * b
    if model.has_stretching:
        along, across = membrane_forces(p, a, b)
        free_along = free_along - stretching * along
        free_across = free_across - stretching * across
    w = modes.psi @ a
    velocity = modes.psi @ rate_a
    u, v = height if len(height) else (w, velocity)
    i = LAWS.Instant(
        **{name: getattr(p, name) for name in ("N", "k", "c", "m", "k_p", "c_p", "Omega")},
        compliance=contact_compliance(p),
        psi=psi,
        g=g,
        w=w,
        w_velocity=velocity,
        dw_dtheta=(modes.diameters * modes.psi) @ b,
        free=modes.psi @ (free_along + turned * rate_b),
        surface_velocity=surface,
        surface_free=tangential @ free_across,
        u=u,
        u_velocity=v,
    )
    friction = LAWS.friction_coefficient(model, 1.0, g)
    denominator = LAWS.slip_denominator(model, p.m, friction, i.dw_dtheta)
    force = LAWS.slip_numerator(model, i) / denominator
    V, H, rate_g = LAWS.slip_rates(model, i, friction, force)
    free_along = free_along - modes.psi[:, None] * V
    free_across = free_across + tangential[:, None] * H
    rate_f = rate_g + tangential @ free_across / p.r_0
    acceleration = (V - p.N - p.k * (u - model.u_0) - p.c * v) / p.m
    lift = (v, acceleration)[: len(height)]
    disc = (rate_a, free_along, rate_b, free_across)
    rates = join_rows(modes, disc, (p.Omega - f, rate_f), lift)
    first = [float(np.ravel(number)[0].real) for number in (g, force, denominator)]
    return _Slip(rows, rates.real[:, 0], rates.imag / LAWS.TINY, *first)


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
    """Height u of the slider in steady sliding, m."""
    modes = mode_arrays(p)
    _, _, height = split_rows(modes, sliding.rows)
    return float(height[0] if len(height) else modes.psi @ sliding.a)


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


def rows_of_state(p: Parameters, state: State) -> Array:
    """A state in the rows of `SteadySliding.jacobian`."""
    disc = (state.a, state.alpha, state.b, state.beta)
    height = (state.u, state.u_velocity) if contact_compliance(p) else ()
    return np.asarray(join_rows(mode_arrays(p), disc, (state.psi, state.f), height), float)


# ---- Modes


@dataclass(frozen=True, eq=False)
class SlidingModes:
    """Oscillating modes of steady sliding; eigenvalues without oscillation are left out.

    Attributes
    ----------
    frequency, growth_rate : Hz, 1/s, shape (n,), in the slider's frame; a growth rate is exactly 0 where it is
        nothing but rounding
    damping_ratio : (n,), negative for a mode that grows, and 0 where the growth rate is
    diameters, circles : (n,), nodal diameters and circles of the disc's modes with most energy; -1 if the slider's
        in-plane motion has most
    disc : (n,), the disc's share of the energy; the rest is the slider's, across the disc and in its plane
    forward : (n,), share of these modes' energy in waves that travel with the slider, seen at f - l Omega / 2 pi
    shapes : (rows of `SteadySliding.jacobian`, n)
    """

    frequency: Array
    growth_rate: Array
    damping_ratio: Array
    diameters: Indices
    circles: Indices
    disc: Array
    forward: Array
    shapes: ComplexArray = field(repr=False)


TABLE = ("frequency", "growth_rate", "damping_ratio", "diameters", "circles", "disc")
"""Columns of the table of modes."""


def sliding_modes(p: Parameters, sliding: SteadySliding | None = None) -> SlidingModes:
    """Modes of steady sliding by ascending frequency; none without steady sliding, which is
    computed if not given."""
    if sliding is None:
        return _sliding_and_modes(p)[1]
    return _modes_of(p, *np.linalg.eig(sliding.jacobian))


def _sliding_and_modes(p: Parameters) -> tuple[SteadySliding, SlidingModes]:
    """Steady sliding and its modes, of which there are none without it. Values and shapes come from
    one solution of the eigenvalue problem, which takes nearly all of the time of 100 modes."""
    status, slips = _equilibria(p)
    values, vectors = np.linalg.eig(_jacobian_of(slips))
    return _described(p, status, slips, values), _modes_of(p, values, vectors)


def _modes_of(p: Parameters, values: ComplexArray, vectors: ComplexArray) -> SlidingModes:
    """The modes of eigenvalues, (n,), and eigenvectors, (n, n), by ascending frequency."""
    order = [i for i in np.argsort(values.imag, kind="stable") if values[i].imag > 0]
    growth_rate = growth_rates(values)[order]
    values = values[order]
    weights = energy_weights(p)[:, None]
    every = vectors if order else np.zeros((len(weights), 0))
    vectors = np.asarray(every[:, order], dtype=complex)
    modes = mode_arrays(p)
    (a, alpha, b, beta), slider, _ = split_rows(modes, np.sqrt(weights) * vectors)
    energy = np.sum(np.abs([a, alpha, b, beta]) ** 2, axis=0)
    diameters = _of_most(modes.diameters, energy)
    most = modes.diameters[:, None] == diameters
    circles = _of_most(modes.circles, np.where(most, energy, 0))

    # a + i b and a - i b are the waves that travel in opposite directions
    with_slider = np.sum(np.abs(a + 1j * b) ** 2, axis=0, where=most)
    against = np.sum(np.abs(a - 1j * b) ** 2, axis=0, where=most)
    with np.errstate(invalid="ignore"):  # a mode without the disc has no waves
        forward = np.asarray(with_slider / (with_slider + against), dtype=float)

    disc = energy.sum(axis=0)
    (shape, *_), _, height = split_rows(modes, vectors)
    u = height[0] if len(height) else modes.psi @ shape
    across = np.abs(u) ** 2 * (p.k + p.m * np.abs(values) ** 2)
    in_plane = np.sum(np.abs(slider) ** 2, axis=0)
    slides = in_plane > disc
    return SlidingModes(
        frequency=values.imag / (2 * math.pi),
        growth_rate=growth_rate,
        damping_ratio=np.asarray((0.0 - growth_rate) / np.abs(values), dtype=float),
        diameters=np.where(slides, -1, diameters).astype(np.int64),
        circles=np.where(slides, -1, circles).astype(np.int64),
        disc=disc / (disc + across + in_plane),
        forward=forward,
        shapes=vectors,
    )


def _of_most(numbers: Indices, energy: Array) -> Indices:
    """Of the numbers of the disc's modes, (n_modes,), the one whose modes have most of the energy, (n_modes, n)."""
    every = range(int(numbers.max(initial=0)) + 1)
    return np.array([energy[numbers == number].sum(axis=0) for number in every]).argmax(axis=0)


# least likeness of modes that are followed; otherwise the step is halved, up to `HALVINGS` times
ALIKE = 0.9
HALVINGS = 6


class FollowedModes(NamedTuple):
    """Steady sliding of a case and its modes, and their numbers, (n,)."""

    sliding: SteadySliding
    modes: SlidingModes
    numbers: Indices


def follow_modes(cases: Sequence[Parameters]) -> list[FollowedModes]:
    """Steady sliding and its modes along cases that differ in numbers.

    Modes keep the numbers that they have by frequency, from 0 on, in the first case; modes that
    appear later have the next ones. Shapes are compared by the modal assurance criterion (MAC), the
    squared cosine. Further cases between two are computed until it is clear which mode is which.
    Numbers begin anew where a disc has another number of modes.
    """
    followed = list[FollowedModes]()
    shapes = dict[int, ComplexArray]()  # of each number, the last one
    before: Parameters | None = None
    for p in cases:
        sliding, modes = _sliding_and_modes(p)
        numbers = _numbered(shapes, before, p, modes, HALVINGS)
        followed.append(FollowedModes(sliding, modes, numbers))
        before = p
    return followed


def _numbered(
    shapes: dict[int, ComplexArray],
    before: Parameters | None,
    p: Parameters,
    modes: SlidingModes,
    halvings: int,
) -> Indices:
    """Numbers of the modes of a case; `shapes`, by number, become those of this case. Where the modes
    are in doubt, the case `before` is followed to this one by halves of the way, up to so many
    `halvings`."""
    # slow to import, and steady sliding alone does without
    from scipy.optimize import linear_sum_assignment

    if not len(modes.frequency):
        return np.zeros(0, np.int64)
    scaled = np.sqrt(energy_weights(p))[:, None] * modes.shapes
    scaled = scaled / np.linalg.norm(scaled, axis=0)
    if shapes and len(shapes[0]) != len(scaled):
        shapes.clear()
    known = np.array([*shapes.values()]).reshape(len(shapes), len(scaled))
    mac = np.abs(known.conj() @ scaled) ** 2
    numbers, places = linear_sum_assignment(-mac)
    if before is not None and halvings and mac[numbers, places].min(initial=1) < ALIKE:
        between = _case_between(before, p)
        if between is not None:
            half = sliding_modes(between)
            if len(half.frequency):
                _numbered(shapes, before, between, half, halvings - 1)
                return _numbered(shapes, between, p, modes, halvings - 1)

    matched = np.full(len(modes.frequency), -1)
    matched[places] = numbers
    matched[matched < 0] = len(shapes) + np.arange(np.sum(matched < 0))
    shapes.update(zip(matched.tolist(), scaled.T, strict=True))
    return matched


def _case_between(before: Parameters, after: Parameters) -> Parameters | None:
    """The case halfway between two that differ in numbers; None if they do not differ."""
    ends = dict(after)
    middles = {}
    for name, value in before:
        if isinstance(value, float) and value != ends[name]:
            middles[name] = (value + ends[name]) / 2
    if middles:
        return after.replace(**middles)
    return None


def energy_weights(p: Parameters) -> Array:
    """Weights of squared rows of the Jacobian in the energy of a motion."""
    modes = mode_arrays(p)
    compliance = contact_compliance(p)
    stiffness = modes.omega**2
    ones = np.ones(len(modes.omega))
    slider = [p.r_0**2 * p.k_p, p.r_0**2 * p.m]
    height = []
    if compliance:
        height = [p.k + 1 / compliance, p.m]
    rows = join_rows(modes, (stiffness, ones, stiffness, ones), slider, height)
    return np.asarray(rows, np.float64)
