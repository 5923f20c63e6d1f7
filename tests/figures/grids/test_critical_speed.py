"""The speed of onset over the load."""

from __future__ import annotations

import numpy as np
import xarray as xr

from disc_model.figures.grids import critical_speed as curves
from disc_model.figures.kinds import CriticalSpeed
from disc_model.figures.parts import save
from tests.figures.grids.reading import labels, lines
from tests.studies.grids.conftest import growth_over


def test_the_critical_speed_is_drawn_with_and_without_hysteresis(
    speeds: xr.Dataset, sweep: xr.Dataset, tmp_path
) -> None:
    plot = CriticalSpeed(claim={"x": (200, 12.6)})
    growth = growth_over([200.0, 400.0], np.linspace(12, 15, 7))
    both = curves.draw(speeds, {"hysteresis": sweep, "cycle": growth}, plot)
    assert [ax.get_title(loc="left") for ax in both.axes] == ["(a) modes as published", "(b) modes as published"]
    save(both, tmp_path / "both.png")
    alone = curves.draw(speeds, {}, CriticalSpeed())
    (ax,) = alone.axes
    assert lines(ax)["begins within 1000 s"].get_ydata()[:2].tolist() == [12.4, 12.4]
    # more than one crossing is explained
    twice = speeds.assign(n_crossings=speeds["n_crossings"] + 1)
    twice["crossing"][..., 1], twice["crossing_kind"][..., 1] = 14.2, 2
    assert "open: separation ends again" in labels(curves.draw(twice, {}, CriticalSpeed()).axes[0])
    save(alone, tmp_path / "alone.png")
