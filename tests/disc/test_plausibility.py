"""Values that can hardly be meant, told once; and none of the paper's among them."""

import warnings
from typing import Any

import pytest

from disc_model import Disc, ImplausibleValue, Parameters, simulate
from disc_model.disc import plausibility
from disc_model.studies.study import parse_study
from tests.studies.refused import parse_grid

BASE = {"N": 200, "Omega": 20}
BASE_OF_GRID = {"N": 200, "normalization": "orthonormal"}


def test_each_doubt_is_told_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plausibility, "_reported", set())
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        for h in (0.02, 0.021, 0.022):
            simulate(Parameters(**BASE, h=h, n_diameters=1, normalization="orthonormal", D_star=0), 1e-3)
    assert [str(one.message)[:12] for one in caught if one.category is ImplausibleValue] == ["h = 0.02 m i"]


def test_the_paper_s_radius_and_damping_are_no_defaults_for_another_disc() -> None:
    disc = Disc(diameters=[0], omega=[1e3], amplitude=[4], radii=[0.02, 0.06], shapes=[[0, 4]])
    for given, text in (({}, "r_0 = 0.1 m is the paper's"), ({"r_0": 0.1}, "r_0 = 0.1 m is not within 0.02 to 0.06 m")):
        assert plausibility.doubts(Parameters(**BASE, disc=disc, **given))["radius of the slider"].startswith(text)
    assert plausibility.doubts(Parameters(**BASE, disc=disc, r_0=0.06)) == {}
    [text] = plausibility.doubts(Parameters(**BASE, h=0.003, normalization="orthonormal")).values()
    assert text.endswith(": state the damping (D_star or damping_ratio)")


def test_a_study_tells_of_how_many_points() -> None:
    axes = {"h": {"start": 0.001, "stop": 0.02, "count": 20}, "Omega": [10, 20, 30]}
    raw: dict[str, Any] = {"study": "thick", "quantity": "floquet", "base": BASE_OF_GRID, "axes": axes}
    [text] = parse_grid(raw).doubts
    assert text.startswith("h = 0.016 m is more than a fifth")
    assert text.endswith(" (15 of 60 points)")
    one = {"title": "one", "t_end": 1}
    cases = {"A": one, "B": one | {"parameters": {"rho": 7.2}}}
    study = parse_study({"study": "some", "base": BASE | {"normalization": "orthonormal", "D_star": 0}, "cases": cases})
    assert [text[-14:] for text in study.doubts] == ["(1 of 2 cases)"] * 2
