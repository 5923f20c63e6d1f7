"""Continuation on a map that is solved by hand: every point, every fold and every border is
known."""

import numpy as np
import pytest

from disc_model import ParameterError, Parameters
from disc_model.stability.continuation import BORDER, CycleProblem, continue_border, continue_cycle
from disc_model.stability.curves import neutral_curves
from disc_model.stability.cycle import bifurcation_type
from tests.stability.toy_map import PERIOD, cycle_at, fold_at, growth_at, outside, toy

__all__ = ["toy"]
pytestmark = pytest.mark.usefixtures("toy")
P = Parameters(N=300, Omega=15)
BOX = {"Omega": (3.0, 18.0), "N": (150.0, 450.0)}


def test_a_branch_goes_both_ways_and_round_its_fold_to_its_bounds():
    branch = continue_cycle(P, "Omega", (12.0, 17.0))
    assert branch.ended == "Omega has left 12 .. 17"
    assert branch.values[[0, -1], 0] == pytest.approx([12, 12], rel=1e-15)  # scaled, and back
    ahead = continue_cycle(P, "Omega", (12.0, 15.96), direction=1)
    assert [*ahead.values[[0, -1], 0], len(ahead.folds)] == pytest.approx([15, 15.96, 0], rel=1e-15)
    with pytest.raises(ParameterError, match="Omega=15: must lie within the bounds, 12 to 14"):
        continue_cycle(P, "Omega", (12.0, 14.0))
    assert len(repr(branch)) < 200
    assert branch.folds == pytest.approx(np.array([[fold_at(300)]]), abs=1e-9)
    upper = branch.points[:, 0] > 1
    assert upper[0]
    assert not upper[-1]
    for values, x, growth, above in zip(
        branch.values, branch.points, branch.growth_rate, upper, strict=True
    ):
        assert x == pytest.approx(cycle_at(values[0], 300, above), abs=1e-9)
        assert growth == pytest.approx(growth_at(values[0], 300, above), abs=1e-6)
    assert np.all(branch.period == PERIOD)
    assert branch.stick_fraction == pytest.approx(np.full(len(branch), 0.3))
    # inside the ellipse the rotating pair is the slower one to die out; on the lower branch x_0
    # grows
    assert {bifurcation_type(complex(branch.multipliers[i, 0])) for i in (0, -1)} == {
        "fold",
        "neimark_sacker",
    }
    assert (branch.diameters[0], branch.diameters[-1]) == (1, 0)


@pytest.mark.parametrize(
    ("Omega", "why"),
    [
        (31, "does not return: lost_contact"),
        (0, "vanishes"),
        (-1, "Omega=-1"),
        (17, "does not converge"),  # beyond the fold there is nothing to converge to
    ],
)
def test_where_there_is_no_cycle_the_corrector_is_lost(Omega, why):
    problem = CycleProblem(P, ("Omega",), None, 1e-12)
    z = np.array([1.0, 0, 0, Omega / problem.scales[0]])
    with pytest.raises(ParameterError, match=why):
        problem.correct(z, np.eye(4)[3:], z[3:])


def test_the_neutral_curve_is_the_ellipse():
    curve = continue_border("neutral", P.replace(Omega=13.5), ("Omega", "N"), BOX)
    assert curve.ended == "the curve is closed"
    assert [outside(*values) for values in curve.values] == pytest.approx(
        np.zeros(len(curve)), abs=1e-8
    )
    assert curve.growth_rate == pytest.approx(np.zeros(len(curve)), abs=1e-7)
    span = np.ptp(curve.values, axis=0)
    assert span == pytest.approx([8, 200], rel=0.02)
    # what is not closed is followed in both directions
    part = continue_border(
        "neutral", P.replace(Omega=13.5), ("Omega", "N"), BOX, steps=BORDER.replace(max_points=4)
    )
    assert len(part) == 7
    assert part.values[3] == pytest.approx(curve.values[0])
    assert (part.values[2] - part.values[3]) @ (part.values[4] - part.values[3]) < 0


def test_what_cannot_be_followed_is_told(monkeypatch):
    def lost(*_, **__):
        raise ParameterError("no cycle")

    monkeypatch.setattr("disc_model.stability.curves.continue_border", lost)
    found = neutral_curves(P, BOX, [225.0, 300.0, 375.0], points=9)
    assert (len(found), {failure.split()[0] for failure in found.failures}) == (
        0,
        {"fold", "neutral"},
    )
    assert all(
        " near Omega=" in failure and failure.endswith(": no cycle") for failure in found.failures
    )
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
