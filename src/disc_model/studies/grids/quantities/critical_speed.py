"""Critical speeds: all speeds at which separation within a horizon begins or ends, since there may be several.

Motions are simulated from their start to the first separation. To extrapolate departures from a cycle would save a
quarter of the time, but moves first separations by more than 0.05 times of growth by e in a fifth of all cases.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from typing import Any

from disc_model.data.variables import SCALARS, Variable
from disc_model.parameters import Parameters
from disc_model.stability.attractor.outcome import OutcomeResult, find_outcome
from disc_model.studies.document import CriticalSpeedOptions
from disc_model.studies.grids.points import STATUS, Coordinate, Point, listed

KINDS = ("none", "begins", "ends")
_EACH, _CROSSINGS = ("horizon",), ("horizon", "crossing_number")
COLUMNS = {
    "status": STATUS,
    "critical_speed": Variable(
        "rad s-1",
        "lowest speed computed with separation within the horizon, nan if there is none or one below failed",
        dims=_EACH,
    ),
    "n_crossings": Variable(
        "1", "number of speeds found at which separation within the horizon begins or ends", dims=_EACH, whole=True
    ),
    "crossing": Variable(
        "rad s-1", "a speed at which separation begins or ends, upper end of the last interval", dims=_CROSSINGS
    ),
    "crossing_kind": Variable("1", "whether separation begins or ends as the speed rises", KINDS, dims=_CROSSINGS),
    "scan_first_separation": SCALARS["first_separation"]._replace(dims=("scan_Omega",)),
    "scan_status": STATUS._replace(dims=("scan_Omega",)),
    "simulations": Variable("1", "number of simulations", whole=True),
    "simulated_time": Variable("s", "simulated time of all of them"),
}
COORDINATES = {
    "horizon": Coordinate("s", "time within which separation must occur", lambda o: o.horizons),
    "crossing_number": Coordinate("1", "number of the crossing, as the speed rises", lambda o: range(o.max_crossings)),
    "scan_Omega": Coordinate("rad s-1", "speed of the drive point, in the scan", lambda o: o.scan.values),
}


def compute_point(point: Point, options: CriticalSpeedOptions) -> tuple[dict[str, Any], str]:
    """Scan and bisect the speed; the point's own Omega is not used."""
    p, scan = point.parameters, options.scan
    motions: dict[int, OutcomeResult] = {}
    known: dict[int, float] = {}

    def speed(i: int) -> float:
        return float(f"{scan.start + i * options.precision:.12g}")

    def look(i: int) -> None:
        """Compute the motion at the i-th speed of the lattice, which is not known yet."""
        # their return maps would take megabytes each for a disc of many modes
        found = motions[i] = replace(motion(p.replace(Omega=speed(i)), options), near=None, departed=None)
        none = math.isnan(found.first_separation) and found.status == "ok"
        known[i] = math.inf if none else found.first_separation

    scanned = [i * round(options.step) for i in range(scan.intervals + 1)]
    for i in scanned:
        look(i)
    for horizon in options.horizons:
        # every interval over which separation within the horizon begins or ends is halved, down to the lattice
        while wide := [(a + b) // 2 for a, b in _changes(known, horizon) if b - a > 1]:
            for i in wide:
                look(i)
    failed = {i: found for i, found in motions.items() if found.status != "ok"}
    values: dict[str, Any] = {
        "status": next((found.status for found in failed.values()), "ok"),
        "scan_first_separation": [motions[i].first_separation for i in scanned],
        "scan_status": [motions[i].status for i in scanned],
        "simulations": len(motions),
        "simulated_time": sum(found.simulated for found in motions.values()),
    }
    values |= listed([_crossings(known, horizon, speed) for horizon in options.horizons])
    return values, "; ".join(f"Omega={speed(i):g}: {found.message}" for i, found in failed.items())


def motion(case: Parameters, options: CriticalSpeedOptions) -> OutcomeResult:
    """The motion from the static start, up to the longest horizon."""
    return find_outcome(case, options.horizons[-1], tol=options.tol, furthest=0.0, early=options.early_end)


def _changes(known: dict[int, float], horizon: float) -> list[tuple[int, int]]:
    """Pairs of neighbours of which only one separates within the horizon; unknown ones belong to no pair.

    known : first separations by place on the lattice, s; inf without one within the longest horizon, nan if unknown
    """
    return [
        (a, b)
        for a, b in pairwise(sorted(known))
        if not math.isnan(known[a] + known[b]) and (known[a] <= horizon) != (known[b] <= horizon)
    ]


def _crossings(known: dict[int, float], horizon: float, speed: Callable[[int], float]) -> dict[str, Any]:
    """Crossings of one horizon among the known speeds."""
    changes = [b for _, b in _changes(known, horizon)]
    # the lowest speed that separates; an unknown speed hides those above it
    first = next((i for i in sorted(known) if not known[i] > horizon), None)
    lowest = math.nan if first is None or math.isnan(known[first]) else speed(first)
    return {
        "critical_speed": lowest,
        "n_crossings": len(changes),
        "crossing": [speed(b) for b in changes],
        "crossing_kind": ["begins" if known[b] <= horizon else "ends" for b in changes],
    }
