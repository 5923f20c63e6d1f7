"""What may vary along a grid, and what is refused before anything is computed."""

import json
from typing import Any

import pytest

from disc_model.data.variables import PERTURBATIONS
from disc_model.parameters import Parameters
from disc_model.studies.grid import GridStudy
from tests.studies.refused import parse_grid

AFTER = {"prerun": {"parameters": {"N": 385, "Omega": 15.1}, "time": 56}}


def parsed(**changes: Any) -> GridStudy:
    raw = {"study": "x", "quantity": "outcome", "options": {"horizon": 2}, "base": {"N": 200, "Omega": 20}}
    return parse_grid(raw | changes)


@pytest.mark.parametrize("name", [name for name in Parameters.model_fields if name != "disc"])
def test_every_parameter_may_vary(name: str) -> None:
    field = Parameters.model_fields[name]
    values = {"N": [1, 2], "Omega": [1, 2], "n_diameters": [1, 2], "n_circles": [0, 1], "a": [0.02, 0.03]}
    values = (values | {"damping_ratio": [0.01, 0.02]}).get(name)
    values = values or (
        [field.default] if isinstance(field.default, str) else [field.default or 0.2, 0.9 * (field.default or 0.1)]
    )
    base = {other: 1 for other in ("N", "Omega") if other != name} | ({"mu_k": 0.1} if name == "mu_s" else {})
    study = parsed(base=base | ({"r_0": 0.05} if name == "b" else {}), axes={name: values})
    assert sorted(study.values[name]) == sorted((value,) for value in values)
    assert name not in study.base
    # the other laws of contact are not named where they are not asked for, so that batches keep their names
    later = {"contact_compliance", "contact_force", "damping_ratio", "disc"}
    assert set(study.base) | {name} | later == set(Parameters.model_fields)
    assert not set(study.base) & later


def test_extra_values_leave_the_batches_that_there_are() -> None:
    """At any resolution; a value that is there already is not computed twice."""
    axis, base = {"start": 0, "stop": 4, "count": 3}, {"N": 1, "Omega": 1}
    for resolution in (1, 2):
        before, after = (
            parse_grid({"study": "x", "quantity": "floquet", "base": base, "axes": {"c": given}}, resolution)
            for given in (axis, axis | {"extra": [2, 3.3]})
        )
        assert {(3.3,)} == set(after.values["c"]) - set(before.values["c"])
        assert set(before.batches) < set(after.batches)
        (new,) = set(after.batches) - set(before.batches)
        assert json.loads(after.batches[new])["points"] == [[3.3]]


def test_a_batch_knows_the_starts_that_its_points_have_and_no_others() -> None:
    def texts(starts: dict[str, Any], names: list[str]) -> dict[str, dict[str, Any]]:
        study = parsed(axes={"c": [0, 1], "start": names}, starts=starts, batch={"over": ["c"]})
        return {key: json.loads(text) for key, text in study.batches.items()}

    before = texts({"apart": AFTER}, ["static", "apart"])
    assert sorted(sorted(text["starts"]) for text in before.values()) == [["apart"], ["static"]]
    more = texts({"apart": AFTER, "kicked": {"perturbation": {"u": 1e-3}}}, ["static", "apart", "kicked"])
    assert set(before) < set(more)
    changed = texts({"apart": AFTER | {"perturbation": {"f": 1}}}, ["static", "apart"])
    assert len(set(before) & set(changed)) == 1


def test_kicks_are_axes_with_units() -> None:
    study = parsed(axes={name: [0, "1e-4"] for name in PERTURBATIONS})
    assert study.values == dict.fromkeys(PERTURBATIONS, ((0.0,), (0.0001,)))
    assert all(variable.units for variable in PERTURBATIONS.values())
