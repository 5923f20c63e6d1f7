"""Late in the motion: range of the slider over the speed, with separation and with it ignored."""

import json
from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.patches import Patch

from disc_model.analysis.contact_loss import pinned_range
from disc_model.data.variables import flag_names
from disc_model.figures.drawing import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    SKY,
    halo,
    large,
    leave_to_first,
    letters,
    mark,
    row_of_panels,
    sample,
    whole_marks,
    wide,
)
from disc_model.figures.kinds.base import key_of
from disc_model.figures.kinds.motions import LateRange
from disc_model.figures.legends import figure_legend
from disc_model.figures.types import Axes, Figure
from disc_model.figures.words import SPEED
from disc_model.parameters import Parameters

LOAD_COLOURS = (BLACK, BLUE, SKY, GREEN)
"""Of preloads in their order; the first three differ in grey print."""
LOAD_WIDTHS = (0.7, 1.7, 1.2, 0.7)
"""Widths of their lines, points, which tell neighbours apart in grey print."""
LARGEST = 10.0  # thicknesses
DECADES = 1e5
"""Largest range drawn over the least one."""
BEYOND = "0.9"  # grey behind ranges of more than a thickness, for which plate theory is not linear
LOST = (":", (0, (5, 1, 1, 1)), (0, (1, 4)), (0, (7, 2)))
"""Lines at which contact is lost, of preloads in their order."""
LINES = {"unilateral": "-", "bilateral": "--"}
CONTACTS = {"unilateral": "with separation", "bilateral": "separation ignored"}
FROM_LINE = 2  # points, distance of a name from its line
LOWEST_NAME = (0.98, "right", "top")
FURTHER_NAMES = (0.03, "left", "bottom")
"""Where the lowest of these lines and the others have their names: share of the panel's width, and
alignments."""
BELOW_LINES = 0.36  # of the panel's height, top of words on all lines
OPEN_END = ("growing", "undecided")
"""Outcomes of which a longer time would change the range."""


