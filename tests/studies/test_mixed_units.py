"""Numbers without a unit beside such with one, and values of ranges that are given with a unit."""

from typing import Any

import numpy as np
import pytest

import disc_model as dm
from disc_model.studies.study import parse_study
from tests.refusals import refusal
from tests.studies.refused import faults_of

CASE = dm.Parameters(N=385, Omega=15)
MIXED = ["140 rpm", 15]
NO_UNIT = "has no unit beside '140 rpm'"
RANGE = {"start": "100 rpm", "stop": "140 rpm", "count": 5}


def speeds_of(axis: Any) -> list[float]:
    """The speeds of a study along an axis."""
    content = {"study": "s", "quantity": "floquet", "base": {"N": 385}, "axes": {"Omega": axis}}
    grid = parse_study(content).grid
    return [speed for (speed,) in grid.values["Omega"]]


def speed_of(text: str) -> float:
    """A speed that is given alone."""
    return dm.Parameters(N=1, Omega=text).Omega


# ---- Mixed units


@pytest.mark.parametrize("axis", [{"Omega": MIXED}, {"zip": {"Omega": MIXED, "N": [300, 400]}}])
def test_a_sweep_refuses_mixed_units(axis: dict[str, Any]) -> None:
    """15 was taken for rad/s."""
    with refusal(f"Omega=15: {NO_UNIT}"):
        dm.sweep(dm.floquet, CASE, **axis)


def test_arguments_along_a_sweep_refuse_mixed_units() -> None:
    with refusal("horizon=1: has no unit beside '100 ms'"):
        dm.sweep(dm.outcome, CASE, over={"horizon": ["100 ms", 1]})


@pytest.mark.parametrize("function", [dm.critical, dm.continue_cycle])
def test_bounds_refuse_mixed_units(function: Any) -> None:
    with refusal(f"bounds=15.2: {NO_UNIT}"):
        function(CASE, "Omega", ("140 rpm", 15.2))


def test_values_of_a_branch_refuse_mixed_units() -> None:
    with refusal(f"values=15: {NO_UNIT}"):
        dm.continue_cycle(CASE, "Omega", ("130 rpm", "150 rpm"), values=MIXED)


def test_bounds_and_step_of_a_preload_refuse_mixed_units() -> None:
    with refusal("bounds=300: has no unit beside '0.1 kN'"):
        dm.hysteresis(CASE, (300, 400), 6, step="0.1 kN", name="N")


def test_times_refuse_mixed_units() -> None:
    with refusal("times=0.1: has no unit beside '5 ms'"):
        dm.snapshots(CASE, ["5 ms", 0.1])


def test_columns_of_a_disc_refuse_mixed_units() -> None:
    with refusal("omega=1515: has no unit beside '230 Hz'"):
        dm.Disc(diameters=[0, 1], omega=["230 Hz", 1515], amplitude=[1.5, 2.2])


@pytest.mark.parametrize("axis", [MIXED, {"blocks": [["140 rpm"], [15]]}, {**RANGE, "extra": [15]}])
def test_a_study_refuses_mixed_units(axis: Any) -> None:
    [fault] = faults_of(lambda: speeds_of(axis))
    assert "axes.Omega=15: has no unit beside" in fault


@pytest.mark.parametrize("axis", [[0, "140 rpm"], ["15 rad/s", 14], ["140 rpm", "2 rps"]])
def test_zero_and_numbers_beside_the_unit_of_si_are_taken(axis: list[Any]) -> None:
    assert len(speeds_of(axis)) == 2


# ---- Values of ranges


@pytest.mark.parametrize("scale", [{}, {"stop": "1600 rpm", "scale": "log"}])
def test_a_value_of_a_range_is_that_of_its_text(scale: dict[str, str]) -> None:
    """It was rounded to 12 digits in rad/s, so that no text selected it."""
    texts = ["100 rpm", "110 rpm", "120 rpm", "130 rpm", "140 rpm"]
    if scale:
        texts = ["100 rpm", "200 rpm", "400 rpm", "800 rpm", "1600 rpm"]
    assert speeds_of({**RANGE, **scale}) == [speed_of(text) for text in texts]


def test_an_extra_value_within_a_range_is_its_own() -> None:
    assert speeds_of({**RANGE, "extra": ["120 rpm"]}) == speeds_of(RANGE)


def test_a_value_of_a_range_is_selected_by_its_text() -> None:
    swept = dm.critical_speed(CASE, ("100 rpm", "140 rpm"), step="20 rpm", horizon=0.1)
    assert swept.sel(scan_Omega=speed_of("120 rpm"))["scan_status"] == "ok"


def test_a_range_of_preloads_has_values_of_its_unit() -> None:
    found = dm.hysteresis(CASE, ("0.3 kN", "0.32 kN"), 6, step="0.01 kN", max_dwell=6, name="N")
    assert np.array_equal(found["sweep_N"], [300.0, 310.0, 320.0])


def test_the_unit_of_a_range_is_no_key_of_a_file() -> None:
    [fault] = faults_of(lambda: speeds_of({"start": 100, "stop": 140, "count": 5, "unit": "rpm"}))
    assert "unknown key" in fault
    assert "given_in" not in fault
