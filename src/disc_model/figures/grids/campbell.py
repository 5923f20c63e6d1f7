"""Campbell diagrams: frequencies of steady sliding and of the stick-slip cycle over the speed, and what meets where."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from disc_model.data.variables import flag_names
from disc_model.figures import parts
from disc_model.figures.grids.kinds import Campbell
from disc_model.figures.parts import (
    BLACK,
    BLUE,
    BROWN,
    COLUMN,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    SKY,
    VERMILION,
    new_figure,
    styled,
)

COLOURS = (GREEN, BLUE, ORANGE, PURPLE, SKY, BROWN)
"""Of modes by their nodal diameters; those of six or more as those of six fewer."""
NOTED = ("rises", "destabilises", "no_cycle")
"""Effects of a crossing that are numbered."""
SPAN = (-1.1, 0.6)
"""1/s: growth rates that the lower panel shows."""


@styled()
def draw(study: xr.Dataset, others: Mapping[str, xr.Dataset], plot: Campbell) -> Figure:
    """(a) frequencies, (b) growth rates by mode; crossings at which the cycle suffers are numbered and said below."""
    study = parts.of(study, plot.normalization or parts.normalizations(study)[0]).transpose("Omega", ...)
    met = noted(study)
    heights = [3.2, 1.7, 0.105 * max(len(met), 1)]
    figure = new_figure(COLUMN, sum(heights) + 1.6)
    top, bottom, below = figure.subplots(3, 1, height_ratios=heights)
    _frequencies(top, study)
    _growth_rates(bottom, study)
    for ax in (top, bottom):
        ax.set_xlim(float(study["Omega"][0]), float(study["Omega"][-1]))
        for one in met:
            ax.axvline(one.Omega, color=GREY, linewidth=0.4, zorder=0)
    _crossings(top, study, met)
    bottom.set_xlabel(parts.axis_of("Omega")[0])
    below.set_axis_off()
    said = "\n".join(f"{i}  {one.said}" for i, one in enumerate(met, 1)) or "no crossing at which the cycle suffers"
    below.text(-0.12, 1, said, fontsize=6, va="top", transform=below.transAxes, linespacing=1.25)
    figure.legend(handles=_handles(study), loc="outside lower center", ncols=3)
    if plot.title:
        figure.suptitle(plot.title, fontsize=8)
    return figure


class Noted(NamedTuple):
    """A crossing at which a growth rate rises or the cycle ends."""

    Omega: float
    frequency: float
    said: str


def noted(study: xr.Dataset) -> list[Noted]:
    """Of one normalization."""
    effects, lines = flag_names(study["crossing_effect"]), flag_names(study["crossing_line"])
    found = []
    for i in np.flatnonzero(np.isin(effects, NOTED)):
        one = study.isel(crossing=i)
        multiple = f"{float(one['crossing_multiple']):g} " + ("$f_s$" if lines[i] == "stick_slip" else r"$f_\Omega$")
        speed, frequency = float(one["crossing_Omega"]), float(one["crossing_frequency"])
        there = study.sel(Omega=speed, method="nearest")
        mode = there.sel(mode=int(one["crossing_mode"]))
        l = int(mode["diameters"]) if flag_names(mode["mode_kind"]) == "disc" else -1
        met = f"{speed:.2f} rad/s: {multiple} = {frequency:.1f} Hz ({_mode(l)}): {effects[i].replace('_', ' ')}"
        if effects[i] != "no_cycle":
            growing = float(there["sliding_frequency"].sel(mode=int(one["crossing_growing_mode"])))
            met += f", {growing:.0f} Hz by {float(one['crossing_rise']):.2g}/s"
        found.append(Noted(speed, frequency, met))
    return found


def _mode(l: int) -> str:
    return "slider in the plane" if l < 0 else f"l = {l}"


def _colour(l: int) -> str:
    return BLACK if l < 0 else COLOURS[l % len(COLOURS)]


def _parts(study: xr.Dataset, name: str) -> list[tuple[int, np.ndarray]]:
    """A variable by mode, cut where the diameters of its number change: those and the values, nan elsewhere."""
    kinds, diameters = flag_names(study["mode_kind"]), study["diameters"].values
    found = []
    for i in range(study.sizes["mode"]):
        own = np.where(kinds[:, i] == "disc", diameters[:, i], -1)
        there = kinds[:, i] != "none"
        for l in np.unique(own[there]):
            found.append((int(l), np.where(there & (own == l), study[name].values[:, i], np.nan)))
    return found


def _frequencies(ax: Axes, study: xr.Dataset) -> None:
    speeds = study["Omega"].values
    for l, values in _parts(study, "sliding_frequency"):
        ax.plot(speeds, values, color=_colour(l), linewidth=0.9)
    thin = slice(None, None, max(1, len(speeds) // 40))
    for l, values in _parts(study, "cycle_frequency"):
        ax.plot(speeds[thin], values[thin], ".", color=_colour(l), markersize=2.5)
    highest = 1.06 * float(study["sliding_frequency"].max())
    ax.set_ylim(0, highest)
    rate = study["stick_slip_frequency"].values
    known = np.flatnonzero(np.isfinite(rate))
    if known.size:
        last = rate[known[-1]]
        for n in range(1, int(highest / last) + 1):
            ax.plot(speeds, n * rate, color=GREY, linewidth=0.6, linestyle=(0, (4, 2)), zorder=0)
            _beside(ax, n * last, "$f_s$" if n == 1 else f"{n} $f_s$")
    turns = study["rotation_frequency"].values
    most = int(study["diameters"].max())
    for l in range(1, most + 1):
        ax.plot(speeds, l * turns, color=GREY, linewidth=0.4, linestyle=":", zorder=0)
    if most:
        _beside(ax, most * turns[-1] / 2, rf"$f_\Omega$..{most} $f_\Omega$" if most > 1 else r"$f_\Omega$")
    ax.set_ylabel("Frequency in the slider's frame (Hz)")
    ax.set_title("(a)", loc="left", pad=16)


def _beside(ax: Axes, height: float, text: str) -> None:
    """A line's name at its right end, outside of the panel."""
    ax.annotate(
        text, (1, height), xycoords=("axes fraction", "data"), xytext=(2, 0), textcoords="offset points", va="center",
        fontsize=6, color=GREY,
    )  # fmt: skip


