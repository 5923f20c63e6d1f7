"""Variables against time, over a run or in one of its windows; figures 10, 11 and 13 of the paper."""

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from disc_model.data import dataset
from disc_model.figures import parts
from disc_model.figures.parts import COLUMN, DISC, GREY, new_figure


def history(
    cases: Mapping[str, xr.DataTree], *, window: str, variables: Sequence[str], until: float = np.inf
) -> Figure:
    """Draw panels one above the other until a time in s; windows of ranges are drawn as bands."""
    (case,) = cases.values()
    figure = new_figure(COLUMN, 0.8 + 1.3 * len(variables))
    axes = figure.subplots(len(variables), 1, sharex=True, squeeze=False)[:, 0]
    with parts.blank_if_missing(*axes):
        found = dataset.group(case, window).sel(time=slice(None, until))
        time = found["time"].values
        if time.size < 2:  # the run ended before it
            raise dataset.Missing(f"has {time.size} samples in {window}, at least 2 are needed")
        parts.letters(axes)
        for ax, name in zip(axes, variables, strict=True):
            label, factor, colour = parts.sampled(name, found)
            if f"{name}_min" in found:
                parts.envelope(ax, found, name, scale=factor, color=colour)
            else:
                ax.plot(time, found[name].values * factor, color=colour, linewidth=0.6)
                ax.set_xlim(time[0], time[-1])
            ax.set_ylabel(label)
            parts.mark_first_separation(ax, case)
        axes[-1].set_xlabel("Time (s)")
        axes[-1].locator_params(axis="x", nbins=6)
    figure.align_ylabels()
    return figure


def with_and_without(cases: Mapping[str, xr.DataTree]) -> Figure:
    """Figure 10: range of the disc at r_0 and a fixed angle over the run, with bonded contact and with separation."""
    figure = new_figure(COLUMN, 2.4)
    ax = figure.subplots()
    with parts.blank_if_missing(ax):
        ignored, separating = (parts.history(cases[name]) for name in ("F04", "F02"))
        label, factor, _ = parts.sampled("w_point", ignored, separating)
        for ranges, color, text in ((ignored, GREY, "separation ignored"), (separating, DISC, "with separation")):
            parts.envelope(ax, ranges, "w_point", scale=factor, color=color, label=text)
        ax.set(xlabel="Time (s)", ylabel=label)
        parts.headroom(ax, 0.25)
        ax.legend(loc="upper left")
    return figure
