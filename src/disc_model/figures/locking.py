"""Locking of motions with stick and separation: the staircase of periods, and the map of release
phases."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.legend_handler import HandlerTuple

from disc_model.data.variables import axis_of, flag_names
from disc_model.figures import drawing
from disc_model.figures.drawing import BLACK, BLUE, GREY, VERMILION, large, mark, wide
from disc_model.figures.kinds.motions import PhaseMap, Staircase
from disc_model.figures.legends import figure_legend
from disc_model.figures.selection import failed, without_single
from disc_model.figures.types import Array, Figure

ROOM = 0.055  # of a panel's width, least distance of two labels
WORDS = 0.14  # and half of that which a number with its unit takes
HEIGHT = 0.11  # of a panel's height, room that a label needs above a step,
BESIDE = 0.06  # and beside one
TOP = 0.93  # height of the marks of motions that never stick, as a share of the panel
BELOW_TOP = 0.88  # share of the panel below these marks: they have no number of separations
APART = "Separations per release"


# ---- The staircase


class _Step(NamedTuple):
    """Neighbouring values of the parameter at which the motion has one period: their ends, in the
    axis's unit, separations per release, and releases in a period."""

    low: float
    high: float
    height: float
    releases: int

    def meets(self, low: float, high: float) -> bool:
        """Whether a part of the step lies between two values."""
        return self.low < high and self.high > low


NEVER_STICKS = "beside it, at these speeds, a motion that never sticks"


def draw_staircase(
    plot: Staircase, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]
) -> Figure:
    """Draw separations per release over a parameter, a step for each period with its number of
    releases; below, zooms of the file."""
    parts = [without_single(study, plot.x)]
    if "fine" in overlays:
        parts.append(without_single(overlays["fine"], plot.x))
    label, factor = axis_of(plot.x)

    narrow = plot.inches != drawing.PAGE
    layout = _layout(len(plot.zooms), beside=not narrow)
    figure = drawing.new_figure(plot.inches, 0.1 + 2.2 * len(layout))
    panels = list(figure.subplot_mosaic(layout).values())
    whole, *zooms = panels

    steps = _steps(parts, plot.x, factor)
    never_sticks = np.empty(0)
    if "slipping" in overlays:
        never_sticks = _without_stick(overlays["slipping"], plot.x) * factor
    share = BELOW_TOP if never_sticks.size else 1.0
    _draw_steps(whole, steps, study[plot.x].values[[0, -1]] * factor, share)
    _draw_undecided(whole, parts, plot.x, factor)
    if never_sticks.size:
        _mark_without_stick(whole, never_sticks, narrow=narrow)
    for ax, (low, high) in zip(zooms, plot.zooms, strict=True):
        _draw_steps(ax, steps, np.array([low, high]) * factor)
        _draw_undecided(ax, parts, plot.x, factor)
    for outer, inner in zip(panels, zooms, strict=False):
        outer.axvspan(*inner.get_xlim(), color="0.9", zorder=0, linewidth=0)
    for ax in panels:
        ax.set_xlabel(label)
        ax.set_ylabel(APART)
        ax.xaxis.set_major_formatter("{x:.6g}")
        if narrow:
            ax.locator_params(axis="x", nbins=5)  # numbers have up to six digits
    drawing.letters(panels)
    return figure


def _layout(zooms: int, beside: bool) -> list[Any]:
    """Names of panels, row by row: the whole above its zooms, which stand beside each other or, in
    a column, below each other."""
    names = [f"zoom {i}" for i in range(zooms)]
    if not beside or not zooms:
        return [["whole"], *([name] for name in names)]
    return [["whole"] * zooms, names]


def _steps(parts: Sequence[xr.Dataset], name: str, factor: float) -> list[_Step]:
    """Steps of the points of all parts together, along the parameter."""
    points: dict[float, tuple[int, int]] = {}
    for part in parts:
        locked = (flag_names(part["motion"]) == "locked") & ~failed(part).values
        releases = np.where(locked, part["period_releases"].values, 0)
        separations = part["period_separations"].values
        for x, n, m in zip(part[name].values.tolist(), releases, separations, strict=True):
            points[round(x, 9)] = (int(n), int(m))

    steps: list[_Step] = []
    before = (0, 0)
    for x in sorted(points):
        n, m = points[x]
        if n and (n, m) == before:
            steps[-1] = steps[-1]._replace(high=x * factor)
        elif n:
            steps.append(_Step(x * factor, x * factor, m / n, n))
        before = (n, m)
    return steps


