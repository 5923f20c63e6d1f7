"""Sweeps: what is called, by whom, and what is gathered."""

import dataclasses
import inspect
import json
import re
import sys
import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from functools import partial
from multiprocessing.pool import ThreadPool
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from matplotlib import pyplot

import disc_model as dm
from disc_model.figures.shown import label, shown
from disc_model.studies import workers
from disc_model.studies.sweeps import sweep
from disc_model.studies.varied_arguments import Arguments
from disc_model.studies.whole_study import run_study
from tests.refusals import refusal

P = dm.Parameters(N=385, Omega=14)


# ---- What is called, and what is gathered


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
    with refusal(r"Omga=.*: is no number of the case.*did you mean Omega"):
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
        with refusal(message):
            sweep(function, P, N=np.linspace(200, 300, 50), workers=workers, **options)
    assert len(called) <= 2 * workers  # those that other workers had begun
    with refusal(r"^t_end: is required"):
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
    with refusal("must be short"):
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


def test_arrays_of_other_lengths_end_in_what_is_missing() -> None:
    """Complex numbers and words too; whole numbers become real ones, so that they can be missing."""

    def function(case: dm.Parameters) -> dict[str, Any]:
        count = int(case.N)
        result: dict[str, Any] = {
            "roots": np.arange(count) + 1j,
            "words": np.array(["ab", "c", "d"][:count]),
            "numbers": np.arange(count),
            "plane": np.zeros((2, 2)),
        }
        if count > 1:
            result["late"] = "x"
        return result

    swept = sweep(function, P, N=[1, 3])
    np.testing.assert_array_equal(swept["roots"], [[1j, np.nan, np.nan], [1j, 1 + 1j, 2 + 1j]])
    assert swept["words"].values.tolist() == [["ab", "", ""], ["ab", "c", "d"]]
    np.testing.assert_array_equal(swept["numbers"], [[0.0, np.nan, np.nan], [0.0, 1.0, 2.0]])
    assert swept["late"].values.tolist() == ["", "x"]
    assert "plane" not in swept, "of one dimension at most"
    assert swept["roots"].dims == ("N", "roots_index")


def test_coordinates_of_a_function_stay_its_own() -> None:
    def function(case: dm.Parameters) -> xr.Dataset:
        times = np.array([0.0, 0.5, 1.0])
        return xr.Dataset({"height": ("time", case.N * times)}, {"time": times})

    swept = sweep(function, P, N=[1, 2], Omega=[3.0])
    assert swept["height"].dims == ("N", "Omega", "time")
    assert swept["time"].dims == ("time",)
    np.testing.assert_array_equal(swept["height"].sel(N=2).squeeze(), [0.0, 1.0, 2.0])


def test_results_of_each_class_have_their_own_units_and_names() -> None:
    """A growth rate is of a cycle or of steady sliding, by whose it is."""
    case = P.replace(n_diameters=1)
    cycle = sweep(dm.floquet, case, N=[300])
    assert cycle["growth_rate"].attrs["long_name"] == "growth rate of the cycle"
    assert cycle["growth_rate"].attrs["missing"] == "there is no cycle"
    assert cycle["sliding_growth_rate"].attrs["long_name"].endswith("steady sliding")
    assert cycle["period"].attrs["units"] == "s"
    assert cycle["tol"].attrs["units"] == "1"
    found = dm.floquet(case.replace(N=300))
    assert cycle["stable"].item() is found.stable
    assert cycle["sliding_growth_rate"].item() == found.sliding.growth_rate
    sliding = sweep(dm.steady_sliding, case, N=[300])
    assert sliding["growth_rate"].attrs["long_name"] == "growth rate of steady sliding"
    assert sliding["psi"].attrs["units"] == "rad"
    for name in ("a", "b", "alpha", "beta", "eigenvalues"):
        assert {"units", "long_name"} <= {*sliding[name].attrs}, name
    # modes have amplitudes of kg^-1/2, so that displacements are in m
    assert sliding["a"].attrs["units"] == "kg0.5 m"
    assert sliding["beta"].attrs["units"] == "kg0.5 m s-1"
    critical = sweep(dm.critical, case, N=[300], name="mu_s", bounds=(0.3, 0.5), points=2)
    assert critical["value"].attrs["long_name"] == "critical value of mu_s"
    exponents = sweep(dm.lyapunov_exponents, case, N=[300], duration=0.2, count=1)
    assert exponents["exponents"].attrs["units"] == "s-1"
    assert exponents["duration"].attrs["units"] == "s"
    assert exponents["separations"].attrs["units"] == "1"


SWEPT: dict[str, dict[str, Any]] = {
    "basins": {"energies": [1e-3], "horizon": 2, "n_bisection_directions": 0},
    "choose_modes": {},
    "continue_cycle": {"name": "Omega", "bounds": (13.9, 14.1)},
    "coupled_natural_frequencies": {},
    "critical": {"name": "mu_s", "bounds": (0.3, 0.5), "points": 2},
    "critical_speed": {"bounds": (13, 14), "horizon": 3},
    "floquet": {},
    "hysteresis": {"bounds": (13, 14), "step": 1, "dwell": 5, "max_dwell": 5},
    "lyapunov_exponents": {"duration": 0.2, "count": 1},
    "outcome": {"horizon": 2},
    "pinned_range": {"frequency": 135.0},
    "residual_flexibility": {},
    "simulate": {"t_end": 0.1},
    "steady_sliding": {},
}
"""Functions whose results a sweep gathers, with few options."""
NOT_SWEPT = {"initial_state", "snapshots", "deflection", "plate_modes", "plot_modes", "fit"}
NOT_SWEPT |= {"neutral_curves"}
"""Those of a case whose results are tables, pictures, states or several curves."""


def test_all_functions_of_a_case_are_known() -> None:
    of_a_case = {
        name
        for name in dm.__all__
        if inspect.isfunction(getattr(dm, name))
        and "case" in inspect.signature(getattr(dm, name)).parameters
    }
    assert of_a_case - {"sweep"} == SWEPT.keys() | NOT_SWEPT


@pytest.mark.parametrize("name", SWEPT)
def test_all_that_a_sweep_gathers_has_a_unit_and_a_name(name: str) -> None:
    """Crossings of `critical` and residuals of `floquet` had none."""
    swept = sweep(getattr(dm, name), P.replace(n_diameters=1), N=[300], **SWEPT[name])
    assert swept["status"].item() != "failed", swept["message"].item()
    for key, variable in swept.variables.items():
        assert variable.attrs.get("long_name"), key
        assert variable.dtype.kind in "UOb" or variable.attrs.get("units"), key
        missing = variable.dtype.kind in "fc" and np.isnan(variable.values).any()
        assert not missing or variable.attrs["missing"], key


