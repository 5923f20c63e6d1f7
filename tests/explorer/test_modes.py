"""Modes of a Campbell diagram in the explorer, as in its figure."""

import numpy as np
import pytest
import xarray as xr

from disc_model.explorer import study_contents as contents_of
from disc_model.figures.campbell_looks import UNSTABLE
from disc_model.studies.run import describe
from tests import needs
from tests.explorer.test_finding import Open, opened
from tests.explorer.test_page import flagged, plane

__all__ = ["opened"]  # a fixture

EFFECTS = "none no_rise rises beyond_scan"
GROWING = "growing mode"
RISES, CALM, UNKNOWN = ("crossing: a rate rises", "crossing: no rate rises", "crossing: not known")


def diagram() -> xr.Dataset:
    """Two modes over three speeds, of which the second one grows at the last; and three crossings."""
    speeds = np.array([10.0, 20.0, 30.0])
    along = ("Omega", "mode")
    frequency = np.array([[100.0, 200.0], [100.0, 200.0], [100.0, 200.0]])
    rate = np.array([[-1.0, -1.0], [-1.0, -1.0], [-1.0, 1.0]])
    hertz = {"units": "Hz", "long_name": "frequency"}
    data = {
        "status": ("Omega", np.zeros(3, np.int8), flagged("ok failed")),
        "sliding_frequency": (along, frequency, hertz),
        "sliding_growth_rate": (along, rate, {"units": "s-1", "long_name": "growth rate"}),
        "cycle_frequency": (along, frequency, hertz),
        "cycle_growth_rate": (along, -np.abs(rate), {"units": "s-1", "long_name": "growth rate"}),
        "crossing_Omega": ("crossing", [15.0, 18.0, 25.0, np.nan], describe("Omega")),
        "crossing_frequency": ("crossing", [100.0, 200.0, 100.0, np.nan], hertz),
        "crossing_effect": ("crossing", np.array([2, 1, 3, 0], np.int8), flagged(EFFECTS)),
    }
    coords = {
        "Omega": ("Omega", speeds, describe("Omega")),
        "mode": ("mode", [1, 2], {"long_name": "number of the mode"}),
        "crossing": ("crossing", [1, 2, 3, 4], {"long_name": "number of the crossing"}),
    }
    return xr.Dataset(data, coords, {"title": "Modes", "quantity": "campbell"})


def test_other_studies_have_no_crossings() -> None:
    """Only a Campbell diagram has looks of modes."""
    assert contents_of("plane", plane())["modes"] is None
    looks = contents_of("diagram", diagram())["modes"]
    assert looks["growing"]["colour"] == UNSTABLE


@pytest.mark.slow
@needs.BROWSER.mark
def test_growing_modes_and_crossings_are_shown(opened: Open) -> None:
    """All were plain points."""
    script = (
        "view.variable = view.study.variables.find((one) => one.name === arguments[0]); update()"
    )
    with opened([contents_of("diagram", diagram())]) as shown:
        shown.page.run(script, "sliding_frequency")
        legend = shown.text("legend").split("\n")
        assert {GROWING, RISES, CALM, UNKNOWN} <= {*legend}
        places = shown.page.run(
            "return crossingsShown().map(({x}) => (x - drawn.horizontal(10)) / "
            "(drawn.horizontal(30) - drawn.horizontal(10)))"
        )
        assert places == pytest.approx([0.25, 0.4, 0.75], abs=1e-6)
        shown.page.run(script, "cycle_frequency")
        assert GROWING not in shown.text("legend"), "the multipliers of the cycle do not grow"
        shown.page.run(script, "sliding_growth_rate")
        assert RISES not in shown.text("legend")
