"""Classical results of the moving load, next to the friction-induced ones.

A constant load that rotates over the disc resonates with the mode (circles, l) where l Omega equals its frequency:
the critical speed is the least omega_l / l.  The paper prints 608 rad/s, which is the least omega_l / (l + 1), an
index shifted by one; the base values give 911.94 rad/s, at l = 2.

An oscillator without friction that rotates over the disc (the slider at constant f = Omega, mu = 0) can be unstable
beyond; see `unstable_speeds`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from disc_model.errors import ParameterError
from disc_model.parameters import Parameters
from disc_model.plate import modal_damping, mode_arrays
from disc_model.stability.sliding import _jacobian

Array = NDArray[np.float64]

ROUNDING = 1e-10
"""Growth below this share of the highest frequency counts as none."""


@dataclass(frozen=True)
class CriticalSpeed:
    """Where a rotating constant load resonates first.

    Attributes
    ----------
    speed : rad/s, least omega / l
    circles, diameters : the mode's
    shifted_index : rad/s, least omega / (l + 1) over l >= 0, which is what the paper prints
    """

    speed: float
    circles: int
    diameters: int
    shifted_index: float


def critical_speed(p: Parameters) -> CriticalSpeed:
    """Critical speed of the moving load.

    Raises
    ------
    ParameterError
        If the model has no mode with a nodal diameter.
    """
    modes = mode_arrays(p)
    turning = np.flatnonzero(modes.diameters > 0)
    if len(turning) == 0:
        raise ParameterError(f"n_diameters={p.n_diameters}: must be >= 1 for a critical speed")
    speeds = modes.omega[turning] / modes.diameters[turning]
    i = int(np.argmin(speeds))
    shifted = float(np.min(modes.omega / (modes.diameters + 1)))
    return CriticalSpeed(float(speeds[i]), int(modes.circles[turning[i]]), int(modes.diameters[turning[i]]), shifted)


def rotating_oscillator_eigenvalues(p: Parameters, Omega: float) -> NDArray[np.complex128]:
    """Eigenvalues of disc and slider, bonded and without friction, the slider rotating at `Omega` (rad/s).

    Returns
    -------
    complex, 1/s, largest real part first; (4 per pair of modes + 2 per axisymmetric mode,)
    """
    modes = mode_arrays(p)
    damping = modal_damping(p)
    nothing = np.zeros(len(modes.omega))
    # mass ratio only: friction is zero, and the state about which f would vary does not matter
    frictionless = p.replace(mu_s=0.0, mu_k=0.0, Omega=Omega)
    denominator = 1 + p.m * float(np.sum(modes.psi**2))
    full = _jacobian(frictionless, modes, damping, nothing, nothing, nothing, 0.0, denominator)
    values = np.linalg.eigvals(full[:-2, :-2]).astype(complex)
    return values[np.argsort(-values.real, kind="stable")]


@dataclass(frozen=True)
class UnstableSpeeds:
    """An interval of speeds: `low` to `high` (rad/s), and the largest growth rate (1/s) met in it, at `worst`.

    `divergence` tells growth without oscillation from flutter.
    """

    low: float
    high: float
    growth_rate: float
    worst: float
    divergence: bool


def unstable_speeds(p: Parameters, top: float, *, points: int = 2000) -> list[UnstableSpeeds]:
    """Intervals of speed up to `top` (rad/s) in which the frictionless rotating oscillator is unstable.

    Found on a grid of `points` speeds and bounded by bisection; intervals narrower than the grid may be missed.

    Raises
    ------
    ParameterError
        If `top` or `points` is not positive.
    """
    if not (top > 0 and points >= 2):
        raise ParameterError(f"top={top!r}, points={points!r}: must be > 0 and >= 2")
    least = ROUNDING * float(mode_arrays(p).omega.max())

    def growth(speed: float) -> float:
        return float(rotating_oscillator_eigenvalues(p, speed)[0].real)

    speeds = [float(speed) for speed in np.linspace(0.0, top, points)]
    rates = np.array([growth(speed) for speed in speeds])
    unstable = np.concatenate([[False], rates > least, [False]])
    edges = np.flatnonzero(np.diff(unstable.astype(int))).reshape(-1, 2)

    def edge(stable: float, unstable_: float) -> float:
        while abs(unstable_ - stable) > 1e-9 * top:
            middle = 0.5 * (stable + unstable_)
            if growth(middle) > least:
                unstable_ = middle
            else:
                stable = middle
        return unstable_

    found = []
    for first, end in edges:
        low = speeds[0] if first == 0 else edge(speeds[first - 1], speeds[first])
        high = top if end == points else edge(speeds[end], speeds[end - 1])
        worst = speeds[first + int(np.argmax(rates[first:end]))]
        leading = rotating_oscillator_eigenvalues(p, worst)[0]
        found.append(
            UnstableSpeeds(low, high, float(leading.real), worst, bool(abs(leading.imag) < 1e-6 * abs(leading.real)))
        )
    return found
