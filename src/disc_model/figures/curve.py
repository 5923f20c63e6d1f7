"""Curves: any variable of a grid study against one of its dimensions."""

from collections.abc import Mapping
from itertools import cycle
from textwrap import fill
from typing import Literal

import numpy as np
import xarray as xr

from disc_model.figures import drawing
from disc_model.figures.drawing import BLACK, COLUMN, GREY, Figure, panels
from disc_model.figures.general import General, colour_bar, in_steps, remaining, scale
from disc_model.units import Finite

LINEAR = 0.1
"""Growth rate up to which its scale is linear, 1/s; a greater step leads to another cycle and breaks the line."""
MARKS = "os^Dv<>"
"""Marks of the lines; they are open, so that lines on top of each other show."""


class CurvePlot(General):
    """A variable against one dimension; a line for each value of a second, if wanted.

    limits : ends of the variable's axis, so that figures can be compared
    """

    room = 12

    kind: Literal["curve"] = "curve"
    limits: tuple[Finite, Finite] | None = None

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw a line, or one for each value of a second dimension; marks at the axis stand for missing values.

        A second dimension of numbers has a colour scale, one of words or pairs a legend.
        """
        from cmcrameri import cm
        from matplotlib.cm import ScalarMappable

        study = drawing.picked(study, self.at)
        found = study[self.variable]
        by = remaining(found, self)
        lines = drawing.slices(found, by)
        numbers = found[by] if by in found.coords and found[by].dtype.kind in "fi" else None
        figure, [ax] = panels(COLUMN, 2.9)
        label, factor = drawing.label_of(found[self.x])
        along = found[self.x].values * factor
        words = drawing.flags_of(found)
        colours = [cm.batlow(i / len(lines)) for i in range(len(lines))] if by else [BLACK]
        jump = np.inf if self.log or self.variable != "growth_rate" else LINEAR
        for colour, (text, line), mark in zip(colours, lines, cycle(MARKS), strict=False):
            name = text if numbers is None else ""
            x, y = drawing.broken(along, line.values, jump)
            ax.plot(
                x, y, mark + "-" * (not words), color=colour, label=name or None,
                markersize=3, markerfacecolor="none", markeredgewidth=0.6, linewidth=0.7,
            )  # fmt: skip
        if self.limits is not None:
            ax.set_ylim(self.limits)
        if self.log:
            ax.set_yscale("log")
        elif self.variable == "growth_rate":  # peaks of tens occur beside hundredths
            ax.set_yscale("symlog", linthresh=LINEAR)
            ax.yaxis.set_major_formatter("{x:g}")
            ax.axhline(0, color=GREY, linewidth=0.6, zorder=0)
        ax.set_xscale(scale(self.x, along))
        ax.margins(0.03)
        ax.set(xlabel=label, ylabel=fill(drawing.label_of(found)[0], 32))
        if words:
            ax.set_yticks(range(len(words)), labels=words)
        for (name, gone), mark in zip(drawing.gaps(study, found).items(), "x+|12", strict=False):
            there = gone.any([dim for dim in gone.dims if dim != self.x]).values
            drawing.mark_failed(ax, along[there], name=name, mark=mark)
        if numbers is not None:
            label, factor = drawing.label_of(numbers)
            steps = ScalarMappable(**in_steps(colours))
            colour_bar(figure, [ax], steps, label, [f"{value * factor:g}" for value in numbers.values])
        if ax.get_legend_handles_labels()[0]:
            # names of more letters do not fit there
            beside = by is not None and numbers is None and max(len(text) for text, _ in lines) < 25
            figure.legend(
                loc="outside right upper" if beside else "outside lower right", ncols=1 if beside or by else 2
            )
        return figure