def test_what_nan_means_is_in_sweeps_and_not_on_axes() -> None:
    """Balances of energy are nan but where all steps are audited, and nothing said so."""
    swept = sweep(dm.simulate, P.replace(n_diameters=1), N=[300], t_end=0.1)
    why = {
        name: swept[name].attrs["missing"] for name in ("energy_residual_inplane", "surface_speed")
    }
    assert why["energy_residual_inplane"] == "not every step is audited"
    assert why["surface_speed"] == "friction acts on no surface that moves"
    assert "nan" not in label(shown(swept)["surface_speed"])


def test_numbers_among_words_are_words() -> None:
    """The sweep was lost when all of it had been computed."""
    swept = sweep(lambda case: {"x": 1.5 if case.N < 150 else "none"}, P, N=[100, 200])
    assert swept["x"].values.tolist() == ["1.5", "none"]


def test_what_a_sweep_would_leave_out_is_refused() -> None:
    """Samples, curves and fitted parameters were computed at each point and lost without a word."""
    windows = {"late": dm.Window(last=0.1, rate=1e3)}
    with refusal(r"windows=\{'late'.*a sweep keeps no samples: sweep a function of your own"):
        sweep(dm.simulate, P, N=[300], t_end=0.2, windows=windows)
    plane = {"Omega": (10, 14), "mu_k": (0.2, 0.3)}
    with refusal(r"function=neutral_curves: a sweep keeps no curves"):
        sweep(dm.neutral_curves, P, N=[300], bounds=plane, lines=[0.25])
    with refusal(r"function=fit: a sweep keeps no fitted parameters"):
        sweep(dm.fit, P, N=[300], vary=["mu_s"], data=[])
    assert sweep(dm.simulate, P, N=[300], t_end=0.2, windows=None)["status"].item() == "ok"


def test_a_sweep_gathers_nothing_private_of_a_state() -> None:
    swept = sweep(dm.initial_state, P, N=[300])
    assert [name for name in swept if str(name).startswith("_")] == []
    assert "psi" in swept


def test_a_sweep_gathers_branches_with_their_parameter() -> None:
    """Points of branches had neither their speeds nor multipliers."""
    options: dict[str, Any] = {"name": "Omega", "bounds": (14.8, 15.2)}
    case = P.replace(Omega=15)
    swept = sweep(dm.continue_cycle, case, N=[385, 390], **options)
    branch = dm.continue_cycle(case, **options).to_dataset()
    first = swept.sel(N=385).isel(point=slice(branch.sizes["point"]))
    for name in ("Omega", "growth_rate", "range", "multipliers"):
        np.testing.assert_array_equal(first[name], branch[name])
    assert swept["Omega"].attrs["units"] == "rad s-1"
    assert swept["ended"].sel(N=385).item() == branch.attrs["ended"]
    for branches in (swept, swept.sel(N=385)):
        with refusal(r"holds branches: draw one by disc_model\.Branch\.from_dataset\(study"):
            dm.plot_sweep(branches)


def swept_branches() -> xr.Dataset:
    """Branches of different lengths, and a point without one."""
    case = P.replace(Omega=15)
    options = {"name": "Omega", "bounds": (14.8, 15.2), "values": [15.15]}
    return sweep(dm.continue_cycle, case, N=[300, 385, -1], **options)


@pytest.mark.parametrize("N", [300, 385])
def test_a_point_of_a_sweep_is_the_branch_of_a_direct_call(N: float) -> None:
    """It was refused: padded with nan, its attributes those of the sweep, its counts real numbers."""
    swept = swept_branches()
    branch = dm.continue_cycle(P.replace(Omega=15, N=N), "Omega", (14.8, 15.2), values=[15.15])
    for point in (swept.sel(N=N), swept.sel(N=[N])):
        again = dm.Branch.from_dataset(point)
        xr.testing.assert_identical(again.to_dataset(), branch.to_dataset())
        assert repr(again) == repr(branch)
        assert again.case == branch.case
        assert again.state(-1) == branch.state(-1)
        assert again.plot().get_ylabel() == branch.plot().get_ylabel()


NEAR_14: dict[str, Any] = {
    "case": P.replace(N=385, Omega=14),
    "name": "Omega",
    "bounds": (13.9, 14.1),
}
"""A short branch of cycles."""


def assert_same_variable(name: str, found: dm.Branch, expected: dm.Branch) -> None:
    """Datasets of two branches have the same values of a variable."""
    values = found.to_dataset()[name]
    of_expected = expected.to_dataset()[name]
    np.testing.assert_array_equal(values, of_expected)


def test_branches_are_whole_where_an_argument_has_the_name_of_a_variable() -> None:
    """The axis took the place of the branch's variable, and pictures failed."""
    swept = sweep(dm.continue_cycle, **NEAR_14, over={"direction": [1, -1]})
    first = dm.Branch.from_dataset(swept.isel(direction=0))
    expected = dm.continue_cycle(**NEAR_14, direction=1)
    assert_same_variable("direction", first, expected)


def test_branches_are_whole_where_a_parameter_has_the_name_of_a_variable() -> None:
    swept = sweep(dm.continue_cycle, **NEAR_14, a=[0.044, 0.045])
    first = dm.Branch.from_dataset(swept.isel(a=0))
    expected = dm.continue_cycle(**NEAR_14)
    assert_same_variable("a", first, expected)


def profile(case: dm.Parameters, count: int = 3) -> xr.Dataset:
    """An array with the name of an argument."""
    return xr.Dataset({"count": ("place", np.arange(3.0))})


def test_a_variable_that_is_no_argument_is_not_taken_for_one() -> None:
    with refusal("returned count, which is a coordinate of the sweep: give it another name"):
        sweep(profile, P, over={"count": [1, 2]})


def test_branches_of_discs_with_fewer_modes_have_no_modes_of_others() -> None:
    options = {"name": "Omega", "bounds": (14.8, 15.2)}
    case = P.replace(N=300, Omega=15)
    swept = sweep(dm.continue_cycle, case, n_diameters=[-1, 4], **options)
    rigid = dm.Branch.from_dataset(swept.sel(n_diameters=-1))
    branch = dm.continue_cycle(case.replace(n_diameters=-1), **options)
    xr.testing.assert_identical(rigid.to_dataset(), branch.to_dataset())


def test_a_stored_sweep_has_its_branches(tmp_path: Path) -> None:
    swept = swept_branches()
    expected = dm.Branch.from_dataset(swept.sel(N=385)).to_dataset()
    dm.save(swept, tmp_path / "swept.nc")
    point = dm.load(tmp_path / "swept.nc").sel(N=385)
    xr.testing.assert_identical(dm.Branch.from_dataset(point).to_dataset(), expected)


