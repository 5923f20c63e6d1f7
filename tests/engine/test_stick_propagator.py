"""Stick in closed form against its Taylor series, and the bound that says how long stick lasts."""

import numpy as np
import pytest

from disc_model import Execution, Parameters, Window, simulate
from disc_model.engine import dense_output, stick_modes, stick_propagator
from disc_model.engine.laws import stick_loads, vertical_in_stick
from disc_model.engine.model import Model, build_state
from disc_model.engine.series import Series, build_series, load_state
from disc_model.engine.state import PSI, SURFACE_TURN, U_VELOCITY, EngineState, U
from disc_model.engine.stick import stick_series
from disc_model.engine.transitions import instant
from disc_model.simulation.states import engine_case
from tests.contact_laws import COMPILES, by_series

ORDER = 40
VARIANTS = {
    "base": {},
    "undamped": {"D_star": 0.0},
    "dampers": {"c": 20.0, "c_p": 0.5, "D_star": 1e-2},
    "orthonormal": {"normalization": "orthonormal"},
    "more blocks": {"n_diameters": 7, "n_circles": 1, "c": 2.0},
    "no pairs": {"n_diameters": 0},
    "coupled": {"friction_offset": 0.02, "c_p": 0.5},
}
COMPLIANT = {"contact_compliance": 2.5e-7, "c": 20.0, "D_star": 1e-2}
ALL = VARIANTS | {
    "compliant": COMPLIANT,
    "compliant coupled": COMPLIANT | VARIANTS["coupled"],
    "compliant block": COMPLIANT | {"n_diameters": -1},
}


def _propagate(model: Model, s: Series, state: EngineState, x: float) -> float:
    length = stick_propagator.closed_form_length(model, s, state)
    stick_propagator.propagate_stick(model, s, x, state)
    return float(length)


def _lively(model: Model, seed: int = 1) -> EngineState:
    """Stick with every mode in motion."""
    state = build_state(model)
    rng = np.random.default_rng(seed)
    used = model.stiffness > 0
    state.z[:] += 1e-6 * rng.normal(size=len(state.z)) * used
    state.e[:] += 3e-3 * rng.normal(size=len(state.e)) * used
    state.y[:] += 1e-6
    state.x[PSI] = -0.01
    if model.has_moving_surface:
        state.x[SURFACE_TURN] = 0.03
    return state


@pytest.mark.parametrize("variant", ALL)
@pytest.mark.parametrize("x", [pytest.param(x, marks=COMPILES) for x in (0.0, 0.1, 1.7, 4.0)])
def test_closed_form_is_the_series(variant: str, x: float) -> None:
    """Both are exact but for rounding: 40 terms, whose largest is 4^4 / 4! = 11 times the sum at x
    = 4.

    A velocity is rounded as the static deflection is, times the highest frequency.
    """
    model = engine_case(Parameters(N=385, Omega=15.1, **ALL[variant])).model
    closed = _lively(model)
    taylor = _lively(model)
    _propagate(model, build_series(model, ORDER), closed, x)
    s = build_series(model, ORDER)
    load_state(model, s, taylor)
    stick_series(model, s, ORDER)
    dense_output.state_at(model, s, ORDER, x, 0.0, taylor)
    size = max(np.abs(taylor.z).max(initial=abs(model.u_0)), np.abs(taylor.y).max(initial=0.0))
    for name, unit in {"e": model.unit, "g": model.unit, "z": 1.0, "y": 1.0}.items():
        np.testing.assert_allclose(
            getattr(closed, name), getattr(taylor, name), atol=1e-14 * size / unit, rtol=0
        )
    assert closed.x[PSI] == pytest.approx(taylor.x[PSI], rel=1e-15)
    # of two angles that grow from it, whose difference is the closed form's
    assert closed.x[SURFACE_TURN] == pytest.approx(taylor.x[SURFACE_TURN], rel=1e-15)
    if model.has_compliance:
        assert closed.x[U] == pytest.approx(taylor.x[U], abs=1e-14 * size)
        assert closed.x[U_VELOCITY] == pytest.approx(
            taylor.x[U_VELOCITY], abs=1e-14 * size / model.unit
        )


def excited(model: Model, mode: int, angle: float) -> EngineState:
    """The static equilibrium with one mode at amplitude one and an angle, as small as the force is
    linear."""
    state = build_state(model)
    n = len(model.modes.gain)
    length = len(state.disc)
    leave = model.modes.leave.reshape(2 * n, length)
    state.disc[:] = model.modes.rest + np.cos(angle) * leave[mode] + np.sin(angle) * leave[n + mode]
    if model.has_compliance:
        slider = 2 * (len(state.z) + len(state.y))  # u and u' stand behind the disc
        state.x[U : U_VELOCITY + 1] = state.disc[slider : slider + 2]
    return state


COUPLED = [
    {"friction_offset": 0.02, "c_p": 5.0, "D_star": 1e-2, "contact_compliance": give}
    for give in (0.0, 2.5e-7)
]


@pytest.mark.parametrize(
    "law", [{"c": 20.0, "D_star": 1e-2}, {"c": 20.0, "contact_compliance": 2.5e-7}, *COUPLED]
)
def test_the_gains_of_a_mode_are_its_swings_of_the_forces(law) -> None:
    """Of the contact force, and of that which holds the slider at an angle from a surface at rest."""
    model = engine_case(Parameters(N=300, Omega=5, n_diameters=2, **law)).model
    hold_gain = (
        model.modes.hold_gain if model.has_moving_surface else np.zeros(len(model.modes.gain))
    )
    for mode in np.flatnonzero(model.modes.turn):
        forces = []
        for angle in np.linspace(0, 2 * np.pi, 361):
            state = excited(model, mode, angle)
            state.x[PSI] = 0.01 - model.tangential @ state.z / model.r_0
            i, _ = instant(model, state)
            forces.append(stick_loads(model, i, vertical_in_stick(model, i)))
        # the other modes' share is rounding of sums of thousands of newtons
        gains = [hold_gain[mode], model.modes.gain[mode]]
        assert gains == pytest.approx(np.ptp(forces, axis=0) / 2, rel=1e-4, abs=1e-7)


