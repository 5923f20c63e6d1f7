"""Critical speeds: all speeds at which separation within a horizon begins or ends, since there may
be several.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Annotated, Any, ClassVar

from pydantic import AfterValidator, Field

from disc_model.data.variables import OF_QUANTITIES, value_with_unit
from disc_model.parameters import Parameters
from disc_model.studies.quantity import Coordinate, OutcomeResult, Point, Quantity, Range, listed
from disc_model.units import Count, Seconds, Speed, Tolerance, Unit

_MULTIPLE = (
    "the scan's step of {0.step:.6g} rad/s must be a multiple of precision={0.precision:.6g} rad/s"
)


class CriticalSpeed(Quantity):
    """Scan of the speed, then bisection of each interval in which separation begins or ends."""

    tol: Tolerance = 1e-10
    """tolerance of simulations: error of event times after a second of motion"""
    early_end: bool = True
    """whether a simulation ends as soon as its outcome is known"""
    extrapolate: bool = True
    """whether slow departures from cycles are extrapolated, which halves the time; their separations are not timed"""
    horizons: Annotated[
        tuple[Seconds, ...], Field(min_length=1), AfterValidator(lambda h: tuple(sorted(set(h))))
    ]
    """times within which separation must occur; each has a critical speed of its own"""
    scan: Annotated[Range, Unit("rad/s")]
    """speeds that are looked at first, evenly spaced"""
    precision: Speed = 0.1
    """width to which crossings are bisected; the scan's step must be a multiple"""
    max_crossings: Annotated[Count, Field(ge=1, le=10_000)] = 12
    """room for that many crossings"""

    _rules = (
        (lambda o: o.scan.scale == "linear", "scan must be linear"),
        (lambda o: 0.5 < o.ratio < math.inf and abs(o.ratio - round(o.ratio)) <= 1e-6, _MULTIPLE),
    )

    @property
    def step(self) -> float:
        """The scan's step, rad/s."""
        return (self.scan.stop - self.scan.start) / self.scan.intervals

    @property
    def ratio(self) -> float:
        """The scan's step as a multiple of the precision."""
        return self.step / self.precision

    @property
    def starts(self) -> int:
        return self.scan.intervals + 1

    points_per_job: ClassVar = 5
    scans: ClassVar = ("Omega",)
    COLUMNS: ClassVar = OF_QUANTITIES["critical_speed"]["columns"]
    COORDINATES: ClassVar = {
        "horizon": Coordinate(lambda o: o.horizons),
        "crossing_number": Coordinate(lambda o: range(o.max_crossings), "max_crossings"),
        "scan_Omega": Coordinate(lambda o: o.scan.values),
    }

    def compute_point(self, point: Point) -> tuple[dict[str, Any], str]:
        scanned = [i * round(self.ratio) for i in range(self.scan.intervals + 1)]
        motions = self._follow(point.parameters, scanned)
        failed = {i: result for i, result in motions.items() if result.status != "ok"}
        values: dict[str, Any] = {
            "status": next((result.status for result in failed.values()), "ok"),
            "scan_outcome": [motions[i].word for i in scanned],
            "scan_first_separation": [motions[i].timed_separation for i in scanned],
            "scan_status": [motions[i].status for i in scanned],
            "simulations": len(motions),
            "simulated_time": sum(result.simulated for result in motions.values()),
        }
        known = _first_separations(motions)
        crossings = [_crossings(known, horizon, self._speed) for horizon in self.horizons]
        values.update(listed(crossings))
        remarks = []
        for i, each in failed.items():
            place = value_with_unit("Omega", self._speed(i))
            remarks.append(f"{place}: {each.message}")
        return values, "; ".join(remarks)

    def _follow(self, p: Parameters, scanned: Sequence[int]) -> dict[int, OutcomeResult]:
        """Follow the motion from the static start, up to the longest horizon, at the speeds of the
        scan and wherever else crossings are sought; by places on the lattice."""
        from disc_model.stability.follower import find_outcome

        motions: dict[int, OutcomeResult] = {}
        times = self.horizons if self.extrapolate else ()

        def look(i: int) -> None:
            result = find_outcome(
                p.replace(Omega=self._speed(i)),
                self.horizons[-1],
                tol=self.tol,
                early=self.early_end,
                compared_with=times,
            )
            # return maps would take megabytes each for a disc of many modes
            motions[i] = replace(result, near=None)

        for i in scanned:
            look(i)
            self.start_is_done()
        for horizon in self.horizons:
            # every interval over which separation within the horizon begins or ends is halved, down
            # to the lattice
            while middles := _middles(_first_separations(motions), horizon):
                for i in middles:
                    look(i)
        return motions

    def _speed(self, i: int) -> float:
        """Speed, rad/s, of a place on the lattice of the precision."""
        place, within = divmod(i, round(self.ratio))
        if within == 0:
            return self.scan.value_at(place)
        return float(f"{self.scan.start + i * self.precision:.12g}")


def _first_separations(motions: Mapping[int, OutcomeResult]) -> dict[int, float]:
    """Times of the first separations of several motions."""
    return {i: _first_separation(result) for i, result in motions.items()}


def _first_separation(result: OutcomeResult) -> float:
    """Time of the first separation, s: infinite if there is none, nan if that is not known."""
    if math.isnan(result.first_separation) and result.status == "ok":
        return math.inf
    return result.first_separation


def _middles(known: dict[int, float], horizon: float) -> list[int]:
    """Middles of the intervals, wider than the lattice's, over which separation begins or ends."""
    return [(a + b) // 2 for a, b in _changes(known, horizon) if b - a > 1]


def _changes(known: dict[int, float], horizon: float) -> list[tuple[int, int]]:
    """Pairs of neighbours on the lattice of which only one separates within the horizon; nan,
    unknown, is in none."""
    changes = []
    for a, b in pairwise(sorted(known)):
        decided = not math.isnan(known[a] + known[b])
        if decided and (known[a] <= horizon) != (known[b] <= horizon):
            changes.append((a, b))
    return changes


def _crossings(
    known: dict[int, float], horizon: float, speed: Callable[[int], float]
) -> dict[str, Any]:
    """Columns of the crossings for a horizon, and the critical speed."""
    changes = [b for _, b in _changes(known, horizon)]
    # the lowest speed that separates; an unknown speed hides those above it
    first = next((i for i in sorted(known) if not known[i] > horizon), None)
    lowest = math.nan
    if first is not None and not math.isnan(known[first]):
        lowest = speed(first)
    return {
        "critical_speed": lowest,
        "n_crossings": len(changes),
        "crossing": [speed(b) for b in changes],
        "crossing_kind": ["begins" if known[b] <= horizon else "ends" for b in changes],
    }
