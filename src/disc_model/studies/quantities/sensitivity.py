"""Sensitivity: the stick-slip cycle at samples of distributed parameters, from one scrambled Sobol'
sequence.

Wilson intervals assume independent samples. A failed one counts as stable at the lower end, as
unstable at the upper.
"""

from collections.abc import Iterator, Mapping
from itertools import pairwise, product
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Field

from disc_model.analysis.classify import share
from disc_model.arrays import Words
from disc_model.data.variables import EXCLUDED, OF_QUANTITIES, SAMPLE, flag_names, with_advice
from disc_model.errors import Fault, ParameterError, as_text, suggestion
from disc_model.parameters import DEFAULTS, RATIOS, RELATED, Disc, Parameters, case_of
from disc_model.studies.distributions import BLOCK, Distribution, quantile, unit_draws
from disc_model.studies.quantity import (
    NUMBERS,
    Blocks,
    Coordinate,
    Dataset,
    Point,
    Quantity,
    Row,
    tried,
    with_ends,
)
from disc_model.units import Count, CycleTolerance, Seconds, Tolerance, Units, is_number

UNSTABLE = ("unstable", "no_cycle", "separates", "unstable_sliding")
FAILED = "failed"


# ---- The quantity


class Sensitivity(Quantity):
    """The stick-slip cycle at samples of uncertain parameters, and the outcome of the static
    start."""

    distributions: Annotated[dict[str, Distribution], Field(min_length=1)]
    """distributions by parameter, or by number of a mode of a disc, such as omega_2_0 for two nodal
    diameters and no circle"""
    # the grid contains it: the result of a sample depends only on the seed and on its own number
    samples: Annotated[Count, Field(ge=2, le=2**16, exclude=True)] = 64
    """number of samples, a power of two"""
    seed: Annotated[Count, Field(ge=0)] = 0
    """whole number that determines the samples"""
    simulated_samples: Annotated[Count, Field(ge=0)] = 0
    """number of the first samples whose motion is simulated as well"""
    horizon: Seconds = 500.0
    """longest simulated time of a sample"""
    extrapolate: bool = True
    """whether slow departures from cycles are extrapolated, which halves the time; their separations are not timed"""
    tol: CycleTolerance = 1e-12
    """tolerance of cycles: relative residual of the return map"""
    motion_tol: Tolerance = 1e-10
    """tolerance of simulations: error of event times after a second of motion"""

    @classmethod
    def _units(cls, data: Mapping[str, Any]) -> dict[str, Units]:
        raw = data.get("distributions")
        of_modes = {}
        if isinstance(raw, Mapping):
            of_modes = {str(x): "rad/s" for x in raw if str(x).startswith("omega_")}
        of_numbers = {name: Parameters.unit(name) for name in NUMBERS}
        return {**super()._units(data), "distributions": {**of_numbers, **of_modes}}

    _rules = (
        (lambda o: o.samples & (o.samples - 1) == 0, "samples={0.samples} must be a power of two"),
    )
    points_per_job: ClassVar = 400
    over: ClassVar = SAMPLE
    COLUMNS: ClassVar = OF_QUANTITIES["sensitivity"]["columns"]
    COORDINATES: ClassVar = {"parameter": Coordinate(lambda o: sorted(o.distributions))}
    SUMMARY_COLUMNS: ClassVar = OF_QUANTITIES["sensitivity"]["summary"]

    @property
    def dimensions(self) -> Mapping[str, Blocks]:
        """The samples: a block of 64, and blocks that each double their number."""
        ends = [0, min(64, self.samples)]
        while ends[-1] < self.samples:
            ends.append(2 * ends[-1])
        return {SAMPLE: tuple(tuple(range(*block)) for block in pairwise(ends))}

    def faults(self, grid: Any) -> Iterator[Fault]:
        """Distributions must be of numbers, of no parameter that varies otherwise, and within valid
        values."""
        path = ("options", "distributions")
        faults: dict[str, Fault] = {}  # the first one of each name
        first = next(grid.points_along(grid.dims))
        for point in grid.points_of([*self.distributions, *RELATED]):
            case = Parameters(**case_of({**grid.base, **first, **point}, grid.discs))
            own = _own_values(dict(case))
            for name in self.distributions:
                rule = self._broken_rule(name, own, grid)
                if rule:
                    faults.setdefault(name, Fault((*path, name), "", rule))
            if faults:
                continue
            for fault in self._out_of_reach(case, own):
                inside = path if fault.path[0] in self.distributions else ("base",)
                rule = f"{fault.rule}; distributions reach that far"
                faults.setdefault(fault.path[0], Fault((*inside, *fault.path), fault.value, rule))
        yield from faults.values()

    def _broken_rule(self, name: str, own: Mapping[str, Any], grid: Any) -> str:
        """The rule that the distribution of a number breaks at a point with these values, or
        ""."""
        relative = self.distributions[name].relative
        nominal = own.get(name)
        of_a_mode = name not in NUMBERS
        varied = {*grid.varied, *(RATIOS[ratio][0] for ratio in grid.varied if ratio in RATIOS)}
        varies = name in varied or (of_a_mode and "disc" in varied)
        if of_a_mode and (name not in own or name in DEFAULTS):
            return f"must be of a parameter that is a number{suggestion(name, NUMBERS)}"
        if varies and not relative:
            return "must be relative, since it varies along an axis as well"
        if relative and not (is_number(nominal) and nominal):
            return f"must not be relative to {as_text(nominal)}"
        return ""

    def _out_of_reach(self, p: Parameters, own: Mapping[str, Any]) -> Iterator[Fault]:
        """Rules broken by an end of a distribution at a point; rules between parameters are tested
        at all corners."""
        ends: dict[str, list[float]] = {}
        for name, distribution in self.distributions.items():
            scale = own[name] if distribution.relative else 1.0
            ends[name] = [scale * distribution.low, scale * distribution.high]
        related = [name for name in ends if name in RELATED]
        corners = product(*(ends[name] for name in related))
        for side, corner in product((0, 1), corners):
            values = {name: pair[side] for name, pair in ends.items()}
            values.update(zip(related, corner, strict=True))
            try:
                p.replace(**values)
            except ParameterError as error:
                yield from error.faults  # type: ignore[misc]

    def compute_point(self, point: Point) -> tuple[dict[str, Any], str]:
        names = sorted(self.distributions)
        own = _own_values(dict(point.parameters))
        block, row = divmod(point.sample, BLOCK)
        draws = unit_draws(self.seed, len(names), block)[row]
        drawn = {}
        for name, draw in zip(names, draws, strict=True):
            drawn[name] = quantile(self.distributions[name], float(own[name]), float(draw))
        p = point.parameters.replace(**drawn)

        cycle, remark = tried("cycle", evaluate, p, self.tol)
        remarks = [remark]
        outcome: Row = {"outcome": "not_simulated"}
        if point.sample < self.simulated_samples:
            outcome, remark = tried("outcome", _followed, p, self)
            remarks.append(remark)
        sampled = np.array(list(drawn.values()))
        values = {"status": "ok", "parameter_values": sampled, **cycle, **outcome}
        return values, "; ".join(dict.fromkeys(filter(None, remarks)))

    def summarise(self, cell: Dataset) -> dict[str, Any]:
        cell = cell.isel(sample=flag_names(cell["status"]) != EXCLUDED)
        if not cell.sizes["sample"]:
            return {}
        cycles = flag_names(cell["cycle"])
        outcomes = flag_names(cell["outcome"])
        simulated = outcomes[outcomes != "not_simulated"]
        return {
            "n_known_cycles": int((cycles != FAILED).sum()),
            "n_known_outcomes": int((simulated != FAILED).sum()),
            "n_failed_cycles": int((cycles == FAILED).sum()),
            "n_failed_outcomes": int((simulated == FAILED).sum()),
            **with_ends("probability_unstable", _probability(cycles, UNSTABLE)),
            **with_ends("probability_separation", _probability(simulated, ("separation",))),
        }


