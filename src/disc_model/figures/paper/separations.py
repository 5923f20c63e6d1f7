"""Separation of the slider from the disc, over a run and in detail; figures 2, 3 and 23."""

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from disc_model.data import dataset
from disc_model.data.dataset import Missing
from disc_model.data.variables import PHASES
from disc_model.figures import parts
from disc_model.figures.parts import BLACK, COLUMN, DISC, FORCE, PAGE, SEPARATED, SLIDER, new_figure

SEPARATION = PHASES.index("separation")


def shade(ax: Axes, spans: list[tuple[float, float]], zero: float) -> None:
    """Shade separations over the time in ms after `zero` in s, with one entry in the legend."""
    for i, span in enumerate(spans):
        start, stop = ((time - zero) * 1e3 for time in span)
        ax.axvspan(start, stop, color=SEPARATED, alpha=0.25, label="separation" if i == 0 else "_nolegend_")


def displacements(ax: Axes, part: xr.Dataset, zero: float, rest: float) -> None:
    """Draw displacements of disc and slider relative to `rest` in m, over the time in ms after `zero` in s."""
    time = (part["time"].values - zero) * 1e3
    ax.plot(time, (part["w"].values - rest) * 1e3, color=DISC, label="disc")
    ax.plot(time, (part["u"].values - rest) * 1e3, color=SLIDER, linestyle=(0, (4, 1.5)), label="slider")
    ax.set_ylabel("Displacement (mm)")


def separations(window: xr.Dataset) -> list[tuple[float, float]]:
    """Separations in a window of samples, s, including those that the window cuts off."""
    time = window["time"].values.tolist()
    return [(time[a], time[b - 1]) for a, b in parts.stretches(window["phase"].values == SEPARATION)]


def complete_separations(window: xr.Dataset) -> list[tuple[float, float]]:
    """Separations that begin and end inside the window."""
    time = window["time"].values
    return [(a, b) for a, b in separations(window) if a > time[0] and b < time[-1]]


def contact_force(cases: Mapping[str, xr.DataTree]) -> Figure:
    """Figure 2: (a) range of the contact force over the run, (b) the contact force in the window `zoom`."""
    case = cases["F02"]
    figure = new_figure(PAGE, 2.3)
    whole, zoom = figure.subplots(1, 2)
    with parts.blank_if_missing(whole):
        label = parts.show_run(whole, case, "P")
        _show_zero(whole, case)
        whole.set(xlabel="Time (s)", ylabel=label)
        parts.letter(whole, "a")
    with parts.blank_if_missing(zoom):
        _zoom(zoom, case)
    return figure


def _show_zero(ax: Axes, case: xr.DataTree) -> None:
    """Include zero if contact is lost; a force that hardly changes is shown in detail."""
    if np.isfinite(float(case["first_separation"])):
        ax.set_ylim(bottom=-0.03 * ax.get_ylim()[1])


def _zoom(ax: Axes, case: xr.DataTree) -> None:
    window = dataset.samples(case, "zoom")
    # a separation that the window cuts off at its start would look like a jump
    window = window.isel(time=slice(int(np.argmin(window["phase"].values == SEPARATION)), None))
    parts.letter(ax, "b")
    time = window["time"].values
    start = float(time[0])
    spans = separations(window)
    shade(ax, spans, start)
    ax.plot((time - start) * 1e3, window["P"].values, color=FORCE)
    _show_zero(ax, case)
    ax.set(xlabel=f"Time after {start:.5f} s (ms)", ylabel=parts.axis_of("P")[0])
    if spans:
        parts.legend_above(ax)


MARGIN = 0.5
"""Time shown before and after, as a fraction of the separation."""


def one_separation(cases: Mapping[str, xr.DataTree]) -> Figure:
    """Figure 3, slider and disc around one separation: (a) displacements from static equilibrium, (b) the gap.

    The paper shows (a); the gap is a hundredth of the motion and needs an axis of its own.
    """
    case = cases["F02"]
    figure = new_figure(COLUMN, 3.2)
    both, gap = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    with parts.blank_if_missing(both, gap):
        window = dataset.samples(case, "zoom")
        found = complete_separations(window)
        if not found:
            raise Missing("has no complete separation in zoom")
        start, stop = found[0]
        margin = MARGIN * (stop - start)
        part = window.sel(time=slice(start - margin, stop + margin))
        for ax in (both, gap):
            shade(ax, found[:1], start)
        displacements(both, part, start, float(case["u_0"]))
        gap.plot((part["time"].values - start) * 1e3, (part["u"] - part["w"]).values * 1e6, color=BLACK)
        gap.set(xlabel=f"Time after {start:.5f} s (ms)", ylabel="Gap (μm)")
        parts.letters((both, gap))
        parts.legend_above(both)
    figure.align_ylabels()
    return figure


SHOWN = 0.025
"""Length of the stretch shown, s."""


def light_slider(cases: Mapping[str, xr.DataTree]) -> Figure:
    """Figure 23, slider and disc from static equilibrium; losses of contact are marked."""
    case = cases["F23"]
    figure = new_figure(COLUMN, 2.5)
    ax = figure.subplots()
    with parts.blank_if_missing(ax):
        window = dataset.samples(case, "zoom")
        start = float(window["time"][0])
        found = complete_separations(window)
        if found:
            start = found[0][0] - 0.1 * SHOWN
        part = window.sel(time=slice(start, start + SHOWN))
        rest = float(case["u_0"])
        shade(ax, separations(part), start)
        displacements(ax, part, start, rest)
        losses = part.sel(time=[a for a, _ in separations(part) if a > start], method="nearest")
        if losses["time"].size:
            time, height = (losses["time"].values - start) * 1e3, (losses["w"].values - rest) * 1e3
            ax.plot(time, height, "o", color=SEPARATED, markersize=3.5, label="contact lost")
        ax.set_xlabel(f"Time after {start:.4f} s (ms)")
        parts.legend_above(ax)
    return figure
