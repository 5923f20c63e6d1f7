"""Maps of regions: outcomes over two parameters, and below them the growth rate of the cycle."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import xarray as xr
from matplotlib.ticker import FixedLocator, NullFormatter, NullLocator

from disc_model.data.variables import axis_of, flag_names, stated_in
from disc_model.figures.borders import Curve, curves_of, draw_borders, draw_curves, parts_of
from disc_model.figures.cells import MARKED, class_cells, decades_between, entries, scale_of
from disc_model.figures.classes import LOOKS, UNRESOLVED
from disc_model.figures.drawing import (
    BLACK,
    COLUMN,
    PAPER,
    halo,
    large,
    letters,
    panels,
    sample,
    say,
)
from disc_model.figures.growth import growth_panels
from disc_model.figures.kinds.maps import Mark, RegionMap
from disc_model.figures.left_out import parts_shown, titles_of_panels
from disc_model.figures.legends import figure_legend
from disc_model.figures.selection import NORM, Part, alike, normalizations
from disc_model.figures.types import Array, Artist, Axes, Figure, Mask

PAPER_MARKERS = {"quiet": "o", "growing": "^", "separation": "s"}
"""The marker of each outcome of the paper."""
TOGETHER = 0.02
"""Distance of two marks, as a share of the panel, from which one surrounds the other."""
USUAL_SIZE = 55.0  # of a mark, square points,
SURROUNDING = 140.0  # and of one around another
LEAST_ROW = 1.7  # inch, height of a panel with its title and label, at least
RIGHT_EDGE = 0.85  # share of the panel from which names stand on the left of their marks
LOWER_EDGE = 0.15  # and below which they stand above
LEFT_EDGE = 0.15  # share up to which the second of two names stands above the first


def draw(plot: RegionMap, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
    """Draw two panels for each value of the compared dimension; lines are those of the study
    ``curves``, or lie between cells."""
    parts = parts_shown(study, plot.by, plot.names)
    planes = [part.data.transpose(plot.y, plot.x, ...) for part in parts]
    figure, above, below = _panels(plot, len(parts))
    subjects = dict(zip(above, titles_of_panels(parts, study, plot.by), strict=True))
    letters(figure.axes, [subjects.get(ax, "") for ax in figure.axes])  # as they are read

    # cells and lines
    growth = growth_panels(figure, below, planes)
    outcomes: set[str] = set()
    lines: dict[str, Artist] = {}
    for upper, lower, plane in zip(above, below, planes, strict=True):
        outcomes |= class_cells(upper, plane["outcome"], LOOKS)
        for ax in (upper, lower):
            for line in _lines(ax, plot, study, plane, overlays):
                lines[str(line.get_label())] = line
    _set_scales([*above, *below], study, plot.axes)

    # marks and legends
    first = _with_paper(parts, study)
    named = [*entries(outcomes, MARKED), *lines.values()]
    if first is not None:
        named += _marks(above[0], plot)
    figure_legend(figure, named, loc="outside upper center", columns=4, title_fontsize=large(8))
    if UNRESOLVED.label in outcomes:  # named above
        growth = [entry for entry in growth if entry.get_label() != UNRESOLVED.label]
    said = "\n".join(_captions(study, first, plot))
    figure_legend(figure, growth, loc="outside lower center", title=said)
    _make_room(figure, rows=len(figure.axes) if plot.inches == COLUMN else 2)
    return figure


def _make_room(figure: Figure, rows: int) -> None:
    """Make a figure so high that legends leave its panels their height."""
    heights = [legend.get_window_extent().height / figure.dpi for legend in figure.legends]
    needed = sum(heights) + LEAST_ROW * rows
    figure.set_figheight(max(figure.get_figheight(), needed))


def _panels(plot: RegionMap, count: int) -> tuple[Figure, list[Axes], list[Axes]]:
    """A figure with panels of outcomes, and of growth rates below them; in one column, each of
    these below its own panel of outcomes."""
    width = plot.inches
    shared: dict[str, Any] = {"sharex": True, "sharey": True}
    if width == COLUMN:
        figure, axes = panels(width, 1.2 + 4.2 * count, 2 * count, 1, **shared)
        return figure, axes[::2], axes[1::2]
    figure, axes = panels(width, 5.6, 2, count, **shared)
    return figure, axes[:count], axes[count:]


def _with_paper(parts: Sequence[Part[xr.Dataset]], study: xr.Dataset) -> xr.Dataset | None:
    """The part of a study in the first panel, if it has the paper's normalization, to which its
    marks belong."""
    data = parts[0].data
    norm = normalizations(study)[0]
    if NORM in data.coords and not data[NORM].ndim:
        norm = str(data[NORM].item())
    if norm != "as_published":
        return None
    return data


# ---- Lines


def _lines(
    ax: Axes,
    plot: RegionMap,
    study: xr.Dataset,
    plane: xr.Dataset,
    overlays: Mapping[str, xr.Dataset],
) -> list[Artist]:
    """Draw continued curves, or borders between cells; returns entries of a legend."""
    if "curves" in overlays:
        return _curves(ax, plane, alike(overlays["curves"], plane, plot.by))
    # branches are continued along the study's first dimension, which may be either axis
    order = [name for name in study["outcome"].dims if name in (plot.x, plot.y)]
    return draw_borders(ax, plane, upward=order == [plot.y, plot.x])


def _curves(ax: Axes, plane: xr.Dataset, curves: xr.Dataset) -> list[Artist]:
    """Draw continued curves of the map's cycle, within its points."""
    paths: list[Curve] = []
    for curve in parts_of(curves_of(curves), plane):
        inside = _between(curve.Omega, plane["Omega"].values) & _between(curve.N, plane["N"].values)
        paths.append(curve.within(inside)._replace(label=""))
    return draw_curves(ax, paths)