def _probability(words: Words, hits: tuple[str, ...]) -> tuple[float, float, float]:
    """Share of samples with certain words, and its confidence interval, in which failed ones count
    as either."""
    known = words[words != FAILED]
    return share(int(np.isin(known, hits).sum()), len(known), len(words) - len(known))


def _own_values(values: Mapping[str, Any]) -> dict[str, Any]:
    """A point's own values of all numbers that can be distributed."""
    disc = values.get("disc")
    numbers = disc.numbers if isinstance(disc, Disc) else {}
    return {**DEFAULTS, **values, **numbers}


# ---- Results of one sample


def evaluate(p: Parameters, tol: float) -> tuple[Row, str]:
    from disc_model.stability.cycle import find_cycle

    cycle = find_cycle(p, tol)
    row: dict[str, Any] = {"cycle": cycle.motion, "growth_rate": cycle.growth_rate}
    if cycle.motion in Sensitivity.COLUMNS["cycle"].flags:
        return row, ""
    return {**row, "cycle": FAILED}, with_advice(cycle.message, cycle.status)


def _followed(p: Parameters, options: Sensitivity) -> tuple[Row, str]:
    from disc_model.stability.follower import find_outcome

    times = (options.horizon,) if options.extrapolate else ()
    result = find_outcome(p, options.horizon, tol=options.motion_tol, compared_with=times)
    row = {"outcome": result.word, "first_separation": result.timed_separation}
    return row, result.message
