"""Contact and its losses, as in figures 2, 3, 10 and 23 of the paper, and the whole disc."""

import json
from collections.abc import Iterator, Sequence
from typing import Annotated, Literal

import numpy as np
import xarray as xr

from disc_model.data import dataset
from disc_model.data.dataset import Missing
from disc_model.data.variables import flag_names
from disc_model.disc.plate import mode_arrays
from disc_model.figures import drawing
from disc_model.figures.drawing import BLACK, COLUMN, DISC, FORCE, GREY, PAGE, SEPARATED, SLIDER, Axes, Figure, panels
from disc_model.figures.kind import CasePlot, Need, as_ranges, as_samples
from disc_model.figures.motion import Motion, draw_circle, draw_disc, scale_of
from disc_model.parameters import Parameters
from disc_model.units import Positive, Unit


def after(window: xr.Dataset, start: float) -> xr.Dataset:
    """A window with times in ms after one in s."""
    return window.assign_coords(time=(window["time"] - start) * 1e3)


def separations(window: xr.Dataset) -> list[tuple[float, float]]:
    """Separations in a window of samples, in its times, including those that the window cuts off."""
    time = window["time"].values.tolist()
    return [(time[a], time[b - 1]) for a, b in drawing.stretches(flag_names(window["phase"]) == "separation")]


def first_complete(window: xr.Dataset) -> tuple[float, float] | None:
    """The first separation that begins and ends inside the window."""
    time = window["time"].values
    return next(((a, b) for a, b in separations(window) if a > time[0] and b < time[-1]), None)


def shade(ax: Axes, spans: Sequence[tuple[float, float]]) -> None:
    for i, span in enumerate(spans):
        ax.axvspan(*span, color=SEPARATED, alpha=0.25, label="_nolegend_" if i else "separation")


def displacements(ax: Axes, part: xr.Dataset, rest: float) -> None:
    """Draw displacements of disc and slider relative to `rest`, m."""
    ax.plot(part["time"], (part["w"] - rest) * 1e3, color=DISC, label="disc")
    ax.plot(part["time"], (part["u"] - rest) * 1e3, color=SLIDER, linestyle=(0, (4, 1.5)), label="slider")
    ax.set_ylabel("Displacement (mm)")


class ContactForce(CasePlot):
    """(a) Range of the contact force over the run, (b) the contact force in a window of samples."""

    shows = (("history", as_ranges), ("zoom", as_samples))
    kind: Literal["paper.contact_force"] = "paper.contact_force"
    history: str = "history"
    zoom: str = "zoom"

    def draw(self, case: xr.DataTree) -> Figure:
        figure, [whole, zoom] = panels(PAGE, 2.3, 1, 2)
        with drawing.blank_if_missing(whole):
            drawing.show(whole, case, drawing.history(case, self.history), "P")
            drawing.letter(whole, "a")
        with drawing.blank_if_missing(zoom):
            window = dataset.samples(case, self.zoom)
            start = float(window["time"][0])
            window = after(window, start)
            drawing.letter(zoom, "b")
            shade(zoom, spans := separations(window))
            zoom.plot(window["time"], window["P"], color=FORCE)
            zoom.set(xlabel=f"Time after {start:.5f} s (ms)", ylabel=drawing.axis_of("P")[0])
            if spans:
                drawing.legend_above(zoom)
        for ax in (whole, zoom):  # with zero if contact is lost; a force that hardly changes is shown in detail
            if ax.has_data() and np.isfinite(float(case["first_separation"])):
                ax.set_ylim(bottom=-0.03 * ax.get_ylim()[1])
        return figure


class OneSeparation(CasePlot):
    """(a) Displacements from static equilibrium around the first complete separation of a window, (b) the gap."""

    shows = (("zoom", as_samples),)
    kind: Literal["paper.one_separation"] = "paper.one_separation"
    zoom: str = "zoom"

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
        drawing.legend_above(both)
        figure.align_ylabels()
        return figure


class LightSlider(CasePlot):
    """Displacements from static equilibrium in a part of a window, with the losses of contact."""

    shows = (("zoom", as_samples),)
    kind: Literal["paper.light_slider"] = "paper.light_slider"
    zoom: str = "zoom"

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
            ax.plot(losses["time"], height, "o", color=SEPARATED, markersize=3.5, label="contact lost")
        drawing.show_thickness(ax, case, "y")
        ax.set_xlabel(f"Time after {start:.4f} s (ms)")
        drawing.legend_above(ax)
        return figure


