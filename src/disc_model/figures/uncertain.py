"""Uncertain starts and parameters: basins of attraction, and probabilities of instability."""

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import Any, Literal

import numpy as np
import xarray as xr

from disc_model.analysis.classify import share
from disc_model.data.variables import EXCLUDED, SAMPLE, STABLE_CYCLES, flag_names, presentation_of, stated_in, typeset
from disc_model.errors import Fault
from disc_model.figures import drawing
from disc_model.figures.drawing import BLACK, BLUE, GREY, PAGE, SEPARATED, Axes, Figure, panels
from disc_model.figures.kind import Plot, Values
from disc_model.figures.maps import OUTCOME_LOOKS, Look, patches

LOOKS = {  # of outcomes, as in maps; a hatch where another one is as dark in grey print
    "quiet": OUTCOME_LOOKS["quiet"],
    "other_cycle": OUTCOME_LOOKS["other_cycle"],
    "separating": OUTCOME_LOOKS["separation"]._replace(label="separating"),
    "quasi_periodic": Look("quasi-periodic", "#b5dcf2", 4 * "\\"),
    "irregular": Look("irregular", drawing.BROWN, 4 * "/"),
    **{name: OUTCOME_LOOKS[name] for name in ("steady_sliding", "at_rest", "undecided", "failed")},
}
LARGEST = 36.0  # area of the mark of an attractor that all starts reach, square points


