"""Entries of a picture without a legend, from which its reader can make one."""

from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from disc_model.figures.kept import Kept
from disc_model.figures.legend_samples import in_order
from disc_model.figures.pages import Page
from disc_model.figures.types import Artist, Axes

OUTSIDE = (2.0, 2.0)  # over the sides of axes, which cut off what lies there
_KEPT: Kept[list[Artist]] = Kept("entries")
"""What was added to axes for the sake of its label alone."""


def keep_entries(page: Page) -> None:
    """Have what a legend would say at the axes of a picture, as labels that legends of matplotlib read."""
    _remove_replaced(page)
    known = {words for ax in page.axes for words in ax.get_legend_handles_labels()[1]}
    for handle in in_order(page.handles):
        if str(handle.get_label()) not in known:
            _keep(page.ax, handle)


def _remove_replaced(page: Page) -> None:
    """Remove entries of former pictures that have other words now."""
    for entry in _KEPT.get(page.ax, []):
        if entry.axes is not None and entry.get_label() in page.replaced:
            entry.remove()


def _keep(ax: Axes, entry: Artist) -> None:
    """Add an entry to axes, where it is not seen."""
    kept = _KEPT.get(ax, [])
    _KEPT[ax] = kept
    if isinstance(entry, Line2D):
        kept.append(ax.add_line(_empty(entry)))
    elif isinstance(entry, Patch):
        kept.append(ax.add_artist(_outside(ax, entry)))


def _empty(entry: Line2D) -> Line2D:
    """A line without points that has the look and the words of an entry."""
    line = Line2D([], [])
    line.update_from(entry)
    line.set_label(str(entry.get_label()))
    return line


def _outside(ax: Axes, entry: Patch) -> Rectangle:
    """A rectangle of no size, with the look and the words of an entry."""
    shown = Rectangle(OUTSIDE, 0, 0)
    shown.update_from(entry)
    shown.set_transform(ax.transAxes)
    shown.set_label(str(entry.get_label()))
    return shown
