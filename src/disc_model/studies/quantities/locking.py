"""Whether a motion with stick and separation repeats after a whole number of releases, and how
strongly it is held there."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from xarray import Dataset

from disc_model.parameters import Parameters
from disc_model.simulation.case import Start
from disc_model.studies.quantity import STATIC, Row, found, quantity
from disc_model.units import Natural, Seconds, Tolerance

if TYPE_CHECKING:
    from disc_model.simulation.result import Result
    from disc_model.stability.locking import Lock

RELEASES = 50  # whose phases are stored


@quantity(
    points_per_job=90,
    rules=(
        (
            lambda o: o.record <= o.max_record,
            "record={0.record:g} must be <= max_record={0.max_record:g}",
        ),
    ),
)
def locking(
    case: Parameters,
    *,
    transient: Seconds = 60.0,
    record: Seconds = 20.0,
    max_record: Seconds = 160.0,
    multipliers: bool = True,
    probes: Natural = 0,
    start: Start = STATIC,
    tol: Tolerance = 1e-10,
) -> Dataset:
    """Number of releases of stick after which a motion that separates repeats, mean number of separations between
    them, and multipliers of the repeating motion.

    Parameters
    ----------
    transient : time left out at the beginning
    record : time recorded; doubled until the motion repeats in it
    max_record : longest time recorded
    multipliers : whether the motion counts as locked only if Newton's method finds a stable cycle at it, whose period
        is then given; without this, that of a motion which still settles may be a multiple
    probes : number of places at which the map of release phases is computed
    start : start of the motion
    tol : tolerance of simulations: error of event times after a second of motion

    Examples
    --------
    >>> import disc_model as dm
    >>> case = dm.Parameters(N=200, Omega=15)
    >>> dm.locking(case, transient=2, record=2, max_record=2, multipliers=False)["motion"].item()
    'in_contact'
    """
    from disc_model.simulation.api import simulate
    from disc_model.simulation.starts import state_after
    from disc_model.stability.locking import lock_of, phase_map, releases_of

    state = state_after(case, start, transient, tol)
    while True:
        run = simulate(case, duration=record, tol=tol, initial_state=state).raise_for_status()
        taken = releases_of(run)
        if taken is None:
            values: Row = {"motion": _without_releases(run)}
            lock = None
        else:
            values = {
                "motion": "undecided",
                "separations_per_release": float(np.mean(taken.vibrations)),
                "release_phase": taken.phases[:RELEASES],
            }
            lock = lock_of(taken)
        if lock or values["motion"] != "undecided" or 2 * record > max_record:
            break
        record *= 2
    message = ""
    if lock:
        values |= _columns_of(lock)
    if lock and multipliers:
        proof = _proof(run, lock)
        if proof is None:
            message = f"no stable cycle of {lock.releases} releases was found at the motion"
            values["motion"] = "undecided"
        else:
            values |= proof
    if probes:
        phases = phase_map(case, run, probes, tol)
        values |= {
            "map_phase": phases.phases,
            "map_next_phase": phases.following,
            "map_separations": phases.vibrations.astype(float),
            "map_slope": phases.slopes,
        }
    return found("locking", values, message, release=range(RELEASES), probe=range(probes))


def _without_releases(run: Result) -> str:
    """What a motion does that is not released from stick again and again while it separates."""
    kinds = {*run.events["kind"]}
    if "separation" not in kinds:
        return "in_contact"
    if "stick_to_slip" not in kinds:
        return "without_stick"
    return "undecided"


def _proof(run: Result, lock: Lock) -> Row | None:
    """Columns of the stable cycle that a motion is on; None without one."""
    from disc_model.stability.cycle import multipliers
    from disc_model.stability.locking import Lock, locked_cycle

    cycle = locked_cycle(run.parameters, run.final_state, lock)
    if cycle is None:
        return None
    known = multipliers(cycle.jacobian)
    if not abs(known[0]) < 1:
        return None
    if cycle.counts.releases < lock.releases:
        lock = Lock(cycle.counts.releases, cycle.counts.separations, cycle.period)
    real = known[np.abs(known.imag) <= 1e-9 * np.abs(known)].real
    return {
        **_columns_of(lock),
        "leading_multiplier": float(abs(known[0])),
        "growth_rate": math.log(abs(known[0])) / lock.period,
        "real_multiplier": float(real.max(initial=-math.inf)),
    }


def _columns_of(lock: Lock) -> Row:
    """Columns of the period of a motion that repeats."""
    return {
        "motion": "locked",
        "separations_per_release": lock.vibrations / lock.releases,
        "period_releases": lock.releases,
        "period_separations": lock.vibrations,
        "period": lock.period,
    }
