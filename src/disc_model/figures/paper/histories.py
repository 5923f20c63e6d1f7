"""Variables against time, over a run or closer, and separations; figures 2, 3, 10, 11, 13 and 23 of the paper."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from disc_model.data import dataset
from disc_model.data.dataset import Missing
from disc_model.data.variables import flag_names
from disc_model.figures import drawing
from disc_model.figures.drawing import BLACK, COLUMN, DISC, FORCE, GREY, PAGE, SEPARATED, SLIDER, panels


def history(case: xr.DataTree, *, window: str, variables: Sequence[str], until: float = np.inf) -> Figure:
    """Draw panels one above the other until a time in s; windows of ranges are drawn as bands."""
    figure, axes = panels(COLUMN, 0.8 + 1.3 * len(variables), len(variables), sharex=True)
    found = dataset.group(case, window).sel(time=slice(None, until))
    if found.sizes["time"] < 2:  # the run ended before it
        raise Missing(f"has {found.sizes['time']} samples in {window}, at least 2 are needed")
    drawing.letters(axes)
    for ax, name in zip(axes, variables, strict=True):
        drawing.show(ax, case, found, name)
        ax.label_outer()
    axes[-1].locator_params(axis="x", nbins=6)
    figure.align_ylabels()
    return figure


def with_and_without(separating: xr.DataTree, bonded: xr.DataTree) -> Figure:
    """Figure 10: range of the disc at r_0 and a fixed angle over the run, bilateral and with separation."""
    figure, [ax] = panels(COLUMN, 2.4)
    ignored, followed = drawing.history(bonded), drawing.history(separating)
    drawing.envelope(ax, ignored, "w_point", color=GREY, label="separation ignored")
    drawing.envelope(ax, followed, "w_point", label="with separation")
    ax.set(xlabel="Time (s)", ylabel=drawing.sampled("w_point", ignored, followed)[0])
    drawing.headroom(ax, 0.25)
    ax.legend(loc="upper left")
    return figure


# ----------------------------------------------------------------------------------------------------
# Separations


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


def contact_force(case: xr.DataTree) -> Figure:
    """Figure 2: (a) range of the contact force over the run, (b) the contact force in the window `zoom`."""
    figure, [whole, zoom] = panels(PAGE, 2.3, 1, 2)
    with drawing.blank_if_missing(whole):
        drawing.show(whole, case, drawing.history(case), "P")
        _show_zero(whole, case)
        drawing.letter(whole, "a")
    with drawing.blank_if_missing(zoom):
        window = dataset.samples(case, "zoom")
        # a separation that the window cuts off at its start would look like a jump
        window = window.isel(time=slice(int(np.argmin(flag_names(window["phase"]) == "separation")), None))
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


def one_separation(case: xr.DataTree) -> Figure:
    """Figure 3, slider and disc around one separation: (a) displacements from static equilibrium, (b) the gap.

    The paper shows (a); the gap is a hundredth of the motion and needs an axis of its own.
    """
    figure, axes = panels(COLUMN, 3.2, 2, sharex=True, height_ratios=(2, 1))
    both, gap = axes
    window = dataset.samples(case, "zoom")
    found = complete_separations(window)
    if not found:
        raise Missing("has no complete separation in zoom")
    start, stop = found[0]
    margin = 0.5 * (stop - start)
    part = after(window.sel(time=slice(start - margin, stop + margin)), start)
    for ax in axes:
        shade(ax, [(0.0, (stop - start) * 1e3)])
    displacements(both, part, float(case["u_0"]))
    gap.plot(part["time"], (part["u"] - part["w"]) * 1e6, color=BLACK)
    gap.set(xlabel=f"Time after {start:.5f} s (ms)", ylabel="Gap (μm)")
    drawing.letters(axes)
    drawing.legend_above(both)
    figure.align_ylabels()
    return figure


def light_slider(case: xr.DataTree) -> Figure:
    """Figure 23, slider and disc from static equilibrium; losses of contact are marked."""
    figure, [ax] = panels(COLUMN, 2.5)
    window, rest = dataset.samples(case, "zoom"), float(case["u_0"])
    found = complete_separations(window)
    length = 0.025  # of the stretch shown, s
    start = found[0][0] - 0.1 * length if found else float(window["time"][0])
    part = after(window.sel(time=slice(start, start + length)), start)
    spans = separations(part)
    shade(ax, spans)
    displacements(ax, part, rest)
    losses = part.sel(time=[a for a, _ in spans if a > 0], method="nearest")
    if losses["time"].size:
        height = (losses["w"] - rest) * 1e3
        ax.plot(losses["time"], height, "o", color=SEPARATED, markersize=3.5, label="contact lost")
    ax.set_xlabel(f"Time after {start:.4f} s (ms)")
    drawing.legend_above(ax)
    return figure
