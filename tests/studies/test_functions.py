"""Quantities of a case and studies as functions: the same numbers as those of the workflow's
batches."""

import json
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import disc_model as dm
from disc_model.data.variables import flag_names
from disc_model.studies.whole_study import run_study

P = dm.Parameters(N=385, Omega=14)
SCAN = {"start": 14, "stop": 15, "step": 1}
SAME = [
    (dm.outcome, {"horizon": 20}, {"horizon": 20}),
    (
        dm.critical_speed,
        {"scan": (14, 15), "horizon": [20, 30]},
        {"scan": SCAN, "horizons": [20, 30]},
    ),
    (dm.basins, {"horizon": 20, "energies": [0.1]}, {"horizon": 20, "energies": [0.1]}),
    (dm.hysteresis, {"scan": (14, 15), "dwell": 10}, {"scan": SCAN, "dwell": 10}),
]


def the_study(quantity: str, options: dict[str, Any]) -> dict[str, Any]:
    if "scan" in options:
        base = {"N": 385}
    else:
        base = {"N": 385, "Omega": 14}
    return {
        "study": "s",
        "quantity": quantity,
        "base": base,
        "options": options,
        "axes": {"c": [0]},
    }


@pytest.mark.compiled
@pytest.mark.parametrize(("function", "arguments", "options"), SAME)
def test_a_function_gives_what_a_study_does(function: Any, arguments: Any, options: Any) -> None:
    of_study = run_study(the_study(function.__name__, options)).isel(c=0)
    of_function = function(P, **arguments)
    assert set(of_function) == set(of_study) - {"message"}
    for variable, values in of_function.items():
        stored = of_study[variable]
        if "flag_meanings" in stored.attrs:
            stored = flag_names(stored)
        else:
            stored = stored.values
        np.testing.assert_array_equal(values.values, stored, err_msg=variable)


@pytest.mark.parametrize(
    ("call", "name"),
    [
        (lambda: dm.critical_speed(P, (14, 15), [5, "x"]), "horizon.1='x'"),
        (lambda: dm.critical_speed(P, (14, 15), step=-1), "scan.step=-1"),
        (lambda: dm.outcome(P, 10, start={"u": "x"}), "start.u='x'"),
        (lambda: dm.basins(P, n_starts=0), "n_starts=0"),
    ],
)
def test_a_wrong_argument_is_named_as_the_function_has_it(
    call: Callable[[], object], name: str
) -> None:
    with pytest.raises(dm.ParameterError) as error:
        call()
    assert any(fault.startswith(name) for fault in error.value.faults), error.value.faults


def test_a_study_of_cases_is_a_tree() -> None:
    case = {"title": "one", "parameters": {"N": 385, "Omega": 14}, "t_end": 0.1}
    tree = run_study({"study": "s", "cases": {"A": case}})
    assert json.loads(tree["A"].attrs["parameters"])["N"] == 385