def _draw_steps(ax: Axes, steps: Sequence[_Step], ends: Array, share: float = 1.0) -> None:
    """Draw the steps between two ends of the axis, in a share of the panel from below, and name
    those that have room."""
    low, high = ends.tolist()
    shown = [step for step in steps if step.high >= low and step.low <= high]
    for step in shown:
        ax.plot(
            [step.low, step.high],
            [step.height] * 2,
            "o-",
            color=BLACK,
            linewidth=wide(1.4),
            markersize=mark(1.8),
        )
    margin = 0.02 * (high - low or abs(high))
    ax.set_xlim(low - margin, high + margin)
    if shown:
        heights = [step.height for step in shown]
        spread = max(max(heights) - min(heights), 1e-3)
        low_end = min(heights) - 0.15 * spread
        high_end = max(heights) + 0.3 * spread
        ax.set_ylim(low_end, low_end + (high_end - low_end) / share)
    _name_steps(ax, shown, low, high)


def _name_steps(ax: Axes, steps: Sequence[_Step], low: float, high: float) -> None:
    """Write the number of releases over the steps, the widest first, as long as there is room; then
    to the right of those that had none above them."""
    taken: list[float] = []
    unnamed: list[_Step] = []
    for step in sorted(steps, key=lambda each: each.low - each.high):
        middle = (max(step.low, low) + min(step.high, high)) / 2
        if not _has_room_above(ax, step, middle, steps, taken, ROOM * (high - low)):
            unnamed.append(step)
            continue
        taken.append(middle)
        place = (middle, step.height)
        side = 0
        text = f"{step.releases} releases" if len(taken) == 1 else f"{step.releases}"
        room = (WORDS if len(taken) == 1 else ROOM) * (high - low)
        if middle > high - room:  # the words would leave the panel
            place = (min(step.high, high), step.height)
            side = -1
        elif middle < low + room:
            place = (max(step.low, low), step.height)
            side = 1
        drawing.say(ax, text, place, (side, 3), fontsize=large(7))

    for step in unnamed:
        others = [other for other in steps if other is not step]
        if _has_room_beside(ax, step, others, high, ROOM * (high - low)):
            place = (step.high, step.height)
            drawing.say(ax, f"{step.releases}", place, (4, 0), fontsize=large(7))


def _has_room_above(
    ax: Axes,
    step: _Step,
    middle: float,
    steps: Sequence[_Step],
    taken: Sequence[float],
    room: float,
) -> bool:
    """Whether no step lies where the name of one would stand, above its middle, and no name near.

    taken : places of names, along the axis
    room : that a name needs there
    """
    bottom, top = ax.get_ylim()
    ceiling = step.height + HEIGHT * (top - bottom)
    above = [other for other in steps if step.height < other.height < ceiling]
    is_free = not any(other.meets(middle - room / 2, middle + room / 2) for other in above)
    return is_free and all(abs(middle - other) >= room for other in taken)


def _has_room_beside(
    ax: Axes, step: _Step, others: Sequence[_Step], high: float, room: float
) -> bool:
    """Whether no other step lies beside the right end of one, where its name would stand.

    high : end of the axis
    room : that a name needs along it
    """
    bottom, top = ax.get_ylim()
    near = [other for other in others if other.meets(step.low - room, step.high + room)]
    apart = [abs(other.height - step.height) for other in near]
    return step.high < high - room and all(each > BESIDE * (top - bottom) for each in apart)


def _draw_undecided(ax: Axes, parts: Sequence[xr.Dataset], name: str, factor: float) -> None:
    """Draw rings at the mean of motions that are not shown to repeat."""
    for part in parts:
        open_ = (flag_names(part["motion"]) == "undecided") & ~failed(part).values
        if open_.any():
            ax.plot(
                part[name].values[open_] * factor,
                part["separations_per_release"].values[open_],
                "o",
                color=GREY,
                markerfacecolor="none",
                markersize=mark(3),
            )
            drawing.mark_failed(ax, part[name].values[failed(part).values] * factor)


def _without_stick(slipping: xr.Dataset, name: str) -> Array:
    """Values of the parameter at which a motion without stick exists."""
    part = slipping.squeeze(drop=True)
    values: Array = part[name].values[flag_names(part["motion"]) == "without_stick"]
    return values


