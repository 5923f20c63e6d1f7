"""Limits with known answers, balances and symmetries."""

from __future__ import annotations

import math
import os
import subprocess
import sys

import numpy as np
import pytest
from scipy.linalg import expm

from disc_model import Parameters, Record, Window, plate_modes, simulate
from disc_model.simulation.api import carried_over
from disc_model.simulation.result import State
from tests.contact_laws import classical_events
from tests.references import stored

pytestmark = pytest.mark.compiled

P_A = Parameters(N=385.0, Omega=15.1)


def _separating_start(time=0.0):
    data = stored.load("C")
    return stored.engine_state(data["start"], P_A).replace(time=time)


def _shape(p):
    modes = plate_modes(p)
    return modes["diameters"].to_numpy(), modes["omega"].to_numpy(), modes["psi"].to_numpy()


def _energy(p, state, u_0):
    """Transverse and in-plane energy (J) of a State."""
    _, omega, _ = _shape(p)
    disc = 0.5 * (state.alpha**2 + state.beta**2 + omega**2 * (state.a**2 + state.b**2)).sum()
    slider = 0.5 * p.m * state.u_velocity**2 + 0.5 * p.k * (state.u - u_0) ** 2 + p.N * state.u
    return disc + slider, 0.5 * p.r_0**2 * (p.m * state.f**2 + p.k_p * state.psi**2)


# ----------------------------------------------------------------------------------- rigid disc
@pytest.mark.parametrize("Omega", [5.0, 20.0])
def test_rigid_disc_has_the_classical_stick_slip_cycle(Omega):
    p = Parameters(N=300.0, Omega=Omega, E=1e20)
    wanted = classical_events(p, 4)
    events = simulate(p, 1.05 * wanted[-1]).events
    assert list(events["kind"])[:4] == ["stick_to_slip", "slip_to_stick"] * 2
    # the disc's compliance, psi^2/omega^2, is 1e9 times smaller than in the published case
    np.testing.assert_allclose(events["time"][:4], wanted, rtol=1e-8)


# ---------------------------------------------------------------------------------- the disc alone
@pytest.mark.parametrize(
    "extra",
    [
        {},
        pytest.param({"n_circles": 1, "normalization": "orthonormal"}, marks=pytest.mark.slow),
    ],  # compiles for a minute
)
def test_free_disc_rings_at_its_own_frequencies_and_decays(extra):
    """The slider, far above the disc, swings on its springs; the disc, seen from there, rings as if alone."""
    p = Parameters(N=0.0, Omega=15.0, k=1.0, D_star=2e-4, **extra)
    l, omega, _psi = _shape(p)
    n, rng = len(l), np.random.default_rng(0)
    cos, sin, cos_rate, sin_rate = rng.normal(0, 1e-3, (4, n))
    cos_rate, sin_rate = cos_rate * omega, sin_rate * omega
    sin, sin_rate = sin * (l > 0), sin_rate * (l > 0)
    modal = {"a": cos, "b": sin, "alpha": cos_rate, "beta": sin_rate}
    start = State(time=0.0, phase="separation", direction=0, psi=0.0, f=12.0, u=1.0, u_velocity=0.0, **modal)
    t = 0.3
    result = simulate(p, t, tol=1e-14, initial_state=start)
    assert len(result.events) == 0
    end = result.final_state
    # psi'' = -(k_p/m) psi with psi(0) = 0, psi'(0) = Omega - f(0)
    w_p = math.sqrt(p.k_p / p.m)
    swing = (p.Omega - start.f) * math.sin(w_p * t) / w_p
    assert end.psi == pytest.approx(swing, rel=1e-11)
    phi = p.Omega * t - swing
    xi_omega = 0.5 * p.D_star / p.D * omega**2
    damped = np.sqrt(omega**2 - xi_omega**2)

    def ring(x, v):
        amplitude = (v + xi_omega * x) / damped
        value = x * np.cos(damped * t) + amplitude * np.sin(damped * t)
        rate = (-xi_omega * value) + damped * (-x * np.sin(damped * t) + amplitude * np.cos(damped * t))
        return np.exp(-xi_omega * t) * value, np.exp(-xi_omega * t) * rate

    (c, c_rate), (s, s_rate) = ring(cos, cos_rate), ring(sin, sin_rate)
    turn, turned = np.cos(l * phi), np.sin(l * phi)
    scale, rate_scale = np.abs(c).max() + np.abs(s).max(), np.abs(c_rate).max() + np.abs(s_rate).max()
    assert np.exp(-xi_omega * t).min() < 0.3  # the decay is not negligible
    np.testing.assert_allclose(end.a, c * turn + s * turned, atol=1e-11 * scale, rtol=0)
    np.testing.assert_allclose(end.b, (s * turn - c * turned) * (l > 0), atol=1e-11 * scale, rtol=0)
    np.testing.assert_allclose(end.alpha, c_rate * turn + s_rate * turned, atol=1e-11 * rate_scale, rtol=0)
    np.testing.assert_allclose(end.beta, (s_rate * turn - c_rate * turned) * (l > 0), atol=1e-11 * rate_scale, rtol=0)
    assert end.u == pytest.approx(math.cos(math.sqrt(p.k / p.m) * t), rel=1e-12)


