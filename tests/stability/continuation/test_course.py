"""Branches in one parameter on maps that are solved by hand: every point and every fold is known."""

import math
import pickle
from itertools import pairwise

import numpy as np
import pytest

from disc_model import ParameterError, Parameters
from disc_model.stability.continuation import (
    CycleProblem,
    StepControl,
    continue_cycle,
    special_point,
)
from disc_model.stability.continuation.curve import Rejected, solve
from disc_model.stability.cycle import bifurcation_type
from disc_model.stability.segments import Extremes
from tests.refusals import refusal
from tests.stability.continuation.toy_maps import (
    PERIOD,
    BrokenMap,
    CornerMap,
    CubicMap,
    FoldMap,
    ResonantMap,
    RoundMap,
    cycle_at,
    fold_at,
    growth_at,
    use,
)

P = Parameters(N=300, Omega=15)


@pytest.fixture(autouse=True)
def extremes_are_known(monkeypatch):
    """Points of these maps are no states of a slider, whose height would be simulated."""

    def extremes(*_: object) -> Extremes:
        return Extremes(-1e-6, 1e-6)

    monkeypatch.setattr(special_point, "extremes_of_cycle", extremes)


@pytest.fixture
def branch(monkeypatch):
    use(monkeypatch, FoldMap)
    return continue_cycle(P, "Omega", (12.0, 17.0))


def test_a_branch_goes_both_ways_and_round_its_fold_to_its_bounds(branch):
    assert branch.ended == "the bound Omega = 12 rad/s was reached"
    assert branch.values[[0, -1], 0].tolist() == [12, 12]
    assert len(repr(branch)) < 200
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
    leading = {bifurcation_type(complex(branch.multipliers[i, 0])) for i in (0, -1)}
    assert leading == {"fold", "neimark_sacker"}
    assert branch.diameters[0] == 1
    assert branch.diameters[-1] == 0


def test_the_fold_is_located_to_rounding(branch):
    # of the residual, 3e-11 of the deflection, over the slope of the map by the speed, 0.03
    assert branch.folds == pytest.approx(np.array([[fold_at(300)]]), abs=2e-9)


def test_directions_are_followed_alone(monkeypatch):
    use(monkeypatch, FoldMap)
    ahead = continue_cycle(P, "Omega", (12.0, 15.96), direction=1)
    assert ahead.values[[0, -1], 0].tolist() == [15, 15.96]
    assert len(ahead.folds) == 0
    assert ahead.ended == "the bound Omega = 15.96 rad/s was reached"
    back = continue_cycle(P, "Omega", (12.0, 15.96), direction=-1)
    assert back.values[[0, -1], 0].tolist() == [15, 12]
    at_bound = continue_cycle(P, "Omega", (15.0, 15.96), direction=-1)
    assert len(at_bound) == 1
    with refusal("Omega=15: must lie within the bounds, 12 to 14"):
        continue_cycle(P, "Omega", (12.0, 14.0))


def test_a_fold_just_beyond_a_bound_is_none_of_the_branch(monkeypatch):
    use(monkeypatch, FoldMap)
    branch = continue_cycle(P, "Omega", (12.0, 16 - 1e-5))
    assert len(branch.folds) == 0
    assert branch.values[-1, 0] == 16 - 1e-5
    beyond = continue_cycle(P, "Omega", (12.0, 15.9), steps=StepControl(beyond=True))
    assert beyond.values.max() > 15.9
    assert "the bound Omega = 15.9 rad/s was passed" in beyond.ended


def test_a_closed_branch_ends_where_it_began(monkeypatch):
    use(monkeypatch, RoundMap)
    branch = continue_cycle(Parameters(N=300, Omega=12), "Omega", (5.0, 20.0))
    assert branch.ended == "the branch closes on itself"
    assert np.sort(branch.folds[:, 0]) == pytest.approx([8, 16], abs=1e-9)
    np.testing.assert_array_equal(branch.points[0], branch.points[-1])
    assert branch.special_points["kind"].tolist() == ["fold", "fold"]
    # once round the circle, and no further
    sine = (branch.values[:, 0] - 12) / 4
    cosine = branch.points[:, 0] - 2
    angle = np.unwrap(np.arctan2(sine, cosine))
    assert abs(angle[-1] - angle[0]) == pytest.approx(math.tau, abs=1e-6)


def test_a_branch_has_cycles_at_given_values_each_time_it_passes_them(monkeypatch):
    use(monkeypatch, FoldMap)
    wanted = ["14 rad/s", "142.5 rpm", "15.9999 rad/s", "16.5 rad/s"]
    branch = continue_cycle(P, "Omega", (12.0, 17.0), values=wanted)
    values = branch.values[:, 0]
    for value in (14.0, 142.5 * math.tau / 60, 15.9999):
        heights = np.sort(branch.points[np.isclose(values, value, rtol=1e-14, atol=0), 0])
        expected = [cycle_at(value, 300, upper)[0] for upper in (False, True)]
        assert heights == pytest.approx(expected, abs=1e-8)
    assert branch.not_reached.tolist() == [16.5]
    # they are in order along the branch, and the number before the fold still belongs to it
    [fold] = [each for each in branch.special if each.kind == "fold"]
    assert np.all(np.diff(branch.points[:, 0]) < 0)
    assert branch.points[fold.after, 0] > 1 > branch.points[fold.after + 1, 0]


