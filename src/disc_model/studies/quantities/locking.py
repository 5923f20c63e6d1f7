"""Whether a motion with stick and separation repeats after a whole number of releases, and how
strongly it is held there."""

import math
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import numpy as np
from pydantic import Field

from disc_model.data.variables import OF_QUANTITIES
from disc_model.simulation.case import Start, Window
from disc_model.studies.quantity import Coordinate, Point, Quantity, Result
from disc_model.units import Count, Seconds, Tolerance

if TYPE_CHECKING:
    from disc_model.stability.locking import Lock

RATE = 1e5  # Hz, of the contact force at releases: a stick lasts half a millisecond


class Locking(Start, Quantity):
    """Number of releases of stick after which a motion that separates repeats, mean number of
    separations between them, and multipliers of the repeating motion."""

    tol: Tolerance = 1e-10
    """tolerance of simulations: error of event times after a second of motion"""
    transient: Seconds = 60.0
    """time left out at the beginning"""
    record: Seconds = 20.0
    """time recorded; doubled until the motion repeats in it"""
    max_record: Seconds = 160.0
    """longest time recorded"""
    multipliers: bool = True
    """whether the motion counts as locked only if Newton's method finds a stable cycle at it, whose
    period is then given; without this, that of a motion which still settles may be a multiple"""
    releases: Annotated[Count, Field(ge=1, le=10_000)] = 50
    """number of releases whose phases are stored"""
    probes: Annotated[Count, Field(ge=0, le=10_000)] = 0
    """number of places at which the map of release phases is computed"""

    _rules = (
        (
            lambda o: o.record <= o.max_record,
            "record={0.record:g} must be <= max_record={0.max_record:g}",
        ),
    )
    points_per_job: ClassVar = 90
    COLUMNS: ClassVar = OF_QUANTITIES["locking"]["columns"]
    COORDINATES: ClassVar = {
        "release": Coordinate(lambda o: range(o.releases)),
        "probe": Coordinate(lambda o: range(o.probes)),
    }

    def compute_point(self, point: Point) -> tuple[dict[str, Any], str]:
        from disc_model.simulation.api import simulate
        from disc_model.simulation.starts import state_after

        p = point.parameters
        state = state_after(p, point.start, self.transient, self.tol)
        record = self.record
        while True:
            run = simulate(p, duration=record, tol=self.tol, initial_state=state)
            if not run.status.complete:
                return {"status": run.status.value}, run.message
            values = self._read(run)
            if values["motion"] != "undecided" or 2 * record > self.max_record:
                break
            record *= 2
        message = ""
        if values["motion"] == "locked" and self.multipliers:
            message = self._prove(run, values)
        if self.probes:
            values |= self._map(run)
        return {"status": "ok", "record_time": record, **values}, message

    def _read(self, run: Result) -> dict[str, Any]:
        """What the record of a motion shows."""
        from disc_model.stability.locking import lock_of, releases_of

        kinds = run.events["kind"].to_numpy()
        found = releases_of(run)
        if found is None:
            motion = "undecided"
            if not (kinds == "separation").any():
                motion = "in_contact"
            elif not (kinds == "stick_to_slip").any():
                motion = "without_stick"
            return {"motion": motion}
        values: dict[str, Any] = {
            "motion": "undecided",
            "separations_per_release": float(np.mean(found.vibrations)),
            "separation_interval": found.vibration,
            "release_phase": found.phases,
            "release_separations": found.vibrations.astype(float),
        }
        lock = lock_of(found)
        if lock is not None:
            values |= {"motion": "locked", **_columns_of(lock)}
        return values

    def _prove(self, run: Result, values: dict[str, Any]) -> str:
        """Add the multipliers of the cycle that a motion is on; without a stable one it is undecided.
        Returns a message."""
        from disc_model.simulation.api import simulate
        from disc_model.stability.cycle import multipliers
        from disc_model.stability.locking import (
            cycle_at,
            lock_of,
            lock_on,
            releases_of,
            swing_multiplier,
        )

        p = run.parameters
        found = releases_of(run)
        lock = None if found is None else lock_of(found)
        if found is None or lock is None:
            return ""
        state = run.final_state
        cycle = cycle_at(p, state, lock)
        known = np.full(1, np.inf) if cycle is None else multipliers(cycle.jacobian)
        if cycle is None or not abs(known[0]) < 1:
            values["motion"] = "undecided"
            return f"no stable cycle of {lock.releases} releases was found at the motion"
        lock = lock_on(cycle, found, lock)
        values |= _columns_of(lock)
        windows = {"force": Window(last=1.1 * lock.period, rate=RATE)}
        period = simulate(
            p, windows=windows, duration=1.1 * lock.period, tol=self.tol, initial_state=state
        )
        real = known[np.abs(known.imag) <= 1e-9 * np.abs(known)].real
        values["leading_multiplier"] = float(abs(known[0]))
        values["growth_rate"] = math.log(abs(known[0])) / lock.period
        values["real_multiplier"] = float(real.max(initial=-math.inf))
        values["swing_multiplier"] = swing_multiplier(p, period, lock)
        return ""

    def _map(self, run: Result) -> dict[str, Any]:
        """Columns of the map of release phases."""
        from disc_model.stability.locking import phase_map

        found = phase_map(run.parameters, run, self.probes, self.tol)
        return {
            "map_phase": found.phases,
            "map_next_phase": found.following,
            "map_separations": found.vibrations.astype(float),
            "map_slope": found.slopes,
        }


def _columns_of(lock: "Lock") -> dict[str, Any]:
    """Columns of the period of a motion that repeats."""
    return {
        "separations_per_release": lock.vibrations / lock.releases,
        "period_releases": lock.releases,
        "period_separations": lock.vibrations,
        "period": lock.period,
        "period_residual": lock.closure,
    }
