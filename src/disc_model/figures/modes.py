"""The shapes of the modes of a disc from above."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.colors import Normalize

from disc_model.disc.plate import mode_arrays, mode_shapes, radial_range
from disc_model.errors import raise_faults, require, violations
from disc_model.figures.canvas import Wishes, page_for
from disc_model.figures.disc import draw_plane, plane_of
from disc_model.figures.drawing import BLACK, COLUMN, PAGE, SLIDER, wide
from disc_model.figures.named_axes import Quantities, check_free
from disc_model.figures.types import Axes
from disc_model.parameters import Parameters, foreign_case
from disc_model.units import is_whole

IN_A_ROW = 5  # modes
COLOURED = 1.6  # ends of the colour scale over the largest deflection, so that lines stay visible
FROM_ABOVE = "Disc from above (mm)"
EDGE = 0.02  # share of the ring's width beside a clamped edge, which is no nodal line


def plot_modes(
    p: Parameters,
    most: int = 15,
    *,
    ax: Any = None,
    labels: Any = None,
    title: str | bool | None = None,
) -> np.ndarray:
    """Draw the modes of a case, as `disc_model.plot_modes` describes."""
    counts = (is_whole(most) and most >= 1, "most", most, "must be a whole number >= 1")
    raise_faults(foreign_case(p) + violations(counts))
    drawable = p.n_diameters >= 0 or p.disc is not None
    require((drawable, "n_diameters", p.n_diameters, "must be >= 0: a rigid disc has no modes"))
    radial_range(p)  # raises an error without shapes

    count = min(most, len(mode_arrays(p).omega))
    columns = min(count, IN_A_ROW)
    rows = -(-count // columns)
    width = COLUMN if columns < 3 else PAGE
    usual = "Modes (nodal diameters, nodal circles), slider and nodal lines"
    named = usual if title is None or title is True else title
    wishes = Wishes(ax, labels=labels, title=named if ax is None else None)
    with page_for(wishes, width, 0.24 * PAGE * rows + 0.3, rows, columns) as page:
        check_free(page.axes, FROM_ABOVE, "modes")
        seen = Quantities(FROM_ABOVE, FROM_ABOVE, "Shape of a mode")
        page.show(*([seen] * len(page.axes)))
        for spare in page.axes[count:]:
            spare.set_axis_off()
        draw_modes(page.axes[:count], p)
    return np.array(page.axes)


def draw_modes(axes: Sequence[Axes], p: Parameters) -> None:
    """Draw the shape of each mode from above, its nodal lines in black, and its frequency, by
    ascending frequency."""
    modes = mode_arrays(p)
    plane = plane_of(p)
    shapes = mode_shapes(p, plane.r)
    inside = plane.r > plane.r[0] + EDGE * (plane.r[-1] - plane.r[0])
    for ax, i in zip(axes, np.argsort(modes.omega), strict=False):
        values = shapes[i, :, None] * np.cos(modes.diameters[i] * plane.theta)
        largest = COLOURED * (float(np.abs(values).max()) or 1.0)
        draw_plane(ax, plane, values, Normalize(-largest, largest))
        shown = values[inside]
        if shown.min() < 0 < shown.max():
            x = plane.x[inside]
            y = plane.y[inside]
            ax.contour(x, y, shown, levels=[0.0], colors=BLACK, linewidths=wide(0.9))
        ax.plot(1e3 * p.r_0, 0, "o", ms=3.5, mfc=SLIDER, mec=BLACK, mew=0.5)
        frequency = modes.omega[i] / (2 * np.pi)
        name = f"({modes.diameters[i]}, {modes.circles[i]})  {frequency:.0f} Hz"
        ax.set_title(name, loc="center")
