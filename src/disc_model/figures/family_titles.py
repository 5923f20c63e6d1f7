"""What titles say of several members on the same axes: what these have in common."""

from collections.abc import Sequence

from disc_model.figures.case_titles import rewrite_case, title_text
from disc_model.figures.drawing import large
from disc_model.figures.family import Member, common_values
from disc_model.figures.head_texts import what_case
from disc_model.figures.pages import OWN, Page
from disc_model.figures.symbols import without_font


def retitle(page: Page, family: Sequence[Member], first: str = "") -> None:
    """Let the title say what all members have in common, unless the reader has given another.

    first : what it says of the first alone, if this is more than its values
    """
    page.case = _said_of_all(family)
    rewrite_case(page.ax, page.case)
    figure = page.figure
    width = float(figure.get_size_inches()[0])
    before = family[:-1]
    said = _said_of_all(before)
    if first and len(before) == 1:
        said = first
    former = title_text(width, said)
    if figure.get_gid() == OWN and without_font(figure.get_suptitle()) == former:
        said = title_text(width, page.case)
        figure.suptitle(said, fontsize=large(8))


def _said_of_all(family: Sequence[Member]) -> str:
    """What a title says of all members."""
    return what_case(common_values(family), family[0].selected)
