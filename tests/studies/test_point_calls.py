"""Calls in Python that pages offer for points of studies."""

from typing import Any

import pytest
import xarray as xr

import disc_model as dm
from disc_model.parameters import Parameters
from disc_model.studies.point_calls import SEARCHES, call_of
from disc_model.studies.registry import quantity_names, quantity_of
from tests.studies.test_quantities import OPTIONS


@pytest.mark.compiled
@pytest.mark.parametrize("name", quantity_names())
def test_the_call_for_a_point_runs(name: str) -> None:
    """That of a quantity which varies the speed lacked the speed, and ended in an error."""
    quantity: Any = quantity_of(name).model_validate(OPTIONS[name])
    call = call_of(name, quantity)
    assert {*call.begins} == {*quantity.scanned}
    # as the page puts it together, with what a study states
    values = {"n_diameters": 1, "N": 200, "Omega": 15} | call.begins
    arguments = ", ".join(f"{key}={value!r}" for key, value in values.items())
    text = f"{call.before}dm.Parameters({arguments}){call.after}"
    result = eval(text, {"dm": dm})
    if name in SEARCHES:
        assert isinstance(result, xr.Dataset)
        computed: Any = quantity_of(name).model_validate_json(result.attrs["options"])
        assert computed.scan.values == quantity.scan.values
        assert computed.model_copy(update={"scan": quantity.scan}) == quantity
    else:
        assert isinstance(result, Parameters)
