"""The stored references (parameters, modes, starts, event times) and the way to disc_model."""

import json
from dataclasses import dataclass, fields
from functools import cache
from pathlib import Path

import numpy as np

from disc_model import plate_modes
from disc_model.simulation.states import State as EngineState

DATA = Path(__file__).parent / "data"
PLAIN = ("time", "phase", "direction", "psi", "f", "u", "u_velocity")
MODAL = ("a", "b", "alpha", "beta")


@dataclass
class State:
    """A state in the slider's frame, with amplitudes that are all positive under the slider.

    Attributes
    ----------
    time : s
    phase, direction : the phase, and the sign of f in slip, else 0
    psi, f, u, u_velocity : of the slider
    a, b, alpha, beta : of the modes
    """

    time: float
    phase: str
    direction: int
    psi: float
    f: float
    u: float
    u_velocity: float
    a: list
    b: list
    alpha: list
    beta: list


def _read(found):
    """Return an object of JSON, as a `State` if it is one."""
    names = {field.name for field in fields(State)}
    if found.keys() == names:
        return State(**found)
    return found


@cache
def load(name):
    """Return a stored reference, a file of ``data``; states are `State`."""
    text = (DATA / f"{name}.json").read_text()
    return json.loads(text, object_hook=_read)


def times_of(data):
    """Return event times in long double, which have 20 decimals."""
    return np.array([np.longdouble(time) for time in data["times"]])


def _signs(p):
    """Return the signs of the amplitudes of `plate_modes`."""
    return np.sign(plate_modes(p)["psi"].to_numpy())


def engine_state(state, p):
    """Return a state of the references as disc_model's, with signs as `plate_modes` has them."""
    sign = _signs(p)
    modal = {name: sign * np.array(getattr(state, name), float) for name in MODAL}
    u = float(state.u)
    if state.phase != "separation" and p.contact_compliance == 0:
        # where the references leave u as it last was
        u = float(plate_modes(p)["psi"].to_numpy() @ modal["a"])
    return EngineState(
        time=float(state.time),
        phase=state.phase,
        direction=state.direction,
        psi=float(state.psi),
        f=float(state.f),
        u=u,
        u_velocity=float(state.u_velocity),
        **modal,
    )


def as_json(state):
    """Return disc_model's state as files of references hold it."""
    values = {name: getattr(state, name) for name in PLAIN}
    for name in MODAL:
        values[name] = getattr(state, name).tolist()
    return values


def reference_state(state, p):
    """Return disc_model's state as one of the references."""
    sign = _signs(p)
    values = {name: getattr(state, name) for name in PLAIN}
    for name in MODAL:
        values[name] = [float(x) for x in sign * getattr(state, name)]
    return State(**values)


def rounded(state):
    """Return a `State` with every number a double."""
    values = dict(vars(state))
    for name in MODAL:
        values[name] = [float(x) for x in values[name]]
    for name in ("time", "psi", "f", "u", "u_velocity"):
        values[name] = float(values[name])
    return State(**values)
