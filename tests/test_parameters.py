"""Parameters: hashes, copies, JSON, and what a disc of one's own leaves out."""

import copy
import json
import pickle
from collections.abc import Callable
from typing import Any

import pytest

from disc_model import Disc, Parameters
from disc_model.parameters import PLATE
from tests.processes import python

P = Parameters(N=385, Omega=15.1)
DISC = Disc(diameters=[0, 3], omega=[1490, 1515], amplitude=[1.53, 2.16])
OF_MODES = Parameters(N=385, Omega=15.1, disc=DISC, r_0=0.1)
LAWS = P.replace(friction_decay=0.1 + 0.2, contact_compliance="residual")
OTHERS: dict[str, Any] = {
    "normalization": "orthonormal",
    "contact": "bilateral",
    "n_diameters": 3,
    "n_circles": 1,
    "c": 1,
    "c_p": 1,
    "contact_compliance": 1e-7,
    "contact_force": "normal",
    "contact_arc": 0.4,
    "damping_ratio": 1e-3,
    "friction_offset": 1e-3,
    "friction_decay": 2.0,
    "friction_law": "exponential",
    "viscous_friction": 0.1,
    "stretching": "clamped",
    "disc": DISC,
}


@pytest.mark.parametrize("name", sorted(Parameters.model_fields))
def test_the_key_changes_with_every_parameter(name: str) -> None:
    value = OTHERS.get(name)
    if value is None:
        value = getattr(P, name) * 0.999
    assert P.replace(**{name: value}).key != P.key


@pytest.mark.parametrize(
    "values", [{"Omega": "15.1", "N": "0.385 kN", "contact_compliance": "0"}, {"k_p": -0.0}]
)
def test_the_key_is_that_of_the_values_however_they_are_written(values: dict[str, Any]) -> None:
    plain = {"N": 385, "Omega": 15.1} | {name: 0 for name in values if name == "k_p"}
    assert Parameters(**{"N": 385, "Omega": 15.1, **values}).key == Parameters(**plain).key


@pytest.mark.parametrize("case", [P, LAWS, OF_MODES])
@pytest.mark.parametrize(
    "copied",
    [
        lambda p: Parameters.model_validate_json(p.model_dump_json()),
        lambda p: Parameters.model_validate_json(p.canonical_json),
        lambda p: pickle.loads(pickle.dumps(p)),
        copy.deepcopy,
        Parameters.replace,
    ],
)
def test_a_copy_is_equal(copied: Callable[[Parameters], Parameters], case: Parameters) -> None:
    again = copied(case)
    assert again == case
    assert hash(again) == hash(case)
    assert again.key == case.key


def test_numbers_are_those_that_may_change() -> None:
    assert "contact_compliance" not in P.numbers
    assert P.replace(contact_compliance=1e-7).numbers["contact_compliance"] == 1e-7
    assert "D_star" not in P.replace(damping_ratio=1e-3).numbers
    assert not {*PLATE} & OF_MODES.numbers.keys()


def test_a_disc_of_ones_own_stores_nothing_of_the_plate() -> None:
    assert not {*PLATE} & {*json.loads(OF_MODES.canonical_json)}


def test_import_is_light() -> None:
    heavy = "{'numba', 'xarray', 'pandas', 'matplotlib', 'pint'}"
    code = f"import sys, disc_model; disc_model.Parameters(N='1e2', Omega=1); print({heavy} & set(sys.modules))"
    assert python(code).stdout.strip() == "set()"
