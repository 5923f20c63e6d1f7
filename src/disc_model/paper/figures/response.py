"""A variable over a run, closer, and its spectrum in time, as in figures 26 to 29 of the paper."""

from collections.abc import Iterator
from typing import Annotated, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from disc_model.data import dataset
from disc_model.data.dataset import Missing
from disc_model.disc.plate import plate_modes
from disc_model.figures import drawing
from disc_model.figures.drawing import BLACK, PAGE, SKY, Axes, Figure, new_figure
from disc_model.figures.kind import HIGHEST, CasePlot, Need, Sampled, as_ranges, as_samples, as_spectrum
from disc_model.figures.spectrogram import draw_spectrum, span_of, spectrum_of
from disc_model.parameters import Parameters
from disc_model.simulation.case import Window
from disc_model.units import Finite, Positive, Unit

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
            draw_spectrum(right, shown, case, spectrum, HIGHEST)
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
