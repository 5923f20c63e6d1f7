"""The return map: its section, its derivatives, Newton on it."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from disc_model import Parameters, simulate
from disc_model.stability.cycle import bifurcation_type, cycle_of
from disc_model.stability.return_map import PARAMETERS, RETURNED, Counts, Flight, ReturnMap, newton
from tests.contact_laws import COMPILES, LAWS
from tests.engine.test_variational import differences
from tests.references.printed import Printed

P = Parameters(N=200, Omega=20, n_diameters=1)
BASE = Parameters(N=200, Omega=20)
DAMPED = Parameters(N=200, Omega=20, c=0.05, c_p=0.02)


def central_differences(
    map_: ReturnMap, x: np.ndarray, h: float | None = None, **how
) -> np.ndarray:
    """Jacobian of the map by central differences of fourth order."""
    h = 3e-5 * np.linalg.norm(x) if h is None else h
    units = np.eye(map_.size)
    columns = [
        differences(lambda s, e=e: map_.evaluate(x + s * e, tangent=False, **how).end, h)
        for e in units
    ]
    return np.array(columns).T


def after_separation(p: Parameters, t_end: float) -> tuple[ReturnMap, np.ndarray]:
    """A point of the section on the motion after contact was first lost."""
    late = simulate(p, t_end).final_state
    map_ = ReturnMap(p)
    outcome, x = map_.next_release(late)
    assert outcome == RETURNED
    return map_, x


class Affine:
    """A return map x -> A x + d with a fixed point, which may fail to return at chosen calls."""

    def __init__(self, A, d, wrong=None, lost_at=()):
        self.A, self.d, self.size = np.asarray(A, float), np.asarray(d, float), len(d)
        self.deflection, self.tol, self.lost_at, self.calls = (
            math.sqrt(self.size),
            1e-12,
            lost_at,
            0,
        )
        self.wrong = self.A if wrong is None else np.asarray(wrong, float)

    def evaluate(self, x, **how):
        self.calls += 1
        code = RETURNED if self.calls not in self.lost_at else RETURNED + 1
        bent, slope = self.A @ x + self.d + 0.01 * np.sin(x), self.wrong + 0.01 * np.diag(np.cos(x))
        return Flight(
            code, 1.0, 0.3, Counts(1, 0, 0, 0, 1), x, bent, slope, np.zeros((self.size, 0))
        )


def test_newton_finds_the_fixed_point():
    map_ = Affine([[0.3, 0.2], [-0.4, 0.1]], [1.0, 2.0])
    found = newton(map_, np.zeros(2))
    assert found is not None
    np.testing.assert_allclose(map_.evaluate(found.start).end, found.start, rtol=1e-12)
    assert found.residual < 1e-11


@pytest.mark.parametrize(
    "map_",
    [
        Affine(np.eye(2), [1.0, 2.0]),  # no fixed point nearby, and a singular matrix on the way
        Affine([[0.3, 0.2], [-0.4, 0.1]], [1.0, 2.0], lost_at=(1,)),
        Affine(
            [[0.3, 0.2], [-0.4, 0.1]],
            [1.0, 2.0],
            wrong=[[9.0, 0.0], [0.0, -9.0]],
            lost_at=range(2, 99),
        ),
        Affine([[0.3, 0.2], [-0.4, 0.1]], [np.nan, 2.0]),
    ],
    ids=["singular", "lost at once", "lost on the way", "not finite"],
)
def test_newton_says_that_it_found_none(map_):
    assert newton(map_, np.zeros(2)) is None


def test_the_section_is_where_stick_is_released():
    """At a point of the section friction is at its limit."""
    map_ = ReturnMap(P.replace(c=0.3, c_p=0.1))
    p = map_.parameters
    x = map_.static * 1.1 + 0.01 * np.arange(6)
    state = map_.state(x)
    assert state.phase == "stick"
    force = Printed(p, state).force()
    assert p.r_0 * (p.k_p * state.psi + p.c_p * p.Omega) == pytest.approx(p.mu_s * force, rel=1e-12)
    events = simulate(p, 1e-6, initial_state=state.replace(psi=state.psi * (1 - 1e-9))).events
    assert events["kind"][0] == "stick_to_slip"


@pytest.mark.compiled
@pytest.mark.parametrize("stiff", [{"k": 1e8}, {"k": 1e9, "m": 1.0}])
def test_columns_of_stiff_springs_took_steps_too_long_for_them(stiff):
    """At k = 1e9 N/m a stable cycle grew by 0.8/s: steps followed the disc's frequencies and the
    motion alone."""
    map_ = ReturnMap(P.replace(Omega=5, **stiff))
    (x,) = map_.returns(map_.static, 1)
    jacobian = map_.evaluate(x).jacobian
    # differences over 1e-7 of the state are known to 5e-4; the columns were wrong by 0.02 and 7
    expected = central_differences(map_, x, 1e-7 * np.linalg.norm(x))
    np.testing.assert_allclose(jacobian, expected, rtol=0, atol=2e-3)


def test_the_jacobian_agrees_with_differences_along_a_direction() -> None:
    """Quick enough without compilation, unlike a whole Jacobian by differences."""
    map_ = ReturnMap(P)
    x = map_.static
    along = np.linalg.norm(x) * np.cos(np.arange(map_.size))
    expected = differences(lambda s: map_.evaluate(x + s * along, tangent=False).end, 1e-3)
    # 4e-11, whatever the step between 3e-5 and 3e-3
    assert np.linalg.norm(map_.evaluate(x).jacobian @ along - expected) < 1e-9 * np.linalg.norm(
        expected
    )


def check_derivatives(
    map_: ReturnMap, x: np.ndarray, step: Callable[[str], float], names=PARAMETERS
) -> None:
    """Derivatives of where a flight ends by parameters, against differences of steps relative to
    their values."""
    p, how = map_.parameters, {"may_separate": True}
    by = ReturnMap(p, parameters=names).evaluate(x, **how).by
    for i, name in enumerate(names):
        value = getattr(p, name)

        def end(change: float, name: str = name, value: float = value) -> np.ndarray:
            other = ReturnMap(p.replace(**{name: value + change}))
            # the same displacements and velocities, whatever the frequencies
            reached = other.evaluate(x / map_.scale * other.scale, tangent=False, **how).end
            return reached / other.scale * map_.scale

        expected = differences(end, step(name) * value)
        assert np.linalg.norm(by[:, i] - expected) < 1e-5 * np.linalg.norm(expected), name


@pytest.mark.parametrize("where", ["cycle", pytest.param("separation", marks=pytest.mark.compiled)])
def test_derivatives_by_parameters_agree_with_central_differences(where):
    if where == "cycle":
        map_ = ReturnMap(DAMPED)
        x = map_.static
    else:
        map_, x = after_separation(Parameters(N=385, Omega=15.1, c=0.01, c_p=0.01), 60.0)
    check_derivatives(map_, x, lambda name: 1e-2 if name in ("c", "c_p") else 1e-4)


def test_the_derivative_by_E_of_a_plate_with_a_damping_ratio() -> None:
    """Its damping rises with the root of E, and that of a plate with D_star not at all."""
    map_ = ReturnMap(P.replace(damping_ratio=0.05))
    check_derivatives(map_, map_.static, lambda name: 1e-4, ("E", "N"))


def test_a_multiplier_tells_the_bifurcation() -> None:
    kinds = [bifurcation_type(mu) for mu in (1.1 + 0j, -1.1 + 0j, 0.8 + 0.8j)]
    assert kinds == ["fold", "period_doubling", "neimark_sacker"]


@pytest.mark.parametrize(("multiplier", "rate"), [(0.0, -math.inf), (-2.0, math.log(2))])
def test_the_leading_multiplier_gives_the_growth_rate(multiplier, rate) -> None:
    """A return map without slope forgets its start at once."""
    map_ = ReturnMap(P)
    flight = replace(map_.evaluate(map_.static), jacobian=multiplier * np.eye(map_.size))
    assert cycle_of(map_, flight).growth_rate * flight.period == pytest.approx(
        rate
    )  # rounding is 1e-15


OTHER_LAWS = {name: LAWS[name] for name in ("compliant", "normal")} | {
    "residual": {"contact_compliance": "residual"}
}


@pytest.mark.parametrize("law", [pytest.param(law, marks=COMPILES) for law in OTHER_LAWS])
def test_derivatives_by_parameters_under_other_laws_of_contact(law):
    """E softens the disc and the residual flexibility with it, but not a compliance that is
    given."""
    map_ = ReturnMap(DAMPED.replace(n_diameters=1, **OTHER_LAWS[law]))
    x = map_.static.copy()
    if law == "normal":  # the disc slopes where stick is released
        shift = map_.model.shift[map_.model.shift != 0]
        x[: len(shift)][shift < 0] = 0.1 * np.max(np.abs(x))
    assert map_.evaluate(x, tangent=False).returned
    check_derivatives(map_, x, lambda name: 1e-2 if name in ("c", "c_p", "D_star") else 1e-6)
