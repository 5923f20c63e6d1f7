"""Branches of cycles: on maps that are solved by hand, and of the slider, against `floquet`,
simulations and other steps."""

import math
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import disc_model as dm
from tests.blocks import RIG
from tests.refusals import refusal
from tests.stability.toy_maps import (
    PERIOD,
    BrokenMap,
    FoldMap,
    ResonantMap,
    RoundMap,
    cycle_at,
    fold_at,
    growth_at,
    use,
)

P = dm.Parameters(N=300, Omega=15)
SHORT = dm.StepControl(step=0.002, longest=0.01)


# ---- On maps that are solved by hand


def test_a_branch_goes_round_its_fold_to_its_bounds(monkeypatch: pytest.MonkeyPatch) -> None:
    use(monkeypatch, FoldMap)
    branch = dm.continue_cycle(P, "Omega", (12.0, 17.0))
    assert branch.ended == "bound"
    assert branch.values[[0, -1]].tolist() == [12, 12]
    upper = branch.state_a[:, 0] > 1
    assert upper[0]
    assert not upper[-1]
    for speed, x, growth, above in zip(
        branch.Omega, branch.state_a, branch.growth_rate, upper, strict=True
    ):
        if speed > 16 - 1e-6:  # at the fold both cycles are one
            continue
        assert_allclose(x, cycle_at(speed, 300, above), rtol=0, atol=1e-9)
        assert growth == pytest.approx(growth_at(speed, 300, above), abs=1e-6)
    assert np.all(branch.period == PERIOD)
    assert_allclose(branch.stick_fraction, 0.3)
    assert branch.diameters[[0, -1]].tolist() == [1, 0]
    # of the residual, 3e-11 of the deflection, over the slope of the map by the speed, 0.03
    assert_allclose(branch.folds, [fold_at(300)], rtol=0, atol=2e-9)
    table = branch.special_points
    kinds = ["end", "neimark_sacker", "fold", "neimark_sacker", "end"]
    assert table["kind"].tolist() == kinds
    assert_allclose(table["Omega"], [12, 14, 16, 14, 12], rtol=0, atol=1e-8)
    for each in table[1:-1].itertuples():
        before, here, after = branch.state_a[each.point - 1 : each.point + 2, 0]
        assert after < here == each.state.a[0] < before
    assert table["multiplier"][1] == pytest.approx(np.exp(1.2j), abs=1e-9)
    assert len(pickle.loads(pickle.dumps(branch))) == len(branch)


