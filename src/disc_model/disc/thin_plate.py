"""How far the frequencies of a thin plate are too high: it neither shears nor has rotary inertia.

A bending wave of wavenumber beta in Mindlin's plate, with q = (beta h)^2 and y = (omega /
omega_K)^2, omega_K being that of Kirchhoff's, has (1 - shear q y)(1 - rotary q y) = y, with shear =
1/(6 kappa (1 - nu)), rotary = 1/12 and kappa = pi^2/12. For long waves omega_K is too high by
(shear + rotary) q / 2.
"""

import math
from typing import NamedTuple

import numpy as np

from disc_model.arrays import Array
from disc_model.disc.plate import mode_arrays
from disc_model.parameters import Parameters

SHEAR_COEFFICIENT = math.pi**2 / 12  # kappa, Mindlin (1951): right for the thickness-shear mode
ROTARY = 1 / 12


class ShortestWave(NamedTuple):
    """The mode of a plate with the shortest waves: its nodal diameters and circles, its wavelength
    over the thickness, and the relative excess of its frequency."""

    diameters: int
    circles: int
    length: float
    excess: float


def excess_of_thin_plate(squared: Array, nu: float) -> Array:
    """Relative excess of Kirchhoff's frequency over Mindlin's of waves with the squares of wavenumber
    times thickness, by Poisson's ratio."""
    shear = 1 / (6 * SHEAR_COEFFICIENT * (1 - nu))
    total = 1 + (shear + ROTARY) * squared
    # of total^2 - 4 shear rotary q^2, as a sum of squares, which may be infinite
    root = np.hypot(np.sqrt(1 + 2 * (shear + ROTARY) * squared), (shear - ROTARY) * squared)
    # the lower root of the quadratic equation for y, 2 / (total + root)
    return np.asarray(np.sqrt((total + root) / 2) - 1)


def shortest_wave(p: Parameters) -> ShortestWave | None:
    """The mode with the shortest waves; None for a disc without a plate."""
    if p.disc is not None or p.n_diameters < 0:
        return None
    modes = mode_arrays(p, "orthonormal")
    squared = p.h**2 * modes.omega * math.sqrt(p.rho * p.h / p.D)
    i = int(squared.argmax())
    return ShortestWave(
        diameters=int(modes.diameters[i]),
        circles=int(modes.circles[i]),
        length=math.tau / math.sqrt(squared[i]),
        excess=float(excess_of_thin_plate(squared, p.nu)[i]),
    )
