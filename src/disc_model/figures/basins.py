"""Basins of attraction: fractions with intervals, the attractors, and the critical energy of separation."""

from collections.abc import Mapping
from typing import Literal

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names, stated_in
from disc_model.figures import drawing
from disc_model.figures.cells import OUTCOME_LOOKS, Look, patches
from disc_model.figures.drawing import BLACK, GREY, PAGE, SEPARATED, Axes, Figure
from disc_model.figures.kind import Plot

LOOKS = {
    "quiet": OUTCOME_LOOKS["quiet"],
    "other_cycle": OUTCOME_LOOKS["other_cycle"],
    "separating": OUTCOME_LOOKS["separation"]._replace(label="separating"),
    "quasi_periodic": Look("quasi-periodic", "#b5dcf2", 4 * "\\"),
    "irregular": Look("irregular", drawing.BROWN, 4 * "/"),
    **{name: OUTCOME_LOOKS[name] for name in ("steady_sliding", "at_rest", "undecided", "failed")},
}
"""Looks of the outcomes, as in maps; a hatch where another one is as dark in grey print."""
LARGEST = 36.0
"""Area of the mark of an attractor that all starts reach, square points."""


class BasinShares(Plot):
    """Outcomes of many starts, the attractors, and the critical energy of separation, against a parameter."""

    quantities = ("basins",)

    kind: Literal["basins"] = "basins"
    x: str

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw the fractions of starts of each energy above, and the range of each attractor and the energies below.

        The size of an attractor's mark is its fraction of all starts.
        """
        study = study.transpose(self.x, ...)
        label, factor = drawing.label_of(study[self.x])
        along, energies = study[self.x].values * factor, study["energy"].values
        figure = drawing.new_figure(PAGE, 4.6)
        above, below = np.asarray(figure.subfigures(2, 1))
        axes = [*above.subplots(1, len(energies), sharey=True, squeeze=False)[0], *below.subplots(1, 2)]
        classes = [class_ for class_ in LOOKS if (study["basin_fraction"].sel(attractor_class=class_) > 0).any()]
        width = 0.9 * np.diff(along).min(initial=1.0)
        for ax, energy in zip(axes, energies, strict=False):
            shares = study["basin_fraction_by_energy"].sel(energy=energy, attractor_class=classes)
            low = shares.cumsum("attractor_class") - shares.fillna(0)
            for class_ in classes:
                selected = {"attractor_class": class_}
                bars = {
                    "edgecolor": BLACK,
                    "linewidth": 0.4,
                    "facecolor": LOOKS[class_].face,
                    "hatch": LOOKS[class_].hatch,
                }
                ax.bar(along, shares.sel(selected), width, low.sel(selected), **bars)
            ax.set(ylim=(0, 1))
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


def _attractors(ax: Axes, study: xr.Dataset, along: np.ndarray) -> None:
    kinds = flag_names(study["attractor_kind"].transpose(..., "attractor"))
    starts = study["attractor_starts"].transpose(..., "attractor").values
    ranges = 1e3 * study["attractor_range"].transpose(..., "attractor").values
    total = study.sizes["energy"] * study.sizes["start"]
    for class_, look in LOOKS.items():
        point, number = np.nonzero((kinds == class_) & (starts > 0))
        area = LARGEST * starts[point, number] / total
        ax.scatter(along[point], ranges[point, number], area, color=look.face, edgecolor=BLACK, linewidth=0.4, zorder=3)
    for part, text in ((0.1, "10 %"), (0.5, "50 %"), (1.0, "all starts")):
        ax.scatter([], [], LARGEST * part, facecolor="none", edgecolor=BLACK, linewidth=0.4, label=text)
    drawing.legend_above(ax)
    ax.set(ylabel="Slider range (mm)")
    if np.any(ranges > 0):
        ax.set_yscale("log")


def _kicks(ax: Axes, study: xr.Dataset, along: np.ndarray) -> None:
    """Draw the critical energy by bisection, the lowest separating energy of the starts, and all their energies."""
    for i, energy in enumerate(study["energy"].values):
        label = "energies sampled" if i == 0 else "_nolegend_"
        ax.axhline(energy, color=GREY, linestyle=":", linewidth=0.6, zorder=0, label=label)
    sample, bound = study["critical_energy_sampled"].values, study["critical_energy"].values
    ax.plot(along, sample, "_", color=BLACK, markersize=6, label="lowest sampled")
    ax.plot(along, np.where(bound > 0, bound, np.nan), "v-", color=SEPARATED, markersize=3.5, label="by bisection")
    ax.set(ylabel="Critical energy (J)")
    if np.any(sample > 0):
        ax.set_yscale("log")
        # energy 0 has no place on this logarithmic scale
        for coordinate in along[bound == 0]:
            drawing.say(
                ax, "0", (coordinate, 0), (0, 2), xycoords=("data", "axes fraction"), color=SEPARATED, fontsize=7
            )
    drawing.legend_above(ax, columnspacing=0.7, handlelength=1.0, handletextpad=0.4)
