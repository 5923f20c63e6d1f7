"""A vibration over a run and its spectra in time, as in figures 24 to 29 of the paper."""

from collections.abc import Iterator
from itertools import product
from typing import Annotated, Any, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from disc_model.analysis.spectra import TimeFrequency
from disc_model.data import dataset
from disc_model.data.dataset import Missing
from disc_model.disc.plate import plate_modes
from disc_model.figures import drawing
from disc_model.figures.drawing import BLACK, PAGE, SKY, Figure, mpl, new_figure
from disc_model.figures.kind import HIGHEST, CasePlot, Need, Sampled, as_ranges, as_samples, as_spectrum
from disc_model.figures.motion import draw_power, draw_scale, span_of, spectrum_of
from disc_model.parameters import Parameters
from disc_model.simulation.case import Window
from disc_model.units import Finite, Positive, Unit

WINDOWS = ("spectrum_a", "spectrum_b", "spectrum_c", "spectrum_d")
CLOSE = 300.0  # highest frequency of the closer view, Hz
TABLE_2 = {  # lines of the paper, Hz, by their components; pairs are too close for separate names
    r"$f_\Omega$": (2.4,),
    "$f_{h1}$, $f_{h2}$:\n$f_s ∓ f_\\Omega$": (65.5, 70.0),
    "$f_1$, $f_2$:\n$2f_s ∓ f_\\Omega$": (133.0, 138.0),
    "$f_3$, $f_4$:\n$3f_s ∓ f_\\Omega$": (200.0, 206.0),
    "$f_5$, $f_6$:\n$4f_s ∓ f_\\Omega$": (269.0, 273.0),
}


class FourStretches(CasePlot):
    """Range of the disc at r_0 and a fixed angle, and its power over time and frequency in four stretches, with the
    lines of Table 2. The last row is the bilateral case `ignored`, which has the same windows but the first."""

    further = ("ignored",)
    kind: Literal["paper.four_stretches"] = "paper.four_stretches"
    history: str = "history"
    until: Annotated[Positive, Unit("s")] | None = None  # end of the part of the run that is shown
    ignored: str

    def needs(self) -> Iterator[Need]:
        yield Need("history", self.case, self.history, [as_ranges])
        for key, case, windows in (("case", self.case, WINDOWS), ("ignored", self.ignored, WINDOWS[1:])):
            yield from (Need(key, case, name, [as_spectrum]) for name in windows)

    def draw(self, *cases: xr.DataTree) -> Figure:
        figure = new_figure(PAGE, 6.2)
        top, below = np.asarray(figure.subfigures(2, 1, height_ratios=(1.1, 3)))
        whole = top.subplots()
        axes = below.subplots(3, len(WINDOWS), sharex="col", sharey="row", squeeze=False, height_ratios=(1, 1.6, 1.6))
        rows = [(0, CLOSE, HIGHEST), (0, 0.0, CLOSE), (1, 0.0, CLOSE)]  # case, and frequencies
        spectra: dict[tuple[int, str], TimeFrequency] = {}
        for i, (j, name) in product((0, 1), enumerate(WINDOWS)):
            if i and not j:  # before any separation
                continue
            with drawing.blank_if_missing(*(axes[2:, j] if i else axes[:2, j])):
                spectra[i, name] = spectrum_of(cases[i], name, "w_point")
        reference = max((float(spectrum.power.max()) for spectrum in spectra.values()), default=1.0)
        for row, (i, low, high) in zip(axes, rows, strict=True):
            for ax, name in zip(row, WINDOWS, strict=True):
                if (i, name) in spectra:
                    mesh = draw_power(ax, cases[i], spectra[i, name], reference, high)
                    ax.set_ylim(low, high)
            row[0].set_ylabel("Frequency (Hz)")
        for ax, text in zip((*axes[0], *axes[2, 1:]), "bcdefgh", strict=True):
            if ax.has_data():
                drawing.letter(ax, text)
        for ax in axes[-1]:
            ax.set_xlabel("Time (s)")
            ax.xaxis.set_major_locator(mpl.ticker.MaxNLocator(3))
        look: dict[str, Any] = {"xycoords": "axes fraction", "ha": "right", "va": "center", "color": "white"}
        for row, text in zip(axes[1:], ("with separation", "separation ignored"), strict=True):
            row[-1].annotate(text, (0.97, 0.58), fontsize=6, **look)
        axes[2, 0].set_facecolor("white")
        axes[2, 0].annotate("as above:\nno separation yet", (0.9, 0.55), fontsize=7, **look | {"color": BLACK})
        if spectra:
            names = axes[1, -1].secondary_yaxis("right")  # of the lines of Table 2
            names.set_yticks([float(np.mean(pair)) for pair in TABLE_2.values()], labels=list(TABLE_2))
            names.set_yticks([line for pair in TABLE_2.values() for line in pair], minor=True)
            names.tick_params(length=0, pad=7)  # names keep clear of the ticks of single lines
            names.tick_params(which="minor", length=3, width=0.6)
            names.spines["right"].set_visible(False)
            draw_scale(below, mesh, list(axes.flat))
        with drawing.blank_if_missing(whole):
            for (i, _), spectrum, text in zip(spectra, spectra.values(), "bcdef", strict=False):
                if not i:
                    start, stop = span_of(spectrum)
                    whole.axvspan(start, stop, color=SKY, alpha=0.3, linewidth=0)
                    at_top = {"transform": whole.get_xaxis_transform(), "va": "top"}
                    whole.text(start + 0.4, 0.97, f"({text})", ha="left", **at_top)
            drawing.show(whole, cases[0], drawing.history(cases[0], self.history, self.until), "w_point")
            drawing.headroom(whole, 0.15)
            whole.set_ylabel(whole.get_ylabel().replace(", ", ",\n", 1))
            drawing.show_thickness(whole, cases[0], "y")
            drawing.letter(whole, "a")
        return figure