def test_what_is_no_branch_of_a_sweep_is_refused() -> None:
    swept = swept_branches()
    with refusal(r"data: must be one branch of the sweep.*data\.isel\(N=0\)"):
        dm.Branch.from_dataset(swept)
    with refusal(r"data: must be a branch, but this point .* failed: ParameterError: N=-1: must"):
        dm.Branch.from_dataset(swept.sel(N=-1))
    for other in (swept.drop_vars("a").sel(N=300), sweep(dm.floquet, P, N=[300]).sel(N=300)):
        with refusal(r"must be a dataset of Branch\.to_dataset, or a point of a sweep"):
            dm.Branch.from_dataset(other)


def test_branches_of_a_function_of_ones_own_are_branches_too() -> None:
    """Its case may be another than that of the sweep."""

    def softer(case: dm.Parameters) -> dm.Branch:
        return dm.continue_cycle(case.replace(k_p=15000), "Omega", (13.9, 14.1))

    swept = sweep(softer, P, N=[300])
    branch = dm.Branch.from_dataset(swept.sel(N=300))
    assert branch.case == P.replace(N=300, k_p=15000)
    with refusal(r"holds branches: draw one by"):
        dm.plot_sweep(swept)


def test_values_of_a_search_are_in_the_unit_of_its_parameter() -> None:
    for name, unit in (("Omega", "rad s-1"), ("mu_k", "1")):
        bounds = (13.0, 14.0) if name == "Omega" else (0.2, 0.3)
        found = sweep(
            dm.critical, P.replace(n_diameters=1), N=[300], name=name, bounds=bounds, points=2
        )
        for key in ("value", "values", "crossings", "resolution"):
            assert found[key].attrs["units"] == unit, key


def test_what_computed_a_sweep_is_stated(tmp_path: Path) -> None:
    """Files of sweeps, branches and runs did not say by which version they were made."""
    case = P.replace(n_diameters=1)
    run = dm.simulate(case, 0.01)
    for data in (
        sweep(dm.steady_sliding, case, N=[300]),
        dm.outcome(case, 1),
        dm.continue_cycle(case, "Omega", (13.9, 14.1)).to_dataset(),
        run.to_tree(),
    ):
        assert json.loads(data.attrs["versions"])["disc_model"] == dm.__version__
    made_elsewhere = dataclasses.replace(run, versions='{"disc_model": "0.2.9"}')
    made_elsewhere.save(tmp_path / "run.nc")
    assert dm.Result.load(tmp_path / "run.nc").versions == made_elsewhere.versions
    assert dm.Result.load(tmp_path / "run.nc") == run


def test_a_sweep_states_its_base_and_its_function() -> None:
    swept = sweep(products, P.replace(mu_k_over_mu_s=0.5), N=[1, 2])
    assert json.loads(swept.attrs["base"])["mu_k_over_mu_s"] == 0.5
    assert json.loads(swept.attrs["parameters"])["Omega"] == 14
    assert swept.attrs["function"] == "products"
    assert swept["N"].dtype.kind == "f", "also of whole numbers"
    assert swept["N"].attrs["units"] == "N"


def test_a_sweep_states_the_arguments_of_its_function(tmp_path: Path) -> None:
    """Without its horizon a map of outcomes cannot be repeated."""
    swept = sweep(dm.outcome, P, Omega=[14.0], horizon=1)
    options = json.loads(swept.attrs["options"])
    assert options["horizon"] == 1
    assert options["tol"] == 1e-10, "also what is as usual"
    dm.save(swept, tmp_path / "swept.nc")
    assert dm.load(tmp_path / "swept.nc").attrs["options"] == swept.attrs["options"]

    execution = dm.Execution(max_steps=10_000)
    simulated = sweep(dm.simulate, P, Omega=[14.0], t_end=0.2, execution=execution)
    assert "max_steps=10000" in json.loads(simulated.attrs["options"])["execution"]


# ---- Values that vary together

PAIRS = {"N": [385, 300, 385], "mu_k": [0.2, 0.25, 0.3]}


def products(case: dm.Parameters) -> dict[str, float]:
    """A quick function of a case, with other values wherever the case is another one."""
    return {"load": case.N * case.mu_k, "speed": case.Omega}


def test_paired_samples_are_one_dimension_with_a_point_for_each_pair() -> None:
    swept = sweep(dm.floquet, P, zip=PAIRS)
    assert swept["growth_rate"].dims == ("N_mu_k",)
    assert swept["N"].dims == swept["mu_k"].dims
    assert swept["mu_k"].dims == ("N_mu_k",)
    assert swept["N"].attrs["units"] == "N"
    for i, (N, mu_k) in enumerate(zip(PAIRS["N"], PAIRS["mu_k"], strict=True)):
        cycle = dm.floquet(P.replace(N=N, mu_k=mu_k))
        assert swept["growth_rate"].values[i] == cycle.growth_rate
    np.testing.assert_array_equal(swept["N"], PAIRS["N"])


def test_pairs_are_called_as_those_of_a_study() -> None:
    raw = {"study": "s", "quantity": "floquet", "base": {"Omega": 14}, "zip": PAIRS}
    study = run_study(raw)
    swept = sweep(dm.floquet, P, zip=PAIRS)
    assert study["growth_rate"].dims == swept["growth_rate"].dims


def test_pairs_go_with_axes() -> None:
    swept = sweep(products, P, zip=PAIRS, Omega=[10, 12])
    assert swept["load"].dims == ("Omega", "N_mu_k")
    np.testing.assert_allclose(swept["load"].values, [[77.0, 75.0, 115.5]] * 2)
    np.testing.assert_array_equal(swept["speed"], [[10.0] * 3, [12.0] * 3])


@pytest.mark.parametrize(
    "table",
    [
        pd.DataFrame(PAIRS, index=[7, 8, 9]),
        {"N": ["385 N", "0.3 kN", "385.0 N"], "mu_k": np.array(PAIRS["mu_k"])},
        xr.Dataset({name: ("sample", values) for name, values in PAIRS.items()}),
    ],
    ids=["pandas", "units", "xarray"],
)
def test_pairs_are_read_from_tables(table: Any) -> None:
    xr.testing.assert_identical(sweep(products, P, zip=table), sweep(products, P, zip=PAIRS))


