"""The paper's figures of single runs: contact and its losses, the whole disc, and spectra in
time."""

import json
from collections.abc import Iterator, Sequence
from typing import Annotated, Any, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from disc_model.data import dataset
from disc_model.data.dataset import Missing
from disc_model.data.variables import flag_names
from disc_model.disc.plate import mode_arrays, plate_modes
from disc_model.figures import drawing
from disc_model.figures import motion as pictures
from disc_model.figures.drawing import (
    BLACK,
    COLUMN,
    GREY,
    PAGE,
    SEPARATED,
    SKY,
    SLIDER,
    Axes,
    Figure,
    mpl,
    panels,
)
from disc_model.figures.kind import (
    HIGHEST,
    CasePlot,
    InTime,
    Need,
    Ranges,
    Sampled,
    Samples,
    as_samples,
    as_spectrum,
)
from disc_model.figures.legends import legend_above
from disc_model.figures.motion import Motion, draw_power, draw_scale, span_of, spectrum_of
from disc_model.parameters import Parameters
from disc_model.simulation.case import Window
from disc_model.units import Finite, Positive, Unit

# ---- Contact and its losses, as in figures 2, 3, 10, 13 and 23


def after(window: xr.Dataset, start: float) -> xr.Dataset:
    """A window with times in ms after one in s."""
    return window.assign_coords(time=(window["time"] - start) * 1e3)


def separations(window: xr.Dataset) -> list[tuple[float, float]]:
    """Separations in a window of samples, in its times, including those that the window cuts
    off."""
    time = window["time"].values.tolist()
    return [
        (time[a], time[b - 1])
        for a, b in drawing.stretches(flag_names(window["phase"]) == "separation")
    ]


def first_complete(window: xr.Dataset) -> tuple[float, float] | None:
    """The first separation that begins and ends inside the window."""
    time = window["time"].values
    return next(((a, b) for a, b in separations(window) if a > time[0] and b < time[-1]), None)


def shade(ax: Axes, spans: Sequence[tuple[float, float]]) -> None:
    for i, span in enumerate(spans):
        ax.axvspan(*span, color=SEPARATED, alpha=0.25, label="_nolegend_" if i else "separation")


def displacements(ax: Axes, part: xr.Dataset, rest: float) -> None:
    """Draw displacements of disc and slider relative to `rest`, m."""
    ax.plot(part["time"], (part["w"] - rest) * 1e3, color=drawing.DISC, label="disc")
    ax.plot(
        part["time"],
        (part["u"] - rest) * 1e3,
        color=SLIDER,
        linestyle=(0, (4, 1.5)),
        label="slider",
    )
    ax.set_ylabel("Displacement (mm)")


class ContactForce(CasePlot):
    """(a) Range of the contact force over the run, (b) the contact force in a window of samples."""

    kind: Literal["paper.contact_force"] = "paper.contact_force"
    history: Ranges = "history"
    zoom: Samples = "zoom"

    def draw(self, case: xr.DataTree) -> Figure:
        figure, axes = panels(PAGE, 2.3, 1, 2)
        drawing.show(axes[0], case, drawing.history(case, self.history), "P")
        window = dataset.samples(case, self.zoom)
        start = float(window["time"][0])
        window = after(window, start)
        shade(axes[1], spans := separations(window))
        axes[1].plot(window["time"], window["P"], color=drawing.FORCE)
        axes[1].set(xlabel=f"Time after {start:.5f} s (ms)", ylabel=drawing.axis_of("P")[0])
        if spans:
            legend_above(axes[1])
        drawing.letters(axes)
        for (
            ax
        ) in axes:  # with zero if contact is lost; a force that hardly changes is shown in detail
            if np.isfinite(float(case["first_separation"])):
                ax.set_ylim(bottom=-0.03 * ax.get_ylim()[1])
        return figure


