"""What the quantity `locking` says of motions that repeat, and of those that do not."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from disc_model.parameters import Parameters
from disc_model.simulation.case import Start
from disc_model.stability import locking
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
def test_a_motion_that_still_settles_has_the_period_of_its_cycle() -> None:
    """It had twice the period: after 80 s the intervals alternate by more than what counts as
    repetition, and after 150 s they no longer do."""
    options = {"transient": 80, "record": 10, "max_record": 20}
    values, _ = Locking.model_validate(options).compute_point(
        Point(Parameters(N=385, Omega=15.1), Start())
    )
    assert values["period_releases"] == 2
    assert values["period_separations"] == 2
    assert values["period"] == pytest.approx(0.01477058, rel=1e-6)
    assert values["leading_multiplier"] == pytest.approx(0.99842, abs=1e-5)


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


@pytest.mark.parametrize(("size", "motion"), [(0.5, "locked"), (1.5, "undecided")])
def test_only_a_stable_cycle_proves_that_a_motion_is_locked(
    size: float, motion: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A disturbance of the size 0.5 after 0.06 s decays at ln(0.5)/0.06."""
    lock = locking.Lock(3, 9, 0.06, 0.0)
    multipliers = size * np.array([1j, -1j, 0.4])
    cycle = SimpleNamespace(jacobian=None)
    made: dict[str, Any] = {
        "releases_of": lambda run: run,
        "lock_of": lambda found: lock,
        "cycle_at": lambda p, state, lock: cycle,
        "lock_on": lambda cycle, found, lock: lock,
        "swing_multiplier": lambda p, run, lock: 0.7,
    }
    for name, function in made.items():
        monkeypatch.setattr(locking, name, function)
    monkeypatch.setattr("disc_model.stability.cycle.multipliers", lambda jacobian: multipliers)
    monkeypatch.setattr("disc_model.simulation.api.simulate", lambda *_, **__: None)
    values: dict[str, Any] = {"motion": "locked"}
    run: Any = SimpleNamespace(parameters=Parameters(N=200, Omega=20), final_state=None)
    message = Locking()._prove(run, values)
    assert values["motion"] == motion
    if motion == "undecided":
        assert message == "no stable cycle of 3 releases was found at the motion"
        return
    assert message == ""
    assert values["leading_multiplier"] == 0.5
    assert values["growth_rate"] == pytest.approx(math.log(0.5) / 0.06)
    assert values["real_multiplier"] == pytest.approx(0.2)
    assert values["swing_multiplier"] == 0.7


@pytest.mark.parametrize(
    ("repeats_in", "lengths"), [(0.0, [20, 40, 80, 160]), (40.0, [20, 40]), (20.0, [20])]
)
def test_a_record_is_doubled_until_it_shows_what_the_motion_is(
    repeats_in: float, lengths: list[float], monkeypatch: pytest.MonkeyPatch
) -> None:
    recorded: list[float] = []

    def simulate(p: Parameters, *, duration: float, tol: float, initial_state: Any) -> Any:
        recorded.append(duration)
        return SimpleNamespace(status=SimpleNamespace(complete=True))

    def read(self: Locking, run: Any) -> dict[str, Any]:
        shown = recorded[-1] == repeats_in
        return {"motion": "in_contact" if shown else "undecided"}

    monkeypatch.setattr("disc_model.simulation.api.simulate", simulate)
    monkeypatch.setattr("disc_model.simulation.starts.state_after", lambda *_: None)
    monkeypatch.setattr(Locking, "_read", read)
    values, _ = Locking().compute_point(Point(Parameters(N=200, Omega=20)))
    assert recorded == lengths
    assert values["record_time"] == lengths[-1]
