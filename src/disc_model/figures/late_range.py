"""Vibration late in the motion, with and without separation, in thicknesses of the disc."""

from collections.abc import Mapping
from typing import Literal

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.figures import drawing
from disc_model.figures.drawing import BLACK, GREY, PAGE, Figure, panels
from disc_model.figures.kind import Plot
from disc_model.units import Positive

COLOURS = (BLACK, "#D55E00", "#0072B2", "#CC79A7")
LEAST = 1e-5
"""Smallest range drawn, in thicknesses: a quiet cycle moves the slider by less than a millionth of a metre."""


class LateRange(Plot):
    """Peak-to-peak displacement of the slider against the speed, in unilateral and in bilateral contact.

    by : dimension with a panel for each value
    thickness : of the disc, m; that of the paper unless given
    """

    quantities = ("outcome",)
    named_above = True

    kind: Literal["late_range"] = "late_range"
    by: str = "disc"
    thickness: Positive = 0.002

    @property
    def dims(self) -> tuple[str, ...]:  # type: ignore[override]
        """All that the figure shows."""
        return ("Omega", "N", "contact", self.by)

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw a panel for each value of ``by``, and a line for each preload and contact."""
        ranges = (study["u_max"] - study["u_min"]) / self.thickness
        separates = study["outcome"].copy(data=flag_names(study["outcome"]) == "separation")
        names, loads = study[self.by].values, study["N"].values
        figure, axes = panels(PAGE, 3.0, 1, len(names), sharex=True, sharey=True)
        for ax, name in zip(axes, names, strict=True):
            ax.axhspan(1, 1e3, color="0.93", zorder=0)
            for load, colour in zip(loads, COLOURS, strict=False):
                for contact, look in (("unilateral", "-"), ("bilateral", "--")):
                    line = {self.by: name, "N": load, "contact": contact}
                    height = np.maximum(ranges.sel(line).transpose("Omega").values, LEAST)
                    apart = separates.sel(line).transpose("Omega").values
                    ax.plot(study["Omega"], height, look, color=colour, linewidth=1.0)
                    ax.plot(study["Omega"], height, "o", color=colour, markersize=3, markerfacecolor="white")
                    ax.plot(study["Omega"].values[apart], height[apart], "o", color=colour, markersize=3)
            ax.set(yscale="log", ylim=(LEAST / 2, 10), xlabel=drawing.label_of(study["Omega"])[0])
        axes[0].set_ylabel("Slider, peak to peak (thicknesses)")
        axes[0].text(
            0.03, 0.99, "beyond linear plate theory", transform=axes[0].transAxes, va="top", color=GREY, size=6
        )
        drawing.letters(axes, [str(name) for name in names])
        figure.legend(
            handles=[
                *(drawing.sample(color=c, label=f"{1e-3 * n:g} kN") for n, c in zip(loads, COLOURS, strict=False)),
                drawing.sample(color=GREY, linestyle="-", label="unilateral contact"),
                drawing.sample(color=GREY, linestyle="--", label="bilateral contact"),
                drawing.sample(color=GREY, linestyle="", marker="o", markersize=3, label="separates"),
            ],
            loc="outside lower center",
            ncols=5,
        )
        return figure
