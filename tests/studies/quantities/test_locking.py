"""What the quantity `locking` says of motions that repeat, and of those that do not."""

from typing import Any

import numpy as np
import pytest

from disc_model.parameters import Parameters
from disc_model.simulation.case import Start
from disc_model.studies.quantities.locking import Locking
from disc_model.studies.quantity import Point

SHORT = {"transient": 5, "record": 5, "max_record": 10}


def measured(start: dict[str, Any], options: dict[str, Any], **changes: Any) -> dict[str, Any]:
    """Columns of a case from a motion of another one."""
    p = Parameters(**{"normalization": "as_published", "N": 200, "Omega": 20, **changes})
    quantity = Locking.model_validate(options)
    values, message = quantity.compute_point(Point(p, Start.model_validate({"prerun": start})))
    assert not message
    return values


@pytest.mark.compiled
def test_a_motion_that_repeats_is_locked_on_a_stable_cycle() -> None:
    found = measured({"parameters": {}, "time": 300}, {"transient": 60}, N=300)
    assert found["motion"] == "locked"
    assert found["period_releases"] == 45
    assert found["period_separations"] == 316
    assert found["separations_per_release"] == 316 / 45
    assert found["leading_multiplier"] < 1
    assert 0 < found["real_multiplier"] < found["leading_multiplier"]
    assert found["swing_multiplier"] == pytest.approx(found["real_multiplier"], rel=0.1)
    assert found["release_separations"].sum() == pytest.approx(
        found["separations_per_release"] * len(found["release_separations"]), rel=0.05
    )


@pytest.mark.compiled
def test_a_motion_from_another_start_never_sticks() -> None:
    after = {"parameters": {"N": 385, "Omega": 15.1}, "time": 70}
    assert measured(after, SHORT)["motion"] == "without_stick"


@pytest.mark.compiled
def test_a_motion_in_contact_is_neither() -> None:
    assert measured({"parameters": {}, "time": 5}, SHORT)["motion"] == "in_contact"


@pytest.mark.compiled
def test_a_motion_of_a_disc_with_nodal_circles_is_undecided() -> None:
    """It is irregular: no record shows a period."""
    start = {"parameters": {"N": 385, "Omega": 20}, "time": 60}
    found = measured(start, SHORT, n_circles=1)
    assert found["motion"] == "undecided"
    assert "period_releases" not in found
    assert np.isfinite(found["separations_per_release"])
