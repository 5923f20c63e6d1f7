"""Shares of starts by what these come to, as stacked bars."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names, stated_in
from disc_model.figures.cells import entries
from disc_model.figures.classes import LOOKS
from disc_model.figures.drawing import wide
from disc_model.figures.legends import figure_legend
from disc_model.figures.separating_share import entries_of_interval
from disc_model.figures.types import Array, Artist, Axes, Figure

STACKED = (
    "separating",
    "quiet",
    "other_cycle",
    "quasi_periodic",
    "irregular",
    "steady_sliding",
    "at_rest",
    "undecided",
    "undecided_lost",
    "failed",
)
"""Order in which shares of outcomes are stacked; those that separate start at zero, as do their intervals."""
LOST = "undecided_lost"
"""Class of undecided starts that have lost contact."""
BARS = {**LOOKS, LOST: LOOKS["undecided"]._replace(hatch=3 * "-")}
"""Looks of the classes that are stacked."""
OF_ENERGY = "basin_fraction_by_energy"
"""Shares of the starts of each energy."""
ROUNDING = 1e-9  # of a share
BAR = 0.9  # width of a bar over the least distance of two


def shares_of(study: xr.Dataset, variable: str) -> xr.DataArray:
    """Shares of starts by what these come to; undecided ones that have lost contact are a class of their
    own where the study knows of all starts."""
    shares = study[variable]
    if not {"kind", "lost_contact"} <= {*study}:
        return shares
    undecided = study["kind"].copy(data=flag_names(study["kind"]) == "undecided")
    apart = study["lost_contact"].copy(data=flag_names(study["lost_contact"]) == "yes")
    starts = [dim for dim in undecided.dims if dim not in shares.dims]
    whole = shares.sel(attractor_class="undecided", drop=True)
    known = whole.isnull() | (abs(undecided.mean(starts) - whole) < ROUNDING)
    if not known.all():  # some starts were left out
        return shares
    kept = (undecided & ~apart).mean(starts).where(whole.notnull())
    lost = (undecided & apart).mean(starts).where(whole.notnull())
    others = shares.where(shares["attractor_class"] != "undecided", kept)
    further = lost.expand_dims(attractor_class=[LOST])
    return xr.concat([others, further], "attractor_class", coords="minimal", compat="override")


def outcomes_in(shares: xr.DataArray) -> list[str]:
    """The outcomes that occur among the starts, in the order in which their shares are stacked."""
    known = {str(word) for word in shares["attractor_class"].values}
    return [
        word for word in STACKED if word in known and (shares.sel(attractor_class=word) > 0).any()
    ]


def entries_of(classes: Sequence[str], undecided: str) -> list[Artist]:
    """Entries of a legend of outcomes, and its words for undecided ones, of which those that have lost
    contact say so before what is advised."""
    words, colon, advice = undecided.partition(":")
    named = {
        "undecided": BARS["undecided"]._replace(label=undecided),
        LOST: BARS[LOST]._replace(label=f"{words}, but contact was lost{colon}{advice}"),
    }
    return entries(classes, {**BARS, **named})


def draw_shares(ax: Axes, shares: xr.DataArray, classes: Sequence[str], along: Array) -> None:
    """Draw the shares of outcomes along another dimension, stacked, as bars at the places
    `along`."""
    steps = np.diff(along)
    width = BAR * (steps.min() if steps.size else 1.0)
    shares = shares.sel(attractor_class=[*classes]).transpose("attractor_class", ...)
    below = shares.cumsum("attractor_class") - shares.fillna(0)
    for word, heights, bottoms in zip(classes, shares, below, strict=True):
        look = BARS[word]
        ax.bar(
            along,
            heights,
            width,
            bottoms,
            lw=wide(0.4),
            fc=look.face,
            hatch=look.hatch,
            ec=look.ink,
        )
    ax.set_ylim((0, 1))


def explain(figure: Figure, study: xr.Dataset, classes: Sequence[str]) -> None:
    """Write the legend of the outcomes of starts below a figure."""
    horizon = stated_in(study, "options")["horizon"]
    handles = entries_of(classes, f"undecided after {horizon:g} s")
    handles += entries_of_interval(study, OF_ENERGY)
    figure_legend(figure, handles, loc="outside lower center")