ZOOM = 0.2  # length of a closer look, s


class Response(CasePlot):
    """(a) Range over the run, with closer looks below it if there are any, (b) spectrum in time in a window."""

    shows = (("history", as_ranges), ("window", as_spectrum))
    further = ("ignored",)
    kind: Literal["paper.response"] = "paper.response"
    variable: Sampled
    window: str
    history: str = "history"
    zooms: Annotated[tuple[tuple[str, Finite], ...], Field(max_length=2)] = ()  # windows, and where looks begin, s
    highest: bool = False  # whether the disc's highest natural frequency is marked
    until: Annotated[Positive, Unit("s")] | None = None  # end of the part of the run that (a) shows
    ignored: str = ""  # the case with bilateral contact, whose spectrum is drawn below
    printed: Annotated[Positive, Unit("s")] | None = None  # time of the first separation that the paper prints

    def needs(self) -> Iterator[Need]:
        yield from (need for need in super().needs() if need.case == self.case or need.key == "window")
        for name, start in self.zooms:

            def contains(window: Window, start: float = start) -> Iterator[str]:
                if not window.start <= start <= start + ZOOM <= window.stop:
                    yield f"must contain {start:g} to {start + ZOOM:g} s"

            yield Need("zooms", self.case, name, [as_samples, contains])

    def draw(self, case: xr.DataTree, *ignored: xr.DataTree) -> Figure:
        figure = new_figure(PAGE, 2.7 + 1.3 * len(ignored))
        left, right = np.asarray(figure.subfigures(1, 2, width_ratios=(1, 1.08)))
        letters = "cd"[: len(self.zooms)]
        axes = left.subplot_mosaic(";".join(filter(None, ["a" * max(len(self.zooms), 1), letters])))
        shown, *beneath = np.atleast_1d(right.subplots(1 + len(ignored), 1, sharex=True))
        marked = None
        with drawing.blank_if_missing(shown):
            spectrum = spectrum_of(case, self.window, self.variable)
            marked = span_of(spectrum)
            reference = float(spectrum.power.max())
            mesh = draw_power(shown, case, spectrum, reference, HIGHEST)
            drawing.letter(shown, "b", "with separation" if ignored else "")
            for ax, other in zip(beneath, ignored, strict=True):
                draw_power(ax, other, spectrum_of(other, self.window, self.variable), reference, HIGHEST)
                drawing.letter(ax, "e", "separation ignored")
            for ax in (shown, *beneath):
                ax.set(xlabel="Time (s)", ylabel="Frequency (Hz)")
                ax.label_outer()
            draw_scale(right, mesh, [shown, *beneath])
            if self.highest:
                p = Parameters.model_validate_json(case.attrs["parameters"])
                natural = float(np.max(plate_modes(p)["omega"])) / (2 * np.pi)
                shown.axhline(natural, color="white", linewidth=0.9, linestyle=(0, (1, 2)))
        with drawing.blank_if_missing(axes["a"]):
            drawing.show(axes["a"], case, drawing.history(case, self.history, self.until), self.variable)
            if self.printed is not None:
                drawing.mark_printed(axes["a"], self.printed)
            if self.variable == "w_point":
                drawing.show_thickness(axes["a"], case, "y")
            if marked is not None:  # a line where it is too narrow to be seen
                middle = (marked[0] + marked[1]) / 2
                axes["a"].axvspan(*marked, color=SKY, alpha=0.3, linewidth=0, zorder=0)
                if marked[1] - marked[0] < 0.02 * axes["a"].get_xlim()[1]:
                    axes["a"].axvline(middle, color=BLACK, linewidth=0.8, zorder=0)
                    drawing.say(axes["a"], "(b)", (middle, 1), (0, 2), xycoords=("data", "axes fraction"))
            drawing.letter(axes["a"], "a")
        for letter, (name, start) in zip(letters, self.zooms, strict=True):
            ax = axes[letter]
            if letter != "c":
                ax.sharey(axes["c"])
                ax.tick_params(labelleft=False)
            with drawing.blank_if_missing(ax):
                window = dataset.samples(case, name)
                part = window.sel(time=slice(start, start + ZOOM))
                if part.sizes["time"] < 2:
                    raise Missing(f"has no samples from {start:g} to {start + ZOOM:g} s")
                label, scale, colour = drawing.sampled(self.variable, window)
                milliseconds = (part["time"].values - start) * 1e3
                ax.plot(milliseconds, part[self.variable].values * scale, color=colour, linewidth=0.6)
                ax.set(xlabel=f"Time after {start:g} s (ms)", xlim=(0, ZOOM * 1e3))
                ax.set_ylabel(label if letter == "c" else "")
                drawing.letter(ax, letter)
        return figure
