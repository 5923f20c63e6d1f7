"""What titles say of parameters."""

import json

import pytest
import xarray as xr

from disc_model.figures.general import CurvePlot


@pytest.mark.parametrize(
    ("base", "text"),
    [
        ({"N": 385.0, "Omega": 15.1, "mu_s": 0.4}, "N = 385 N, Ω = 15.1 rad/s"),
        ({"N": 385.0, "c_p": 1.0}, "N = 385 N, $c_p$ = 1 N s/m"),
        # what varies, and an N or Omega of 0, which stands for one that the quantity varies by itself
        ({"N": 200.0, "Omega": 0.0, "k": 3.0}, "N = 200 N"),
        ({"N": 200.0, "normalization": "orthonormal"}, "N = 200 N, orthonormal modes"),
        ({"N": 200.0, "contact": "bonded"}, "N = 200 N, bilateral contact"),
    ],
)
def test_a_title_says_what_is_fixed_with_symbols(base: dict[str, object], text: str) -> None:
    attrs = {"title": "Made up", "base": json.dumps(base)}
    status = ("k", [0, 0], {"flag_meanings": "ok"})
    study = xr.Dataset({"period": ("k", [1.0, 2.0]), "status": status}, {"k": [1.0, 2.0]}, attrs)
    plot = CurvePlot(variable="period", x="k")
    assert plot.render({"study": xr.DataTree(study)}).get_suptitle() == f"Made up\n{text}"
    said_below = plot.model_copy(update={"caption": "Said below."})
    assert said_below.render({"study": xr.DataTree(study)}).get_suptitle() == ""
