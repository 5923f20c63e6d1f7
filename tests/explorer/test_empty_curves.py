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


def test_a_point_of_unstable_sliding_has_its_motion(opened: Open) -> None:
    """No motion of this kind was stored."""
    with opened([contents()]) as shown:
        shown.page.run("choose({...view.place, Omega: 3})")
        assert "unstable steady sliding" in shown.text("point")
        assert shown.history() is not None
        note = shown.text("motion-note")
        assert note.startswith("At this point. The motion from the static start")
        assert "unstable" in note
