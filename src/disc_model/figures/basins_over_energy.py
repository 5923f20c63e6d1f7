"""Shares of starts against their energy, with a panel for each value of a parameter."""

import math

import numpy as np
import xarray as xr

from disc_model.figures.basin_shares import OF_ENERGY, draw_shares, explain, outcomes_in, shares_of
from disc_model.figures.drawing import PAGE, letters, mark_failed, panels
from disc_model.figures.kinds.motions import ENERGY, BasinShares
from disc_model.figures.left_out import parts_shown, titles_of_panels
from disc_model.figures.selection import failed, without_single
from disc_model.figures.separating_share import draw_interval, interval_of, share_text
from disc_model.figures.types import Figure
from disc_model.figures.words import measured

IN_A_ROW = 4  # panels over the energy on a page
OF_ROW = 1.7  # height of a row of them, inch,
OF_LEGEND = 0.7  # and of what is below them


def draw_over_energies(plot: BasinShares, study: xr.Dataset) -> Figure:
    """Draw the fractions against the energy, with a panel for each value of a parameter."""
    parts = parts_shown(study, plot.by, plot.names)
    columns = 1
    width = plot.inches_of(len(parts))
    if width == PAGE:
        columns = math.ceil(len(parts) / math.ceil(len(parts) / IN_A_ROW))
    rows = math.ceil(len(parts) / columns)
    height = OF_LEGEND + OF_ROW * rows
    figure, axes = panels(width, height, rows, columns, sharex=True, sharey=True)
    for ax in axes[len(parts) :]:
        ax.remove()
    axes = axes[: len(parts)]
    classes = outcomes_in(shares_of(study, OF_ENERGY))
    places = np.arange(study.sizes[ENERGY], dtype=float)  # one of the energies may be 0
    for ax, part in zip(axes, parts, strict=True):
        point = without_single(part.data, ENERGY, "start")
        draw_shares(ax, shares_of(point, OF_ENERGY), classes, places)
        draw_interval(ax, interval_of(point, OF_ENERGY), places)
        ax.set_xticks(places, [f"{energy:g}" for energy in study[ENERGY].values])
        ax.set_xlabel(measured(study[ENERGY]).label)
        ax.set_ylabel(share_text(study.sizes["start"]))
        ax.margins(x=0.04)
        mark_failed(ax, places[np.broadcast_to(failed(point).values, places.shape)])
        ax.label_outer()
    for ax in axes[-columns:]:  # below some of them there is none
        ax.set_xlabel(measured(study[ENERGY]).label)
        ax.tick_params(labelbottom=True)
    letters(axes, titles_of_panels(parts, study, plot.by))
    explain(figure, study, classes)
    return figure
