"""Seeds of curves of stability, and places on them."""

from types import SimpleNamespace

import numpy as np
import pytest

from disc_model import Parameters
from disc_model.analysis.spectra import Resonance
from disc_model.errors import ParameterError
from disc_model.stability import curves
from disc_model.stability.return_map import ReturnMap
from tests.refusals import refusal
from tests.stability.continuation.test_cycles import STEEL_ALONE


@pytest.mark.compiled
def test_a_seed_met_on_the_way_to_another_modulus_is_a_cycle_there():
    """E scales the coordinates of the section."""
    seed = curves._border(Parameters(N=385, Omega=15), "E", 1.4e11, 1e-12, [])
    assert seed is not None
    assert seed.kind == "fold"
    # twice the stick-slip rate meets the mode's frequency, sqrt(E), at Omega = 15.0949 for 150 GPa
    assert pytest.approx(149.42e9, rel=1e-4) == seed.case.E
    map_ = ReturnMap(seed.case)
    # rounding, and what a corrector leaves; with the coordinates of 150 GPa it is 1e-4
    assert map_.evaluate(seed.point).residual < 1e-9 * map_.deflection


@pytest.mark.parametrize(("rates", "place"), [([0.1, 0.2, 0.1, -0.1], 2), ([0.1] * 4, 0)])
def test_a_seed_is_the_first_special_point_beside_a_stable_cycle(
    rates: list[float], place: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whether that is stable before it or after it; without one, the first of all."""
    special = [
        SimpleNamespace(
            kind="neimark_sacker", after=after, case=after, point=None, multiplier=1j, period=0.01
        )
        for after in (0, 2)
    ]
    growth_rate = np.array(rates)
    stable = growth_rate < 0
    branch = SimpleNamespace(special=special, growth_rate=growth_rate, stable=stable, ended="")
    monkeypatch.setattr(curves, "continue_cycle", lambda *_, **__: branch)
    seed = curves._border(Parameters(N=385, Omega=15), "Omega", 20.0, 1e-12, [])
    assert seed is not None
    assert seed.case == place


@pytest.mark.compiled
def test_a_fold_is_followed_across_its_line():
    """The gradient at the former place leads the corrector astray here, unless each step corrects
    it."""
    bounds = {"Omega": (9.5, 11.0), "N": (350.0, 400.0)}
    found = curves.neutral_curves(Parameters(N=375, Omega=10), bounds, [375.0], points=2)
    assert found.failures == ()
    fold = next(curve for curve in found if curve.kind == "fold")
    assert fold.values[:, 1].min() < 375 < fold.values[:, 1].max()
    assert len(fold.values) < 30  # short steps are a sign of a corrector that fails


@pytest.mark.parametrize(
    ("point", "span", "distance", "period"),
    [
        ((0.25, 0.1), (1.0, 1.0), 0.1, 1.25),
        ((0.75, 0.1), (1.0, 2.0), 0.05, 1.75),
        ((-2.0, 0.0), (4.0, 1.0), 0.5, 1.0),
        ((1.1, 1.5), (1.0, 1.0), 0.1, 4.0),
        ((1.0, 3.0), (1.0, 1.0), 1.0, 5.0),
    ],
)
def test_the_nearest_place_on_a_curve_lies_between_its_points(
    point: tuple[float, float], span: tuple[float, float], distance: float, period: float
) -> None:
    """From (0, 0) to (1, 0), where a point stands twice, and up to (1, 2)."""
    curve = curves.StabilityCurve(
        kind="neutral",
        values=np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [1.0, 2.0]]),
        adjoins_stable_cycle=np.ones(4, bool),
        period=np.array([1.0, 2.0, 1.0, 5.0]),
        multipliers=np.ones(4, complex),
        resonance=Resonance(1.0, 100.0, 0, 0, 0.0),
    )
    found, period_there = curves._nearest_on(curve, np.array(point), np.array(span))
    assert found == pytest.approx(distance, rel=1e-12)
    assert period_there == pytest.approx(period, rel=1e-12)


@pytest.mark.compiled
@pytest.mark.parametrize("points", [5, 31])
def test_a_fold_is_found_whatever_the_points_of_a_line(points: int) -> None:
    """With 17 points and more there was no curve, and nothing told of it."""
    plane = {"Omega": (14, 15.5), "N": (380, 390)}
    found = curves.neutral_curves(Parameters(N=385, Omega=15), plane, [385], points=points)
    [fold] = found
    assert fold.kind == "fold"
    at_line = np.interp(385, fold.values[:, 1], fold.values[:, 0])
    assert at_line == pytest.approx(15.0949, abs=1e-3)  # by `critical`; the curve is straight here
    assert not found.failures


@pytest.mark.compiled
def test_the_fold_of_a_stable_cycle_beyond_a_point_without_one_is_found() -> None:
    """At 26,850 N/m the search from the static start finds no cycle, and at 26,860 N/m the unstable
    one: only the fold of another unstable cycle was found."""
    plane = {"k_p": (26700, 26900), "N": (298, 302)}
    case = Parameters(N=300, Omega=14)
    found = curves.neutral_curves(case, plane, [300], points=21, max_points=20)
    [fold] = [curve for curve in found if curve.adjoins_stable_cycle.all()]
    # that of the branch, by `continue_cycle`; the curve's points lie some 2 N/m apart
    at_line = np.interp(300, fold.values[:, 1], fold.values[:, 0])
    assert at_line == pytest.approx(26861.8806, abs=0.1)


@pytest.mark.compiled
def test_a_branch_that_ends_elsewhere_is_told() -> None:
    failures: list[str] = []
    assert curves._border(STEEL_ALONE, "Omega", 60.0, 1e-12, failures) is None
    ended = "Omega from 34.65 to 60: stick vanishes: the cycle touches zero slip speed"
    assert failures == [ended]


def test_lines_lie_within_the_bounds() -> None:
    plane = {"Omega": (14, 15), "mu_s": (0.38, 0.42)}
    with refusal(r"lines=\[0.5\]: must lie within the bounds of mu_s"):
        curves.neutral_curves(Parameters(N=385, Omega=15), plane, [0.4, 0.5])


def refuse(*_args: object, **_named: object) -> None:
    """In place of a continuation that does not succeed."""
    raise ParameterError("no cycle there")


def test_a_curve_that_cannot_be_followed_is_told_with_both_its_values(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(curves, "continue_border", refuse)
    plane = {"Omega": (10.0, 20.0), "N": (100.0, 400.0)}
    case = Parameters(N=300, Omega=15)
    search = curves._CurveSearch(case, plane, 1e-12, curves.BORDER)
    seed = SimpleNamespace(kind="fold", case=case, period=0.01, point=None, mu=1.0)
    search._follow(seed)
    assert search.failures == ["fold near Omega=15, N=300: no cycle there"]


def test_a_point_of_a_line_without_a_branch_is_told_with_its_value(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(curves, "continue_cycle", refuse)
    case = Parameters(N=300, Omega=15)
    failures: list[str] = []
    seed = curves._border(case, "Omega", 16.0, 1e-12, failures)
    assert seed is None
    assert failures == ["Omega=15: no cycle there"]


@pytest.mark.parametrize("bounds", [{"Omega": (16, 15), "N": (1, 2)}, {"Omega": (15, 16)}])
def test_bounds_of_a_plane_are_two_ascending_ones(bounds: dict[str, tuple[float, float]]) -> None:
    case = Parameters(N=300, Omega=15)
    rule = "must be two ascending finite numbers, by the names of two parameters"
    with refusal(f"^bounds=.*: {rule}$"):
        curves.neutral_curves(case, bounds, [1.5])
