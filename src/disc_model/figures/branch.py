"""A branch of cycles over its parameter."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

import numpy as np
import xarray as xr

from disc_model.data.variables import axis_of
from disc_model.errors import require
from disc_model.figures.branches import STABLE, THIN, draw_branch, stable_segments
from disc_model.figures.canvas import OWN, Page, Wishes, page_for
from disc_model.figures.curve import scale_rates
from disc_model.figures.drawing import (
    BLACK,
    BLUE,
    BROWN,
    COLUMN,
    GREEN,
    ORANGE,
    PURPLE,
    SEPARATED,
    SKY,
    large,
    mark,
    sample,
    wide,
)
from disc_model.figures.runs import stated, stated_values
from disc_model.figures.types import Axes
from disc_model.figures.words import head_text, label_of, what_case

if TYPE_CHECKING:
    from disc_model.stability.continuation import Branch, SpecialPoint

WIDE = 30.0  # largest over least range from which the axis is logarithmic
SPECIAL_MARKS = {
    "fold": ("s", SEPARATED, "fold"),
    "period_doubling": ("D", BLUE, "period doubling"),
    "neimark_sacker": ("o", BLUE, "Neimark-Sacker bifurcation"),
    "branch_point": ("*", BLACK, "branch point"),
    "grazing": ("X", SEPARATED, "grazing"),
    "hopf": ("^", BLUE, "Hopf point"),
}
"""Kinds of special points, with their mark, colour and name in the legend."""
FAMILY = (BLACK, GREEN, BROWN, SKY, PURPLE, ORANGE)
"""Colours of branches on the same axes, in their order."""


@dataclass
class _Shown:
    """A branch on axes: its name, if the reader gives one, what titles say of its case, and its
    entries of the legend."""

    name: str
    values: Mapping[str, Any]
    looks: list[Any]
    special: list[Any]


_SHOWN: WeakKeyDictionary[Axes, list[_Shown]] = WeakKeyDictionary()
"""The branches that axes have."""


def plot_branch(
    branch: Branch,
    y: str,
    *,
    ax: Any = None,
    legend: Any = True,
    labels: Any = None,
    title: str | None = None,
) -> Axes:
    """Draw a variable of the cycles along a branch over its parameter, or its second parameter over
    its first; returns the axes."""
    first, *second = branch.parameters
    across, factor = axis_of(first)
    x = branch.values[:, 0] * factor
    label, upward = _axis_upward(branch, y)
    values = _upward(branch, branch, y) * upward
    case = stated(branch.case, *branch.parameters)
    name = ""
    if isinstance(labels, Mapping) and "branch" in labels:
        name = labels["branch"]
        require((isinstance(name, str), "labels.branch", name, "must be a text"))
        labels = {word: text for word, text in labels.items() if word != "branch"}
    with page_for(Wishes(ax, legend, labels, title), COLUMN, 2.8, title=case) as page:
        axes = page.ax
        shown = _SHOWN.setdefault(axes, [])
        colour = FAMILY[len(shown) % len(FAMILY)]
        # the stability changes at special points, which lie between the others
        stable = stable_segments(branch.refined_growth_rate())
        refined_x = branch.refined("values")[:, 0] * factor
        refined_values = _refined_upward(branch, y) * upward
        draw_branch(axes, refined_x, refined_values, stable, colour)
        # what lies between is not computed
        axes.plot(x, values, ".", color=colour, markersize=mark(3))
        if y == "growth_rate" and not second:
            scale_rates(axes)
        if y == "range" and not second and np.nanmax(values) > WIDE * np.nanmin(values):
            axes.set_yscale("log")
        looks = ((stable.any(), STABLE, "stable"), (not stable.all(), THIN, "unstable"))
        handles = [
            sample(color=BLACK, linewidth=wide(width), label=text)
            for occurs, width, text in looks
            if occurs
        ]
        special = _mark_special_points(axes, branch, y, (factor, upward))
        values_of_case = stated_values(branch.case, *branch.parameters)
        shown.append(_Shown(name, values_of_case, handles, special))
        axes.margins(0.04)
        axes.set_xlabel(across)
        axes.set_ylabel(label)
        page.explain([*handles, *special])
        page.joins = True
        if len(shown) > 1 or name:
            _explain_family(page, shown, title)
    return page.ax


def _explain_family(page: Page, shown: Sequence[_Shown], title: str | None) -> None:
    """Name the branches on the same axes by what differs between their cases, each kind of special
    points once, and what all have in common above a figure of this package."""
    names = dict.fromkeys(name for each in shown for name in each.values)
    common = {}
    for name in names:
        values = [each.values.get(name) for each in shown]
        if all(value == values[0] for value in values):
            common[name] = values[0]

    # the entries of the legend, which replace those that there were
    former = [*(each.looks for each in shown), *(each.special for each in shown)]
    replaced = {str(handle.get_label()) for handles in former for handle in handles}
    handles: list[Any] = []
    for number, each in enumerate(shown):
        differing = {name: value for name, value in each.values.items() if name not in common}
        text = each.name or what_case(differing) or f"branch {number + 1}"
        handles.append(sample(color=FAMILY[number % len(FAMILY)], linewidth=wide(1.4), label=text))
    looks: dict[str, Any] = {}
    for each in shown:
        looks |= {str(handle.get_label()): handle for handle in each.looks}
    marks: dict[str, Any] = {}
    for each in shown:
        for handle in each.special:
            marks.setdefault(str(handle.get_marker()), handle)
    for sign, handle in marks.items():
        handle.set_label(next(name for own, _, name in SPECIAL_MARKS.values() if own == sign))
    handles += [*looks.values(), *marks.values()]
    page.replaced = replaced | {str(handle.get_label()) for handle in handles}
    page.explain(handles)

    figure = page.figure
    if figure.get_gid() == OWN and title is None:
        width = float(figure.get_size_inches()[0])
        figure.suptitle(head_text(width, "", what_case(common)), fontsize=large(8))


def _axis_upward(branch: Branch, y: str) -> tuple[str, float]:
    """The label of what is drawn upward, and the factor from SI to the label's unit."""
    if len(branch.parameters) > 1:
        return axis_of(branch.parameters[1])
    known = isinstance(y, str) and y in branch.variables
    require((known, "y", y, f"must be one of {', '.join(branch.variables)}"))
    return label_of(xr.DataArray(name=y, attrs=branch.variables[y].attributes))


