"""Resonances of the stick-slip cycle: which one a multiplier belongs to, and where to expect them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from disc_model.errors import ParameterError
from disc_model.parameters import Parameters
from disc_model.plate import coupled_shapes, mode_arrays
from disc_model.stability.tongue import Tongue

Array = NDArray[np.float64]


def nearest_tongue(p: Parameters, period: float, multiplier: complex, diameters: int | None = None) -> Tongue:
    """The resonance that a cycle's multiplier belongs to.

    Over a period the slider turns by Omega T against the disc.  A free mode of frequency f and l diameters is therefore
    seen at f -/+ l Omega / 2 pi; one that the slider binds, so that it stands in the slider's frame, at f itself.
    Modulo f_s that is the multiplier's angle over 2 pi T.  The harmonic is the multiple of f_s nearest to it (of
    f_s / 2 for a negative real multiplier).

    Parameters
    ----------
    period : s
    diameters : l of the modes to choose from, as in `Branch.diameters`; all by default, and then chance may choose
    """
    rate = 1 / float(period)
    angle = math.atan2(multiplier.imag, multiplier.real) / (2 * math.pi)
    half = 0.5 if multiplier.imag == 0 and multiplier.real < 0 else 0.0
    best: tuple[float, Tongue] | None = None
    for frequency, l, bound in modes_at_rest(p):
        if diameters is not None and l != diameters:
            continue
        for sign in _signs(l, bound):
            seen = (frequency + sign * l * p.Omega / (2 * math.pi)) / rate
            miss = min(abs((seen - s * angle + 0.5) % 1 - 0.5) for s in (-1, 1))
            harmonic = round(seen - half) + half
            tongue = Tongue(harmonic, frequency, l, sign, float((harmonic - seen) * rate))
            if best is None or miss < best[0]:
                best = (miss, tongue)
    if best is None:
        raise ParameterError(f"diameters={diameters!r}: must be those of a mode")
    return best[1]


@dataclass(frozen=True, eq=False)
class TongueLine:
    """Where a resonance lies: `Omega` (rad/s) and `N` (N), shape (n_points,); the rest as in `Tongue`."""

    label: str
    harmonic: int
    frequency: float
    diameters: int
    sign: int
    Omega: Array
    N: Array


def rigid_period(p: Parameters) -> float:
    """Period of the stick-slip cycle on a rigid disc, in-plane damping neglected, s: P = N, slip a free oscillation."""
    rate = math.sqrt(p.k_p / p.m)
    extension = (p.mu_s - p.mu_k) * p.N / (p.r_0 * p.k_p)
    return 2 / rate * (math.pi - math.atan(extension * rate / p.Omega)) + 2 * extension / p.Omega


def tongue_lines(
    p: Parameters, loads: Array, speeds: tuple[float, float], *, diameters: int | None = None, harmonics: int = 12
) -> list[TongueLine]:
    """Lines n f_s = f -/+ l Omega / 2 pi, with f_s of the rigid disc's cycle: where to expect folds and tongues.

    Parameters
    ----------
    p : the case; its N and Omega do not matter
    loads : N, shape (n,), ascending
    speeds : rad/s, least and largest
    diameters : l of the modes wanted; all by default
    harmonics : largest n

    Returns
    -------
    A line for each resonance; two where it passes the same load at two speeds.
    """
    from scipy.optimize import brentq

    grid = np.geomspace(speeds[0], speeds[1], 60)
    lines = []
    for frequency, l, bound in modes_at_rest(p):
        if diameters is not None and l != diameters:
            continue
        for sign in _signs(l, bound):
            for n in range(1, harmonics + 1):

                def miss(
                    Omega: float, N: float, n: int = n, f: float = frequency, turn: float = sign * l / (2 * math.pi)
                ) -> float:
                    return n / rigid_period(p.replace(N=N, Omega=Omega)) - f - turn * Omega

                branches: dict[int, list[tuple[float, float]]] = {}
                for load in map(float, loads):
                    values = [miss(float(Omega), load) for Omega in grid]
                    for j, i in enumerate(np.flatnonzero(np.diff(np.sign(values)))):
                        branches.setdefault(j, []).append((brentq(miss, grid[i], grid[i + 1], args=(load,)), load))
                for points in branches.values():
                    label = Tongue(n, frequency, l, sign, 0.0).label
                    Omega, N = np.array(points).T
                    lines.append(TongueLine(label, n, frequency, l, sign, Omega, N))
    return lines


def _signs(l: int, bound: bool) -> tuple[int, ...]:
    """Shifts by the rotation that a mode may have."""
    if l == 0:
        return (0,)
    return (0, -1, 1) if bound else (-1, 1)


def modes_at_rest(p: Parameters) -> list[tuple[float, int, bool]]:
    """Frequency (Hz), number of diameters and whether the slider takes part, for every mode of disc and slider at rest.

    A coupled mode takes the diameters of the disc's mode that has most of its energy; its partner, which the slider
    leaves alone, keeps its own.
    """
    modes = mode_arrays(p)
    frequencies, shapes = coupled_shapes(modes.omega, modes.psi, p.m, p.k)
    coupled = [
        (float(frequency) / (2 * math.pi), int(modes.diameters[np.argmax(np.abs(shape))]), True)
        for frequency, shape in zip(frequencies, shapes.T, strict=True)
    ]
    alone = [
        (float(omega) / (2 * math.pi), int(l), False)
        for omega, l in zip(modes.omega, modes.diameters, strict=True)
        if l > 0
    ]
    return sorted(coupled + alone)
