"""All kinds of figures: how they are found, and that each has an example, which is drawn."""

import pytest

from disc_model.figures.drawings import DRAWINGS
from disc_model.figures.kinds import KINDS, CasePlot, General, Plot, kind_of
from disc_model.parameters import Parameters
from disc_model.studies.registry import quantity_names
from tests.figures.every_kind import EXAMPLES
from tests.processes import python
from tests.refusals import refusal


@pytest.mark.parametrize("name", KINDS)
def test_a_kind_shows_a_quantity_over_parameters_and_has_an_example(name: str) -> None:
    kind = KINDS[name]
    assert issubclass(kind, CasePlot | Plot)
    if issubclass(kind, Plot) and not issubclass(kind, General):
        plane = (
            {"x": "N", "y": "Omega"}
            if "y" in kind.model_fields
            else {"x": "N"}
            if "x" in kind.model_fields
            else {}
        )
        assert {*kind.quantities} <= {*quantity_names()}
        assert {*kind(**plane).dims} <= {*Parameters.model_fields, "perturbation_u"}
    assert name in EXAMPLES, f"add a function {name} to tests/figures/every_kind.py"


def test_kinds_are_listed_by_their_names_and_each_has_a_drawing() -> None:
    assert {*DRAWINGS} == {*KINDS}
    for name, kind in KINDS.items():
        assert kind.model_fields["kind"].default == name


@pytest.mark.parametrize(
    "name", ["chart", "paper.chart", "paper", "", None, ["heat_map"], "kind", "..errors"]
)
def test_another_name_is_no_kind(name: object) -> None:
    with refusal("unknown kind of figure"):
        kind_of(name)


def test_a_study_is_checked_without_what_draws_and_without_the_paper() -> None:
    code = "import sys, disc_model.studies.study; print(*sorted({name.split('.')[0] for name in sys.modules}))"
    assert {"matplotlib", "numba"}.isdisjoint(python(code).stdout.split())
    code = "import sys, disc_model.studies.study; print(*(name for name in sys.modules if '.paper' in name))"
    assert python(code).stdout.split() == []
