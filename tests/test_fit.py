"""Parameters fitted to computed values, with and without errors, are found again."""

import math
import re
import sys
from typing import Any

import numpy as np
import pandas as pd
import pytest

import disc_model as dm
from tests.refusals import refusal

P = dm.Parameters(N=385, Omega=14, normalization="as_published")
UNCERTAINTY = {
    "period": 1e-5,
    "growth_rate": 2e-3,
    "stick_fraction": 1e-3,
    "stick_time": 1e-5,
    "slip_time": 1e-5,
    "sliding_growth_rate": 1e-3,
    "frequency_2_0": 0.1,
    "damping_ratio_2_0": 1e-5,
}
"""A standard deviation for each quantity."""
SPEEDS = (12.0, 13.0, 14.0, 14.8)
ROW = {"quantity": "frequency_2_0", "value": 290.0, "uncertainty": 0.1}


def computed(quantity: str, case: dm.Parameters) -> float:
    """A quantity, by the function of its motion."""
    if quantity == "sliding_growth_rate":
        return dm.steady_sliding(case).growth_rate
    if not quantity.endswith("_2_0"):
        return float(getattr(dm.floquet(case), quantity))
    omega = dm.plate_modes(case).set_index(["diameters", "circles"])["omega"][2, 0]
    return omega / math.tau if quantity == "frequency_2_0" else case.D_star / (2 * case.D) * omega


def measured(case: dm.Parameters, *quantities: str) -> pd.DataFrame:
    """Exact values at each speed."""
    rows = []
    for quantity in quantities:
        for speed in SPEEDS:
            value = computed(quantity, case.replace(Omega=speed))
            rows.append((quantity, value, UNCERTAINTY[quantity], speed))
    return pd.DataFrame(rows, columns=["quantity", "value", "uncertainty", "Omega"])


@pytest.mark.parametrize("quantity", UNCERTAINTY)
def test_a_parameter_is_found_again(quantity: str) -> None:
    name = "D_star" if quantity == "damping_ratio_2_0" else "E"
    true = P.replace(**{name: 1.01 * P.numbers[name]})
    found = dm.fit(P, [name], measured(true, quantity))
    assert P.replace(**found.params.valuesdict()).numbers[name] == pytest.approx(
        true.numbers[name], rel=1e-7
    )
    assert found.chisqr < 1e-6


def test_several_parameters_are_found_again_from_rows_as_mappings() -> None:
    true = P.replace(mu_s=0.42, k_p=19e3)
    rows: Any = measured(true, "period", "slip_time").to_dict("records")
    rows[2].pop("Omega")  # which is then that of the case
    found = dm.fit(P, ("mu_s", "k_p"), rows, bounds={"mu_s": (0.3, 0.5), "k_p": (1e4, math.inf)})
    assert dict(found.params.valuesdict()) == pytest.approx({"mu_s": 0.42, "k_p": 19e3}, rel=1e-7)
    assert 0.4 < found.params["mu_s"].correl["k_p"] < 0.6
    assert found.residual.shape == (8,)


def test_the_covariance_is_that_of_a_linear_problem() -> None:
    """Frequencies of a thin plate are proportional to its thickness: the best one is a weighted mean."""
    true = computed("frequency_2_0", P)
    rows = [
        {"quantity": "frequency_2_0", "value": 1.01 * true, "uncertainty": 1.0},
        {"quantity": "frequency_2_0", "value": 1.04 * true, "uncertainty": 2.0},
    ]
    thickness = dm.fit(P, ["h"], rows).params["h"]
    mean = (1.01 * 4 + 1.04 * 1) / 5
    assert thickness.value == pytest.approx(mean * P.h, rel=1e-8)
    assert thickness.stderr == pytest.approx(P.h / true / math.sqrt(1 + 1 / 4), rel=1e-6)


