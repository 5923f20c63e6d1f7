"""Modes of the disc: an annular Kirchhoff plate, clamped at its inner radius and free at its outer
radius.

With w = R(r) cos/sin(l theta), R = A J_l + B Y_l + C I_l + G K_l of beta r and beta^4 = rho h
omega^2 / D, the four edge conditions are a homogeneous system whose determinant vanishes at the
modes (the paper's Eqs. (13) to (17)). Lengths are in outer radii: x = r/b, lambda = beta b; lambda
depends on a/b, nu and l alone.

Bessel functions span hundreds of decades, so that each of the four columns is scaled by a factor
whose logarithm is kept. Roots are bracketed on a grid, refined, and checked: mode c of any l has
exactly c nodal circles.
"""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from operator import attrgetter
from typing import Any

import numpy as np

from disc_model.arrays import Array, Indices
from disc_model.errors import ModeError, as_text, require
from disc_model.parameters import SURFACE, Disc, Parameters

POINTS_PER_ROOT = 6  # grid points per asymptotic root spacing pi/(1 - a/b) when brackets are sought
WIDEST = 1e11  # greatest ratio of squared frequencies of disc and slider: their error is 1e-5, compared with 60 digits


@dataclass(frozen=True, eq=False)
class Modes:
    """The columns of `plate_modes` as read-only arrays of shape (n_modes,)."""

    circles: Indices
    diameters: Indices
    omega: Array
    psi: Array

    def __post_init__(self) -> None:
        for column in vars(self).values():
            column.setflags(write=False)

    @property
    def flexibility(self) -> float:
        """Static flexibility under the slider: the sum of psi^2 / omega^2, m/N; infinite beyond the
        range of floats."""
        with np.errstate(over="ignore"):
            return float(np.sum((self.psi / self.omega) ** 2))


def mode_arrays(p: Parameters) -> Modes:
    """The modes of `plate_modes` as read-only arrays, the same at every call."""
    return _modes_under(p, p.contact_arc)


def modes_at_point(p: Parameters) -> Modes:
    """As `mode_arrays`, with the amplitudes of a single point at r_0, whatever the slider's arc."""
    return _modes_under(p, 0.0)


def _modes_under(p: Parameters, arc: float) -> Modes:
    """The modes of a case with their mean amplitudes over an arc (rad)."""
    if p.disc is not None:
        return _modes_of_table(p.disc, arc)
    return _modes_of_plate(_PLATE(p), p.normalization == "orthonormal", arc)


def pad_factors(diameters: Indices | Array, arc: float) -> Array:
    """Mean displacement under a pad over that at its middle, of modes with these numbers of nodal
    diameters (n,): sin(l d)/(l d), 2 d being the pad's arc (rad)."""
    return np.asarray(np.sinc(diameters * (arc / math.tau)))


def tangential_amplitudes(p: Parameters) -> Array:
    """Amplitudes of the modes along the slider's path where friction acts, kg^-1/2, shape
    (n_modes,); under a pad, their means over its arc. At a height z of ``friction_offset`` above the
    middle plane they are -(z/r_0) l psi; 0 in that plane."""
    if p.disc is not None and p.friction_offset == SURFACE:
        return np.array(p.disc.tangential) * pad_factors(mode_arrays(p).diameters, p.contact_arc)
    modes = mode_arrays(p)
    height = p.friction_offset
    if height == SURFACE:
        height = p.h / 2
    return -float(height) / p.r_0 * modes.diameters * modes.psi


def mode_shapes(p: Parameters, r: Array) -> Array:
    """Amplitudes of the modes at radii r (m, shape (k,)), in kg^-1/2, (n_modes, k); at r_0 those of
    `modes_at_point`. For a table they are splines through its shapes. Raises ParameterError if it
    has none."""
    if p.disc is not None:
        from scipy.interpolate import make_interp_spline  # few callers need it

        radial_range(p)
        degree = min(3, len(p.disc.radii) - 1)
        return np.asarray(make_interp_spline(p.disc.radii, p.disc.shapes, k=degree, axis=1)(r))
    if p.n_diameters < 0:  # a rigid disc
        return np.zeros((0, len(r)))
    shapes = _shapes(p.a / p.b, p.nu, p.n_diameters, p.n_circles)
    radial = shapes.at(r / p.b, p.normalization == "orthonormal")
    return shapes.around[:, None] * radial / np.sqrt(p.rho * p.h * p.b**2)


