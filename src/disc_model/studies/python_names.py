"""How options of quantities are given to the function that computes the same for a single case."""

import inspect
from collections.abc import Callable, Mapping
from typing import Any

from disc_model.stability.floquet import floquet
from disc_model.stability.lyapunov import lyapunov_exponents
from disc_model.studies.functions import basins, critical_speed, hysteresis, outcome
from disc_model.studies.options import value_text
from disc_model.studies.registry import quantity_of

FUNCTIONS: Mapping[str, Callable[..., Any]] = {
    "basins": basins,
    "critical_speed": critical_speed,
    "floquet": floquet,
    "hysteresis": hysteresis,
    "lyapunov": lyapunov_exponents,
    "outcome": outcome,
}
"""Functions of a case, by the quantity that has their results for studies."""
OTHER_WORDS: Mapping[str, Mapping[str, str]] = {
    "exponents": {"count": "count=2"},
    "horizons": {"horizon": "horizon=[100, 1000]"},
    "perturbation": {
        "start": 'start={"u": 1e-4}',
        "initial_state": 'initial_state=dm.initial_state(case, {"u": 1e-4})',
    },
    "prerun": {
        "initial_state": 'initial_state=dm.initial_state(case, prerun={"parameters": {"Omega": 15}, "time": 10})'
    },
    "scan": {"bounds": "bounds=(5, 30), step=1"},
}
"""Calls in Python for options whose arguments have other names, by option and argument."""
ONLY_IN_STUDIES = "in studies only"


def in_python(quantity: str, option: str) -> str:
    """How the function of a quantity is given an option, with the argument's default where it is
    another one; "" where both are as in a study file, or there is no such function."""
    if quantity not in FUNCTIONS:
        return ""
    parameters = inspect.signature(FUNCTIONS[quantity]).parameters
    if option in parameters:
        return _other_default(quantity, option, parameters[option].default)
    for name, written in OTHER_WORDS.get(option, {}).items():
        if name in parameters:
            default = _other_default(quantity, option, parameters[name].default)
            return ", ".join(filter(None, [f"`{written}`", default]))
    return ONLY_IN_STUDIES


def _other_default(quantity: str, option: str, default: Any) -> str:
    """The default of an argument where it is another one than that of the option."""
    if not isinstance(default, int | float | str):  # a class if there is none
        return ""
    field = quantity_of(quantity).model_fields[option]
    if not field.is_required() and value_text(field.get_default()) == value_text(default):
        return ""
    return f"default `{value_text(default)}`"
