"""Charts of stability from a handful of numbers: what is drawn, named and shaded."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.colors import to_rgba

from disc_model.figures.grids.stability import Curve, bifurcation_diagram, growth_map, threshold_chart
from disc_model.figures.style import BLUE

SPEEDS, LOADS = np.linspace(5, 50, 6), np.linspace(50, 600, 5)
RATE = np.linspace(-0.1, 0.2, 30).reshape(5, 6)
NEUTRAL = Curve(SPEEDS, np.linspace(600, 50, 6), "neutral")
FOLD = Curve(SPEEDS, SPEEDS * 12, "fold", "2 f_s = 135.42 Hz")


def grid(rate=RATE) -> xr.Dataset:
    return xr.Dataset({"growth_rate": (("N", "Omega"), rate)}, coords={"N": LOADS, "Omega": SPEEDS})


def labels(figure) -> set[str]:
    return {text.get_text() for legend in figure.legends for text in legend.get_texts()}


def test_a_growth_map_names_curves_and_gaps():
    gaps = RATE.copy()
    gaps[2, 3] = np.nan
    figure = growth_map({"as_published": grid(gaps)}, {"as_published": [NEUTRAL, FOLD]}, limit=0.05)
    assert labels(figure) == {"a multiplier crosses the unit circle", "fold", "no cycle"}
    assert [text.get_text() for text in figure.axes[0].texts] == ["2 $f_s$ = 135.42 Hz"]
    bar = figure.axes[-1]
    assert [text.get_text() for text in bar.get_yticklabels()] == ["−0.01", "0", "0.01"]
    assert not growth_map({"as_published": grid()}).legends
    assert len(growth_map({"x": grid(np.full((5, 6), np.nan))}).axes) == 2


def test_thresholds_shade_where_the_cycle_is_unstable():
    separation = np.array([np.nan, 45.0, 40, 35, 30])
    figure = threshold_chart(LOADS, separation, 1000.0, NEUTRAL, [FOLD, FOLD], {200: 12.6})
    band = "no stable cycle, no separation within 1000 s"
    assert {"fold: the cycle ends", "paper", "cycle loses stability", band} <= labels(figure)
    (ax,) = figure.axes
    # between the curve, interpolated at each load, and the separation
    (shaded,) = (c for c in ax.collections if c.get_label() == band)
    assert to_rgba(shaded.get_facecolor()[0]) == to_rgba(BLUE, 0.15)
    corners = shaded.get_paths()[0].vertices
    for load in LOADS[1:]:
        lowest = np.interp(load, NEUTRAL.N[::-1], NEUTRAL.Omega[::-1])
        at = corners[np.isclose(corners[:, 1], load)]
        assert np.any(np.isclose(at[:, 0], lowest))
    shown = threshold_chart(LOADS, separation, 1000.0, NEUTRAL, cycle=grid())
    assert shown.axes[0].get_xlim() == (5, 50)
    none = threshold_chart(LOADS, np.full(5, np.nan), 1000.0, NEUTRAL, cycle=grid())
    assert band in labels(none)


def test_a_diagram_without_exponents_has_one_panel():
    samples = xr.Dataset(
        {"P": (("N", "sample"), np.ones((2, 3)), {"units": "N"}), "phase": (("N", "sample"), np.zeros((2, 3), int))},
        coords={"N": ("N", [1.0, 2.0], {"units": "N"})},
    )
    figure = bifurcation_diagram(samples, "N", "P", scale=1.0)
    (ax,) = figure.axes
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("Preload N (N)", "Contact force (N)")
    assert len(ax.lines) == 1  # all of it stick
