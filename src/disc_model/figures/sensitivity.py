"""Probability of instability against each uncertain parameter."""

import math
from collections.abc import Iterator, Mapping
from itertools import product
from typing import Any, Literal

import numpy as np
import xarray as xr

from disc_model.data.variables import (
    EXCLUDED,
    SAMPLE,
    STABLE_CYCLES,
    flag_names,
    presentation_of,
    stated_in,
    typeset,
)
from disc_model.errors import Fault
from disc_model.figures import drawing
from disc_model.figures.drawing import BLACK, BLUE, PAGE, Axes, Figure, new_figure
from disc_model.figures.kind import Plot, Values

MOST_PANELS = 4
"""Greatest number of points that a figure shows."""
BINS = 3
"""Number of parts, with equal numbers of draws, of a parameter's distribution."""


class Sensitivity(Plot):
    """Probabilities with their intervals, and Sobol indices of each distributed parameter; for up to four points."""

    quantities = ("sensitivity",)
    several = True

    kind: Literal["sensitivity"] = "sensitivity"

    def _wrong_dims(self, values: Values) -> Iterator[Fault]:
        points = math.prod(len(along) for name, along in values.items() if name != SAMPLE)
        if points > MOST_PANELS:
            rule = f"has room for {MOST_PANELS} points beside their samples, not {points}"
            yield Fault.of(("kind",), self.kind, rule)

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw a row for each point and a panel for each parameter: probability of instability in thirds of its values.

        Bars are 95 % intervals; the dashed line is the probability at all values.
        """
        cells, names = list(cells_of(study)), [str(name) for name in study["parameter"].values]
        figure = new_figure(PAGE, 0.6 + 1.5 * len(cells))
        separates = f"separates within {stated_in(study, 'options')['horizon']:g} s"
        for part, (title, cell) in zip(figure.subfigures(len(cells), 1, squeeze=False)[:, 0], cells, strict=True):
            axes = part.subplots(1, len(names), sharey=True, squeeze=False)[0]
            for ax, name in zip(axes, names, strict=True):
                _panel(ax, cell, name)
            phrase = "; ".join(
                f"{what} {float(cell[key]):.2f} ({float(cell[f'{key}_low']):.2f} to {float(cell[f'{key}_high']):.2f})"
                for what, key in (("unstable", "probability_unstable"), (separates, "probability_separation"))
                if np.isfinite(cell[key])
            )
            part.suptitle(f"{title}, {phrase}", x=0.01, ha="left", fontsize=8)
            axes[0].set_ylabel("P(unstable)")
        figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
        return figure


def probabilities(cell: xr.Dataset, name: str) -> np.ndarray:
    """Probability of instability in each part of a parameter's values: middle, probability, standard error; (3, parts).

    The draws A and B count, as in the probability at all values; errors are those of samples.
    """
    draws = cell["parameter_values"].sel(parameter=name).transpose(SAMPLE, "sample_matrix").values
    words = flag_names(cell["cycle"].sel(variant=["A", "B"]).transpose(SAMPLE, "variant"))
    known = words != "failed"
    unstable = ~np.isin(words, STABLE_CYCLES)
    edges = np.quantile(draws, np.linspace(0, 1, BINS + 1))
    part = np.clip(np.searchsorted(edges, draws, side="right") - 1, 0, BINS - 1)
    handles = []
    for i in range(BINS):
        mask = known & (part == i)
        count, hits = mask.sum(axis=1), (mask & unstable).sum(axis=1)
        share = hits.sum() / count.sum()
        handles.append((edges[i : i + 2].mean(), share, np.sqrt(np.sum((hits - share * count) ** 2)) / count.sum()))
    return np.transpose(handles)


def _panel(ax: Axes, cell: xr.Dataset, name: str) -> None:
    middle, share, error = probabilities(cell, name)
    whole = float(cell["probability_unstable"])
    ax.axhline(whole, label="all values", color=BLACK, linewidth=0.7, linestyle=(0, (3, 2)))
    look: dict[str, Any] = {"fmt": "o", "color": BLUE, "markersize": 2.5, "capsize": 1.5}
    half = np.minimum(1.96 * error, [share, 1 - share])
    ax.errorbar(middle, share, half, label="a third of the values, with its interval", **look)
    ends = np.quantile(cell["parameter_values"].sel(parameter=name), [0, 1])
    _, symbol, unit, factor = presentation_of(name)
    label = typeset(symbol) or name.replace("_", " ")
    ax.set_xticks(ends, labels=[f"{end * factor:.3g}" for end in ends], fontsize=6)
    for text, side in zip(ax.get_xticklabels(), ("left", "right"), strict=True):  # clear of the neighbours
        text.set(horizontalalignment=side)
    ax.minorticks_off()
    ax.set(xlabel=f"{label}\n({unit})" if unit else label, ylim=(-0.03, 1.03))


def cells_of(study: xr.Dataset) -> Iterator[tuple[str, xr.Dataset]]:
    """Name and values of each point of the grid that has samples left, without the dimension of samples."""
    dims = [str(dim) for dim in study["status"].dims if dim != SAMPLE]
    for index in product(*(range(study.sizes[dim]) for dim in dims)):
        cell = study.isel(dict(zip(dims, index, strict=True)))
        cell = cell.isel({SAMPLE: flag_names(cell["status"]) != EXCLUDED})
        if not cell.sizes[SAMPLE]:
            continue
        names = [str(name) for name in study.coords if study[name].dims and set(study[name].dims) <= set(dims)]
        yield ", ".join(drawing.coordinate_text(cell[name], name) for name in names), cell