def mode_slopes(p: Parameters, r: Array) -> tuple[Array, Array]:
    """Amplitudes of the modes of a plate at radii r (m, shape (k,)), and their derivatives by r, in
    kg^-1/2 and kg^-1/2 m^-1, both (n_modes, k)."""
    shapes = _shapes(p.a / p.b, p.nu, p.n_diameters, p.n_circles)
    value, slope = shapes.with_slopes(r / p.b, p.normalization == "orthonormal")
    scale = shapes.around[:, None] / np.sqrt(p.rho * p.h * p.b**2)
    return scale * value, scale * slope / p.b


def radial_range(p: Parameters) -> tuple[float, float]:
    """Least and greatest radius (m) of the known shapes; raises ParameterError if the table of a
    disc has none."""
    if p.disc is None:
        return p.a, p.b
    rule = "must have shapes: only amplitudes under the slider are known"
    require((p.disc.radii, "disc.radii", p.disc.radii, rule))
    return p.disc.radii[0], p.disc.radii[-1]


def coupled_frequencies(p: Parameters, compliance: float = 0.0) -> Array:
    """Frequencies of the modes of disc and attached slider at rest in which the slider moves,
    rad/s, ascending: (n,), or (n + 1,) with a `compliance` of the contact (m/N). Raises `ModeError`."""
    return np.sort(coupled_shapes(p, compliance)[0])


def coupled_shapes(p: Parameters, compliance: float = 0.0) -> tuple[Array, Array]:
    """Frequencies of `coupled_frequencies`, descending, and shapes in columns: n rows, each mode
    times its frequency. On a compliant contact the last row is the slider's."""
    from scipy import linalg  # takes 0.3 s, and most jobs do without

    # a matrix that is singular by rounding, or not finite
    with np.errstate(all="ignore"), suppress(linalg.LinAlgError, ValueError):
        inverse_squares, shapes = linalg.eigh(*_coupling(p, compliance))
        if not len(shapes) or inverse_squares[0] * WIDEST > inverse_squares[-1]:
            return 1 / np.sqrt(inverse_squares), shapes
    case = f"m={as_text(p.m)}, k={as_text(p.k)}, a contact compliance of {compliance:g} m/N and the disc's modes"
    rule = f"squared frequencies must be within a factor of {WIDEST:g}"
    raise ModeError(f"disc and slider at rest: {case}: {rule}")


def _coupling(p: Parameters, compliance: float) -> tuple[Array, Array]:
    """Both matrices of M y = lambda^-2 K y: `coupled_natural_frequencies` with y = omega v, so that
    low frequencies stay accurate beside high ones. On a compliant contact the last coordinate is u
    over the root of its compliance."""
    modes = mode_arrays(p)
    omega = modes.omega
    phi = modes.psi / omega
    if compliance == 0:
        at_slider = np.outer(phi, phi)
        return np.diag(omega**-2) + p.m * at_slider, np.eye(omega.size) + p.k * at_slider
    stretch = np.append(phi / np.sqrt(compliance), -1.0)
    mass = np.diag(np.append(omega**-2, p.m * compliance))
    uncoupled = np.append(np.ones(omega.size), p.k * compliance)
    return mass, np.diag(uncoupled) + np.outer(stretch, stretch)


def modal_damping(p: Parameters) -> Array:
    """Damping 2 xi omega of every mode, 1/s, in the order of `plate_modes`; (D*/D) omega^2 if no
    ratio xi is given."""
    omega = mode_arrays(p).omega
    if p.disc is not None:
        return 2 * np.array(p.disc.damping_ratio) * omega
    if p.damping_ratio is not None:
        return 2 * p.damping_ratio * omega
    return p.D_star / p.D * omega**2


@lru_cache(maxsize=64)
def _modes_of_table(disc: Disc, arc: float) -> Modes:
    """The modes of a disc that is given by a table, under an arc."""
    circles, diameters = (np.array(column, np.int64) for column in (disc.circles, disc.diameters))
    psi = np.array(disc.amplitude) * pad_factors(diameters, arc)
    return Modes(circles, diameters, np.array(disc.omega), psi)