@pytest.mark.parametrize(
    ("table", "message"),
    [
        (
            {"N": [1, 2], "mu_k": [0.1]},
            r"^zip={'N': 2, 'mu_k': 1}: must have columns of one length",
        ),
        ({"N": [1, 2], "mu_q": [0.1, 0.2]}, r"^zip.mu_q: is no number .*did you mean"),
        ({"N": [float("nan")]}, r"^zip.N\[0\]=nan: must be a finite number$"),
        ({"N": [-1, None]}, r"^zip.N\[0\]=-1: must be >= 0; zip.N\[1\]=None: must be a number$"),
        ({"N": [1, "1 s"]}, r"^zip.N\[1\]='1 s': must be a number in N"),
        ({"N": [1, "much"], "mu_k": [0.1, 0.2]}, r"^zip.N\[1\]='much': must be a number$"),
        ({"N": [1, True]}, r"^zip.N\[1\]=True: must be a number$"),
        (
            {"contact": ["rigid"]},
            r"^zip.contact\[0\]='rigid': must be 'unilateral' or 'bilateral'$",
        ),
        ({"N": []}, r"^zip.N=\[\]: must have one value or more"),
        ({"Omega": [1, 2]}, r"^zip.Omega: must not be an axis as well"),
        ({"Omgea": [1, 2], "N": [1, 2]}, r"^zip.Omgea: is no number .*known: a, a_over_b, b,"),
        ({"level": [1, 2], "N": [1, 2]}, r"^zip.level: is an argument of the function"),
        ({"levle": [1, 2], "N": [1, 2]}, r"^zip.levle: is no number .*did you mean level\?"),
        ({"message": [1, 2], "N": [1, 2]}, r"^zip.message: must have another name"),
        ({"rate": [1, "x"], "N": [1, 2]}, r"^zip.rate: is no number .*must hold words or numbers"),
        ({"contct": ["bilateral"], "N": [1]}, r"^zip.contct: is no number .*mean contact\?"),
        ({"sample": ["A"], "N": [1, 2]}, r"^zip={'N': 2, 'sample': 1}: must have columns of one"),
        ({"status": ["A"], "N": [1]}, r"^zip.status: must have another name"),
        ({"sample": ["A", "B"]}, r"^zip=.*: must have columns of values"),
        ({}, r"^zip={}: must have columns"),
        ([1, 2], r"^zip=\[1, 2\]: must have columns"),
    ],
)
def test_pairs_that_do_not_fit_are_refused(table: Any, message: str) -> None:
    with refusal(message):
        sweep(products_at, P, zip=table, Omega=[10.0])


def products_at(case: dm.Parameters, level: float = 1.0) -> dict[str, float]:
    """A function with an argument."""
    return {"load": level * case.N}


@pytest.mark.parametrize("errors", ["raise", "record"])
@pytest.mark.parametrize(
    ("wrong", "number", "rule"),
    [
        (-1, -1.0, "N=-1: must be >= 0"),
        ("-1 N", -1.0, "N=-1: must be >= 0"),
        (np.nan, np.nan, "N=nan: must be a finite number"),
        (None, np.nan, "N=nan: must be a finite number"),
        (np.inf, np.inf, "N=inf: must be a finite number"),
    ],
)
def test_a_number_that_cannot_be_fails_its_own_row(
    errors: str, wrong: Any, number: float, rule: str
) -> None:
    """It ended the sweep, and columns were said to differ in length, too."""
    table = {"N": [wrong, 300, 385], "mu_k": [0.2, 0.2, 0.24]}
    swept = sweep(products, P, zip=table, errors=errors)
    assert swept["status"].values.tolist() == ["failed", "ok", "ok"]
    assert swept["message"].values[0] == f"ParameterError: {rule}"
    np.testing.assert_allclose(swept["load"], [np.nan, 60.0, 92.4])
    np.testing.assert_array_equal(swept["N"], [number, 300.0, 385.0])


@pytest.mark.parametrize("errors", ["raise", "record"])
def test_a_number_that_cannot_be_fails_its_place_along_an_axis(errors: str) -> None:
    along = sweep(products, P, N=[-1, 300, 385], errors=errors)
    assert along["status"].values.tolist() == ["failed", "ok", "ok"]


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, None])
def test_a_value_that_has_no_place_along_an_axis_is_refused(value: float | None) -> None:
    """Its points failed, and pictures left them out without a word."""
    rule = "must be a finite number along an axis$"
    with refusal(rf"^N\[1\]=(nan|-?inf): {rule}"):
        sweep(products, P, N=[300, value, 385])
    if value is not None:
        with refusal(rf"^over\.level\[1\]=(nan|-?inf): {rule}"):
            sweep(products_at, P, over={"level": [1.0, value]}, N=[300])


def test_arguments_along_an_axis_have_units_and_names() -> None:
    """A step of speeds had none, which an axis of a picture then had not, either."""
    short = {"dwell": 0.1, "max_dwell": 0.1, "evaluation_time": 0.05}
    steps = {"step": [0.25, 0.5]}
    swept = sweep(dm.hysteresis, P, over=steps, bounds=(8, 8.5), **short)
    assert swept["step"].attrs == {"units": "rad s-1", "long_name": "step of the speeds"}
    tolerances = {"tol": [1e-8, 1e-10]}
    cycles = sweep(dm.floquet, P, over=tolerances)
    assert cycles["tol"].attrs["units"] == "1"
    runs = sweep(dm.simulate, P, over=tolerances, t_end=0.1)
    assert runs["tol"].attrs["units"] == "s"


WITHOUT_ONE_UNIT = ("precision", "values", "bounds", "lines", "direction", "start", "energies")
"""Arguments in the unit of a parameter that another one names, or of several values."""

VARIED = (
    "basins",
    "continue_cycle",
    "critical",
    "critical_speed",
    "floquet",
    "hysteresis",
    "lyapunov_exponents",
    "outcome",
    "pinned_range",
    "simulate",
)
"""Functions of a case whose arguments vary in sweeps."""


@pytest.mark.parametrize("name", VARIED)
def test_every_number_that_can_vary_has_a_unit(name: str) -> None:
    function = getattr(dm, name)
    parameters = inspect.signature(function).parameters
    arguments = Arguments(name, name, parameters)
    for argument in arguments.names:
        annotation = str(parameters[argument].annotation)
        takes_numbers = re.search(r"\b(int|float)\b", annotation)
        if not takes_numbers or argument in WITHOUT_ONE_UNIT:
            continue
        attributes = arguments.attributes(argument)
        assert "units" in attributes, argument


def test_a_wrong_argument_is_told_at_the_first_point_that_is_a_case() -> None:
    with refusal(r"^tol=-1: must be within"):
        sweep(dm.floquet, P, zip={"N": [-1, 300], "mu_k": [0.2, 0.2]}, tol=-1)


