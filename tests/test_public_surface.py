"""Wrong types and sizes, for each argument of every public function: each is named, with its value and the rule."""

import inspect
import math
import re
from typing import Any

import numpy as np
import pytest

import disc_model
from disc_model import Execution, ParameterError, Parameters, Poincare, Ramp, Record, State, Window, simulate
from disc_model.data import dataset
from disc_model.stability.branch import StepControl
from disc_model.stability.continuation import continue_cycle
from disc_model.stability.curves import stability_curves
from disc_model.stability.lyapunov import lyapunov_exponents

P = Parameters(N=200, Omega=20, n_diameters=1)
HOSTILE: dict[str, Any] = {
    "text": "x",
    "digits": "1",
    "long": "x" * 5000,
    "bytes": b"1",
    "None": None,
    "True": True,
    "flag": np.True_,
    "nan": math.nan,
    "inf": math.inf,
    "negative": -1.5,
    "zero": 0,
    "huge": 10**400,
    "wide": np.longdouble("1e400"),
    "complex": 1j,
    "list": [1.0, "x"],
    "pair": (2, 1),
    "array": np.array([1.0, math.nan]),
    "matrix": np.eye(2),
    "scalar": np.array(0.5),
    "words": np.array(["1", "1"]),
    "dict": {1: 2},
    "empty": (),
    "object": object(),
}
FILE = "text digits"
ANY = "zero negative pair empty matrix scalar"


def right(alike: str = "", labels: str = "", /, **others: str) -> dict[str, str]:
    """Labels of what is right as well, for several arguments alike and for others."""
    return dict.fromkeys(alike.split(), labels) | others


SLIPPING = simulate(P, 2.5e-3).final_state


def start(**changes: object) -> None:
    simulate(P, 1.0, initial_state=SLIPPING.replace(**{"time_low": SLIPPING.time_low} | changes))


def run(**given: Any) -> None:
    simulate(P, 1.0, execution=Execution(**given))


start.__signature__ = inspect.signature(State)  # type: ignore[attr-defined]
run.__signature__ = inspect.signature(Execution)  # type: ignore[attr-defined]
RUN = simulate(P, 1e-4, record=Window(rate=1e5))
PLANE = {"p": P, "names": ("Omega", "N"), "bounds": {"Omega": (10.0, 30.0), "N": (100, 300)}}
ALL = " ".join(HOSTILE)
LATE = "inf huge wide"
#: Functions, arguments that are right, and for each of `HOSTILE` that are right as well, or not looked at.
SURFACE: list[tuple[Any, dict[str, Any], dict[str, str]]] = [
    (disc_model.plate_modes, {}, {}),
    (disc_model.coupled_natural_frequencies, {}, {}),
    (disc_model.residual_flexibility, {}, {}),
    (disc_model.steady_sliding, {}, {}),
    (disc_model.choose_modes, {"case": P}, right(case="dict", tolerance="None digits")),
    (simulate, {"p": P, "t_end": 1.0}, right("initial_state record stop_at", "None", ramps="empty")),
    (run, {}, right(progress="None True", max_steps="None huge")),
    (
        start,
        {},
        right("time psi u_velocity", "zero negative", mode_amplitudes="None", case_key=ALL)
        | right("time_low f known", "zero")
        | right("a b alpha beta", "pair"),
    ),
    (disc_model.snapshots, {"p": P, "times": 1e-4}, right(times="zero empty", initial_state="None")),
    (
        disc_model.deflection,
        {"p": P, "states": RUN.final_state, "r": 0.1, "theta": 0.0},
        right("states r", "empty", theta="zero negative pair empty"),
    ),
    (disc_model.floquet, {"p": P}, right(guess="None")),
    (continue_cycle, {"p": P, "name": "Omega", "bounds": (10.0, 30.0)}, right(guess="None")),
    (StepControl, {}, right("growth easy sharpest", ALL, scale="None", max_points="huge")),
    (stability_curves, PLANE | {"lines": (200.0,)}, right(lines="pair empty", max_points="huge")),
    (
        lyapunov_exponents,
        {"p": P, "duration": 0.1},
        right(initial_state="None", leave_out_trivial="True flag"),
    ),
    (Window, {"rate": 1.0}, right("last envelope", "None", start="zero", stop=LATE, theta="zero negative")),
    (Poincare, {}, right(start="zero", stop=LATE, theta="zero negative")),
    (Record, {}, right("events audit_every_step", "True flag zero bytes", windows="empty", poincare="None")),
    (Ramp, {"parameter": "N", "to": 1.0, "start": 0.0, "end": 2.0}, right(start="zero")),
    (RUN.value_at, {"name": "N", "times": 0.0}, right(times=ANY)),
    (RUN.to_tree, {}, right(names=f"None {FILE}")),
    (RUN.save, {"path": "x"}, right(path=FILE, names=f"None {FILE}")),
    (RUN.final_state.save, {}, right(path=FILE)),
    (State.load, {}, right(path=FILE)),
    (disc_model.load, {}, right(path=FILE)),
    (dataset.save, {"tree": RUN.to_tree(), "path": "x"}, right(path=FILE)),
]
MODELS = (Window, Poincare, Record, Ramp)
"""What files are checked by: digits are numbers there."""
ARGUMENTS = [
    pytest.param(function, given, name, right.get(name, ""), id=f"{function.__qualname__}-{name}")
    for function, given, right in SURFACE
    for name in inspect.signature(function).parameters
]


@pytest.mark.parametrize(("function", "given", "name", "right"), ARGUMENTS)
def test_a_wrong_argument_is_named(function, given, name, right, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for label, value in HOSTILE.items():
        if label in right.split() or (function in MODELS and label == "digits"):
            continue
        try:
            function(**given | {name: value})
        except ParameterError as error:
            text = error.faults
        else:
            text = ("nothing",)
        assert any(name in re.findall(r"\w+", fault) for fault in text), (label, text)
