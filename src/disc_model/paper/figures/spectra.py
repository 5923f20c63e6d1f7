"""A vibration over a run and its spectra in time, as in figures 24 to 29 of the paper."""

from collections.abc import Iterator
from typing import Annotated, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from disc_model.analysis.spectra import TimeFrequency
from disc_model.data import dataset
from disc_model.data.dataset import Missing
from disc_model.disc.plate import plate_modes
from disc_model.figures import drawing
from disc_model.figures.drawing import BLACK, PAGE, SKY, Axes, Figure, new_figure, panels
from disc_model.figures.kind import HIGHEST, CasePlot, Need, Sampled, as_ranges, as_samples, as_spectrum
from disc_model.figures.motion import draw_power, draw_scale, draw_spectrogram, span_of, spectrum_of
from disc_model.parameters import Parameters
from disc_model.simulation.case import Window
from disc_model.units import Finite, Positive, Unit

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


ZOOM = 0.2
"""Length of a closer look, s."""


class Response(CasePlot):
    """(a) Range over the run, with closer looks below it if there are any, (b) spectrum in time in a window.

    zooms : windows, and times in s at which closer looks begin
    highest : whether the disc's highest natural frequency is marked
    until : s, end of the part of the run that (a) shows
    """

    shows = (("history", as_ranges), ("window", as_spectrum))

    kind: Literal["paper.response"] = "paper.response"
    variable: Sampled
    window: str
    history: str = "history"
    zooms: Annotated[tuple[tuple[str, Finite], ...], Field(max_length=2)] = ()
    highest: bool = False
    until: Annotated[Positive, Unit("s")] | None = None

    def needs(self) -> Iterator[Need]:
        yield from super().needs()
        for name, start in self.zooms:

            def contains(window: Window, start: float = start) -> Iterator[str]:
                if not window.start <= start <= start + ZOOM <= window.stop:
                    yield f"must contain {start:g} to {start + ZOOM:g} s"

            yield Need("zooms", self.case, name, [as_samples, contains])

    def draw(self, *cases: xr.DataTree) -> Figure:
        [case] = cases
        figure = new_figure(PAGE, 2.7)
        left, right = np.asarray(figure.subfigures(1, 2, width_ratios=(1, 1.08)))
        letters = "cd"[: len(self.zooms)]
        axes = left.subplot_mosaic(";".join(filter(None, ["a" * max(len(self.zooms), 1), letters])))
        shown = right.subplots()
        marked = None
        with drawing.blank_if_missing(shown):
            spectrum = spectrum_of(case, self.window, self.variable)
            marked = span_of(spectrum)
            draw_spectrogram(right, shown, case, spectrum, HIGHEST)
            drawing.letter(shown, "b")
            if self.highest:
                p = Parameters.model_validate_json(case.attrs["parameters"])
                natural = float(np.max(plate_modes(p)["omega"])) / (2 * np.pi)
                shown.axhline(natural, color="white", linewidth=0.9, linestyle=(0, (1, 2)))
        with drawing.blank_if_missing(axes["a"]):
            drawing.show(axes["a"], case, drawing.history(case, self.history, self.until), self.variable)
            if marked is not None:
                _mark(axes["a"], *marked)
            drawing.letter(axes["a"], "a")
        for letter, (name, start) in zip(letters, self.zooms, strict=True):
            ax = axes[letter]
            if letter != "c":
                ax.sharey(axes["c"])
                ax.tick_params(labelleft=False)
            with drawing.blank_if_missing(ax):
                label = _closer(ax, dataset.samples(case, name), self.variable, start)
                ax.set_ylabel(label if letter == "c" else "")
                drawing.letter(ax, letter)
        return figure


def _mark(ax: Axes, start: float, stop: float) -> None:
    """Shade the stretch of (b), with a line where it is too narrow to be seen."""
    ax.axvspan(start, stop, color=SKY, alpha=0.3, linewidth=0, zorder=0)
    if stop - start < 0.02 * ax.get_xlim()[1]:
        ax.axvline((start + stop) / 2, color=BLACK, linewidth=0.8, zorder=0)
        drawing.say_above(ax, (start + stop) / 2, "(b)")


def _closer(ax: Axes, window: xr.Dataset, variable: str, start: float) -> str:
    """Draw a closer look; returns the label of the variable's axis."""
    part = window.sel(time=slice(start, start + ZOOM))
    if part.sizes["time"] < 2:
        raise Missing(f"has no samples from {start:g} to {start + ZOOM:g} s")
    label, scale, colour = drawing.sampled(variable, window)
    ax.plot((part["time"].values - start) * 1e3, part[variable].values * scale, color=colour, linewidth=0.6)
    ax.set(xlabel=f"Time after {start:g} s (ms)", xlim=(0, ZOOM * 1e3))
    return label
