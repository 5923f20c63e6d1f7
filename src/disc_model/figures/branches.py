"""Branches of cycles: their range of motion against one parameter, and where a sweep jumps."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.legend_handler import HandlerTuple
from matplotlib.ticker import FixedLocator, LogFormatterSciNotation, NullFormatter

from disc_model.data.variables import axis_of, flag_names, stated_in
from disc_model.figures.branch_lines import (
    STABLE,
    THIN,
    Look,
    between,
    draw_branch,
    stable_segments,
)
from disc_model.figures.drawing import (
    BLACK,
    GREY,
    PAGE,
    SEPARATED,
    halo,
    large,
    mark,
    mark_cases,
    panels,
    sample,
    say,
    wide,
)
from disc_model.figures.kinds.motions import Branches
from disc_model.figures.legends import figure_legend
from disc_model.figures.types import Array, Axes, Figure, Mask

LOWEST = 1e-3  # least range that is distinguished from rest, mm
DECADES = 8  # of the axis above it that have ticks
BENDS = 2.5  # factor between the heights of neighbouring points beyond which a branch may bend
ABOVE_SLIDING = 0.12  # height of the names of cases, as a share of the panel
ROOM_BELOW = 0.36  # lower end of the axis over `LOWEST`, for the name of steady sliding
JUMP = 1.0  # decades of the range from which a sweep jumps
NONE = 1e-9  # mm, stands for no range on a logarithmic scale
UNSETTLED = "#4d4d4d"  # a sweep's marks, filled ones, where motions are not shown to have settled


def draw(plot: Branches, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
    """Draw one point: a line for each branch, thick where it is stable, and triangles for the
    sweep up and down."""
    study = study.squeeze([str(dim) for dim in study["status"].dims])  # keeps a single branch
    label, factor = axis_of(str(stated_in(study, "options")["parameter"]))
    along = study["sweep_value"].values * factor
    width = plot.inches
    figure, [ax] = panels(width, 3.6 if width == PAGE else 3.9)
    ax.set_yscale("log")

    for i in range(int(study["n_branches"])):
        branch = study.isel(branch=i)
        colour = SEPARATED if branch["separations"] > 0 else BLACK
        values = branch["value"].values * factor
        stable = stable_segments(branch["growth_rate"].values)
        draw_branch(ax, values, _heights(branch["range"]), stable, Look(colour), BENDS)
    _draw_sliding(ax, study, along)
    jumps = [_draw_sweep(ax, sweep) for sweep in sweeps_of(study, along)]

    places = {case: value * factor for case, value in plot.paper_cases.items()}
    mark_cases([ax], places, ABOVE_SLIDING)
    ax.set_xlabel(label)
    ax.set_ylabel("Range of the slider's height (mm)")
    ax.set_xlim((along[0], along[-1]))
    _end_at_lowest(ax)
    _legend(figure, study, any(jumps))
    return figure


def _heights(ranges: xr.DataArray) -> Array:
    """Ranges in mm; those that are not distinguished from rest are at `LOWEST`."""
    return np.maximum(1e3 * ranges.values, LOWEST)


def _end_at_lowest(ax: Axes) -> None:
    """Say at `LOWEST` that smaller ranges, and none, stand there too, without ticks below."""
    ax.set_ylim(bottom=ROOM_BELOW * LOWEST)
    ticks = LOWEST * 10.0 ** np.arange(DECADES)
    between = np.outer(ticks, range(2, 10)).ravel()
    ax.yaxis.set_major_locator(FixedLocator(ticks.tolist()))
    ax.yaxis.set_minor_locator(FixedLocator(between.tolist()))
    usual = LogFormatterSciNotation()
    usual.set_axis(ax.yaxis)

    def text(value: float, _: float) -> str:
        words = str(usual(value))
        return f"≤ {words}" if np.isclose(value, LOWEST) else words

    ax.yaxis.set_major_formatter(text)
    ax.yaxis.set_minor_formatter(NullFormatter())


def _draw_sliding(ax: Axes, study: xr.Dataset, along: Array) -> None:
    """Draw the stability of steady sliding as a line along the lower edge."""
    unstable = study["sliding_growth_rate"].values > 0
    phrase = "stable where the line is thick"
    if unstable.all():
        phrase = "unstable"
    elif not unstable.any():
        phrase = "stable"
    draw_branch(ax, along, np.full(along.size, LOWEST), between(~unstable), Look(GREY))
    place = (along[-1], LOWEST)
    look: dict[str, Any] = {"fontsize": large(7), "color": GREY, "path_effects": halo(2.5)}
    say(ax, f"steady sliding: {phrase}", place, (-4, -3), **look)


# ---- Sweeps


@dataclass(frozen=True)
class Sweep:
    """A sweep of the parameter, in its order.

    x : the parameter, in the unit of the axis
    heights : range of the slider's height, mm, at least `LOWEST`
    separates, settled : whether contact is lost, and whether it is shown that the motion has
        settled
    shape : the mark that stands for its direction
    """

    x: Array
    heights: Array
    separates: Mask
    settled: Mask
    shape: str


def sweeps_of(study: xr.Dataset, along: Array) -> list[Sweep]:
    """The sweeps up and down of a study of branches."""
    found = []
    for way, shape in enumerate("^v"):
        order = slice(None) if shape == "^" else slice(None, None, -1)
        heights = _heights(study["sweep_range"][way])
        separates = study["sweep_separation_rate"].values[way] > 0
        settled = flag_names(study["sweep_settled"])[way] == "settled"
        found.append(Sweep(along[order], heights[order], separates[order], settled[order], shape))
    return found


def _mark_look(colour: str) -> dict[str, Any]:
    """Look of the marks of a sweep in one of its colours: filled where it is not shown that motions
    have settled, as in grey print colours are alike."""
    face = UNSETTLED if colour == UNSETTLED else "white"
    return {
        "color": colour,
        "markersize": mark(2.5),
        "markerfacecolor": face,
        "markeredgewidth": wide(0.5),
    }


def _draw_sweep(ax: Axes, sweep: Sweep) -> bool:
    """Draw the marks of a sweep, and an arrow at each jump, by a factor of more than 10 or between
    vibration and rest; returns whether there is one."""
    for mask, colour in (
        (sweep.settled & ~sweep.separates, BLACK),
        (sweep.settled & sweep.separates, SEPARATED),
        (~sweep.settled, UNSETTLED),
    ):
        if mask.any():  # the layout leaves room for marks that are not clipped, even for none
            look = _mark_look(colour)
            ax.plot(sweep.x[mask], sweep.heights[mask], sweep.shape, clip_on=False, **look)
    decades = np.log10(np.maximum(sweep.heights, NONE))
    rests = sweep.heights <= LOWEST
    jumps = (np.abs(np.diff(decades)) > JUMP) | (rests[1:] != rests[:-1])
    arrow = {"arrowstyle": "->", "color": GREY, "lw": wide(1.0)}
    for i in np.flatnonzero(jumps):
        start = (sweep.x[i], sweep.heights[i])
        end = (sweep.x[i + 1], sweep.heights[i + 1])
        ax.annotate("", end, start, arrowprops=arrow)
    return bool(jumps.any())


def _legend(figure: Figure, study: xr.Dataset, has_jumps: bool) -> None:
    """Name lines, marks and arrows below the panel."""
    separating = bool((study["separations"].values > 0).any())
    separating |= bool((study["sweep_separation_rate"].values > 0).any())
    swept = np.isfinite(study["sweep_range"].values)
    unsettled = bool((flag_names(study["sweep_settled"])[swept] != "settled").any())

    named: dict[str, Any] = {
        "stable cycle, in contact": sample(color=BLACK, linewidth=wide(STABLE))
    }
    if separating:
        thick = sample(color=SEPARATED, linewidth=wide(STABLE))
        named["stable cycle, separating"] = thick
    named["unstable cycle"] = sample(color=BLACK, linewidth=wide(THIN))

    def both(colour: str) -> tuple[Any, Any]:
        """Marks of both sweeps, up and down."""
        up, down = (sample(ls="", marker=way, **_mark_look(colour)) for way in "^v")
        return up, down

    rising, falling = both(BLACK)
    named["simulated, rising"] = rising
    named["simulated, falling"] = falling
    if separating:
        named["simulated, separating"] = both(SEPARATED)
    if unsettled:
        named["simulated, not settled, or undecided"] = both(UNSETTLED)
    if has_jumps:
        named["jump"] = sample(color=GREY, linestyle="", marker=r"$\rightarrow$", ms=mark(9))
    figure_legend(
        figure,
        [*named.values()],
        loc="outside lower center",
        columns=3,
        labels=[*named],
        handler_map={tuple: HandlerTuple(None)},
    )
