"""What the explorer shows where nothing of a curve has a value, and motions where there is no cycle."""

from typing import Any

import pytest

import disc_model as dm
from disc_model.explorer import Stated
from disc_model.explorer import study_contents as contents_of
from disc_model.studies.motions import run_motions
from disc_model.studies.point_calls import call_of
from tests import needs
from tests.explorer.test_finding import Open, opened
from tests.studies.refused import parse_grid

pytestmark = [pytest.mark.slow, pytest.mark.compiled, needs.BROWSER.mark]

__all__ = ["opened"]  # a fixture

GRID: dict[str, Any] = {
    "study": "sliding",
    "quantity": "floquet",
    "base": {"c_p": 20.0, "N": 300.0},
    "axes": {"Omega": [10.0, 12.0, 14.0, 16.0, 18.0]},
}


def contents() -> dict[str, Any]:
    """A study of a line of points that slide, with their motions."""
    grid = parse_grid(GRID)
    [text] = grid.motions.values()
    stated = Stated(
        call=call_of("floquet", grid.options).plain,
        motion=grid.options.motion,
        motion_by=grid.options.motion_by,
    )
    return contents_of("sliding", dm.run_study(GRID), run_motions(text), stated)


def test_a_curve_without_a_value_says_why_in_a_sentence(opened: Open) -> None:
    """It was a panel of fine stripes, above a legend with an entry "stable"."""
    with opened([contents()]) as shown:
        shown.choose("Variable", "growth_rate")
        lack = shown.text("map-lack")
        assert lack.startswith("No point of this curve has a value: ")
        assert "steady sliding" in lack
        assert shown.text("legend") == ""
        shown.choose("Variable", "sliding_growth_rate")
        assert shown.page.run("return document.getElementById('map-lack').hidden")


def test_a_point_of_unstable_sliding_has_its_motion(opened: Open) -> None:
    """No motion of this kind was stored."""
    with opened([contents()]) as shown:
        shown.page.run("choose({...view.place, Omega: 3})")
        assert "unstable steady sliding" in shown.text("point")
        assert shown.history() is not None
        note = shown.text("motion-note")
        assert note.startswith("At this point. The motion from the static start")
        assert "unstable" in note


def test_phases_of_a_motion_are_told_apart_without_colours(opened: Open) -> None:
    """Stick and separation have nearly the same grey."""
    with opened([contents()]) as shown:
        hatches = shown.page.run(
            "return ['stick', 'slip', 'separation'].map((word) => lookOfPhase(word).hatch)"
        )
    assert [bool(hatch) for hatch in hatches] == [True, False, False]
