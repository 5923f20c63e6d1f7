"""Figures of grid studies: one normalization or two, points that failed, grids too narrow."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tests.figures.grids.reading import crosses, draw, lines
from tests.studies.grids.conftest import growth_over, in_base, made_up_samples, with_failed


def test_points_that_failed_are_marked_and_not_drawn(plane: xr.Dataset, speeds: xr.Dataset, sweep: xr.Dataset) -> None:
    lost = with_failed(speeds, N=200)
    both = draw("critical_speed", lost, {"hysteresis": with_failed(sweep, N=400)})
    assert [crosses(ax) for ax in both.axes] == [[[200]], [[400]]]
    shown = lines(both.axes[0]) | lines(both.axes[1])
    for label in ("separation begins, within 1000 s", "published start, within 1000 s"):
        loads = np.asarray(shown[label].get_ydata())
        assert set(loads[np.isfinite(loads)]) == {400}
    for label in ("sweep up: separation begins", "sweep down: separation ends"):
        assert np.isfinite(shown[label].get_xdata()).tolist() == [True, False]
    growth = growth_over(np.linspace(200, 400, 5), np.linspace(5, 18, 9))
    (ax,) = draw("thresholds", lost, {"curves": plane, "cycle": growth}).axes
    assert crosses(ax) == [[200]]
    separation = lines(ax)["separation begins, within 1000 s"].get_ydata()
    assert np.nanmin(separation) == np.nanmax(separation) == 400
    # nothing is known of any
    (ax,) = draw("thresholds", with_failed(lost, N=400), {"curves": plane, "cycle": growth}).axes
    assert crosses(ax) == [[200, 400]]


def test_the_normalization_may_be_given_in_base(plane: xr.Dataset, speeds: xr.Dataset, sweep: xr.Dataset) -> None:
    growth = growth_over(np.linspace(200, 400, 5), np.linspace(5, 18, 9))
    both = xr.concat([growth, growth.assign_coords(normalization=["orthonormal"])], "normalization")
    alone = in_base(speeds)
    assert len(draw("critical_speed", alone, {"hysteresis": in_base(sweep), "cycle": both}).axes) == 2
    assert len(draw("thresholds", alone, {"curves": plane, "cycle": both}).axes) == 1
    assert len(draw("growth_map", in_base(growth), {"curves": plane}).axes) == 2  # and the colour bar
    samples, exponents = made_up_samples("as_published")
    exponents = exponents.expand_dims(normalization=["as_published"])
    assert len(draw("bifurcation", samples, {"lyapunov": exponents}, x="N").axes) == 2


def test_grids_too_narrow_for_contours_are_drawn_without(plane: xr.Dataset, speeds: xr.Dataset) -> None:
    for growth in (growth_over([200.0], np.linspace(5, 18, 9)), growth_over([200.0, 400.0], [5.0, 9.0])):
        assert draw("critical_speed", speeds, {"cycle": growth}).axes
        assert draw("thresholds", speeds, {"curves": plane, "cycle": growth}).axes
