"""Lines of several sweeps, or of several variables of one, on the same axes, and what the axis
calls them."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any
from weakref import ref

import xarray as xr

from disc_model.errors import require
from disc_model.figures.covered import twins_of
from disc_model.figures.durations import duration_of
from disc_model.figures.family import Member, name_in
from disc_model.figures.kept import Kept
from disc_model.figures.named_axes import Quantities, shown_on
from disc_model.figures.sweep_options import function_of, sought_in
from disc_model.figures.types import Axes
from disc_model.figures.words import named

CASE = "case"
"""The label by which a reader names all lines of a sweep."""
EDGE = " at separation (onset|end)$"
"""What phrases say of a number of a sweep at which separation begins or ends."""
KINDS = {"Whether ": "Yes or no", "Share of ": "Share"}
"""Names of several variables without a unit, by how their own names begin."""
OF_UNITS = {"s": "Time", "ms": "Time", "J": "Energy", "Hz": "Frequency", "N": "Force"}
"""Names of several variables that have no word in common, by their unit."""
LOOSE = {"a", "an", "and", "at", "by", "for", "from", "in", "of", "on", "over", "the", "to", "with"}
LOOSE |= {"that", "which", "whose"}
"""Words at which what a name is of begins."""


@dataclass
class Lines:
    """Lines of a variable on axes.

    Attributes
    ----------
    across, label : labels of both axes if the lines are alone
    phrase, unit : name of the variable, and its unit
    duration : time for which motions were followed, "" if the variable does not depend on it
    shown : what tells the lines from others
    function, sought : what computed the lines, and in words, what critical values are those of
    options : names of the options of that function that are set
    number : their place in the order in which lines were drawn there
    parts : name along a second dimension, "" without one, of each line, and the line
    """

    across: str
    label: str
    phrase: str
    unit: str
    duration: str
    shown: Member
    function: str = ""
    sought: str = ""
    options: Collection[str] = ()
    number: int = 0
    parts: Sequence[tuple[str, ref[Any]]] = ()


_LINES: Kept[list[Lines]] = Kept("lines of sweeps")
"""The lines of sweeps that axes have."""


def lines_on(ax: Axes) -> list[Lines]:
    """The lines of sweeps on axes from which they were not removed."""
    return _LINES.get(ax, []) if shown_on(ax).labels else []


def lines_beside(ax: Axes) -> list[Lines]:
    """The lines of sweeps on axes, and those on others on the same place, from which they differ in
    look and name."""
    return [line for each in (*twins_of(ax), ax) for line in lines_on(each)]


def add_lines(ax: Axes, lines: Lines) -> None:
    """Add lines to those that axes have."""
    _LINES[ax] = [*lines_on(ax), lines]


def names_asked(labels: Any, variables: Sequence[str]) -> tuple[dict[str, str], Any]:
    """The names that a reader gives lines, by variables, and the other labels; one of the case is
    that of all its lines."""
    if not isinstance(labels, Mapping):
        return {}, labels
    case, labels = name_in(labels, CASE)
    if case:
        labels = {**dict.fromkeys(variables, case), **labels}
    names = {name: text for name, text in labels.items() if name in variables}
    for name, text in names.items():
        require((isinstance(text, str), f"labels.{name}", text, "must be a text"))
    return names, {name: text for name, text in labels.items() if name not in variables}


OF_INSTABILITY = re.compile(" for (?:instability of|separation)")
"""How a name begins to say what its values are critical for."""


def without_sought(phrase: str, sought: str) -> str:
    """The name of a variable without what its values are critical for, if other words say this."""
    return OF_INSTABILITY.split(phrase)[0] if sought else phrase


def lines_of(
    study: xr.Dataset, variable: str, labels: tuple[str, str], name: str, case: Mapping[str, Any]
) -> Lines:
    """Lines that are not drawn yet.

    labels : of both axes
    name : the one that a reader gives them, "" for none
    case : values of the case that do not vary
    """
    phrase, unit, _ = named(study[variable])
    duration = duration_of(study, variable)
    sought = sought_in(study)
    shown = Member(name, {"variable": without_sought(phrase, sought), "sought": sought, **case})
    return Lines(*labels, phrase, unit, duration, shown, function_of(study), sought)


def quantities_of(lines: Lines, others: Sequence[Lines]) -> Quantities:
    """What axes show with lines beside others: variables of one unit have a common name, and one
    variable has its own whatever the times for which motions were followed."""
    labels = {each.label for each in others}
    units = {each.unit for each in (*others, lines)}
    phrases = {each.phrase for each in (*others, lines)}
    is_alike = units != {""} or kind_of_phrases(phrases)
    of_one_kind = len(units) == 1 and (len(phrases) == 1 or is_alike)
    if labels - {lines.label} and of_one_kind:
        labels.add(_common_label(others))
        return Quantities(lines.across, _common_label([*others, lines]), alike=labels)
    return Quantities(lines.across, lines.label)


def _common_label(family: Sequence[Lines]) -> str:
    """The label of an axis for several lines of one unit, with the time for which motions were followed
    if it is that of all."""
    first = family[0]
    if len({each.label for each in family}) == 1:
        return first.label
    words = first.phrase
    phrases = [each.phrase for each in family]
    if len({*phrases}) > 1:
        words = kind_of_phrases(phrases) or common_name(phrases, first.unit)
    if len({each.duration for each in family}) == 1 and first.duration:
        words = f"{words} within {first.duration}"
    return f"{words} ({first.unit})" if first.unit else words


def kind_of_phrases(phrases: Collection[str]) -> str:
    """The name of what all phrases without a unit are, "" if they may be of several kinds."""
    for beginning, name in KINDS.items():
        if all(phrase.startswith(beginning) for phrase in phrases):
            return name
    return _swept_number(phrases)


def _swept_number(phrases: Collection[str]) -> str:
    """What all phrases call a number at which separation begins or ends, "" if they are of others."""
    numbers = {re.sub(EDGE, "", phrase) for phrase in phrases}
    are_edges = all(re.search(EDGE, phrase) for phrase in phrases)
    if not are_edges or len(numbers) > 1:
        return ""
    number = numbers.pop()
    return number[0].upper() + number[1:]


def common_name(phrases: Sequence[str], unit: str = "") -> str:
    """The name of what all phrases say, or of what has their unit."""
    words = common_words(phrases) or OF_UNITS.get(unit, "Value")
    return f"{words} {common_tail(phrases)}".strip()


def common_tail(phrases: Sequence[str]) -> str:
    """The words at the end of all phrases, if these are several, that say where or of what; "" if
    there are none."""
    if len(set(phrases)) < 2:
        return ""
    split = [phrase.split() for phrase in phrases]
    count = 0
    for column in zip(*(reversed(words[1:]) for words in split), strict=False):
        if len({*column}) > 1:
            break
        count += 1
    tail = split[0][len(split[0]) - count :]
    while tail and tail[0] not in LOOSE:
        tail = tail[1:]
    return " ".join(tail)


def common_words(phrases: Sequence[str]) -> str:
    """The words in a row that all phrases have, those that come first in the first of them, without
    what they are of; "" if there are none."""
    words = phrases[0].split()
    others = [f" {phrase.lower()} " for phrase in phrases[1:]]
    for start in range(len(words)):
        for end in range(len(words), start, -1):
            row = words[start:end]
            said = " ".join(row)
            if LOOSE & {*said.lower().split()}:
                continue
            if all(f" {said.lower()} " in other for other in others):
                return said[0].upper() + said[1:]
    return ""
