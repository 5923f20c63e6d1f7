"""Phase portraits: one variable over another, coloured by phase."""

from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from disc_model.data.variables import PHASES, flag_names
from disc_model.figures.canvas import Page, Wishes, page_for
from disc_model.figures.case_lines import Lines, Style, limits_of_motion
from disc_model.figures.drawing import BLACK, COLUMN, PHASE_COLOURS, halo, mark, sample, wide
from disc_model.figures.growing_runs import growth_entries, growth_note
from disc_model.figures.named_axes import Quantities
from disc_model.figures.overlay import Case, draw_case, name_of_case
from disc_model.figures.runs import sampled, window_of
from disc_model.figures.stated_case import size_of, stated, told_apart
from disc_model.figures.still_motions import ends_shown, is_still, show_ends
from disc_model.figures.types import Array, Artist, Axes

LINES = {"stick": 1.6, "slip": 0.5, "separation": 1.4}
"""Widths of the lines of phases, points: where slip lies on stick, both show."""
DASHES = {"separation": (0, (2.0, 0.8))}
"""Dashes of lines that are not full: in grey print the three phases are edged, thin and dashed."""
EDGED = "stick"
"""The phase whose line has a black edge,"""
EDGE = 0.4
"""and the width of this edge, points."""

POINT = 3.0
"""Size of the point that a motion is in comparison with its variables, points."""
ROOM = 0.04
"""Free share of the values on both sides of them."""


def plot_phase_portrait(
    case: xr.DataTree,
    window: str,
    x: str,
    y: str,
    *,
    ax: Any = None,
    legend: Any = True,
    labels: Any = None,
    title: str | bool | None = None,
) -> Axes:
    """Draw a portrait of a run; returns the axes."""
    samples = window_of(case, window, ("x", x), ("y", y), samples=True)
    name, labels = name_of_case(labels)
    with page_for(Wishes(ax, legend, labels, title), COLUMN, 2.9, title=stated(case)) as page:
        page.show(Quantities(*(sampled(each, samples)[0] for each in (x, y))))
        apart = told_apart(case, name, window=f"window {window}")
        overlaid = Case("portrait", apart, stated(case), ending=growth_note(case, [samples]))
        panels = [_lines(case, samples, x, y)]
        draw_case(page, overlaid, panels, lambda: _draw_alone(page, case, samples, x, y))
    return page.ax


def _draw_alone(page: Page, case: xr.DataTree, samples: xr.Dataset, x: str, y: str) -> None:
    """Draw a portrait of one run, coloured by phase, with its legend."""
    phases = draw_portrait(page.ax, case, samples, x, y)
    page.explain([*phases, *growth_entries(case, [samples])])


def _lines(case: xr.DataTree, samples: xr.Dataset, x: str, y: str) -> Lines:
    """How a portrait is drawn beside others: as a line in one look, whatever the phase."""
    across = _variable(case, samples, x)
    up = _variable(case, samples, y)
    point = _point_of_rest(across, up)

    def draw(ax: Axes, style: Style) -> Artist:
        ax.plot(across.values, up.values, rasterized=True, **style.layered(), **point)
        ax.set_xlabel(across.label)
        ax.set_ylabel(up.label)
        return sample(**style.layered(), **point)

    limits_across = limits_of_motion(across.values, ROOM, across.size)
    limits_upward = limits_of_motion(up.values, ROOM, up.size)
    return Lines(draw, (limits_across, limits_upward))


class Shown(NamedTuple):
    """A variable along an axis of a portrait: its label, values, and its size, as `size_of` has it, all in the
    unit that is shown."""

    label: str
    values: Array
    size: float


def _variable(case: xr.DataTree, samples: xr.Dataset, name: str) -> Shown:
    """A variable of a portrait."""
    label, factor, _ = sampled(name, samples)
    return Shown(label, samples[name].values * factor, size_of(name, case) * factor)


def _point_of_rest(across: Shown, up: Shown) -> dict[str, Any]:
    """Options of a line that is a point, as neither of its variables moves in comparison with its size;
    none of another line."""
    if is_still(across.values, across.size) and is_still(up.values, up.size):
        return {"marker": "o", "markersize": mark(POINT)}
    return {}


def draw_portrait(ax: Axes, case: xr.DataTree, samples: xr.Dataset, x: str, y: str) -> list[Artist]:
    """Draw one variable over another, coloured by phase; returns entries of a legend."""
    across = _variable(case, samples, x)
    up = _variable(case, samples, y)
    point = _point_of_rest(across, up)
    words = flag_names(samples["phase"])
    handles = []
    for name in PHASES:
        inside = words == name
        if not inside.any():
            continue
        # broken where the phase changes, so that no chord is drawn across others
        height = np.where(inside, up.values, np.nan)
        look: dict[str, Any] = {"color": PHASE_COLOURS[name], "label": name}
        look["linestyle"] = DASHES.get(name, "-")
        width = wide(LINES[name])
        if name == EDGED:
            look["path_effects"] = halo(width + 2 * wide(EDGE), BLACK)
        ax.plot(across.values, height, linewidth=width, rasterized=True, **look, **point)
        handles.append(sample(linewidth=width + 0.5, **look, **point))
    ax.margins(ROOM)
    ends_across = np.array(ends_shown(across.values, across.size))
    ends_up = np.array(ends_shown(up.values, up.size))
    show_ends(ax, ends_across, ends_up)
    ax.set_xlabel(across.label)
    ax.set_ylabel(up.label)
    return handles
