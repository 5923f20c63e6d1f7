"""Growth, and where separation follows."""

from __future__ import annotations

import numpy as np
import xarray as xr

from disc_model.figures.grids import thresholds
from disc_model.figures.grids.kinds import GrowthMap, Thresholds
from disc_model.figures.style import save
from tests.studies.grids.conftest import growth_over


def test_growth_and_thresholds_are_drawn(plane: xr.Dataset, speeds: xr.Dataset, tmp_path) -> None:
    growth = growth_over(np.linspace(200, 400, 5), np.linspace(5, 18, 9))
    mapped = thresholds.draw(growth, {"curves": plane}, GrowthMap())
    assert mapped.axes[0].get_xlim() == (5, 18)
    save(mapped, tmp_path / "growth.png")
    chart = thresholds.draw(speeds, {"curves": plane, "cycle": growth}, Thresholds(claim={"a": (200, 12.6)}))
    labels = [text.get_text() for text in chart.legends[0].get_texts()]
    assert "separation within 1000 s" in labels
    assert "paper" in labels
    save(chart, tmp_path / "chart.png")
    both = xr.concat([growth, growth.assign_coords(normalization=["orthonormal"])], "normalization")
    assert len(thresholds.draw(both, {}, GrowthMap()).axes) == 3  # two panels and the colour bar
    without = thresholds.draw(speeds, {"curves": plane}, Thresholds())
    assert len(without.axes) == 1
