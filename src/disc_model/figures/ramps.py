"""Onset of separation on the way up and its end on the way down, against the rate of the speed's ramps."""

from collections.abc import Mapping
from itertools import chain
from typing import Any, ClassVar, Literal

import numpy as np
import xarray as xr

from disc_model.data.variables import stated_in
from disc_model.figures import drawing
from disc_model.figures.curves import crossings, curves_of
from disc_model.figures.drawing import Figure, panels
from disc_model.figures.kind import CURVES, Plot, Roles


class RampedSpeeds(Plot):
    """Where separation begins on the way up and ends on the way down, against the rate of the speed's ramps."""

    quantities = ("ramps",)
    roles: ClassVar[Roles] = {"curves": CURVES}

    kind: Literal["ramps"] = "ramps"

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw one point; with the further study ``curves``, also the speed at which the cycle ends at this load.

        This is the limit of the onset for slow ramps: the highest such speed below all onsets. Other ends belong to
        other cycles.
        """
        study = study.squeeze()
        options, load = stated_in(study, "options"), float(stated_in(study, "base")["N"])
        rates, onset, end = (study[name].values for name in ("rate", "onset_speed", "offset_speed"))
        gone = study["rate_status"].values != 0
        figure, [ax] = panels(drawing.COLUMN, 3.4)
        ax.plot(rates, onset, "^-", color=drawing.ONSET, markersize=4, linewidth=0.8, label="onset, rising ramp")
        ax.plot(rates, end, "v-", color=drawing.END, markersize=4, linewidth=0.8, label="end, falling ramp")
        late = rates[np.isnan(onset) & ~gone]
        if late.size:
            look: dict[str, Any] = {
                "color": drawing.ONSET,
                "markersize": 4,
                "markerfacecolor": "white",
                "clip_on": False,
            }
            ax.plot(late, np.full(late.size, options["high"]), "^", label="none up to the highest speed", **look)
        if "curves" in overlays:
            folds = [crossings(curve, load) for curve in curves_of(overlays["curves"]) if curve.kind == "fold"]
            if below := [speed for speed in chain(*folds) if speed <= np.fmin.reduce(onset)]:
                ax.axhline(max(below), **drawing.BORDERS["fold"], zorder=0)
                drawing.say_beside(ax, max(below), f"{max(below):.2f}")
        drawing.mark_failed(ax, rates[gone])
        ax.set_xscale("log")
        ax.margins(x=0.04)
        ax.set(xlabel="Ramp rate (rad/s²)", ylabel=drawing.axis_of("Omega")[0], ylim=(options["low"], options["high"]))
        figure.legend(loc="outside lower center", ncols=1)
        return figure
