"""Phase portraits: one variable of a case over another, coloured by phase."""

from typing import Any, Literal

import numpy as np
import xarray as xr

from disc_model.data import dataset
from disc_model.data.variables import PHASES
from disc_model.figures import drawing
from disc_model.figures.drawing import COLUMN, PHASE_COLOURS, Figure, panels
from disc_model.figures.kind import CasePlot, Sampled, as_samples


class Portrait(CasePlot):
    """One variable over another, coloured by phase."""

    shows = (("window", as_samples),)

    kind: Literal["portrait"] = "portrait"
    window: str
    x: Sampled = "psi"
    y: Sampled = "psi_velocity"

    def draw(self, *cases: xr.DataTree) -> Figure:
        figure, [ax] = panels(COLUMN, 2.7)
        samples = dataset.samples(cases[0], self.window)
        (across, in_x, _), (up, in_y, _) = (drawing.sampled(name, samples) for name in (self.x, self.y))
        for i, name in enumerate(PHASES):
            inside = samples["phase"].values == i
            look: dict[str, Any] = {"color": PHASE_COLOURS[name], "label": name}
            width = 1.5 if name == "separation" else 0.5  # distinct in grey print
            if inside.any():
                # broken where the phase changes, so that no chord is drawn across others
                height = np.where(inside, samples[self.y].values * in_y, np.nan)
                ax.plot(samples[self.x].values * in_x, height, linewidth=width, rasterized=True, **look)
        ax.margins(0.04)
        for line in drawing.legend_above(ax).get_lines():
            line.set_linewidth(line.get_linewidth() + 0.5)
        ax.set(xlabel=across, ylabel=up)
        return figure
