"""What study files may say of figures: each kind's keys are the parameters of its function, and each
fault names its parameter, value and rule."""

import inspect
from collections.abc import Mapping, Sequence
from typing import Any

import pytest

from disc_model import Poincare, Window
from disc_model.errors import Fault
from disc_model.figures.kinds import KINDS, kind_of
from disc_model.figures.schema import CasePlot, Kind, Plot
from disc_model.studies.quantity import HOMES
from tests.figures.examples import EXAMPLES
from tests.processes import python
from tests.refusals import refusal

OF_ALL = {"kind", "title", "caption", "section", "units", "width"}
"""Keys of figures of every kind."""


def plot_of(phrase: Mapping[str, Any]) -> Any:
    """A figure as a file asks for it."""
    return kind_of(phrase["kind"]).model_validate(phrase)


# ---- Kinds


@pytest.mark.parametrize("name", KINDS)
def test_keys_of_a_kind_are_the_parameters_of_its_function(name: str) -> None:
    kind = KINDS[name]
    first, *parameters = inspect.signature(kind.function).parameters
    if issubclass(kind, Plot):
        assert first == "study"
        keys = {*kind.model_fields} - {"study", "overlays", "at", "names"}
        own = {*keys, *kind.roles}
        assert not keys & {*kind.roles}, "a study is given among the overlays"
    else:
        assert first == "case"
        own = {*kind.model_fields} - {"case"}
    assert own == OF_ALL | {*parameters}
    assert kind.model_fields["kind"].default == name
    assert kind.__doc__ == inspect.getdoc(kind.function)


@pytest.mark.parametrize("name", KINDS)
def test_a_kind_shows_quantities_that_there_are(name: str) -> None:
    kind = KINDS[name]
    roles = {role.quantity for role in getattr(kind, "roles", {}).values()}
    assert {*kind.shows.quantities, *roles} <= {*HOMES}


@pytest.mark.parametrize(
    "name", ["chart", "paper.chart", "paper", "", None, ["heat_map"], "kind", "..errors"]
)
def test_another_name_is_no_kind(name: object) -> None:
    with refusal("kind.*unknown kind of figure"):
        kind_of(name)


def test_a_kind_of_the_paper_is_found_beside_the_package() -> None:
    kind = kind_of("paper.one_separation")
    assert issubclass(kind, CasePlot)
    assert kind.model_fields["kind"].default == "paper.one_separation"


def test_a_study_is_checked_without_what_draws() -> None:
    code = "import sys, disc_model.studies.study; print(*sys.modules)"
    loaded = python(code).stdout.split()
    assert "disc_model.figures.schema" in loaded
    assert {"matplotlib", "numba", "disc_model.figures.draw"}.isdisjoint(loaded)


# ---- Keys by themselves

MAP = {"kind": "heat_map", "variable": "period", "x": "Omega", "y": "N"}
CURVE = {"kind": "curve", "variable": "period", "x": "Omega"}
HISTORY = {"kind": "history", "case": "A", "window": "late"}


@pytest.mark.parametrize(
    ("phrase", "expected"),
    [
        ({"kind": "heat_map", "x": "Omega", "y": "N"}, "variable: is required"),
        ({**MAP, "colour": "red"}, "colour.*unknown"),
        ({**MAP, "xs": "Omega"}, "xs.*did you mean x"),
        ({**MAP, "width": "narrow"}, "width='narrow'.*column.*page"),
        ({**MAP, "units": {"speed": "rpm"}}, "units.speed='rpm': no parameter or variable"),
        ({**MAP, "units": {"Omega": "mm"}}, "units.Omega=.*mm'.*rad/s"),
        ({**MAP, "units": {"mu_k": "rpm"}}, "units.mu_k='rpm': no parameter or variable"),
        ({**MAP, "at": {"k": [1, 2]}}, "at.k"),
        ({**HISTORY, "variables": []}, "variables"),
        ({**HISTORY, "variables": ["v"]}, "variables.*'v'"),
        ({"kind": "history", "window": "late"}, "case: is required"),
        ({"kind": "spectrum", "case": "A", "window": "w", "highest": -2}, "highest=-2: must be"),
        ({"kind": "spectrum", "case": "A", "window": "w", "highest": "2 m"}, "highest='2 m'.*Hz"),
        ({"kind": "campbell", "multiples": [0]}, "multiples.*0.*must be"),
        ({"kind": "late_range"}, "thickness: is required"),
        (
            {"kind": "region_map", "x": "Omega", "y": "N", "marks": {"A": {"x": 1, "y": 2}}},
            "marks.A.paper_outcome: is required",
        ),
        ({"kind": "staircase", "x": "Omega", "zooms": [[1, 2, 3]]}, "zooms"),
    ],
)
def test_a_wrong_key_is_named(phrase: dict[str, Any], expected: str) -> None:
    with refusal(expected):
        plot_of(phrase)


