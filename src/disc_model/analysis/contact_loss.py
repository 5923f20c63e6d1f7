"""The range of vibration at which a slider loses contact, and how far a motion with separation
exceeds it (docs/model.md, The range at which contact is lost)."""

import math
from typing import Annotated

from disc_model.parameters import Parameters
from disc_model.units import Positive, Unit, checked


@checked
def pinned_range(case: Parameters, frequency: Annotated[Positive, Unit("Hz")]) -> float:
    """Range of the slider's height at which vibration at one frequency loses contact, m.

    In contact the slider follows the disc, so that the vibration U cos(omega t) of its height needs
    the contact force N + Re[(k - m omega^2 + i c omega) U exp(i omega t)]. Its least value is 0 at
    the range

        R = 2 N / abs(k - m omega^2 + i c omega).

    The disc enters by the frequency only, and neither friction, speed nor the motion in the plane
    do.

    Parameters
    ----------
    case : the case
    frequency : Hz, of the vibration

    Returns
    -------
    float
        m, peak to peak; infinite where spring and mass balance and there is no damper

    Raises
    ------
    ParameterError
        If `case` is not a `Parameters`, or the frequency is not positive and finite.

    Examples
    --------
    >>> import disc_model as dm
    >>> f"{1e3 * dm.pinned_range(dm.Parameters(N=200, Omega=20), 135.42):.2f} mm"
    '17.86 mm'
    """
    omega = 2 * math.pi * frequency
    stiffness = abs(complex(case.k - case.m * omega**2, case.c * omega))
    if stiffness == 0:
        return math.inf
    return 2 * case.N / stiffness


def excess_of_flights(apart: float) -> float:
    """Excess of the range over `pinned_range`, relative to it, of a motion that is apart for a
    small share of the time.

    A vibration that is larger by the share e needs a negative force for the time 2 t_0 about its
    extreme, with omega t_0 = sqrt(2 e). The bodies part when it begins and meet again 4 t_0
    later, hence the share of the time is 4 t_0 omega / (2 pi), and e = (pi apart)^2 / 8.

    Examples
    --------
    >>> round(excess_of_flights(0.1), 4)
    0.0123
    """
    return (math.pi * apart) ** 2 / 8
