"""A warning of panels that labels, legends and strips leave no room."""

import json
import re
import warnings
from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot

import disc_model as dm
from disc_model.data.variables import attributes
from disc_model.figures.sizes import PAGE

SPEEDS = np.linspace(10.0, 30.0, 21)  # rad/s
LOADS = [200.0, 385.0, 600.0]  # N
STATUS = {"flag_values": np.arange(2, dtype=np.int8), "flag_meanings": "ok no_cycle"}
PLANE = ("Omega", "N")


@pytest.fixture(autouse=True)
def _closed() -> object:
    yield
    pyplot.close("all")


def shares(k_p: float) -> xr.Dataset:
    """Shares of sticking at speeds and loads, with a point where none was found."""
    sticking = 4.0 / SPEEDS[:, None] + 1e-4 * np.array(LOADS)
    status = np.zeros(sticking.shape, dtype=np.int8)
    status[15, 2] = 1
    sticking[15, 2] = np.nan
    words = {"units": "1", "long_name": "share of the period spent sticking"}
    return xr.Dataset(
        {"stick_fraction": (PLANE, sticking, words), "status": (PLANE, status, STATUS)},
        {"Omega": (PLANE[0], SPEEDS, attributes("Omega")), "N": ("N", LOADS, attributes("N"))},
        {"quantity": "floquet", "base": json.dumps({"k_p": k_p})},
    )


def draw(height: float, layout: Any, **wishes: Any) -> list[str]:
    """Two sweeps of three lines each in one of two panels of a page; returns the warnings."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        _, panels = pyplot.subplots(1, 2, figsize=(PAGE, height), layout=layout)
        for k_p in (2e4, 1.5e4):
            dm.plot_sweep(shares(k_p), ax=panels[1], lines="N", **wishes)
        dm.plot_sweep(shares(2e4), ax=panels[0], lines="N", **wishes)
    assert {warning.filename for warning in caught} <= {__file__}
    return [str(warning.message) for warning in caught]


@pytest.mark.parametrize("layout", [None, "constrained"])
def test_a_reader_is_told_once_of_panels_without_room(layout: Any) -> None:
    [said] = draw(1.8, layout)
    assert re.match(
        "the panel is . mm high.*such as its legend and strips, leaves no room; make", said
    )


@pytest.mark.parametrize("layout", [None, "constrained"])
def test_nothing_is_said_of_panels_with_room(layout: Any) -> None:
    assert not draw(5.0, layout)


def test_a_panel_that_is_small_from_the_beginning_is_its_readers_wish() -> None:
    figure = pyplot.figure(figsize=(PAGE, 5.0))
    small = figure.add_axes((0.4, 0.4, 0.07, 0.1))  # 12 by 13 mm, of which labels take some
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        dm.plot_sweep(shares(2e4), ax=small, lines="N", legend=False)