def test_units_and_texts_of_files_are_read() -> None:
    plot = plot_of({"kind": "campbell", "highest": "2 kHz", "caption": ["One.", "Two."]})
    assert plot.options == {"highest": 2000.0, "multiples": ()}
    assert plot.caption == "One. Two."
    zoomed = plot_of({"kind": "bifurcation", "x": "Omega", "paper_cases": {"A": "60 rpm"}})
    assert zoomed.paper_cases["A"] == pytest.approx(6.283185307)
    chosen = plot_of({**CURVE, "at": {"k": "20 kN/m"}, "names": {2e4: "soft", "60000": "stiff"}})
    assert chosen.at == {"k": 20000.0}
    assert chosen.names == {"20000": "soft", "60000": "stiff"}


@pytest.mark.parametrize("name", EXAMPLES)
def test_examples_are_what_files_may_say(name: str) -> None:
    """As a file writes it, and as it is written to one."""
    plot = plot_of({"kind": name, **EXAMPLES[name]().phrase})
    again = type(plot).model_validate(plot.model_dump(exclude_unset=True))
    assert again == plot
    assert type(plot).model_validate_json(plot.model_dump_json(exclude_unset=True)) == plot


# ---- A figure and its study

NORMAL = {"normalization": ["as_published"]}
PLANE = {"Omega": [10.0, 12.0], "N": [100.0, 200.0], **NORMAL}
CUBE = {**PLANE, "k": [2e4, 5e4]}


def faults_of(phrase: Mapping[str, Any], dims: Mapping[str, Sequence[Any]]) -> list[Fault]:
    """What keeps a figure from showing a study of these dimensions, whose variables are a period and
    an outcome at each point, and exponents."""
    variables = {"period": dims, "outcome": dims, "exponent": {**dims, "exponent_number": [1, 2]}}
    plot: Kind = plot_of(phrase)
    assert isinstance(plot, Plot)
    return [*plot.faults(dims, variables)]


OUTCOME = {"kind": "sliding_outcome", "x": "Omega", "y": "N", "overlays": {"sliding": "s"}}
FAULTS: list[tuple[dict[str, Any], dict[str, Any], str, str, str]] = [
    # a variable
    ({**MAP, "variable": "perid"}, PLANE, "variable", "'perid'", "unknown variable, did you mean"),
    (
        {**CURVE, "variable": "exponent"},
        {**NORMAL, "Omega": [1, 2]},
        "at.exponent_number",
        "",
        "is required",
    ),
    # dimensions that the kind itself needs
    ({"kind": "critical_speed"}, {"Omega": [1, 2], **NORMAL}, "kind", "", "needs the dimension N"),
    # axes
    ({**MAP, "x": "c"}, PLANE, "x", "'c'", "needs the dimension c"),
    ({**MAP, "y": "Omga"}, PLANE, "y", "'Omga'", "did you mean Omega"),
    ({**MAP, "y": "Omega"}, PLANE, "y", "'Omega'", "must differ from the other dimensions"),
    ({**CURVE, "by": "Omega"}, PLANE, "by", "'Omega'", "must differ from the other dimensions"),
    ({**MAP, "x": "contact"}, {**PLANE, "contact": ["unilateral"]}, "x", "'contact'", "a number"),
    ({**MAP, "x": "k_c"}, {"k_c": [(1.0, 2.0)], **PLANE}, "x", "'k_c'", "one parameter"),
    # lines and panels
    ({**CURVE, "by": "k"}, PLANE, "by", "'k'", "needs the dimension k"),
    ({**CURVE, "by": "N"}, {**PLANE, "N": [*range(13)]}, "by", "'N'", "has 13 values"),
    # what remains
    (MAP, CUBE, "at.k", "", "is required, one of [20000.0, 50000.0]; or by: k"),
    ({"kind": "campbell"}, {"N": [1, 2]}, "at.N", "", "is required, one of [1, 2]"),
    ({**MAP, "at": {"k": 3e4}}, CUBE, "at.k", "30000", "must be one of [20000.0, 50000.0]"),
    ({**MAP, "at": {"N": 100}}, PLANE, "at.N", "100", "is no dimension that remains"),
    (
        {**MAP, "at": {"normalization": "orthonormal"}},
        PLANE,
        "at.normalization",
        "'orthonormal'",
        "",
    ),
    # further studies
    ({**OUTCOME, "overlays": {}}, PLANE, "overlays.sliding", "", "a study of the quantity sliding"),
    ({**MAP, "overlays": {"curves": "s"}}, PLANE, "overlays.curves", "'s'", "unknown role"),
]


