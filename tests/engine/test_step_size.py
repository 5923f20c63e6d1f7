"""The length of a step by the last terms of its series, each of them alone."""

import math
from collections.abc import Callable

import pytest

from disc_model import Parameters
from disc_model.engine import step_size
from disc_model.engine.jit.simd import WIDTH
from disc_model.engine.model import Model
from disc_model.engine.series import Series, build_series, displacement_at
from disc_model.engine.state import SEPARATION, SLIP, STICK
from disc_model.simulation.states import engine_case
from tests.engine.test_state import in_python

ORDER = 20
TOLERANCE = 1e-13
SMALL = 1e-16
"""Of a last term, over what it is compared with: the step is then about 1.4 units of time."""
ROOT = 0.01
"""The root of the engine is right to 0.8 %, a factor of two in an error is 3.5 %."""
LAST_OF_FORCE = SMALL * step_size.TYPICAL_STEP
"""The force is known to an order less than the rest."""

P = Parameters(N=200, Omega=10)
COMPLIANT = P.replace(contact_compliance=1e-7)
FALLING = P.replace(friction_law="exponential", friction_decay=2.0)


def at_rest(p: Parameters) -> tuple[Model, Series]:
    """A case, and a series whose coefficients are zero but for drive and load."""
    model = engine_case(p).model
    series = build_series(model, ORDER)
    series.drive[0] = p.Omega
    series.preload[0] = p.N - model.k * model.u_0
    return model, series


def length(model: Model, series: Series, phase: float = SLIP, tolerance: float = TOLERANCE):
    return step_size.step_size(model, series, ORDER, tolerance, float(phase))


def wanted(*errors: float) -> float:
    """The step at which these relative last terms, as if of the full order, meet the tolerance."""
    return (TOLERANCE / sum(errors)) ** (1 / ORDER)


def expect(found: float, *errors: float) -> None:
    """Compare a step with that which these relative last terms allow."""
    assert found == pytest.approx(wanted(*errors), rel=ROOT)


def put_pairs(series: Series, k: int, value: float) -> None:
    """Set the velocities of a block of pairs, of order k."""
    start = in_python(displacement_at)(k, 0) + WIDTH
    series.modes[start : start + WIDTH] = value


def test_nothing_that_changes_allows_the_longest_step() -> None:
    assert length(*at_rest(P)) == step_size.LONGEST_STEP


@pytest.mark.parametrize("k", [ORDER, ORDER - 1])
def test_modal_velocities_are_compared_with_those_of_static_deflection(k: int) -> None:
    model, series = at_rest(P)
    last = SMALL * model.velocity_scale * step_size.TYPICAL_STEP ** (ORDER - k)
    series.g[k] = -last
    found = length(model, series)
    expect(found, SMALL)
    series.g[0] = 100 * model.velocity_scale
    found = length(model, series)
    expect(found, SMALL / 100)


@pytest.mark.parametrize("k", [ORDER, ORDER - 1])
def test_slip_is_compared_with_the_drive_or_with_itself(k: int) -> None:
    model, series = at_rest(P)
    series.f[k] = SMALL * P.Omega * step_size.TYPICAL_STEP ** (ORDER - k)
    found = length(model, series)
    expect(found, SMALL)
    series.f[0] = -50 * P.Omega
    found = length(model, series)
    expect(found, SMALL / 50)


@pytest.mark.parametrize("k", [ORDER - 1, ORDER - 2])
def test_the_force_is_compared_with_the_preload_but_in_separation(k: int) -> None:
    model, series = at_rest(P)
    series.P[k] = SMALL * P.N * step_size.TYPICAL_STEP ** (ORDER - k)
    for phase in (SLIP, STICK):
        found = length(model, series, phase)
        expect(found, SMALL)
    assert length(model, series, SEPARATION) == step_size.LONGEST_STEP


@pytest.mark.parametrize(("p", "phase"), [(P, SEPARATION), (COMPLIANT, SLIP)])
def test_the_slider_counts_where_the_disc_does_not_carry_it(p: Parameters, phase: int) -> None:
    model, series = at_rest(p)
    series.v[ORDER] = SMALL * model.slider_scale
    found = length(model, series, phase)
    expect(found, SMALL)


def test_the_slider_on_a_rigid_disc_does_not_count() -> None:
    model, series = at_rest(P)
    series.v[ORDER] = SMALL * model.slider_scale
    assert length(model, series) == step_size.LONGEST_STEP


def test_a_step_out_of_compliant_contact_is_measured_by_its_own_motion() -> None:
    model, series = at_rest(COMPLIANT)
    assert length(model, series, SEPARATION) == pytest.approx(
        step_size.LONGEST_STEP * model.free_unit
    )
    last = SMALL * model.slider_scale
    series.v[ORDER - 1] = last * step_size.TYPICAL_STEP * model.free_unit
    found = length(model, series, SEPARATION)
    expect(found, SMALL)


