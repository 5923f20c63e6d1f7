"""What linear analysis says of steady sliding beside what the motion does, over two parameters."""

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from disc_model.data.variables import EXCLUDED, axis_of, flag_names, stated_in
from disc_model.figures.cells import edges_of, entries, paint
from disc_model.figures.classes import LOOKS, STABLE, Look
from disc_model.figures.drawing import letters, row_of_panels
from disc_model.figures.growth import ROUNDING
from disc_model.figures.kinds.maps import SlidingOutcome
from disc_model.figures.left_out import parts_shown, titles_of_panels
from disc_model.figures.legends import figure_legend
from disc_model.figures.selection import alike, common_points
from disc_model.figures.types import Figure, Words

AGREEMENTS: Mapping[str, Look] = {
    "stable_quiet": STABLE._replace(label="stable, and the motion quiet", face=LOOKS["quiet"].face),
    "stable_grows": STABLE._replace(
        label="stable, but the motion leaves the quiet cycle in contact", face=LOOKS["growing"].face
    ),
    "stable_separates": STABLE._replace(
        label="stable, but the motion separates", face=LOOKS["separation"].face
    ),
    "unstable_quiet": LOOKS["quiet"]._replace(label="unstable, but the motion stays quiet"),
    "unstable_grows": LOOKS["growing"]._replace(
        label="unstable, and the motion grows, or reaches another cycle, in contact"
    ),
    "unstable_separates": LOOKS["separation"]._replace(label="unstable, and the motion separates"),
    "unknown": LOOKS["undecided"]._replace(label="undecided, or no steady sliding"),
    EXCLUDED: LOOKS[EXCLUDED],
}
"""What linear analysis of steady sliding says (dots: stable), and what the motion from the start
does."""


def draw(plot: SlidingOutcome, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
    """Draw a panel for each value of the compared dimension; the legend has the shares of all
    classes."""
    parts = parts_shown(study, plot.by, plot.names)
    width = plot.inches
    figure, axes = row_of_panels(width, len(parts), 3.4, 3.0, sharex=True, sharey=True)
    each: list[Words] = []
    for ax, part in zip(axes, parts, strict=True):
        plane = part.data.transpose(plot.y, plot.x, ...)
        sliding = alike(overlays["sliding"], part.data, plot.by).rename(value=plot.x)
        linear = sliding.transpose(plot.y, plot.x, ...)
        plane, linear = common_points(plane, linear, (plot.x, plot.y))
        rates = linear["largest_growth_rate"].values
        words = agreement(rates, flag_names(plane["outcome"]))
        paint(ax, edges_of(plane["outcome"]), words, AGREEMENTS)
        each.append(words)
        ax.set_xlabel(axis_of(plot.x)[0])
        ax.set_ylabel(axis_of(plot.y)[0])
        ax.label_outer()
    letters(axes, titles_of_panels(parts, study, plot.by))
    horizon = stated_in(study, "options")["horizon"]
    looks = {word: _with_shares(word, look, each) for word, look in AGREEMENTS.items()}
    figure_legend(
        figure,
        entries(np.concatenate(each, axis=None), looks),
        loc="outside lower center",
        columns=1,
        title=f"Motions of {horizon:g} s, in % of points. Steady sliding is",
    )
    return figure


def _with_shares(word: str, look: Look, each: Sequence[Words]) -> Look:
    """The look of a class with its share of the cells of each panel."""
    letters = [""]
    if len(each) > 1:
        letters = [f"({letter})\u00a0" for letter in "abcd"]
    shares = [
        f"{letter}{percent(float(np.mean(words == word)))}"
        for letter, words in zip(letters, each, strict=False)
    ]
    return look._replace(label=f"{look.label}: {', '.join(shares)}")


def percent(share: float) -> str:
    """A share in whole percent, on one line; one that rounds to nothing is not called nothing."""
    if 0 < share < 0.005:
        return "<\u00a01\u00a0%"
    return f"{100 * share:.0f}\u00a0%"


def agreement(growth_rate: np.ndarray, outcome: np.ndarray) -> Words:
    """Keys of `AGREEMENTS` at points with this growth rate of steady sliding (1/s) and outcome of
    the static start."""
    quiet = np.isin(outcome, ("quiet", "steady_sliding", "at_rest"))
    grows = np.isin(outcome, ("growing", "other_cycle"))
    motion = np.select([outcome == "separation", grows, quiet], ["separates", "grows", "quiet"], "")
    linear = np.where(growth_rate > ROUNDING, "unstable_", "stable_")
    known = np.isfinite(growth_rate) & (motion != "")
    words = np.where(known, np.char.add(linear, motion), "unknown")
    return np.where(outcome == EXCLUDED, EXCLUDED, words)
