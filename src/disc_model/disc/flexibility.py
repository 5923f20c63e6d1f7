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
from disc_model.errors import Fault, ModeError, ParameterError, as_text, require
from disc_model.parameters import RESIDUAL, Parameters, require_case

HIGHEST_HARMONIC = 4096
"""Beyond it the plate is as if unbounded, unless the slider runs on its very edge."""
MODAL_SUM = (60, 20)
"""Diameters and circles of the sum that stands for all modes if these are ``as_published``."""


@dataclass(frozen=True)
class Flexibility:
    """Static flexibility of the disc's point under the slider, m/N.

    total : flexibility of all modes
    kept : flexibility of the modes of the case
    """

    total: float
    kept: float

    @property
    def residual(self) -> float:
        """Flexibility of the modes left out, total - kept, m/N."""
        return self.total - self.kept


def residual_flexibility(case: Parameters) -> Flexibility:
    """Static flexibility of all modes and of those kept; ``contact_compliance="residual"`` is their
    difference.

    For ``orthonormal`` modes the sum over all modes is exactly the static deflection of the plate
    under a point load, found to 1e-8. Modes ``as_published`` do not expand a load, so that only
    their sum up to `MODAL_SUM` is available, which takes seconds for each shape of the plate.

    Parameters
    ----------
    case : the case

    Returns
    -------
    Flexibility
        m/N: total, kept, and their difference residual.

    Raises
    ------
    ParameterError
        If `case` is not a `Parameters`, or its disc has no static compliance.
    ModeError
        If the modes cannot be computed.

    Examples
    --------
    >>> import disc_model as dm
    >>> flexibility = dm.residual_flexibility(dm.Parameters(N=385, Omega=15.1, normalization="orthonormal"))
    >>> f"{flexibility.residual:.3g} m/N"
    '3.17e-07 m/N'
    """
    require_case(case)
    kept = _modal_sum(case)
    if case.disc is not None:
        total = case.disc.static_compliance
        if total is None:
            rule = "must be given for the compliance of the modes left out"
            raise ParameterError(Fault(("disc", "static_compliance"), "None", rule))
        return Flexibility(total, kept)
    if case.normalization != "orthonormal":
        diameters, circles = MODAL_SUM
        whole = case.replace(n_diameters=diameters, n_circles=circles)
        return Flexibility(_modal_sum(whole), kept)
    value = _deflection(case.a / case.b, case.r_0 / case.b, case.nu, case.contact_arc)
    return Flexibility(value * case.b**2 / case.D, kept)


def contact_compliance(p: Parameters) -> float:
    """Compliance of a case's contact, m/N; raises `ParameterError` if "residual" is asked for and
    no mode left out."""
    if p.contact_compliance != RESIDUAL:
        return float(p.contact_compliance)
    found = residual_flexibility(p)
    rule = f"must be a number: of the static compliance {found.total:.6g} m/N the modes give {found.kept:.6g} m/N"
    require((found.residual > 0, "contact_compliance", RESIDUAL, rule))
    return found.residual


def _modal_sum(p: Parameters) -> float:
    """Sum of psi^2 / omega^2 over the modes of a case, m/N."""
    total = mode_arrays(p).flexibility
    if not total < np.inf:
        rule = "static flexibility of the modes must be within the range of numbers"
        raise ModeError(f"E={as_text(p.E)}, h={as_text(p.h)}, b={as_text(p.b)}: {rule}")
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
def _deflection(inner: float, x: float, nu: float, arc: float) -> float:
    """Mean deflection under a load that is spread evenly over an arc (rad), or in a point, in units
    of b^2 / D."""
    last = HIGHEST_HARMONIC
    l = np.arange(last + 1)
    # both the load and the mean have the pad's factor
    harmonics = pad_factors(l, arc) ** 2 * harmonic_flexibility(l, inner, x, nu)
    summed = np.sum(harmonics[:0:-1])  # the smallest first
    # higher ones fall as 1/(l (l^2 - 1)), whose sum over l > L is 1/(2 L (L + 1))
    tail = harmonics[-1] * (last - 1) / 2
    return float((harmonics[0] / 2 + summed + tail) / np.pi)


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
