"""Stretches of a vibration, and their spectra in time, as in figures 24 and 25 of the paper."""

from typing import Annotated, Literal

import xarray as xr
from pydantic import Field

from disc_model.figures import drawing
from disc_model.figures.drawing import PAGE, SKY, Figure, panels
from disc_model.figures.kind import CasePlot, as_ranges, as_spectrum
from disc_model.figures.spectrogram import span_of, spectrum_of
from disc_model.units import Positive, Unit

WINDOWS = ("spectrum_a", "spectrum_b", "spectrum_c", "spectrum_d")


class Stretches(CasePlot):
    """Range of the disc's displacement at r_0 and a fixed angle, with the stretches of `paper.four_stretches`.

    until : s, end of the part of the run that is shown
    """

    shows = (("history", as_ranges), ("spectra", as_spectrum))

    kind: Literal["paper.stretches"] = "paper.stretches"
    history: str = "history"
    spectra: Annotated[tuple[str, ...], Field(min_length=1)] = WINDOWS
    until: Annotated[Positive, Unit("s")] | None = None

    def draw(self, *cases: xr.DataTree) -> Figure:
        [case] = cases
        figure, [ax] = panels(PAGE, 2.2)
        for name, letter in zip(self.spectra, "abcdef", strict=False):
            start, stop = span_of(spectrum_of(case, name, "w_point", hop=0.5))
            ax.axvspan(start, stop, color=SKY, alpha=0.3, linewidth=0)
            ax.text(start + 0.4, 0.97, f"({letter})", transform=ax.get_xaxis_transform(), ha="left", va="top")
        drawing.show(ax, case, drawing.history(case, self.history, self.until), "w_point")
        drawing.headroom(ax, 0.15)
        return figure