@pytest.mark.parametrize(
    ("options", "ended", "ends"),
    [
        ({"bounds": (12.0, 15.96), "direction": 1}, "bound", (15, 15.96)),
        ({"bounds": (12.0, 15.96), "direction": -1}, "bound", (15, 12)),
        ({"bounds": (15.0, 15.96), "direction": -1}, "bound", (15, 15)),
        ({"bounds": (12.0, 16 - 1e-5)}, "bound", (12, 16 - 1e-5)),  # just below the fold
        ({"steps": dm.StepControl(max_points=5), "direction": -1}, "max_points", None),
    ],
)
def test_a_branch_ends_where_it_is_told(
    options: dict[str, Any],
    ended: str,
    ends: tuple[float, float] | None,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    use(monkeypatch, FoldMap)
    branch = dm.continue_cycle(P, "Omega", **{"bounds": (12.0, 17.0), **options})
    assert branch.ended == ended
    if ends is None:
        assert branch.kind.tolist().count("") == 5 - 2
        assert branch.kind[-1] == "max_points"
    else:
        assert_allclose(branch.Omega[[0, -1]], ends, rtol=0, atol=1e-8)


def test_a_closed_branch_ends_where_it_began(monkeypatch: pytest.MonkeyPatch) -> None:
    use(monkeypatch, RoundMap)
    branch = dm.continue_cycle(dm.Parameters(N=300, Omega=12), "Omega", (5.0, 20.0))
    assert branch.ended == "closed"
    assert_allclose(np.sort(branch.folds), [8, 16], rtol=0, atol=1e-9)
    assert_array_equal(branch.state_a[0], branch.state_a[-1])
    assert branch.special_points["kind"].tolist() == ["fold", "fold"]
    # once round the circle, and no further
    angle = np.unwrap(np.arctan2((branch.Omega - 12) / 4, branch.state_a[:, 0] - 2))
    assert abs(angle[-1] - angle[0]) == pytest.approx(math.tau, abs=1e-6)


def test_a_narrow_peak_between_two_points_is_followed(monkeypatch: pytest.MonkeyPatch) -> None:
    """The peak is 0.002 rad/s wide, a thousandth of a step, and the branch smooth on both sides."""
    use(monkeypatch, ResonantMap)
    for steps in (dm.StepControl(), SHORT):
        branch = dm.continue_cycle(
            dm.Parameters(N=300, Omega=10), "Omega", (8.0, 16.0), steps=steps
        )
        assert_allclose(np.sort(branch.folds), ResonantMap.folds(), rtol=0, atol=1e-8)
        height = ResonantMap.FORCE / (1 - ResonantMap.RHO)
        assert np.linalg.norm(branch.state_a, axis=1).max() == pytest.approx(height, rel=0.01)


def test_a_jump_of_the_map_ends_the_branch_and_is_not_crossed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    use(monkeypatch, BrokenMap)
    branch = dm.continue_cycle(P.replace(Omega=14), "Omega", (12.0, 20.0), direction=1)
    assert branch.Omega.max() == branch.Omega[-1] == pytest.approx(16, abs=1e-5)
    assert branch.ended == branch.kind[-1] == "lost"


def test_a_limit_of_the_parameter_ends_the_branch(monkeypatch: pytest.MonkeyPatch) -> None:
    use(monkeypatch, FoldMap)
    branch = dm.continue_cycle(P.replace(mu_k=0.1), "mu_k", (-0.5, 0.39), direction=-1)
    assert branch.mu_k[-1] == pytest.approx(0, abs=1e-5)
    assert branch.ended == "limit"


# ---- Of the slider

STEEL = {
    "normalization": "orthonormal",
    "a": 0.04,
    "b": 0.15,
    "r_0": 0.13,
    "h": 0.006,
    "E": 210e9,
    "rho": 7800,
    "nu": 0.3,
    "m": 0.3,
    "k": 5e5,
    "k_p": 2e5,
    "c_p": 5,
    "mu_s": 0.45,
    "mu_k": 0.35,
    "damping_ratio": 5e-4,
}
BRANCHES = {
    "published": (dm.Parameters(N=385, Omega=14.9), (10.9, 15.2)),
    "orthonormal": (dm.Parameters(N=300, Omega=20, normalization="orthonormal"), (10, 40)),
    "steel": (dm.Parameters(N=9000, Omega=16, friction_offset="surface", **STEEL), (15, 30)),
}


@pytest.fixture(scope="module", params=BRANCHES)
def branch(request: pytest.FixtureRequest) -> dm.Branch:
    p, bounds = BRANCHES[request.param]
    return dm.continue_cycle(p, "Omega", bounds)


@pytest.mark.compiled
def test_points_are_the_cycles_of_floquet_and_repeat_in_simulation(branch: dm.Branch) -> None:
    for i in range(0, len(branch), max(1, len(branch) // 12)):
        p, state, period = branch.case_at(i), branch.state(i), branch.period[i]
        run = dm.simulate(p, period, initial_state=state, tol=1e-13)
        # the residual, some 1e-11 of the deflection, moves the period, and with it fast modes
        allowed = 1e-7 * max(1.0, abs(branch.multipliers[i, 0]))
        for name in ("a", "alpha"):
            start = getattr(state, name)
            scale = max(
                np.abs(start).max(), np.abs(getattr(state, {"a": "b", "alpha": "beta"}[name])).max()
            )
            assert np.abs(getattr(run.final_state, name) - start).max() < allowed * scale
        simple = np.abs(branch.multipliers[i, 0]) < 1.3
        if simple and np.abs(branch.multipliers[i] - 1).min() > 1e-3:
            found = dm.floquet(p, guess=state)
            # residuals of 1e-12 over the distance of a multiplier from 1, for both cycles
            assert found.period == pytest.approx(period, rel=2e-9)
            apart = np.abs(found.multipliers[:, None] - branch.multipliers[i][None, :])
            assert apart.min(axis=1).max() < 1e-6


@pytest.mark.compiled
def test_special_points_have_their_multipliers_and_their_cycles(branch: dm.Branch) -> None:
    table = branch.special_points
    for each in table[
        table["kind"].isin(["fold", "period_doubling", "neimark_sacker"])
    ].itertuples():
        assert abs(each.multiplier) == pytest.approx(1, abs=1e-6)
        case = branch.case.replace(Omega=each.Omega)
        run = dm.simulate(case, each.period, initial_state=each.state, tol=1e-13)
        assert run.final_state.u == pytest.approx(each.state.u, rel=1e-9)


@pytest.mark.compiled
def test_heights_are_those_of_simulated_periods(branch: dm.Branch) -> None:
    for i in (0, len(branch) // 2, -1):
        stop = float(branch.period[i])
        window = dm.Window(start=0.0, stop=stop, rate=1e6 / stop)
        run = dm.simulate(branch.case_at(i), stop, {"all": window}, initial_state=branch.state(i))
        # samples miss a peak by 1e-10 of the range at most, the parabola of the branch by 1e-7
        assert branch.range[i] == pytest.approx(np.ptp(run["all"]["u"].values), rel=1e-6)


GRAZED = {  # the last cycle, its way on, and the event that appears or vanishes beyond it
    "stick vanishes": (dm.Parameters(N=5139, Omega=34.65, **STEEL), 1),
    "release during stick": (dm.Parameters(N=507, Omega=12.8, normalization="orthonormal"), 1),
    "release where stick ends": (dm.Parameters(N=200, Omega=9.8), -1),
    "stop during slip": (dm.Parameters(N=253, Omega=6.16), 1),
    "contact is lost": (dm.Parameters(N=334, Omega=11.1, normalization="orthonormal"), 1),
    "stick on a rigid disc": (RIG.replace(Omega=2.2), 1),
}


@pytest.mark.compiled
@pytest.mark.parametrize("event", GRAZED)
def test_a_branch_ends_at_a_grazing(event: str) -> None:
    p, direction = GRAZED[event]
    branch = dm.continue_cycle(p, "Omega", (1, 60), direction=direction)
    assert branch.ended == branch.kind[-1] == "grazing"


@pytest.fixture(scope="module")
def separating() -> dm.State:
    """A settled motion that separates and sticks twice in a period, at 385 N and 15.1 rad/s."""
    return dm.simulate(dm.Parameters(N=385, Omega=15.1), 100).final_state


@pytest.mark.compiled
def test_a_branch_of_twice_the_period_ends_and_begins_at_the_doubling(separating: dm.State) -> None:
    case = dm.Parameters(N=385, Omega=15.1)
    double = dm.continue_cycle(case, "Omega", (9.0, 18.0), guess=separating, releases=2)
    assert double.ended == "period_doubling; grazing"
    assert not len(double.folds)
    end = double.special_points.iloc[0]
    there = case.replace(Omega=end["Omega"])
    single = dm.continue_cycle(there, "Omega", (13.0, 14.6), guess=end["state"])
    table = single.special_points
    [doubling] = table[table["kind"] == "period_doubling"].itertuples()
    # a double zero of the equations of twice the period
    assert end["Omega"] == pytest.approx(doubling.Omega, rel=1e-7)
    assert end["period"] == pytest.approx(2 * doubling.period, rel=1e-7)

    start = {"guess": doubling.state, "releases": 2}
    there = case.replace(Omega=doubling.Omega)
    again = dm.continue_cycle(there, "Omega", (14.0, 14.6), **start)
    assert again.special_points["kind"].tolist() == ["period_doubling", "end"]
    assert again.ended == "period_doubling; bound"
    # at its other end it is the branch that came to the doubling
    period = np.interp(14.6, double.Omega, double.period)
    assert again.period[-1] == pytest.approx(period, rel=1e-4)
    with refusal("releases=2: must be 1"):
        far = {"guess": single.state(0), "releases": 2}
        dm.continue_cycle(single.case_at(0), "Omega", (12, 15), **far)


@pytest.mark.compiled
def test_the_inner_radius_is_a_parameter_as_others() -> None:
    """It has the name of the coordinates of modes."""
    case = dm.Parameters(N=385, Omega=14.9)
    bounds = (case.a, 1.01 * case.a)
    branch = dm.continue_cycle(case, "a", bounds, direction=1, steps=dm.StepControl(max_points=3))
    assert branch.values[0] == case.a < branch.values[1]
    again = dm.floquet(branch.case_at(1), guess=branch.state(1))
    assert branch.period[1] == pytest.approx(again.period, rel=1e-9)


@pytest.mark.compiled
@pytest.mark.parametrize(("name", "value"), [("contact_arc", 0.1), ("damping_ratio", 1e-4)])
def test_a_branch_reaches_the_least_value_of_its_parameter(name: str, value: float) -> None:
    """Where a difference of orbits on both sides would need a value below 0."""
    case = dm.Parameters(N=385, Omega=14.9, n_diameters=1, **{name: value})
    branch = dm.continue_cycle(case, name, (0, 1.5 * value), direction=-1)
    assert branch.values[-1] == 0
    there = dm.floquet(case.replace(**{name: 0}))
    assert branch.period[-1] == pytest.approx(there.period, rel=1e-9)
    assert branch.growth_rate[-1] == pytest.approx(there.growth_rate, abs=1e-6)


# ---- As data

FOLDED = dm.Parameters(N=385, Omega=14.9)
"""On the stable half of a branch that turns back at 15.09 rad/s."""


@pytest.fixture(scope="module")
def folded() -> dm.Branch:
    return dm.continue_cycle(FOLDED, "Omega", (14.8, 15.2))


@pytest.mark.compiled
def test_a_branch_is_its_dataset(folded: dm.Branch) -> None:
    data = folded.to_dataset()
    for name in ("growth_rate", "period", "range", "separations", "stable", "state_a"):
        assert_array_equal(data[name], getattr(folded, name))
    for each in folded.special_points.itertuples():
        row = data.isel(point=each.point)
        assert (each.kind, each.u_max, each.state.u) == (row["kind"], row["u_max"], row["state_u"])
    # stable up to the fold, where the largest multiplier passes 1
    [fold] = np.flatnonzero(folded.kind == "fold")
    assert_array_equal(data["stable"][:fold], True)
    assert_array_equal(data["stable"][fold + 1 :], False)
    assert_array_equal(np.abs(folded.multipliers[:fold]) < 1, True)
    assert folded.growth_rate[fold] == 0
    assert data.ended == "bound"
    assert data["Omega"].attrs["units"] == "rad s-1"
    for name, variable in data.data_vars.items():
        assert variable.attrs["long_name"]
        assert ("units" in variable.attrs) == (name not in ("kind", "state_phase"))


@pytest.mark.compiled
@pytest.mark.parametrize("kind", ["stick_slip", "slipping"])
def test_a_stored_branch_is_a_branch_again(kind: str, folded: dm.Branch, tmp_path: Path) -> None:
    kept = folded
    if kind == "slipping":
        kept = dm.continue_cycle(RIG, "Omega", (1.8, 2.2), kind="slipping")
        assert kept.to_dataset().sizes["mode"] == 0
    dm.save(kept, tmp_path / "branch.nc")
    stored = dm.load(tmp_path / "branch.nc")
    assert stored.identical(kept.to_dataset())
    again = dm.Branch(stored)
    assert repr(again) == repr(kept)
    shown = ["kind", "growth_rate", "period", "multiplier", "point", "range"]
    assert again.special_points[shown].equals(kept.special_points[shown])
    guess = None if kind == "slipping" else again.state(-1)
    bounds = (float(again.values[-1]) - 0.5, float(again.values[-1]) + 0.5)
    onward = dm.continue_cycle(again.case_at(-1), "Omega", bounds, guess=guess, kind=kind)
    place = np.argmin(np.abs(onward.values - again.values[-1]))
    assert onward.period[place] == pytest.approx(again.period[-1], rel=1e-9)
    with refusal(r"must be a dataset of Branch\.to_dataset"):
        dm.Branch(stored.drop_vars("state_beta"))


# ---- What is refused


@pytest.mark.parametrize(
    ("changed", "told"),
    [
        ({"bounds": (17, 12)}, "bounds="),
        ({"bounds": ("2.3 Hz", 16)}, "Hz may mean turns or radians"),
        ({"bounds": (12, 14)}, "Omega=14.9: must lie within the bounds, 12 to 14"),
        ({"direction": 2}, "direction=2: must be"),
        ({"guess": 1.0}, "guess=1: must be an instance of State"),
        ({"name": "damping_ratio"}, "name='damping_ratio': does not act in this case"),
    ],
)
def test_wrong_arguments_are_refused(changed: dict[str, Any], told: str) -> None:
    asked = {"name": "Omega", "bounds": (14, 16), **changed}
    with pytest.raises(dm.ParameterError) as error:
        dm.continue_cycle(FOLDED, **asked)
    assert told in str(error.value)


@pytest.mark.compiled
def test_a_case_without_a_cycle_is_told_what_to_do() -> None:
    with refusal("^case: must have a cycle, but.*start from another value of Omega"):
        dm.continue_cycle(FOLDED.replace(Omega=15.1), "Omega", (14, 16))
