"""Contact and its losses, as in figures 2, 3, 10 and 23 of the paper."""

import json
from collections.abc import Sequence
from typing import Annotated, Literal

import numpy as np
import xarray as xr

from disc_model.data import dataset
from disc_model.data.dataset import Missing
from disc_model.data.variables import flag_names
from disc_model.figures import drawing
from disc_model.figures.drawing import BLACK, COLUMN, DISC, FORCE, GREY, PAGE, SEPARATED, SLIDER, Axes, Figure, panels
from disc_model.figures.kind import CasePlot, as_ranges, as_samples
from disc_model.units import Positive, Unit


def after(window: xr.Dataset, start: float) -> xr.Dataset:
    """A window with times in ms after one in s."""
    return window.assign_coords(time=(window["time"] - start) * 1e3)


def separations(window: xr.Dataset) -> list[tuple[float, float]]:
    """Separations in a window of samples, in its times, including those that the window cuts off."""
    time = window["time"].values.tolist()
    return [(time[a], time[b - 1]) for a, b in drawing.stretches(flag_names(window["phase"]) == "separation")]


def complete_separations(window: xr.Dataset) -> list[tuple[float, float]]:
    """Separations that begin and end inside the window."""
    time = window["time"].values
    return [(a, b) for a, b in separations(window) if a > time[0] and b < time[-1]]


def shade(ax: Axes, spans: Sequence[tuple[float, float]]) -> None:
    """Shade separations, with one entry in the legend."""
    for i, span in enumerate(spans):
        ax.axvspan(*span, color=SEPARATED, alpha=0.25, label="_nolegend_" if i else "separation")


def displacements(ax: Axes, part: xr.Dataset, rest: float) -> None:
    """Draw displacements of disc and slider relative to `rest` in m, and a legend."""
    ax.plot(part["time"], (part["w"] - rest) * 1e3, color=DISC, label="disc")
    ax.plot(part["time"], (part["u"] - rest) * 1e3, color=SLIDER, linestyle=(0, (4, 1.5)), label="slider")
    ax.set_ylabel("Displacement (mm)")


class ContactForce(CasePlot):
    """(a) Range of the contact force over the run, (b) the contact force in a window of samples."""

    shows = (("history", as_ranges), ("zoom", as_samples))

    kind: Literal["paper.contact_force"] = "paper.contact_force"
    history: str = "history"
    zoom: str = "zoom"

    def draw(self, *cases: xr.DataTree) -> Figure:
        [case] = cases
        figure, [whole, zoom] = panels(PAGE, 2.3, 1, 2)
        with drawing.blank_if_missing(whole):
            drawing.show(whole, case, drawing.history(case, self.history), "P")
            _show_zero(whole, case)
            drawing.letter(whole, "a")
        with drawing.blank_if_missing(zoom):
            window = dataset.samples(case, self.zoom)
            start = float(window["time"][0])
            window = after(window, start)
            drawing.letter(zoom, "b")
            shade(zoom, spans := separations(window))
            zoom.plot(window["time"], window["P"], color=FORCE)
            _show_zero(zoom, case)
            zoom.set(xlabel=f"Time after {start:.5f} s (ms)", ylabel=drawing.axis_of("P")[0])
            if spans:
                drawing.legend_above(zoom)
        return figure


def _show_zero(ax: Axes, case: xr.DataTree) -> None:
    """Include zero if contact is lost; a force that hardly changes is shown in detail."""
    if np.isfinite(float(case["first_separation"])):
        ax.set_ylim(bottom=-0.03 * ax.get_ylim()[1])


class OneSeparation(CasePlot):
    """(a) Displacements from static equilibrium around the first complete separation of a window, (b) the gap.

    The paper shows (a); the gap is a hundredth of the motion and needs an axis of its own.
    """

    shows = (("zoom", as_samples),)

    kind: Literal["paper.one_separation"] = "paper.one_separation"
    zoom: str = "zoom"

    def draw(self, *cases: xr.DataTree) -> Figure:
        [case] = cases
        figure, axes = panels(COLUMN, 3.2, 2, sharex=True, height_ratios=(2, 1))
        both, gap = axes
        window = dataset.samples(case, self.zoom)
        complete = complete_separations(window)
        if not complete:
            raise Missing(f"has no complete separation in {self.zoom}")
        start, stop = complete[0]
        margin = 0.5 * (stop - start)
        part = after(window.sel(time=slice(start - margin, stop + margin)), start)
        for ax in axes:
            shade(ax, [(0.0, (stop - start) * 1e3)])
        displacements(both, part, float(case["u_0"]))
        drawing.show_thickness(both, case, "y")
        gap.plot(part["time"], (part["u"] - part["w"]) * 1e6, color=BLACK)
        gap.set(xlabel=f"Time after {start:.5f} s (ms)", ylabel="Gap (μm)")
        drawing.letters(axes)
        drawing.legend_above(both)
        figure.align_ylabels()
        return figure


