"""Modes and natural frequencies of a case, as a reader asks for them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from disc_model.arrays import Array
from disc_model.disc.plate import coupled_frequencies, mode_arrays
from disc_model.parameters import Parameters, require_case

if TYPE_CHECKING:
    import pandas as pd


def plate_modes(case: Parameters) -> pd.DataFrame:
    """Natural frequencies of the disc alone, and the modes' amplitudes under the slider.

    Parameters
    ----------
    case : the case

    Returns
    -------
    DataFrame
        A fresh one at every call, with a row for each (circles, diameters), ordered by circles, then diameters:

        - circles, diameters : int, number of nodal circles and nodal diameters
        - omega : rad/s, natural frequency
        - psi : kg^-1/2, Psi = R(r_0)/sqrt(rho h b^2), times sqrt(2) if diameters >= 1 (for a pair of modes);
          under a pad, the mean over its arc

    Notes
    -----
    R is scaled as `p.normalization` says: `as_published` gives the coefficient of J_l the value 1;
    `orthonormal` is Eq. (17), (2 pi/b^2) * integral of R^2 r dr from a to b = 1, with R positive at the free edge.

    Raises
    ------
    ParameterError
        If `case` is not a `Parameters`.
    ModeError
        If the modes cannot be distinguished or an amplitude overflows.

    Examples
    --------
    >>> import disc_model as dm
    >>> dm.plate_modes(dm.Parameters(N=385, Omega=15.1)).round(3)
       circles  diameters     omega    psi
    0        0          0  1491.927 -1.306
    1        0          1  1516.757  8.173
    2        0          2  1823.881  1.534
    3        0          3  2774.194  1.150
    4        0          4  4383.044  0.984
    """
    import pandas as pd

    require_case(case)
    return pd.DataFrame(vars(mode_arrays(case)))


def coupled_natural_frequencies(case: Parameters) -> Array:
    """Natural frequencies of disc and attached slider at rest (Section 4.4 of the paper), rad/s,
    ascending.

    Solves (diag(omega^2) + k psi psi^T) v = lambda^2 (I + m psi psi^T) v for the modes that have an
    amplitude under the slider; the other mode of each diametral pair has a node there and keeps its
    frequency. Contact is rigid as in the paper, whatever the contact of the case.

    Parameters
    ----------
    case : the case

    Returns
    -------
    array
        Shape (number of real modes,).

    Raises
    ------
    ParameterError, ModeError
        As `plate_modes`.

    Examples
    --------
    >>> import disc_model as dm
    >>> dm.coupled_natural_frequencies(dm.Parameters(N=385, Omega=15.1))[:3].round(2)
    array([ 850.86, 1492.55, 1516.76])
    """
    require_case(case)
    modes = mode_arrays(case)
    return np.sort(np.concatenate([coupled_frequencies(case), modes.omega[modes.diameters > 0]]))