class OneSeparation(CasePlot):
    """(a) Displacements from static equilibrium around the first complete separation of a window,
    (b) the gap."""

    kind: Literal["paper.one_separation"] = "paper.one_separation"
    zoom: Samples = "zoom"

    def draw(self, case: xr.DataTree) -> Figure:
        figure, axes = panels(COLUMN, 3.2, 2, sharex=True, height_ratios=(2, 1))
        both, gap = axes
        window = dataset.samples(case, self.zoom)
        if (complete := first_complete(window)) is None:
            raise Missing(f"has no complete separation in {self.zoom}")
        start, stop = complete
        margin = 0.5 * (stop - start)
        part = after(window.sel(time=slice(start - margin, stop + margin)), start)
        for ax in axes:
            shade(ax, [(0.0, (stop - start) * 1e3)])
        displacements(both, part, float(case["u_0"]))
        drawing.show_thickness(both, case, "y")
        gap.plot(part["time"], (part["u"] - part["w"]) * 1e6, color=BLACK)
        gap.set(xlabel=f"Time after {start:.5f} s (ms)", ylabel="Gap (μm)")
        drawing.letters(axes)
        legend_above(both)
        figure.align_ylabels()
        return figure


class LightSlider(CasePlot):
    """Displacements from static equilibrium in a part of a window, with the losses of contact."""

    kind: Literal["paper.light_slider"] = "paper.light_slider"
    zoom: Samples = "zoom"

    def draw(self, case: xr.DataTree) -> Figure:
        figure, [ax] = panels(COLUMN, 2.5)
        window, rest = dataset.samples(case, self.zoom), float(case["u_0"])
        complete, length = first_complete(window), 0.025  # of the stretch shown, s
        start = complete[0] - 0.1 * length if complete else float(window["time"][0])
        part = after(window.sel(time=slice(start, start + length)), start)
        spans = separations(part)
        shade(ax, spans)
        displacements(ax, part, rest)
        losses = part.sel(time=[first for first, _ in spans if first > 0], method="nearest")
        if losses["time"].size:
            height = (losses["w"] - rest) * 1e3
            ax.plot(
                losses["time"], height, "o", color=SEPARATED, markersize=3.5, label="contact lost"
            )
        drawing.show_thickness(ax, case, "y")
        ax.set_xlabel(f"Time after {start:.4f} s (ms)")
        legend_above(ax)
        return figure


class WithAndWithout(CasePlot):
    """Range of the disc at r_0 and a fixed angle over the run, with separation and, in the case
    `ignored`, without."""

    further = ("ignored",)
    kind: Literal["paper.with_and_without"] = "paper.with_and_without"
    ignored: str
    history: Ranges = "history"

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
    """Ranges of the contact force and of the disc at r_0 and a fixed angle, a column for each case,
    on common axes. A range of the force below a twentieth of the axis is drawn once more."""

    further = ("beside",)
    kind: Literal["paper.histories"] = "paper.histories"
    beside: tuple[str, ...] = ()
    history: Ranges = "history"
    until: Annotated[Positive, Unit("s")] | None = None  # end of the part of the runs that is shown
    printed: Annotated[Positive, Unit("s")] | None = (
        None  # first separation of the last case that the paper prints
    )

    def draw(self, *cases: xr.DataTree) -> Figure:
        figure, axes = panels(PAGE, 3.2, 2, len(cases), sharex=True, sharey="row")
        forces, discs = axes[: len(cases)], axes[len(cases) :]
        windows = [drawing.history(case, self.history, self.until) for case in cases]
        for force, disc, case, window in zip(forces, discs, cases, windows, strict=True):
            p = json.loads(case.attrs["parameters"])
            for ax, name in ((force, "P"), (disc, "w_point")):
                drawing.show(ax, case, window, name, named=name == "P")
                ax.label_outer()
            force.set_title(f"{p['N']:g} N, {p['Omega']:g} rad/s", loc="right")
        for force, disc, case, window in zip(
            forces, discs, cases, windows, strict=True
        ):  # now axes are known
            low, high = float(window["P_min"].min()), float(window["P_max"].max())
            if high - low < 0.05 * np.ptp(force.get_ylim()):
                inset = force.inset_axes((0.3, 0.74, 0.66, 0.26))
                drawing.envelope(inset, window, "P")
                inset.set_ylim(low - 1, high + 1)
                inset.tick_params(labelsize=6)
                inset.xaxis.set_major_formatter("{x:g} s")
                inset.yaxis.set_major_formatter("{x:g} N")
            drawing.show_thickness(disc, case, "y")
        if self.printed is not None:
            drawing.mark_printed(forces[-1], self.printed)
        drawing.letters(axes)
        figure.align_ylabels()
        return figure


