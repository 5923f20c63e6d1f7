"""The paper's cases on maps of regions: their marks, and where the static start does otherwise."""

import math
from collections.abc import Iterator

import xarray as xr

from disc_model.data.variables import axis_of, flag_names, stated_in
from disc_model.figures.classes import LOOKS
from disc_model.figures.drawing import BLACK, PAPER, halo, large, sample, say
from disc_model.figures.kinds.maps import Mark, RegionMap
from disc_model.figures.types import Artist, Axes

PAPER_MARKERS = {"quiet": "o", "growing": "^", "separation": "s"}
"""The marker of each outcome of the paper."""
TOGETHER = 0.02
"""Distance of two marks, as a share of the panel, from which one surrounds the other."""
USUAL_SIZE = 55.0  # of a mark, square points,
SURROUNDING = 140.0  # and of one around another
RIGHT_EDGE = 0.85  # share of the panel from which names stand on the left of their marks
LOWER_EDGE = 0.15  # and below which they stand above
LEFT_EDGE = 0.15  # share up to which the second of two names stands above the first


def captions(study: xr.Dataset, first: xr.Dataset | None, plot: RegionMap) -> Iterator[str]:
    """The horizon, and where the static start does otherwise than the paper."""
    horizon = stated_in(study, "options")["horizon"]
    yield f"Within {horizon:g} s of the static start."
    if first is None:
        return
    for name, mark in plot.marks.items():
        point = first["outcome"].sel({plot.x: mark.x, plot.y: mark.y}, method="nearest")
        outcome = str(flag_names(point))
        label = LOOKS[outcome].label
        of_paper = LOOKS[mark.paper_outcome].label
        if label == of_paper or mark.assumed:
            continue
        if outcome == "growing":
            label = f"still growing at {horizon:g} s"
        yield f"{name}: paper: “{of_paper}”, static start: {label}."


def draw_marks(ax: Axes, plot: RegionMap) -> list[Artist]:
    """Mark cases by the shape of the paper's outcome, with names towards the middle; returns
    entries of a legend."""
    outline = halo(2.4, BLACK)
    places: list[tuple[float, float]] = []
    for name, mark in plot.marks.items():
        point = _point(plot, mark)
        across, up = (ax.transData + ax.transAxes.inverted()).transform(point)
        size = USUAL_SIZE
        offset = _away_from_edges(across, up)
        if any(math.dist((across, up), other) < TOGETHER for other in places):
            size = SURROUNDING  # so that the other mark stays visible
            offset = (6, 14) if across < LEFT_EDGE else (-8, 6)
        places.append((across, up))
        shape = PAPER_MARKERS[mark.paper_outcome]
        ax.scatter(
            *point,
            size,
            marker=shape,
            facecolor="none",
            zorder=4,
            clip_on=False,
            edgecolor=PAPER,
            linewidth=1.4,
            path_effects=outline,
        )
        say(
            ax,
            f"{name}, place assumed" if mark.assumed else name,
            point,
            offset,
            path_effects=halo(2.0),
            fontsize=large(7),
            zorder=5,
            annotation_clip=False,
        )
    outcomes = {mark.paper_outcome for mark in plot.marks.values()}
    numbered = all(name.isdigit() for name in plot.marks)
    source = "paper's figure" if numbered else "paper"
    return [
        sample(
            marker=shape,
            label=f"{source}: {LOOKS[name].label}",
            path_effects=outline,
            ls="",
            mfc="none",
            ms=6,
            mew=1.4,
            mec=PAPER,
        )
        for name, shape in PAPER_MARKERS.items()
        if name in outcomes
    ]


def _away_from_edges(across: float, up: float) -> tuple[float, float]:
    """Offset in points of the name of a mark at a place of the panel, towards its middle."""
    right = -6 if across > RIGHT_EDGE else 6
    above = -5 if up > LOWER_EDGE else 5
    return right, above


def _point(plot: RegionMap, mark: Mark) -> tuple[float, float]:
    """Where a mark lies, in the units of the axes."""
    return mark.x * axis_of(plot.x)[1], mark.y * axis_of(plot.y)[1]
