"""What the axes of pictures show, so that a further picture of something else does not take their
words."""

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary, WeakSet

from disc_model.errors import Fault, raise_faults
from disc_model.figures.covered import twins_of
from disc_model.figures.labels import words_of
from disc_model.figures.types import Axes

UNIT = re.compile(r"\(([^()]+)\)$")
"""The unit at the end of a label."""
REMEDIES = {
    "x": "other axes, such as those of ax.twiny()",
    "y": "other axes, such as those of ax.twinx()",
    "bar": "other axes",
}
"""Where another quantity can be drawn, by the axis along which one is shown."""
SAME = {
    "Growth rate of the stick-slip cycle (1/s)": "Growth rate of the cycle (1/s)",
    "Growth rate of the cycle, or of sliding (1/s)": "Growth rate of the cycle (1/s)",
}
"""Labels of one quantity in other words."""


class Quantities(NamedTuple):
    """What a panel shows along its axes and by its colours, as labels with units; "" for nothing.

    alike : labels of other quantities along "y" in whose company it may be
    """

    x: str
    y: str
    bar: str = ""
    alike: Collection[str] = ()

    @property
    def labels(self) -> dict[str, str]:
        return {"x": self.x, "y": self.y, "bar": self.bar}


@dataclass
class Shown:
    """What pictures of this package show on axes: labels of quantities, the words that these
    pictures have written there, and what they have drawn."""

    labels: dict[str, str] = field(default_factory=dict)
    written: dict[str, str] = field(default_factory=dict)
    drawn: WeakSet[Any] = field(default_factory=WeakSet)


_SHOWN: WeakKeyDictionary[Axes, Shown] = WeakKeyDictionary()


def shown_on(ax: Axes) -> Shown:
    """What pictures show on axes; nothing if all that they have drawn was removed, as by
    ``ax.clear()``."""
    shown = _SHOWN.get(ax, Shown())
    return Shown() if shown.drawn.isdisjoint(ax.get_children()) else shown


def unit_in(label: str) -> str:
    """The unit at the end of a label; "" if there is none."""
    found = UNIT.search(label)
    return found[1] if found else ""


def check_axes(axes: Sequence[Axes], panels: Iterable[Quantities], asked: Collection[str]) -> None:
    """Raise `ParameterError` if axes show something else than a further picture would, unless its
    reader has asked for a label of the axis."""
    faults: list[Fault] = []
    for ax, quantities in zip(axes, panels, strict=True):
        for along, label in quantities.labels.items():
            if label and along not in asked:
                faults += _faults(ax, along, label, quantities.alike if along == "y" else ())
    raise_faults(dict.fromkeys(faults).keys())


def check_free(axes: Sequence[Axes], label: str, picture: str) -> None:
    """Raise `ParameterError` if axes have a picture already over which a second one could not be told
    from it; it has this label along its vertical axis."""
    shows = any(shown_on(ax).labels.get("y") == label for ax in axes)
    rule = f"shows {picture} already: give each its own axes"
    raise_faults([Fault(("ax",), "", rule)] if shows else [])


def refuse_beside_areas(axes: Sequence[Axes], areas: str) -> None:
    """Raise `ParameterError` if axes have a map or bars of a picture, which areas such as "a map" would
    cover."""
    rule = f"shows areas in colour already, which {areas} would cover: draw on {REMEDIES['bar']}"
    for ax in axes:
        if shown_on(ax).labels.get("bar"):
            raise_faults([Fault(("ax",), "", rule)])


def _faults(ax: Axes, along: str, label: str, alike: Collection[str]) -> Iterator[Fault]:
    """Yield what is wrong with a picture that has a label along axes."""
    own = own_label(ax, along)
    where = "by colour" if along == "bar" else f"along {along}"
    remedy = f"draw on {REMEDIES[along]}, or give a label for both, as by labels={{'{along}': ...}}"
    former = _former(ax, along)
    for text in former:
        same = SAME.get(text, text) == SAME.get(label, label) or text in alike
        if not same and (not own or unit_in(label) != unit_in(own)):
            rule = f"shows “{text}” {where}, and “{label}” is something else: {remedy}"
            yield Fault(("ax",), "", rule)
            return
    if own and not former and unit_in(own) and unit_in(label) not in ("", unit_in(own)):
        rule = f"has the label “{own}” {where}, and “{label}” has another unit: {remedy}"
        yield Fault(("ax",), "", rule)


def _former(ax: Axes, along: str) -> list[str]:
    """What pictures show along axes, or along those on the same place that share the axis."""
    places = [ax]
    if along != "bar":
        shared = ax.get_shared_x_axes() if along == "x" else ax.get_shared_y_axes()
        places += [twin for twin in twins_of(ax) if shared.joined(ax, twin)]
    return [*filter(None, (shown_on(place).labels.get(along, "") for place in places))]


def own_label(ax: Axes, along: str) -> str:
    """The label that a reader has given an axis; "" if it has none, or that of a picture."""
    if along == "bar":
        return ""
    words = words_of(ax.xaxis.label if along == "x" else ax.yaxis.label)
    return "" if words == shown_on(ax).written.get(along) else words


def own_labels(ax: Axes) -> dict[str, str]:
    """The labels that a reader has given axes, by "x" and "y"."""
    labels = {along: own_label(ax, along) for along in ("x", "y")}
    return {along: words for along, words in labels.items() if words}


def remember(
    ax: Axes, quantities: Quantities, before: Collection[Any], own: Mapping[str, str]
) -> None:
    """Remember what a picture shows on axes.

    before : what was drawn there already
    own : labels that are the reader's
    """
    former = shown_on(ax)
    labels = {along: label for along, label in quantities.labels.items() if label}
    written = {"x": words_of(ax.xaxis.label), "y": words_of(ax.yaxis.label)}
    shown = Shown({**former.labels, **labels})
    shown.written = {along: words for along, words in written.items() if along not in own}
    known = {id(artist) for artist in before}
    shown.drawn.update(former.drawn)
    shown.drawn.update(artist for artist in ax.get_children() if id(artist) not in known)
    _SHOWN[ax] = shown
