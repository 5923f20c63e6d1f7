"""The chart of thresholds: what is drawn, named and shaded."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure

from disc_model.figures.grids import thresholds
from disc_model.figures.grids.growth_map import Curve
from disc_model.figures.grids.kinds import Thresholds
from disc_model.figures.parts import BLUE, save
from tests.studies.grids.conftest import growth_over

SPEEDS, LOADS = np.linspace(5, 50, 6), np.linspace(50, 600, 5)
NEUTRAL = Curve(SPEEDS, np.linspace(600, 50, 6), "neutral")
FOLD = Curve(SPEEDS, SPEEDS * 12, "fold", "2 f_s = 135.42 Hz")
BAND = "no stable cycle, no separation within 1000 s"


def labels(figure: Figure) -> set[str]:
    return {text.get_text() for legend in figure.legends for text in legend.get_texts()}


def chart(monkeypatch: pytest.MonkeyPatch, separation: np.ndarray, **others: xr.Dataset) -> Figure:
    """Of known curves, and speeds of separation by load."""
    monkeypatch.setattr(thresholds, "curves_of", lambda _: [NEUTRAL, FOLD, FOLD])
    study = xr.Dataset(
        {
            "critical_speed": (("N", "horizon"), separation[:, None]),
            "status": ("N", np.zeros(len(LOADS), np.int8), {"flag_meanings": "ok failed"}),
        },
        {"N": LOADS, "horizon": [1000.0], "scan_Omega": SPEEDS, "normalization": ["as_published"]},
    )
    plot = Thresholds(claim={"paper": (200, 12.6)})
    return thresholds.draw(study, {"curves": xr.Dataset(), **others}, plot)


def test_thresholds_shade_where_the_cycle_is_unstable(monkeypatch: pytest.MonkeyPatch) -> None:
    figure = chart(monkeypatch, np.array([np.nan, 45.0, 40, 35, 30]))
    assert {"fold: the cycle ends", "paper", "cycle loses stability", BAND} <= labels(figure)
    (ax,) = figure.axes
    assert {text.get_text() for text in ax.texts} == {"1"}
    assert "2 $f_s$ = 135.42 Hz" in labels(figure)
    # between the curve, interpolated at each load, and the separation
    (shaded,) = (c for c in ax.collections if c.get_label() == BAND)
    assert to_rgba(shaded.get_facecolor()[0]) == to_rgba(BLUE, 0.15)
    corners = shaded.get_paths()[0].vertices
    for load in LOADS[1:]:
        lowest = np.interp(load, NEUTRAL.N[::-1], NEUTRAL.Omega[::-1])
        at = corners[np.isclose(corners[:, 1], load)]
        assert np.any(np.isclose(at[:, 0], lowest))


@pytest.mark.parametrize("separation", [np.array([np.nan, 45.0, 40, 35, 30]), np.full(5, np.nan)])
def test_cells_in_which_no_cycle_is_stable_are_shaded(separation: np.ndarray, monkeypatch: pytest.MonkeyPatch) -> None:
    rate = (("N", "Omega"), np.linspace(-0.1, 0.2, 30).reshape(5, 6))
    figure = chart(monkeypatch, separation, cycle=xr.Dataset({"growth_rate": rate}, {"N": LOADS, "Omega": SPEEDS}))
    assert figure.axes[0].get_xlim() == (5, 50)
    assert BAND in labels(figure)


def test_thresholds_are_drawn(plane: xr.Dataset, speeds: xr.Dataset, tmp_path) -> None:
    growth = growth_over(np.linspace(200, 400, 5), np.linspace(5, 18, 9))
    chart = thresholds.draw(speeds, {"curves": plane, "cycle": growth}, Thresholds(claim={"a": (200, 12.6)}))
    said = [text.get_text() for text in chart.legends[0].get_texts()]
    assert "separation within 1000 s" in said
    assert "paper" in said
    save(chart, tmp_path / "chart.png")
    without = thresholds.draw(speeds, {"curves": plane}, Thresholds())
    assert len(without.axes) == 1