@pytest.mark.parametrize("values", [[15, 14, 14], [15, 14, "14 rad/s"], [14.0, 15, 14]])
def test_a_value_twice_along_an_axis_is_refused(values: list[Any]) -> None:
    """The same points were computed twice without a word; rows of a table may be alike."""
    with refusal(r"^Omega\[2\]=14: must not be given twice"):
        sweep(products, P, Omega=values)
    assert sweep(products, P, zip={"Omega": values, "N": [1, 1, 1]}).sizes == {"Omega_N": 3}


def test_counts_are_whole_numbers_where_none_is_missing() -> None:
    swept = sweep(dm.simulate, P, t_end=0.1, N=[200, 300])
    assert swept["steps"].dtype.kind == "i"
    failed = sweep(dm.simulate, P, t_end=0.1, N=[200, -1])
    np.testing.assert_array_equal(failed["steps"], [swept["steps"].values[0], np.nan])


@pytest.mark.parametrize("values", [np.ones((2, 2)), [[1.0, 2.0], [3.0]]])
def test_an_axis_of_two_dimensions_is_one_fault(values: Any) -> None:
    """Each of its rows was told to be no number."""
    with refusal(r"values in one dimension") as caught:
        sweep(products, P, Omega=values)
    assert len(caught.value.faults) == 1
    with refusal(r"^zip.Omega=.*one dimension") as caught:
        sweep(products, P, zip={"Omega": values, "N": [1.0, 2.0]})
    assert len(caught.value.faults) == 1


def alone() -> float:
    """A function that takes no case."""
    return 3.0


def by_name(*, case: dm.Parameters) -> float:
    """A function that takes a case only by its name."""
    return case.N


@pytest.mark.parametrize("function", [alone, by_name])
def test_a_function_must_take_a_case(function: Any) -> None:
    """The error was Python's, about positional arguments."""
    with refusal("must take a case first"):
        sweep(function, P, Omega=[10.0, 12.0])


@pytest.mark.parametrize(
    ("name", "units", "meaning"),
    [
        ("omega_1_0", "rad s-1", "natural frequency of the mode (1, 0)"),
        ("amplitude_0_2", "kg^-1/2", "amplitude of the mode (0, 2)"),
        ("damping_ratio_0_2", "1", "damping ratio of the mode (0, 2)"),
    ],
)
def test_numbers_of_modes_have_units_and_names_along_axes(
    name: str, units: str, meaning: str
) -> None:
    """Their coordinates had no attributes, and pictures showed the bare name."""
    disc = dm.Disc(diameters=[1, 0], circles=[0, 2], omega=[1500, 1800], amplitude=[1, 2])
    case = P.replace(disc=disc, r_0=0.1)
    found = sweep(products, case, **{name: [case.numbers[name], 1600.0]})
    assert {key: found[name].attrs[key] for key in ("units", "long_name")} == {
        "units": units,
        "long_name": meaning,
    }
    assert dm.plot_sweep(found).get_xlabel().replace("\n", " ").startswith(meaning.capitalize())
    pyplot.close("all")


@pytest.mark.parametrize("as_index", [False, True])
def test_words_of_a_table_stay_beside_its_samples(as_index: bool, tmp_path: Path) -> None:
    """A column of names was refused, as it is no number of the case."""
    names = ["A", "B", None]
    table = pd.DataFrame({"sample": names, **PAIRS, "new": [True, False, True]})
    if as_index:
        table = table[:2].set_index("sample")
    found = sweep(products, P, zip=table)
    assert found["sample"].values.tolist() == ["A", "B", ""][: len(table)]
    assert found["sample"].dims == found["new"].dims == ("N_mu_k",)
    assert found["new"].values.tolist() == table["new"].tolist()
    expected = sweep(products, P, zip={name: table[name] for name in PAIRS})
    xr.testing.assert_identical(found.drop_vars(["sample", "new"]), expected)
    dm.save(found, tmp_path / "found.nc")
    xr.testing.assert_identical(dm.load(tmp_path / "found.nc"), found)


LABORATORY = pd.DataFrame({**PAIRS, "temperature": [20.5, np.nan, 22], "Unnamed: 0": [0, 1, 2]})


def test_other_numbers_of_a_table_stay_beside_its_samples(tmp_path: Path) -> None:
    """A column of numbers that the case does not have was refused."""
    with pytest.warns(dm.ImplausibleValue) as caught:
        found = sweep(products, P, zip=LABORATORY)
    assert [str(each.message) for each in caught] == [
        "temperature and Unnamed_0: no number of the case, kept beside the samples"
    ]
    assert found["temperature"].dims == ("N_mu_k",)
    assert found["temperature"].values.tolist()[::2] == [20.5, 22]
    assert np.isnan(found["temperature"].values[1])
    assert found["Unnamed_0"].values.tolist() == [0, 1, 2]
    expected = sweep(products, P, zip=PAIRS)
    xr.testing.assert_identical(found.drop_vars(["temperature", "Unnamed_0"]), expected)
    dm.save(found, tmp_path / "found.nc")
    xr.testing.assert_identical(dm.load(tmp_path / "found.nc"), found)


@pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")
def test_other_numbers_are_drawn_over_where_they_are_asked_for() -> None:
    first = LABORATORY[["temperature", "Unnamed: 0", "N", "mu_k"]]
    found = sweep(products, P, zip=first)
    usual = dm.plot_sweep(found, "load")
    assert usual.get_xlabel() == "Preload N (N)"
    asked = dm.plot_sweep(found, "load", x="temperature")
    assert asked.get_xlabel() == "Temperature"
    pyplot.close("all")


def test_a_name_of_several_words_stays_a_coordinate_in_a_file(tmp_path: Path) -> None:
    """It became a variable there, since files separate the names of coordinates by spaces."""
    found = sweep(products, P, zip={"N": [300, 320], "sample name": ["A", "B"]})
    dm.save(found, tmp_path / "found.nc")
    assert dm.load(tmp_path / "found.nc")["sample_name"].values.tolist() == ["A", "B"]
    xr.testing.assert_identical(dm.load(tmp_path / "found.nc"), found)


@pytest.mark.parametrize(
    "words",
    [
        pd.Categorical(["A", "B"]),
        pd.array(["A", None], dtype="string"),
        np.array(["A", ""]),
        ["A", np.nan],
    ],
)
def test_words_of_any_kind_of_column_are_labels(words: Any) -> None:
    found = sweep(products, P, zip=pd.DataFrame({"sample": words, "N": [300.0, 320.0]}))
    assert found["sample"].values[0] == "A"
    assert found["sample"].values[1] in ("B", "")
    assert found["sample"].dtype.kind == "U"