def test_special_points_of_both_halves_lie_behind_the_point_of_their_number(branch):
    """From 15 rad/s down, the pair crosses the unit circle at 14; up, there is the fold at 16, and
    beyond it 14 again."""
    _, down, fold, beyond, _ = branch.special
    assert [down.kind, fold.kind, beyond.kind] == ["neimark_sacker", "fold", "neimark_sacker"]
    values = branch.values[:, 0]
    assert values[down.after] < 14 < values[down.after + 1]
    assert branch.points[fold.after, 0] > 1 > branch.points[fold.after + 1, 0]
    assert values[beyond.after] > 14 > values[beyond.after + 1]


def test_a_branch_stops_at_its_first_fold(monkeypatch):
    use(monkeypatch, FoldMap)
    branch = continue_cycle(P, "Omega", (12.0, 17.0), stop_at="fold")
    assert branch.ended == (
        "the bound Omega = 12 rad/s was reached; the first fold, at Omega = 16 rad/s"
    )
    assert branch.values[-1, 0] == pytest.approx(16, abs=1e-8)
    assert branch.special_points["label"].tolist() == ["EP", "TR", "LP"]


def test_kinds_at_which_a_branch_stops_may_be_several_and_labels(monkeypatch):
    use(monkeypatch, FoldMap)
    for stop_at in ("LP", ["fold"], ("PD", "LP")):
        branch = continue_cycle(P, "Omega", (12.0, 17.0), stop_at=stop_at)
        assert branch.special_points["label"].tolist() == ["EP", "TR", "LP"]
    branch = continue_cycle(P, "Omega", (12.0, 17.0), stop_at=["LP", "TR"])
    assert branch.special_points["label"].tolist() == ["TR", "LP"]
    for wrong in ("GR", ["LP", "HB"], ["LP", 3], 3):
        with refusal(r"stop_at=.*must be None, or one or several of"):
            continue_cycle(P, "Omega", (12.0, 17.0), stop_at=wrong)


def test_neimark_sacker_points_are_those_of_the_ellipse(monkeypatch):
    use(monkeypatch, FoldMap)
    branch = continue_cycle(Parameters(N=300, Omega=10), "Omega", (4.0, 15.0))
    found = [each for each in branch.special if each.kind == "neimark_sacker"]
    assert [each.values[0] for each in found] == pytest.approx([6, 14], abs=1e-8)
    for each in found:
        assert each.multiplier == pytest.approx(complex(math.cos(1.2), math.sin(1.2)), abs=1e-9)
        assert each.label == "TR"
        assert each.growth_rate == pytest.approx(0, abs=1e-6)


def test_special_points_are_a_table_with_states(branch):
    table = branch.special_points
    assert table["label"].tolist() == ["EP", "TR", "LP", "TR", "EP"]
    assert table["Omega"].tolist() == pytest.approx([12, 14, 16, 14, 12], abs=1e-8)
    fold = branch.special[2]
    assert fold.state == pytest.approx([1, 0, 0], abs=1e-4)  # steep there: x_0 = 1 + sqrt(mu)
    assert fold.case == P.replace(Omega=float(fold.values[0]))
    assert branch.state(-1) == pytest.approx(cycle_at(12, 300, upper=False), abs=1e-9)
    assert branch.case_at(-1).Omega == 12
    for wrong in (len(branch), -len(branch) - 1, 0.5, "0", slice(2)):
        with refusal("must be the number of a cycle"):
            branch.state(wrong)
    assert len(pickle.loads(pickle.dumps(branch))) == len(branch)


def test_a_narrow_peak_between_two_points_is_followed(monkeypatch):
    """The peak is 0.002 rad/s wide, a thousandth of a step, and the branch smooth on both sides."""
    use(monkeypatch, ResonantMap)
    for steps in (StepControl(), StepControl(step=0.002, longest=0.01)):
        branch = continue_cycle(Parameters(N=300, Omega=10), "Omega", (8.0, 16.0), steps=steps)
        assert np.sort(branch.folds[:, 0]) == pytest.approx(ResonantMap.folds(), abs=1e-8)
        height = ResonantMap.FORCE / (1 - ResonantMap.RHO)
        assert np.linalg.norm(branch.points, axis=1).max() == pytest.approx(height, rel=0.01)
        assert "12" not in branch.ended