class BasinShares(Plot):
    """Outcomes of many starts, the attractors, and the critical energy of separation, against a parameter."""

    quantities = ("basins",)
    kind: Literal["basins"] = "basins"
    x: str

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw the fractions for each energy; below, attractors by range, as large as their fractions, and energies."""
        study = study.transpose(self.x, ...)
        (label, along), energies = drawing.along(study[self.x]), study["energy"].values
        figure = drawing.new_figure(PAGE, 4.6)
        above, below = np.asarray(figure.subfigures(2, 1))
        axes = [*above.subplots(1, len(energies), sharey=True, squeeze=False)[0], *below.subplots(1, 2)]
        classes = outcomes_in(study["basin_fraction"])
        for ax, energy in zip(axes, energies, strict=False):
            draw_shares(ax, study["basin_fraction_by_energy"].sel(energy=energy), classes, along)
        axes[0].set_ylabel(f"Fraction of {study.sizes['start']} starts")
        _attractors(axes[-2], study, along)
        _kicks(axes[-1], study, along)
        drawing.letters(axes, [f"{energy:g} J" for energy in energies])
        for ax in axes:
            ax.margins(x=0.04)
            ax.set_xlabel(label)
            drawing.mark_failed(ax, along[drawing.failed(study).values])
        options = stated_in(study, "options")
        undecided = LOOKS["undecided"]._replace(label=f"undecided after {options['horizon']:g} s")
        handles = patches(LOOKS | {"undecided": undecided}, classes)
        figure.legend(handles=handles, loc="outside lower center", ncols=len(handles))
        return figure


def outcomes_in(shares: xr.DataArray) -> list[str]:
    """The outcomes that occur among the starts, in the order in which their shares are stacked."""
    return [class_ for class_ in LOOKS if (shares.sel(attractor_class=class_) > 0).any()]


def draw_shares(ax: Axes, shares: xr.DataArray, classes: Sequence[str], along: np.ndarray) -> None:
    """Draw the shares of outcomes along another dimension, stacked, as bars at the places `along`."""
    width = 0.9 * np.diff(along).min(initial=1.0)
    shares = shares.sel(attractor_class=[*classes]).transpose("attractor_class", ...)
    below = shares.cumsum("attractor_class") - shares.fillna(0)
    for class_, heights, bottoms in zip(classes, shares, below, strict=True):
        look: dict[str, Any] = {"facecolor": LOOKS[class_].face, "hatch": LOOKS[class_].hatch, "edgecolor": BLACK}
        ax.bar(along, heights, width, bottoms, linewidth=0.4, **look)
    ax.set(ylim=(0, 1))


def _attractors(ax: Axes, study: xr.Dataset, along: np.ndarray) -> None:
    study = study.transpose(..., "attractor")
    kinds, starts = flag_names(study["attractor_kind"]), study["attractor_starts"].values
    ranges = 1e3 * study["attractor_range"].values
    total = study.sizes["energy"] * study.sizes["start"]
    for class_, look in LOOKS.items():
        point, number = np.nonzero((kinds == class_) & (starts > 0))
        area = LARGEST * starts[point, number] / total
        mark: dict[str, Any] = {"marker": "D" if look.hatch else "o", "edgecolor": BLACK, "linewidth": 0.4, "zorder": 3}
        ax.scatter(along[point], ranges[point, number], area, color=look.face, **mark)
    for part, text in ((0.1, "10 %"), (0.5, "50 %"), (1.0, "all starts")):
        ax.scatter([], [], LARGEST * part, facecolor="none", edgecolor=BLACK, linewidth=0.4, label=text)
    drawing.legend_above(ax)
    ax.set(ylabel="Slider range (mm)")
    if np.any(ranges > 0):
        ax.set_yscale("log")


def _kicks(ax: Axes, study: xr.Dataset, along: np.ndarray) -> None:
    """Draw the critical energy by bisection, the lowest separating energy of the starts, and all their energies."""
    for i, energy in enumerate(study["energy"].values):
        label = "sampled" if i == 0 else "_nolegend_"
        ax.axhline(energy, color=GREY, linestyle=":", linewidth=0.6, zorder=0, label=label)
    sample, bound = study["critical_energy_sampled"].values, study["critical_energy"].values
    ax.plot(along, sample, "_", color=BLACK, markersize=6, label="lowest separating")
    ax.plot(along, np.where(bound > 0, bound, np.nan), "v-", color=SEPARATED, markersize=3.5, label="by bisection")
    ax.set(ylabel="Critical energy (J)")
    if np.any(sample > 0):
        ax.set_yscale("log")
        # energy 0 has no place on this logarithmic scale
        for x in along[bound == 0]:
            drawing.say(ax, "0", (x, 0), (0, 2), xycoords=("data", "axes fraction"), color=SEPARATED, fontsize=7)
    drawing.legend_above(ax, columnspacing=0.7, handlelength=1.0, handletextpad=0.4)


# ---- Probability of instability against each uncertain parameter
MOST_PANELS = 4  # greatest number of points that a figure shows
BINS = 3  # number of parts, with equal numbers of draws, of a parameter's distribution


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
        """Draw rows with 95 % intervals, those above that change most; the line is the probability at all values."""
        cells = list(cells_of(study))
        names = [str(name) for name in study["parameter"].values]
        each = np.array([[probabilities(cell, name) for name in names] for _, cell in cells])
        order = np.abs(each[:, :, -1, 0] - each[:, :, 0, 0]).max(axis=0).argsort(kind="stable")
        names, rows = [names[i] for i in order], np.arange(len(names), dtype=float)
        figure, axes = panels(PAGE, 1.2 + 0.2 * len(names), 1, len(cells), sharey=True)
        for ax, (title, cell), thirds in zip(axes, cells, each[:, order], strict=True):
            ax.axvline(float(cell["probability_unstable"]), color=BLACK, linewidth=0.7, linestyle=(0, (3, 2)))
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
    names = [str(name) for name, values in study.coords.items() if values.dims and {*values.dims} <= {*dims}]
    for index in product(*(range(study.sizes[dim]) for dim in dims)):
        cell = study.isel(dict(zip(dims, index, strict=True)))
        cell = cell.isel({SAMPLE: flag_names(cell["status"]) != EXCLUDED})
        if cell.sizes[SAMPLE]:
            yield ", ".join(drawing.coordinate_text(cell[name], name) for name in names), cell
