"""Samples for bifurcation diagrams."""

from __future__ import annotations

import numpy as np
import pytest

from disc_model import ParameterError, Parameters, Poincare, Record, simulate
from disc_model.figures.grids.stability import Curve, bifurcation_diagram, growth_map, threshold_chart
from disc_model.figures.style import save
from disc_model.stability.bifurcation import STATUS_NAMES, bifurcation_samples

BASE = Parameters(N=385, Omega=15)


def test_samples_are_those_of_the_simulator():
    data = bifurcation_samples(BASE, "N", [300.0, 385.0], transient=1.0, samples=5)
    assert data["psi"].dims == ("N", "sample")
    assert data.sizes == {"N": 2, "sample": 5}
    turn = 2 * np.pi / BASE.Omega
    first = np.ceil(1.0 / turn) * turn
    run = simulate(BASE, first + 5 * turn, record=Record(poincare=Poincare(start=first - 0.1 * turn)))
    assert np.allclose(data["psi"].sel(N=385.0), run.poincare["psi"][:5], rtol=0, atol=1e-9)
    assert [STATUS_NAMES[i] for i in data["status"].values] == ["ok", "ok"]
    assert set(np.unique(data["phase"])) <= {0, 1, 2}


def test_following_starts_where_the_last_value_ended():
    values = [15.0, 15.001]
    fresh = bifurcation_samples(BASE, "Omega", values, transient=0.5, samples=3)
    followed = bifurcation_samples(BASE, "Omega", values, transient=0.5, samples=3, follow=True)
    assert np.array_equal(fresh["psi"][0], followed["psi"][0])
    assert not np.allclose(fresh["psi"][1], followed["psi"][1])


def test_bad_input_is_named_in_full():
    with pytest.raises(ParameterError, match=r"name='contact': .*; values=\[\]: .*; samples=0: "):
        bifurcation_samples(BASE, "contact", [], transient=1, samples=0)
    with pytest.raises(ParameterError, match="Omega: must be > 0"):
        bifurcation_samples(BASE, "Omega", [0.0], transient=1, samples=1)


def test_figures_are_drawn(tmp_path):
    import xarray as xr

    speeds, loads = np.linspace(5, 50, 6), np.linspace(50, 600, 5)
    rate = np.linspace(-0.1, 0.2, 30).reshape(5, 6)
    rate[2, 3] = np.nan
    grid = xr.Dataset({"growth_rate": (("N", "Omega"), rate)}, coords={"N": loads, "Omega": speeds})
    neutral = Curve(speeds, np.linspace(200, 60, 6), "neutral")
    fold = Curve(speeds, speeds * 25, "fold", "2 f_s = 135.42 Hz")
    grids = {"as_published": grid, "orthonormal": grid}
    save(growth_map(grids, {"as_published": [neutral, fold]}), tmp_path / "map.png")
    chart = threshold_chart(loads, np.array([np.nan, 30, 25, 20, 18]), 1000.0, neutral, [fold], {200: 12.6})
    save(chart, tmp_path / "chart.png")
    data = bifurcation_samples(BASE, "N", [300.0, 385.0], transient=0.2, samples=5)
    save(bifurcation_diagram(data, "N"), tmp_path / "diagram.png")
    assert all((tmp_path / f"{name}.png").stat().st_size > 5000 for name in ("map", "chart", "diagram"))
