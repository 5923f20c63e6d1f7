"""Kinds that show named cases: histories, phase portraits, Poincaré sections and spectra."""

from collections.abc import Iterator, Mapping
from functools import partial
from typing import Annotated, Literal

from pydantic import Field

from disc_model.errors import Fault
from disc_model.figures.kinds.base import (
    HIGHEST,
    CasePlot,
    Need,
    Recorded,
    Sampled,
    Samples,
    as_either,
    as_spectrum,
)
from disc_model.simulation.case import Window
from disc_model.units import Positive, Unit

RANGES = ("P", "u", "w", "w_point", "psi", "psi_velocity")
"""Variables that a window with an envelope stores."""


class History(CasePlot):
    """Variables against time, one above the other; a window with an envelope as ranges.

    until : end of the part of the window that is shown
    """

    usual = "column"
    kind: Literal["history"] = "history"
    window: Annotated[str, as_either]
    variables: Annotated[tuple[Sampled, ...], Field(min_length=1)] = ("P", "w")
    until: Annotated[Positive, Unit("s")] | None = None

    def faults(self, cases: Mapping[str, Recorded | None]) -> Iterator[Fault]:
        yield from super().faults(cases)
        window = (cases.get(self.case) or {}).get(self.window)
        if not isinstance(window, Window) or window.envelope is None:
            return
        for i, name in enumerate(self.variables):
            if name not in RANGES:
                rule = f"is not kept as ranges (known: {', '.join(RANGES)})"
                yield Fault.of(("variables", str(i)), name, rule)


class Portrait(CasePlot):
    """One variable over another, coloured by phase."""

    usual = "column"
    kind: Literal["portrait"] = "portrait"
    window: Samples
    x: Sampled = "psi"
    y: Sampled = "psi_velocity"


class PoincareSections(CasePlot):
    """The Poincaré sections of slider and disc: psi' over psi, and velocity over displacement of
    the disc at r_0.

    below : further cases, each in a row of its own on the same axes
    """

    further = ("below",)
    kind: Literal["poincare"] = "poincare"
    below: tuple[str, ...] = ()

    def needs(self) -> Iterator[Need]:
        for case in self.cases:
            yield Need("case", case, "poincare")


class Spectrum(CasePlot):
    """Amplitude of a variable over the frequency, in the whole of a window.

    highest : highest frequency shown, Hz; without it up to where the lines end
    """

    usual = "column"
    kind: Literal["spectrum"] = "spectrum"
    window: Samples
    variable: Sampled = "w_point"
    highest: Annotated[Positive, Unit("Hz")] | None = None


class Spectrogram(CasePlot):
    """Power of a variable over time and frequency, in dB below its strongest line."""

    usual = "column"
    kind: Literal["spectrogram"] = "spectrogram"
    window: str
    variable: Sampled = "w_point"
    highest: Annotated[Positive, Unit("Hz")] = HIGHEST

    def needs(self) -> Iterator[Need]:
        yield Need("window", self.case, self.window, partial(as_spectrum, highest=self.highest))
