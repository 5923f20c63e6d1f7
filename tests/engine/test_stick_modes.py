"""Each mode of stick by itself: how far it takes the contact force."""

import numpy as np
import pytest

from disc_model import Parameters
from disc_model.engine import layout
from disc_model.engine.transitions import stick_force
from disc_model.simulation.result import engine_case

P = Parameters(N=300, Omega=5, n_diameters=2, c=20.0, D_star=1e-2)


def excited(model: layout.Model, mode: int, angle: float) -> layout.EngineState:
    """The static equilibrium with one mode at amplitude one and an angle, as small as the force is linear."""
    state = layout.build_state(model)
    n, length = len(model.modes.gain), len(state.disc)
    leave = model.modes.leave.reshape(2 * n, length)
    state.disc[:] = model.modes.rest + np.cos(angle) * leave[mode] + np.sin(angle) * leave[n + mode]
    if model.compliance:
        slider = 2 * (len(state.z) + len(state.y))  # u and u' stand behind the disc
        state.x[layout.U : layout.U_VELOCITY + 1] = state.disc[slider : slider + 2]
    return state


@pytest.fixture(params=[0.0, 2.5e-7], ids=["rigid", "compliant"])
def model(request: pytest.FixtureRequest) -> layout.Model:
    return engine_case(P.replace(contact_compliance=request.param)).model


def used(model: layout.Model) -> np.ndarray:
    return np.flatnonzero(model.modes.turn)


def test_the_gain_is_the_swing_of_the_contact_force(model: layout.Model) -> None:
    angles = np.linspace(0, 2 * np.pi, 361)
    for mode in used(model):
        swing = max(abs(stick_force(model, excited(model, mode, angle)) - P.N) for angle in angles)
        # the other modes' share of 1e-9 N is rounding of sums of thousands
        assert model.modes.gain[mode] == pytest.approx(swing, rel=1e-4, abs=1e-7)
