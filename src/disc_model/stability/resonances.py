"""Resonances of the stick-slip cycle: the one to which a multiplier belongs, and its label in figures."""

import math
from dataclasses import dataclass

import numpy as np

from disc_model.disc.flexibility import contact_compliance
from disc_model.disc.plate import coupled_shapes, mode_arrays
from disc_model.errors import ParameterError
from disc_model.parameters import Parameters


@dataclass(frozen=True)
class Resonance:
    """A resonance n f_s = f -/+ l Omega / 2 pi of a cycle.

    harmonic : n; half-integer for a period doubling
    frequency, diameters : f (Hz) and l, of a mode of disc and slider at rest
    sign : -1 or 1, of l Omega / 2 pi; 0 if the mode stands in the slider's frame
    detuning : Hz, n f_s less the right side
    """

    harmonic: float
    frequency: float
    diameters: int
    sign: int
    detuning: float

    @property
    def label(self) -> str:
        """Label in figures, such as "2 f_s = 135.42 Hz" or "4 f_s = 290.28 Hz - 2 Ω/2π"."""
        shift = f" {'-' if self.sign < 0 else '+'} {self.diameters} Ω/2π" if self.sign else ""
        return f"{self.harmonic:g} f_s = {self.frequency:.2f} Hz{shift}"


def nearest_resonance(p: Parameters, period: float, multiplier: complex, diameters: int | None = None) -> Resonance:
    """The resonance to which a cycle's multiplier belongs, among modes of so many nodal diameters, or among all.

    In the slider's frame a free mode of l diameters has the frequency f -/+ l Omega / 2 pi; one bound to the slider, f.
    Modulo f_s that is the multiplier's angle over 2 pi T. The harmonic is the nearest multiple of f_s, or of f_s / 2.
    """
    rate = 1 / float(period)
    angle = math.atan2(multiplier.imag, multiplier.real) / (2 * math.pi)
    half = 0.5 if multiplier.imag == 0 and multiplier.real < 0 else 0.0
    resonances: list[tuple[float, Resonance]] = []
    for frequency, l, bound in modes_at_rest(p):
        if diameters is not None and l != diameters:
            continue
        standing = (0,) if bound else ()
        for sign in (*standing, -1, 1) if l else (0,):
            seen = (frequency + sign * l * p.Omega / (2 * math.pi)) / rate
            miss = min(abs((seen - s * angle + 0.5) % 1 - 0.5) for s in (-1, 1))
            harmonic = round(seen - half) + half
            resonances.append((miss, Resonance(harmonic, frequency, l, sign, float((harmonic - seen) * rate))))
    if not resonances:
        raise ParameterError(f"diameters={diameters!r}: must be those of a mode")
    return min(resonances, key=lambda pair: pair[0])[1]


def modes_at_rest(p: Parameters) -> list[tuple[float, int, bool]]:
    """Frequency (Hz), diameters and whether the slider takes part, for every mode of disc and slider at rest. A coupled
    mode has the diameters of the disc's mode with most of its energy; a compliant contact adds one mode."""
    modes = mode_arrays(p)
    frequencies, shapes = coupled_shapes(p, contact_compliance(p))
    coupled = [
        (float(frequency) / (2 * math.pi), int(modes.diameters[np.argmax(np.abs(shape[: len(modes.omega)]))]), True)
        for frequency, shape in zip(frequencies, shapes.T, strict=True)
    ]
    pairs = zip(modes.omega[modes.diameters > 0], modes.diameters[modes.diameters > 0], strict=True)
    return sorted(coupled + [(float(omega) / (2 * math.pi), int(l), False) for omega, l in pairs])
