"""Calls in Python that pages offer for points of studies; that they give the values of points is
tested where pages put them together."""

import json
from typing import Any

import pytest
import xarray as xr

import disc_model as dm
from disc_model.studies.point_calls import call_of
from disc_model.studies.registry import quantity_names, quantity_of
from tests.studies.test_quantities import OPTIONS


@pytest.mark.compiled
@pytest.mark.parametrize("name", quantity_names())
def test_each_recipe_has_its_variables(name: str) -> None:
    """With the options of the study: `escape` was computed without early ends, and its call with."""
    quantity: Any = quantity_of(name).model_validate(OPTIONS[name])
    call = call_of(name, quantity)
    assert {*call.begins} == {*quantity.scanned}
    assert {*call.columns} <= {*quantity.COLUMNS}
    assert json.loads(json.dumps(call.plain))["recipes"] == json.loads(
        json.dumps(call.plain["recipes"])
    )
    case = dm.Parameters(**({"n_diameters": 1, "N": 200, "Omega": 15} | call.begins))
    for recipe in call.recipes:
        arguments = ", ".join(["case", *recipe.arguments])
        found = eval(f"{recipe.function}({arguments})", {"dm": dm, "case": case})
        for variable, number in recipe.numbers.items():
            if number:
                eval(number, {"found": found})
            else:
                assert variable in found
        if isinstance(found, xr.Dataset) and name not in ("regions", "sensitivity"):
            computed: Any = quantity_of(name).model_validate_json(found.attrs["options"])
            same = quantity.model_dump(exclude={"scan"})
            assert computed.model_dump(exclude={"scan"}) == same
            if "scan" in quantity.model_fields_set:
                assert computed.scan.values == quantity.scan.values


def test_options_of_a_study_are_those_of_its_call() -> None:
    options = {"horizon": 450, "early_end": False, "tol": 1e-9}
    [recipe] = call_of("outcome", quantity_of("outcome").model_validate(options)).recipes
    assert recipe.arguments == ["horizon=450.0", "early_end=False", "tol=1e-09"]
    cycles = call_of("floquet", quantity_of("floquet").model_validate({"tol": 1e-10}))
    assert cycles.recipes[0].arguments == ["tol=1e-10"]