@pytest.mark.parametrize(("phrase", "dims", "path", "value", "rule"), FAULTS)
def test_what_a_study_does_not_have_is_named_with_its_rule(
    phrase: dict[str, Any], dims: dict[str, Any], path: str, value: str, rule: str
) -> None:
    [fault] = faults_of(phrase, dims)
    assert ".".join(fault.path) == path
    assert value in fault.value
    assert rule in fault.rule


@pytest.mark.parametrize(
    ("phrase", "dims"),
    [
        (MAP, PLANE),
        ({**MAP, "by": "k"}, CUBE),
        ({**MAP, "at": {"k": "20 kN/m"}}, CUBE),
        ({**CURVE, "by": "N", "names": {100: "light", 2e2: "heavy"}}, PLANE),
        ({**CURVE, "variable": "exponent", "by": "exponent_number"}, {**NORMAL, "Omega": [1, 2]}),
        (OUTCOME, PLANE),
        ({"kind": "critical_speed"}, {"N": [1, 2], **NORMAL}),
        ({"kind": "basins", "x": "Omega"}, {"Omega": [1, 2], **NORMAL}),
        ({"kind": "range_law"}, {**CUBE, "h": [1.0, 2.0]}),
    ],
)
def test_what_a_study_has_is_shown(phrase: dict[str, Any], dims: dict[str, Any]) -> None:
    assert not faults_of(phrase, dims)


# ---- A figure and its cases

PLAIN = Window(start=0, stop=2, rate=100)
WINDOWS = {
    "plain": PLAIN,
    "folded": PLAIN.replace(envelope=10),
    "brief": Window(start=0, stop=1, rate=100),
    "poincare": Poincare(),
}
CASES = {"A": WINDOWS, "B": {}, "broken": None}


@pytest.mark.parametrize(
    ("phrase", "path", "value", "rule"),
    [
        ({**HISTORY, "case": "C"}, "case", "'C'", "no such case (known: A, B, broken)"),
        ({**HISTORY, "window": "plan"}, "window", "'plan'", "did you mean plain"),
        ({**HISTORY, "case": "B"}, "window", "'late'", "is not recorded by case B"),
        ({**HISTORY, "window": "poincare"}, "window", "'poincare'", "must be a window"),
        ({"kind": "portrait", "case": "A", "window": "folded"}, "window", "'folded'", "without an"),
        ({"kind": "spectrum", "case": "A", "window": "poincare"}, "window", "'poincare'", "window"),
        ({"kind": "poincare", "case": "B"}, "case", "'poincare'", "is not recorded by case B"),
        ({"kind": "poincare", "case": "A", "below": ["B"]}, "case", "'poincare'", "by case B"),
    ],
)
def test_what_a_case_does_not_have_is_named_with_its_rule(
    phrase: dict[str, Any], path: str, value: str, rule: str
) -> None:
    [fault] = plot_of(phrase).faults(CASES)
    assert ".".join(fault.path) == path
    assert fault.value == value
    assert rule in fault.rule


@pytest.mark.parametrize(
    "phrase",
    [
        {**HISTORY, "window": "plain"},
        {**HISTORY, "window": "folded"},
        {**HISTORY, "case": "broken"},
        {"kind": "portrait", "case": "A", "window": "brief"},
        {"kind": "spectrum", "case": "A", "window": "plain"},
        {"kind": "poincare", "case": "A", "below": ["A", "broken"]},
    ],
)
def test_what_a_case_has_is_shown(phrase: dict[str, Any]) -> None:
    assert not [*plot_of(phrase).faults(CASES)]
