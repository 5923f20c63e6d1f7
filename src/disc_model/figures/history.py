"""Histories: variables of a case against time, one above the other."""

import math
from collections.abc import Iterator, Mapping
from typing import Annotated, Literal

import xarray as xr
from pydantic import Field

from disc_model.data import dataset
from disc_model.data.dataset import Missing
from disc_model.errors import Fault
from disc_model.figures import drawing
from disc_model.figures.drawing import COLUMN, Figure, panels
from disc_model.figures.kind import CasePlot, Recorded, Sampled
from disc_model.simulation.case import Window
from disc_model.units import Positive, Unit

RANGES = ("P", "u", "w", "w_point", "psi", "psi_velocity")
"""Variables that a window with an envelope stores."""


def _as_either(window: Window) -> Iterator[str]:
    if window.count < 2 * (window.envelope or 1):
        yield "must be two samples, or two envelopes, long or more"


class History(CasePlot):
    """Variables against time, one above the other; a window with an envelope as ranges.

    until : s, end of the part of the window that is shown
    """

    shows = (("window", _as_either),)

    kind: Literal["history"] = "history"
    window: str
    variables: Annotated[tuple[Sampled, ...], Field(min_length=1)] = ("P", "w")
    until: Annotated[Positive, Unit("s")] | None = None

    def faults(self, cases: Mapping[str, Recorded | None]) -> Iterator[Fault]:
        """Faults as of any figure of a case, and variables that the window does not keep."""
        yield from super().faults(cases)
        window = (cases.get(self.case) or {}).get(self.window)
        if isinstance(window, Window) and window.envelope is not None:
            for i, name in enumerate(self.variables):
                if name not in RANGES:
                    yield Fault.of(("variables", str(i)), name, f"is not kept as ranges (known: {', '.join(RANGES)})")

    def draw(self, *cases: xr.DataTree) -> Figure:
        [case] = cases
        figure, axes = panels(COLUMN, 0.8 + 1.3 * len(self.variables), len(self.variables), sharex=True)
        shown = dataset.group(case, self.window).sel(time=slice(None, self.until or math.inf))
        if shown.sizes["time"] < 2:  # the run ended before it
            raise Missing(f"has {shown.sizes['time']} samples in {self.window}, at least 2 are needed")
        drawing.letters(axes)
        for ax, name in zip(axes, self.variables, strict=True):
            drawing.show(ax, case, shown, name)
            ax.label_outer()
        axes[-1].locator_params(axis="x", nbins=6)
        figure.align_ylabels()
        return figure
