"""Quantities of a case, sweeps and studies as functions: the same numbers as those of the
workflow's batches."""

import json
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest
import xarray as xr

import disc_model as dm
from disc_model.data.variables import flag_names
from disc_model.studies.functions import run_study, sweep

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
    base = {"N": 385} if "scan" in options else {"N": 385, "Omega": 14}
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
        stored = flag_names(stored) if "flag_meanings" in stored.attrs else stored.values
        np.testing.assert_array_equal(values.values, stored, err_msg=variable)


def test_a_sweep_has_a_status_for_each_point_and_the_same_numbers_with_any_workers() -> None:
    axes = {"Omega": [10.0, 14.0], "mu_k_over_mu_s": [0.6, 1.2]}
    swept = sweep(dm.floquet, P, **axes)
    assert swept["status"].values.tolist() == [["ok", "failed"]] * 2
    assert "mu_k=0.48: must be <= mu_s=0.4" in swept["message"].values[0, 1]
    assert np.isnan(swept["growth_rate"].values[:, 1]).all()
    for i, Omega in enumerate(axes["Omega"]):
        cycle = dm.floquet(P.replace(Omega=Omega, mu_k_over_mu_s=0.6))
        assert swept["growth_rate"].values[i, 0] == cycle.growth_rate
        np.testing.assert_array_equal(swept["multipliers"].values[i, 0], cycle.multipliers)
    xr.testing.assert_identical(sweep(dm.floquet, P, workers=2, **axes), swept)
    xr.testing.assert_identical(sweep(dm.floquet, P, workers=2, processes=True, **axes), swept)


def test_a_sweep_takes_any_function_and_passes_its_arguments() -> None:
    swept = sweep(
        lambda case, factor: {"load": factor * case.N, "word": "x"}, P, N=[1, 2], factor=3
    )
    assert swept["load"].values.tolist() == [3, 6]
    assert swept["word"].values.tolist() == ["x", "x"]
    assert sweep(dm.simulate, P, t_end=0.1, N=[200])["n_separations"].values.tolist() == [0]
    with pytest.raises(
        dm.ParameterError, match=r"Omga=.*: is no number of the case.*did you mean Omega"
    ):
        sweep(dm.floquet, P, Omga=[1])
    assert sweep(partial(dm.floquet, tol=1e-10), P, N=[200]).attrs["function"] == "partial"


@pytest.mark.parametrize("workers", [1, 2])
def test_a_wrong_argument_of_the_function_ends_a_sweep_at_once(workers: int) -> None:
    called = []

    def function(case: dm.Parameters, factor: float, tol: float = 1e-12) -> float:
        called.append(case.N)
        return factor * dm.floquet(case, tol=tol).growth_rate

    for options, message in (
        ({"factor": 1, "tol": -1}, r"^tol=-1: must be within 1e-14 and 1e-06$"),
        ({"tol": -1}, r"^factor: is required by function$"),
    ):
        with pytest.raises(dm.ParameterError, match=message):
            sweep(function, P, N=np.linspace(200, 300, 50), workers=workers, **options)
    assert len(called) <= 2 * workers  # those that other workers had begun
    with pytest.raises(dm.ParameterError, match=r"^t_end: is required"):
        sweep(dm.simulate, P, N=[200], workers=workers)


def test_an_argument_that_is_refused_later_on_fails_its_own_point() -> None:
    def function(case: dm.Parameters, length: float) -> float:
        if case.N > 150:
            raise dm.ParameterError(f"length={length}: must be short at such a load")
        return case.N * length

    swept = sweep(function, P, N=[100, 200], length=2.0)
    assert swept["status"].values.tolist() == ["ok", "failed"]
    assert swept["message"].values[1].startswith("ParameterError: length=2.0: must be short")
    np.testing.assert_array_equal(swept["value"], [200.0, np.nan])
    with pytest.raises(dm.ParameterError, match="must be short"):
        sweep(function, P, N=[200, 100], length=2.0)


def test_an_argument_of_the_function_is_no_axis_though_a_parameter_has_its_name() -> None:
    swept = sweep(lambda case, k: k + case.k, P, N=[1, 2], k=3.0)
    assert swept["value"].dims == ("N",)
    assert swept["value"].values.tolist() == [3.0 + P.k] * 2


def test_what_a_sweep_gathers_keeps_its_kind() -> None:
    def function(case: dm.Parameters) -> xr.Dataset:
        values = {"light": case.N < 150, "heavy": case.N > 150}
        if case.N > 150:
            del values["light"]
        return xr.Dataset(values, attrs={"message": f"of {case.N:g} N"})

    swept = sweep(function, P, N=[100, 200])
    assert swept["heavy"].dtype == bool
    assert swept["heavy"].values.tolist() == [False, True]
    np.testing.assert_array_equal(swept["light"], [1.0, np.nan])
    assert swept["message"].values.tolist() == ["of 100 N", "of 200 N"]


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
