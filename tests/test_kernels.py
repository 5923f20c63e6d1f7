"""Kinds of kernels: which cases need which."""

import pytest

from disc_model import Parameters, Ramp
from disc_model.disc.truncation import ModeRequest
from disc_model.engine.layout import HALF
from disc_model.kernels import KINDS, LAWS, PAIRS_OF_A_BLOCK, example, kinds_of, kinds_of_case
from disc_model.simulation.case import CaseSpec, Prerun, Start
from disc_model.simulation.states import engine_case

P = Parameters(N=385, Omega=15)
RAMP = Ramp(parameter="Omega", to=10.0, start=1.0, end=2.0)
SIMULATED = {"simulate-rigid_vertical", "simulate-rigid_vertical-wide"}


@pytest.mark.parametrize("kind", KINDS)
def test_an_example_is_what_the_compiler_takes_for_its_kind(kind: str) -> None:
    assert HALF == PAIRS_OF_A_BLOCK
    task, law, *wide = kind.split("-")
    model = engine_case(example(kind)).model
    flags = bool(model.wide), bool(model.compliant), bool(model.normal)
    assert flags == (bool(wide), law.startswith("compliant"), law.endswith("normal"))
    assert kinds_of([example(kind).model_dump()], [task]) == [kind]


@pytest.mark.parametrize(
    ("spec", "kinds"),
    [
        ({}, {"simulate-rigid_vertical"}),
        ({"parameters": P.replace(n_diameters=2, n_circles=1)}, {"simulate-rigid_vertical"}),
        ({"parameters": P.replace(n_circles=1)}, {"simulate-rigid_vertical-wide"}),
        ({"parameters": P.replace(contact_compliance=1e-8)}, {"simulate-compliant_vertical"}),
        ({"ramps": (RAMP,)}, {"simulate-rigid_vertical", "ramp-rigid_vertical"}),
        ({"modes": ModeRequest(quantity="first_separation", tolerance=0.01).model_dump_json()}, SIMULATED),
        (
            {"modes": ModeRequest(quantity="growth", tolerance=0.01).model_dump_json()},
            SIMULATED | {"floquet-rigid_vertical", "floquet-rigid_vertical-wide"},
        ),
        (
            {"start": Start(prerun=Prerun(parameters={"contact_force": "normal"}, time=1.0))},
            {"simulate-rigid_vertical", "simulate-rigid_normal"},
        ),
    ],
)
def test_a_case_needs_kernels_of_all_that_it_computes(spec: dict, kinds: set[str]) -> None:
    assert {*kinds_of_case(CaseSpec(**{"parameters": P, "t_end": 1.0} | spec))} == kinds


def test_points_need_the_kernels_of_their_laws() -> None:
    assert kinds_of([{}, *LAWS.values()], ["simulate"]) == [f"simulate-{law}" for law in LAWS]
    assert kinds_of([{"n_diameters": "auto"}], ["ramp"]) == ["ramp-rigid_vertical", "ramp-rigid_vertical-wide"]
