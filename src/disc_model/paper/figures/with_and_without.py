"""The disc's vibration with separation and with separation ignored, as in figure 10 of the paper."""

from typing import Literal

import xarray as xr

from disc_model.figures import drawing
from disc_model.figures.drawing import COLUMN, GREY, Figure, panels
from disc_model.figures.kind import CasePlot, as_ranges


class WithAndWithout(CasePlot):
    """Range of the disc at r_0 and a fixed angle over the run, with separation and bilateral.

    ignored : the case with bilateral contact
    """

    shows = (("history", as_ranges),)

    kind: Literal["paper.with_and_without"] = "paper.with_and_without"
    ignored: str
    history: str = "history"

    @property
    def others(self) -> tuple[str, ...]:
        return (self.ignored,)

    def draw(self, *cases: xr.DataTree) -> Figure:
        figure, [ax] = panels(COLUMN, 2.4)
        followed, ignored = (drawing.history(case, self.history) for case in cases)
        drawing.envelope(ax, ignored, "w_point", color=GREY, label="separation ignored")
        drawing.envelope(ax, followed, "w_point", label="with separation")
        ax.set(xlabel="Time (s)", ylabel=drawing.sampled("w_point", ignored, followed)[0])
        drawing.headroom(ax, 0.25)
        ax.legend(loc="upper left")
        return figure
