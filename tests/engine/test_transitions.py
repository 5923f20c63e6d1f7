"""The impact under the normal force, and how phases begin: laws that compiled runs show only in
long tests."""

import numpy as np
import pytest

from disc_model import Parameters, simulate
from disc_model.engine import transitions
from disc_model.engine.laws import Instant, impact
from disc_model.engine.model import build_state
from disc_model.engine.state import SLIP, known_roots, phase_of
from disc_model.simulation.states import engine_case, static_start, write_state
from tests.contact_laws import COMPILES


def test_an_impact_pushes_along_the_normal_of_the_slope_and_leaves_no_gap() -> None:
    model = engine_case(
        Parameters(N=200, Omega=20, contact_force="normal", friction_offset=0.02)
    ).model
    assert model.surface_inverse_mass > 1.0
    i = Instant(
        *[1.0] * 8,
        psi=0.0,
        g=4.0,
        w=0.0,
        w_velocity=0.7,
        dw_dtheta=0.02,
        free=0.0,
        surface_velocity=0.3,
        surface_free=0.0,
        u=0.0,
        u_velocity=-0.3,
    )
    i = i._replace(m=0.1)
    p, g = impact(model, i)
    # a height of w rises by B per radian: the tangential part of the impulse, p B / r_0, brakes the
    # slider and pushes the surface
    along = p * i.dw_dtheta / model.r_0
    change = -along / (i.m * model.r_0) - along * model.surface_inverse_mass / model.r_0
    assert g - i.g == pytest.approx(change, rel=1e-14)
    w_velocity = i.w_velocity - model.inverse_effective_mass * p + i.dw_dtheta * change
    assert i.u_velocity + p / i.m == pytest.approx(w_velocity, rel=1e-14)


@pytest.mark.parametrize(("share", "known"), [(1.0, 2), (1.01, 1)])
def test_the_root_of_f_where_slip_begins_is_double_if_nothing_accelerates_it(
    share: float, known: int
) -> None:
    p = Parameters(N=200, Omega=10)
    case = engine_case(p)
    state = build_state(case.model)
    # at rest under N, pulled by as much as kinetic friction, or a bit more
    write_state(case, static_start(p).replace(psi=share * p.mu_k * p.N / (p.r_0 * p.k_p)), state)
    transitions.enter_slip(case.model, state, 1.0)
    assert phase_of(state) == SLIP
    assert known_roots(state)[0] == known


@pytest.mark.parametrize("psi", [pytest.param(psi, marks=COMPILES) for psi in (0.02, -0.02)])
def test_a_slider_that_touches_down_without_speed_slips_to_the_side_of_its_spring(
    psi: float,
) -> None:
    p = Parameters(N=200, Omega=10, n_diameters=1, contact_compliance=1e-7)
    start = static_start(p)
    w = p.N * 1e-7 + start.u  # the slider is N C below the disc at rest
    falling = start.replace(
        phase="separation", direction=0, psi=psi, u=w, u_velocity=-0.2, f=0.0, _roots=(0, 0)
    )
    result = simulate(p, 2e-5, initial_state=falling)
    # the contact force is still too small to stop it
    assert list(result.events.kind) == ["reattachment"]
    assert np.sign(result.final_state.f) == np.sign(psi)


@pytest.mark.parametrize("sense", [pytest.param(sense, marks=COMPILES) for sense in (1, -1)])
def test_a_slider_that_touches_down_slips_on_against_its_spring(sense: int) -> None:
    """With the sign of f, of which the spring alone takes k_p psi t / m = 0.08 rad/s."""
    p = Parameters(N=200, Omega=10, n_diameters=1, contact_compliance=1e-7)
    start = static_start(p)
    falling = start.replace(
        phase="separation",
        direction=0,
        psi=-0.02 * sense,
        u=p.N * 1e-7 + start.u,
        u_velocity=-0.2,
        f=5.0 * sense,
        _roots=(0, 0),
    )
    end = simulate(p, 2e-5, initial_state=falling).final_state
    assert end.direction == sense
    assert end.f == pytest.approx(4.91 * sense, abs=0.02)


# ------------------------------------------------------------------------ errors where a phase begins
TOLERANCE = 1e-3
"""Of the series: so large that rounding is nothing beside it."""


@pytest.mark.parametrize("give", [0.0, 1e-6])
def test_an_error_of_the_force_opens_a_gap_by_compliance_or_by_acceleration(give: float) -> None:
    """The coefficients of order 0 to 2 of the gap, in time units."""
    p = Parameters(N=200, Omega=10, contact_compliance=give)
    model = engine_case(p).model
    state = build_state(model)
    force = TOLERANCE * p.N
    wanted = [force * give, 0.0, 0.0]
    if not give:
        wanted[2] = model.unit**2 / 2 * force * (1 / p.m + model.inverse_effective_mass)
    own = [transitions.gap_error(model, state, order, TOLERANCE) for order in range(3)]
    # 1e-13 of the disc's deflection of some millimetres counts as rounding
    assert own == pytest.approx(wanted, rel=1e-6, abs=1e-14)
    if give:
        assert transitions.force_error(model, state, TOLERANCE) == pytest.approx(force, rel=1e-6)


def test_errors_of_pull_and_force_accelerate_slip_that_has_just_begun() -> None:
    p = Parameters(N=200, Omega=10, c_p=0.5)
    case = engine_case(p)
    state = build_state(case.model)
    psi = 1.01 * p.mu_s * p.N / (p.r_0 * p.k_p)
    write_state(case, static_start(p).replace(psi=psi), state)
    transitions.enter_slip(case.model, state, 1.0)
    pull = p.k_p * psi + p.c_p * p.Omega
    wanted = TOLERANCE * case.model.unit / p.m * (pull + p.mu_k * p.N / p.r_0)
    assert transitions.slip_error(case.model, state, TOLERANCE) == pytest.approx(wanted, rel=1e-6)


def test_rounding_of_the_pull_on_a_moving_surface_is_that_of_its_modes() -> None:
    """Two modes that accelerate the surface against each other, by far more than the spring."""
    p = Parameters(N=200, Omega=10, friction_offset=0.02)
    model = engine_case(p).model
    state = build_state(model)
    acceleration = 1e9  # m/s^2 of each
    lanes = np.flatnonzero(model.tangential)[:2]
    state.z[lanes] = [1.0, -1.0] * (acceleration / (model.tangential * model.stiffness)[lanes])
    pulled = transitions.slip_error(model, state, 0.0)
    rounding = transitions.ROUNDING * 2 * acceleration / p.r_0
    assert pulled > model.unit * rounding
