"""Resonances of the stick-slip cycle, and how figures name them. Imports nothing heavy."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Tongue:
    """A resonance n f_s = f -/+ l Omega / 2 pi of a cycle.

    Attributes
    ----------
    harmonic : n; half-integer for a period doubling
    frequency : Hz, f, of a mode of disc and slider at rest
    diameters : l, the mode's
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
        """As figures show it, such as "2 f_s = 135.42 Hz" or "4 f_s = 290.28 Hz - 2 Ω/2π"."""
        shift = f" {'-' if self.sign < 0 else '+'} {self.diameters} Ω/2π" if self.sign else ""
        return f"{self.harmonic:g} f_s = {self.frequency:.2f} Hz{shift}"
