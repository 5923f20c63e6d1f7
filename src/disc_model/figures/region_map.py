"""Maps of regions: outcomes over two parameters, and below them the growth rate of the cycle."""

from collections.abc import Mapping, Sequence
from typing import Any

import xarray as xr

from disc_model.figures.borders import Curve, curves_of, draw_borders, draw_curves, parts_of
from disc_model.figures.cells import MARKED, class_cells, entries
from disc_model.figures.classes import LOOKS, UNRESOLVED
from disc_model.figures.drawing import COLUMN, large, letters, panels
from disc_model.figures.growth import growth_panels
from disc_model.figures.kinds.maps import RegionMap
from disc_model.figures.left_out import parts_shown, titles_of_panels
from disc_model.figures.legends import figure_legend
from disc_model.figures.region_marks import captions, draw_marks
from disc_model.figures.region_scales import set_scales
from disc_model.figures.selection import NORM, Part, alike, normalizations
from disc_model.figures.types import Array, Artist, Axes, Figure, Mask

LEAST_ROW = 1.7  # inch, height of a panel with its title and label, at least


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
    set_scales([*above, *below], study, plot.axes)

    # marks and legends
    first = _with_paper(parts, study)
    named = [*entries(outcomes, MARKED), *lines.values()]
    if first is not None:
        named += draw_marks(above[0], plot)
    figure_legend(figure, named, loc="outside upper center", columns=4, title_fontsize=large(8))
    if UNRESOLVED.label in outcomes:  # named above
        growth = [entry for entry in growth if entry.get_label() != UNRESOLVED.label]
    said = "\n".join(captions(study, first, plot))
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