_PLATE = attrgetter("a", "b", "r_0", "h", "E", "nu", "rho", "n_diameters", "n_circles")


@lru_cache(maxsize=1024)
def _modes_of_plate(plate: tuple[Any, ...], orthonormal: bool, arc: float) -> Modes:
    """Modes under an arc, cached by exactly the values on which they depend, so that another load or
    speed reuses them."""
    a, b, r_0, h, E, nu, rho, n_diameters, n_circles = plate
    if n_diameters < 0:  # a rigid disc
        return Modes(*np.zeros((2, 0), np.int64), *np.zeros((2, 0)))
    shapes = _shapes(a / b, nu, n_diameters, n_circles)
    stiffness = E * h**3 / 12 / (1 - nu**2)
    # numpy's floats overflow without an exception, and the outcome is checked
    with np.errstate(all="ignore"):
        area = np.float64(b) ** 2
        area_mass = np.float64(rho) * h
        omega = shapes.lam**2 / area * np.sqrt(stiffness / area_mass)
        amplitude = shapes.at(np.array([r_0 / b]), orthonormal)[:, 0]
        psi = shapes.around * amplitude / np.sqrt(rho * h * area) * pad_factors(shapes.l, arc)
    vibrate = np.all((omega > 0) & np.isfinite(omega))
    move = np.all(np.isfinite(psi)) and np.any(psi)
    if not (vibrate and move):
        values = f"E={as_text(E)}, h={as_text(h)}, b={as_text(b)}, rho={as_text(rho)}"
        rule = "frequencies or amplitudes must be within the range of numbers"
        raise ModeError(f"plate modes: {values}: {rule}")
    return Modes(shapes.circles, shapes.l, omega, psi)


@dataclass(frozen=True)
class _Shapes:
    """Radial shapes R(x), x = r/b, of the n modes of a plate with the radii `inner` and 1, by
    circles, then diameters.

    R = sum over J, Y, I, K of coefficients (4, n) times function / exp(exponents (4, n)), and
    `norm` (n,) is 2 pi * integral of R^2 x dx.
    """

    inner: float
    l: Indices
    lam: Array
    coefficients: Array
    exponents: Array
    norm: Array

    @property
    def circles(self) -> Indices:
        """Numbers of nodal circles."""
        return np.arange(len(self.l)) // (self.l[-1] + 1)

    @property
    def around(self) -> Array:
        """Norms of cos(l theta)."""
        return np.where(self.l > 0, np.sqrt(2), 1.0)

    def at(self, x: Array, orthonormal: bool) -> Array:
        """R of every mode at radii x (k,) in the requested normalisation, (n, k)."""
        value = _evaluate(self.l, self.lam, self.coefficients, self.exponents, x)
        if orthonormal:
            return value / np.sqrt(self.norm)[:, None]
        with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
            amplitude = value / self.coefficients[0, :, None] * np.exp(self.exponents[0, :, None])
        overflown = self.l[~np.isfinite(amplitude).all(axis=1)]
        if overflown.size:
            mode = f"the mode with {overflown[0]} nodal diameters at a/b={self.inner:g}"
            rule = "overflows when its coefficient of J_l is 1; use fewer diameters or normalization='orthonormal'"
            raise ModeError(f"normalization='as_published': {mode} {rule}")
        return amplitude

    def with_slopes(self, x: Array, orthonormal: bool) -> tuple[Array, Array]:
        """R and its derivative at radii x (k,) of every mode in the requested normalisation, both
        (n, k)."""
        value, slope, logs = _with_slope(self.l[:, None], self.lam[:, None] * x)
        factors = self.coefficients[..., None] * np.exp(logs - self.exponents[..., None])
        scale = self.norm**-0.5
        if not orthonormal:
            scale = np.exp(self.exponents[0]) / self.coefficients[0]
        R = np.sum(factors * value, axis=0)
        rate = self.lam[:, None] * np.sum(factors * slope, axis=0)
        return scale[:, None] * R, scale[:, None] * rate


