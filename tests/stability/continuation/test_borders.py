"""Borders of stability in two parameters, on a map that is solved by hand."""

import numpy as np
import pytest

from disc_model import ParameterError, Parameters
from disc_model.stability.continuation import BORDER, continue_border
from disc_model.stability.curves import neutral_curves
from tests.stability.continuation.toy_maps import PERIOD, fold_at, fold_map, outside

__all__ = ["fold_map"]
pytestmark = pytest.mark.usefixtures("fold_map")
P = Parameters(N=300, Omega=15)
BOX = {"Omega": (3.0, 18.0), "N": (150.0, 450.0)}


def test_the_neutral_curve_is_the_ellipse():
    curve = continue_border("neutral", P.replace(Omega=13.5), ("Omega", "N"), BOX)
    assert curve.ended == "the curve closes on itself"
    assert [outside(*values) for values in curve.values] == pytest.approx(
        np.zeros(len(curve)), abs=1e-8
    )
    assert curve.growth_rate == pytest.approx(np.zeros(len(curve)), abs=1e-7)
    span = np.ptp(curve.values, axis=0)
    assert span == pytest.approx([8, 200], rel=0.02)
    np.testing.assert_array_equal(curve.values[0], curve.values[-1])
    # what is not closed is followed in both directions
    part = continue_border(
        "neutral", P.replace(Omega=13.5), ("Omega", "N"), BOX, steps=BORDER.replace(max_points=4)
    )
    assert len(part) == 7
    assert part.values[3] == pytest.approx(curve.values[0])
    turning = part.values[3]
    before = part.values[2] - turning
    after = part.values[4] - turning
    assert before @ after < 0


def test_a_fold_is_followed_from_the_point_itself():
    """A search for a cycle near it would not converge."""
    at_fold = P.replace(Omega=fold_at(300))
    guess = np.array([1.0, 0.0, 0.0])
    curve = continue_border("fold", at_fold, ("Omega", "N"), BOX, guess=guess, mu=1.0)
    Omega, N = curve.values.T
    assert Omega == pytest.approx(fold_at(N), abs=1e-6)
    assert curve.ended == "Omega or N has left the bounds"
    assert Omega.min() < 13.2 < 17.8 < Omega.max()


def test_what_cannot_be_followed_is_told(monkeypatch):
    def lost(*_, **__):
        raise ParameterError("no cycle")

    monkeypatch.setattr("disc_model.stability.curves.continue_border", lost)
    found = neutral_curves(P, BOX, [225.0, 300.0, 375.0], points=9)
    assert len(found) == 0
    assert {failure.split()[0] for failure in found.failures} == {"fold", "neutral"}
    for failure in found.failures:
        assert " near Omega=" in failure
        assert failure.endswith(": no cycle")
    assert repr(found).startswith(
        "NeutralCurves(0 curves over Omega from 3 to 18 and N from 150 to 450, "
    )


def test_all_curves_of_a_plane_are_found_once():
    curves = neutral_curves(P, BOX, [250.0, 300.0], points=9, max_points=60)
    assert curves.failures == ()
    assert sorted(curve.kind for curve in curves) == ["fold", "neutral"]
    for curve in curves:
        Omega, N = curve.values.T
        if curve.kind == "fold":
            assert Omega == pytest.approx(fold_at(N), abs=1e-6)
            # a stable cycle is on one side within the ellipse only, which the line does not meet
            assert not curve.adjoins_stable_cycle.any()
        else:
            assert outside(Omega, N) == pytest.approx(np.zeros(len(N)), abs=1e-6)
            assert curve.adjoins_stable_cycle.all()
            assert curve.resonance.diameters == 1
        assert np.all(curve.period == PERIOD)