class WithAndWithout(CasePlot):
    """Range of the disc at r_0 and a fixed angle over the run, with separation and, in the case `ignored`, without."""

    shows = (("history", as_ranges),)
    further = ("ignored",)
    kind: Literal["paper.with_and_without"] = "paper.with_and_without"
    ignored: str
    history: str = "history"

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
    """Ranges of the contact force and of the disc at r_0 and a fixed angle, a column for each case, on common axes. A
    range of the force below a twentieth of the axis is drawn once more."""

    shows = (("history", as_ranges),)
    further = ("beside",)
    kind: Literal["paper.histories"] = "paper.histories"
    beside: tuple[str, ...] = ()
    history: str = "history"
    until: Annotated[Positive, Unit("s")] | None = None  # end of the part of the runs that is shown
    printed: Annotated[Positive, Unit("s")] | None = None  # first separation of the last case that the paper prints

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
        for force, disc, case, window in zip(forces, discs, cases, windows, strict=True):  # now axes are known
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
    """The disc from above, and along its circle of radius r_0, at four instants from the first loss of contact to the
    next, or over the whole stretch without two losses, by nine windows `around0`, ..."""

    kind: Literal["paper.instants"] = "paper.instants"

    def needs(self) -> Iterator[Need]:
        for i in range(9):
            yield Need("case", self.case, f"around{i}", [as_samples])

    def draw(self, case: xr.DataTree) -> Figure:
        figure = drawing.new_figure(PAGE, 4.2)
        above, around = np.asarray(figure.subfigures(2, 1, height_ratios=(1.15, 1)))
        discs = above.subplots(1, 4)
        circle = around.subplots()
        motion = motion_of(case)
        losses = [first for first, _ in drawing.stretches(motion.phase == "separation") if first > 0]
        first, last = losses[:2] if len(losses) > 1 else (0, motion.time.size - 1)
        scale = scale_of(motion)
        levels = [share * (scale.vmax or 0.0) for share in (-0.75, -0.5, -0.25, -0.1, 0.0, 0.1, 0.25, 0.5, 0.75)]
        for j, (ax, style) in enumerate(zip(discs, ("-", "--", "-.", ":"), strict=True)):
            i = first + j * (last - first) // len(discs)
            mesh = draw_disc(ax, motion, i, scale, levels)
            after = f"{1e3 * (motion.time[i] - motion.time[first]):.1f} ms"
            ax.set_title(f"({'abcd'[j]}) {after}, {motion.phase[i]}")
            draw_circle(circle, motion, i, 5, linestyle=style, label=f"disc, {after}")
        bar = above.colorbar(mesh, ax=list(discs), pad=0.01, aspect=20, fraction=0.04, label="Deflection (mm)")
        bar.outline.set_visible(False)
        circle.plot([], [], "s", ms=5, mfc=SLIDER, mec=BLACK, mew=0.6, label="slider")
        circle.plot([], [], "s", ms=5, mfc=SEPARATED, mec=BLACK, mew=0.6, label="slider, separated")
        circle.margins(y=0.08)
        drawing.show_thickness(circle, case, "y")
        circle.legend(loc="lower left", bbox_to_anchor=(0, 1), borderaxespad=0.2, ncols=6)
        circle.set_title("(e)", loc="left", x=-0.06)
        return figure


def motion_of(case: xr.DataTree) -> Motion:
    """The motion of disc and slider from windows `around0`, ... of the disc at r_0 and as many angles, which determine
    the harmonics that modes without nodal circles are; raises `Missing` if they do not."""
    p = Parameters.model_validate_json(case.attrs["parameters"])
    count = sum(str(name).startswith("around") for name in case.children)
    windows = [dataset.samples(case, f"around{j}", at_least=1) for j in range(count or 1)]
    harmonics = np.arange(p.n_diameters + 1)
    if p.n_circles:
        raise Missing("has modes with nodal circles, which a circle of points does not tell apart")
    if len(windows) < 2 * len(harmonics) - 1:
        raise Missing(f"recorded the disc at {len(windows)} angles, {2 * len(harmonics) - 1} are needed")
    if any(not np.array_equal(window["time"].values, windows[0]["time"].values) for window in windows):
        raise Missing("recorded the disc at other times at other angles")
    angles = np.array([window.attrs["theta"] for window in windows])
    turns = harmonics * angles[:, None]
    values = np.array([window["w_point"].values for window in windows])
    solution = np.linalg.lstsq(np.hstack([np.cos(turns), np.sin(turns)[:, 1:]]), values, rcond=None)[0]
    at_slider = solution[: len(harmonics)].astype(complex)
    at_slider[1:] += 1j * solution[len(harmonics) :]
    amplitudes = at_slider / mode_arrays(p).psi[:, None]
    time, psi, u = (windows[0][name].values for name in ("time", "psi", "u"))
    return Motion(p, time, amplitudes, p.Omega * time - psi, u, flag_names(windows[0]["phase"]))
