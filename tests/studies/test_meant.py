"""What is meant by names, units and numbers that a study file or a call has wrongly."""

from typing import Any

import pytest
import yaml

import disc_model as dm
from disc_model.studies.study import parse_study
from tests.refusals import refusal
from tests.studies.refused import faults_of

CASE = dm.Parameters(N=300, Omega=12)
GRID: dict[str, Any] = {
    "study": "s",
    "quantity": "outcome",
    "options": {"horizon": 2},
    "base": {"N": 200},
    "axes": {"Omega": [10, 20], "k": [4e4, 5e4]},
}
MAP = {"kind": "heat_map", "variable": "outcome", "x": "Omega", "y": "k"}
RANGE = {"start": 1, "stop": 2, "count": 2}
DISC = {"diameters": [2], "circles": [0], "omega": [3000.0], "amplitude": [0.5]}


def faults(**changes: Any) -> list[str]:
    """The faults of a study with some parts changed."""
    return faults_of(lambda: parse_study({**GRID, **changes}).grids())


def faults_of_figure(**keys: Any) -> list[str]:
    """The faults of a study with a figure."""
    return faults(figures={"f": {**MAP, **keys}})


# ---- Numbers and units


@pytest.mark.parametrize("axis", ["{start: 8,5 kN, stop: 9 kN, count: 3}", "['8,5 kN']"])
def test_a_decimal_comma_is_told(axis: str) -> None:
    """YAML ends a number at it, and the rest was an unknown key."""
    found = faults(base={}, axes={"Omega": [10, 20], "N": yaml.safe_load(axis)})
    assert any("decimals have a point" in fault for fault in found)


def test_a_unit_of_another_kind_has_an_example() -> None:
    [fault] = faults(base={"N": "8 kg"})
    assert fault.endswith("with a unit of its kind, such as kN")


# ---- Figures


def test_a_map_of_classes_has_no_scale() -> None:
    """The study was computed, and its figure failed then."""
    [fault] = faults_of_figure(log=True)
    assert fault.startswith("figures.f.log=")
    assert "outcome has classes" in fault


@pytest.mark.parametrize(("key", "word"), [("x", "omega"), ("y", "kk")])
def test_a_wrong_axis_makes_no_other_fault(key: str, word: str) -> None:
    [fault] = faults_of_figure(**{key: word})
    assert fault.startswith(f"figures.f.{key}='{word}'")


def test_wrong_names_of_discs_make_no_other_fault() -> None:
    """A third one said that their mapping was an unknown key."""
    figure = {"kind": "curve", "variable": "P_max", "x": "Omega", "by": "disc"}
    found = faults(
        base={"N": 200, "r_0": 0.1},
        discs={"steel": DISC, "paper": DISC},
        axes={"Omega": [10, 20], "disc": ["steel", "paper"]},
        figures={"f": {**figure, "names": {"steel.csv": "A", "cast": "B"}}},
    )
    assert len(found) == 2
    assert all(fault.startswith("figures.f.names=") for fault in found)


@pytest.mark.parametrize(
    ("quantity", "options", "figure", "known"),
    [
        (
            "sliding",
            {"parameter": "m", "scan": RANGE},
            {"variable": "largest_growth_rate", "x": "m"},
            "value",
        ),
        (
            "hysteresis",
            {"scan": RANGE, "dwell": 10},
            {"variable": "separation_rate", "x": "Omega"},
            "sweep_Omega",
        ),
    ],
)
def test_a_parameter_that_the_quantity_varies_has_its_dimension(
    quantity: str, options: dict[str, Any], figure: dict[str, Any], known: str
) -> None:
    [fault] = faults(
        quantity=quantity,
        options=options,
        base={"Omega": 12} if quantity == "sliding" else {},
        axes={"N": [200, 300]},
        figures={"f": {"kind": "curve", "by": "N", **figure}},
    )
    _, _, dimensions = fault.partition("known: ")
    assert known in dimensions.rstrip(")").split(", ")


# ---- Names of options and arguments