@lru_cache(maxsize=256)
@np.errstate(all="ignore")
def _shapes(inner: float, nu: float, n_diameters: int, n_circles: int) -> _Shapes:
    """All shapes with up to `n_diameters` nodal diameters and `n_circles` nodal circles."""
    l = np.tile(np.arange(n_diameters + 1), n_circles + 1)
    lam = _roots(inner, nu, n_diameters, n_circles).ravel()
    matrix, exponents = _columns(l, lam, inner, nu)
    if not np.all(np.isfinite(matrix)):
        ratios = f"a/b={inner:g} and 1 - a/b={1 - inner:g}"
        rule = f"must not be so near 0 for {n_diameters} nodal diameters"
        raise ModeError(f"plate modes: {ratios} {rule}: the modes cannot be computed")
    matrix = np.moveaxis(matrix, -1, 0)
    rows = np.max(np.abs(matrix), axis=2, keepdims=True)
    coefficients = np.linalg.svd(matrix / rows)[2][:, -1, :].T
    # a null vector has no sign of its own; at the free edge no mode vanishes
    [at_edge] = _evaluate(l, lam, coefficients, exponents, np.array([1.0])).T
    coefficients = coefficients * np.sign(at_edge)
    # nodes that integrate R^2 r to rounding: several per half wave, more for edge layers of many
    # diameters
    needed = int(40 + lam[-1] * (1 - inner) + 1.2 * n_diameters)
    count = 8 * (needed // 8)
    nodes, weights = np.polynomial.legendre.leggauss(count)
    half = (1 - inner) / 2
    nodes = inner + half * (nodes + 1)
    weights = half * weights
    values = _evaluate(l, lam, coefficients, exponents, nodes)
    norm = 2 * np.pi * values**2 @ (weights * nodes)
    shapes = _Shapes(inner, l, lam, coefficients, exponents, norm)
    for shape, diameters, expected in zip(values, l, shapes.circles, strict=True):
        counted = _nodal_circles(shape)
        if counted != expected:
            root = f"root {expected} for {diameters} nodal diameters at a/b={inner:g}, nu={nu:g}"
            rule = f"has {counted} nodal circles; one was missed or doubled"
            raise ModeError(f"plate modes: {root} {rule}")
    return shapes


def _nodal_circles(shape: Array) -> int:
    """The number of changes of sign of a radial shape, but for rounding errors near the clamp."""
    sizes = np.abs(shape)
    clear = shape[sizes > 1e-7 * np.max(sizes)]
    return int(np.count_nonzero(clear[1:] * clear[:-1] < 0))


def _evaluate(l: Indices, lam: Array, coefficients: Array, exponents: Array, x: Array) -> Array:
    """R of n modes at the radii `x` (k,), roughly in units of its largest value: (n, k)."""
    values, logs = _bessel(l[:, None], lam[:, None] * x)
    factors = np.exp(logs - exponents[..., None])
    return np.sum(coefficients[..., None] * values * factors, axis=0)


def _roots(inner: float, nu: float, n_diameters: int, n_circles: int) -> Array:
    """The lowest zeros lambda of the frequency determinant for each l, (n_circles + 1, n_diameters
    + 1)."""
    from scipy.optimize.elementwise import find_root  # takes 0.2 s

    step = np.pi / (1 - inner) / POINTS_PER_ROOT
    l = np.arange(n_diameters + 1)
    # below the first roots, where the determinant is well conditioned
    start = 0.02 + 0.3 * np.maximum(l - 1.0, 0.0)
    first = POINTS_PER_ROOT * (n_circles + 1) + 8
    for count in first * 2 ** np.arange(9):
        grid = start[:, None] + step * np.arange(count + 1)
        of_grid = np.broadcast_to(l[:, None], grid.shape).ravel()
        signs = np.sign(_determinant(of_grid, grid.ravel(), inner, nu)).reshape(grid.shape)
        # a zero on the grid belongs to the interval that ends there
        changes = (signs[:, 1:] != signs[:, :-1]) & (signs[:, :-1] != 0)
        lacking = l[changes.sum(axis=1) <= n_circles]
        if lacking.size == 0:
            break
    else:
        roots = f"no {n_circles + 1} roots for {lacking[0]} nodal diameters"
        raise ModeError(f"plate modes: {roots} at a/b={inner:g}")
    places = np.argsort(~changes, axis=1, kind="stable")[:, : n_circles + 1]
    brackets = [np.take_along_axis(grid, places + end, axis=1).T for end in (0, 1)]
    orders = np.tile(l, (n_circles + 1, 1))

    def determinant(lam: Array, orders: Indices) -> Array:
        return _determinant(orders.ravel(), lam.ravel(), inner, nu).reshape(lam.shape)

    # Chandrupatla's method, to rounding
    tight = {"xatol": 0.0, "xrtol": 2e-16, "fatol": 0.0, "frtol": 0.0}
    found = find_root(determinant, tuple(brackets), args=(orders,), tolerances=tight, maxiter=50)
    return np.asarray(found.x)


def _determinant(l: Indices, lam: Array, inner: float, nu: float) -> Array:
    """Determinant of the scaled edge conditions, up to a positive factor, for `l` and `lam` (n,):
    (n,)."""
    m, _ = _columns(l, lam, inner, nu)
    # Laplace expansion: minors of the clamped edge (rows 0, 1) times those of the free edge (rows
    # 2, 3).
    i = [0, 2, 0, 1, 0, 1]
    j = [1, 3, 2, 3, 3, 2]
    partner = [1, 0, 3, 2, 5, 4]
    value, slope, moment, shear = m
    clamped = value[i] * slope[j] - value[j] * slope[i]
    free = moment[i] * shear[j] - moment[j] * shear[i]
    sign = np.array([1.0, 1.0, -1.0, -1.0, 1.0, 1.0])[:, None]
    return np.sum(sign * clamped * free[partner], axis=0)


def _columns(l: Indices, lam: Array, inner: float, nu: float) -> tuple[Array, Array]:
    """Matrix of the edge conditions, (4 conditions, 4 functions, n), and logarithms (4, n) taken
    out of its columns. Its rows are R and R' at the inner edge, radial moment and Kirchhoff shear
    at the outer one, over lambda x."""
    value, slope, logs = _with_slope(l, np.stack([lam * inner, lam]))
    # J and I grow outwards, Y and K inwards: scaled by the larger edge, no entry is much above one.
    exponents = np.max(logs, axis=1)
    scale = np.exp(logs - exponents[:, None])
    value = value * scale
    slope = slope * scale
    kind = np.array([-1.0, -1.0, 1.0, 1.0])[:, None]  # Laplacian R = kind * lambda^2 R
    bend = (1 - nu) * (l / lam) ** 2
    # M = Laplacian R - (1 - nu) (R'/r - l^2 R/r^2)
    value_outer = value[:, 1]
    slope_outer = slope[:, 1]
    moment = (kind + bend) * value_outer - (1 - nu) / lam * slope_outer
    # V = (Laplacian R)' - (1 - nu) l^2/r^2 (R' - R/r)
    shear = (kind - bend) * slope_outer + bend / lam * value_outer
    return np.stack([value[:, 0], slope[:, 0], moment, shear]), exponents


def _with_slope(l: Indices, x: Array) -> tuple[Array, Array, Array]:
    """J, Y, I, K of order l and their derivatives at `x` (..., n), the larger of them 1 in
    magnitude, and the logarithms of their factors: (4, ..., n) each."""
    value, exponent = _bessel(l, x)
    following, exponent_next = _bessel(l + 1, x)
    along_functions = (4,) + (1,) * x.ndim
    sign = np.array([-1.0, -1.0, 1.0, -1.0]).reshape(along_functions)
    scale = np.exp(exponent_next - exponent)
    slope = l / x * value + sign * following * scale
    size = np.maximum(np.abs(value), np.abs(slope))
    return value / size, slope / size, exponent + np.log(size)


def _bessel(l: Indices, x: Array) -> tuple[Array, Array]:
    """J, Y, I, K of the orders `l` at `x` as mantissa and natural exponent, each (4, *shape of
    x)."""
    from scipy import special  # takes 0.2 s, and merges and figures do without

    functions = (special.jv, special.yv, special.ive, special.kve)
    value = np.stack([function(l, x) for function in functions])
    exponent = np.stack([np.zeros_like(x), np.zeros_like(x), x, -x])
    return value, exponent
