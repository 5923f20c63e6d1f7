"""How many modes a study needs."""

import pytest

from disc_model import Parameters, choose_modes
from disc_model.mode_choice import RICH, frequency_error
from disc_model.simulation.api import run_case
from disc_model.simulation.case import CaseSpec
from disc_model.studies.study import parse_study

P = Parameters(N=385.0, Omega=15.1)


@pytest.mark.parametrize(
    ("normalization", "tolerance", "size"), [("as_published", 1e-4, (5, 3)), ("orthonormal", 1e-2, (4, 0))]
)
def test_choice_meets_the_tolerance_with_the_fewest_modes(normalization, tolerance, size):
    p = P.replace(normalization=normalization)
    choice = choose_modes(p, tolerance)
    chosen = choice.parameters
    assert (chosen.n_diameters, chosen.n_circles) == size
    assert choice.error <= tolerance
    rich = p.replace(n_diameters=RICH[0], n_circles=RICH[1])
    assert frequency_error(chosen, rich) == pytest.approx(choice.error, rel=1e-9)
    smaller = chosen.replace(n_diameters=chosen.n_diameters - 1)
    assert frequency_error(smaller, rich) > tolerance


@pytest.mark.compiled
def test_a_case_of_the_workflow_keeps_the_record_of_its_choice() -> None:
    raw = {"study": "s", "base": {"Omega": 15.1}, "cases": {}}
    raw["cases"]["A"] = {"title": "A", "t_end": 0.01, "parameters": {"N": 385, "n_diameters": "auto"}}
    raw["cases"]["B"] = {"title": "A", "t_end": 0.01, "parameters": {"N": 385, "n_diameters": 3}}
    automatic, given = parse_study(raw).specs.values()
    record = choose_modes(P).to_json()
    assert automatic.parameters == given.parameters
    assert (automatic.truncation, given.truncation) == (record, "")
    read = CaseSpec.from_canonical(automatic.canonical)
    assert read == automatic
    assert run_case(read).attrs["truncation"] == record
    assert "truncation" not in run_case(given).attrs
    assert "truncation" not in given.canonical