@pytest.mark.parametrize("m", [1e-3, 1e3, 1e6])
def test_any_mass_can_be_computed(m):
    """No paradox on a flat disc, however heavy the slider."""
    result = simulate(Parameters(N=100.0, Omega=15.0, m=m), 0.02)
    assert result.status == "ok", result.message
    assert result.events["kind"].iloc[0] == "stick_to_slip"


def test_stick_is_the_coupled_linear_system():
    """While the slow drive winds up the spring the slider sticks: a linear system, by scipy's expm."""
    p = Parameters(N=300.0, Omega=0.1, c=3.0)
    l, omega, psi = _shape(p)
    n, t = len(l), 0.05
    rest = simulate(p, 1e-9)
    start = rest.final_state
    rng = np.random.default_rng(3)
    kick = rng.normal(0, 3e-3, n)
    b, beta = rng.normal(0, 1e-5, n) * (l > 0), rng.normal(0, 1e-2, n) * (l > 0)
    start = start.replace(time=0.0, time_low=0.0, psi=0.0, alpha=kick, b=b, beta=beta, u_velocity=float(psi @ kick))
    result = simulate(p, t, tol=1e-14, initial_state=start)
    assert len(result.events) == 0

    damping = p.D_star / p.D * omega**2
    inverse = np.linalg.inv(np.eye(n) + p.m * np.outer(psi, psi))
    stiffness = np.diag(omega**2) + p.k * np.outer(psi, psi)
    damper = np.diag(damping) + p.c * np.outer(psi, psi)
    matrix = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ stiffness, -inverse @ damper]])
    equilibrium = -p.N * psi / omega**2
    x = expm(matrix * t) @ np.concatenate([start.a - equilibrium, kick])
    across = np.array(
        [expm(np.array([[0, 1], [-w * w, -d]]) * t) @ y for w, d, y in zip(omega, damping, np.c_[b, beta], strict=True)]
    )
    end = result.final_state
    np.testing.assert_allclose(end.a - equilibrium, x[:n], atol=1e-11 * np.abs(x[:n]).max(), rtol=0)
    np.testing.assert_allclose(end.alpha, x[n:], atol=1e-11 * np.abs(x[n:]).max(), rtol=0)
    np.testing.assert_allclose(end.b, across[:, 0], atol=1e-11 * np.abs(across[:, 0]).max(), rtol=0)
    np.testing.assert_allclose(end.beta, across[:, 1], atol=1e-11 * np.abs(across[:, 1]).max(), rtol=0)
    assert end.psi == pytest.approx(p.Omega * t, rel=1e-13)


