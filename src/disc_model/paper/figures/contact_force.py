"""The contact force over a run and closer, as in figure 2 of the paper."""

from typing import Literal

import numpy as np
import xarray as xr

from disc_model.data import dataset
from disc_model.data.variables import flag_names
from disc_model.figures import drawing
from disc_model.figures.drawing import FORCE, PAGE, Axes, Figure, panels
from disc_model.figures.kind import CasePlot, as_ranges, as_samples
from disc_model.paper.figures.separations import after, separations, shade


class ContactForce(CasePlot):
    """(a) Range of the contact force over the run, (b) the contact force in a window of samples."""

    shows = (("history", as_ranges), ("zoom", as_samples))

    kind: Literal["paper.contact_force"] = "paper.contact_force"
    history: str = "history"
    zoom: str = "zoom"

    def draw(self, *cases: xr.DataTree) -> Figure:
        [case] = cases
        figure, [whole, zoom] = panels(PAGE, 2.3, 1, 2)
        with drawing.blank_if_missing(whole):
            drawing.show(whole, case, drawing.history(case, self.history), "P")
            _show_zero(whole, case)
            drawing.letter(whole, "a")
        with drawing.blank_if_missing(zoom):
            window = dataset.samples(case, self.zoom)
            # a separation that the window cuts off at its start would look like a jump
            window = window.isel(time=slice(int(np.argmin(flag_names(window["phase"]) == "separation")), None))
            start = float(window["time"][0])
            window = after(window, start)
            drawing.letter(zoom, "b")
            shade(zoom, spans := separations(window))
            zoom.plot(window["time"], window["P"], color=FORCE)
            _show_zero(zoom, case)
            zoom.set(xlabel=f"Time after {start:.5f} s (ms)", ylabel=drawing.axis_of("P")[0])
            if spans:
                drawing.legend_above(zoom)
        return figure


def _show_zero(ax: Axes, case: xr.DataTree) -> None:
    """Include zero if contact is lost; a force that hardly changes is shown in detail."""
    if np.isfinite(float(case["first_separation"])):
        ax.set_ylim(bottom=-0.03 * ax.get_ylim()[1])