def test_two_folds_within_a_step_are_found(monkeypatch):
    use(monkeypatch, CubicMap)
    branch = continue_cycle(Parameters(N=300, Omega=13), "Omega", (11.0, 14.0))
    apart = 2 * (CubicMap.TINY / 3) ** 1.5
    low = 12 - apart
    high = 12 + apart
    folds = np.sort(branch.folds[:, 0])
    assert folds == pytest.approx([low, high], abs=1e-9)
    assert apart == pytest.approx(2e-6)


def test_a_jump_of_the_map_ends_the_branch_and_is_not_crossed(monkeypatch):
    use(monkeypatch, BrokenMap)
    branch = continue_cycle(P.replace(Omega=14), "Omega", (12.0, 20.0), direction=1)
    # the shortest step, and a fraction of it
    assert branch.values[-1, 0] == pytest.approx(16, abs=1e-5)
    assert branch.values.max() <= 16
    assert branch.ended.startswith("no step from ")


def test_a_corner_of_the_map_is_passed_and_listed(monkeypatch):
    use(monkeypatch, CornerMap)
    branch = continue_cycle(P.replace(Omega=14), "Omega", (12.0, 20.0), direction=1)
    assert branch.ended == "the bound Omega = 20 rad/s was reached"
    drive = 0.125 * (branch.values[:, 0] - 12)
    expected = np.where(drive < 0.5, drive / 0.5, (drive - 0.2) / 0.3)
    assert branch.points[:, 0] == pytest.approx(expected, abs=1e-9)
    [grazing] = [each for each in branch.special if each.kind == "grazing"]
    assert grazing.values[0] == pytest.approx(16, abs=1e-3)  # within a step of 1e-5 of 14 rad/s


def test_where_contact_is_lost_the_branch_ends(monkeypatch):
    use(monkeypatch, RoundMap)
    monkeypatch.setattr(RoundMap, "step", FoldlessStep.step)
    branch = continue_cycle(P.replace(Omega=25), "Omega", (20.0, 40.0), direction=1)
    assert branch.values[-1, 0] == pytest.approx(30, abs=1e-5)
    assert branch.ended.endswith("the motion does not return: it loses contact")


class FoldlessStep:
    """x -> 0.5 x + 0.05 Omega, whose cycle is x = 0.1 Omega."""

    def step(self, x):
        return 0.5 * x + 0.05 * self.parameters.Omega, np.array([[0.5]]), {"Omega": 0.05}


def test_a_limit_of_the_parameter_ends_the_branch(monkeypatch):
    use(monkeypatch, FoldMap)
    branch = continue_cycle(P.replace(mu_k=0.1), "mu_k", (-0.5, 0.39), direction=-1)
    assert branch.values[-1, 0] == pytest.approx(0, abs=1e-5)
    assert "the case is not valid: mu_k=-" in branch.ended
    many = continue_cycle(P, "Omega", (3.0, 17.0), steps=StepControl(max_points=5), direction=-1)
    assert len(many) == 5
    assert many.ended == "max_points=5 were computed"
    assert many.special[-1].kind == "max_points"


@pytest.mark.parametrize(
    ("Omega", "why"),
    [
        (31, "does not return: it loses contact"),
        (0, "vanishes"),
        (-1, "Omega=-1"),
        (17, "does not converge"),  # beyond the fold there is nothing to converge to
        (1, "singular"),
    ],
)
def test_where_there_is_no_cycle_the_corrector_is_lost(Omega, why, monkeypatch):
    use(monkeypatch, FoldMap)
    problem = CycleProblem(P, ("Omega",), None, 1e-12)
    z = np.array([1.0, 0, 0, Omega / problem.scales[0]])
    start = problem.evaluate(np.array([1.0, 0, 0, 1.0]))
    rows = np.eye(4)[3:]
    with pytest.raises(Rejected, match=why):
        solve(problem, z, rows, np.vstack([start.by, rows]))


def test_arguments_are_checked(monkeypatch):
    use(monkeypatch, FoldMap)
    wrong = {"values": ["5 kg"], "stop_at": "hopf", "steps": 0.1, "direction": 2}
    with pytest.raises(ParameterError) as error:
        continue_cycle(P, "Omega", (17.0, 12.0), **wrong)
    for text in (
        "bounds=",
        "values=",
        "stop_at='hopf': must be None, or one or several of fold, ",
        "steps=",
    ):
        assert text in str(error.value)
    for values in (3.0, None, [math.nan]):
        with refusal("values="):
            continue_cycle(P, "Omega", (12.0, 17.0), values=values)


def test_the_arclength_of_a_parameter_of_zero_is_that_of_its_bounds(monkeypatch):
    use(monkeypatch, FoldMap)
    branch = continue_cycle(P.replace(c=0.0), "c", (0.0, 50.0))
    assert branch.values[[0, -1], 0].tolist() == [0, 50]
    steps = [after - before for before, after in pairwise(branch.values[:, 0])]
    assert max(steps) == pytest.approx(0.1 * 5)  # a tenth of a tenth of 50
