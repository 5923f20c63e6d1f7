"""The figure of speed ramps."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from disc_model.figures.grids import ramps as drawn
from disc_model.figures.grids.growth_map import Curve, crossings
from disc_model.figures.parts import save
from disc_model.studies.grids.points import STATUSES
from disc_model.studies.grids.quantities import ramps
from tests.figures.grids.reading import draw, lines
from tests.studies.grids.conftest import computed

OPTIONS = {"low": 8, "high": 20, "rates": {"start": 0.01, "stop": 1, "count": 3, "scale": "log"}}


@pytest.fixture
def study(monkeypatch: pytest.MonkeyPatch) -> xr.Dataset:
    def at(p, options):
        values = {
            "status": "ok",
            "rate_status": np.array([0, 0, STATUSES.index("stalled")]),
            "onset": np.array([15.3, np.nan, np.nan]),
            "top_separation_rate": np.array([135.0, 0.0, np.nan]),
            "persists_to": np.array([9.7, 9.3, np.nan]),
        }
        return values, ""

    monkeypatch.setattr(ramps, "at", at)
    return computed(quantity="ramps", options=OPTIONS, base={"N": 385}, axes={"normalization": ["as_published"]})


def test_onset_and_end_are_drawn_and_what_has_none_is_marked(
    study: xr.Dataset, monkeypatch: pytest.MonkeyPatch, tmp_path
) -> None:
    folds = [
        Curve(np.array([15.0, 15.2]), np.array([380.0, 390.0]), "fold"),
        Curve(np.array([12.0, 12.5]), np.array([380.0, 390.0]), "neutral"),
        Curve(np.array([11.0, np.nan, 30.0, 31.0]), np.array([380.0, np.nan, 380.0, 390.0]), "fold"),
    ]
    monkeypatch.setattr(drawn, "curves_of", lambda _: folds)
    figure = draw("ramps", study, {"curves": xr.Dataset()}, title="t")
    shown = lines(figure.axes[0])
    np.testing.assert_allclose(shown["onset of separation, speed rising"].get_ydata(), [15.3, np.nan, np.nan])
    np.testing.assert_allclose(shown["end of separation, speed falling"].get_ydata(), [9.7, 9.3, np.nan])
    assert list(shown[drawn.BEYOND].get_xdata()) == [0.1]
    assert list(shown["stable cycle ends (fold)"].get_ydata()) == pytest.approx([15.1, 15.1])
    save(figure, tmp_path / "ramps.png")
    save(draw("ramps", study), tmp_path / "alone.png")


def test_a_curve_may_pass_a_load_several_times() -> None:
    back = Curve(np.array([10.0, 11.0, 12.0, np.nan, 13.0]), np.array([300.0, 400.0, 300.0, np.nan, 350.0]), "fold")
    np.testing.assert_allclose(crossings(back, 350.0), [10.5, 11.5])
    assert crossings(back, 400.0).tolist() == [11.0]
    assert crossings(back, 500.0).size == 0
