"""Several sweeps on the same axes: what tells their lines apart, and how the legend names them."""

from __future__ import annotations

from collections.abc import Sequence

from disc_model.figures.covered import twins_of
from disc_model.figures.family import Member, names_of
from disc_model.figures.family_titles import retitle
from disc_model.figures.pages import Page
from disc_model.figures.sweep_lines import (
    Lines,
    add_lines,
    common_tail,
    lines_beside,
    lines_on,
    without_sought,
)
from disc_model.figures.sweep_options import COMPARED, unset_text
from disc_model.figures.valueless_lines import name_line


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


def join_lines(page: Page, new: Lines) -> list[int]:
    """Add lines to those on their axes. Of several, the legend names each by what differs between
    their variables and cases, or as its reader does. Returns the numbers of several."""
    family = [*lines_beside(page.ax), new]
    add_lines(page.ax, new)
    shown = [each.shown for each in family]
    names = [new.shown.name]
    tail = common_tail([each.phrase for each in family])  # which the axis says
    for each in family:
        short = each.phrase.removesuffix(tail).rstrip(" ,")
        short = without_sought(short, each.sought)
        each.shown.values = {**each.shown.values, "variable": short, "sought": each.sought}
    if len({each.function for each in family}) > 1:
        _compare_functions(family)
    else:
        _with_unset(family)
    if len(family) > 1:
        names = _distinct(names_of(shown, "sweep"), shown)
        retitle(page, shown)

    page.joins = True
    # lines of a former variable of the page may have replaced names already
    page.replaced = [*page.replaced, *_rename(family, names)]
    axes = [*filter(lines_on, twins_of(page.ax)), page.ax]
    page.explain([each for ax in axes for each in ax.get_legend_handles_labels()[0]])
    return [each.number for each in family] if len(family) > 1 else []


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
                former = str(line.get_label())
                name_line(line, text)
                replaced += [former, str(line.get_label())]
    return replaced
