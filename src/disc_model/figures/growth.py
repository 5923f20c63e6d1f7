"""Maps of growth rates: one scale of colours, marks of sign and resolution, and the classes of
points that have no rate."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from cmcrameri import cm
from matplotlib.colors import to_hex

from disc_model.data.variables import EXCLUDED, flag_names
from disc_model.figures.cells import are_ordered, edges_of, entries, lay_over, paint, unresolved
from disc_model.figures.classes import DOUBTS, LOOKS, STABLE, UNRESOLVED, Look
from disc_model.figures.colour_wishes import USUAL, ColourWishes
from disc_model.figures.colours import ROUNDING, draw_bar, growth_colours, growth_norm
from disc_model.figures.missing_texts import missing_text
from disc_model.figures.selection import classes_of_gaps, doubts, has_values, statuses_like
from disc_model.figures.types import Artist, Axes, FigureBase, Mask, Words
from disc_model.figures.words import NO_VALUE, label_of

NEGATIVE = "negative"
NEUTRAL = "neutral"
MAP_LOOKS = {
    **LOOKS,
    NEGATIVE: STABLE,
    NEUTRAL: Look("neutral", to_hex(cm.vik(0.5))),
    UNRESOLVED.label: UNRESOLVED,
    **{look.label: look for look in DOUBTS},
}
"""Looks of all that a map of growth rates shows beside its colours."""


def growth_panels(
    figure: FigureBase,
    axes: Sequence[Axes],
    planes: Sequence[xr.Dataset],
    name: str = "growth_rate",
    wishes: ColourWishes = USUAL,
) -> list[Artist]:
    """Draw a growth rate (1/s) on one scale of colours, a panel for each plane.

    Cells are dotted where it is negative by more than rounding, hatched where it is unresolved, and
    have the middle of the scale where it is zero but for rounding.
    A point without a rate has the look of its class. Returns entries of a legend.
    """
    rates_of_all = np.concatenate([plane[name].values.ravel() for plane in planes])
    scale = growth_colours(rates_of_all, wishes)
    used: set[str] = set()
    for ax, plane in zip(axes, planes, strict=True):
        edges = edges_of(plane[name])
        rates = plane[name].values
        words = classes_without_rate(plane, name)
        known = np.isfinite(rates)
        shown = np.ma.array(np.where(known, rates, 0.0), mask=~known)
        mesh = ax.pcolormesh(*edges, shown, cmap=scale.cmap, norm=scale.norm, rasterized=True)
        painted = paint(ax, edges, words, MAP_LOOKS)
        colours = np.where(known[..., None], mesh.to_rgba(shown), painted)
        used |= set(words.flat)
        for mark, cells in marks_of(plane, name).items():
            if not cells.any():
                continue
            used.add(mark)
            if MAP_LOOKS[mark].hatch:
                lay_over(ax, edges, cells, MAP_LOOKS[mark], colours)
    if has_values(planes, name):
        draw_bar(figure, axes, mesh, scale, label_of(planes[0][name])[0])
    unvalued = MAP_LOOKS[NO_VALUE]._replace(label=missing_text(planes[0], name))
    return entries(used, {**MAP_LOOKS, NO_VALUE: unvalued})


def marks_of(plane: xr.Dataset, name: str = "growth_rate") -> dict[str, Mask]:
    """Cells of a map of growth rates that have each mark, a key of `MAP_LOOKS`; neutral ones are
    named, and keep the colour of their rate."""
    rates = plane[name].values
    marks = {NEGATIVE: rates < -ROUNDING, NEUTRAL: np.abs(rates) <= ROUNDING}
    if are_ordered(plane[name]):
        marks[UNRESOLVED.label] = isolated(plane, name)
    for look, mask in doubts(plane, name).items():
        marks[look.label] = mask.transpose(*plane[name].dims).values
    return marks


def stability_of(plane: xr.Dataset) -> Words:
    """Stability of the followed cycle, "stable" or "unstable", or the class of the quantity
    `regions` where there is none."""
    rate = plane["growth_rate"].values
    words = flag_names(plane["cycle"]).astype(object)
    words[statuses_like(plane, plane["growth_rate"]) == EXCLUDED] = EXCLUDED
    words[rate < 0] = "stable"
    words[rate > 0] = "unstable"
    return words.astype(str)


def classes_without_rate(plane: xr.Dataset, name: str = "growth_rate") -> Words:
    """Classes of points that have no growth rate, keys of `MAP_LOOKS`; "" where there is a rate."""
    rate = plane[name].values
    if name == "growth_rate" and "cycle" in plane:
        is_left_out = statuses_like(plane, plane[name]) == EXCLUDED
        words = np.where(is_left_out, EXCLUDED, flag_names(plane["cycle"]))
    else:
        words = classes_of_gaps(plane, plane[name])
    return np.where(np.isfinite(rate), "", words)


def isolated(plane: xr.Dataset, name: str = "growth_rate") -> Mask:
    """Cells whose growth rate (of another cycle, or a narrow resonance) or stability differs from
    that around them."""
    rate = plane[name].values
    known = np.isfinite(rate)
    places = growth_norm(rate)(np.where(known, rate, 0.0)).clip(0, 1)
    places = np.where(known, places, np.nan)
    padded = np.pad(places, 1, constant_values=np.nan)
    around = np.lib.stride_tricks.sliding_window_view(padded, (3, 3))
    like = np.abs(places[..., None, None] - around) < 0.1  # of the scale; a cell is like itself
    alone = (like.sum((2, 3)) == 1) & (np.isfinite(around).sum((2, 3)) > 1)
    if name == "growth_rate" and "cycle" in plane:
        alone |= unresolved(stability_of(plane))
    return alone
