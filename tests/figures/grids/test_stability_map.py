"""Maps of outcomes over two parameters."""

from __future__ import annotations

import json

import numpy as np
import pytest
import xarray as xr

from disc_model.figures.grids import stability_map as maps
from disc_model.figures.kinds import Mark, StabilityMap
from disc_model.figures.parts import save
from tests.figures.grids.reading import ON_EACH_SCALE, labels

OUTCOMES = {"flag_meanings": "failed quiet growing separation"}


@ON_EACH_SCALE
def test_maps_show_outcomes_on_growth(x: str, values: list[float], scale: str, tmp_path) -> None:
    loads, norms = [100.0, 200.0], ["as_published", "orthonormal"]
    axes = {"N": loads, x: values, "normalization": norms}
    codes = np.arange(12).reshape(2, 3, 2) % 4
    study = xr.Dataset({"outcome": (("N", x, "normalization"), codes, OUTCOMES)}, axes)
    rate = np.linspace(-0.1, 0.1, 12).reshape(2, 3, 2)
    rate[0, 0, 0] = np.nan
    growth = xr.Dataset({"growth_rate": (("N", x, "normalization"), rate)}, axes)
    marks = {"a": Mark(x=values[1], y=100, paper="stable"), "b": Mark(x=values[2], y=200, paper="separation")}
    figure = maps.draw(study, {"growth": growth}, StabilityMap(x=x, y="N", marks=marks))
    assert figure.axes[0].get_xscale() == scale
    assert {text.get_text() for text in figure.axes[0].texts} == {"a", "b"}
    said = {"stays quiet", "separation", "no cycle found", "the paper: stays quiet", "the paper: separation"}
    assert said <= set(labels(figure))
    save(figure, tmp_path / "map.png")
    bare = maps.draw(study.sel(normalization="orthonormal"), {}, StabilityMap(x=x, y="N"))
    (ax,) = bare.axes
    assert ax.get_ylabel() == "Preload N (N)"


@pytest.mark.parametrize(("x", "values"), [("n_diameters", [2, 4, 8]), ("n_circles", [0, 1]), ("c", [0.0])])
def test_maps_of_one_normalization_over_any_number(x: str, values: list[float], tmp_path) -> None:
    axes, shape = {"N": [100.0, 200.0], x: values}, (2, len(values))
    attrs = {"base": json.dumps({"normalization": "orthonormal"})}
    study = xr.Dataset({"outcome": (("N", x), np.ones(shape, int), OUTCOMES)}, axes, attrs)
    rate = xr.DataArray(np.linspace(-1, 1, 2 * len(values)).reshape(shape), dims=("N", x))
    norms = {"normalization": ["as_published", "orthonormal"]}
    growth = xr.Dataset({"growth_rate": rate.expand_dims(norms)}, axes | norms)
    plot = StabilityMap(x=x, y="N", marks={"a": Mark(x=values[0], y=100, paper="stable")})
    figure = maps.draw(study, {"growth": growth}, plot)
    panel, _ = figure.axes
    assert panel.get_title(loc="left") == "orthonormal modes"
    assert panel.get_xlabel() == {"c": "Damper c (N s/m)"}.get(x, f"Nodal {x[2:]}")
    # the paper's cases are of the other modes
    assert not any("the paper" in label for label in labels(figure))
    save(figure, tmp_path / "map.png")
