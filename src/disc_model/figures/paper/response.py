"""One variable of one case: its range over the run, and its spectrum in time in one stretch.

Figures 26 to 29 of the paper.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from disc_model.analysis.spectra import TimeFrequency
from disc_model.data import inputs
from disc_model.data.inputs import Missing
from disc_model.figures import parts
from disc_model.figures.paper.catalogue import HIGHEST, ZOOM
from disc_model.figures.paper.spectrograms import colour_bar, mark_time, spectrogram, stretch
from disc_model.figures.style import BLACK, DISC, PAGE, SKY, SLIDER, new_figure, styled

SCALES = {"psi": 1.0, "w_point": 1e3}
"""From SI to what the axes show."""
COLOURS = {"psi": SLIDER, "w_point": DISC}


@styled
def draw(
    cases: Mapping[str, xr.DataTree],
    *,
    case: str,
    variable: str,
    spectrum: str,
    zooms: Sequence[tuple[str, float]] = (),
    highest: bool = False,
    until: float = np.inf,
) -> Figure:
    """(a) range over the run, with closer looks beside it if asked for, (b) spectrum in the window `spectrum`.

    Parameters
    ----------
    zooms : windows and times in s at which a closer look begins
    highest : mark the disc's highest natural frequency
    until : s, how much of the run (a) shows
    """
    tree = cases[case]
    figure = new_figure(PAGE, 2.7)
    layout = [["whole"] * max(len(zooms), 1)] + ([[f"zoom{i}" for i in range(len(zooms))]] if zooms else [])
    left, right = np.asarray(figure.subfigures(1, 2, width_ratios=(1, 1.08)))
    panels = left.subplot_mosaic(layout)
    shown = right.subplots()
    marked = None
    with parts.or_say_why(shown):
        found = parts.spectrum_in_time(tree, spectrum, variable)
        marked = stretch(found)
        _spectrum(right, shown, tree, found, highest)
    with parts.or_say_why(panels["whole"]):
        _whole(panels["whole"], tree, variable, marked, until)
    for i, (name, start) in enumerate(zooms):
        with parts.or_say_why(panels[f"zoom{i}"]):
            _closer(panels[f"zoom{i}"], inputs.samples(tree, name), variable, start, first=i == 0)
    return figure


def _whole(ax: Axes, tree: xr.DataTree, variable: str, marked: tuple[float, float] | None, until: float) -> None:
    history = parts.history(tree, until)
    if marked is not None:
        ax.axvspan(*marked, color=SKY, alpha=0.3, linewidth=0)
        if marked[1] - marked[0] < 0.02 * float(history["time"][-1]):
            _point_out(ax, sum(marked) / 2)
    parts.envelope(ax, history, variable, scale=SCALES[variable], color=COLOURS[variable])
    parts.mark_first_separation(ax, float(tree["first_separation"]))
    ax.set(xlabel="Time (s)", ylabel=_label(variable, history))
    parts.letter(ax, "a")


def _point_out(ax: Axes, time: float) -> None:
    """A line where the stretch of (b) is too narrow to be seen."""
    ax.axvline(time, color=BLACK, linewidth=0.8)
    ax.annotate(
        "(b)",
        (time, 1),
        (0, 2),
        xycoords=("data", "axes fraction"),
        textcoords="offset points",
        ha="center",
        va="bottom",
    )


def _label(variable: str, window: xr.Dataset) -> str:
    return parts.disc_label(window) if variable == "w_point" else "ψ (rad)"


def _closer(ax: Axes, window: xr.Dataset, variable: str, start: float, *, first: bool) -> None:
    part = window.sel(time=slice(start, start + ZOOM))
    if part.sizes["time"] < 2:
        raise Missing(f"has no samples from {start:g} to {start + ZOOM:g} s")
    ax.plot(
        (part["time"].values - start) * 1e3,
        part[variable].values * SCALES[variable],
        color=COLOURS[variable],
        linewidth=0.6,
    )
    ax.set_xlabel(f"Time after {start:g} s (ms)")
    ax.set_xlim(0, ZOOM * 1e3)
    if first:
        ax.set_ylabel(_label(variable, window))
    else:
        ax.set_label("shares the axis to its left")


def _spectrum(figure: SubFigure, ax: Axes, tree: xr.DataTree, found: TimeFrequency, highest: bool) -> None:
    mesh = spectrogram(ax, found, float(found.power.max()), HIGHEST)
    mark_time(ax, float(tree["first_separation"]))
    if highest:
        ax.axhline(_highest_natural(tree), color="white", linewidth=0.9, linestyle=(0, (1, 2)))
    ax.set(xlabel="Time (s)", ylabel="Frequency (Hz)")
    parts.letter(ax, "b")
    colour_bar(figure, mesh, ax)


def _highest_natural(tree: xr.DataTree) -> float:
    from disc_model.parameters import Parameters
    from disc_model.plate import plate_modes

    p = Parameters.model_validate_json(tree.attrs["parameters"])
    return float(np.max(plate_modes(p)["omega"])) / (2 * np.pi)
