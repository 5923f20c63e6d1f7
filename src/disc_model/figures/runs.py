"""What pictures of a run have in common: its windows and phases, and how a sampled
variable is drawn.
"""

import json
from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np
import xarray as xr

from disc_model.data import dataset
from disc_model.data.variables import PHASES, axis_of, flag_names, ranged_variable
from disc_model.errors import Fault, ParameterError, require, suggestion
from disc_model.figures import selection
from disc_model.figures.drawing import BLACK, DISC, FORCE, SEPARATED, SLIDER, halo, large, say, wide
from disc_model.figures.stated_case import size_of
from disc_model.figures.still_motions import ends_shown, show_ends
from disc_model.figures.types import Array, Axes

Span = tuple[float, float]  # s, begin and end
Spans = Mapping[str, Sequence[Span]]  # by phase

TIME = "Time (s)"
ABOVE = 1.04  # height of a bar above a panel, as a share of it,
RIGHT = 1.02  # and place of one beside it

# ---- Windows


def window_of(
    case: xr.DataTree,
    name: object,
    *variables: tuple[str, object],
    which: str = "window",
    samples: bool = False,
) -> xr.Dataset:
    """A window of a run, if it holds what is needed; raises `ParameterError`.

    Parameters
    ----------
    name : of the window
    variables : what it must hold, each after the argument that names it
    which : the argument that names the window
    samples : whether it must hold samples instead of ranges
    """
    known = [str(child) for child in case.children if child not in ("events", "poincare")]
    if not (isinstance(name, str) and name in case.children):
        raise ParameterError(Fault.of((which,), name, f"was not recorded{suggestion(name, known)}"))
    window = dataset.group(case, name)
    held = [ranged_variable(str(x)) for x in window if x != "phase"]
    for argument, variable in variables:
        if not (isinstance(variable, str) and variable in held):
            rule = f"is not in the window {name}{suggestion(variable, dict.fromkeys(held))}"
            raise ParameterError(Fault.of((argument,), variable, rule))
    require(("phase" in window or not samples, which, name, "must hold samples, not their ranges"))
    return window


def span_of(window: xr.Dataset) -> float:
    """Time from the first to the last sample of a window, s."""
    times = window["time"].values
    return float(np.ptp(times)) if times.size else 0.0


# ---- Phases


def spans_between(case: xr.DataTree, start: float, stop: float) -> Spans:
    """Stretches of each phase between two times in s, from the events; raises `Missing` unless the
    case keeps all events there, and one before.

    A study's case keeps those of a span. A run that is drawn at once has all of them.
    """
    events = dataset.group(case, "events")
    times = events["time"].values
    phases = flag_names(events["phase"])
    kept_from = events.attrs.get("kept_from", -np.inf)
    kept_until = events.attrs.get("kept_until", np.inf)
    inside = (times > start) & (times < stop)
    before = np.flatnonzero(times <= start)
    if start < kept_from or stop > kept_until or not before.size:
        raise dataset.Missing(f"keeps no events from {start:g} to {stop:g} s")
    words = [phases[before[-1]], *phases[inside]]
    borders = [start, *times[inside].tolist(), stop]
    spans: dict[str, list[Span]] = {phase: [] for phase in PHASES}
    for word, begin, end in zip(words, borders[:-1], borders[1:], strict=True):
        same = spans[word]
        if same and same[-1][1] == begin:  # the phase goes on, as at a reversal of slip
            same[-1] = (same[-1][0], end)
        else:
            same.append((begin, end))
    return spans


def spans_in(case: xr.DataTree, window: xr.Dataset) -> Spans:
    """Stretches of each phase in a window; borders lie halfway between samples where the case
    keeps no events. Nothing for a window that holds ranges."""
    if "phase" not in window or window.sizes["time"] < 2:
        return {phase: [] for phase in PHASES}
    time = window["time"].values
    words = flag_names(window["phase"])
    try:
        return spans_between(case, float(time[0]), float(time[-1]))
    except dataset.Missing:
        return {phase: selection.spans(time, words == phase) for phase in PHASES}


# ---- Sampled variables of a case

NO_BREAK = "\N{NO-BREAK SPACE}"


