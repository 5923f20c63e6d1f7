"""What many starts come to: shares with intervals, the attractors, and the least kick that leads to separation."""

from __future__ import annotations

import json
from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from disc_model.data.variables import flag_names
from disc_model.figures import parts
from disc_model.figures.kinds import BasinShares
from disc_model.figures.parts import (
    BLACK,
    BLUE,
    BROWN,
    COLUMN,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    SEPARATED,
    SKY,
    new_figure,
)

COLOURS = {
    "quiet": BLUE,
    "other_cycle": ORANGE,
    "separating": SEPARATED,
    "quasi_periodic": SKY,
    "irregular": BROWN,
    "sliding": PURPLE,
    "resting": GREEN,
    "undecided": GREY,
    "failed": BLACK,
}
SAID = {"other_cycle": "another cycle in contact", "quasi_periodic": "quasi-periodic"}
LARGEST = 36.0
"""Area of the mark of an attractor that all starts reach, square points."""
ASIDE = 0.06
"""Marks of different fates stand beside each other, by this share of the least step."""


def draw(study: xr.Dataset, others: Mapping[str, xr.Dataset], plot: BasinShares) -> Figure:
    """(a) shares of all starts; (b) range of each attractor, its mark as large as its share; (c) kicks."""
    study = parts.of_one(study, {})[1].transpose(plot.x, ...)
    label, factor = parts.label_of(study[plot.x])
    along = study[plot.x].values * factor
    figure = new_figure(COLUMN, 5.6)
    axes = figure.subplots(3, 1, sharex=True, height_ratios=(1.2, 1, 1))
    fates = [fate for fate in COLOURS if (study["share"].sel(fate=fate) > 0).any()]
    _shares(axes[0], study, along, fates)
    _attractors(axes[1], study, along)
    _kicks(axes[2], study, along)
    for ax, letter in zip(axes, "abc", strict=True):
        ax.margins(x=0.04)
        parts.mark_failed(ax, along[parts.failed(study).values])
        parts.letter(ax, letter)
    axes[-1].set_xlabel(label)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    parts.head(figure, study, plot.title)
    return figure


def _shares(ax: Axes, study: xr.Dataset, along: np.ndarray, fates: list[str]) -> None:
    options = json.loads(study.attrs["options"])
    said = SAID | {"undecided": f"undecided after {options['horizon']:g} s"}
    step = np.diff(along).min() if len(along) > 1 else 0.0
    for i, fate in enumerate(fates):
        one = study.sel(fate=fate)
        share = one["share"].values
        bounds = np.abs(np.stack([share - one["share_low"].values, one["share_high"].values - share]))
        aside = ASIDE * step * (i - (len(fates) - 1) / 2)
        ax.errorbar(
            along + aside, share, bounds, fmt="o-", color=COLOURS[fate], markersize=2.5, linewidth=0.8, elinewidth=0.6,
            label=said.get(fate, fate),
        )  # fmt: skip
    ax.set(ylim=(-0.03, 1.03), ylabel=f"Share, {100 * options['confidence']:g} % interval")


def _attractors(ax: Axes, study: xr.Dataset, along: np.ndarray) -> None:
    kinds = flag_names(study["attractor_kind"].transpose(..., "attractor"))
    starts = study["attractor_starts"].transpose(..., "attractor").values
    ranges = 1e3 * study["attractor_range"].transpose(..., "attractor").values
    total = study.sizes["energy"] * study.sizes["start"]
    for fate, colour in COLOURS.items():
        point, number = np.nonzero((kinds == fate) & (starts > 0))
        area = LARGEST * starts[point, number] / total
        ax.scatter(along[point], ranges[point, number], area, color=colour, linewidth=0, zorder=3)
    ax.set(ylabel="Range of the slider (mm)")
    if np.any(ranges > 0):
        ax.set_yscale("log")


def _kicks(ax: Axes, study: xr.Dataset, along: np.ndarray) -> None:
    """The least kick by bisection; the least among the starts; and their energies."""
    for i, energy in enumerate(study["energy"].values):
        label = "kicks tried" if i == 0 else "_nolegend_"
        ax.axhline(energy, color=GREY, linestyle=":", linewidth=0.6, zorder=0, label=label)
    sample, found = study["least_kick_sample"].values, study["least_kick"].values
    ax.plot(along, sample, "_", color=BLACK, markersize=6, label="least of them")
    ax.plot(along, np.where(found > 0, found, np.nan), "v-", color=SEPARATED, markersize=3.5, label="by bisection")
    ax.set(ylabel="Least kick that\nseparates (J)")
    if np.any(sample > 0):
        ax.set_yscale("log")
        # what separates without a kick has no place on this scale
        for place in along[found == 0]:
            ax.text(
                place, 0.02, "0", color=SEPARATED, fontsize=7, ha="center", va="bottom",
                transform=ax.get_xaxis_transform(),
            )  # fmt: skip
    parts.legend_above(ax, columnspacing=0.9)