def _growth_rates(ax: Axes, study: xr.Dataset) -> None:
    speeds = study["Omega"].values
    for l, values in _parts(study, "cycle_growth_rate"):
        ax.plot(speeds, values, color=_colour(l), linewidth=0.8)
    ax.axhline(0, color=BLACK, linewidth=0.5)
    gone = ~np.isfinite(study["growth_rate"].values)
    ax.fill_between(
        speeds,
        0,
        1,
        where=gone,
        step="mid",
        transform=ax.get_xaxis_transform(),
        color=VERMILION,
        alpha=0.25,
        linewidth=0,
    )
    ax.set(ylim=SPAN, ylabel="Cycle's growth rates (1/s)")
    parts.letter(ax, "b")


def _crossings(ax: Axes, study: xr.Dataset, met: list[Noted]) -> None:
    """Small open circles at all that were found, full ones and numbers above the panel at those that matter."""
    ax.plot(
        study["crossing_Omega"], study["crossing_frequency"], "o", color=BLACK, markersize=2.2, markerfacecolor="white",
        markeredgewidth=0.5,
    )  # fmt: skip
    ax.plot([one.Omega for one in met], [one.frequency for one in met], "o", color=VERMILION, markersize=3)
    low, high = ax.get_xlim()
    places = spread([one.Omega for one in met], 0.055 * (high - low), low, high)
    for i, (one, place) in enumerate(zip(met, places, strict=True), 1):
        ax.annotate(
            str(i), (one.Omega, 1), xycoords=("data", "axes fraction"), xytext=(place, 1.03),
            textcoords=("data", "axes fraction"), ha="center", va="bottom", fontsize=6, color=VERMILION,
            arrowprops={"arrowstyle": "-", "linewidth": 0.4, "color": GREY, "shrinkA": 0, "shrinkB": 0},
        )  # fmt: skip


def spread(places: list[float], apart: float, low: float, high: float) -> list[float]:
    """Ascending places, as far apart as they need or as there is room, within bounds and near to where they were."""
    if not places:
        return []
    apart = min(apart, (high - low) / max(len(places) - 1, 1))
    steps = apart * np.arange(len(places))
    # places less steps need only not fall: the nearest such are running means of what is out of order
    blocks: list[list[float]] = []
    for place in np.asarray(places) - steps:
        blocks.append([place])
        while len(blocks) > 1 and np.mean(blocks[-2]) > np.mean(blocks[-1]):
            blocks[-2:] = [blocks[-2] + blocks[-1]]
    level = np.repeat([np.mean(block) for block in blocks], [len(block) for block in blocks])
    return (np.clip(level, low, high - steps[-1]) + steps).tolist()  # type: ignore[no-any-return]


def _handles(study: xr.Dataset) -> list[Line2D]:
    shown = sorted({l for l, _ in _parts(study, "sliding_frequency")})
    handles = [Line2D([], [], color=_colour(l), label=_mode(l)) for l in shown]
    return [
        *handles,
        Line2D([], [], color=BLACK, marker=".", linestyle="", markersize=4, label="stick-slip cycle"),
        Line2D([], [], color=VERMILION, alpha=0.25, linewidth=6, label="no cycle found"),
        Line2D(
            [], [], color=BLACK, marker="o", linestyle="", markersize=2.5, markerfacecolor="white", label="crossing"
        ),
    ]
