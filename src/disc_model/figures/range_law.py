"""Range of motions with separation against the range at which contact is lost."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import xarray as xr

from disc_model.analysis.contact_loss import excess_of_flights
from disc_model.figures import drawing
from disc_model.figures.drawing import BLACK, BLUE, GREY, VERMILION, large, mark, wide
from disc_model.figures.kinds.motions import RangeLawPlot
from disc_model.figures.legends import figure_legend
from disc_model.figures.selection import NORM, failed, normalizations
from disc_model.figures.types import Array, Axes, Figure, Mask
from disc_model.figures.words import MODES

LOOKS = {"as_published": (BLUE, "o"), "orthonormal": (VERMILION, "^")}
OTHER_LOOK = (BLACK, "s")  # of motions that are set apart, and of discs given by a table
HIGHEST_EXCESS = 0.35  # largest deviation drawn, and least time apart beyond the points, as shares
LOWEST_EXCESS = -0.2


class _Motions(NamedTuple):
    """The motions of a study that separate, one a row: names of their marks, and columns of
    `disc_model.studies.quantities.range_law`; `single` where one frequency carries enough."""

    marks: np.ndarray
    range: Array
    pinned: Array
    deviation: Array
    apart: Array
    single: Mask


def draw(plot: RangeLawPlot, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
    """Draw all motions of the study: range against pinned range, and its excess against the share
    of time apart; hollow where several frequencies share the motion."""
    motions = _motions_of(study, plot)
    figure, axes = drawing.row_of_panels(plot.inches, 2, 3.0, 2.8)
    _draw_ranges(axes[0], motions)
    _draw_excess(axes[1], motions)
    drawing.letters(axes)
    _explain(figure, motions, plot.share)
    return figure


def _motions_of(study: xr.Dataset, plot: RangeLawPlot) -> _Motions:
    """The motions of a study that separate, whatever its dimensions."""
    known = study["range"].notnull() & ~failed(study)
    rows = known.values.ravel()

    def column(values: xr.DataArray) -> np.ndarray:
        """A variable or coordinate of these motions."""
        return values.broadcast_like(known).transpose(*known.dims).values.ravel()[rows]

    modes = xr.DataArray(normalizations(study)[0])
    if NORM in study.dims:
        modes = study[NORM]
    marks = column(modes).astype(object)
    for name, values in plot.set_apart.items():
        chosen = np.ones(marks.shape, dtype=bool)
        for parameter, value in values.items():
            chosen &= np.isclose(column(study[parameter]), value, rtol=1e-9, atol=0)
        marks[chosen] = name

    single = (study["vibration_share"] >= plot.share) & (study["force_share"] >= plot.share)
    return _Motions(
        marks=marks,
        range=column(study["range"]),
        pinned=column(study["pinned_range"]),
        deviation=column(study["deviation"]),
        apart=column(study["separation_fraction"]),
        single=column(single),
    )


def _draw_points(ax: Axes, motions: _Motions, x: Array, y: Array) -> None:
    """Draw the motions by their marks, hollow ones below."""
    for name in dict.fromkeys(motions.marks.tolist()):
        colour, shape = LOOKS.get(name, OTHER_LOOK)
        here = motions.marks == name
        for single, fill, order in ((False, "white", 2), (True, colour, 3)):
            mask = here & (motions.single == single)
            ax.plot(
                x[mask],
                y[mask],
                shape,
                color=colour,
                markerfacecolor=fill,
                markersize=mark(3),
                markeredgewidth=wide(0.6),
                zorder=order,
            )


def _draw_ranges(ax: Axes, motions: _Motions) -> None:
    """Draw the range against the pinned one, and the line on which both are equal."""
    _draw_points(ax, motions, 1e3 * motions.pinned, 1e3 * motions.range)
    low = 1e3 * 0.8 * min(motions.pinned.min(), motions.range.min())
    high = 1e3 * 1.25 * max(motions.pinned.max(), motions.range.max())
    ax.plot([low, high], [low, high], color=BLACK, linewidth=wide(0.8), zorder=1)
    ax.set(xscale="log", yscale="log", xlim=(low, high), ylim=(low, high), aspect="equal")
    drawing.plain_decades(ax.xaxis)
    drawing.plain_decades(ax.yaxis)
    ax.set_xlabel("Range at which contact is lost, 2N/|k − mω²| (mm)")
    ax.set_ylabel("Range with separation (mm)")
    drawing.say(ax, "equal", (0.55 * high, 0.55 * high), (3, -3), fontsize=large(7))
    words = "a few percent of scatter\ndo not show: see (b)"
    drawing.say(ax, words, (1, 0), (-3, 3), xycoords="axes fraction", fontsize=large(7))


def _draw_excess(ax: Axes, motions: _Motions) -> None:
    """Draw the excess against the share of time apart, in percent, and the curve that it follows;
    marks beyond the panel stand at its edge."""
    low = 100 * LOWEST_EXCESS
    high = 100 * HIGHEST_EXCESS
    deviation = np.clip(100 * motions.deviation, low, high)
    apart = 100 * motions.apart
    _draw_points(ax, motions, apart, deviation)
    times = np.linspace(0, min(apart.max() * 1.08, 60.0), 200)
    curve = [100 * excess_of_flights(share / 100) for share in times.tolist()]
    ax.plot(times, curve, color=BLACK, linewidth=wide(0.8), zorder=4)
    ax.axhspan(-5, 5, color="0.9", zorder=0)
    ax.axhline(0, color=GREY, linewidth=wide(0.6), zorder=1)
    ax.set_xlim(0, times[-1])
    margin = 0.03 * (high - low)
    ax.set_ylim(low - margin, high + margin)
    ax.set_xlabel("Time apart (%)")
    ax.set_ylabel("Excess over that range (%)")
    if np.any(100 * motions.deviation > high):
        drawing.say(ax, f"beyond {high:g} %", (0, high), (3, 0), fontsize=large(7))
    drawing.say(ax, "within 5 %", (times[-1], -5), (-3, 2), fontsize=large(7), color="0.35")
    drawing.say(
        ax,
        "from flights:\n(π · time apart)²/8",
        (times[-1], 5),
        (-3, 3),
        fontsize=large(7),
        path_effects=drawing.halo(),
    )


def _explain(figure: Figure, motions: _Motions, share: float) -> None:
    """Name the marks below the panels, with their numbers."""
    handles = []
    for name in sorted(set(motions.marks.tolist())):
        colour, shape = LOOKS.get(name, OTHER_LOOK)
        label = MODES.get(name, name)
        look = {"color": colour, "marker": shape, "linestyle": "", "markersize": mark(4)}
        handles.append(drawing.sample(label=label, **look))
    hollow = f"no frequency carries {100 * share:g} % of height and contact force"
    handles.append(
        drawing.sample(
            color=GREY,
            marker="o",
            linestyle="",
            markersize=mark(4),
            markerfacecolor="white",
            label=hollow,
        )
    )
    figure_legend(figure, handles, loc="outside lower center", columns=2)
