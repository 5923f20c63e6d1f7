"""Range of the disc over a run, with separation and with it ignored."""

import xarray as xr

from disc_model.figures.drawing import GREY, headroom, panels
from disc_model.figures.runs import envelope, sampled, show_thickness
from disc_model.figures.selection import history
from disc_model.figures.types import Figure
from workflow.paper.figures.kinds import WithAndWithout


def draw(plot: WithAndWithout, *cases: xr.DataTree) -> Figure:
    """Draw the range with separation over that without."""
    figure, [ax] = panels(plot.inches, 2.4)
    followed, ignored = (history(case, plot.history) for case in cases)
    envelope(ax, ignored, "w_point", color=GREY, label="separation ignored")
    envelope(ax, followed, "w_point", label="with separation")
    ax.set_xlabel("Time (s)")
    ax.set_ylabel(sampled("w_point", ignored, followed)[0])
    headroom(ax, 0.25)
    show_thickness(ax, cases[0], "y")
    ax.legend(loc="upper left")
    return figure
