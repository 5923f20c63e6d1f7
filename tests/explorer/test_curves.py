"""What curves of the explorer show beside their values, as figures do: open steps, points in doubt, and
intervals."""

from typing import Any

import numpy as np
import pytest
import xarray as xr

from disc_model.explorer import Stated
from disc_model.explorer import study_contents as contents_of
from disc_model.figures.classes import AT_BOUND, UNSETTLED
from disc_model.figures.curve_heights import heights_of
from disc_model.figures.curve_pieces import open_steps
from disc_model.figures.rate_scale import ANOTHER_BORDER, OPEN
from disc_model.studies.point_calls import HEADLINES
from disc_model.studies.run import describe
from tests import needs
from tests.explorer.test_finding import Open, opened
from tests.explorer.test_page import flagged, numbers

__all__ = ["opened"]  # a fixture

SPEEDS = [5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0]
RATES = [-0.01, -0.007, -0.01, -0.018, -0.106, 0.06, 0.021, 0.0186]
"""Growth rates at these speeds, of two cycles: the smaller one ends between 9 and 10 rad/s."""
ENDS_AT = 4
"""Place of its last point."""
JOINED = """
const middle = (along) => (along(arguments[0]) + along(arguments[0] + 1)) / 2;
const [x, y] = [middle((n) => drawn.horizontal(drawn.xs.at[n])), middle((n) => drawn.heights[n])];
const ink = document.getElementById("map").getContext("2d");
const seen = ink.getImageData(Math.round(x) - 1, Math.round(y) - 1, 3, 3).data;
return seen.some((channel, n) => n % 4 < 3 && channel < 200);
"""
"""Whether a line is drawn on white paper halfway between a point and the next one."""


def cycles() -> xr.Dataset:
    """Growth rates and periods of two cycles over speed and preload, in another order than that of
    lines."""
    rates = np.array([RATES, np.full(8, 0.3), np.linspace(-0.05, 0.05, 8)])
    attrs = {"long_name": "growth rate of disturbances", "units": "s-1"}
    data = {
        "status": (["N", "Omega"], np.zeros((3, 8), np.int8), flagged("ok failed")),
        "growth_rate": (["N", "Omega"], rates, attrs),
        "period": (["N", "Omega"], 0.01 + 0 * rates, {"long_name": "period", "units": "s"}),
    }
    values = {"N": [230.0, 300.0, 385.0], "Omega": SPEEDS}
    coords = {name: (name, along, describe(name)) for name, along in values.items()}
    return xr.Dataset(data, coords, {"title": "Cycles", "quantity": "floquet"})


def line() -> xr.Dataset:
    """One preload of the cycles."""
    return cycles().isel(N=0, drop=True)


def shares() -> xr.Dataset:
    """Shares of starts over the speed, with their intervals."""
    data: dict[str, Any] = {"status": ("Omega", np.zeros(3, np.int8), flagged("ok failed"))}
    for name, values in {
        "": [0.1, 0.5, 0.9],
        "_low": [0, 0.25, 0.75],
        "_high": [0.3, 0.75, 1],
    }.items():
        data[f"separating_fraction{name}"] = ("Omega", values, {"long_name": f"share{name}"})
    coords = {"Omega": ("Omega", [10.0, 12.0, 14.0], describe("Omega"))}
    return xr.Dataset(data, coords, {"title": "Shares", "options": '{"confidence": 0.9}'})


def variable(study: xr.Dataset, name: str) -> dict[str, Any]:
    """What the page is told of a variable."""
    told = contents_of("study", study)["variables"]
    return next(one for one in told if one["name"] == name)


@pytest.mark.parametrize("name", ["growth_rate", "period"])
def test_lines_are_open_where_those_of_figures_are(name: str) -> None:
    """A line led from the end of one cycle to another one."""
    study = cycles()
    told = {one["axis"]: numbers(one, "u1").reshape(3, 8) for one in variable(study, name)["open"]}
    _, heights = heights_of(study, name)
    by_preload = open_steps(study, heights, "N", log=False)
    expected = np.array([*by_preload.values()])
    np.testing.assert_array_equal(told["Omega"][:, :-1], expected)
    assert np.flatnonzero(expected[0]).tolist() == [ENDS_AT]
    assert not told["Omega"][:, -1].any(), "no step begins at the last point"
    across = open_steps(study, heights, "Omega", log=False)
    np.testing.assert_array_equal(told["N"][:-1], np.array([*across.values()]).T)


