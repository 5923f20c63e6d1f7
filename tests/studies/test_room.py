"""Quantities that find more than their datasets have room for."""

from typing import Any

import numpy as np
import pytest

import disc_model as dm
from disc_model.parameters import Parameters
from disc_model.stability.follower import OutcomeResult
from disc_model.studies.quantities.basins import AttractorBasins
from disc_model.studies.quantities.branches import Branches, _Found
from disc_model.studies.quantities.campbell import Campbell
from disc_model.studies.quantities.stability_curves import StabilityCurves
from disc_model.studies.registry import quantity_names, quantity_of
from disc_model.studies.run import coordinates_of, with_cuts
from tests.studies.conftest import computed


@pytest.fixture
def alternating(monkeypatch: pytest.MonkeyPatch) -> None:
    """Separation at every second speed of a scan."""

    def motion(p: Parameters, horizon: float, **_: Any) -> OutcomeResult:
        first = np.nan
        if round(p.Omega) % 2:
            first = 1.0
        return OutcomeResult(first_separation=first)

    monkeypatch.setattr("disc_model.stability.follower.find_outcome", motion)


CUT = "4 were found along crossing_number, which has room for 3: raise max_crossings"


def test_crossings_without_room_are_told(alternating: None) -> None:
    """They were lost without a word."""
    case = Parameters(N=200, Omega=1)
    speeds = {"bounds": (2, 6), "step": 1, "precision": 1.0}
    found = dm.critical_speed(case, max_crossings=3, **speeds)
    assert found["n_crossings"] == 4
    assert found.attrs["message"] == CUT
    assert dm.critical_speed(case, max_crossings=4, **speeds).attrs["message"] == ""


def test_a_study_tells_it_at_the_point(alternating: None) -> None:
    scan = {"start": 2, "stop": 6, "step": 1}
    options = {"scan": scan, "horizons": [9], "precision": 1, "max_crossings": 3}
    axes = {"N": [200]}
    study = computed(quantity="critical_speed", options=options, base={}, axes=axes)
    assert study["message"].values.tolist() == [CUT]


def test_attractors_without_room_are_told() -> None:
    """The message named no option that gives them room."""
    basins = AttractorBasins(max_attractors=2)
    coordinates = coordinates_of(basins.COORDINATES, basins)
    assert coordinates["attractor"].values.tolist() == [1, 2]
    said = with_cuts("", {"attractor_starts": [5, 3, 1]}, basins, coordinates)
    assert said == "3 were found along attractor, which has room for 2: raise max_attractors"


def test_curves_and_branches_without_room_are_told() -> None:
    lines = {"start": 180, "stop": 420, "count": 3}
    curves = StabilityCurves(x_range=[3, 18], y_lines=lines, max_curves=2)
    coordinates = coordinates_of(curves.COORDINATES, curves)
    row = {"n_curves": 3, "kind": ["fold", "fold", "neutral"], "x": [np.ones(4)] * 3}
    said = with_cuts("slow", row, curves, coordinates)
    assert said == "slow; 3 were found along curve, which has room for 2: raise max_curves"

    scan = {"start": 14.75, "stop": 15.25, "step": 0.25}
    found = _Found(Branches(scan=scan, dwell=60, max_branches=1))
    assert found.message == ""
    found.left_out = 2
    assert found.message.startswith("2 cycles of further branches")
    assert found.message.endswith("raise max_branches")


def test_modes_without_room_are_told() -> None:
    """They were lost without a word, as they are an array."""
    few = Campbell(modes=2)
    coordinates = coordinates_of(few.COORDINATES, few)
    three = {"sliding_frequency": np.ones(3)}
    two = {"sliding_frequency": np.ones(2)}
    of_three = with_cuts("Look.", three, few, coordinates)
    of_two = with_cuts("Look.", two, few, coordinates)
    assert of_three == "Look; 3 were found along mode, which has room for 2: raise modes"
    assert of_two == "Look."


@pytest.mark.parametrize("name", quantity_names())
def test_what_gives_room_is_an_option(name: str) -> None:
    quantity = quantity_of(name)
    rooms = [coordinate.room for coordinate in quantity.COORDINATES.values() if coordinate.room]
    assert {*rooms} <= {*quantity.model_fields}
