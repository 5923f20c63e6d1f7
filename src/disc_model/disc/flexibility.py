"""Static flexibility of the disc under the slider: of the whole plate, of the modes kept, and of
those left out.

Under a unit load at r_0, in a point or spread over the arc of a pad, the clamped-free plate deflects
there by the sum of psi^2 / omega^2 over all its modes; under a pad, in the mean.  That is a static
problem: for each harmonic D L^2 R = delta(r - r_0)/r_0 with L = d^2/dr^2 + 1/r d/dr - l^2/r^2, solved
in closed form.  The difference from the sum over the modes kept is the residual flexibility.

For l >= 2 a harmonic is that of the unbounded plate, r_0^2 / (4 D l (l^2 - 1)), plus the effect of
the two edges: four functions r^l, r^(l+2), r^-l, r^(2-l), each scaled to 1 at the edge where it is
largest.  Lengths are in outer radii.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from disc_model.disc.plate import Array, mode_arrays, pad_factors
from disc_model.errors import Fault, ModeError, ParameterError, as_text, raise_faults, require
from disc_model.parameters import RESIDUAL, Parameters, foreign_case

HIGHEST_HARMONIC = (
    4096  # beyond it the plate is as if unbounded, unless the slider runs on its very edge
)
ROUNDING = 1e-13  # relative accuracy of the harmonics' closed forms: their functions become nearly equal at large l
_TAIL_POINTS = 1000  # midpoints of the integral over harmonics beyond the highest
_TAIL_ERROR = 0.01  # of that integral, relative: at most 0.3 % for any arc
MODAL_SUM = (
    60,
    20,
)  # diameters and circles of the sum that stands for all modes if these are ``as_published``


@dataclass(frozen=True)
class Flexibility:
    """Static flexibility of the disc's point under the slider, m/N.

    total : flexibility of all modes
    kept : flexibility of the modes of the case
    remainder : error of ``total``: a bound for ``orthonormal``, an estimate for ``as_published``
    """

    total: float
    kept: float
    remainder: float

    @property
    def residual(self) -> float:
        """Flexibility of the modes left out, total - kept, m/N."""
        return self.total - self.kept


def residual_flexibility(case: Parameters) -> Flexibility:
    """Static flexibility of all modes and of those kept; ``contact_compliance="residual"`` is their
    difference.

    For ``orthonormal`` modes the sum over all modes is exactly the static deflection of the plate
    under a point load. Modes ``as_published`` do not expand a load, so that only their sum up to
    `MODAL_SUM` is available. Its remainder is a third of the sum's upper half, because terms
    decrease at least as the third power.

    Parameters
    ----------
    case : the case

    Returns
    -------
    Flexibility
        m/N: total, kept, their difference residual, and remainder, the error of the total.

    Raises
    ------
    ParameterError
        If `case` is not a `Parameters`.
    ModeError
        If the modes cannot be computed.

    Examples
    --------
    >>> import disc_model as dm
    >>> flexibility = dm.residual_flexibility(dm.Parameters(N=385, Omega=15.1, normalization="orthonormal"))
    >>> f"{flexibility.residual:.3g} m/N"
    '3.17e-07 m/N'
    """
    raise_faults(foreign_case(case))
    found = _flexibility(case)
    if not is_modal_sum(case):
        return found
    diameters, circles = MODAL_SUM
    half = _modal_sum(case.replace(n_diameters=diameters // 2, n_circles=circles // 2))
    return Flexibility(found.total, found.kept, (found.total - half) / 3)


def is_modal_sum(p: Parameters) -> bool:
    """Whether the flexibility of all modes is a sum over a thousand of them, which takes seconds
    for each shape of the plate."""
    return p.disc is None and p.normalization != "orthonormal"


def _flexibility(p: Parameters) -> Flexibility:
    """As `residual_flexibility`, but without the remainder of a modal sum."""
    kept = _modal_sum(p)
    if p.disc is not None:
        if p.disc.static_compliance is None:
            rule = "must be given for the compliance of the modes left out"
            raise ParameterError(Fault(("disc", "static_compliance"), "None", rule))
        return Flexibility(p.disc.static_compliance, kept, 0.0)
    if is_modal_sum(p):
        diameters, circles = MODAL_SUM
        whole = p.replace(n_diameters=diameters, n_circles=circles)
        return Flexibility(_modal_sum(whole), kept, np.nan)
    value, bound = _deflection(p.a / p.b, p.r_0 / p.b, p.nu, p.contact_arc)
    total = value * p.b**2 / p.D
    remainder = bound * p.b**2 / p.D
    return Flexibility(total, kept, remainder)


def contact_compliance(p: Parameters) -> float:
    """Compliance of a case's contact, m/N; raises `ParameterError` if "residual" is asked for and
    no mode left out."""
    if p.contact_compliance != RESIDUAL:
        return float(p.contact_compliance)
    found = _flexibility(p)
    rule = f"must be a number: of the static compliance {found.total:.6g} m/N the modes give {found.kept:.6g} m/N"
    require((found.residual > 0, "contact_compliance", RESIDUAL, rule))
    return found.residual


def _modal_sum(p: Parameters) -> float:
    """Sum of psi^2 / omega^2 over the modes of a case, m/N."""
    total = mode_arrays(p).flexibility
    if not total < np.inf:
        rule = "static flexibility of the modes must be within the range of numbers"
        values = [f"{name}={as_text(getattr(p, name))}" for name in ("E", "h", "b")]
        raise ModeError(f"{', '.join(values)}: {rule}")
    return total


def harmonic_flexibility(l: NDArray[np.int64], inner: float, x: float, nu: float) -> Array:
    """Deflection at the load of the harmonics `l`, in units of b^2 / D: radii `inner` and 1, load
    at `x`. The plate's point deflects by the harmonic l = 0 over 2 pi plus the sum of the others
    over pi."""
    value = np.empty(l.shape)
    for order in (0, 1):
        value[l == order] = _with_edges(order, inner, x, nu)
    value[l >= 2] = _high_harmonics(l[l >= 2], inner, x, nu)
    return value


@lru_cache(maxsize=256)
def _deflection(inner: float, x: float, nu: float, arc: float) -> tuple[float, float]:
    """Mean deflection under a load that is spread evenly over an arc (rad), or in a point, in units
    of b^2 / D, and a bound on its error."""
    last = HIGHEST_HARMONIC
    l = np.arange(last + 1)
    harmonics = harmonic_flexibility(l, inner, x, nu)
    # sum of 1/(l (l^2 - 1)) over l > L is 1/(2 L (L + 1))
    tail = x**2 / (8 * last * (last + 1))
    # the edge acts on the last harmonic by this factor, and on higher ones by less
    factor = harmonics[-1] / (x**2 / (4 * last * (last**2 - 1.0)))
    # both the load and the mean have the pad's factor
    harmonics = pad_factors(l, arc) ** 2 * harmonics
    tail *= _mean_of_tail(arc)
    summed = np.sum(harmonics[:0:-1])  # the smallest first
    total = harmonics[0] / 2 + summed + factor * tail
    truncation = abs(factor - 1) * tail
    if arc:
        truncation += _TAIL_ERROR * tail
    bound = truncation / np.pi + ROUNDING * total
    return float(total / np.pi), float(bound)


def _mean_of_tail(arc: float) -> float:
    """Mean of the pad's squared factor over the harmonics beyond `HIGHEST_HARMONIC` L, with their
    weights l^-3: with v = (L/l)^2 the integral over v from 0 to 1, by midpoints."""
    midpoints = (np.arange(_TAIL_POINTS) + 0.5) / _TAIL_POINTS
    return float(np.mean(pad_factors(HIGHEST_HARMONIC / np.sqrt(midpoints), arc) ** 2))


def _free(l: NDArray[np.int64] | int, nu: float, w: Array) -> tuple[Array, Array]:
    """Radial moment and Kirchhoff shear at r = 1 of functions with the derivatives `w` (4, ...)
    there."""
    square = np.square(l)
    value, slope, second, third = w
    moment = second + nu * (slope - square * value)
    of_laplacian = third + second - (1 + square) * slope + 2 * square * value
    of_twist = (1 - nu) * square * (slope - value)
    return moment, of_laplacian - of_twist


def _power(n: Array, r: float) -> Array:
    """Derivatives 0 to 3 of r^n over r^n: (4, ...)."""
    value = np.ones_like(n)
    slope = n / r
    second = n * (n - 1) / r**2
    third = n * (n - 1) * (n - 2) / r**3
    return np.stack([value, slope, second, third])


def _high_harmonics(l: NDArray[np.int64], inner: float, x: float, nu: float) -> Array:
    """Harmonics l >= 2 (n,): those of the unbounded plate plus the effect of the edges."""
    n = l.astype(float)
    powers = np.stack([n, n + 2, -n, 2 - n])  # (4, n)
    # r^n over its value at the edge where it is largest: 1 for the first two, inner for the others
    largest = np.array([1.0, 1.0, inner, inner])[:, None]
    clamped, free, at_slider = ((r / largest) ** powers for r in (inner, 1.0, x))
    at_inner, at_outer = (_power(powers, r) for r in (inner, 1.0))
    moment, shear = _free(l, nu, at_outer)
    slope = clamped * at_inner[1] * inner / n
    free_moment = free * moment / n**2
    free_shear = free * shear / n**3
    matrix = np.stack([clamped, slope, free_moment, free_shear])
    # the unbounded plate: [s^2 (r/s)^l/(l-1) - r^2 (r/s)^l/(l+1)] / 8 l inside of s; outside, r and
    # s are exchanged, so that its powers are the last two
    near = (inner / x) ** n / (8 * n)
    far = x**n / (8 * n)
    inside_l = near * x**2 / (n - 1)  # its power r^l,
    inside_next = -near * inner**2 / (n + 1)  # and r^(l + 2)
    outside_next = far / (n - 1)  # r^(2 - l),
    outside_l = -far * x**2 / (n + 1)  # and r^-l
    value = inside_l + inside_next
    slope = (inside_l * n + inside_next * (n + 2)) / n
    load_moment = (outside_next * moment[3] + outside_l * moment[2]) / n**2
    load_shear = (outside_next * shear[3] + outside_l * shear[2]) / n**3
    right = np.stack([value, slope, load_moment, load_shear])

    # the homogeneous solution that meets the conditions at both edges
    systems = np.moveaxis(matrix, -1, 0)
    edges = np.linalg.solve(systems, -right.T[..., None])[..., 0]
    unbounded = x**2 / (4 * n * (n**2 - 1))
    return unbounded + np.sum(edges.T * at_slider, axis=0)


def _particular(l: int, s: float) -> Array:
    """Derivatives 0 to 3 at r = 1 of a solution that is flat up to the load at s. For l = 0 it is
    [(r^2 + s^2) ln(r/s) - r^2 + s^2]/4, for l = 1 r^3/(16 s) - s r ln(r/s)/4 - s^3/(16 r)."""
    log = -np.log(s)
    if l == 0:
        value = (1 + s**2) * log - 1 + s**2
        slope = 2 * log + (1 + s**2) - 2
        second = 2 * log + 3 - s**2 - 2
        third = 2 + 2 * s**2
        return np.array([value, slope, second, third]) / 4
    value = 1 / (16 * s) - s * log / 4 - s**3 / 16
    slope = 3 / (16 * s) - s * (log + 1) / 4 + s**3 / 16
    second = 6 / (16 * s) - s / 4 - 2 * s**3 / 16
    third = 6 / (16 * s) + s / 4 + 6 * s**3 / 16
    return np.array([value, slope, second, third])


def _logarithmic(l: int, r: float) -> Array:
    """Functions of l = 0 (1, ln r, r^2, r^2 ln r) or l = 1 (r, 1/r, r^3, r ln r), derivatives 0 to
    3 at r: (4, 4)."""
    log = np.log(r)
    if l == 0:
        constant = [1, 0, 0, 0]
        logarithm = [log, 1 / r, -1 / r**2, 2 / r**3]
        square = [r**2, 2 * r, 2, 0]
        product = [r**2 * log, 2 * r * log + r, 2 * log + 3, 2 / r]
        return np.array([constant, logarithm, square, product]).T
    linear = [r, 1, 0, 0]
    inverse = [1 / r, -1 / r**2, 2 / r**3, -6 / r**4]
    cube = [r**3, 3 * r**2, 6 * r, 6]
    product = [r * log, log + 1, 1 / r, -1 / r**2]
    return np.array([linear, inverse, cube, product]).T


def _with_edges(l: int, inner: float, x: float, nu: float) -> float:
    """Harmonic l = 0 or 1 at the load, where the particular solution is zero."""
    clamped = _logarithmic(l, inner)
    free = _logarithmic(l, 1.0)
    particular = _particular(l, x)
    matrix = np.array([clamped[0], clamped[1], *_free(l, nu, free)])
    right = -np.array([0.0, 0.0, *_free(l, nu, particular)])
    return float(np.linalg.solve(matrix, right) @ _logarithmic(l, x)[0])
