"""Excess of the range of motions with separation over the range at which contact is lost."""

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
BAND = 5.0  # percent, deviation up to which a motion counts as one that follows the law
CORNERS = ((1, 1), (0, 1), (1, 0), (0, 0))
"""Of a panel, in which words may stand, best first."""
CORNER = (0.45, 0.2)  # size of one, as shares of the panel
ENLARGED = (-25.0, 35.0)  # percent, deviations in the panel over the time apart


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
    """Draw the excess of the range over the pinned range, of all motions of the study: all of it
    against the pinned range, and against the share of time apart; hollow where several
    frequencies share the motion."""
    motions = _motions_of(study, plot)
    figure, axes = drawing.row_of_panels(plot.inches, 2, 3.0, 2.8)
    _draw_all(axes[0], motions)
    _draw_enlarged(axes[1], motions)
    drawing.letters(axes, ("all motions", "by the time apart"))
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


def _draw_band(ax: Axes) -> None:
    """Draw zero and the band of motions that count as following the law, in percent."""
    ax.axhspan(-BAND, BAND, color="0.9", zorder=0)
    ax.axhline(0, color=GREY, linewidth=wide(0.6), zorder=1)
    ax.set_ylabel("Excess of the range over R (%)")


def _draw_all(ax: Axes, motions: _Motions) -> None:
    """Draw the excess, in percent, against the pinned range, and say how many are in the band."""
    excess = 100 * motions.deviation
    pinned = 1e3 * motions.pinned
    _draw_band(ax)
    _draw_points(ax, motions, pinned, excess)
    ax.set_xscale("log")
    ax.set_xlim(0.8 * pinned.min(), 1.25 * pinned.max())
    drawing.plain_decades(ax.xaxis)
    ax.set_xlabel("Range at which contact is lost, R = 2N/|k − mω²| (mm)")

    inside = np.abs(excess) <= BAND
    lines = [f"within {BAND:g} % (grey):"]
    for word, chosen in (("filled", motions.single), ("hollow", ~motions.single)):
        if chosen.any():
            lines.append(f"{(inside & chosen).sum()} of {chosen.sum()} {word}")
    corner = _freest_corner(ax, pinned, excess)
    offset = (3 - 6 * corner[0], 3 - 6 * corner[1])
    look = {"xycoords": "axes fraction", "fontsize": large(7)}
    drawing.say(ax, "\n".join(lines), corner, offset, **look)


def _freest_corner(ax: Axes, x: Array, y: Array) -> tuple[int, int]:
    """The corner of a panel in which fewest points lie, as shares of it; the upper right one of
    several."""
    places = ax.transAxes.inverted().transform(ax.transData.transform(np.column_stack([x, y])))

    def points_in(corner: tuple[int, int]) -> int:
        near = np.abs(places - corner) < CORNER
        return int(near.all(axis=1).sum())

    return min(CORNERS, key=points_in)


def _draw_enlarged(ax: Axes, motions: _Motions) -> None:
    """Draw the excess, in percent, against the share of time apart, and the curve that it follows;
    motions beyond the panel stand at its edge."""
    low, high = ENLARGED
    excess = 100 * motions.deviation
    apart = 100 * motions.apart
    _draw_band(ax)
    _draw_points(ax, motions, apart, np.clip(excess, low, high))
    times = np.linspace(0, min(apart.max() * 1.08, 60.0), 200)
    curve = [100 * excess_of_flights(share / 100) for share in times.tolist()]
    ax.plot(times, curve, color=BLACK, linewidth=wide(0.8), zorder=4)
    ax.set_xlim(0, times[-1])
    margin = 0.03 * (high - low)
    ax.set_ylim(low - margin, high + margin)
    ax.set_xlabel("Time apart (%)")
    drawing.say(ax, "within 5 %", (times[-1], -BAND), (-3, 2), fontsize=large(7), color="0.35")
    if (excess > high).any():
        drawing.say(ax, "higher: see (a)", (0, high), (3, -7), fontsize=large(7))
    if (excess < low).any():
        drawing.say(ax, "lower: see (a)", (0, low), (3, 7), fontsize=large(7))


def _explain(figure: Figure, motions: _Motions, share: float) -> None:
    """Name the marks below the panels, with their numbers."""
    handles = []
    for name in sorted(set(motions.marks.tolist())):
        colour, shape = LOOKS.get(name, OTHER_LOOK)
        label = MODES.get(name, name)
        look = {"color": colour, "marker": shape, "linestyle": "", "markersize": mark(4)}
        handles.append(drawing.sample(label=label, **look))
    if not motions.single.all():
        text = f"no frequency carries {100 * share:g} % of height and contact force"
        look = {"color": GREY, "marker": "o", "linestyle": "", "markersize": mark(4)}
        handles.append(drawing.sample(markerfacecolor="white", label=text, **look))
    from_flights = "(b) from flights: (π · time apart)²/8"
    handles.append(drawing.sample(color=BLACK, linewidth=wide(0.8), label=from_flights))
    figure_legend(figure, handles, loc="outside lower center", columns=2)