def test_errors_add_up() -> None:
    model, series = at_rest(P)
    put_pairs(series, ORDER, SMALL * model.velocity_scale)
    series.f[ORDER] = 2 * SMALL * P.Omega
    series.P[ORDER - 1] = 4 * LAST_OF_FORCE * P.N
    found = length(model, series)
    expect(found, SMALL, 2 * SMALL, 4 * SMALL)
    series.v[ORDER] = 8 * SMALL * model.slider_scale
    four = wanted(SMALL, 2 * SMALL, 8 * SMALL)
    assert length(model, series, SEPARATION) == pytest.approx(four, rel=ROOT)


def too_large_pairs(series: Series) -> None:
    put_pairs(series, 0, math.inf)


def too_large_slip(series: Series) -> None:
    series.f[0] = -math.inf


def too_large_term(series: Series) -> None:
    series.f[ORDER] = math.inf


@pytest.mark.parametrize("spoil", [too_large_pairs, too_large_slip, too_large_term])
def test_a_number_that_overflows_leaves_no_step(spoil: Callable[[Series], None]) -> None:
    model, series = at_rest(P)
    spoil(series)
    assert math.isnan(length(model, series))


def test_the_longest_step_holds_where_the_terms_allow_more() -> None:
    model, series = at_rest(P)
    just = TOLERANCE / step_size.LONGEST_STEP**ORDER
    series.f[ORDER] = 0.5 * just * P.Omega
    assert length(model, series) == step_size.LONGEST_STEP
    series.f[ORDER] = 2.0 * just * P.Omega
    found = length(model, series)
    expect(found, 2.0 * just)


def test_without_drive_a_start_is_compared_with_its_growth() -> None:
    model, series = at_rest(P.replace(Omega=0.0))
    series.f[1] = 3.0
    series.f[ORDER] = 3.0 * SMALL
    found = length(model, series)
    expect(found, SMALL)


def test_without_anything_to_compare_with_a_term_is_its_own_error() -> None:
    model, series = at_rest(P.replace(Omega=0.0))
    series.f[ORDER] = SMALL
    found = length(model, series)
    expect(found, SMALL)


@pytest.mark.parametrize("order", [14, 20, 28])
@pytest.mark.parametrize("ratio", [1e-30, 3.7e-4, 1.0, 2.9, 1e17])
def test_the_root_is_right_to_a_percent(ratio: float, order: int) -> None:
    root = in_python(step_size._root)(ratio, order)
    assert root == pytest.approx(ratio ** (1 / order), rel=0.0085)


# ------------------------------------------------------------------------ falling friction
def test_slow_slip_counts_ten_times_by_its_own_speed_where_friction_falls() -> None:
    """It grows by itself, on the scale of the fall: 1 / (r_0 friction_decay)."""
    model, series = at_rest(FALLING)
    slow = 1.0 / model.decay
    series.f[0] = 0.5 * slow
    series.f[ORDER] = SMALL * 1.5 * slow
    found = length(model, series)
    expect(found, 10.0 * SMALL)
    relative = SMALL * 1.5 * slow / P.Omega
    found = length(model, series, STICK)
    expect(found, relative)
    # not slower than usual
    series.f[0] = P.Omega
    series.f[ORDER] = SMALL * P.Omega
    found = length(model, series)
    expect(found, 10.0 * SMALL)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_step_of_fallen_friction_ends_before_half_of_the_speed_is_lost(sense: float) -> None:
    """The loss counts terms that slow down alone, at the end of the step."""
    model, series = at_rest(FALLING)
    speed = 2.0 * step_size.FALLEN / model.decay
    series.f[0] = sense * speed
    series.f[1] = -sense * speed / 4.0
    series.f[2] = sense * speed
    half = length(model, series)
    assert half == pytest.approx(step_size.LONGEST_STEP * 0.75**5)
    assert 0.75 * 2.0 < half <= 2.0
    # slow slip, of which friction has not fallen
    series.f[0] /= 4.0
    assert length(model, series) == step_size.LONGEST_STEP
    assert length(model, series, STICK) == step_size.LONGEST_STEP


def test_release_functions_count_in_stick_under_the_normal_force() -> None:
    model, series = at_rest(P.replace(contact_force="normal"))
    for function in (series.switch, series.switch2):
        function[ORDER - 1] = LAST_OF_FORCE * P.N
        found = length(model, series, STICK)
        expect(found, SMALL)
        assert length(model, series, SLIP) == step_size.LONGEST_STEP
        function[ORDER - 1] = 0.0
