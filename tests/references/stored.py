"""The stored references (parameters, modes, starts, event times) and the way from them to
disc_model."""

import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from disc_model import plate_modes
from disc_model.simulation.states import State as EngineState

DATA = Path(__file__).parent / "data"


@dataclass
class State:
    """Time (s), phase, direction (sign of f in slip, else 0) and the variables of the slider's
    frame."""

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


@cache
def load(name):
    """Stored reference `name`, a file of ``data``, as a dict; states as `State`, `time` as
    floats."""

    def read(found):
        return State(**found) if found.keys() == State.__annotations__.keys() else found

    return json.loads((DATA / f"{name}.json").read_text(), object_hook=read)


def times_of(data):
    """Event times in long double: 20 decimals."""
    return np.array([np.longdouble(time) for time in data["times"]])


def engine_state(state, p):
    """`State` of the references (all psi positive) as disc_model's (signs as plate_modes has
    them)."""
    sign = np.sign(plate_modes(p)["psi"].to_numpy())
    values = {
        k: sign * np.array(v, float) if isinstance(v, list) else v for k, v in vars(state).items()
    }
    if (
        state.phase != "separation" and p.contact_compliance == 0
    ):  # where the references leave u as it last was
        values["u"] = float(plate_modes(p)["psi"].to_numpy() @ values["a"])
    return EngineState(
        **{k: float(v) if isinstance(v, np.floating) else v for k, v in values.items()}
    )


def as_json(state):
    """disc_model's state, as files of references hold it."""
    values = {name: getattr(state, name) for name in State.__annotations__}
    return {
        name: value.tolist() if isinstance(value, np.ndarray) else value
        for name, value in values.items()
    }


def reference_state(state, p):
    """The other way round."""
    sign = np.sign(plate_modes(p)["psi"].to_numpy())
    modal = {k: [float(x) for x in sign * getattr(state, k)] for k in ("a", "b", "alpha", "beta")}
    plain = {
        k: getattr(state, k) for k in ("time", "phase", "direction", "psi", "f", "u", "u_velocity")
    }
    return State(**plain, **modal)


def rounded(state):
    """`State` with every number a double."""
    values = {
        k: [float(x) for x in v] if isinstance(v, list) else v for k, v in vars(state).items()
    }
    return State(**{k: float(v) if isinstance(v, np.floating) else v for k, v in values.items()})
