"""The table of variables: names, units and words."""

import pytest

from disc_model import Parameters
from disc_model.analysis.classify import Settled
from disc_model.data.variables import (
    OF_QUANTITIES,
    OF_RESULTS,
    PHASES,
    SCALARS,
    SERIES,
    STABLE_CYCLES,
    WORDS,
    CycleStatus,
    Outcome,
    attributes,
    known_of,
    values_text,
)
from disc_model.errors import Status
from disc_model.simulation.result import EVENT_ROW, SAMPLE_ROW


@pytest.mark.parametrize(
    ("name", "unit", "text", "comment"),
    [
        ("P_min", "N", "least contact force", "within the bin; positive in compression"),
        ("u_velocity_max", "m s-1", "greatest vertical velocity of the slider", "within the bin"),
        ("rho", "kg m-3", "density of the disc", None),
        ("k", "N m-1", "normal spring of the slider", "spring of the slider, normal to the disc"),
    ],
)  # fmt: skip
def test_attributes(name: str, unit: str, text: str, comment: str | None) -> None:
    found = attributes(name)
    assert (found["units"], found["long_name"], found.get("comment")) == (unit, text, comment)


def test_values_of_a_parameter_are_in_its_unit() -> None:
    """They were called "Omega in the sweep, SI units", without a unit."""
    found = OF_QUANTITIES["branches"]["columns"]["value"].texts({"name": "k"})
    assert (found["parameter"], found["units"]) == ("k", "N m-1")
    crossing = OF_QUANTITIES["campbell"]["columns"]["crossing_Omega"].texts()
    assert (crossing["parameter"], crossing["units"]) == ("Omega", "rad s-1")


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ({"N": 385.0, "Omega": 15.0, "mu_s": 0.4}, "N = 385 N, Ω = 15 rad/s"),
        ({"N": 385.0, "D_star": 2e-5}, "N = 385 N, D* = 2·10⁻⁵ N m s"),
        ({"D_star": 0.0, "contact": "bilateral"}, "D* = 0 N m s"),
        ({"friction_law": "stribeck"}, "friction_law = stribeck"),
        ({"disc": {"omega": [628.3, 1256.6]}}, "a disc given by 2 modes of 100 to 200 Hz"),
    ],
)
def test_what_differs_from_the_paper_in_words(values: dict[str, object], text: str) -> None:
    assert values_text(values) == text


PARTS = {
    "series": SERIES | SCALARS,
    **{name: known_of(name) for name in OF_QUANTITIES},
    **OF_RESULTS,
}


@pytest.mark.parametrize("part", PARTS)
def test_long_names_are_short_labels(part: str) -> None:
    """They were sentences, which ran out of every picture of plain xarray."""
    for name, variable in PARTS[part].items():
        assert variable.long_name or variable.parameter, name
        assert len(variable.long_name) <= 40, name
    for name in (*Parameters.model_fields, *SERIES):
        assert len(attributes(name)["long_name"]) <= 40


def test_words_of_flags_are_those_of_the_enumerations() -> None:
    assert {*WORDS["statuses"]} == {*Status, "failed"}
    left = ["failed", "excluded"]
    assert [*WORDS["point_statuses"]] == ["ok", *(x for x in Status if not x.complete), *left]
    assert [*WORDS["cycle_statuses"]] == [*CycleStatus, *left]
    assert {*WORDS["outcomes"], *WORDS["long_term"]} == {*Outcome, "failed"}
    assert [*WORDS["answers"]] == [*Settled]
    assert WORDS["attractors"][1:] == WORDS["long_term"][1:]
    assert WORDS["sample_outcomes"][1:] == WORDS["outcomes"]
    assert {*STABLE_CYCLES} < {*WORDS["sample_cycles"]}
    assert WORDS["sampled_phases"][1:] == PHASES


def test_the_engine_records_what_the_table_describes() -> None:
    assert SERIES.keys() == {*EVENT_ROW, *SAMPLE_ROW} - {"direction"}
