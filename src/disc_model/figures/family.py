"""Several branches on the same axes: their colours, and what legend and title say of them."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any
from weakref import WeakKeyDictionary

from disc_model.data.variables import typeset
from disc_model.display import counted
from disc_model.errors import require
from disc_model.figures.branch_lines import Look
from disc_model.figures.drawing import (
    BLACK,
    BLUE,
    BROWN,
    GREEN,
    GREY,
    INDIGO,
    OLIVE,
    ORANGE,
    PURPLE,
    ROSE,
    SEPARATED,
    SKY,
    large,
    sample,
)
from disc_model.figures.labels import without_font
from disc_model.figures.named_axes import shown_on
from disc_model.figures.pages import MOST_LINES, OWN, Page
from disc_model.figures.types import Axes
from disc_model.figures.words import head_text, stated_value, what_case
from disc_model.parameters import RATIOS

SPECIAL_MARKS = {
    "fold": ("s", SEPARATED, "fold"),
    "period_doubling": ("D", BLUE, "period doubling"),
    "neimark_sacker": ("o", BLUE, "Neimark-Sacker bifurcation"),
    "branch_point": ("*", BLACK, "branch point"),
    "grazing": ("X", SEPARATED, "grazing"),
    "hopf": ("^", BLUE, "Hopf point"),
}
"""Kinds of special points, with their mark, colour and name in the legend."""
LOOKS = (
    Look(BLACK),
    Look(GREEN, (5, 2)),
    Look(ORANGE, (4.5, 1.6, 1.2, 1.6)),
    Look(BROWN, (1.2, 1.8)),
    Look(SKY, (3, 3)),
    Look(PURPLE, (3, 1.3, 1.1, 1.3, 1.1, 1.3)),
    Look(BLUE, (7, 1.6)),
    Look(OLIVE, (4, 1.2, 2, 1.2)),
    Look(INDIGO, (2.6, 1.2, 1, 1.2)),
    Look(ROSE, (2, 1.1)),
)
"""Of branches on the same axes, in their order: dashes tell them apart in grey print."""
WIDTH = 1.4  # points, of their lines in the legend


@dataclass
class Shown:
    """A branch on axes: its name, if the reader gives one, what titles say of its case, the releases
    of stick in a period of its cycles, and its own entries of the legend; and words for values of
    which names of parameters say nothing."""

    name: str
    values: Mapping[str, Any]
    releases: int
    looks: list[Any]
    special: list[Any]
    said: Mapping[str, str] = field(default_factory=dict)


_SHOWN: WeakKeyDictionary[Axes, list[Shown]] = WeakKeyDictionary()
"""The branches that axes have."""


def name_and_labels(labels: Any) -> tuple[str, Any]:
    """The name that a reader gives a branch, "" for none, and the other labels."""
    if not isinstance(labels, Mapping) or "branch" not in labels:
        return "", labels
    name = labels["branch"]
    require((isinstance(name, str), "labels.branch", name, "must be a text"))
    return name, {word: text for word, text in labels.items() if word != "branch"}


def _branches_on(ax: Axes) -> list[Shown]:
    """The branches on axes from which they were not removed, as by ``ax.clear()``."""
    return _SHOWN.get(ax, []) if shown_on(ax).labels else []


def next_look(ax: Axes) -> Look:
    """The look of the next branch on axes."""
    return LOOKS[len(_branches_on(ax)) % len(LOOKS)]


def join_family(page: Page, new: Shown) -> None:
    """Add a branch to those on its axes. Of several, the legend names each by what differs between
    their cases and between their periods, and each kind of special points once; the title of a
    figure of this package says what all have in common."""
    family = [*_branches_on(page.ax), new]
    _SHOWN[page.ax] = family
    if len(family) > 1 or new.name:
        _explain(page, family)
    if len(family) > 1:
        retitle(page.figure, family)


def _explain(page: Page, family: Sequence[Shown]) -> None:
    """Set the entries of the legend, which replace those of each branch alone."""
    alone = [handle for each in family for handle in (*each.looks, *each.special)]
    replaced = {str(handle.get_label()) for handle in alone}
    replaced |= {*names_of(family[:-1])}  # a further branch may differ in something else

    handles: list[Any] = []
    for number, text in enumerate(names_of(family)):
        look = LOOKS[number % len(LOOKS)]
        handles.append(sample(label=text, **look.line(WIDTH)))
    looks: dict[str, Any] = {}
    marks: dict[str, Any] = {}
    for each in family:
        looks |= {str(handle.get_label()): handle for handle in each.looks}
    for handle in looks.values():
        handle.set_color(GREY)  # black would be that of a branch
    for each in family:
        marks |= {str(handle.get_marker()): handle for handle in each.special}
    for sign, _, name in SPECIAL_MARKS.values():
        if sign in marks:
            marks[sign].set_label(name)

    handles += [*looks.values(), *marks.values()]
    page.replaced = replaced | {str(handle.get_label()) for handle in handles}
    page.explain(handles)


def names_of(family: Sequence[Shown], word: str = "branch") -> list[str]:
    """Names of branches, or of what else a word says: those that a reader gives, or what differs
    between them, or numbers."""
    names = []
    for number, each in enumerate(family):
        names.append(each.name or _what_differs(each, family) or f"{word} {number + 1}")
    distinct = []
    for number, name in enumerate(names):
        alike = names.count(name) > 1 and not family[number].name
        distinct.append(f"{name}, {word} {number + 1}" if alike else name)
    return distinct


def _what_differs(branch: Shown, family: Sequence[Shown]) -> str:
    """What sets a branch apart from others on its axes: values of its case, and how many releases
    a period of its cycles has; "" if nothing does."""
    common = _common_values(family)
    said = []
    for name, value in _without_ratios(branch, family).items():
        if name not in common:
            said.append(branch.said.get(name) or typeset(stated_value(name, value)))
    if len({each.releases for each in family}) > 1:
        said.append(f"{counted(branch.releases, 'release')} per period")
    return ", ".join(filter(None, said))


def retitle(figure: Any, family: Sequence[Shown], first: str = "") -> None:
    """Let the title say what all branches have in common, unless the reader has given another.

    first : what it says of the first alone, if this is more than its values
    """
    width = float(figure.get_size_inches()[0])
    before = family[:-1]
    said = what_case(_common_values(before))
    if first and len(before) == 1:
        said = first
    former = head_text(width, "", said, MOST_LINES)
    if figure.get_gid() == OWN and without_font(figure.get_suptitle()) == former:
        said = head_text(width, "", what_case(_common_values(family)), MOST_LINES)
        figure.suptitle(said, fontsize=large(8))


def _common_values(family: Sequence[Shown]) -> dict[str, Any]:
    """The values that the cases of all branches have in common."""
    first, *others = (_without_ratios(each, family) for each in family)
    common = {}
    for name, value in first.items():
        if all(name in other and _equal(other[name], value) for other in others):
            common[name] = value
    return common


def _without_ratios(branch: Shown, family: Sequence[Shown]) -> dict[str, Any]:
    """The values of a branch, with a parameter in place of a ratio that others do not state: both
    may say the same."""
    values = dict(branch.values)
    for ratio, (name, other) in RATIOS.items():
        stated_by_all = all(ratio in each.values for each in family)
        if ratio in values and other in values and not stated_by_all:
            values[name] = values.pop(ratio) * values[other]
    return values


def _equal(one: Any, another: Any) -> bool:
    """Whether two values are the same but for rounding."""
    if isinstance(one, float | int) and isinstance(another, float | int):
        return math.isclose(one, another, rel_tol=1e-12)
    return bool(one == another)