# ---- The whole disc
class Instants(CasePlot):
    """The disc from above, and along its circle of radius r_0, at four instants from the first loss
    of contact to the next, or over the whole stretch without two losses, by nine windows `around0`,
    ..."""

    kind: Literal["paper.instants"] = "paper.instants"

    def needs(self) -> Iterator[Need]:
        for i in range(9):
            yield Need("case", self.case, f"around{i}", as_samples)

    def draw(self, case: xr.DataTree) -> Figure:
        figure = drawing.new_figure(PAGE, 4.2)
        above, around = np.asarray(figure.subfigures(2, 1, height_ratios=(1.15, 1)))
        discs = above.subplots(1, 4)
        circle = around.subplots()
        motion = motion_of(case)
        losses = [
            first for first, _ in drawing.stretches(motion.phase == "separation") if first > 0
        ]
        first, last = losses[:2] if len(losses) > 1 else (0, motion.time.size - 1)
        scale = pictures.scale_of(motion)
        levels = [
            share * (scale.vmax or 0.0)
            for share in (-0.75, -0.5, -0.25, -0.1, 0.0, 0.1, 0.25, 0.5, 0.75)
        ]
        for j, (ax, style) in enumerate(zip(discs, ("-", "--", "-.", ":"), strict=True)):
            i = first + j * (last - first) // len(discs)
            mesh = pictures.draw_disc(ax, motion, i, scale, levels)
            after = f"{1e3 * (motion.time[i] - motion.time[first]):.1f} ms"
            ax.set_title(f"({'abcd'[j]}) {after}, {motion.phase[i]}")
            pictures.draw_circle(circle, motion, i, 5, linestyle=style, label=f"disc, {after}")
        bar = above.colorbar(
            mesh, ax=list(discs), pad=0.01, aspect=20, fraction=0.04, label="Deflection (mm)"
        )
        bar.outline.set_visible(False)
        circle.plot([], [], "s", ms=5, mfc=SLIDER, mec=BLACK, mew=0.6, label="slider")
        circle.plot([], [], "s", ms=5, mfc=SEPARATED, mec=BLACK, mew=0.6, label="slider, separated")
        circle.margins(y=0.08)
        drawing.show_thickness(circle, case, "y")
        circle.legend(loc="lower left", bbox_to_anchor=(0, 1), borderaxespad=0.2, ncols=6)
        circle.set_title("(e)", loc="left", x=-0.06)
        return figure


def motion_of(case: xr.DataTree) -> Motion:
    """The motion of disc and slider from windows `around0`, ... of the disc at r_0 and as many
    angles as determine the harmonics that modes without nodal circles are; raises `Missing` if they
    do not."""
    p = Parameters.model_validate_json(case.attrs["parameters"])
    harmonics = np.arange(p.n_diameters + 1)
    windows = [
        dataset.samples(case, f"around{j}", at_least=1) for j in range(2 * len(harmonics) - 1)
    ]
    if p.n_circles:
        raise Missing("has modes with nodal circles, which a circle of points does not tell apart")
    if any(
        not np.array_equal(window["time"].values, windows[0]["time"].values) for window in windows
    ):
        raise Missing("recorded the disc at other times at other angles")
    angles = np.array([window.attrs["theta"] for window in windows])
    turns = harmonics * angles[:, None]
    values = np.array([window["w_point"].values for window in windows])
    solution = np.linalg.lstsq(
        np.hstack([np.cos(turns), np.sin(turns)[:, 1:]]), values, rcond=None
    )[0]
    at_slider = solution[: len(harmonics)].astype(complex)
    at_slider[1:] += 1j * solution[len(harmonics) :]
    amplitudes = at_slider / mode_arrays(p).psi[:, None]
    time, psi, u = (windows[0][name].values for name in ("time", "psi", "u"))
    return Motion(p, time, amplitudes, p.Omega * time - psi, u, flag_names(windows[0]["phase"]))