def test_stick_ends_where_static_friction_is_reached():
    """The first switch from equilibrium is at r_0 k_p Omega t = mu_s N exactly: nothing moves till then."""
    for N, Omega in ((385.0, 15.1), (300.0, 20.0)):
        p = Parameters(N=N, Omega=Omega)
        first = simulate(p, 0.01).events.iloc[0]
        assert first["kind"] == "stick_to_slip"
        assert first["time"] == pytest.approx(p.mu_s * N / (p.k_p * p.r_0 * Omega), rel=1e-14)


# ---------------------------------------------------------------------------------------- balances
BALANCED = {
    "stick and slip": ({}, False, 5.0),
    "separation": ({}, True, 2.0),
    "separation, every damper": ({"c": 0.2, "c_p": 0.05, "D_star": 2e-5}, True, 2.0),
    "bonded": ({"contact": "bonded"}, True, 2.0),
    "orthonormal": ({"normalization": "orthonormal"}, True, 2.0),
}


@pytest.mark.parametrize("case", BALANCED)
def test_both_energy_balances(case):
    changes, separating, t_end = BALANCED[case]
    p = Parameters(**(P_A.model_dump() | changes))
    start = carried_over(p, _separating_start()) if separating else None
    result = simulate(p, t_end, tol=1e-12, initial_state=start, record=Record(energy=True))
    statistics = result.statistics
    assert statistics["energy_transverse"] <= 1e-10
    assert statistics["energy_inplane"] <= 1e-10
    assert statistics["energy_residual"] <= 1e-10
    assert statistics["audited_steps"] == statistics["steps"]


def test_energy_of_free_flight_is_conserved():
    """Without dampers a separation keeps the transverse energy; from the states, not from the audit."""
    p = Parameters(N=385.0, Omega=15.1, D_star=0.0)
    first = simulate(p, 0.5, tol=1e-15, initial_state=_separating_start())
    times, kinds = first.events["time"].to_numpy(), list(first.events["kind"])
    i = kinds.index("separation")
    inside = [
        simulate(p, times[i] + s * (times[i + 1] - times[i]), tol=1e-15, initial_state=_separating_start())
        for s in (0.1, 0.9)
    ]
    assert [r.final_state.phase for r in inside] == ["separation"] * 2
    before, after = (_energy(p, r.final_state, r.u_0)[0] for r in inside)
    assert after == pytest.approx(before, rel=1e-12)


def _impacts(count=20):
    """States just before and after the first impacts; the clock starts at 0, where its numbers are dense."""
    start = _separating_start()
    events = simulate(P_A, 0.2, tol=1e-15, initial_state=start).events
    for time in events["time"][events["kind"] == "reattachment"][:count]:
        # one state on each side, a few units in the last place away (the motion meanwhile is below rounding)
        before, after = (
            simulate(P_A, time * (1 + side * 1e-15), tol=1e-15, initial_state=start).final_state for side in (-1, 1)
        )
        assert (before.phase, after.phase) == ("separation", "slip")
        yield before, after


def test_impact_conserves_momentum_and_is_plastic():
    l, _, psi = _shape(P_A)
    impulses = []
    for before, after in _impacts():
        impulse = P_A.m * (after.u_velocity - before.u_velocity)
        assert impulse > 0
        impulses.append(impulse)
        scale = np.abs(before.alpha).max()
        np.testing.assert_allclose(after.alpha - before.alpha, -psi * impulse, atol=1e-10 * scale, rtol=0)  # Eq. (33)
        disc = psi @ (after.alpha + l * after.f * after.b)
        assert after.u_velocity == pytest.approx(disc, rel=1e-12)  # Eq. (34)
        for name in ("a", "b", "beta", "psi", "f", "u"):  # Eq. (35)
            old, new = getattr(before, name), getattr(after, name)
            np.testing.assert_allclose(new, old, atol=1e-11 * max(1e-3, np.abs(old).max()), rtol=0)
    assert max(impulses) > 1e-4  # N s: far above the 1e-11 m/s or so of rounding


