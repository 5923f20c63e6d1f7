"""The table of variables: values of points that are missing, attributes, and words of flags."""

import numpy as np
import pytest
import xarray as xr

from disc_model import Parameters
from disc_model.analysis.classify import Settled
from disc_model.data.described import known_of
from disc_model.data.variables import (
    OF_ARGUMENTS,
    OF_QUANTITIES,
    OF_RESULTS,
    PHASES,
    SCALARS,
    SERIES,
    STABLE_CYCLES,
    STATUSES,
    WORDS,
    CycleStatus,
    Outcome,
    Variable,
    attributes,
    flag_names,
)
from disc_model.errors import Status
from disc_model.simulation.result import EVENT_ROW, FOLDED, SAMPLE_ROW


def test_points_that_are_missing_have_a_value_that_says_so() -> None:
    assert STATUSES[int(SCALARS["status"].unknown)] == "failed"
    assert SCALARS["steps"].unknown == 0
    assert np.isnan(SCALARS["first_separation"].unknown)
    # without a word for it, the first one: the kind of no event
    assert SERIES["kind"].unknown == 0
    empty = SCALARS["status"].empty((2, 3))
    assert empty.dtype == np.int8
    assert empty.shape == (2, 3)
    assert (empty == STATUSES.index("failed")).all()
    assert SCALARS["n_events"].empty((1,)).dtype == np.int64


@pytest.mark.parametrize(
    ("name", "unit", "text", "comment"),
    [
        ("P_min", "N", "least contact force", "within the bin; positive in compression"),
        ("u_velocity_max", "m s-1", "greatest vertical velocity of the slider", "within the bin"),
        ("rho", "kg m-3", "density of the disc", None),
        ("k", "N m-1", "normal spring of the slider", "spring of the slider, normal to the disc"),
    ],
)
def test_attributes_of_derived_names(name: str, unit: str, text: str, comment: str | None) -> None:
    found = attributes(name)
    assert found["units"] == unit
    assert found["long_name"] == text
    assert found.get("comment") == comment


@pytest.mark.parametrize("name", ["u", "w", "w_point", "u_0", "u_min"])
def test_a_displacement_says_what_it_is_measured_from(name: str) -> None:
    """Those of samples and those of outcomes have two zeros, and samples named none."""
    assert attributes(name)["comment"].endswith("the undeformed disc")


# ---- The table

PARTS = {
    "series": SERIES | SCALARS,
    **{name: known_of(name) for name in OF_QUANTITIES},
    **OF_RESULTS,
    **{f"arguments of {name}": part for name, part in OF_ARGUMENTS.items()},
}
NAMES = ("Lyapunov",)
"""First words of long names that have a capital letter wherever they stand."""


@pytest.mark.parametrize("part", PARTS)
def test_long_names_are_short_labels(part: str) -> None:
    """They were sentences, which ran out of every picture of plain xarray."""
    for name, variable in PARTS[part].items():
        text = variable.long_name
        assert text or variable.parameter, name
        assert len(text) <= 40, name
        assert text[:1] == text[:1].lower() or text.startswith(NAMES), name
        assert ", nan " not in text, name
        assert not variable.missing.startswith(("if ", "unless ", "nan")), name


@pytest.mark.parametrize("part", [*OF_QUANTITIES, *OF_RESULTS])
def test_labels_tell_the_variables_of_a_dataset_apart(part: str) -> None:
    own = [*OF_QUANTITIES.get(part, {}).values(), OF_RESULTS.get(part, {})]
    named = [x.long_name for variables in own for x in variables.values() if x.long_name]
    assert len(named) == len({*named})


@pytest.mark.parametrize("name", [*SERIES, *SCALARS, *Parameters.model_fields])
def test_names_of_what_runs_hold_are_short_too(name: str) -> None:
    assert len(attributes(name)["long_name"]) <= 40
    if name in FOLDED:
        assert all(len(attributes(f"{name}_{end}")["long_name"]) <= 40 for end in ("min", "max"))


def test_words_of_flags_are_those_of_the_enumerations() -> None:
    assert {*WORDS["statuses"]} == {*Status, "failed"}
    assert [*WORDS["point_statuses"]] == ["ok", *(x for x in Status if not x.complete), "failed"]
    assert [*WORDS["cycle_statuses"]] == [*CycleStatus, "failed"]
    assert {*WORDS["outcomes"], *WORDS["long_term"]} == {*Outcome, "failed"}
    assert [*WORDS["answers"]] == [*Settled]
    assert WORDS["attractors"][1:] == WORDS["long_term"][1:]
    assert WORDS["sample_outcomes"][1:] == WORDS["outcomes"]
    assert {*STABLE_CYCLES} < {*WORDS["sample_cycles"]}
    assert WORDS["sampled_phases"][1:] == PHASES


def test_the_engine_records_what_the_table_describes() -> None:
    assert {*EVENT_ROW} - {"direction"} <= SERIES.keys()
    assert {*SAMPLE_ROW} <= SERIES.keys()
    assert SERIES.keys() == {*EVENT_ROW, *SAMPLE_ROW} - {"direction"}


def test_swept_values_have_the_name_and_unit_of_their_parameter() -> None:
    """They were called "Omega in the sweep, SI units", without a unit."""
    known = OF_QUANTITIES["branches"]["columns"]["value"]
    found = known.texts({"parameter": "k"})
    assert found["parameter"] == "k"
    assert found["units"] == "N m-1"
    assert found["long_name"] == attributes("k")["long_name"]
    assert found["missing"] == "there is no branch, or one of fewer points"
    crossing = OF_QUANTITIES["campbell"]["summary"]["crossing_Omega"].texts()
    assert crossing["long_name"] == "speed of the crossing"
    assert (crossing["parameter"], crossing["units"]) == ("Omega", "rad s-1")


def test_flags_are_words_by_their_numbers() -> None:
    variable = Variable("1", "a flag", ("no", "yes"))
    assert variable.attributes["flag_meanings"] == "no yes"
    assert variable.attributes["flag_values"].tolist() == [0, 1]
    values = xr.DataArray(np.array([1, 0, 1], np.int8), attrs=variable.attributes)
    assert flag_names(values).tolist() == ["yes", "no", "yes"]
    assert flag_names(xr.DataArray(["a"])).tolist() == ["a"]


def test_former_words_are_understood() -> None:
    """The class of small stick-slip was called quiet, also where a brake groans."""
    attrs = {"flag_values": np.arange(2, dtype=np.int8), "flag_meanings": "failed quiet"}
    old = xr.DataArray(np.array([[1, 0]], np.int8), attrs=attrs)
    assert flag_names(old).tolist() == [["stick_slip", "failed"]]
    words = xr.DataArray([["quiet", "separating"]])
    assert flag_names(words).tolist() == [["stick_slip", "separating"]]
    masked = words.where(words != "separating")
    assert flag_names(masked).tolist() == [["stick_slip", ""]]
    assert flag_names(xr.DataArray("quiet")).item() == "stick_slip"
