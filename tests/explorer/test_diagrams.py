"""Diagrams of the explorer: samples and branches as in the figures."""

import json
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import disc_model as dm
from disc_model.explorer import Stated, page
from disc_model.explorer import study_contents as contents_of
from disc_model.studies.point_calls import call_of
from disc_model.studies.registry import quantity_of
from disc_model.studies.run import describe
from tests import needs
from tests.explorer.test_finding import Open, opened
from tests.explorer.test_in_browser import READY, Explorer
from tests.explorer.test_page import flagged, motions, plane
from tests.workflow.browser import browser

pytestmark = [pytest.mark.slow, needs.BROWSER.mark]
__all__ = ["opened"]

PHASES = "none stick slip separation"
KINDS = "quiet other_cycle separating undecided"


def sampled() -> xr.Dataset:
    """Three speeds, each with two samples: in contact, separating, and not shown to settle."""
    dims = ["Omega", "sample"]
    phases = np.array([[1, 1], [3, 3], [3, 3]], np.int8)
    data = {
        "status": ("Omega", np.zeros(3, np.int8), flagged("ok failed")),
        "psi": (dims, np.arange(6.0).reshape(3, 2), {"units": "rad"}),
        "phase": (dims, phases, flagged(PHASES)),
        "settled": ("Omega", np.array([0, 0, 1], np.int8), flagged("settled undecided")),
        "kind": ("Omega", np.array([1, 2, 3], np.int8), flagged(KINDS)),
        "transient_time": ("Omega", [20.0, 80.0, 20.0], {"units": "s"}),
    }
    samples = ("sample", np.arange(2.0), {"long_name": "number of the event"})
    coords = {"Omega": ("Omega", [8.0, 9.0, 10.0], describe("Omega")), "sample": samples}
    options = json.dumps({"section": "event"})
    return xr.Dataset(data, coords, {"quantity": "bifurcation", "options": options})


def branches() -> xr.Dataset:
    """A branch in contact that turns back and becomes unstable, and one that separates."""
    dims = ["N", "branch", "branch_point"]
    speeds = [[[8.0, 10.0, 12.0, 11.0, 9.0], [9.0, 10.0, 11.0, 12.0, 13.0]]]
    rates = [[[-1.0, -1.0, 0.0, 1.0, 1.0], [-1.0] * 5]]
    heights = [[[1e-5, 2e-5, 4e-5, 8e-5, 1e-4], [1e-2] * 5]]
    data = {
        "status": ("N", np.zeros(1, np.int8), flagged("ok failed")),
        "separations": (dims[:2], [[0, 2]]),
        "value": (dims, speeds),
        "growth_rate": (dims, rates, {"units": "s-1"}),
        "range": (dims, heights, {"units": "m", "long_name": "range"}),
    }
    points = ("branch_point", np.arange(5.0), {"long_name": "number of the point along the branch"})
    lines = ("branch", np.arange(2.0), {"long_name": "number of the branch"})
    coords = {"N": ("N", [385.0], describe("N")), "branch": lines, "branch_point": points}
    attrs = {"quantity": "branches", "options": json.dumps({"parameter": "Omega"})}
    return xr.Dataset(data, coords, attrs)


def told_of_branches() -> dict[str, object]:
    """What the page is told of the branches, with their call."""
    options = {"scan": {"start": 8, "stop": 13, "step": 1}, "sweep_from": 9, "dwell": 40}
    quantity = quantity_of("branches").model_validate(options)
    call = json.loads(json.dumps(call_of("branches", quantity).plain))
    return contents_of("branches", branches(), stated=Stated(call=call))


def test_branches_are_lines_over_the_parameter_when_their_study_opens(opened: Open) -> None:
    """They were drawn over the number of the point along the branch only."""
    with opened([told_of_branches()]) as shown:
        run = shown.page.run
        assert run("return [view.variable.name, view.x, view.spread]") == [
            "range",
            "branch_point",
            "branch",
        ]
        ends = run("return [drawn.xs.borders[0], drawn.xs.borders[1]]")
        legend = shown.text("legend").split("\n")
        # a click on the fold of the first branch
        x, y = run(
            "const { left, top } = element('map').getBoundingClientRect();"
            "const fold = drawn.points.find(({ place }) => place.branch === 0 && place.branch_point === 2);"
            "return [left + fold.x, top + fold.y]"
        )
        shown.page.point(x, y, click=True)
        point = shown.text("point")
        call = shown.text("call")
        across = shown.page.run("return element('controls').Across.selectedOptions[0].text")
        table = shown.page.run("return csv().split('\\n').slice(0, 2)")
    assert table == ["branch_point,branch,N (N),value (rad/s),range (mm)", "0,0,385,8,0.01"]
    assert ends == [8, 13]
    assert legend == ["stable cycle, in contact", "stable cycle, separating", "unstable cycle"]
    assert "Ω = 12 rad/s" in point
    assert "Omega=12" in call.split("\n")[0]
    assert across.endswith(" along the branch")


def test_no_motion_from_far_away_is_drawn(tmp_path: Path) -> None:
    """It was, however far its point is."""
    far = plane().isel(Omega=[0] * 12).assign_coords(Omega=5.0 * np.arange(1, 13))
    far["outcome"].values[:] = 0
    far["status"].values[:] = 0
    path = tmp_path / "explorer.html"
    path.write_text(page("Made up", [contents_of("far", far, motions())], []), encoding="utf-8")
    with browser(tmp_path / "profile") as window:
        window.open(path)
        window.wait_for(READY)
        shown = Explorer(window)
        window.run("choose({N: 0, Omega: 11, normalization: 0})")
        assert window.run("return element('motion').hidden")
        assert "none is stored near this point" in shown.text("motion-note")
        assert "11 cells away" in shown.text("motion-note")
        assert shown.text("motion-call").startswith("dm.simulate(")
        assert shown.text("motion-title") == "The motion"


def test_the_call_of_a_motion_after_a_transient_gives_that_motion(opened: Open) -> None:
    """It showed the motion from the start, up to a time before that of the samples."""
    with opened([contents_of("sampled", sampled())]) as shown:
        shown.page.run("choose({Omega: 1, sample: 0})")
        lines = shown.text("motion-call").split("\n")
        said = shown.text("motion-says")
    names = {"dm": dm}
    assert said.startswith("The motion of this case after the transient, 80 s")
    assert lines[1] == "later = dm.simulate(case, 80).final_state"
    assert lines[2] == "dm.simulate(case, duration=0.1, initial_state=later).plot()"
    case = lines[0].replace("dm.Parameters(", "dm.Parameters(N=385, ")
    exec("\n".join([case, *lines[1:]]).replace("80", "1"), names)
    assert names["later"].time == 1
