"""Growth maps: one scale of colours, curves on top, and what is no cycle."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.colors import AsinhNorm

from disc_model.figures.grids import growth_map, stability_map
from disc_model.figures.grids.cells import GREATEST
from disc_model.figures.kinds import GrowthMap, StabilityMap
from disc_model.figures.parts import save
from tests.figures.grids.reading import labels
from tests.studies.grids.conftest import growth_over


def test_a_growth_map_names_curves_and_gaps(plane: xr.Dataset, tmp_path) -> None:
    growth = growth_over(np.linspace(200, 400, 5), np.linspace(5, 18, 9))
    growth.attrs = {"title": "Growth", "base": '{"c_p": 0.5}'}
    mapped = growth_map.draw(growth, {"curves": plane}, GrowthMap())
    assert mapped.get_suptitle() == "Growth\n$c_p$ = 0.5 N s/m"
    assert mapped.axes[0].get_xlim() == (5, 18)
    assert {"cycle loses stability", "no cycle found"} <= set(labels(mapped))
    bar = mapped.axes[-1]
    assert [text.get_text() for text in bar.get_yticklabels()] == ["−0.1", "−0.01", "0", "0.01", "0.1"]
    save(mapped, tmp_path / "growth.png")
    both = xr.concat([growth, growth.assign_coords(normalization=["orthonormal"])], "normalization")
    assert len(growth_map.draw(both, {}, GrowthMap()).axes) == 3  # two panels and the colour bar
    full = growth.assign(growth_rate=xr.full_like(growth["growth_rate"], 0.1))
    assert not growth_map.draw(full, {}, GrowthMap()).legends
    none = growth.assign(growth_rate=growth["growth_rate"] * np.nan)
    assert labels(growth_map.draw(none, {}, GrowthMap())) == ["no cycle found"]


def test_growth_has_one_scale_of_colours_in_all_maps(toy) -> None:
    growth = growth_over(np.linspace(200, 400, 5), np.linspace(5, 18, 9))
    outcome = xr.zeros_like(growth["growth_rate"], dtype=np.int8)
    outcome.attrs = {"flag_meanings": "stable unstable separation unknown"}
    study = xr.Dataset({"outcome": outcome})
    maps = (
        growth_map.draw(growth, {}, GrowthMap()),
        stability_map.draw(study, {"growth": growth}, StabilityMap(x="Omega", y="N")),
    )
    norms = [next(c for c in figure.axes[0].collections if c.get_array() is not None).norm for figure in maps]
    assert all(isinstance(norm, AsinhNorm) and (norm.vmin, norm.vmax) == (-GREATEST, GREATEST) for norm in norms)


def test_a_curve_across_which_the_shown_cycle_does_not_change_is_of_another_cycle() -> None:
    """Neutral curves of other cycles crossed areas in which the shown one is stable."""
    speeds, loads = np.linspace(5, 50, 10), np.linspace(50, 500, 10)
    rate = np.where(loads[:, None] > 280, 0.1, -0.1) * np.ones((1, 10))
    cycle = xr.Dataset({"growth_rate": (("N", "Omega"), rate)}, {"N": loads, "Omega": speeds})
    own = growth_map.Curve(np.array([5.0, 20, np.nan, 40]), np.array([275.0, 275, np.nan, 275]), "neutral")
    away = growth_map.Curve(np.array([5.0, 10]), np.array([100.0, 100]), "fold", "2 f_s")
    (shown,), (other,) = growth_map.parted([own, away], cycle)
    np.testing.assert_array_equal(shown.N, own.N)
    np.testing.assert_array_equal(other.N, away.N)
    assert other.label == "", "it is not numbered"