@pytest.mark.slow
def test_intervals_of_95_percent_contain_the_true_values() -> None:
    """Of friction and damping, in at least 90 of 100 draws."""
    start = P.replace(mu_s=0.44, c_p=1.5)
    true = {"mu_s": 0.42, "c_p": 2.0}
    exact = measured(start.replace(**true), "period", "slip_time", "growth_rate")
    random = np.random.default_rng(3)
    within = dict.fromkeys(true, 0)
    for _ in range(100):
        errors = exact["uncertainty"] * random.standard_normal(len(exact))
        found = dm.fit(start, [*true], exact.assign(value=exact["value"] + errors))
        for name, each in found.params.items():
            within[name] += abs(each.value - true[name]) < 1.96 * each.stderr
    assert min(within.values()) >= 90, within


# ---- Cases without what was measured


def test_a_start_without_a_cycle_is_refused_with_its_speed() -> None:
    rows = measured(P, "period")
    with refusal(r"data\.2\.quantity='period': is not there at the start with Omega=14\.0$"):
        dm.fit(P.replace(c_p=1.5), ["mu_s"], rows)


def test_a_search_ends_in_front_of_cases_without_a_cycle() -> None:
    """There is none from c_p = 1.15 to 1.5 N s/m."""
    row = {"quantity": "period", "value": dm.floquet(P.replace(c_p=5)).period, "uncertainty": 1e-5}
    found = dm.fit(P.replace(c_p=0.5), ["c_p"], [row], bounds={"c_p": (0, 1.5)})
    assert 1.1 < found.params["c_p"].value < 1.15
    assert 100 < found.redchi < 1e8


def test_a_search_ends_in_front_of_what_is_no_case() -> None:
    row = {"quantity": "period", "value": 0.01, "uncertainty": 1e-5}
    found = dm.fit(P, ["mu_s"], [row])
    assert P.mu_k <= found.params["mu_s"].value < 0.26


# ---- Refusals


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"case": 3}, "case=3: must be Parameters"),
        ({"vary": ["mus"]}, "vary='mus': is no number of the case, did you mean mu_s?"),
        ({"vary": []}, "vary=[]: must not be empty"),
        ({"vary": "mu_s"}, "vary='mu_s': must be a valid tuple"),
        ({"data": []}, "data=[]: must not be empty"),
        ({"data": 5.0}, "data=5: must be a valid tuple"),
        ({"data": [{"quantity": "period"}]}, "data.0.value: is required"),
        (
            {"data": [ROW | {"quantity": "periode"}]},
            "data.0.quantity='periode': must match pattern",
        ),
        ({"data": [ROW, ROW | {"value": "x"}]}, "data.1.value='x': must be a number"),
        ({"data": [ROW | {"value": math.inf}]}, "data.0.value=inf: must be a finite number"),
        ({"data": [ROW | {"uncertainty": 0}]}, "data.0.uncertainty=0: must be > 0"),
        ({"data": [ROW, ROW | {"N": -1.0}]}, "data.1.N=-1: must be >= 0"),
        ({"data": [ROW | {"speed": 3.0}]}, "data.0.speed=3: unknown parameter"),
        ({"data": [ROW | {"quantity": "frequency_9_0"}]}, "is not there at the start"),
        ({"bounds": {"h": (0.1, 0.2)}}, f"h={P.h:g}: must be between its bounds, 0.1 and 0.2"),
        ({"bounds": {"k": (0, 1)}}, "bounds='k': is not varied"),
        ({"bounds": {"h": (0, "x")}}, "bounds.h.1='x': must be a number"),
        ({"bounds": {"h": 3}}, "bounds.h=3: must be a valid tuple"),
    ],
)
def test_what_breaks_a_rule_is_refused(changes: dict[str, Any], message: str) -> None:
    with refusal(re.escape(message)):
        dm.fit(**{"case": P, "vary": ["h"], "data": [ROW]} | changes)


def test_without_lmfit_a_message_says_how_to_install_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "lmfit", None)
    with pytest.raises(ImportError, match=re.escape("pip install 'disc_model[fit]'")):
        dm.fit(P, ["h"], [ROW])
