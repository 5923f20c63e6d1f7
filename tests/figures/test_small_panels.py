"""A warning of panels that labels, legends and strips leave no room."""

import json
import re
import warnings
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot

import disc_model as dm
from disc_model.data.variables import attributes
from disc_model.figures.colours import bars_of
from disc_model.figures.drawing import large
from disc_model.figures.gap_rows import rows_above
from disc_model.figures.sizes import COLUMN, INCH, PAGE

SPEEDS = np.linspace(10.0, 30.0, 21)  # rad/s
LOADS = [200.0, 385.0, 600.0]  # N
WORDS = "ok no_cycle separates failed"
STATUS = {"flag_values": np.arange(4, dtype=np.int8), "flag_meanings": WORDS}
PLANE = ("Omega", "N")


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


def crowded(k_p: float) -> xr.Dataset:
    """Shares with three reasons why points of each of three lines have none."""
    study = shares(k_p).copy(deep=True)
    study["status"][4] = 1
    study["status"][8] = 2
    study["status"][12] = 3
    study["stick_fraction"][4] = np.nan
    study["stick_fraction"][[8, 12]] = np.nan
    return study


def draw(height: float, layout: Any, **wishes: Any) -> list[str]:
    """Two sweeps of three lines each in one of two panels of a page; returns the warnings."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        _, panels = pyplot.subplots(1, 2, figsize=(PAGE, height), layout=layout)
        for k_p in (2e4, 1.5e4):
            dm.plot_sweep(shares(k_p), ax=panels[1], lines="N", **wishes)
        dm.plot_sweep(shares(2e4), ax=panels[0], lines="N", **wishes)
    return [str(warning.message) for warning in caught]


@pytest.mark.parametrize("layout", [pytest.param(None, marks=pytest.mark.slow), "constrained"])
def test_a_reader_is_told_once_of_panels_without_room(layout: Any) -> None:
    [said] = draw(1.8, layout)
    assert re.match(
        "the panel is . mm high.*such as its legend and strips, leaves no room; make", said
    )


@pytest.mark.parametrize("layout", [None, pytest.param("constrained", marks=pytest.mark.slow)])
def test_nothing_is_said_of_panels_with_room(layout: Any) -> None:
    assert not draw(5.0, layout)


def test_a_panel_that_is_small_from_the_beginning_is_its_readers_wish() -> None:
    figure = pyplot.figure(figsize=(PAGE, 5.0))
    small = figure.add_axes((0.4, 0.4, 0.07, 0.1))  # 12 by 13 mm, of which labels take some
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        dm.plot_sweep(shares(2e4), ax=small, lines="N", legend=False)


@pytest.mark.parametrize(
    ("width", "columns", "layout"),
    [
        (COLUMN, 1, None),
        (COLUMN, 1, "constrained"),
        (PAGE, 2, None),
        pytest.param(PAGE, 2, "constrained", marks=pytest.mark.slow),
    ],
)
def test_panels_below_strips_of_three_lines_keep_25_mm(
    width: float, columns: int, layout: Any
) -> None:
    """They were 14 mm high."""
    figure, panels = pyplot.subplots(
        1, columns, figsize=(width, 60 / INCH), layout=layout, squeeze=False
    )
    for ax, k_p in zip(panels.flat, (2e4, 1.5e4), strict=False):
        dm.plot_sweep(crowded(k_p), ax=ax, lines="N")
    figure.canvas.draw()
    for ax in panels.flat:
        assert ax.bbox.height > 25 / INCH * figure.dpi
        assert len(rows_above(ax)) == 3
        assert ax.get_tightbbox().y1 <= figure.bbox.y1


def test_strips_keep_their_size_where_they_have_room() -> None:
    _, ax = pyplot.subplots(figsize=(PAGE, 5.0), layout="constrained")
    dm.plot_sweep(crowded(2e4), ax=ax, lines="N")
    assert {row.words.get_fontsize() for row in rows_above(ax)} == {large(7)}


def test_strips_have_their_usual_size_again_after_a_panel_was_cleared() -> None:
    figure, ax = pyplot.subplots(figsize=(PAGE, 2.0), layout="constrained")
    dm.plot_sweep(crowded(2e4), ax=ax, lines="N")
    assert {row.words.get_fontsize() for row in rows_above(ax)} == {6.0}
    ax.clear()
    figure.set_figheight(5.0)
    dm.plot_sweep(crowded(2e4), ax=ax, lines="N")
    assert {row.words.get_fontsize() for row in rows_above(ax)} == {large(7)}


@pytest.mark.parametrize("inches", [84 / 25.4, 174 / 25.4])
def test_numbers_about_zero_beside_a_bar_of_large_rates_are_apart(inches: float) -> None:
    """0.1, 0 and -0.1 touched beside a bar that ends at 9/s."""
    loads = np.linspace(100, 400, 20)
    speeds = np.linspace(10, 30, 20)
    rates = np.clip(np.linspace(-4, 4, 400), -9, 9).reshape(20, 20)
    rates[0] = -9
    rates[-1] = 9
    study = xr.Dataset({"growth_rate": (("N", "Omega"), rates)}, {"N": loads, "Omega": speeds})
    figure, ax = pyplot.subplots(figsize=(inches, 0.6 * inches), layout="constrained")
    dm.plot_sweep(study, "growth_rate", lines=False, ax=ax)
    figure.draw_without_rendering()
    [bar] = bars_of(ax)
    shown = [text for text in bar.get_yticklabels() if text.get_text()]
    assert "0" in {text.get_text() for text in shown}
    boxes = sorted((text.get_window_extent() for text in shown), key=lambda box: box.y0)
    gaps = [above.y0 - below.y1 for below, above in pairwise(boxes)]
    assert min(gaps) >= 1.9 * figure.dpi / 72
