"""Range of the disc over a run, with separation and with it ignored."""

import xarray as xr
from matplotlib.figure import Figure

from disc_model.figures import drawing
from disc_model.figures.drawing import GREY
from disc_model.figures.selection import history
from disc_model.paper.figures.kinds import WithAndWithout


def draw(plot: WithAndWithout, *cases: xr.DataTree) -> Figure:
    """Draw the range with separation over that without."""
    figure, [ax] = drawing.panels(plot.inches, 2.4)
    followed, ignored = (history(case, plot.history) for case in cases)
    drawing.envelope(ax, ignored, "w_point", color=GREY, label="separation ignored")
    drawing.envelope(ax, followed, "w_point", label="with separation")
    ax.set_xlabel("Time (s)")
    ax.set_ylabel(drawing.sampled("w_point", ignored, followed)[0])
    drawing.headroom(ax, 0.25)
    drawing.show_thickness(ax, cases[0], "y")
    ax.legend(loc="upper left")
    return figure
