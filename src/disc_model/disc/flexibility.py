"""Static flexibility of the disc under the slider: of the whole plate, of the modes kept, and of
those left out.

Under a unit load at r_0, in a point or spread over the arc of a pad, the clamped-free plate deflects
there by the sum of psi^2 / omega^2 over all its modes; under a pad, in the mean.  That is a static
problem: for each harmonic D L^2 R = delta(r - r_0)/r_0 with L = d^2/dr^2 + 1/r d/dr - l^2/r^2, solved
in closed form on both sides of the load.  The difference from the sum over the modes kept is the
residual flexibility.  Far from the edges a high harmonic is that of the unbounded plate,
r_0^2 / (4 D l (l^2 - 1)).  Lengths are in outer radii.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from disc_model.disc.plate import Array, mode_arrays, pad_factors
from disc_model.errors import Fault, ModeError, ParameterError, as_text, raise_faults, require
from disc_model.parameters import RESIDUAL, Parameters, foreign_case

HIGHEST_HARMONIC = 4096
"""Beyond it the plate is as if unbounded, unless the slider runs on its very edge."""
ROUNDING = (1e-13, 1e-16)
"""Relative error of the harmonics' closed forms, whose functions become nearly equal at large l, and
its growth with the inverse cube of the distance from the clamped edge over the radius."""
_TAIL_POINTS = 1000  # midpoints of the integral over harmonics beyond the highest
_TAIL_ERROR = 0.01  # of that integral, relative: at most 0.3 % for any arc
MODAL_SUM = (60, 20)
"""Diameters and circles of the sum that stands for all modes if these are ``as_published``."""


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
    """Deflection at the load of the harmonics `l` (n,), in units of b^2 / D: radii `inner` and 1, load
    at `x`. The plate's point deflects by the harmonic l = 0 over 2 pi plus the sum of the others
    over pi."""
    # growing powers are scaled to 1 at the outer end of their part of the plate, falling ones at the inner end
    inside = np.array([x, x, inner, inner])
    outside = np.array([1.0, 1.0, x, x])
    before, after = (_functions(l, x, scale) for scale in (inside, outside))
    conditions = np.zeros((l.size, 8, 8))
    conditions[:, :2, :4] = _functions(l, inner, inside)[:, :2]
    conditions[:, 2:4, 4:] = _free(l[:, None], nu, _functions(l, 1.0, outside))
    conditions[:, 4:, :4] = -before
    conditions[:, 4:, 4:] = after
    sizes = np.abs(conditions).max(axis=2)
    load = np.zeros((l.size, 8))
    load[:, 7] = 1 / x  # the jump of the third derivative
    systems = conditions / sizes[..., None]
    amplitudes = np.linalg.solve(systems, (load / sizes)[..., None])[..., 0]
    return np.asarray(np.sum(after[:, 0] * amplitudes[:, 4:], axis=1))


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
    rounding = ROUNDING[0] + ROUNDING[1] * (x / (x - inner)) ** 3
    bound = truncation / np.pi + rounding * total
    return float(total / np.pi), float(bound)


def _mean_of_tail(arc: float) -> float:
    """Mean of the pad's squared factor over the harmonics beyond `HIGHEST_HARMONIC` L, with their
    weights l^-3: with v = (L/l)^2 the integral over v from 0 to 1, by midpoints."""
    midpoints = (np.arange(_TAIL_POINTS) + 0.5) / _TAIL_POINTS
    return float(np.mean(pad_factors(HIGHEST_HARMONIC / np.sqrt(midpoints), arc) ** 2))


def _free(l: NDArray[np.int64], nu: float, w: Array) -> Array:
    """Radial moment and Kirchhoff shear at r = 1 of functions with the derivatives `w` (n, 4, ...)
    there: (n, 2, ...)."""
    square = np.square(l)
    value, slope, second, third = np.moveaxis(w, 1, 0)
    moment = second + nu * (slope - square * value)
    of_laplacian = third + second - (1 + square) * slope + 2 * square * value
    of_twist = (1 - nu) * square * (slope - value)
    return np.stack([moment, of_laplacian - of_twist], axis=1)


def _functions(l: NDArray[np.int64], r: float, scale: Array) -> Array:
    """The four functions of each harmonic that no load bends, r^l, r^(l+2), r^-l and r^(2-l) over
    their values at `scale` (4,), with derivatives 0 to 3 at r: (n, 4 derivatives, 4 functions). The
    third of l = 0, and the fourth of l = 0 and 1, have ln r besides, since they would equal another
    one."""
    n = l[:, None] * np.array([1.0, 1.0, -1.0, -1.0]) + np.array([0.0, 2.0, 0.0, 2.0])
    one = np.ones_like(n)
    none = np.zeros_like(n)
    powers = np.stack([one, n, n * (n - 1), n * (n - 1) * (n - 2)], axis=1)
    by_exponent = np.stack([none, one, 2 * n - 1, 3 * n**2 - 6 * n + 2], axis=1)
    logarithmic = l[:, None] < np.array([0, 0, 1, 2])
    factors = np.where(logarithmic[:, None], powers * np.log(r) + by_exponent, powers)
    return factors * ((r / scale) ** n)[:, None] / r ** np.arange(4.0)[:, None]
