"""Several cases in pictures of one kind on the same axes: their limits, and what the legend calls them.

A case alone has the colours and marks of its picture. Beside others it is one line, or one kind of
marks, in a look of its own: phases, first separations and frequencies beside peaks are not shown.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from disc_model.figures.case_lines import Lines, Style, limits_around
from disc_model.figures.common_stretch import stretch_shown
from disc_model.figures.family import Member, name_in, names_of
from disc_model.figures.family_titles import retitle
from disc_model.figures.kept import Kept, Removable
from disc_model.figures.named_axes import shown_on
from disc_model.figures.pages import Page
from disc_model.figures.stated_case import stated, stated_values
from disc_model.figures.symbols import in_a_row
from disc_model.figures.twin_colours import shown_beside, tell_axes_apart
from disc_model.figures.types import Artist, Axes
from disc_model.parameters import Parameters

NAME = "case"
"""The label by which a reader names a case."""
OF_ONE_COLOUR = ("run", "spectrum")
"""Kinds of pictures in which a case alone has one line in a colour of its variable."""


@dataclass
class Case:
    """A case on axes.

    Attributes
    ----------
    kind : of its picture; only those of one kind are drawn beside each other
    shown : its name, if the reader gives one, and what tells it from others
    title : what the title of a new figure says of it alone
    notes : what stands above panels that show it alone
    place : in the order of the cases
    ending : what the legend says after its name
    """

    kind: str
    shown: Member
    title: str
    notes: Sequence[str] = ()
    place: int = 0
    ending: str = ""


@dataclass
class Panel:
    """A case in one panel, and what was drawn of it there."""

    case: Case
    lines: Lines
    drawn: list[Removable[Any]] = field(default_factory=list)

    @property
    def shown(self) -> Member:
        """What tells the case from others in the panel."""
        values = {"variable": self.lines.what, **self.case.shown.values}
        return replace(self.case.shown, values=values)


_PANELS: Kept[list[Panel]] = Kept("cases")
"""The cases that axes show."""


def case_of_result(
    kind: str, name: str, p: Parameters | None, *varied: str, notes: Sequence[str] = ()
) -> Case:
    """The case of a result of some parameters, if they are known, but those that it varies.

    name : that of the reader, "" for none
    """
    values = {} if p is None else stated_values(p, *varied)
    title = "" if p is None else stated(p, *varied)
    return Case(kind, Member(name, values), title, notes)


def name_of_case(labels: Any) -> tuple[str, Any]:
    """The name that a reader gives a case, "" for none, and the other labels."""
    return name_in(labels, NAME)


def _panels_on(ax: Axes, kind: str) -> list[Panel]:
    """The cases in pictures of a kind on axes from which they were not removed."""
    panels = _PANELS.get(ax, []) if shown_on(ax).labels else []
    return [panel for panel in panels if panel.case.kind == kind]


def draw_case(
    page: Page,
    case: Case,
    panels: Sequence[Lines],
    draw_alone: Callable[[], None],
    common: Sequence[Artist] = (),
) -> bool:
    """Draw a case on a page, and return whether it stands alone there: it has neither a name nor
    others beside it.

    panels : how it is drawn beside others in each panel
    draw_alone : draws it in the colours and marks of its picture, with their legend
    common : entries of the legend that serve all cases beside each other
    """
    if case.shown.name or any(_panels_on(ax, case.kind) for ax in page.axes):
        _stand_beside(page, case, panels, common)
        return False
    draw_alone()
    for ax, drawn in zip(page.axes, page.added(), strict=True):
        for former in _alone_beside(ax, case.kind):
            tell_axes_apart(ax, drawn, *former)
    _remember_alone(page, case, panels)
    return True


def is_beside(ax: Axes, kind: str) -> bool:
    """Whether other axes on the same place, with heights of their own, show a case alone in a picture
    of a kind."""
    return any(_alone_beside(ax, kind))


def _alone_beside(ax: Axes, kind: str) -> list[tuple[Axes, list[Any]]]:
    """Such axes, and what was drawn there."""
    found = []
    for other in shown_beside(ax):
        panels = _panels_on(other, kind)
        if kind in OF_ONE_COLOUR and len(panels) == 1:
            found.append((other, [reference() for reference in panels[0].drawn]))
    return found


def _remember_alone(page: Page, case: Case, panels: Sequence[Lines]) -> None:
    """Remember a case that was drawn alone, with how it is drawn beside others in each panel."""
    case.shown.looks[:] = page.handles
    for ax, lines, drawn in zip(page.axes, panels, page.added(), strict=True):
        _PANELS[ax] = [Panel(case, lines, [Removable(artist) for artist in drawn])]


def _stand_beside(
    page: Page, case: Case, panels: Sequence[Lines], common: Sequence[Artist]
) -> None:
    """Draw a case beside those that its axes have, a look each, within limits that hold all. The
    legend names them by what differs between them, or as the reader does, before entries that are
    common to all."""
    former = [_panels_on(ax, case.kind) for ax in page.axes]
    places = [panel.case.place for row in former for panel in row]
    case.place = 1 + max(places, default=-1)
    families = [[*row, Panel(case, lines)] for row, lines in zip(former, panels, strict=True)]
    entries: list[Artist] = []
    for ax, family in zip(page.axes, families, strict=True):
        handles = _draw(ax, family)
        entries = entries or handles
        _PANELS[ax] = family

    _name(families[0], entries)
    _explain(page, families[0], [*entries, *common])


def _draw(ax: Axes, family: Sequence[Panel]) -> list[Artist]:
    """Draw all cases of a panel anew, the last for the first time; returns entries of a legend."""
    limits = [family[-1].lines.limits]
    if len(family) > 1:
        limits.append((ax.get_xlim(), ax.get_ylim()))
    handles = []
    count = 1 + max(panel.case.place for panel in family)
    shown = stretch_shown([panel.lines.stretch for panel in family])
    for panel in family:
        _remove(ax, panel)
        before = {id(artist) for artist in ax.get_children()}
        handles.append(panel.lines.draw(ax, Style(panel.case.place, count, shown.from_end)))
        panel.drawn = [Removable(each) for each in ax.get_children() if id(each) not in before]
    across, up = limits_around(limits)
    ax.set_xlim(shown.limits or across)
    ax.set_ylim(up)
    return handles


def _remove(ax: Axes, panel: Panel) -> None:
    """Remove what was drawn of a case, with the notes above the panel."""
    for reference in panel.drawn:
        artist = reference()
        if artist is not None and artist.axes is ax:
            artist.remove()
    notes = {in_a_row(note) for note in panel.case.notes}
    for side in ("left", "right"):
        if in_a_row(ax.get_title(loc=side)) in notes:  # type: ignore[arg-type]  # a Literal
            ax.set_title("", loc=side)  # type: ignore[arg-type]  # as well


def _name(panels: Sequence[Panel], entries: Sequence[Artist]) -> None:
    """Name the entries of cases in the legend."""
    for entry, name in zip(entries, _names_in(panels), strict=True):
        entry.set_label(name)


def _names_in(panels: Sequence[Panel]) -> list[str]:
    """What the legend calls the cases of panels."""
    names = names_of([panel.shown for panel in panels], NAME)
    endings = [panel.case.ending for panel in panels]
    return [", ".join(filter(None, pair)) for pair in zip(names, endings, strict=True)]


def _explain(page: Page, panels: Sequence[Panel], entries: Sequence[Artist]) -> None:
    """Set the entries of the legend, and let the title say what all cases have in common."""
    family = [panel.shown for panel in panels]
    replaced = {str(handle.get_label()) for each in family for handle in each.looks}
    replaced |= {*_names_in(panels[:-1])} if panels[:-1] else set()
    page.joins = True
    page.replaced = replaced | {str(entry.get_label()) for entry in entries}
    page.explain(entries)
    if len(family) > 1:
        retitle(page, family, panels[0].case.title)