def test_a_label_takes_the_name_of_an_argument_and_of_nothing_else() -> None:
    """`critical` returns its argument `name`, which xarray did not join with a column of names."""
    table = {"name": ["A", "B"], "mu_s": [0.4, 0.45]}
    options = {"bounds": (14, 15), "points": 2}
    found = sweep(partial(dm.critical, name="Omega"), P, zip=table, **options)
    assert found["name"].values.tolist() == ["A", "B"]
    with refusal(r"^clash: returned name, which is a coordinate"):
        sweep(clash, P, zip=table)


def clash(case: dm.Parameters) -> dict[str, Any]:
    return {"name": case.N}


@pytest.mark.parametrize("nothing", [None, {}, {"plane": np.zeros((2, 2))}, [P]])
def test_a_function_that_returns_nothing_is_named(nothing: Any) -> None:
    """The dataset had no variables, and the status "ok"."""

    def margins(case: dm.Parameters) -> Any:
        return nothing if case.N < 2 else 1.0

    with refusal(r"^margins: returned .*, and must return a number"):
        sweep(margins, P, N=[1, 3])
    later = sweep(margins, P, N=[3, 1])
    assert later["status"].values.tolist() == ["ok", "failed"]
    assert str(later["message"].values[1]).startswith("ParameterError: margins: returned ")


def test_truth_stays_to_be_selected_where_a_sample_failed() -> None:
    whole = sweep(lambda case: {"good": case.N > 2}, P, N=[1, 3])
    assert whole["good"].dtype == bool
    part = sweep(lambda case: {"good": case.N > 2}, P, zip={"N": [1, 3, 3], "mu_k": [0.2, 0.2, 9]})
    np.testing.assert_array_equal(part["good"], [0, 1, np.nan])
    assert part["good"].attrs["comment"] == "1 for True, 0 for False, nan where there is neither"
    assert part["N"][part["good"] == 1].values.tolist() == [3.0]


def test_results_of_pandas_and_xarray_keep_their_names() -> None:
    """Names of a Series were lost, and so were units of a DataArray."""
    series = sweep(lambda case: pd.Series({"a": case.N, "b": 2.0}), P, N=[1.0, 3.0])
    assert series["a"].values.tolist() == [1.0, 3.0]
    assert series["b"].dims == ("N",)
    array = sweep(lambda case: xr.DataArray(case.N, name="q", attrs={"units": "s"}), P, N=[1.0])
    assert array["q"].attrs == {"units": "s"}


# ---- Who makes the calls


class Backwards:
    """An executor whose calls end in another order than they were asked for."""

    def __init__(self) -> None:
        self.submitted = 0

    def submit(self, function: Callable[[Any], Any], argument: Any) -> "Future[Any]":
        self.submitted += 1
        future: Future[Any] = Future()
        work = partial(self._finish, future, function, argument)
        # later ones sooner
        threading.Timer(0.05 / self.submitted, work).start()
        return future

    def _finish(self, future: "Future[Any]", function: Callable[[Any], Any], argument: Any) -> None:
        future.set_result(function(argument))


def test_an_executor_of_the_user_makes_the_calls() -> None:
    expected = sweep(products, P, zip=PAIRS)
    backwards = Backwards()
    xr.testing.assert_identical(sweep(products, P, zip=PAIRS, executor=backwards), expected)
    assert backwards.submitted == 3
    with ThreadPoolExecutor(2) as pool:
        xr.testing.assert_identical(sweep(products, P, zip=PAIRS, executor=pool), expected)
    with ThreadPool(2) as others:  # has `map` but not `submit`
        xr.testing.assert_identical(sweep(products, P, zip=PAIRS, executor=others), expected)


def test_an_executor_computes_the_batches_of_a_study() -> None:
    raw = {
        "study": "s",
        "quantity": "floquet",
        "base": {"Omega": 14},
        "axes": {"N": [300, 385]},
        "batch": {"size": 1},
    }
    backwards = Backwards()
    xr.testing.assert_identical(run_study(raw, executor=backwards), run_study(raw))
    assert backwards.submitted == 2


def with_horizon(case: dm.Parameters, horizon: float) -> float:
    return horizon * case.Omega


def test_arguments_of_the_function_may_follow_the_case_without_a_name() -> None:
    """A duration had to be named, although the function takes it after the case."""
    case = dm.Parameters(N=385, Omega=15)
    swept = sweep(with_horizon, case, 200, Omega=[10, 20])
    options = json.loads(swept.attrs["options"])
    assert swept["value"].values.tolist() == [2000, 4000]
    assert options == {"horizon": 200}


@pytest.mark.parametrize(
    ("unnamed", "named", "told"),
    [
        ([1, 2], {}, "one more than the arguments of with_horizon"),
        ([1], {"horizon": 2}, "horizon=2: is given by its place already"),
        ([1], {"over": {"horizon": [2]}}, "horizon"),
    ],
)
def test_an_argument_without_a_name_is_one_of_the_function_that_is_not_given(
    unnamed: list[int], named: dict[str, Any], told: str
) -> None:
    case = dm.Parameters(N=385, Omega=15)
    with refusal(told):
        sweep(with_horizon, case, *unnamed, Omega=[10, 20], **named)


@pytest.mark.parametrize("workers", [1, 2])
def test_an_error_of_another_kind_names_the_point(workers: int) -> None:
    """One of hundreds of calls ended the sweep, and did not say which."""

    def found(case: dm.Parameters) -> float:
        if case.Omega == 12:
            raise RuntimeError("no answer")
        return case.Omega

    with pytest.raises(RuntimeError, match="no answer") as caught:
        sweep(found, dm.Parameters(N=385, Omega=15), Omega=[10, 12], mu_k=[0.4], workers=workers)
    remedy = 'with errors="record" a sweep goes on after such an error'
    note = f"at the point Omega=12.0, mu_k=0.4 of the sweep; {remedy}"
    assert caught.value.__notes__ == [note]


@pytest.mark.parametrize("workers", [1, 2])
def test_errors_of_any_kind_can_be_recorded(workers: int) -> None:
    """A ValueError at the last point lost the results of all."""

    def found(case: dm.Parameters) -> float:
        if case.Omega == 12:
            raise ValueError("no root")
        return case.Omega

    case = dm.Parameters(N=385, Omega=15)
    kept = sweep(found, case, Omega=[10, 12, 14], workers=workers, errors="record")
    assert kept["status"].values.tolist() == ["ok", "failed", "ok"]
    assert kept["message"].values[1] == "ValueError: no root"
    assert kept["value"].values[[0, 2]].tolist() == [10, 14]
    with refusal("errors='keep': must be one of raise, record"):
        sweep(found, case, Omega=[10], errors="keep")


