"""Probability of instability against each uncertain parameter."""

import math
from collections.abc import Iterator, Mapping
from itertools import product
from typing import Any, Literal

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
from disc_model.errors import Fault
from disc_model.figures import drawing
from disc_model.figures.drawing import BLACK, BLUE, GREY, PAGE, Figure, panels
from disc_model.figures.kind import Plot, Values

MOST_PANELS = 4
"""Greatest number of points that a figure shows."""
BINS = 3
"""Number of parts, with equal numbers of draws, of a parameter's distribution."""


class Sensitivity(Plot):
    """Probability of instability in the lowest and in the highest third of each parameter; for up to four points."""

    quantities = ("sensitivity",)
    several = True

    kind: Literal["sensitivity"] = "sensitivity"

    def _wrong_dims(self, values: Values) -> Iterator[Fault]:
        points = math.prod(len(along) for name, along in values.items() if name != SAMPLE)
        if points > MOST_PANELS:
            rule = f"has room for {MOST_PANELS} points beside their samples, not {points}"
            yield Fault.of(("kind",), self.kind, rule)

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw a panel for each point and a row for each parameter, those above that change most somewhere.

        Bars are 95 % intervals; the dashed line is the probability at all values.
        """
        cells = list(cells_of(study))
        names = [str(name) for name in study["parameter"].values]
        names.sort(
            key=lambda name: max(abs(float(np.diff(probabilities(cell, name)[[0, -1], 0])[0])) for _, cell in cells)
        )
        figure, axes = panels(PAGE, 1.2 + 0.2 * len(names), 1, len(cells), sharey=True)
        for ax, (title, cell) in zip(axes, cells, strict=True):
            ax.axvline(float(cell["probability_unstable"]), color=BLACK, linewidth=0.7, linestyle=(0, (3, 2)))
            thirds = np.array([probabilities(cell, name) for name in names])
            rows = np.arange(len(names), dtype=float)
            ax.hlines(rows, thirds[:, 0, 0], thirds[:, -1, 0], color=GREY, linewidth=0.8)
            for end, up, face, label in ((0, -0.12, "white", "lowest third"), (-1, 0.12, BLUE, "highest third")):
                value, low, high = thirds[:, end].T
                look: dict[str, Any] = {"fmt": "o", "color": BLUE, "markerfacecolor": face, "markersize": 4}
                bars = np.maximum([value - low, high - value], 0.0)  # rounding
                ax.errorbar(value, rows + up, xerr=bars, elinewidth=0.8, label=f"{label} of its values", **look)
            ax.set(xlabel="P(unstable)", xlim=(-0.03, 1.03), ylim=(-0.6, len(names) - 0.4))
            ax.set_title("\n".join(title.replace("Preload ", "").replace("Speed ", "").split(", ")), loc="left")
        axes[0].set_ylabel("Parameter")
        axes[0].set_yticks(rows, labels=[typeset(presentation_of(name)[1]) or name.replace("_", " ") for name in names])
        axes[0].minorticks_off()
        figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
        return figure


def probabilities(cell: xr.Dataset, name: str) -> np.ndarray:
    """Probability of instability in each part of a parameter's values, and the ends of its interval: (parts, 3)."""
    values, words = cell["parameter_values"].sel(parameter=name).values, flag_names(cell["cycle"])
    known, unstable = words != "failed", ~np.isin(words, STABLE_CYCLES)
    edges = np.quantile(values, np.linspace(0, 1, BINS + 1))
    part = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, BINS - 1)
    counts = [(int((unstable & known & (part == i)).sum()), int((known & (part == i)).sum())) for i in range(BINS)]
    return np.array([share(*count) for count in counts])


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
