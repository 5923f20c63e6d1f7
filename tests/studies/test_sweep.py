"""Sweeps: any function of a case, along numbers of the case and arguments of the function."""

import json
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import disc_model as dm
from disc_model.errors import ParameterError

CASE = dm.Parameters(N=385, Omega=15)
PAIRS = {"N": [385, 300], "Omega": [10, 12]}


def gained(case: dm.Parameters, gain: float = 1.0) -> dict[str, Any]:
    return {"load": case.N * gain, "word": "heavy" if case.N > 350 else "light"}


def test_a_sweep_takes_any_function_with_any_map_and_says_what_it_did() -> None:
    found = dm.sweep(gained, CASE, N=[300, 400], Omega=[10], gain=2)
    assert found["load"].dims == ("N", "Omega")
    assert found["load"].values.tolist() == [[600], [800]]
    assert found["word"].values.tolist() == [["light"], ["heavy"]]
    assert found["N"].attrs["units"] == "N"
    assert json.loads(found.attrs["options"]) == {"gain": 2}
    assert dm.Parameters.model_validate_json(found.attrs["parameters"]) == CASE
    with ProcessPoolExecutor(1) as pool:
        assert dm.sweep(gained, CASE, N=[300, 400], Omega=[10], gain=2, map=pool.map).identical(
            found
        )


@pytest.mark.parametrize("table", [PAIRS, pd.DataFrame(PAIRS)])
def test_columns_vary_together_and_go_with_axes(table: Any) -> None:
    pairs = dm.sweep(dm.floquet, CASE, zip=table, mu_k=[0.2, 0.24])
    assert pairs["growth_rate"].dims == ("mu_k", "N_Omega")
    assert pairs["N"].dims == ("N_Omega",)
    direct = dm.floquet(CASE.replace(N=300, Omega=12, mu_k=0.2)).growth_rate
    assert pairs["growth_rate"].sel(mu_k=0.2).values[1] == direct


def test_an_argument_varies_along_a_dimension_of_its_own() -> None:
    found = dm.sweep(gained, CASE, over={"gain": [1, 2]}, N=[300])
    assert found["load"].dims == ("N", "gain")
    assert found["load"].values.tolist() == [[300, 600]]


def test_words_missing_numbers_and_messages_where_a_point_fails() -> None:
    found = dm.sweep(dm.floquet, CASE, N=[385, -1])
    assert found["status"].values.tolist() == ["ok", "failed"]
    assert "N=-1" in str(found["message"].values[1])
    assert np.isnan(found["growth_rate"].values[1])
    assert found["stable"].values[1] != found["stable"].values[1]  # nan: neither true nor false


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: dm.sweep(dm.floquet, CASE, Omga=[1]), "Omga Omega"),
        (lambda: dm.sweep(dm.floquet, CASE, Omega=12), "Omega list"),
        (lambda: dm.sweep(dm.floquet, CASE, Omega=["12 N"]), "Omega '12 N' rad/s"),
        (lambda: dm.sweep(dm.floquet, CASE), "vary"),
        (lambda: dm.sweep(dm.floquet, CASE, zip={"N": [1], "Omega": [1, 2]}), "zip same length"),
        (lambda: dm.sweep(dm.floquet, 3, Omega=[1]), "case Parameters"),
        (lambda: dm.sweep(dm.floquet, CASE, Omega=[1], tol=7), "tol 7"),
        (lambda: dm.sweep(dm.floquet, CASE, N=[-1, -2]), "no point N=-1"),
        (lambda: dm.sweep(lambda case: None, CASE, N=[1, 2]), "return"),
    ],
)
def test_what_cannot_be_is_refused(call: Any, words: str) -> None:
    with pytest.raises(ParameterError) as error:
        call()
    assert all(word in str(error.value) for word in words.split()), error.value


def test_any_other_error_of_the_function_ends_the_sweep() -> None:
    with pytest.raises(KeyError):
        dm.sweep(lambda case: {}["no"], CASE, N=[1, 2])


def test_a_sweep_is_saved_and_loaded(tmp_path: Path) -> None:
    found = dm.sweep(dm.simulate, CASE, t_end=0.2, Omega=[12, 15])
    dm.save(found, tmp_path / "s.nc")
    assert dm.load(tmp_path / "s.nc").equals(found)