def test_an_error_leaves_out_the_calls_that_have_not_begun() -> None:
    called = []

    def function(case: dm.Parameters) -> float:
        called.append(case.N)
        raise RuntimeError("a fault of the user's own function")

    with ThreadPoolExecutor(1) as pool, pytest.raises(RuntimeError, match="user's own"):
        sweep(function, P, N=range(1, 100), executor=pool)
    assert len(called) < 99


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"executor": 3}, r"^executor=3: must have the method submit"),
        ({"executor": ThreadPool}, r"^executor=.*: must have the method submit"),
        ({"executor": Backwards(), "workers": 2}, r"^executor=.*: takes the place of workers"),
        ({"executor": Backwards(), "processes": True}, r"^executor=.*: takes the place of workers"),
        ({"workers": 0}, r"^workers=0: must be a whole number >= 1"),
        ({"workers": 2, "processes": True}, r"^processes=True: needs a function that other"),
        ({"progress": "yes"}, r"^progress='yes': must be True or False"),
    ],
)
def test_workers_that_cannot_be_are_refused(options: dict[str, Any], message: str) -> None:
    with refusal(message):
        sweep(lambda case: case.N, P, N=[1, 2], **options)


def test_a_bar_counts_the_calls_that_are_done(capsys: pytest.CaptureFixture[str]) -> None:
    sweep(products, P, zip=PAIRS, workers=2)
    assert capsys.readouterr() == ("", "")
    sweep(products, P, zip=PAIRS, workers=2, progress=True)
    printed = capsys.readouterr()
    assert printed.out == ""
    assert re.search(r"products .*3/3", printed.err)


def test_a_function_that_has_the_name_of_one_of_the_package_is_another() -> None:
    """It ended with a KeyError, as it has no parameter to search."""

    def critical(case: dm.Parameters) -> float:
        return case.N

    found = sweep(critical, P, N=[1.0, 2.0])
    assert found["value"].values.tolist() == [1.0, 2.0]
    assert json.loads(found.attrs["base"])["Omega"] == P.Omega