@pytest.mark.parametrize(
    ("quantity", "options", "wrong", "meant"),
    [
        ("critical_speed", {"bounds": [1, 2], "horizons": [5]}, "bounds", "scan"),
        ("critical_speed", {"scan": RANGE, "horizon": 5}, "horizon", "horizons"),
        ("hysteresis", {"step": 1, "dwell": 10}, "step", "scan"),
        ("lyapunov", {"transient": 1, "duration": 5, "count": 3}, "count", "exponents"),
        ("branches", {"name": "k", "scan": RANGE, "dwell": 10}, "name", "parameter"),
    ],
)
def test_an_option_has_the_name_of_an_argument(
    quantity: str, options: dict[str, Any], wrong: str, meant: str
) -> None:
    found = faults(quantity=quantity, options=options)
    [told] = [fault for fault in found if fault.startswith(f"options.{wrong}=")]
    assert f"did you mean {meant}?" in told


CALLS = [
    (dm.critical, {"parameter": "Omega", "bounds": (1, 2)}, "name"),
    (dm.critical, {"name": "Omega", "scan": RANGE}, "bounds"),
    (dm.continue_cycle, {"parameter": "Omega", "bounds": (1, 2)}, "name"),
    (dm.lyapunov_exponents, {"duration": 1, "exponents": 3}, "count"),
    (dm.critical_speed, {"bounds": (1, 2), "horizons": [5]}, "horizon"),
]


@pytest.mark.parametrize(("function", "arguments", "meant"), CALLS)
def test_an_argument_has_the_name_of_an_option(
    function: Any, arguments: dict[str, Any], meant: str
) -> None:
    with refusal(f"did you mean {meant}"):
        function(CASE, **arguments)


@pytest.mark.parametrize(("function", "arguments", "meant"), CALLS)
def test_an_argument_of_a_sweep_has_the_name_of_an_option(
    function: Any, arguments: dict[str, Any], meant: str
) -> None:
    with refusal(f"did you mean {meant}"):
        dm.sweep(function, CASE, N=[200, 300], **arguments)


# ---- Figures of a study with one axis more


def test_dimensions_that_are_left_over_are_told() -> None:
    """A key is named only if the figure has it."""
    axes = {"Omega": [10, 20], "mu_k": [0.1, 0.2]}
    raw = {"study": "s", "quantity": "campbell", "base": {"N": 200}, "axes": axes}
    figures: dict[str, Any] = {"f": {"kind": "campbell"}}
    [fault] = faults_of(lambda: parse_study({**raw, "figures": figures}).grids())
    assert fault == "figures.f.at.mu_k: is required, one of [0.1, 0.2]"
    figures["f"]["at"] = {"mu_k": 0.1}
    assert parse_study({**raw, "figures": figures}).grids()
    several = {**axes, "normalization": ["as_published", "orthonormal"]}
    [fault] = faults_of(lambda: parse_study({**raw, "axes": several, "figures": figures}).grids())
    assert fault.startswith("figures.f.at.normalization: is required")


def test_a_figure_with_panels_for_another_axis_tells_the_key() -> None:
    figures: dict[str, Any] = {"f": {"kind": "curve", "variable": "outcome", "x": "Omega"}}
    [fault] = faults(figures=figures)
    assert fault.startswith("figures.f.at.k: is required")
    assert "by: k" in fault
    figures["f"]["by"] = "k"
    assert parse_study({**GRID, "figures": figures}).grids()


def test_a_figure_with_lines_for_another_axis_tells_the_dimensions() -> None:
    starts = {"perturbation_u": [1e-4, 2e-4], "mu_k": [0.1, 0.2]}
    raw = {**GRID, "base": {"N": 200, "Omega": 12}, "axes": starts}
    figures = {"f": {"kind": "escape"}}
    [fault] = faults_of(lambda: parse_study({**raw, "figures": figures}).grids())
    assert fault == "figures.f.by='N': needs the dimension N (known: mu_k, perturbation_u)"
    figures["f"]["by"] = "mu_k"
    assert parse_study({**raw, "figures": figures}).grids()
