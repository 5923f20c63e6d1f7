"""Motions that begin where another one ended."""

from __future__ import annotations

import numpy as np
import pytest

from disc_model.data.variables import flag_names
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.studies.faults import StudyError
from disc_model.studies.grids.quantities.preparation import prepared
from disc_model.studies.grids.quantities.schema import BifurcationOptions
from disc_model.studies.grids.schema import parse_grid
from tests.studies.grids.conftest import computed

AFTER = {"prepare": {"parameters": {"N": 385, "Omega": 15.1}, "time": 56}, "transient": 1}


@pytest.mark.compiled
def test_motions_may_start_after_a_separation() -> None:
    raw = {"study": "b", "quantity": "bifurcation", "base": {"N": 385}, "axes": {"Omega": [5, 15]}}
    before = computed(**(raw | {"options": {"transient": 1, "samples": 3}}))
    after = computed(**(raw | {"options": AFTER | {"samples": 3}}))
    assert before["separations"].values.tolist() == [0, 0]
    assert after["separations"].sel(Omega=15) > 50
    assert flag_names(before["phase"]).tolist() != [["none"] * 3] * 2
    start = simulate(Parameters(N=385, Omega=15.1), 56).final_state.replace(time=0.0, time_low=0.0)
    run = simulate(Parameters(N=385, Omega=15), 1.0, initial_state=start)
    assert after["first_separation"].sel(Omega=15) == run.first_separation


@pytest.mark.parametrize(
    ("parameters", "faults"),
    [
        ({"Omgea": 15}, ["Omgea = 15: unknown parameter, did you mean Omega?"]),
        ({"m": -1, "contact": "open"}, ["m = -1: must be > 0", "contact = 'open': must be 'separable' or 'bonded'"]),
        ({"mu_s": 0.2, "mu_k": 0.3}, ["mu_k = 0.3: must be <= mu_s=0.2"]),
        ({"n_diameters": "auto"}, ["n_diameters = 'auto': must be a whole number, that of the points"]),
    ],
)
@pytest.mark.parametrize(("quantity", "more"), [("bifurcation", {}), ("lyapunov", {"duration": 1})])
def test_a_preparation_is_checked_before_anything_runs(
    quantity: str, more: dict, parameters: dict, faults: list[str]
) -> None:
    given = {"prepare": {"parameters": parameters, "time": 1}, "transient": 1} | more
    raw = {"study": "b", "quantity": quantity, "axes": {"N": [1], "Omega": [15]}}
    with pytest.raises(StudyError) as error:
        parse_grid(raw | {"options": given})
    assert error.value.faults == tuple(f"options.prepare.parameters.{fault}" for fault in faults)


def test_any_parameter_may_be_prepared_however_it_is_spelled() -> None:
    def read(**parameters: object) -> dict:
        raw = {"prepare": {"parameters": parameters, "time": 1}, "transient": 1}
        return BifurcationOptions.model_validate(raw).model_dump()["prepare"]["parameters"]

    assert read() == {}
    found = read(normalization="orthonormal", N="3e2", n_diameters=4.0, mu_k=0.5, contact="bonded")
    # mu_k may be right: the point has its own mu_s
    assert found == {"normalization": "orthonormal", "N": 300.0, "n_diameters": 4, "mu_k": 0.5, "contact": "bonded"}
    assert isinstance(found["n_diameters"], int)


def test_a_preparation_that_fails_is_reported() -> None:
    options = {"prepare": {"parameters": {"mu_k": 0.9}, "time": 1}, "transient": 1}
    raw = {"study": "b", "quantity": "bifurcation", "base": {"N": 385}, "axes": {"Omega": [15]}, "options": options}
    found = computed(**raw).isel(Omega=0)
    assert flag_names(found["status"]) == "failed"
    assert "ParameterError" in str(found["message"].item())


def test_a_preparation_is_another_motions_end() -> None:
    from disc_model.studies.grids.quantities.schema import BifurcationOptions

    p = Parameters(N=200, Omega=50, n_diameters=1)
    asked = {"transient": 0.1, "samples": 1, "tol": 1e-8}
    assert prepared(p, BifurcationOptions(**asked)) is None
    start = prepared(p, BifurcationOptions(**asked, prepare={"parameters": {"N": 100}, "time": 0.01}))
    expected = simulate(p.replace(N=100), 0.01, tol=1e-8).final_state
    np.testing.assert_array_equal(start.a, expected.a)
    assert start.time == 0