def test_impact_changes_the_energy_as_it_must():
    l, _, psi = _shape(P_A)
    u_0 = simulate(P_A, 1e-9).u_0
    for before, after in _impacts():
        p = P_A.m * (after.u_velocity - before.u_velocity)
        slope = psi @ (l * before.b)
        wanted = -0.5 * p**2 * (psi @ psi + 1 / P_A.m) + p * before.f * slope
        (old, old_inplane), (new, new_inplane) = _energy(P_A, before, u_0), _energy(P_A, after, u_0)
        assert new - old == pytest.approx(wanted, abs=1e-10 * old, rel=1e-8)
        assert new_inplane == pytest.approx(old_inplane, rel=1e-12)


# -------------------------------------------------------------------------------------- symmetries
def test_reflection():
    """With the drive at rest, the mirror image of a motion is a motion: all angles and slopes change sign."""
    p = Parameters(N=120.0, Omega=0.0)
    start = _separating_start().replace(f=14.0, psi=0.03)
    mirrored = start.replace(f=-start.f, psi=-start.psi, b=-start.b, beta=-start.beta, direction=-start.direction)
    one, other = (simulate(p, 0.5, tol=1e-13, initial_state=s) for s in (start, mirrored))
    assert {"slip_to_stick", "separation", "reattachment"} <= set(one.events["kind"])
    assert list(one.events["kind"]) == list(other.events["kind"])
    np.testing.assert_allclose(one.events["time"], other.events["time"], atol=1e-12, rtol=0)
    for name, sign in {"psi": -1, "f": -1, "u": 1, "u_velocity": 1, "P": 1}.items():
        values = one.events[name].to_numpy()
        np.testing.assert_allclose(sign * other.events[name], values, atol=1e-9 * np.abs(values).max(), rtol=0)


def test_rotation():
    """A later start is a start at another angle: the same motion, seen from a point turned with it."""
    shift, t_end = 0.375, 0.25  # a binary fraction, so that the shifted clock adds no rounding of its own

    def run(delay):
        window = Window(start=delay, stop=delay + t_end, rate=1000.0, theta=1.0 + delay * P_A.Omega)
        start, record = _separating_start(delay), Record(windows=(window,))
        return simulate(P_A, delay + t_end, tol=1e-14, initial_state=start, record=record)

    one, other = run(0.0), run(shift)
    assert list(one.events["kind"]) == list(other.events["kind"])
    np.testing.assert_allclose(other.events["time"] - shift, one.events["time"], atol=1e-12, rtol=0)
    for name in ("w_point", "w_point_velocity", "w", "psi", "P"):
        values = one.samples[0][name]
        np.testing.assert_allclose(other.samples[0][name], values, atol=1e-8 * np.abs(values).max(), rtol=0)


# ----------------------------------------------------------------------------- without compilation
PLAIN = """
from disc_model import Parameters, simulate
from tests.references import stored
data = stored.load("C")
p = stored.parameters_of(data)
start = stored.engine_state(data["start"], p)
for time, kind in simulate(p, 54.42, initial_state=start).events[["time", "kind"]].itertuples(index=False):
    print(repr(float(time)), kind)
"""


def test_same_events_without_numba():
    data = stored.load("C")
    environment = os.environ | {"NUMBA_DISABLE_JIT": "1"}
    done = subprocess.run([sys.executable, "-c", PLAIN], env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    rows = [line.split() for line in done.stdout.splitlines()]
    assert len(rows) >= 4
    wanted = data["events"][: len(rows)]
    assert [kind for _, kind in rows] == [e["kind"] for e in wanted]
    np.testing.assert_allclose([float(t) for t, _ in rows], [e["time"] for e in wanted], atol=1e-11, rtol=0)