# ---- A vibration over a run and its spectra in time, as in figures 24 to 29
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
    """Range of the disc at r_0 and a fixed angle, and its power over time and frequency in four
    stretches, with the lines of Table 2. The last row is the bilateral case `ignored`, which has
    the same windows but the first."""

    further = ("ignored",)
    kind: Literal["paper.four_stretches"] = "paper.four_stretches"
    history: Ranges = "history"
    until: Annotated[Positive, Unit("s")] | None = None  # end of the part of the run that is shown
    ignored: str

    def needs(self) -> Iterator[Need]:
        yield from (need for need in super().needs() if need.case == self.case)
        for key, case, windows in (
            ("case", self.case, WINDOWS),
            ("ignored", self.ignored, WINDOWS[1:]),
        ):
            yield from (Need(key, case, name, as_spectrum) for name in windows)

    def draw(self, *cases: xr.DataTree) -> Figure:
        figure = drawing.new_figure(PAGE, 6.2)
        top, below = np.asarray(figure.subfigures(2, 1, height_ratios=(1.1, 3)))
        whole = top.subplots()
        axes = below.subplots(
            3, len(WINDOWS), sharex="col", sharey="row", squeeze=False, height_ratios=(1, 1.6, 1.6)
        )
        spectra = {
            (i, name): spectrum_of(case, name, "w_point")
            for i, case in enumerate(cases)
            for name in WINDOWS[i:]  # before any separation both are alike
        }
        reference = max(float(spectrum.power.max()) for spectrum in spectra.values())
        for row, (i, low, high) in zip(
            axes, [(0, CLOSE, HIGHEST), (0, 0.0, CLOSE), (1, 0.0, CLOSE)], strict=True
        ):
            for ax, name in zip(row[i:], WINDOWS[i:], strict=True):
                mesh = draw_power(ax, cases[i], spectra[i, name], reference, high)
                ax.set_ylim(low, high)
            row[0].set_ylabel("Frequency (Hz)")
        for ax in axes[-1]:
            ax.set_xlabel("Time (s)")
            ax.xaxis.set_major_locator(mpl.ticker.MaxNLocator(3))
        look: dict[str, Any] = {
            "xycoords": "axes fraction",
            "ha": "right",
            "va": "center",
            "color": "white",
        }
        for row, text in zip(axes[1:], ("with separation", "separation ignored"), strict=True):
            row[-1].annotate(text, (0.97, 0.58), fontsize=6, **look)
        axes[2, 0].set_facecolor("white")
        axes[2, 0].annotate(
            "as above:\nno separation yet", (0.9, 0.55), fontsize=7, **look | {"color": BLACK}
        )
        names = axes[1, -1].secondary_yaxis("right")  # of the lines of Table 2
        names.set_yticks([float(np.mean(pair)) for pair in TABLE_2.values()], labels=list(TABLE_2))
        names.set_yticks([line for pair in TABLE_2.values() for line in pair], minor=True)
        names.tick_params(length=0, pad=7)  # names keep clear of the ticks of single lines
        names.tick_params(which="minor", length=3, width=0.6)
        names.spines["right"].set_visible(False)
        draw_scale(below, mesh, list(axes.flat))
        for name, text in zip(WINDOWS, "bcde", strict=True):
            start, stop = span_of(spectra[0, name])
            whole.axvspan(start, stop, color=SKY, alpha=0.3, linewidth=0)
            whole.text(
                start + 0.4,
                0.97,
                f"({text})",
                ha="left",
                va="top",
                transform=whole.get_xaxis_transform(),
            )
        drawing.show(
            whole, cases[0], drawing.history(cases[0], self.history, self.until), "w_point"
        )
        drawing.headroom(whole, 0.15)
        whole.set_ylabel(whole.get_ylabel().replace(", ", ",\n", 1))
        drawing.show_thickness(whole, cases[0], "y")
        drawing.letters([whole, *axes[0], *axes[2, 1:]])
        return figure


