"""After how many releases of stick motions repeat: an addition to the paper's figures."""

from typing import Literal

import numpy as np
import xarray as xr

from disc_model.analysis.classify import closure
from disc_model.data import dataset
from disc_model.data.dataset import Missing
from disc_model.data.variables import EVENT_KINDS
from disc_model.figures import drawing
from disc_model.figures.drawing import BLACK, PAGE, Figure, panels
from disc_model.figures.kind import CasePlot


class Closures(CasePlot):
    """Differences between release intervals and those n later, against n: small where a motion repeats.

    further : cases of further panels
    """

    kind: Literal["paper.closures"] = "paper.closures"
    further: tuple[str, ...] = ()

    @property
    def others(self) -> tuple[str, ...]:
        return self.further

    def draw(self, *cases: xr.DataTree) -> Figure:
        figure, axes = panels(PAGE, 2.6, 1, len(cases), sharey=True)
        for ax, case in zip(axes, cases, strict=True):
            with drawing.blank_if_missing(ax):
                events = dataset.events(case)
                released = events["time"].values[events["kind"].values == EVENT_KINDS.index("stick_to_slip")]
                counts = np.arange(1, (len(released) - 1) // 2 + 1)
                if not counts.size:
                    raise Missing("keeps no two releases of stick")
                rounding = np.spacing(released[-1])  # intervals that agree exactly have no place on a logarithmic scale
                differences = [max(closure(np.diff(released), int(n)), rounding) for n in counts]
                ax.plot(counts, differences, ".", color=BLACK, markersize=3)
                ax.set(xscale="log", yscale="log", xlabel="Releases n")
                ax.margins(0.04)
        drawing.letters(axes, self.cases)
        axes[0].set_ylabel("Largest difference (s)")
        return figure
