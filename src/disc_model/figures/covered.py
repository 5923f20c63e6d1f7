"""What a legend would cover: lines, points, areas and texts of its axes, and of others on the same place."""

from typing import Any

import numpy as np
from matplotlib.collections import Collection, PolyCollection
from matplotlib.lines import Line2D
from matplotlib.transforms import Bbox

from disc_model.figures.types import Axes, Legend

INSIDE = 0.6  # of the width of axes, for a legend in them: other panels may make them narrower


def covers(legend: Legend, ax: Axes) -> bool:
    """Whether a legend reaches beyond its axes, nearly fills their width, or covers lines, points,
    areas or texts in them."""
    box = legend.get_window_extent()
    frame = ax.get_window_extent()
    if frame.count_contains(box.corners()) < len(box.corners()):
        return True
    if box.width > INSIDE * frame.width or box.count_overlaps(other_legends(ax)) > 0:
        return True
    return any(_meets_contents(box, each) for each in (ax, *twins_of(ax)))


def twins_of(ax: Axes) -> list[Axes]:
    """Other axes on the same place, such as those of ``ax.twinx()``."""
    figure = ax.get_figure(root=False)
    assert figure is not None
    return [each for each in figure.axes if each is not ax and _share_place(each, ax)]


def _share_place(ax: Axes, other: Axes) -> bool:
    """Whether axes lie on each other: in the same cells of a grid, where a layout may not have moved
    new ones yet, or at the same place."""
    cells = [each.get_subplotspec() for each in (ax, other)]
    if None not in cells:
        return cells[0] == cells[1]
    places = [each.get_position(original=True).bounds for each in (ax, other)]
    return np.allclose(*places)


def other_legends(ax: Axes) -> list[Bbox]:
    """The extents of legends of axes on the same place."""
    legends: list[Legend] = [each.get_legend() for each in twins_of(ax)]
    return [legend.get_window_extent() for legend in legends if legend is not None]


def _meets_contents(box: Bbox, ax: Axes) -> bool:
    """Whether a box covers lines, points, areas or texts in axes."""
    texts = [text.get_window_extent() for text in ax.texts if text.get_text()]
    return (
        box.count_overlaps(texts) > 0
        or any(_meets_line(box, line) for line in ax.lines)
        or any(_meets_shape(box, shape) for shape in ax.collections)
    )


def _meets_line(box: Bbox, line: Line2D) -> bool:
    """Whether a box covers a part of a line, or its marks; not of one across the axes, such as that
    of zero."""
    path = line.get_transform().transform_path(line.get_path())
    points = np.asarray(path.vertices)
    page: Any = line.get_figure(root=True)
    size = 0.0
    if line.get_marker() not in ("", "None", None):
        size = 0.5 * line.get_markersize() * page.dpi / 72
    if box.padded(size).count_contains(points):
        return True
    assert line.axes is not None
    of_data = all(line.get_transform().contains_branch_seperately(line.axes.transData))
    joined = line.get_linestyle() != "None" and of_data
    return joined and bool(path.intersects_bbox(box, filled=False))


def _meets_shape(box: Bbox, shape: Collection) -> bool:
    """Whether a box covers a part of an area, or a mark of many."""
    if not isinstance(shape, PolyCollection):
        return bool(box.count_contains(shape.get_offset_transform().transform(shape.get_offsets())))
    to_page = shape.get_transform()
    return any(
        to_page.transform_path(path).intersects_bbox(box, filled=True) for path in shape.get_paths()
    )
