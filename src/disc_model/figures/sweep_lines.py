"""Lines of several sweeps, or of several variables of one, on the same axes: their looks, and what axis
and legend call them."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any
from weakref import WeakKeyDictionary, ref

import xarray as xr

from disc_model.errors import require
from disc_model.figures.covered import twins_of
from disc_model.figures.durations import duration_of
from disc_model.figures.family import Member, name_in, names_of, retitle
from disc_model.figures.named_axes import Quantities, shown_on
from disc_model.figures.pages import Page
from disc_model.figures.sweep_options import COMPARED, function_of, sought_in, unset_text
from disc_model.figures.types import Axes
from disc_model.figures.words import named

CASE = "case"
"""The label by which a reader names all lines of a sweep."""
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


_LINES: WeakKeyDictionary[Axes, list[Lines]] = WeakKeyDictionary()
"""The lines of sweeps that axes have."""


def lines_on(ax: Axes) -> list[Lines]:
    """The lines of sweeps on axes from which they were not removed."""
    return _LINES.get(ax, []) if shown_on(ax).labels else []


def lines_beside(ax: Axes) -> list[Lines]:
    """The lines of sweeps on axes, and those on others on the same place, from which they differ in
    look and name."""
    return [line for each in (*twins_of(ax), ax) for line in lines_on(each)]


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
    shown = Member(name, {"variable": phrase, "sought": sought, **case})
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
    return ""


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


def _within(name: str) -> str:
    """A name after other words: its first word has no capital, unless it is a symbol."""
    first = name.partition(" ")[0]
    return name[0].lower() + name[1:] if first[1:].islower() else name


def _distinct(names: Sequence[str], family: Sequence[Member]) -> list[str]:
    """Names of lines, with their variables where a reader gives several of them one name."""
    found = []
    for name, each in zip(names, family, strict=True):
        alike = each.name and names.count(name) > 1
        found.append(f"{name}, {_within(each.values['variable'])}" if alike else name)
    return found


def _compare_functions(family: Sequence[Lines]) -> None:
    """Let lines of several functions be told apart by what is sought, and by times, but not by options that
    are settings of one of them."""
    all_seek = all(each.sought for each in family)
    for each in family:
        settings = {*each.options} - {*COMPARED}
        kept = {name: value for name, value in each.shown.values.items() if name not in settings}
        if all_seek:  # which tells more than the name of a speed
            kept["variable"] = kept.pop("sought")
        each.shown.values = kept


def _with_unset(family: Sequence[Lines]) -> None:
    """Let lines of one function say of options that only others of them have set that they are not set."""
    names = [name for each in family for name in each.options]
    for each in family:
        unset = {name: unset_text(name) for name in names if name not in each.options}
        first = {name: each.shown.values[name] for name in ("variable", "sought")}
        each.shown.values = {**first, **unset, **each.shown.values}
        each.shown.said = {**each.shown.said, **unset}
        each.options = {*each.options, *unset}


def join_lines(page: Page, new: Lines) -> dict[int, str]:
    """Add lines to those on their axes. Of several, the legend names each by what differs between
    their variables and cases, or as its reader does. Returns the names of several by their numbers."""
    family = [*lines_beside(page.ax), new]
    _LINES[page.ax] = [*lines_on(page.ax), new]
    shown = [each.shown for each in family]
    names = [new.shown.name]
    called: dict[int, str] = {}
    tail = common_tail([each.phrase for each in family])  # which the axis says
    for each in family:
        short = each.phrase.removesuffix(tail).rstrip(" ,")
        each.shown.values = {**each.shown.values, "variable": short, "sought": each.sought}
    if len({each.function for each in family}) > 1:
        _compare_functions(family)
    else:
        _with_unset(family)
    if len(family) > 1:
        names = _distinct(names_of(shown, "sweep"), shown)
        retitle(page, shown)
        called = dict(zip([each.number for each in family], names, strict=True))

    page.joins = True
    # lines of a former variable of the page may have replaced names already
    page.replaced = [*page.replaced, *_rename(family, names)]
    axes = [*filter(lines_on, twins_of(page.ax)), page.ax]
    page.explain([each for ax in axes for each in ax.get_legend_handles_labels()[0]])
    return called


def _rename(family: Sequence[Lines], names: Sequence[str]) -> list[str]:
    """Give lines their names among several; returns each former label before the one in its place."""
    replaced = []
    for each, name in zip(family, names, strict=True):
        for part, reference in each.parts:
            line = reference()
            if part and not each.shown.name:
                name = _within(name)
            text = ", ".join(filter(None, (part, name)))
            if line is not None and text:
                replaced += [str(line.get_label()), text]
                line.set_label(text)
    return replaced
