"""Outcomes of many starts: their shares, the attractors, and the critical energy of separation."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.ticker import FixedLocator

from disc_model.data.variables import flag_names
from disc_model.figures.basin_shares import (
    BARS,
    OF_ENERGY,
    STACKED,
    draw_shares,
    explain,
    outcomes_in,
    shares_of,
)
from disc_model.figures.basins_over_energy import draw_over_energies
from disc_model.figures.drawing import (
    BLACK,
    GREY,
    PAGE,
    SEPARATED,
    letters,
    mark,
    mark_failed,
    new_figure,
    plain_decades,
    wide,
)
from disc_model.figures.kinds.motions import ENERGY, BasinShares
from disc_model.figures.legends import legend_above
from disc_model.figures.selection import failed
from disc_model.figures.separating_share import draw_interval, interval_of, share_text
from disc_model.figures.types import Array, Axes, Figure
from disc_model.figures.words import measured

LARGEST = 36.0  # area of the mark of an attractor that all starts reach, square points
AREAS = {"10 %": 0.1, "50 %": 0.5, "all starts": 1.0}
"""Shares of starts that the legend shows."""
OF_DIAMOND = "50 %"  # size of the diamond there
ZERO = 0.04  # height of the marks of critical energies of zero, as a share of the panel
BELOW = 0.1  # share of the panel below the axis for them


def draw(plot: BasinShares, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
    """Draw the fractions for each energy; below, attractors by range, as large as their
    fractions, and energies. Over the energy, draw the fractions alone, for each value of a parameter."""
    if plot.x == ENERGY:
        return draw_over_energies(plot, study)
    study = study.transpose(plot.x, ...)
    across = measured(study[plot.x])
    energies = study["energy"].values
    figure, axes = _panels(plot.inches, len(energies))
    *shares, attractors, kicks = axes

    classes = outcomes_in(shares_of(study, "basin_fraction"))
    by_energy = shares_of(study, OF_ENERGY)
    for ax, energy in zip(shares, energies, strict=True):
        of_energy = by_energy.sel(energy=energy)
        draw_shares(ax, of_energy, classes, across.values)
        of_separating = interval_of(study.sel(energy=energy), OF_ENERGY)
        draw_interval(ax, of_separating, across.values)
        if plot.inches == PAGE:  # below each other, each panel has numbers and names
            ax.label_outer()
    for ax in shares if plot.inches != PAGE else shares[:1]:
        ax.set_ylabel(share_text(study.sizes["start"]))
    _draw_attractors(attractors, study, across.values)
    _draw_kicks(kicks, study, across.values)

    letters(axes, [f"{energy:g} J" for energy in energies])
    for ax in axes:
        ax.margins(x=0.04)
        ax.set_xlabel(across.label)
        mark_failed(ax, across.values[failed(study).values])
    ends = np.transpose([ax.get_xlim() for ax in axes])
    for ax in axes:
        ax.set_xlim(ends[0].min(), ends[1].max())
    explain(figure, study, classes)
    return figure


def _panels(width: float, count: int) -> tuple[Figure, list[Axes]]:
    """A figure with a panel of shares for each energy, and two below; in one column, all below each
    other."""
    if width != PAGE:
        figure = new_figure(width, 1.0 + 1.5 * count + 4.0)
        grid = figure.add_gridspec(count + 2, 1, height_ratios=[1.0] * count + [1.3, 1.3])
        return figure, [figure.add_subplot(grid[i]) for i in range(count + 2)]
    figure = new_figure(width, 4.6)
    above, below = np.asarray(figure.subfigures(2, 1))
    shares = above.subplots(1, count, sharey=True, squeeze=False)[0]
    return figure, [*shares, *below.subplots(1, 2)]


# ---- Attractors


def _draw_attractors(ax: Axes, study: xr.Dataset, along: Array) -> None:
    """Draw the range of the slider on each attractor, mm, with marks as large as its share of all
    starts; diamonds stand for classes with a pattern."""
    study = study.transpose(..., "attractor")
    kinds = flag_names(study["attractor_kind"])
    starts = study["attractor_starts"].values
    ranges = 1e3 * study["attractor_range"].values
    total = study.sizes["energy"] * study.sizes["start"]
    edge: dict[str, Any] = {"edgecolor": BLACK, "linewidth": wide(0.4)}
    for word in STACKED:
        look = BARS[word]
        point, number = np.nonzero((kinds == word) & (starts > 0))
        areas = LARGEST * starts[point, number] / total
        shape = "D" if look.hatch else "o"
        heights = ranges[point, number]
        ax.scatter(along[point], heights, areas, color=look.face, marker=shape, zorder=3, **edge)
    for text, share in AREAS.items():
        ax.scatter([], [], LARGEST * share, facecolor="none", label=text, **edge)
    drawn = [BARS[word] for word in STACKED if ((kinds == word) & (starts > 0)).any()]
    if any(look.hatch for look in drawn):
        area = LARGEST * AREAS[OF_DIAMOND]
        diamond: dict[str, Any] = {"marker": "D", "facecolor": "none", **edge}
        ax.scatter([], [], area, label="class with a pattern", **diamond)
    legend_above(ax)
    ax.set_ylabel("Slider range (mm)")
    if np.any(ranges > 0):
        ax.set_yscale("log")
        plain_decades(ax.yaxis)


# ---- Energies


def _draw_kicks(ax: Axes, study: xr.Dataset, along: Array) -> None:
    """Draw the critical energy by bisection, the lowest separating energy of the starts, and all
    their energies."""
    label = "energies of the starts"
    for energy in study["energy"].values:
        ax.axhline(energy, color=GREY, linestyle=":", linewidth=wide(0.6), zorder=0, label=label)
        label = "_nolegend_"
    sample = study["critical_energy_sampled"].values
    bound = study["critical_energy"].values
    ax.plot(along, sample, "_", color=BLACK, markersize=mark(6), label="least that separates")
    shown = np.where(bound > 0, bound, np.nan)
    ax.plot(along, shown, "v-", color=SEPARATED, markersize=mark(3.5), label="by bisection")
    ax.set_ylabel("Critical energy (J)")
    if np.any(sample > 0):
        ax.set_yscale("log")
        plain_decades(ax.yaxis)
        _mark_zeros(ax, along[bound == 0])
    legend_above(ax, columns=2, columnspacing=0.7, handlelength=1.0, handletextpad=0.4)


def _mark_zeros(ax: Axes, places: Array) -> None:
    """Mark critical energies of zero, which have no place on a logarithmic scale, below its end."""
    if not places.size:
        return
    low, high = ax.get_ylim()
    ax.set_ylim(low * (low / high) ** (BELOW / (1 - BELOW)), high)
    ax.spines["left"].set_bounds(low, high)
    plain_decades(ax.yaxis, least=low)
    between = ax.get_yticks(minor=True)
    ax.yaxis.set_minor_locator(FixedLocator(between[between >= low].tolist()))
    ax.plot(
        places,
        np.full(places.size, ZERO),
        "v",
        color=SEPARATED,
        markersize=mark(3.5),
        markerfacecolor="white",
        transform=ax.get_xaxis_transform(),
        label="zero",
    )
