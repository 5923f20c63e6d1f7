"""Several cases on the same axes, such as branches or runs: their looks, and their names in the
legend.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from disc_model.data.variables import typeset
from disc_model.display import counted
from disc_model.errors import require
from disc_model.figures.branch_lines import Look
from disc_model.figures.disc_names import disc_name, same_disc, without_plates
from disc_model.figures.drawing import (
    BLACK,
    BLUE,
    BROWN,
    GREEN,
    INDIGO,
    OLIVE,
    ORANGE,
    PURPLE,
    ROSE,
    SKY,
)
from disc_model.figures.value_texts import stated_value
from disc_model.parameters import RATIOS

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
"""Of members of a family, in their order: dashes tell them apart in grey print."""

DISC = "disc"
"""The parameter that is a table of modes, or None for a plate."""


@dataclass
class Member:
    """One of several cases on the same axes.

    Attributes
    ----------
    name : the one that a reader gives it, "" for none
    values : what titles say of its case
    releases : of stick in a period of its cycles
    looks : its entries of the legend when it is alone
    special : those of its special points
    line : options of its line in the legend
    coloured : labels of those of its looks whose colour is the reader's own
    said : words for values of which names of parameters say nothing
    selected : words for those at which a study was selected, which titles have as well
    """

    name: str
    values: Mapping[str, Any]
    releases: int = 0
    looks: list[Any] = field(default_factory=list)
    special: list[Any] = field(default_factory=list)
    line: dict[str, Any] = field(default_factory=dict)
    coloured: Sequence[str] = ()
    said: Mapping[str, str] = field(default_factory=dict)
    selected: Mapping[str, str] = field(default_factory=dict)


def name_in(labels: Any, word: str) -> tuple[str, Any]:
    """The name that a reader gives a case by a word such as "branch", "" for none, and the other
    labels."""
    if not isinstance(labels, Mapping) or word not in labels:
        return "", labels
    name = labels[word]
    require((isinstance(name, str), f"labels.{word}", name, "must be a text"))
    return name, {key: text for key, text in labels.items() if key != word}


def names_of(family: Sequence[Member], word: str) -> list[str]:
    """Names of members, each of which is what a word says: those that a reader gives, with what differs
    between members of one name, or what differs between all. Where two would have one name, or one has
    none, all have numbers as well, but those that a reader alone has named."""
    names = [_given_name(each, family) or _what_differs(each, family) for each in family]
    if all(names) and len(set(names)) == len(names):
        return names
    given = [each.name for each in family]
    distinct = []
    for number, name in enumerate(names):
        is_readers = given[number] == name and names.count(name) == 1
        numbered = ", ".join(filter(None, (name, f"{word} {number + 1}")))
        distinct.append(name if name and is_readers else numbered)
    return distinct


def _given_name(member: Member, family: Sequence[Member]) -> str:
    """The name that a reader gives a member, with what sets it apart from others of this name; "" for
    none."""
    namesakes = [each for each in family if each.name == member.name]
    if not member.name or len(namesakes) < 2:
        return member.name
    return ", ".join(filter(None, (member.name, _what_differs(member, namesakes))))


def _what_differs(member: Member, family: Sequence[Member]) -> str:
    """What sets a member apart from others on its axes: values of its case, and how many releases
    a period of its cycles has; "" if nothing does."""
    common = common_values(family)
    said = []
    values = _without_ratios(member, family)
    # which kind of disc it is comes first
    for name in sorted(values, key=lambda name: name != DISC):
        if name not in common:
            said.append(member.said.get(name) or _value_said(name, values[name], family))
    if len({each.releases for each in family}) > 1:
        said.append(f"{counted(member.releases, 'release')} per period")
    return ", ".join(filter(None, said))


def _value_said(name: str, value: Any, family: Sequence[Member]) -> str:
    """What the legend says of a value that differs between members."""
    if name == DISC:
        return disc_name(value, _discs_of(family))
    return typeset(stated_value(name, value))


def _discs_of(family: Sequence[Member]) -> list[Any]:
    """The discs of all members, None for those given by their sizes and material."""
    return [each.values.get(DISC) for each in family]


def common_values(family: Sequence[Member]) -> dict[str, Any]:
    """The values that the cases of all members have in common."""
    first, *others = (_without_ratios(each, family) for each in family)
    common = {}
    for name, value in first.items():
        same = same_disc if name == DISC else _equal
        if all(name in other and same(other[name], value) for other in others):
            common[name] = value
    return common


def _without_ratios(member: Member, family: Sequence[Member]) -> dict[str, Any]:
    """The values of a member, with a parameter in place of a ratio that others do not state: both
    may say the same."""
    values = without_plates(member.values, _discs_of(family))
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