def _between(values: Array, points: Array) -> Mask:
    return (values >= points.min()) & (values <= points.max())


# ---- The paper's cases


def _captions(study: xr.Dataset, first: xr.Dataset | None, plot: RegionMap) -> Iterator[str]:
    """The horizon, and where the static start does otherwise than the paper."""
    horizon = stated_in(study, "options")["horizon"]
    yield f"Within {horizon:g} s of the static start."
    if first is None:
        return
    for name, mark in plot.marks.items():
        point = first["outcome"].sel({plot.x: mark.x, plot.y: mark.y}, method="nearest")
        outcome = str(flag_names(point))
        label = LOOKS[outcome].label
        of_paper = LOOKS[mark.paper_outcome].label
        if label == of_paper or mark.assumed:
            continue
        if outcome == "growing":
            label = f"still growing at {horizon:g} s"
        yield f"{name}: paper: “{of_paper}”, static start: {label}."


def _marks(ax: Axes, plot: RegionMap) -> list[Artist]:
    """Mark cases by the shape of the paper's outcome, with names towards the middle; returns
    entries of a legend."""
    outline = halo(2.4, BLACK)
    places: list[tuple[float, float]] = []
    for name, mark in plot.marks.items():
        point = _point(plot, mark)
        across, up = (ax.transData + ax.transAxes.inverted()).transform(point)
        size = USUAL_SIZE
        offset = _away_from_edges(across, up)
        if any(math.dist((across, up), other) < TOGETHER for other in places):
            size = SURROUNDING  # so that the other mark stays visible
            offset = (6, 14) if across < LEFT_EDGE else (-8, 6)
        places.append((across, up))
        shape = PAPER_MARKERS[mark.paper_outcome]
        ax.scatter(
            *point,
            size,
            marker=shape,
            facecolor="none",
            zorder=4,
            clip_on=False,
            edgecolor=PAPER,
            linewidth=1.4,
            path_effects=outline,
        )
        say(
            ax,
            f"{name}, place assumed" if mark.assumed else name,
            point,
            offset,
            path_effects=halo(2.0),
            fontsize=large(7),
            zorder=5,
            annotation_clip=False,
        )
    outcomes = {mark.paper_outcome for mark in plot.marks.values()}
    numbered = all(name.isdigit() for name in plot.marks)
    source = "paper's figure" if numbered else "paper"
    return [
        sample(
            marker=shape,
            label=f"{source}: {LOOKS[name].label}",
            path_effects=outline,
            ls="",
            mfc="none",
            ms=6,
            mew=1.4,
            mec=PAPER,
        )
        for name, shape in PAPER_MARKERS.items()
        if name in outcomes
    ]


def _away_from_edges(across: float, up: float) -> tuple[float, float]:
    """Offset in points of the name of a mark at a place of the panel, towards its middle."""
    right = -6 if across > RIGHT_EDGE else 6
    above = -5 if up > LOWER_EDGE else 5
    return right, above


def _point(plot: RegionMap, mark: Mark) -> tuple[float, float]:
    """Where a mark lies, in the units of the axes."""
    return mark.x * axis_of(plot.x)[1], mark.y * axis_of(plot.y)[1]


# ---- Scales


def _set_scales(axes: Sequence[Axes], study: xr.Dataset, names: Mapping[str, str]) -> None:
    """Set limits, labels and scales of shared axes; a logarithmic scale with a 0 is linear up to
    the second value."""
    for which, name in names.items():
        label, factor = axis_of(name)
        values = study[name].values * factor
        _set_scale(axes[0], which, scale_of(name, values), values)
        for ax in axes:
            ax.set(**{f"{which}label": label})
            ax.label_outer()


def _set_scale(ax: Axes, which: str, scale: str, values: Array) -> None:
    """Set the scale of one axis of a panel, and limits with some room beside its values."""
    axis = getattr(ax, f"{which}axis")
    if scale != "linear":
        ticks = decades_between(values)
        start = {}
        if scale == "symlog":
            ticks = [0.0, *ticks]
            start = {"linthresh": values[1], "linscale": 0.4}
        getattr(ax, f"set_{which}scale")(scale, **start)
        axis.set_major_locator(FixedLocator(ticks))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter(NullFormatter())
    if scale == "symlog":
        axis.set_minor_locator(NullLocator())
    to_axis = axis.get_transform()
    low, high = to_axis.transform(values[[0, -1]])
    room = 0.02 * (high - low) or 0.02 * abs(high) or 1.0
    limits = to_axis.inverted().transform([low - room, high + room])
    getattr(ax, f"set_{which}lim")(limits)
