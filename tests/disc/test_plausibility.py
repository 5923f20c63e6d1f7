"""Values that can hardly be meant, told once; and none of the paper's among them."""

import inspect
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import disc_model as dm
from disc_model import Disc, ImplausibleValue, Parameters, simulate
from disc_model.disc import plausibility
from disc_model.simulation.states import engine_case
from disc_model.studies.study import parse_study
from tests.studies.refused import parse_grid

BASE = {"N": 200, "Omega": 20}
BASE_OF_GRID = {"N": 200, "normalization": "orthonormal"}


def test_each_doubt_is_told_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plausibility, "_reported", set())
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        for h in (0.02, 0.021, 0.022):
            simulate(
                Parameters(**BASE, h=h, n_diameters=1, normalization="orthonormal", D_star=0), 1e-3
            )
    assert [str(one.message)[:12] for one in caught if one.category is ImplausibleValue] == [
        "h = 0.02 m i"
    ]


def test_the_paper_s_radius_and_damping_are_no_defaults_for_another_disc() -> None:
    disc = Disc(diameters=[0], omega=[1e3], amplitude=[4], radii=[0.02, 0.06], shapes=[[0, 4]])
    for given, text in (
        ({}, "r_0 = 0.1 m is the paper's"),
        ({"r_0": 0.1}, "r_0 = 0.1 m is not within 0.02 to 0.06 m"),
    ):
        assert plausibility.doubts(Parameters(**BASE, disc=disc, **given))[
            "radius of the slider"
        ].startswith(text)
    assert plausibility.doubts(Parameters(**BASE, disc=disc, r_0=0.06)) == {}
    [text] = plausibility.doubts(Parameters(**BASE, h=0.003, normalization="orthonormal")).values()
    assert text.endswith(": state the damping (D_star or damping_ratio)")


def test_amplitudes_and_deflections_that_mistakes_in_units_make_are_doubted() -> None:
    [text] = plausibility.doubts(Parameters(N=160e3, Omega=20)).values()
    assert text.startswith("N = 160000 N bends the disc by 845 mm, 422 times the thickness")
    shaped = {"radii": [0.05, 0.12], "shapes": [[0, 1.4], [0, 9.0]]}  # at 0.1 m, 1 and 6.43
    for amplitude, words in (
        ([1.0, 400.0], "modal mass of 6.3e-06 kg"),
        ([1.0, 4.0], "moves by 6.43 kg^-1/2 there"),
    ):
        disc = Disc(
            diameters=[0, 1],
            omega=[1e3, 2e3],
            amplitude=amplitude,
            **(shaped if amplitude[1] < 5 else {}),
        )
        assert any(
            words in text
            for text in plausibility.doubts(Parameters(**BASE, disc=disc, r_0=0.1)).values()
        )


def test_a_study_tells_of_doubts_once() -> None:
    axes = {"h": {"start": 0.001, "stop": 0.02, "count": 20}, "Omega": [10, 20, 30]}
    raw: dict[str, Any] = {
        "study": "thick",
        "quantity": "floquet",
        "base": BASE_OF_GRID,
        "axes": axes,
    }
    [text] = parse_grid(raw).doubts
    assert text.startswith("h = 0.02 m is more than a fifth")
    one = {"title": "one", "t_end": 1}
    cases = {"A": one, "B": one | {"parameters": {"rho": 7.2}}}
    study = parse_study(
        {
            "study": "some",
            "base": BASE | {"normalization": "orthonormal", "D_star": 0},
            "cases": cases,
        }
    )
    assert [text.partition(" ")[0] for text in study.doubts] == ["rho"]


def test_a_doubt_is_told_at_the_reader_s_line(monkeypatch: pytest.MonkeyPatch) -> None:
    """It showed a line of this package."""
    monkeypatch.setattr(plausibility, "_reported", set())
    with pytest.warns(ImplausibleValue) as caught:
        simulate(Parameters(**BASE, E=150, normalization="orthonormal"), 1e-3)
    assert {Path(warning.filename).name for warning in caught} == {Path(__file__).name}


THICK = Parameters(N=200, Omega=20, n_diameters=1, h=0.02)
PLANE: dict[str, Any] = {"bounds": {"Omega": (10, 30), "N": (100, 300)}, "lines": (200.0,)}
#: Arguments of public functions of a case beside the case, where these are needed or save time.
ARGUMENTS: dict[str, dict[str, Any]] = {
    "basins": {"horizon": 0.1},
    "continue_cycle": {"name": "Omega", "bounds": (19.9, 20.1)},
    "critical": {"name": "Omega", "bounds": (19, 20), "points": 2},
    "critical_speed": {"bounds": (19, 20), "horizon": 0.1},
    "deflection": {"states": [], "r": 0.1, "theta": 0.0},
    "fit": {
        "vary": ["E"],
        "data": [{"quantity": "frequency_0_0", "value": 2390.0, "uncertainty": 1.0}],
    },
    "hysteresis": {"bounds": (19, 20), "dwell": 5, "max_dwell": 5},
    "lyapunov_exponents": {"duration": 0.1, "count": 1},
    "neutral_curves": PLANE,
    "outcome": {"horizon": 10.0},
    "pinned_range": {"frequency": 100.0},
    "simulate": {"t_end": 1e-3},
    "snapshots": {"times": 1e-4},
    "split_growth": {"split": 0.0},
}


def functions_of_a_case() -> dict[str, Callable[..., object]]:
    """All public functions with a parameter `case`, by name."""
    found = {}
    for name in dm.__all__:
        value = getattr(dm, name)
        if inspect.isfunction(value) and "case" in inspect.signature(value).parameters:
            found[name] = value
    return found


@pytest.mark.compiled
@pytest.mark.parametrize("name", functions_of_a_case())
def test_every_public_function_of_a_case_tells_doubts_once(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Those that one calls first for a disc of one's own, such as `plate_modes`, did not."""
    monkeypatch.setattr(plausibility, "_reported", set())
    engine_case.cache_clear()
    function = functions_of_a_case()[name]
    given: dict[str, Any] = {"case": THICK, **ARGUMENTS.get(name, {})}
    if name == "sweep":
        given |= {"function": lambda case: case.N, "N": [100, 200]}
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        for _ in range(2):
            function(**given)
    doubts = [warning for warning in caught if warning.category is ImplausibleValue]
    told = [str(warning.message).partition(" is ")[2].partition(" of")[0] for warning in doubts]
    assert told == ["more than a fifth", "not the paper's disc: state the normalization"]
    assert {Path(warning.filename).name for warning in doubts} == {Path(__file__).name}


def test_cases_that_are_tried_are_not_doubted(monkeypatch: pytest.MonkeyPatch) -> None:
    """Doubts of trial cases of a fit were not shown, and counted as told."""
    monkeypatch.setattr(plausibility, "_reported", set())
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with plausibility.trial_cases():
            dm.plate_modes(THICK)
    with pytest.warns(ImplausibleValue) as caught:
        dm.plate_modes(THICK)
    assert "more than a fifth" in str(caught[0].message)
