"""Samples of legends that show the dashes of lines between their marks, and notes, which have none."""

from collections.abc import Sequence
from typing import Any

from matplotlib import rcParams
from matplotlib.collections import PathCollection
from matplotlib.colors import to_hex
from matplotlib.font_manager import FontProperties
from matplotlib.legend_handler import HandlerLine2D
from matplotlib.lines import Line2D
from matplotlib.offsetbox import DrawingArea

from disc_model.figures.classes import FILLED_MARK
from disc_model.figures.types import Legend

MARK_PAD = 0.3  # distance of marks at the ends of a sample from these, over the size of the text
NO_MARKS = ("", " ", "None", None)
"""Marks that are not seen."""
FILLED = FILLED_MARK.partition("{")[0]
"""Begins the words for marks that are filled where all others are open."""
NOTE = "disc_model_note"
"""Begins the group ids of entries of legends that are only words, and of no line."""


def draw_legend(parent: Any, handles: Sequence[Any], **look: Any) -> Legend:
    """Draw a legend of axes or of a figure, whose samples are so long that dashes show between marks
    where they alone tell lines apart."""
    if "labels" not in look:  # which are in the order of the handles
        handles = in_order(handles)
    dashed = [handle for handle in handles if _is_dashed_with_marks(handle)]
    if dashed and _share_marks(handles):
        usual = FontProperties(size=look.get("fontsize") or rcParams["legend.fontsize"])
        size = usual.get_size_in_points()
        length = max(map(_sample_length, dashed)) / size + 2 * MARK_PAD
        given = look.get("handlelength") or rcParams["legend.handlelength"]
        at_ends = HandlerLine2D(MARK_PAD, 2)  # one in the middle would cover a gap
        handlers = {handle: at_ends for handle in handles if _joins_marks(handle)}
        look = {"handler_map": handlers, **look, "handlelength": max(length, given)}
    legend = parent.legend(handles=list(handles), **look)
    write_notes(legend, handles)
    if handles and all(map(_is_note, handles)) and "frameon" not in look:
        legend.set_frame_on(False)
    return legend


def in_order(handles: Sequence[Any]) -> list[Any]:
    """Entries of a legend in the order in which they are read: lines and areas, marks of points, what
    filled ones say, and words alone."""
    return sorted(handles, key=_rank)


def _rank(handle: Any) -> int:
    """The place of an entry of a legend among others, which is that of all of its kind."""
    if str(handle.get_label()).startswith(FILLED):
        return 2
    if isinstance(handle, PathCollection):
        return 1
    if not isinstance(handle, Line2D) or handle.get_linestyle() != "None":
        return 0
    return 1 if handle.get_marker() not in NO_MARKS else 3


def write_notes(legend: Legend, handles: Sequence[Any]) -> None:
    """Have the notes of a legend begin where the samples of other entries do."""
    columns = legend._legend_handle_box.get_children()
    rows = [row for column in columns for row in column.get_children()]
    for row, entry, handle in zip(rows, legend.legend_handles, handles, strict=True):
        if not _is_note(handle):
            continue
        entry.set_gid(handle.get_gid())
        row.sep = 0
        for part in row.get_children():
            if isinstance(part, DrawingArea):
                part.width = 0


def _is_note(handle: Any) -> bool:
    """Whether an entry of a legend is only words."""
    return isinstance(handle, Line2D) and str(handle.get_gid()).startswith(NOTE)


def _joins_marks(handle: Any) -> bool:
    """Whether an entry of a legend is a line with marks."""
    if not isinstance(handle, Line2D):
        return False
    has_marks = handle.get_marker() not in NO_MARKS
    return has_marks and handle.get_linestyle() != "None"


def _share_marks(handles: Sequence[Any]) -> bool:
    """Whether some lines with marks have the same ones in the same colour."""
    lines = [handle for handle in handles if _joins_marks(handle)]
    looks = {(to_hex(line.get_color()), line.get_marker()) for line in lines}
    return len(looks) < len(lines)


def _is_dashed_with_marks(handle: Any) -> bool:
    """Whether an entry of a legend is a line with gaps, and marks."""
    return _joins_marks(handle) and bool(handle.is_dashed())


def _sample_length(line: Line2D) -> float:
    """The length in points at which a sample with a mark at each end shows the dashes of a line: all of
    them and the first once more."""
    _, dashes = vars(line)["_dash_pattern"]  # points, which matplotlib tells in no other way
    return sum(dashes) + dashes[0] + line.get_markersize()
