"""A branch of cycles over its parameter."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from disc_model.figures.branch_family import (
    NAME,
    NO_FURTHER,
    SPECIAL_MARKS,
    join_family,
    line_in_legend,
    next_look,
)
from disc_model.figures.branch_heights import (
    axis_upward,
    drawn_unit,
    label_along,
    refined_upward,
    upward_of,
)
from disc_model.figures.branch_lines import (
    FLOOR,
    Look,
    above_floor,
    dot_in_legend,
    draw_at_floor,
    draw_branch,
    draw_dots,
    set_margins,
    stable_line,
    stable_segments,
    unstable_line,
)
from disc_model.figures.branch_wishes import PartLooks, part_looks
from disc_model.figures.canvas import Wishes, page_for
from disc_model.figures.drawing import BLACK, COLUMN, mark, sample
from disc_model.figures.drawn_units import in_readers_units
from disc_model.figures.family import Member, name_in
from disc_model.figures.named_axes import Quantities
from disc_model.figures.rate_scale import scale_rates
from disc_model.figures.stated_case import stated, stated_values
from disc_model.figures.types import Artist, Axes, Mask

if TYPE_CHECKING:
    from disc_model.stability.continuation import Branch

WIDE = 30.0  # largest over least range from which the axis is logarithmic


@in_readers_units
def plot_branch(
    branch: Branch,
    y: str,
    *,
    ax: Any = None,
    legend: Any = True,
    labels: Any = None,
    title: str | bool | None = None,
    looks: Any = None,
) -> Axes:
    """Draw a variable of the cycles along a branch over its parameter, or its second parameter over
    its first; returns the axes.

    looks : of the stable and unstable parts and of the cycles, as `part_looks` reads them
    """
    first, *second = branch.parameters
    across, factor = label_along(first)
    x = branch.values[:, 0] * factor
    label, upward = axis_upward(branch, y)
    values = upward_of(branch, branch, y) * upward
    case = stated(branch.case, *branch.parameters)
    name, labels = name_in(labels, NAME)
    wished = part_looks(looks)
    with page_for(Wishes(ax, legend, labels, title), COLUMN, 2.8, title=case) as page:
        page.show(Quantities(across, label))
        axes = page.ax
        look = next_look(axes, wished)
        # the stability changes at special points, which lie between the others
        stable = stable_segments(branch.refined_growth_rate())
        refined_x = branch.refined("values")[:, 0] * factor
        refined_values = refined_upward(branch, y) * upward
        draw_branch(axes, refined_x, above_floor(refined_values), stable, look, wished=wished)
        # what lies between is not computed
        draw_dots(axes, x, above_floor(values), look, wished)
        lowest = draw_at_floor(axes, x, look, np.isneginf(values), wished)
        if y == "growth_rate" and not second:
            scale_rates(axes)
        heights = axes.dataLim  # of all branches on the axes
        if y == "range" and not second and heights.y1 > WIDE * heights.minposy:
            axes.set_yscale("log")
        handles = _stability_samples(stable, wished)
        handles += lowest
        special = _mark_special_points(axes, branch, y, (factor, upward))
        set_margins(axes)
        axes.set_xlabel(across)
        axes.set_ylabel(label)
        page.explain([*handles, *special])
        page.joins = True
        values_of_case = stated_values(branch.case, *branch.parameters)
        member = Member(name, values_of_case, int(branch.releases[0]), handles, special)
        member.line = line_in_legend(look, stable, wished)
        member.coloured = wished.coloured
        join_family(page, member)
    return page.ax


def _stability_samples(stable: Mask, wished: PartLooks) -> list[Artist]:
    """Entries of the legend for the lines: a branch that is unstable throughout is a thin line with dots
    in the legend too.

    stable : whether the branch is stable between points
    """
    black = Look(BLACK)
    unstable = unstable_line(black, wished)
    if not stable.any():
        return [sample(**{**unstable, **dot_in_legend(wished)}, label="unstable")]
    samples = [sample(**stable_line(black, wished), label="stable")]
    if not stable.all():
        samples.append(sample(**unstable, label="unstable"))
    return samples


def _mark_special_points(
    ax: Axes, branch: Branch, y: str, factors: tuple[float, float]
) -> list[Any]:
    """Mark the special points of a branch; returns the entries of a legend, with the value of a
    kind that is there once, or else how many there are. The factors are those from SI to the units
    of both axes."""
    across, upward = factors
    unit = drawn_unit(branch.parameters[0])
    handles: list[Any] = []
    for kind, (sign, colour, name) in SPECIAL_MARKS.items():
        special = [each for each in branch.special if each.kind == kind]
        if not special:
            continue
        places = np.array([each.values[0] for each in special]) * across
        heights = np.array([upward_of(each, branch, y) * upward for each in special], float)
        text = f"{len(special)} {name}s"
        if name.startswith(NO_FURTHER):
            text = name
        elif len(special) == 1:
            text = f"{name} at {places[0]:.5g} {unit}".rstrip()
        look: dict[str, Any] = {"color": colour, "markersize": mark(4), "markeredgewidth": 0.5}
        handles += ax.plot(places, above_floor(heights), sign, label=text, **look)
        lowest = places[np.isneginf(heights)]
        if lowest.size:
            edge = np.full(lowest.size, FLOOR)
            ax.plot(lowest, edge, sign, transform=ax.get_xaxis_transform(), **look)
    return handles