class LightSlider(CasePlot):
    """Displacements from static equilibrium in a part of a window, with the losses of contact."""

    shows = (("zoom", as_samples),)

    kind: Literal["paper.light_slider"] = "paper.light_slider"
    zoom: str = "zoom"

    def draw(self, *cases: xr.DataTree) -> Figure:
        [case] = cases
        figure, [ax] = panels(COLUMN, 2.5)
        window, rest = dataset.samples(case, self.zoom), float(case["u_0"])
        complete = complete_separations(window)
        length = 0.025  # of the stretch shown, s
        start = complete[0][0] - 0.1 * length if complete else float(window["time"][0])
        part = after(window.sel(time=slice(start, start + length)), start)
        spans = separations(part)
        shade(ax, spans)
        displacements(ax, part, rest)
        losses = part.sel(time=[first for first, _ in spans if first > 0], method="nearest")
        if losses["time"].size:
            height = (losses["w"] - rest) * 1e3
            ax.plot(losses["time"], height, "o", color=SEPARATED, markersize=3.5, label="contact lost")
        drawing.show_thickness(ax, case, "y")
        ax.set_xlabel(f"Time after {start:.4f} s (ms)")
        drawing.legend_above(ax)
        return figure


class WithAndWithout(CasePlot):
    """Range of the disc at r_0 and a fixed angle over the run, with separation and bilateral.

    ignored : the case with bilateral contact
    """

    shows = (("history", as_ranges),)

    kind: Literal["paper.with_and_without"] = "paper.with_and_without"
    ignored: str
    history: str = "history"

    @property
    def others(self) -> tuple[str, ...]:
        return (self.ignored,)

    def draw(self, *cases: xr.DataTree) -> Figure:
        figure, [ax] = panels(COLUMN, 2.4)
        followed, ignored = (drawing.history(case, self.history) for case in cases)
        drawing.envelope(ax, ignored, "w_point", color=GREY, label="separation ignored")
        drawing.envelope(ax, followed, "w_point", label="with separation")
        ax.set(xlabel="Time (s)", ylabel=drawing.sampled("w_point", ignored, followed)[0])
        drawing.headroom(ax, 0.25)
        drawing.show_thickness(ax, cases[0], "y")
        ax.legend(loc="upper left")
        return figure


class Histories(CasePlot):
    """Ranges of the contact force and of the disc at r_0 and a fixed angle, a column for each case, on common axes.

    A range that hardly shows on the common axis is drawn once more, on an axis of its own.

    beside : further cases
    until : s, end of the part of the runs that is shown
    printed : s, time of the first separation of the last case that the paper prints
    """

    shows = (("history", as_ranges),)

    kind: Literal["paper.histories"] = "paper.histories"
    beside: tuple[str, ...] = ()
    history: str = "history"
    until: Annotated[Positive, Unit("s")] | None = None
    printed: Annotated[Positive, Unit("s")] | None = None

    @property
    def others(self) -> tuple[str, ...]:
        return self.beside

    def draw(self, *cases: xr.DataTree) -> Figure:
        variables = ("P", "w_point")
        figure, axes = panels(PAGE, 3.2, 2, len(cases), sharex=True, sharey="row")
        for k, case in enumerate(cases):
            window = drawing.history(case, self.history, self.until)
            p = json.loads(case.attrs["parameters"])
            for ax, name in zip(axes[k :: len(cases)], variables, strict=True):
                drawing.show(ax, case, window, name, named=name == "P")
                ax.label_outer()
            axes[k].set_title(f"{p['N']:g} N, {p['Omega']:g} rad/s", loc="right")
        for k, case in enumerate(cases):  # when the common axes are known
            self._closer(axes[k], drawing.history(case, self.history, self.until))
            drawing.show_thickness(axes[k + len(cases)], case, "y")
        if self.printed is not None:
            drawing.mark_printed(axes[len(cases) - 1], self.printed)
        drawing.letters(axes)
        figure.align_ylabels()
        return figure

    def _closer(self, ax: Axes, window: xr.Dataset) -> None:
        """Draw a range of the contact force that is less than a twentieth of the axis once more."""
        low, high = float(window["P_min"].min()), float(window["P_max"].max())
        if high - low < 0.05 * np.ptp(ax.get_ylim()):
            inset = ax.inset_axes((0.3, 0.62, 0.66, 0.3))
            drawing.envelope(inset, window, "P")
            inset.set_ylim(low - 1, high + 1)
            inset.tick_params(labelsize=6, labelbottom=False)