@pytest.mark.parametrize(
    "variant",
    [
        pytest.param(name, marks=[pytest.mark.compiled] if name == "more blocks" else [])
        for name in VARIANTS
    ],
)
@pytest.mark.parametrize("seed", range(2))
def test_stick_holds_as_long_as_promised_and_not_much_longer(variant: str, seed: int) -> None:
    p = Parameters(N=385, Omega=5.0, **VARIANTS[variant])
    model = engine_case(p).model
    s = build_series(model, ORDER)
    state = _lively(model, seed)
    length = _propagate(model, s, state, 0.0)
    assert stick_propagator.SHORTEST_STICK <= length < stick_modes.LONGEST_STICK
    swing = 0.0
    lowest = np.inf
    times = np.linspace(0.0, length, 500)
    pulls = np.zeros(500)
    for k, x in enumerate(times):
        stick_propagator.propagate_stick(model, s, x, state)
        i, _ = instant(model, state)
        pull, P = stick_loads(model, i, vertical_in_stick(model, i))
        pulls[k] = pull
        lowest = min(lowest, p.mu_s * P - abs(pull))
        swing = max(swing, abs(P - p.N))
    assert lowest > -1e-12 * p.N
    # the bound adds amplitudes that are never all at their worst together: it may not be idle,
    # though
    wave = np.abs(pulls - np.polyval(np.polyfit(times, pulls, 1), times)).max()
    assert lowest < 4.0 * (p.mu_s * swing + wave)


@pytest.mark.parametrize(
    "parameters",
    [
        {"D_star": 50.0},
        {"D_star": 200.0, "n_diameters": 1},
        {"n_diameters": 20, "n_circles": 3},
        {"k": 1e9},
    ],
    ids=["near critical damping", "overdamped", "many modes", "faster than the series allows"],
)
def test_the_rest_is_left_to_the_series(parameters: dict[str, float]) -> None:
    assert engine_case(Parameters(N=385, Omega=15.1, **parameters)).model.modes.gain.size == 0


def test_nothing_is_promised_where_nothing_is_sure() -> None:
    """A spring beyond the friction limit, or a swing that could take P to zero."""
    model = engine_case(Parameters(N=385, Omega=15.1)).model
    s = build_series(model, ORDER)
    pulled = _lively(model)
    shaken = _lively(model)
    pulled.x[PSI] = 0.1
    shaken.e[:] *= 1e4
    assert _propagate(model, s, pulled, 0.0) == _propagate(model, s, shaken, 0.0) == 0.0


def test_a_spring_that_pulls_hard_already_leaves_less_time() -> None:
    """At rest under the preload P stays: stick lasts until the spring, now at 0.9 of the limit, is
    at all of it."""
    p = Parameters(N=385, Omega=15.1)
    limit = p.mu_s * p.N / p.r_0
    unit = engine_case(p).model.unit
    # from no pull at all that would take as long as one advance may last
    model = engine_case(p.replace(Omega=limit / (p.k_p * unit * stick_modes.LONGEST_STICK))).model
    s = build_series(model, ORDER)
    state = build_state(model)
    state.x[PSI] = 0.9 * limit / p.k_p
    # 0.1 of it, right to the rounding of forces of which nine tenths cancel
    assert _propagate(model, s, state, 0.0) == pytest.approx(
        0.1 * stick_modes.LONGEST_STICK, rel=1e-12
    )


@pytest.mark.compiled
@pytest.mark.parametrize("dampers", [{}, {"c": 1.0, "D_star": 1e-3}], ids=str)
def test_events_samples_and_audit_within_an_advance(dampers: dict[str, float]) -> None:
    """Slow drive: stick is nearly all of the motion, and what falls into a long advance is as good
    as of steps."""
    p = Parameters(N=385, Omega=1.0, **dampers)
    how = {
        "windows": {"all": Window(start=0.0, stop=0.3, rate=2000.0)},
        "execution": Execution(audit_every_step=True),
    }
    closed = simulate(p, 0.6, tol=1e-14, **how)
    stepped = simulate(p, 0.6, tol=1e-14, **how, ramps=by_series(p))
    assert closed.statistics["steps"] < stepped.statistics["steps"] / 3
    assert list(closed.events["kind"]) == list(stepped.events["kind"])
    # rounding of a clock that reads 0.6 s, and of the forces at a release that the slow spring
    # reaches at a flat angle
    np.testing.assert_allclose(closed.events["time"], stepped.events["time"], atol=1e-12, rtol=0)
    for name, values in stepped.samples["all"].items():
        # the series leave 1e-14 of the static deflection at each step, which a small velocity feels
        size = max(np.abs(values).max(), 1e-3 * (name == "u_velocity"))
        np.testing.assert_allclose(
            closed.samples["all"][name], values, rtol=0, atol=1e-9 * size, err_msg=name
        )
    # the quadrature of a step is good to rounding, so is that of an advance in closed form
    assert all(
        closed.statistics[f"energy_residual_{of}"] < 1e-13 for of in ("transverse", "inplane")
    )
