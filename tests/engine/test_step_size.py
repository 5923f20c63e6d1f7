"""The length of a step by the last terms of its series, each of them alone."""

import math

import numpy as np
import pytest

from disc_model import Parameters
from disc_model.engine import step_size
from disc_model.engine.model import Model
from disc_model.engine.series import Series, build_series, velocity_at
from disc_model.engine.state import SEPARATION, SLIP, STICK, WIDTH
from disc_model.simulation.states import engine_case

ORDER = 20
TOLERANCE = 1e-13
SMALL = 1e-16
"""Of a last term, over what it is compared with: the step is then about 1.4 units of time."""
ROOT = 0.01
"""The root of the engine is right to 0.8 %, a factor of two in an error is 3.5 %."""
LONGEST = step_size.LONGEST_STEP

P = Parameters(N=200, Omega=10)
COMPLIANT = P.replace(contact_compliance=1e-7)
NORMAL = P.replace(contact_force="normal")
FALLING = P.replace(friction_law="exponential", friction_decay=2.0)
RESTING = P.replace(Omega=0)
ORDERS_LESS = {"P": 1, "switch": 1, "switch2": 1}
"""To which series of forces are known."""


def at_rest(p: Parameters) -> tuple[Model, Series]:
    """Return a case, and a series whose coefficients are zero but for drive and load."""
    model = engine_case(p).model
    series = build_series(model, ORDER)
    series.drive[0] = p.Omega
    series.preload[0] = p.N - model.k * model.u_0
    return model, series


def scale_of(model: Model, name: str) -> float:
    """Return what a series is compared with at rest: static deflection, drive or preload."""
    modal = model.velocity_scale
    scales = {"pairs": modal, "g": modal, "v": model.slider_scale, "f": P.Omega}
    return scales.get(name, P.N)


def coefficient(series: Series, name: str, k: int) -> np.ndarray:
    """Return the place of a coefficient; of pairs of modes, a whole block."""
    if name == "pairs":
        place = velocity_at(k, 0)
        return series.modes[place : place + WIDTH]
    return getattr(series, name)[k : k + 1]


def put(model: Model, series: Series, name: str, relative: float, before: int = 0) -> None:
    """Set a series' last term, or one before, to as much as counts like this over its scale."""
    k = ORDER - ORDERS_LESS.get(name, 0) - before
    unit = scale_of(model, name) * step_size.TYPICAL_STEP ** (ORDER - k)
    coefficient(series, name, k)[:] = relative * unit


def length(model: Model, series: Series, phase: float = SLIP) -> float:
    return step_size.step_size(model, series, ORDER, TOLERANCE, float(phase))


def allowed(error: float) -> object:
    """Return the step at which such an error, as if of the full order, meets the tolerance."""
    if error == 0:
        return LONGEST
    return pytest.approx((TOLERANCE / error) ** (1 / ORDER), rel=ROOT)


@pytest.mark.parametrize("before", [0, 1])
@pytest.mark.parametrize(
    ("name", "p", "phase", "start", "counts"),
    [
        ("pairs", P, SLIP, 0, 1),
        ("g", P, SLIP, 0, 1),
        ("g", P, SLIP, 100, 0.01),
        ("f", P, SLIP, 0, 1),
        ("f", P, SLIP, -50, 0.02),
        ("f", FALLING, SLIP, 1, 10),
        ("f", RESTING, SLIP, 0, P.Omega),  # nothing to compare with
        ("P", P, SLIP, 0, 1),
        ("P", P, STICK, 0, 1),
        ("P", P, SEPARATION, 0, 0),
        ("v", P, SLIP, 0, 0),
        ("v", P, SEPARATION, 0, 1),
        ("v", COMPLIANT, SLIP, 0, 1),
        ("switch", NORMAL, STICK, 0, 1),
        ("switch2", NORMAL, STICK, 0, 1),
        ("switch2", NORMAL, SLIP, 0, 0),
    ],
)
def test_a_last_term_is_compared_with_its_scale_or_the_present_size(
    name: str, p: Parameters, phase: int, start: float, counts: float, before: int
) -> None:
    model, series = at_rest(p)
    coefficient(series, name, 0)[:] = start * scale_of(model, name)
    put(model, series, name, SMALL, before)
    assert length(model, series, phase) == allowed(counts * SMALL)


def test_errors_add_up() -> None:
    model, series = at_rest(P)
    for relative, name in ((1, "g"), (2, "f"), (4, "P"), (8, "v")):
        put(model, series, name, relative * SMALL)
    assert length(model, series) == allowed(7 * SMALL)
    assert length(model, series, SEPARATION) == allowed(11 * SMALL)


@pytest.mark.parametrize(("name", "k"), [("pairs", 0), ("f", 0), ("f", ORDER)])
def test_a_number_that_overflows_leaves_no_step(name: str, k: int) -> None:
    model, series = at_rest(P)
    coefficient(series, name, k)[:] = -math.inf
    assert math.isnan(length(model, series))


@pytest.mark.parametrize(("share", "longest"), [(0.5, True), (2.0, False)])
def test_the_longest_step_holds_where_the_terms_allow_more(share: float, longest: bool) -> None:
    model, series = at_rest(P)
    error = share * TOLERANCE / LONGEST**ORDER
    put(model, series, "f", error)
    assert length(model, series) == allowed(0 if longest else error)


def test_a_step_out_of_compliant_contact_is_measured_by_its_own_motion() -> None:
    model, series = at_rest(COMPLIANT)
    assert length(model, series, SEPARATION) == pytest.approx(LONGEST * model.free_unit)


def test_without_drive_a_start_is_compared_with_its_growth() -> None:
    model, series = at_rest(RESTING)
    series.f[1] = 3.0
    series.f[ORDER] = 3.0 * SMALL
    assert length(model, series) == allowed(SMALL)


# ---- falling friction


@pytest.mark.parametrize(("phase", "weight"), [(SLIP, 10 / 1.5), (STICK, None)])
def test_slow_slip_counts_ten_times_by_its_own_speed(phase: int, weight: float | None) -> None:
    """It grows by itself, on the scale of the fall: 1 / (r_0 friction_decay)."""
    model, series = at_rest(FALLING)
    slow = 1.0 / model.decay
    series.f[0] = 0.5 * slow
    series.f[ORDER] = SMALL * slow
    assert length(model, series, phase) == allowed(SMALL * (weight or slow / P.Omega))


@pytest.mark.parametrize("sense", [1.0, -1.0])
@pytest.mark.parametrize(("speed", "power"), [(2.0, 5), (0.5, 0)])
def test_a_step_of_fallen_friction_ends_before_half_of_the_speed_is_lost(
    sense: float, speed: float, power: int
) -> None:
    """The loss counts terms that slow down alone, at the end of the step."""
    model, series = at_rest(FALLING)
    fallen = sense * step_size.FALLEN / model.decay
    series.f[:3] = [speed * fallen, -fallen / 2.0, 2.0 * fallen]
    assert length(model, series) == pytest.approx(LONGEST * 0.75**power)
    assert length(model, series, STICK) == LONGEST
