"""What a reader asks of a picture's axes, legend, labels and title, and how it is written."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from inspect import signature
from typing import Any, Literal

import numpy as np
from matplotlib.legend import Legend

from disc_model.errors import require, suggestion
from disc_model.figures.axis_numbers import write_in_full
from disc_model.figures.case_titles import write_case
from disc_model.figures.drawing import large
from disc_model.figures.least_span import keep_least_span
from disc_model.figures.named_axes import Quantities, check_axes, own_labels, remember
from disc_model.figures.symbols import in_a_row
from disc_model.figures.types import Artist, Axes

Place = Literal["inside", "beside", "below"]
OWN = "disc_model"  # group id of figures that this package has made
LEGEND_OPTIONS = [*signature(Legend).parameters][3:]  # after its axes, handles and labels
TITLE_RULE = "must be a text, True or False"
LEGEND_RULE = "must be True, False, or options of a legend of matplotlib"


@dataclass(frozen=True)
class Wishes:
    """What a reader asks of a picture.

    ax : axes to draw on, one or several; None for a new figure
    legend : whether there is a legend; or options of `Axes.legend`, such as the size of its text, or its
        place in that of the usual one
    labels : other words for labels of axes, which are called "x" and "y", of a bar of colours,
        called "bar", and for entries of the legend, which are called as they are without
    title : another title; "" or False for none, None for the usual one; True also for the values of
        the case above a reader's axes
    """

    ax: Any = None
    legend: bool | Mapping[str, Any] = True
    labels: Mapping[str, str] | None = None
    title: str | bool | None = None

    def check(self) -> None:
        """Raise `ParameterError` if a wish cannot be understood."""
        options = self.legend if isinstance(self.legend, Mapping) else {}
        unknown = [name for name in options if name not in LEGEND_OPTIONS]
        wrong = next(iter(unknown), None)
        like = suggestion(wrong, LEGEND_OPTIONS, all_of_them=False)
        labels = {} if self.labels is None else self.labels
        require(
            (isinstance(self.legend, bool | Mapping), "legend", self.legend, LEGEND_RULE),
            (not unknown, "legend", wrong, f"{LEGEND_RULE}{like}"),
            (_are_texts(labels), "labels", labels, "must be texts by x, y, or what they replace"),
            (isinstance(self.title, str | bool | None), "title", self.title, TITLE_RULE),
        )

    @property
    def has_usual_title(self) -> bool:
        """Whether the title is what the picture says of itself."""
        return self.title is None or self.title is True


def _are_texts(labels: object) -> bool:
    """Whether these are texts by texts."""
    if not isinstance(labels, Mapping):
        return False
    return all(isinstance(text, str) for text in (*labels, *labels.values()))


@dataclass
class Page:
    """Axes that a picture is drawn on, and the entries of its legend.

    axes : one for each panel, row by row
    own : whether the figure is a new one
    asked : labels that the reader asks for
    shown : what each panel shows along its axes
    handles : entries of the legend; none if there is none
    beside : where the legend stands on a reader's axes; below them, or beside a square panel, if it would
        cover something
    heading : title of the legend
    note : what stands above the first panel, unless the reader asks for another title
    case : the values of its case, in words
    joins : whether the entries of a legend that the axes have are kept
    replaced : words of such entries that are not
    bars : axes of bars of colours
    legend : the one that was written beside a reader's axes, unless the reader has placed it
    spare : inches beside a legend below a reader's axes that it leaves free
    is_small : whether the text of the legend of a new figure is small, however few entries it has
    is_map : whether a new figure grows so that its panels keep their height beside the legend
    """

    axes: list[Axes]
    own: bool
    asked: Mapping[str, str] = field(default_factory=dict)
    shown: Sequence[Quantities] = ()
    handles: Sequence[Artist] = field(default_factory=list)
    beside: Place = "inside"
    heading: str = ""
    note: str = ""
    case: str = ""
    joins: bool = False
    replaced: Collection[str] = ()
    bars: Sequence[Axes] = field(default_factory=list)
    legend: Any = None
    spare: float = 0.0
    is_small: bool = False
    is_map: bool = False

    def __post_init__(self) -> None:
        self._before = [ax.get_children() for ax in self.axes]
        self._labelled = [own_labels(ax) for ax in self.axes]

    @property
    def ax(self) -> Axes:
        """The first panel."""
        return self.axes[0]

    @property
    def figure(self) -> Any:
        return self.ax.get_figure()

    @property
    def beside_last(self) -> list[Axes]:
        """The bars, and the panels in the row of the last one, below which its legend may stand too."""
        last = self.axes[-1].get_position(original=True)
        heights = [ax.get_position(original=True) for ax in self.axes[:-1]]
        row = zip(self.axes[:-1], heights, strict=True)
        return [*self.bars, *(ax for ax, place in row if np.isclose(place.y0, last.y0))]

    def show(self, *panels: Quantities) -> None:
        """Say what the panels show, before anything is drawn; raises `ParameterError` if a reader's
        axes show something else."""
        check_axes(self.axes, panels, self.asked)
        self.shown = panels

    def remove(self, ax: Axes) -> None:
        """Remove a panel that is not needed from a new figure, before anything is drawn."""
        place = self.axes.index(ax)
        for listed in (self.axes, self._before, self._labelled):
            del listed[place]
        ax.remove()

    def keep_labels(self) -> None:
        """Give axes the labels of their reader back."""
        for ax, labels in zip(self.axes, self._labelled, strict=True):
            ax.set(**{f"{along}label": words for along, words in labels.items()})

    def added(self) -> list[list[Artist]]:
        """What the picture has drawn so far in each panel."""
        found = []
        for ax, before in zip(self.axes, self._before, strict=True):
            known = {id(artist) for artist in before}
            found.append([artist for artist in ax.get_children() if id(artist) not in known])
        return found

    def remember(self) -> None:
        """Remember what the panels show, for further pictures on them."""
        for ax, shown, before, labelled in zip(
            self.axes, self.shown, self._before, self._labelled, strict=True
        ):
            remember(ax, shown, before, {**labelled, **self.asked})

    def explain(self, handles: Sequence[Artist], beside: Place = "inside", title: str = "") -> None:
        """Set the entries of the legend, its title, and where it stands on a reader's axes."""
        self.handles = handles
        self.beside = beside
        self.heading = title