def borders() -> xr.Dataset:
    """Critical speeds over friction: the first two begin a tongue, the last but one is at the lower
    bound of the search."""
    data = {
        "value": ("mu_k", [9.1, 9.2, 12.6, 9.5, 9.0, 9.7, np.nan]),
        "border": ("mu_k", [15.7, np.nan, 12.6, 9.5, 9.0, 9.7, np.nan]),
        "at_lower_bound": ("mu_k", np.arange(7) == 4),
    }
    coords = {"mu_k": ("mu_k", np.linspace(0.2, 0.32, 7), describe("mu_k"))}
    return xr.Dataset(data, coords, {"title": "Borders"})


def test_lines_between_a_tongue_and_the_main_border_are_open() -> None:
    """A line joined them, with a greatest value that there is not."""
    [steps] = variable(borders(), "value")["open"]
    assert steps["reason"] == ANOTHER_BORDER
    assert np.flatnonzero(numbers(steps, "u1")).tolist() == [1]
    assert variable(borders(), "border")["open"] == []


def test_other_variables_have_no_open_steps() -> None:
    """Equilibria are one family, and words are not joined."""
    study = cycles().rename(growth_rate="largest_growth_rate")
    assert variable(study, "largest_growth_rate")["open"] == []
    words = cycles().assign_coords(N=["low", "middle", "high"])
    assert [one["axis"] for one in variable(words, "growth_rate")["open"]] == ["Omega"]


def test_doubts_of_other_studies_are_told() -> None:
    """Figures mark motions that had not settled, and values at the bound of a search."""
    settled = np.array([[0, 2, 2]], np.int8)
    swept = xr.Dataset(
        {
            "range": (["direction", "sweep_Omega"], np.ones((1, 3))),
            "sweep_settled": (
                ["direction", "sweep_Omega"],
                settled,
                flagged("undecided changing settled"),
            ),
        },
        {"direction": ["up"], "sweep_Omega": [1.0, 2.0, 3.0]},
    )
    [doubt] = variable(swept, "range")["doubts"]
    assert doubt["look"]["label"] == UNSETTLED.label
    assert numbers(doubt, "u1").tolist() == [1, 0, 0]
    searched = xr.Dataset({"value": ("N", [1.0, 2.0]), "at_lower_bound": ("N", [1, 0])})
    [bound] = variable(searched.assign_coords(N=[1.0, 2.0]), "value")["doubts"]
    assert (bound["look"]["label"], bound["is_bound"]) == (AT_BOUND.label, True)


@pytest.mark.slow
@needs.BROWSER.mark
def test_an_open_line_is_seen_and_named(opened: Open) -> None:
    with opened([contents_of("line", line())]) as shown:
        shown.page.prefer("light")
        joined = [shown.page.run(JOINED, n) for n in range(7)]
        legend = shown.text("legend")
    assert joined == [True, True, True, True, False, True, True]
    assert OPEN in legend


@pytest.mark.slow
@needs.BROWSER.mark
def test_shares_have_their_interval(opened: Open) -> None:
    """A curve of shares said nothing of how many starts there were."""
    with opened([contents_of("shares", shares())]) as shown:
        shown.choose("Variable", "separating_fraction")
        shown.page.run("choose({Omega: 1})")
        said = shown.text("point")
        legend = shown.text("legend")
        ends = shown.page.run("return [0, 1].every((x) => Math.abs(drawn.ys.borders[x] - x) < 0.1)")
    assert said.endswith("0.5, 90 % interval 0.25 to 0.75")
    assert legend == "90 % interval"
    assert ends, "the ends of all intervals are within the frame"


def campbell() -> xr.Dataset:
    """Frequencies of three modes over the speed."""
    modes = {"long_name": "number of the mode, lowest frequency first"}
    frequencies = np.add.outer(np.array(SPEEDS), [60.0, 140.0, 240.0])
    study = line().drop_vars("period")
    study = study.assign_coords(mode=("mode", [1, 2, 3], modes))
    for name in ("sliding_frequency", "cycle_frequency"):
        study[name] = (["Omega", "mode"], frequencies, {"long_name": name, "units": "Hz"})
    return study


@pytest.mark.slow
@needs.BROWSER.mark
def test_a_campbell_study_opens_on_its_diagram(opened: Open) -> None:
    """It opened on colours over the number of the mode."""
    stated = Stated(call={"quantity": "campbell", "headlines": [*HEADLINES["campbell"]]})
    with opened([contents_of("campbell", campbell(), stated=stated)]) as shown:
        seen = shown.page.run("return [view.x, view.y, view.spread, view.variable.name]")
    assert seen == ["Omega", "", "mode", "sliding_frequency"]