def draw(plot: LateRange, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
    """Draw a panel for each disc, and in it a line for each preload and contact.

    A disc whose surface moves has one more panel, of the speed of its surface.
    """
    ranges = (study["u_max"] - study["u_min"]) / plot.thickness
    outcomes = study["outcome"].copy(data=flag_names(study["outcome"]))
    names = study[plot.by].values
    moving = _moving(study, plot.by)
    figure, axes = row_of_panels(plot.inches, len(names) + len(moving), 3.0, 2.4, sharex=True)
    titles = [plot.names.get(key_of(name), str(name)) for name in names]
    for ax, name in zip(axes, names, strict=False):
        chosen = {plot.by: name}
        ax.axhspan(1, 1e3, color=BEYOND, zorder=0)
        _draw_panel(ax, ranges.sel(chosen), outcomes.sel(chosen))
        if name in moving:
            _draw_lost_contact(ax, study, plot, str(name))
        ax.set_yscale("log")
        ax.set_ylim((LARGEST / DECADES, LARGEST))
        ax.set_ylabel("Slider, peak to peak (thicknesses)")
        if ax is not axes[0]:
            ax.sharey(axes[0])
            leave_to_first([ax], axes[:1])
    for ax, name in zip(axes[len(names) :], moving, strict=True):
        chosen = {plot.by: name}
        _draw_panel(ax, study["surface_speed"].sel(chosen), outcomes.sel(chosen))
        ax.axhline(1, color=GREY, linestyle=":", linewidth=wide(1.0))
        ax.set_ylim(bottom=0)
        ax.set_ylabel("Speed of the surface / of the drive")
        titles.append("speed in the plane")
    for ax in axes:
        ax.margins(x=0.05)
        if ax.xaxis.get_tick_params()["labelbottom"]:  # its numbers are not those of a panel below
            ax.set_xlabel(SPEED)
        whole_marks(ax)
    letters(axes, titles)
    _legend(figure, study, has_drive=bool(moving))
    return figure


def _moving(study: xr.Dataset, by: str) -> list[Any]:
    """Return the discs whose surface moves somewhere in the study."""
    if "surface_speed" not in study:
        return []
    return [name for name in study[by].values if (study["surface_speed"].sel({by: name}) > 0).any()]


def _draw_lost_contact(ax: Axes, study: xr.Dataset, plot: LateRange, name: str) -> None:
    """Draw at which range contact is lost, for each preload, and say how many times as large the
    ranges with separation are.

    The vibration is that of the mode with the largest tangential motion, which friction feeds.
    """
    limits = lost_contact(study, name)
    place = LOWEST_NAME  # the lowest line has its name below, where no curve is
    for limit, colour, line in zip(limits, LOAD_COLOURS, LOST, strict=False):
        lost = float(limit) / plot.thickness
        ax.axhline(lost, color=colour, linestyle=line, linewidth=wide(1.0))
        _note(ax, lost, f"contact lost, N = {1e-3 * float(limit['N']):g} kN", place, color=colour)
        place = FURTHER_NAMES
    _say_how_far_beyond(ax, study.sel({plot.by: name}), limits)


def lost_contact(study: xr.Dataset, name: str) -> xr.DataArray:
    """Ranges at which vibration at the frequency of a disc's mode with the largest tangential motion
    loses contact, m, along the preload."""
    disc = json.loads(study.attrs["discs"])[name]
    fed = np.argmax(np.abs(disc["tangential"]))
    frequency = float(disc["omega"][fed]) / (2 * np.pi)
    base = json.loads(study.attrs["base"])
    slider = {key: base[key] for key in ("k", "m", "c")}
    limits = []
    for load in study["N"].values.tolist():
        p = Parameters(N=load, Omega=1.0, **slider)
        limits.append(pinned_range(p, frequency))
    return xr.DataArray(limits, {"N": study["N"].values}, ("N",))


def _say_how_far_beyond(ax: Axes, study: xr.Dataset, limits: xr.DataArray) -> None:
    """Say between which multiples of the ranges at which contact is lost those with separation
    lie."""
    multiples = (study["u_max"] - study["u_min"]) / limits
    separates = flag_names(study["outcome"]) == "separation"
    found = multiples.where(study["outcome"].copy(data=separates)).values
    found = found[np.isfinite(found)]
    if found.size:
        factors = " to ".join(dict.fromkeys(f"{end:.2g}" for end in (found.min(), found.max())))
        text = f"with separation: {factors} times\nthe range at which\ncontact is lost"
        look: dict[str, Any] = {"va": "top", "ha": "right", "size": large(7)}
        look |= {"path_effects": halo(), "zorder": 5}
        ax.annotate(text, (0.98, BELOW_LINES), xycoords="axes fraction", **look)


def _note(ax: Axes, height: float, text: str, place: tuple[float, str, str], **look: Any) -> None:
    """Name a horizontal line at a place, and on the side of it that is given by alignments."""
    across, ha, va = place
    look = {"size": large(6), "ha": ha, "va": va, **look}
    gap = -FROM_LINE if va == "top" else FROM_LINE
    place_of: dict[str, Any] = {
        "xycoords": ("axes fraction", "data"),
        "textcoords": "offset points",
    }
    ax.annotate(text, (across, height), (0, gap), **place_of, **look)


def _lines_of(contacts: np.ndarray) -> dict[str, str]:
    """Dashes of the lines of the contacts that a study has."""
    return {contact: line for contact, line in LINES.items() if contact in contacts}


def _marks() -> dict[str, dict[str, Any]]:
    """Marks of what has become of the motion."""
    plain: dict[str, Any] = {"linestyle": "", "marker": "o", "markersize": mark(3)}
    hollow = {"markerfacecolor": "white"}
    return {
        "separates": plain,
        "growing or undecided": {**plain, "marker": "^", "markersize": mark(5), **hollow},
        "settled in contact": {**plain, **hollow},
    }


def _draw_panel(ax: Axes, ranges: xr.DataArray, outcomes: xr.DataArray) -> None:
    """Draw lines over the speed for each preload and contact, with marks of their outcomes."""
    speeds = ranges["Omega"].values
    loads = ranges["N"].values
    for load, colour, width in zip(loads, LOAD_COLOURS, LOAD_WIDTHS, strict=False):
        for contact, line in _lines_of(ranges["contact"].values).items():
            chosen = {"N": load, "contact": contact}
            heights = ranges.sel(chosen).values
            words = outcomes.sel(chosen).values
            ax.plot(speeds, heights, line, color=colour, linewidth=wide(width))
            separates = words == "separation"
            open_end = np.isin(words, OPEN_END)
            masks = (separates, open_end, ~(separates | open_end))
            for mask, look in zip(masks, _marks().values(), strict=True):
                ax.plot(speeds, np.where(mask, heights, np.nan), color=colour, **look)


def _legend(figure: Figure, study: xr.Dataset, has_drive: bool) -> None:
    """Name preloads, contacts, marks, the grey band and the speed of the drive below the panels."""
    handles = []
    for load, colour, width in zip(study["N"].values, LOAD_COLOURS, LOAD_WIDTHS, strict=False):
        said = f"N = {1e-3 * load:g} kN"
        handles.append(sample(color=colour, linewidth=wide(width), label=said))
    for contact, line in _lines_of(study["contact"].values).items():
        handles.append(sample(color=GREY, linestyle=line, label=CONTACTS[contact]))
    for name, look in _marks().items():
        handles.append(sample(color=GREY, label=name, **look))
    handles.append(Patch(color=BEYOND, label="beyond linear plate theory"))
    if has_drive:
        handles.append(sample(color=GREY, linestyle=":", label="friction reverses above"))
    figure_legend(figure, handles, loc="outside lower center", columns=4, columnspacing=1.0)
