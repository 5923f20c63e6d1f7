"""What curves of the explorer show beside their values, as figures do: open steps, points in doubt, and
intervals."""

from typing import Any

import numpy as np
import pytest
import xarray as xr

from disc_model.explorer import study_contents as contents_of
from disc_model.figures.classes import AT_BOUND, UNSETTLED
from disc_model.figures.curve_heights import heights_of
from disc_model.figures.curve_pieces import open_steps
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
