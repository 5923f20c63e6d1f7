"""Each mode of stick by itself: how it turns and decays, and how far it takes the contact force."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import expm

from disc_model import Parameters, plate_modes
from disc_model.engine import layout
from disc_model.engine.switches import stick_force
from disc_model.simulation.result import engine_case

P = Parameters(N=300, Omega=5, n_diameters=2, c=20.0, D_star=1e-2)


def excited(model: layout.Model, mode: int, angle: float) -> layout.State:
    """The static equilibrium with one mode at amplitude one and an angle, as small as the force is linear."""
    state = layout.build_state(model)
    n, length = len(model.modes.gain), len(state.disc)
    leave = model.modes.leave.reshape(2 * n, length)
    state.disc[:] = model.modes.rest + np.cos(angle) * leave[mode] + np.sin(angle) * leave[n + mode]
    if model.give:
        slider = 2 * (len(state.z) + len(state.y))  # u and u' stand behind the disc
        state.x[layout.U : layout.U_VELOCITY + 1] = state.disc[slider : slider + 2]
    return state


@pytest.fixture(params=[0.0, 2.5e-7], ids=["rigid", "compliant"])
def model(request: pytest.FixtureRequest) -> layout.Model:
    return engine_case(P.replace(contact_compliance=request.param)).model


def used(model: layout.Model) -> np.ndarray:
    return np.flatnonzero(model.modes.turn)


def test_the_gain_is_the_swing_of_the_contact_force(model: layout.Model) -> None:
    angles = np.linspace(0, 2 * np.pi, 721)
    for mode in used(model):
        swing = max(abs(stick_force(model, excited(model, mode, angle)) - P.N) for angle in angles)
        # the other modes' share of 1e-9 N is rounding of sums of thousands
        assert model.modes.gain[mode] == pytest.approx(swing, rel=1e-4, abs=1e-7)


def test_the_modes_are_those_of_the_coupled_system(model: layout.Model) -> None:
    """Rates in time units, against the eigenvalues of disc and slider, assembled in full."""
    modes = plate_modes(P)
    omega, psi, l = (modes[name].to_numpy() for name in ("omega", "psi", "diameters"))
    damping = P.D_star / P.D * omega**2
    n = len(omega)
    mass = np.eye(n) + P.m * np.outer(psi, psi)
    stiffness, damper = np.diag(omega**2) + P.k * np.outer(psi, psi), np.diag(damping) + P.c * np.outer(psi, psi)
    if model.give:  # the slider has a coordinate of its own, and a spring to the disc
        spring = np.append(psi, -1.0)
        mass, damper = np.diag([*np.ones(n), P.m]), np.diag([*damping, P.c])
        stiffness = np.diag([*omega**2, P.k]) + np.outer(spring, spring) / model.give
    inverse, zero, one = np.linalg.inv(mass), np.zeros_like(mass), np.eye(len(mass))
    coupled = np.linalg.eigvals(np.block([[zero, one], [-inverse @ stiffness, -inverse @ damper]]))
    free = [-d / 2 + 1j * np.sqrt(w**2 - d**2 / 4) for w, d in zip(omega[l > 0], damping[l > 0], strict=True)]
    expected = np.concatenate([coupled[coupled.imag > 0], free]) * model.unit
    found = (model.modes.decay + 1j * model.modes.turn)[used(model)]
    assert len(found) == len(expected)
    assert np.max(np.min(np.abs(found[:, None] - expected[None, :]), axis=1)) < 1e-10


def test_amplitudes_are_read_from_states(model: layout.Model) -> None:
    """Entering the modes undoes leaving them; over a time they turn as the tabled powers say."""
    n = len(model.modes.gain)
    enter = model.modes.enter.reshape(-1, 2 * n)
    for mode in used(model):
        state = excited(model, mode, 0.7)
        q = model.modes.offset + state.disc @ enter
        expected = np.zeros(2 * n)
        expected[mode], expected[n + mode] = np.cos(0.7), np.sin(0.7)
        np.testing.assert_allclose(q, expected, atol=1e-6)
    powers = model.modes.powers.reshape(-1, 2, n)
    rates = model.modes.decay + 1j * model.modes.turn
    turned = np.diag(expm(np.diag(0.25 * rates)))
    np.testing.assert_allclose(powers[0, 0] + 1j * powers[0, 1], np.where(rates == 0, powers[0, 0], turned), atol=1e-12)
