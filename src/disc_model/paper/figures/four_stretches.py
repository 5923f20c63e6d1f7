"""Spectra in time of several stretches of a vibration, as in figure 25 of the paper."""

from typing import Annotated, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from disc_model.analysis.spectra import TimeFrequency
from disc_model.figures import drawing
from disc_model.figures.drawing import PAGE, Axes, Figure, new_figure
from disc_model.figures.kind import HIGHEST, CasePlot, as_spectrum
from disc_model.figures.spectrogram import draw_power, draw_scale, spectrum_of
from disc_model.paper.figures.stretches import WINDOWS

CLOSE = 300.0
"""Highest frequency of the closer view, Hz."""
TABLE_2 = {
    r"$f_\Omega$": (2.4,),
    "$f_{h1}$, $f_{h2}$:\n$f_s ∓ f_\\Omega$": (65.5, 70.0),
    "$f_1$, $f_2$:\n$2f_s ∓ f_\\Omega$": (133.0, 138.0),
    "$f_3$, $f_4$:\n$3f_s ∓ f_\\Omega$": (200.0, 206.0),
    "$f_5$, $f_6$:\n$4f_s ∓ f_\\Omega$": (269.0, 273.0),
}
"""Lines of the paper, Hz, by their components; pairs are too close for separate names."""


class FourStretches(CasePlot):
    """Power of the disc's displacement at r_0 and a fixed angle over time and frequency, in several stretches.

    The lower row is the same up to `CLOSE` Hz, with the lines of Table 2 named.
    """

    shows = (("spectra", as_spectrum),)

    kind: Literal["paper.four_stretches"] = "paper.four_stretches"
    spectra: Annotated[tuple[str, ...], Field(min_length=1)] = WINDOWS

    def draw(self, *cases: xr.DataTree) -> Figure:
        from matplotlib.ticker import MaxNLocator

        [case] = cases
        figure = new_figure(PAGE, 4.6)
        axes = figure.subplots(2, len(self.spectra), sharex="col", sharey="row", squeeze=False)
        spectra: dict[str, TimeFrequency] = {}
        for name, column in zip(self.spectra, axes.T, strict=True):
            with drawing.blank_if_missing(*column):
                spectra[name] = spectrum_of(case, name, "w_point")
        reference = max((float(spectrum.power.max()) for spectrum in spectra.values()), default=1.0)
        for name, spectrum in spectra.items():
            column = axes[:, self.spectra.index(name)]
            for ax, highest in zip(column, (HIGHEST, CLOSE), strict=True):
                mesh = draw_power(ax, case, spectrum, reference, highest)
            drawing.letter(column[0], "abcdef"[self.spectra.index(name)])
            column[1].set_xlabel("Time (s)")
            column[1].xaxis.set_major_locator(MaxNLocator(3))
        for ax in axes[:, 0]:
            ax.set_ylabel("Frequency (Hz)")
        if spectra:
            _name_lines(axes[1, -1])
            draw_scale(figure, mesh, list(axes.flat))
        return figure


def _name_lines(ax: Axes) -> None:
    """Draw ticks at the frequencies of Table 2, with the paper's symbols."""
    right = ax.secondary_yaxis("right")
    right.set_yticks([float(np.mean(pair)) for pair in TABLE_2.values()], labels=list(TABLE_2))
    right.set_yticks([line for pair in TABLE_2.values() for line in pair], minor=True)
    right.tick_params(length=0, pad=7)  # names keep clear of the ticks of single lines
    right.tick_params(which="minor", length=3, width=0.6)
    right.spines["right"].set_visible(False)
