"""The chart of thresholds: what is drawn, named and shaded."""

from __future__ import annotations

import json

import numpy as np
import pytest
import xarray as xr
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure

from disc_model.figures.grids import separating, thresholds
from disc_model.figures.grids.growth_map import Curve
from disc_model.figures.kinds import Thresholds
from disc_model.figures.parts import save
from tests.figures.grids.reading import labels
from tests.studies.grids.conftest import growth_over

SPEEDS, LOADS = np.linspace(5, 50, 10), np.array([100.0, 200, 300])
NEUTRAL = Curve(SPEEDS, np.linspace(300, 100, 10), "neutral")
FOLD = Curve(SPEEDS, SPEEDS * 6, "fold", "2 f_s = 135.42 Hz")


def scanned() -> xr.Dataset:
    """At 100 N nothing separates, at 200 N from 30 rad/s on, at 300 N from 10 to 20 and from 40 on."""
    crossing = np.full((3, 1, 4), np.nan)
    crossing[1, 0, 0], crossing[2, 0, :3] = 30.0, [10.0, 20.0, 40.0]
    kind = np.where(np.isfinite(crossing), 1, 0)
    kind[2, 0, 1] = 2
    data = {
        "critical_speed": (("N", "horizon"), np.array([[np.nan], [30.0], [10.0]])),
        "crossing": (("N", "horizon", "crossing_number"), crossing),
        "crossing_kind": (("N", "horizon", "crossing_number"), kind, {"flag_meanings": "none begins ends"}),
        "status": ("N", np.zeros(3, np.int8), {"flag_meanings": "ok failed"}),
    }
    axes = {"N": LOADS, "horizon": [1000.0], "scan_Omega": SPEEDS, "normalization": ["as_published"]}
    return xr.Dataset(data, axes)


def chart(monkeypatch: pytest.MonkeyPatch, **others: xr.Dataset) -> Figure:
    """Of known curves."""
    monkeypatch.setattr(thresholds, "curves_of", lambda _: [NEUTRAL, FOLD, FOLD])
    curves = xr.Dataset({"n_unfollowed": 2})
    return thresholds.draw(scanned(), {"curves": curves, **others}, Thresholds(claim={"paper": (200, 12.6)}))


def test_curves_crossings_and_what_the_paper_says_are_named(monkeypatch: pytest.MonkeyPatch) -> None:
    figure = chart(monkeypatch)
    named = {"cycle loses stability", "stable cycle ends (fold)", "separation begins", "open: separation ends again"}
    named |= {"what the paper says", "2 $f_s$ = 135.42 Hz", "curves stop, not followed: 2"}
    assert set(labels(figure)) == named
    (ax,) = figure.axes
    assert {text.get_text() for text in ax.texts} == {"1"}


def test_no_separation_is_presumed_between_loads(monkeypatch: pytest.MonkeyPatch) -> None:
    """It was interpolated from the lowest crossings, up to loads without any, and above the end of a separation."""
    loads = np.array([100.0, 150, 200, 250, 300])
    rate = (("N", "Omega"), np.full((5, 10), 0.1))
    cycle = xr.Dataset({"growth_rate": rate}, {"N": loads, "Omega": SPEEDS})
    figure = chart(monkeypatch, cycle=cycle)
    assert figure.axes[0].get_xlim() == (5, 50)
    assert any("no stable cycle, no separation" in label for label in labels(figure))
    apart = separating.separates(scanned(), 1000.0, loads, SPEEDS)
    at_200, at_300 = SPEEDS >= 30, ((SPEEDS >= 10) & (SPEEDS < 20)) | (SPEEDS >= 40)
    np.testing.assert_array_equal(apart, [np.zeros(10, bool), at_200, at_200, at_200 | at_300, at_300])


def test_areas_are_the_outcomes_of_a_map_where_there_is_one(monkeypatch: pytest.MonkeyPatch) -> None:
    codes, words = np.repeat([[0], [1], [2]], 10, axis=1), {"flag_meanings": "quiet growing separation"}
    data = {"growth_rate": (("N", "Omega"), codes - 0.1), "outcome": (("N", "Omega"), codes, words)}
    cycle = xr.Dataset(data, {"N": LOADS, "Omega": SPEEDS}, {"options": json.dumps({"horizon": 1000.0})})
    figure = chart(monkeypatch, cycle=cycle)
    assert {"stays quiet", "grows, no separation", "separation"} <= set(labels(figure))
    (mesh,) = (one for one in figure.axes[0].collections if isinstance(one, QuadMesh))
    assert not np.ma.getmaskarray(mesh.get_array()).any()


def test_thresholds_are_drawn(plane: xr.Dataset, speeds: xr.Dataset, tmp_path) -> None:
    growth = growth_over(np.linspace(200, 400, 5), np.linspace(5, 18, 9))
    chart = thresholds.draw(speeds, {"curves": plane, "cycle": growth}, Thresholds(claim={"a": (200, 12.6)}))
    assert {"separation begins", "what the paper says"} <= set(labels(chart))
    save(chart, tmp_path / "chart.png")
    assert len(thresholds.draw(speeds, {"curves": plane}, Thresholds()).axes) == 1