def sampled(name: str, *windows: xr.Dataset) -> tuple[str, float, str]:
    """Axis label of a sampled variable, with the angle of the disc's fixed point, factor to its
    unit, and colour."""
    where = ""
    if name.startswith("w_point"):
        angles = {float(window.attrs["theta"]) for window in windows if "theta" in window.attrs}
        shown = " and ".join(f"{angle:g}" for angle in sorted(angles))
        angle_text = rf"$\theta$ = {shown} rad".replace(" ", NO_BREAK)
        where = f", {angle_text}"
    label, factor = axis_of(name, where)
    colour = SLIDER
    if name == "P":
        colour = FORCE
    elif name.partition("_")[0] == "w":
        colour = DISC
    return label, factor, colour


def envelope(ax: Axes, ranges: xr.Dataset, name: str, color: str = "", label: str = "") -> None:
    """Draw the range of a variable against time, as a band that stays visible where it is thin."""
    time = ranges["time"].values
    _, factor, usual_colour = sampled(name)
    low, high = (ranges[f"{name}_{end}"].values * factor for end in ("min", "max"))
    ax.fill_between(time, low, high, color=color or usual_colour, linewidth=0.5, label=label)
    ax.set_xlim(0, end_of_ranges(time))


def end_of_ranges(time: Array) -> float:
    """Where the last of the ranges ends whose middles these times are, s."""
    bin_width = time[-1] - time[-2]
    return float(round(time[-1] + bin_width / 2, 2))


def show(ax: Axes, case: xr.DataTree, window: xr.Dataset, name: str, *, named: bool = True) -> None:
    """Draw a variable against time, as a line or as ranges, and mark the first separation, with its
    time if `named`."""
    label, factor, colour = sampled(name, window)
    if f"{name}_min" in window:
        envelope(ax, window, name)
        values = np.stack([window[f"{name}_{end}"].values for end in ("min", "max")]) * factor
    else:
        values = window[name].values * factor
        ax.plot(window["time"], values, color=colour, linewidth=wide(0.6))
        ax.set_xlim(*window["time"].values[[0, -1]])
    if np.isfinite(values).any():
        ends = ends_shown(values, size_of(name, case) * factor)
        show_ends(ax, window["time"].values[[0, -1]], np.array(ends))
    ax.set_xlabel(TIME)
    ax.set_ylabel(label)
    mark_first_separation(ax, case, named=named)


def show_thickness(ax: Axes, case: xr.DataTree, along: Literal["x", "y"]) -> None:
    """Draw a bar as long as the disc is thick, beside a panel whose axis is a displacement in mm,
    if it finds room."""
    thickness = json.loads(case.attrs.get("parameters", "{}")).get("h")
    if not thickness:
        return
    low, high = {"x": ax.get_xlim, "y": ax.get_ylim}[along]()
    share = 1e3 * thickness / (high - low)
    if share > 0.8:
        return
    start: tuple[float, float] = (RIGHT, 0)
    end: tuple[float, float] = (RIGHT, share)
    offset = (3, 1)
    rotation = 90
    if along == "x":
        start = (1 - share, ABOVE)
        end = (1, ABOVE)
        offset = (-3, 0)
        rotation = 0
    ax.plot(
        *zip(start, end, strict=True),
        color=BLACK,
        linewidth=2.5,
        solid_capstyle="butt",
        transform=ax.transAxes,
        clip_on=False,
    )
    say(
        ax,
        f"thickness {1e3 * thickness:g} mm",
        start,
        offset,
        xycoords="axes fraction",
        fontsize=large(6),
        rotation=rotation,
    )


def mark_first_separation(ax: Axes, case: xr.DataTree, *, named: bool = True, **look: Any) -> None:
    """Mark the first separation by a line with its time above it; nothing if the time shown has
    none."""
    time = float(case["first_separation"])
    low, high = ax.get_xlim()
    if not low <= time <= high:
        return
    usual: dict[str, Any] = {"color": SEPARATED, "linewidth": wide(0.8), "linestyle": (0, (4, 2))}
    usual["path_effects"] = halo(wide(2.0))  # on ranges of nearly its grey
    usual.update(look)
    ax.axvline(time, **usual)
    if named:
        say(
            ax,
            f"first separation {time:.2f} s",
            (time, 1),
            (0, 2),
            color=SEPARATED,
            xycoords=("data", "axes fraction"),
            fontsize=large(7),
        )
