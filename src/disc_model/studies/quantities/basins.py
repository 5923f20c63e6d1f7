"""Basins of attraction at one point, from many starts: attractors, basin fractions and the critical
energy.

The first starts of all energies come first, then all second ones: further starts leave the earlier
ones unchanged.
"""

from collections import Counter
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import numpy as np
from pydantic import Field, PrivateAttr

from disc_model.data.variables import OF_QUANTITIES
from disc_model.errors import require
from disc_model.parameters import Parameters
from disc_model.simulation.case import Start
from disc_model.studies.quantity import MOST, Coordinate, OutcomeResult, Point, Quantity, listed
from disc_model.studies.shares_of_starts import (
    CLASSES,
    columns_of_attractor,
    columns_of_starts,
    fractions_of,
    remarks_of_undecided,
)
from disc_model.units import Count, Real, Seconds, Tolerance, Unit

if TYPE_CHECKING:
    from disc_model.stability.attractors import Basins

Energy = Annotated[Real, Field(ge=0, allow_inf_nan=False), Unit("J")]
SMALLEST = (
    2.0**-40
)  # fraction of the least separating energy of the sample, below which the bisection gives up
_ONE_START = (
    "n_starts={0.n_starts} must be 1 where an energy is 0, since no direction tells them apart"
)
Follow = Callable[[float, int, int], OutcomeResult]


class AttractorBasins(Start, Quantity):
    """Attractors, basin fractions and critical energy, from many starts."""

    tol: Tolerance = 1e-10
    """tolerance of simulations: error of event times after a second of motion"""
    energies: Annotated[tuple[Energy, ...], Field(min_length=1)] = (0.0,)
    """energies of the perturbations, ascending; 0 adds nothing"""
    n_starts: Annotated[Count, Field(ge=1, le=MOST)] = 1
    """number of starts at each energy, in random directions"""
    seed: Annotated[Count, Field(ge=0)] = 1
    """whole number that determines the directions"""
    horizon: Seconds = 200.0
    """longest simulated time of a motion"""
    attractor_tol: Annotated[Real, Field(ge=0, le=0.25)] = 0.1
    """relative difference of ranges at which a motion that approaches a known attractor has come
    to it; 0: all motions are followed to the horizon"""
    confidence: Annotated[Real, Field(gt=0, lt=1)] = 0.95
    """level of the confidence intervals of fractions"""
    n_bisection_directions: Annotated[Count, Field(ge=0, le=1000)] = 1
    """number of directions, those of the least separating energies, in which the critical energy
    is bisected"""
    precision: Annotated[Real, Field(gt=1e-6, le=1)] = 0.05
    """relative precision of the critical energy"""

    max_attractors: Annotated[Count, Field(ge=1, le=1000)] = 12
    """room for that many attractors, those of most starts first"""

    _found: Any = PrivateAttr(default=None)
    """Attractors of the last point's case, for points of a batch that differ only in their starts."""

    _rules = (
        (lambda o: [*o.energies] == sorted({*o.energies}), "energies={0.energies} must ascend"),
        (lambda o: o.n_starts == 1 or 0.0 not in o.energies, _ONE_START),
    )
    points_per_job: ClassVar = 5
    COLUMNS: ClassVar = OF_QUANTITIES["basins"]["columns"]
    COORDINATES: ClassVar = {
        "energy": Coordinate(lambda o: o.energies),
        "start": Coordinate(lambda o: range(o.n_starts)),
        "attractor_class": Coordinate(lambda o: CLASSES),
        # those of most starts come first; there are seven at 10 rad/s and 385 N
        "attractor": Coordinate(lambda o: range(1, o.max_attractors + 1), "max_attractors"),
    }

    @property
    def starts(self) -> int:
        return len(self.energies) * self.n_starts

    def compute_point(self, point: Point) -> tuple[dict[str, Any], str]:
        """Failed starts have a fraction of their own, and the point fails if all starts do."""
        from disc_model.simulation.starts import make_initial_state
        from disc_model.simulation.states import static_start
        from disc_model.stability.attractors import random_perturbation

        p = point.parameters
        modes_or_none = p.n_diameters >= 0 or not any(self.energies)
        rule = "must be 0 on a rigid disc, which has no modes to perturb; perturb f of the start"
        require((modes_or_none, "energies", self.energies, rule))
        start = make_initial_state(p, point.start, self.tol) or static_start(p)
        basins = self._basins_of(p)

        def follow(energy: float, i: int, j: int) -> OutcomeResult:
            """The outcome of a perturbation of any energy in the direction of start i of the j-th
            energy."""
            return basins.follow(random_perturbation(p, start, energy, (self.seed, j, i)))

        # the first starts of all energies come first
        by_start = []
        for i in range(self.n_starts):
            of_round: list[OutcomeResult] = []
            for j, energy in enumerate(self.energies):
                of_round.append(follow(energy, i, j))
                self.start_is_done()
            by_start.append(of_round)
        results = list(zip(*by_start, strict=True))
        every = [reached for row in results for reached in row]

        starts = Counter(reached.attractor for reached in every if reached.attractor is not None)
        # by decreasing number of starts; of equal numbers the one reached first comes first
        attractors = starts.most_common()
        failed = [reached for reached in every if reached.outcome is None]
        values: dict[str, Any] = {"status": "ok"}
        if len(failed) == len(every):
            values["status"] = failed[0].status
        values.update(columns_of_starts(results, attractors))
        values.update(fractions_of(results, every, self.confidence))
        values.update(self._critical_energy(results, follow))
        values.update(listed([columns_of_attractor(each, count) for each, count in attractors]))
        remarks = []
        if failed:
            remarks.append(
                f"{len(failed)} of {len(every)} starts failed, such as {failed[0].message}"
            )
        remarks += remarks_of_undecided(every)
        return values, "; ".join(remarks)

    def _basins_of(self, p: Parameters) -> "Basins":
        """The attractors of a case that its own starts come to, as yet without those of others: what
        a point gives does not depend on the points before it."""
        from disc_model.stability.attractors import Basins

        return Basins(p, self.horizon, near=self.attractor_tol, tol=self.tol)

    def _critical_energy(
        self, results: Sequence[Sequence[OutcomeResult]], follow: Follow
    ) -> dict[str, float]:
        """Bisect the logarithm of the energy in the directions of the separating starts with the
        lowest energies."""
        separating = []
        for j, row in enumerate(results):
            for i, result in enumerate(row):
                if result.separates:
                    separating.append((self.energies[j], i, j))
        separating.sort()
        if not separating:
            return {}
        least = {"critical_energy_sampled": separating[0][0]}
        if separating[0][0] == 0 or not self.n_bisection_directions:
            return least
        if follow(0.0, 0, 0).separates:
            return {**least, "critical_energy": 0.0}
        ends = []
        for energy, i, j in separating[: self.n_bisection_directions]:
            ends.append(self._bisected(energy, i, j, follow))
        low, high = min(ends, key=lambda pair: pair[1])
        return {**least, "critical_energy_lower": low, "critical_energy": high}

    def _bisected(self, first: float, i: int, j: int, follow: Follow) -> tuple[float, float]:
        """Energies without and with lasting separation, closer to each other than the required
        precision."""
        low = first / 4
        high = first
        while follow(low, i, j).separates:
            high = low
            low = low / 4
            if low < SMALLEST * first:
                return np.nan, high
        while high > low * (1 + self.precision):
            middle = float(np.sqrt(low * high))
            if follow(middle, i, j).separates:
                high = middle
            else:
                low = middle
        return low, high