def _mark_without_stick(ax: Axes, places: Array, *, narrow: bool) -> None:
    """Mark, above the end of the axis of separations per release, where a motion without stick,
    which has no release, exists beside.

    narrow : whether the panel is as wide as a column, and has no room for the words
    """
    low, high = ax.get_ylim()
    end = low + BELOW_TOP * (high - low)
    ax.set_yticks([tick for tick in ax.get_yticks() if low <= tick <= end])
    ax.spines["left"].set_bounds(low, end)

    edge = ax.get_xaxis_transform()
    heights = np.full(places.size, TOP)
    ax.plot(places, heights, "D", color=BLUE, markersize=mark(2.5), transform=edge)
    if narrow:
        sign = drawing.sample(
            color=BLUE, marker="D", markersize=mark(2.5), linestyle="", label=NEVER_STICKS
        )
        figure: Any = ax.get_figure()
        figure_legend(figure, [sign], loc="outside lower center", columns=1)
        return
    drawing.say(
        ax,
        NEVER_STICKS,
        (float(places[0]), TOP),
        (3, 2),
        xycoords=edge,
        color=BLUE,
        fontsize=large(7),
    )


# ---- The map of release phases


def draw_map(plot: PhaseMap, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
    """Draw the next phase over the phase: (a) of all releases for which the slider was held, (b) near
    those of the motion itself, with the number of separations between them."""
    point = study.squeeze(drop=True)
    phase = point["map_phase"].values
    following = point["map_next_phase"].values
    separations = point["map_separations"].values
    slopes = point["map_slope"].values
    own = point["release_phase"].values
    own = own[np.isfinite(own)]

    figure, axes = drawing.row_of_panels(plot.inches, 2, 3.0, 2.8)
    margin = 0.15 * float(np.ptp(own))
    near = (float(own.min()) - margin, float(own.max()) + margin)
    whole = (float(np.nanmin(phase)), 1.0)
    for ax, (low, high) in zip(axes, (whole, near), strict=True):
        for index, number in enumerate(np.unique(separations[np.isfinite(separations)])):
            branch = separations == number
            colour = (BLACK, VERMILION)[index % 2]
            ax.plot(phase[branch], following[branch], ".", color=colour, markersize=mark(2))
            inside = (
                branch & (phase > low) & (phase < high) & (following > low) & (following < high)
            )
            if inside.sum() > 2 and ax is axes[1]:
                _name_branch(ax, phase[inside], following[inside], slopes[inside], int(number))
        ax.plot([low, high], [low, high], color=GREY, linewidth=wide(0.6), zorder=1)
        ax.set(xlim=(low, high), ylim=(low, high), aspect="equal")
        ax.set_xlabel("Phase of a release")
        ax.set_ylabel("Phase of the next one")
    axes[1].plot(own[:-1], own[1:], zorder=4, **_ring())
    _mark_window(axes[0], near)
    drawing.letters(axes)
    _name_marks(figure)
    return figure


def _name_marks(figure: Figure) -> None:
    """Name dots and rings below the panels."""
    dot = {"linestyle": "", "marker": "."}
    named: dict[str, Any] = {
        "slider held once; colours change with the number of separations": (
            drawing.sample(color=BLACK, **dot),
            drawing.sample(color=VERMILION, **dot),
        ),
        "motion left to itself": drawing.sample(**_ring()),
    }
    figure_legend(
        figure,
        [*named.values()],
        loc="outside lower center",
        columns=2,
        labels=[*named],
        handler_map={tuple: HandlerTuple(None)},
    )


def _ring() -> dict[str, Any]:
    """Look of the releases of the motion itself."""
    return {
        "color": BLUE,
        "linestyle": "",
        "marker": "o",
        "markerfacecolor": "none",
        "markersize": mark(3.5),
        "markeredgewidth": wide(0.8),
    }


def _name_branch(ax: Axes, phase: Array, following: Array, slopes: Array, number: int) -> None:
    """Write after how many separations the next release comes, and the mean slope."""
    last = phase.size - 1
    drawing.say(
        ax,
        f"{number} separations,\nslope {np.nanmean(slopes):.2f}",
        (float(phase[last]), float(following[last])),
        (6, 0),
        fontsize=large(7),
        bbox={"fc": "white", "lw": 0, "pad": 1},  # the diagonal may run there
    )


def _mark_window(ax: Axes, ends: tuple[float, float]) -> None:
    """Draw the window of the next panel."""
    low, high = ends
    ax.plot(
        [low, high, high, low, low],
        [low, low, high, high, low],
        color=BLUE,
        linewidth=wide(0.8),
        zorder=3,
    )
