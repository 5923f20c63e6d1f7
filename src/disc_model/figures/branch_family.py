"""Several branches of cycles on the same axes: the entries of their legend, and their title."""

from collections.abc import Sequence
from typing import Any

from disc_model.figures.branch_lines import Look, dot_in_legend, stable_line, unstable_line
from disc_model.figures.branch_wishes import AS_USUAL, PartLooks
from disc_model.figures.drawing import BLACK, BLUE, GREY, SEPARATED, sample
from disc_model.figures.family import LOOKS, Member, names_of
from disc_model.figures.family_titles import retitle
from disc_model.figures.kept import Kept
from disc_model.figures.named_axes import shown_on
from disc_model.figures.pages import Page
from disc_model.figures.types import Axes, Mask

NAME = "branch"
"""The label by which a reader names a branch."""
NO_FURTHER = "continued no further"
"""Said of ends at which a branch may go on."""
SPECIAL_MARKS = {
    "fold": ("s", SEPARATED, "fold"),
    "period_doubling": ("D", BLUE, "period doubling"),
    "neimark_sacker": ("o", BLUE, "Neimark-Sacker bifurcation"),
    "branch_point": ("*", BLACK, "branch point"),
    "grazing": ("X", SEPARATED, "grazing"),
    "hopf": ("^", BLUE, "Hopf point"),
    "max_points": ("P", BLACK, f"{NO_FURTHER}: max_points"),
    "lost": ("p", BLACK, f"{NO_FURTHER}: no step succeeds"),
}
"""Kinds of special points, with their mark, colour and name in the legend."""
WIDTH = 1.4  # points, of their lines in the legend


_BRANCHES: Kept[list[Member]] = Kept("branches")
"""The branches that axes have."""


def _branches_on(ax: Axes) -> list[Member]:
    """The branches on axes from which they were not removed, as by ``ax.clear()``."""
    return _BRANCHES.get(ax, []) if shown_on(ax).labels else []


def next_look(ax: Axes, wished: PartLooks = AS_USUAL) -> Look:
    """The look of the next branch on axes, without dashes of its own where those that a reader wishes
    tell its stability."""
    look = LOOKS[len(_branches_on(ax)) % len(LOOKS)]
    return Look(look.colour) if wished.tell_stability else look


def line_in_legend(look: Look, stable: Mask, wished: PartLooks) -> dict[str, Any]:
    """Options of the line of a branch in a legend of several; with dots where it is unstable throughout."""
    if stable.any():
        return stable_line(look, wished, WIDTH)
    return {**unstable_line(look, wished), **dot_in_legend(wished)}


def join_family(page: Page, new: Member) -> None:
    """Add a branch to those on its axes. Of several, the legend names each by what differs between
    their cases and between their periods, and each kind of special points once; the title of a
    figure of this package says what all have in common."""
    family = [*_branches_on(page.ax), new]
    _BRANCHES[page.ax] = family
    if len(family) > 1 or new.name:
        _explain(page, family)
    if len(family) > 1:
        retitle(page, family)


def _explain(page: Page, family: Sequence[Member]) -> None:
    """Set the entries of the legend, which replace those of each branch alone."""
    alone = [handle for each in family for handle in (*each.looks, *each.special)]
    replaced = {str(handle.get_label()) for handle in alone}
    replaced |= {*names_of(family[:-1], NAME)}  # a further branch may differ in something else

    names = names_of(family, NAME)
    handles = [sample(label=text, **each.line) for each, text in zip(family, names, strict=True)]
    looks = _looks_of(family)
    stable_first = sorted(looks, key=lambda label: label != "stable")
    handles += [*(looks[label] for label in stable_first), *_marks_of(family)]
    page.replaced = replaced | {str(handle.get_label()) for handle in handles}
    page.explain(handles)


def _looks_of(family: Sequence[Member]) -> dict[str, Any]:
    """Handles of the looks of stable and unstable parts, which branches share, by label; in grey, as black
    would be that of a branch, but where a reader has wished a colour."""
    looks = {str(handle.get_label()): handle for each in family for handle in each.looks}
    coloured = {label for each in family for label in each.coloured}
    for label in looks.keys() - coloured:
        looks[label].set_color(GREY)
    return looks


def _marks_of(family: Sequence[Member]) -> list[Any]:
    """Handles of the special points of all branches, each kind of mark once and under its name."""
    marks = {str(handle.get_marker()): handle for each in family for handle in each.special}
    for sign, _, name in SPECIAL_MARKS.values():
        if sign in marks:
            marks[sign].set_label(name)
    return [*marks.values()]
