"""Neutral curves and folds in two parameters: on a map that is solved by hand, and of the slider."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

import disc_model as dm
from tests.refusals import refusal
from tests.stability.test_continuation import STEEL
from tests.stability.toy_maps import PERIOD, FoldMap, RoundMap, outside, use

P = dm.Parameters(N=300, Omega=15)


def test_the_neutral_curve_of_a_plane_is_found_once(monkeypatch: pytest.MonkeyPatch) -> None:
    use(monkeypatch, FoldMap)
    box = {"Omega": (3.0, 18.0), "N": (150.0, 450.0)}
    found = dm.neutral_curves(P, box, [250.0, 300.0], points=9, max_points=60)
    assert found.failures == ()
    [curve] = found
    assert curve.kind == "neutral"
    assert np.all(curve.period == PERIOD)
    assert_allclose(outside(*curve.values.T), 0, atol=1e-6)
    assert curve.adjoins_stable_cycle.all()
    assert curve.resonance.diameters == 1
    # it closes on itself
    assert_allclose(curve.values[0], curve.values[-1])
    assert_allclose(np.ptp(curve.values, axis=0), [8, 200], rtol=0.02)


def test_both_folds_of_a_plane_are_found_once(monkeypatch: pytest.MonkeyPatch) -> None:
    use(monkeypatch, RoundMap)
    box = {"Omega": (3.0, 20.0), "N": (250.0, 350.0)}
    found = dm.neutral_curves(P, box, [280.0, 310.0], points=9, max_points=60)
    assert found.failures == ()
    assert [curve.kind for curve in found] == ["fold", "fold"]
    for curve in found:
        Omega, N = curve.values.T
        assert_allclose(np.abs(Omega - 12 - 0.01 * (N - 300)), 4, rtol=0, atol=1e-6)
        assert curve.adjoins_stable_cycle.all()
        assert N.min() < 250 < 350 < N.max()


CURVES = {  # a case, its plane, and along a line at the middle the place of a fold of a stable cycle
    "few points": (
        {"N": 385, "Omega": 15},
        {"Omega": (14, 15.5), "N": (380, 390)},
        {"points": 5},
        15.0949118,
    ),
    "many points": (
        {"N": 385, "Omega": 15},
        {"Omega": (14, 15.5), "N": (380, 390)},
        {"points": 31},
        15.0949118,
    ),
    # from a stable cycle beyond a point of the line at which the static start leads to none
    "beyond": (
        {"N": 300, "Omega": 14},
        {"k_p": (26700, 26900), "N": (298, 302)},
        {"points": 21, "max_points": 20},
        26861.8806,
    ),
}


@pytest.mark.compiled
@pytest.mark.parametrize("name", CURVES)
def test_the_fold_of_a_stable_cycle_is_found(name: str) -> None:
    case, plane, options, place = CURVES[name]
    line = float(np.mean(plane["N"]))
    found = dm.neutral_curves(dm.Parameters(**case), plane, [line], **options)
    [fold] = [curve for curve in found if curve.adjoins_stable_cycle.all()]
    assert fold.kind == "fold"
    at_line = np.interp(line, fold.values[:, 1], fold.values[:, 0])
    assert at_line == pytest.approx(place, rel=4e-6)  # the curve is nearly straight there
    assert not found.failures


@pytest.mark.compiled
def test_points_of_a_curve_are_neutral_and_a_fold_is_followed_across_its_line() -> None:
    plane = {"Omega": (9.5, 11.0), "N": (350.0, 400.0)}
    case = dm.Parameters(N=375, Omega=10)
    found = dm.neutral_curves(case, plane, [375.0], points=2)
    assert found.failures == ()
    fold = next(curve for curve in found if curve.kind == "fold")
    assert fold.values[:, 1].min() < 375 < fold.values[:, 1].max()
    assert len(fold.values) < 30  # short steps are a sign of a corrector that fails
    for curve in found:
        if curve.kind == "neutral" and curve.adjoins_stable_cycle.all():
            Omega, N = curve.values[len(curve.values) // 2].tolist()
            assert dm.floquet(case.replace(Omega=Omega, N=N)).growth_rate == pytest.approx(
                0, abs=1e-6
            )


@pytest.mark.compiled
def test_a_branch_that_ends_elsewhere_is_told() -> None:
    steel = dm.Parameters(N=5139, Omega=34.65, **STEEL)
    plane = {"Omega": (34.65, 60.0), "N": (5100, 5200)}
    found = dm.neutral_curves(steel, plane, [5139], points=2)
    assert len(found) == 0
    assert found.failures == ("Omega from 34.65 to 60: grazing",)


@pytest.mark.parametrize(
    ("bounds", "lines", "told"),
    [
        ({"Omega": (16, 15), "N": (1, 2)}, [1.5], "^bounds=.*: must be two ascending numbers"),
        ({"Omega": (15, 16)}, [1.5], "^bounds=.*: must"),
        ({"Omega": (14, 15), "mu_s": (0.38, 0.42)}, [0.4, 0.5], r"lines=\[0.5\]: must lie within"),
    ],
)
def test_wrong_arguments_are_refused(bounds: Any, lines: list[float], told: str) -> None:
    with refusal(told):
        dm.neutral_curves(P, bounds, lines)