def test_a_notebook_without_widgets_has_a_bar_of_text(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """rich would only warn that it needs ipywidgets."""
    monkeypatch.setattr("rich.console._is_jupyter", lambda: True)
    monkeypatch.setitem(sys.modules, "ipywidgets", None)
    sweep(products, P, zip=PAIRS, progress=True)
    assert re.search(r"products .*3/3", capsys.readouterr().err)


def test_a_bar_stays_where_a_call_ended_the_sweep(capsys: pytest.CaptureFixture[str]) -> None:
    def function(case: dm.Parameters) -> float:
        if case.N > 1:
            raise RuntimeError("a fault of the user's own function")
        return case.N

    with pytest.raises(RuntimeError):
        sweep(function, P, N=[1, 2, 3], progress=True)
    assert "1/3" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("processes", "kind"), [(False, "ThreadPoolExecutor"), (True, "ProcessPoolExecutor")]
)
def test_as_many_workers_are_started_as_are_asked_for(
    processes: bool, kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    started: list[int] = []

    def pool(number: int) -> ThreadPoolExecutor:
        started.append(number)
        return ThreadPoolExecutor(number)

    monkeypatch.setattr(workers, kind, pool)
    swept = sweep(products, P, N=[1, 2, 3], workers=3, processes=processes)
    assert started == [3]
    np.testing.assert_allclose(swept["load"], P.mu_k * np.array([1, 2, 3]))


@pytest.mark.parametrize(
    ("function", "options"),
    [
        (dm.critical, {"name": "Omega", "bounds": (14, 16), "points": 3}),
        (dm.critical_speed, {"bounds": (15, 15.5), "horizon": 1, "step": 0.5}),
    ],
)
def test_a_speed_that_is_searched_is_no_value_of_the_case(
    function: Any, options: dict[str, Any]
) -> None:
    """Nothing was computed at the case's own speed."""
    found = sweep(function, P.replace(N=385, Omega=15), mu_s=[0.4, 0.45], **options)
    assert set(json.loads(found.attrs["base"])) >= {"N"}
    assert "Omega" not in json.loads(found.attrs["base"])


def test_whole_numbers_along_a_sweep_are_floats() -> None:
    """So that they are drawn as numbers, and not as counts."""
    swept = sweep(lambda case: {"x": case.N}, P, n_diameters=[1, 2])
    numbers = swept["n_diameters"]
    assert numbers.dtype.kind == "f"
    assert numbers.values.tolist() == [1.0, 2.0]


def test_a_parameter_that_is_searched_is_not_swept() -> None:
    """Its values had no effect, and nothing told so."""
    rule = "mu_k: must not be swept, because critical searches along it"
    with refusal(rule):
        sweep(dm.critical, P, name="mu_k", bounds=(0.1, 0.3), points=3, mu_k=[0.1, 0.2])
    with refusal("Omega: must not be swept, because continue_cycle"):
        sweep(dm.continue_cycle, P, name="Omega", bounds=(13, 15), Omega=[14.0, 14.5])
    with refusal("Omega: must not be swept, because hysteresis"):
        sweep(dm.hysteresis, P, bounds=(14, 15), dwell=2, Omega=[10.0, 12.0])


def test_names_of_own_results_have_no_meaning() -> None:
    """A number called w was the disc under the slider, in mm."""
    found = sweep(lambda case: {"w": 2.0, "period": 1.0}, P, Omega=[1.0, 2.0])
    assert found["w"].attrs == {}
    assert found["period"].attrs == {}
    drawn = shown(found)
    assert label(drawn["w"]) == "w"
    assert label(drawn["period"]) == "Period"
    # one's own attributes are said, and numbers stay as they are
    own = {"units": "mm", "long_name": "pad amplitude"}
    named = sweep(lambda case: xr.Dataset({"u": ((), 2.0, own)}), P, Omega=[1.0, 2.0])
    drawn = shown(named)["u"]
    assert (label(drawn), drawn.attrs["factor"]) == ("Pad amplitude (mm)", 1.0)


# ---- Arguments of the function that vary, and sweeps of which no point makes a case


def test_a_sweep_of_which_no_point_makes_a_case_is_refused() -> None:
    """A dataset of only status and message came back, after as many calls as points."""
    with refusal(
        r"^no point of the sweep makes a case: at the first, mu_k_over_mu_s=0.5, mu_k=0.1: "
        r"mu_k_over_mu_s=0.5: must not be given beside mu_k$"
    ):
        sweep(dm.floquet, P, mu_k_over_mu_s=[0.5, 0.6], mu_k=[0.1, 0.2])


def test_an_argument_of_the_function_varies_along_a_dimension_of_its_own() -> None:
    swept = sweep(
        lambda case, gain, word: {"load": case.N * gain, "word": f"{word} {case.k:g}"},
        P,
        over={"gain": [1, 2, 3]},
        zip={"k": [1.0, 2.0], "name": ["a", "b"]},
        N=[3.0, 4.0],
        word="k",
    )
    assert swept["load"].dims == ("N", "gain", "k")
    assert swept["load"].sel(N=4, gain=3, k=2).item() == 12
    assert swept["word"].sel(N=4, gain=3, k=2).item() == "k 2"
    assert swept["gain"].values.tolist() == [1, 2, 3]
    assert json.loads(swept.attrs["options"]) == {"word": "k"}


@pytest.mark.parametrize("workers", [{"workers": 2}, {"workers": 2, "processes": True}])
def test_an_argument_that_varies_has_its_unit_and_meaning(workers: Any) -> None:
    swept = sweep(dm.outcome, P, over={"horizon": ["1 s", "0.05 min"]}, N=[300], **workers)
    assert swept["horizon"].values.tolist() == [1.0, 3.0]
    assert swept["horizon"].attrs == {"units": "s", "long_name": "longest simulated time"}
    assert "horizon" not in json.loads(swept.attrs["options"])
    alone = sweep(dm.outcome, P, horizon=3, N=[300])
    for name in ("outcome", "time_reached", "u_max"):
        assert swept[name].sel(horizon=3).values == alone[name].values


@pytest.mark.parametrize(
    ("over", "message"),
    [
        ({"horizn": [5]}, r"^over.horizn: is no argument of outcome, did you mean horizon\?"),
        ({"case": [5]}, r"^over.case: is no argument of outcome"),
        ({"N": [5]}, r"^over.N: is a number of the case: give it beside over, as in N=\[...\]$"),
        ({"tol": [1e-10]}, r"^over.tol: must not be given twice$"),
        ({"horizon": []}, r"^over.horizon=\[\]: must have one value or more$"),
        ({"horizon": [5, 5.0]}, r"^over.horizon\[1\]=5: must not be given twice along an axis$"),
        ({"start": [{"u": 1}, 2]}, r"^over.start=.*: must be all numbers, all words, all mappings"),
        ({"horizon": [1, "x"]}, r"^over.horizon=.*: must be all numbers, all words, all mappings"),
        ({"horizon": [-1, 5]}, r"^horizon=-1: must be > 0$"),
        ({"horizon": ["x"]}, r"^horizon='x': must be a number$"),
        ({}, r"^over=\{\}: must be values by the names of arguments"),
        ([5], r"^over=\[5\]: must be values by the names of arguments"),
    ],
)
def test_what_is_wrong_with_arguments_that_vary_is_said(over: Any, message: str) -> None:
    required = {}
    if "horizon" not in over:
        required = {"horizon": 1}
    with refusal(message):
        sweep(dm.outcome, P, over=over, Omega=[10], tol=1e-9, **required)


def test_an_argument_must_not_have_the_name_of_a_column() -> None:
    with refusal(r"^over.k: must not be given twice$"):
        sweep(lambda case, k: k, P, over={"k": [1]}, zip={"k": [1.0], "N": [2.0]})


def test_an_argument_that_is_refused_at_a_later_point_fails_there() -> None:
    swept = sweep(dm.outcome, P, over={"horizon": [1, -1]}, N=[-1, 300])
    assert swept["status"].values.tolist() == [["failed", "failed"], ["ok", "failed"]]
    assert "horizon=-1: must be > 0" in swept["message"].values[1, 1]


def test_a_list_for_an_argument_of_one_value_is_told_of_over() -> None:
    hint = r"to vary {0}, give over={{\"{0}\": \[...\]}}"
    with refusal("^horizon=.*must be a number; " + hint.format("horizon")):
        sweep(dm.outcome, P, horizon=[50, 100], Omega=[10, 12])
    with pytest.raises(TypeError) as raised:
        sweep(lambda case, gain: case.N * gain, P, gain=[1, 2], N=[3.0])
    assert re.search(hint.format("gain"), raised.value.__notes__[-1])
    with refusal(r"^bounds=\(9, 8\): lowest=9 must be < highest=8$"):
        sweep(dm.critical_speed, P, bounds=[9, 8], N=[300])


def test_a_horizon_along_which_a_function_has_one_value_varies() -> None:
    swept = sweep(dm.critical_speed, P, over={"horizon": [0.5, 1]}, bounds=(8, 9), N=[300, 385])
    assert swept["critical_speed"].dims == ("N", "horizon")
    with refusal(r"returned values along gain, which is a dimension of the sweep"):
        sweep(
            lambda case, gain: xr.Dataset({"x": ("gain", [1.0, 2.0])}), P, over={"gain": [1.0, 2.0]}
        )


def test_coordinates_of_a_function_that_differ_between_points_are_a_variable() -> None:
    """Values stood beside the coordinates of the first point."""

    def function(case: dm.Parameters, step: float) -> xr.Dataset:
        times = np.arange(0.0, 1.0, step)
        return xr.Dataset({"height": ("time", case.N * times)}, {"time": times})

    swept = sweep(function, P, over={"step": [0.5, 0.25]})
    assert swept["height"].dims == ("step", "time_index")
    nan = np.nan
    np.testing.assert_array_equal(swept["time"], [[0, 0.5, nan, nan], [0, 0.25, 0.5, 0.75]])
    np.testing.assert_array_equal(swept["height"], P.N * swept["time"])


def test_what_critical_varies_may_vary_and_its_values_have_then_no_common_unit() -> None:
    found = sweep(
        lambda case, unit: xr.Dataset({"x": ((), 1.0, {"units": unit, "long_name": "x"})}),
        P,
        over={"unit": ["m", "s"]},
    )
    assert found["x"].attrs == {"long_name": "x"}
    with refusal(r"^N: must not be swept, because critical searches along it$"):
        sweep(dm.critical, P, over={"name": ["Omega", "N"]}, bounds=(8, 20), N=[300])


def test_arguments_that_vary_are_saved(tmp_path: Path) -> None:
    swept = sweep(
        lambda case, early, method: case.N * early,
        P,
        over={"early": [True, False], "method": ["a", "bc"]},
    )
    dm.save(swept, tmp_path / "x.nc")
    xr.testing.assert_equal(dm.load(tmp_path / "x.nc"), swept)


def number_or_word(case: dm.Parameters) -> dict[str, Any]:
    """A number at low speeds, and a word at others."""
    if case.Omega < 11:
        return {"found": 1}
    return {"found": "w"}


def test_numbers_among_words_are_warned_of() -> None:
    """The number 1 became the word "1" without a word."""
    with pytest.warns(UserWarning, match="found is a word at some points and a number at others"):
        swept = sweep(number_or_word, P, Omega=[10, 12])
    assert swept["found"].values.tolist() == ["1", "w"]
