"""Values that can hardly be meant, told once; and none of the paper's among them."""

import warnings
from typing import Any

import pytest

from disc_model import ImplausibleValue, Parameters, plausibility, simulate
from disc_model.plausibility import doubts
from disc_model.studies.study import parse_study
from tests.studies.refused import parse_grid

BASE = {"N": 200, "Omega": 20}
MODE: dict[str, Any] = {"diameters": [1], "omega": [3400.0], "amplitude": [0.5]}
SHAPES: dict[str, Any] = {"radii": [0.08, 0.12], "shapes": [[0.4, 0.6]]}


@pytest.mark.parametrize(
    ("changes", "kinds"),
    [
        ({}, set()),
        ({"E": 150}, {"E", "speed of sound", "static deflection"}),
        ({"rho": 7.2}, {"rho", "speed of sound"}),
        ({"h": 2}, {"h", "thickness"}),
        ({"h": 0.016}, {"thickness"}),
        ({"h": 0.015}, set()),
        ({"N": 2e5}, {"static deflection"}),
        ({"k": 50e6}, {"k"}),
        ({"k": 50e5}, set()),
        ({"k": 0, "D_star": 0, "mu_k": 0}, set()),
        ({"E": 8e9, "rho": 8000}, set()),  # sqrt(E/rho) = 1000 m/s
        ({"E": 7.9e9, "rho": 8000}, {"speed of sound"}),
        ({"n_diameters": -1, "N": 1e9}, set()),  # rigid
        ({"disc": MODE}, set()),
        ({"disc": MODE | {"omega": [3.4]}}, {"frequencies of the disc"}),  # in kHz
        ({"disc": MODE | {"omega": [3.4e6]}}, {"frequencies of the disc"}),
        ({"disc": MODE | {"amplitude": [500.0]}}, {"amplitudes of the disc"}),
        ({"disc": MODE | {"amplitude": [5e-4]}}, {"amplitudes of the disc"}),
        ({"disc": MODE | SHAPES}, set()),
        ({"disc": MODE | SHAPES, "r_0": 0.13}, {"radius of the slider"}),
    ],
)
def test_what_cannot_be_meant_is_doubted(changes: dict[str, float], kinds: set[str]) -> None:
    assert doubts(Parameters(**BASE | changes)).keys() == kinds


def test_a_doubt_names_parameter_value_and_rule() -> None:
    text = doubts(Parameters(**BASE, h=2))["thickness"]
    assert text == "h = 2 m is more than a fifth of b - a = 0.076 m, and the disc is modelled as a thin plate"


def test_each_doubt_is_told_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plausibility, "_told", set())
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        for h in (0.02, 0.021, 0.022):
            simulate(Parameters(**BASE, h=h, n_diameters=1), 1e-3)
    assert [str(one.message)[:12] for one in caught if one.category is ImplausibleValue] == ["h = 0.02 m i"]


def test_a_study_tells_of_how_many_points() -> None:
    axes = {"h": {"start": 0.001, "stop": 0.02, "count": 20}, "Omega": [10, 20, 30]}
    raw: dict[str, Any] = {"study": "thick", "quantity": "floquet", "base": {"N": 200}, "axes": axes}
    [text] = parse_grid(raw).doubts
    assert text.startswith("h = 0.016 m is more than a fifth")
    assert text.endswith(" (15 of 60 points)")
    one = {"title": "one", "t_end": 1}
    cases = {"A": one, "B": one | {"parameters": {"rho": 7.2}}}
    study = parse_study({"study": "some", "base": BASE, "cases": cases})
    assert [text[-14:] for text in study.doubts] == ["(1 of 2 cases)"] * 2