def given_axes(ax: Any, count: int) -> list[Axes]:
    """The axes of a reader, if they are as many as panels; raises `ParameterError`."""
    given = list(np.ravel(np.asarray(ax, dtype=object)))
    fit = len(given) == count and all(isinstance(each, Axes) for each in given)
    require((fit, "ax", given, f"must be {count} axes of matplotlib, one for each panel"))
    return given


def restate(page: Page, wishes: Wishes) -> None:
    """Write the title and labels that a reader asks for."""
    if wishes.title is True and not page.own:
        write_case(page.ax, page.case, page.note)
    elif wishes.has_usual_title:
        if page.note:
            page.ax.set_title(page.note, loc="left", fontsize=large(8))
    elif not page.own:
        page.ax.set_title("")
        if wishes.title:  # at the left, in the size of the values of a case that others have there
            page.ax.set_title(str(wishes.title), loc="left", fontsize=large(8))
    _relabel(page, wishes.labels or {})
    keep_least_span(page.axes)
    for ax in (*page.axes, *page.bars):
        write_in_full(ax)


def _relabel(page: Page, labels: Mapping[str, str]) -> None:
    """Give axes and entries of the legend other words; raises `ParameterError` if there is nothing
    that a label replaces."""
    labels = {in_a_row(name): text for name, text in labels.items()}
    replaced = ["x", "y", *(in_a_row(str(handle.get_label())) for handle in page.handles)]
    if page.bars:
        replaced.append("bar")
    for name in labels:
        rule = f"must replace x, y or an entry of the legend{suggestion(name, replaced)}"
        require((name in replaced, "labels", name, rule))
    for bar in page.bars:
        bar.set_ylabel(labels.get("bar", bar.get_ylabel()))
    for ax in page.axes:
        if ax.get_xlabel() and "x" in labels:
            ax.set_xlabel(labels["x"])
        if ax.get_ylabel() and "y" in labels:
            ax.set_ylabel(labels["y"])
    for handle in page.handles:
        usual = str(handle.get_label())
        handle.set_label(labels.get(in_a_row(usual), usual))