def _upward(of: Branch | SpecialPoint, branch: Branch, y: str) -> np.ndarray:
    """What is drawn upward, of all cycles of a branch or of a special point, in SI units."""
    if len(branch.parameters) > 1:
        return np.asarray(of.values[..., 1])
    return np.asarray(getattr(of, y))


def _refined_upward(branch: Branch, y: str) -> np.ndarray:
    """As `_upward` of all cycles, with those of the special points at which stability may change."""
    if len(branch.parameters) > 1:
        return branch.refined("values")[:, 1]
    return branch.refined(y)


def _mark_special_points(
    ax: Axes, branch: Branch, y: str, factors: tuple[float, float]
) -> list[Any]:
    """Mark the special points of a branch; returns the entries of a legend, with the value of a
    kind that is there once, or else how many there are. The factors are those from SI to the units
    of both axes."""
    across, upward = factors
    handles: list[Any] = []
    for kind, (sign, colour, name) in SPECIAL_MARKS.items():
        special = [each for each in branch.special if each.kind == kind]
        if not special:
            continue
        places = np.array([each.values[0] for each in special]) * across
        heights = [_upward(each, branch, y) * upward for each in special]
        text = f"{len(special)} {name}s"
        if len(special) == 1:
            text = f"{name} at {places[0]:.5g}"
        handles += ax.plot(
            places, heights, sign, label=text, color=colour, markersize=mark(4), markeredgewidth=0.5
        )
    return handles