ZOOM = 0.2  # length of a closer look, s


class Response(CasePlot):
    """(a) Range over the run, with closer looks below it if there are any, (b) spectrum in time in
    a window."""

    further = ("ignored",)
    kind: Literal["paper.response"] = "paper.response"
    variable: Sampled
    window: InTime
    history: Ranges = "history"
    zooms: Annotated[
        tuple[tuple[str, Finite], ...], Field(max_length=2)
    ] = ()  # windows, and where looks begin, s
    highest: bool = False  # whether the disc's highest natural frequency is marked
    until: Annotated[Positive, Unit("s")] | None = None  # end of the part of the run that (a) shows
    ignored: str = ""  # the case with bilateral contact, whose spectrum is drawn below
    printed: Annotated[Positive, Unit("s")] | None = (
        None  # time of the first separation that the paper prints
    )

    def needs(self) -> Iterator[Need]:
        yield from (
            need for need in super().needs() if need.case == self.case or need.key == "window"
        )
        for name, start in self.zooms:

            def contains(window: Window, start: float = start) -> str:
                inside = window.start <= start <= start + ZOOM <= window.stop
                return (
                    as_samples(window)
                    if inside
                    else f"must contain {start:g} to {start + ZOOM:g} s"
                )

            yield Need("zooms", self.case, name, contains)

    def draw(self, *cases: xr.DataTree) -> Figure:
        case, count = cases[0], len(cases)
        figure = drawing.new_figure(PAGE, 2.7 + 1.3 * (count - 1))
        left, right = np.asarray(figure.subfigures(1, 2, width_ratios=(1, 1.08)))
        letters = "cd"[: len(self.zooms)]
        axes = left.subplot_mosaic(";".join(filter(None, ["a" * max(len(self.zooms), 1), letters])))
        shown = np.atleast_1d(right.subplots(count, 1, sharex=True))
        spectra = [spectrum_of(each, self.window, self.variable) for each in cases]
        titles = (
            [("b", "with separation"), ("e", "separation ignored")] if count > 1 else [("b", "")]
        )
        for ax, each, spectrum, title in zip(shown, cases, spectra, titles, strict=True):
            mesh = draw_power(ax, each, spectrum, float(spectra[0].power.max()), HIGHEST)
            drawing.letter(ax, *title)
            ax.set(xlabel="Time (s)", ylabel="Frequency (Hz)")
            ax.label_outer()
        draw_scale(right, mesh, list(shown))
        if self.highest:
            p = Parameters.model_validate_json(case.attrs["parameters"])
            natural = float(np.max(plate_modes(p)["omega"])) / (2 * np.pi)
            shown[0].axhline(natural, color="white", linewidth=0.9, linestyle=(0, (1, 2)))
        whole, (start, stop) = axes["a"], span_of(spectra[0])
        drawing.show(whole, case, drawing.history(case, self.history, self.until), self.variable)
        if self.printed is not None:
            drawing.mark_printed(whole, self.printed)
        if self.variable == "w_point":
            drawing.show_thickness(whole, case, "y")
        whole.axvspan(start, stop, color=SKY, alpha=0.3, linewidth=0, zorder=0)
        if stop - start < 0.02 * whole.get_xlim()[1]:  # a line where it is too narrow to be seen
            middle = (start + stop) / 2
            whole.axvline(middle, color=BLACK, linewidth=0.8, zorder=0)
            drawing.say(whole, "(b)", (middle, 1), (0, 2), xycoords=("data", "axes fraction"))
        drawing.letter(whole, "a")
        for letter, (name, start) in zip(letters, self.zooms, strict=True):
            ax = axes[letter]
            if letter == "d":
                ax.sharey(axes["c"])
                ax.tick_params(labelleft=False)
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
