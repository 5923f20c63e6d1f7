"""Probability of instability against each uncertain parameter."""

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

from disc_model.analysis.classify import share
from disc_model.data.variables import (
    EXCLUDED,
    SAMPLE,
    STABLE_CYCLES,
    flag_names,
    presentation_of,
    typeset,
)
from disc_model.display import counted
from disc_model.figures.drawing import BLACK, BLUE, GREY, mark, row_of_panels, sample, wide
from disc_model.figures.kinds.motions import Sensitivity
from disc_model.figures.legends import figure_legend
from disc_model.figures.types import Array, Axes, Figure
from disc_model.figures.value_texts import named_value

BINS = 3  # number of parts, with equal numbers of draws, of a parameter's distribution
FAILED = "failed"  # word of a sample whose search for a cycle failed
ASIDE = 0.12  # of a row, by which both ends of a parameter lie above and below it


class Cell(NamedTuple):
    """A point of the grid: its name, and its samples."""

    name: str
    samples: xr.Dataset


def draw(plot: Sensitivity, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
    """Draw rows with 95 % intervals, those above that change most; the line is the probability
    at all values."""
    cells = list(cells_of(study))
    names = [str(name) for name in study["parameter"].values]
    each = np.array([[probabilities(cell.samples, name) for name in names] for cell in cells])
    lowest = each[:, :, 0, 0]
    highest = each[:, :, -1, 0]
    change = np.abs(highest - lowest).max(axis=0)
    order = change.argsort(kind="stable")
    names = [names[i] for i in order]

    width = plot.inches
    height = 1.35 + 0.2 * len(names)
    figure, axes = row_of_panels(width, len(cells), height, height, sharey=True, sharex=True)
    for ax, cell, thirds in zip(axes, cells, each[:, order], strict=True):
        _draw_rows(ax, thirds, float(cell.samples["probability_unstable"]))
        title = cell.name.replace("Preload ", "").replace("Speed ", "")
        ax.set_title("\n".join(title.split(", ")), loc="left")
        ax.set_ylabel("Parameter")
        ax.label_outer()
    labels = [typeset(presentation_of(name)[1]) or name.replace("_", " ") for name in names]
    axes[0].set_yticks(range(len(names)), labels=labels)
    axes[0].minorticks_off()
    handles = axes[0].get_legend_handles_labels()[0]
    handles.append(sample(color=BLUE, linewidth=wide(0.8), label=_interval_text(cells)))
    figure_legend(figure, handles, loc="outside lower center", columns=4)
    return figure


def _interval_text(cells: Sequence[Cell]) -> str:
    """What the legend says of intervals: also how many samples failed, if any did."""
    words = np.concatenate([flag_names(cell.samples["cycle"]) for cell in cells])
    failed = int((words == FAILED).sum())
    if not failed:
        return "95 % interval"
    return f"95 % interval, which holds {failed} failed of {counted(words.size, 'sample')}"


def _draw_rows(ax: Axes, thirds: Array, at_all: float) -> None:
    """Draw the probabilities in the lowest and highest third of each parameter, shape
    (parameters, parts, 3), and the one at all values."""
    rows = np.arange(len(thirds), dtype=float)
    ax.axvline(
        at_all, color=BLACK, linewidth=wide(0.7), linestyle=(0, (3, 2)), label="all of its values"
    )
    ax.hlines(rows, thirds[:, 0, 0], thirds[:, -1, 0], color=GREY, linewidth=wide(0.8))
    for end, up, face, label in (
        (0, -ASIDE, "white", "lowest third of its values"),
        (-1, ASIDE, BLUE, "highest third of its values"),
    ):
        value, low, high = thirds[:, end].T
        bars = np.maximum([value - low, high - value], 0.0)  # rounding
        ax.errorbar(
            value,
            rows + up,
            xerr=bars,
            label=label,
            fmt="o",
            color=BLUE,
            markerfacecolor=face,
            markersize=mark(4),
            elinewidth=wide(0.8),
        )
    ax.set_xlabel("P(unstable)")
    ax.set_xlim((-0.03, 1.03))
    ax.set_ylim((-0.6, len(rows) - 0.4))


# ---- Selection


def probabilities(samples: xr.Dataset, name: str) -> Array:
    """Probability of instability in each part of a parameter's values, and the ends of its
    interval, in which failed samples count as either: (parts, 3)."""
    values = samples["parameter_values"].sel(parameter=name).values
    words = flag_names(samples["cycle"])
    known = words != FAILED
    unstable = known & ~np.isin(words, STABLE_CYCLES)
    borders = np.quantile(values, np.linspace(0, 1, BINS + 1))
    part = np.clip(np.searchsorted(borders, values, side="right") - 1, 0, BINS - 1)
    rows = []
    for i in range(BINS):
        inside = part == i
        hits = int((unstable & inside).sum())
        rows.append(share(hits, int((known & inside).sum()), int((inside & ~known).sum())))
    return np.array(rows)


def cells_of(study: xr.Dataset) -> Iterator[Cell]:
    """Each point of the grid that has samples left."""
    dims = [str(dim) for dim in study["status"].dims if dim != SAMPLE]
    names = _coordinates_of(study, dims)
    for index in np.ndindex(*(study.sizes[dim] for dim in dims)):
        point = study.isel(dict(zip(dims, index, strict=True)))
        samples = point.isel({SAMPLE: flag_names(point["status"]) != EXCLUDED})
        if samples.sizes[SAMPLE]:
            title = ", ".join(named_value(samples[name], name) for name in names)
            yield Cell(title, samples)


def _coordinates_of(study: xr.Dataset, dims: Sequence[str]) -> list[str]:
    """Names of coordinates along some dimensions alone."""
    return [
        str(name)
        for name, values in study.coords.items()
        if values.dims and {*values.dims} <= {*dims}
    ]
