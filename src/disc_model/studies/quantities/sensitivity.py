"""Sensitivity: the stick-slip cycle at samples of distributed parameters.

Each sample is drawn twice, as A and as B, from one scrambled Sobol' sequence. The sequence has twice as many dimensions
as there are distributed parameters. For each parameter, a variant of A takes this parameter from B: the design of
Saltelli et al. (2010) for first-order and total indices, see `disc_model.analysis.sobol`. A sample depends only on the
seed and its own number.

Probabilities of instability and separation among the samples, and the parameters that decide them.

Fractions of the cycles refer to all draws, A and B, and fractions of the outcomes to the simulated ones. The Wilson
intervals assume independent samples. Quasi-random samples are more even, so that their errors are mostly smaller. A
failed sample is neither stable nor unstable: the lower and upper ends of an interval count it as one and as the other.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import lru_cache
from itertools import pairwise, product
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from disc_model.data.variables import (
    EXCLUDED,
    OUTCOMES_TO_HORIZON,
    SAMPLE,
    SCALARS,
    STABLE_CYCLES,
    CycleStatus,
    Variable,
    flag_names,
)
from disc_model.errors import Fault, ParameterError, as_text
from disc_model.parameters import DEFAULTS, PLATE, RELATED, Disc, Parameters, case_of, cross_faults
from disc_model.simulation.case import SomeParameters
from disc_model.studies.quantity import (
    CYCLE,
    SIMULATED,
    STATUS,
    Coordinate,
    Point,
    Quantity,
    Row,
    listed,
    tried,
    with_ends,
)
from disc_model.studies.ranges import Blocks, Ruled, Rules
from disc_model.units import Count, CycleTolerance, Finite, Positive, Seconds, Tolerance, Unit, Units, is_number

if TYPE_CHECKING:
    import xarray as xr

    from disc_model.stability.cycle import FloquetResult

UNSTABLE = ("unstable", "no_cycle", "separates", "unstable_sliding")
SAMPLE_CYCLES = ("failed", *STABLE_CYCLES, *UNSTABLE)
"""Classes of the cycle near the static start: one of `STABLE_CYCLES`; or an unstable cycle, none though the slider
sticks and slips, immediate separation, or unstable sliding."""
SAMPLE_OUTCOMES = ("not_simulated", *OUTCOMES_TO_HORIZON)
DRAWS = ("A", "B")
# ----------------------------------------------------------------------------------------------------
# Distributions of uncertain parameters

NUMBERS = tuple(name for name in Parameters.model_fields if Parameters.unit(name) and not name.startswith("n_"))
"""Parameters that can be distributed."""
FARTHEST = 6.47
"""Standard deviations at which a normal distribution is cut off, rounded up: a fraction of 1e-10 lies beyond."""


class _Distribution(Ruled):
    """Of one parameter.

    relative : whether the numbers are multiples of the parameter's own value at the point
    """

    relative: bool = False


class _Bounded(_Distribution):
    low: Finite
    high: Finite

    _rules: ClassVar[Rules] = ((lambda d: d.low < d.high, "low={0.low:g} must be < high={0.high:g}"),)

    @property
    def ends(self) -> tuple[float, float]:
        return self.low, self.high


class Uniform(_Bounded):
    """A uniform distribution: all values from `low` to `high` are equally likely."""

    distribution: Literal["uniform"]


class Normal(_Distribution):
    """A normal distribution, cut off at 6.47 standard deviations."""

    distribution: Literal["normal"]
    mean: Finite
    deviation: Positive

    @property
    def ends(self) -> tuple[float, float]:
        return self.mean - FARTHEST * self.deviation, self.mean + FARTHEST * self.deviation


class TruncatedNormal(_Bounded):
    """A normal distribution, restricted to values from `low` to `high`; mean and deviation are those of the whole."""

    distribution: Literal["truncated_normal"]
    mean: Finite
    deviation: Positive

    _rules = (
        *_Bounded._rules,
        (
            lambda d: max(d.low - d.mean, d.mean - d.high) <= FARTHEST * d.deviation,
            f"low and high must be within {FARTHEST:g} deviations of mean={{0.mean:g}}",
        ),
    )


Distribution = Annotated[Uniform | Normal | TruncatedNormal, Field(discriminator="distribution")]


Array = NDArray[np.float64]
FAILED = "failed"
FOLLOWED = tuple(word for word in SAMPLE_OUTCOMES if word not in ("not_simulated", FAILED))
KNOWN = tuple(word for word in SAMPLE_CYCLES if word != FAILED)
OUTPUTS = ("instability", "growth_rate")
"""Outputs with Sobol indices: absence of a stable motion (1, else 0), and the cycle's growth rate, capped."""
_INDEX = ("output", "parameter")


def _with_interval(name: str, words: str, dims: tuple[str, ...] = ()) -> dict[str, Variable]:
    ends = ("", ", lower end", ", upper end")
    return with_ends(name, (Variable("1", f"{words}{end}", dims=dims) for end in ends))


class Sensitivity(Quantity):
    """The stick-slip cycle at samples of uncertain parameters, and the outcome of the static start.

    distributions : by parameter; for a disc given by its modes also by mode, such as omega_2_0, amplitude_2_0 and
        damping_ratio_2_0 for two nodal diameters and no circle
    samples : number of samples, a power of two; more samples keep the existing ones
    seed : whole number; a sample depends only on it and on the sample's own number
    simulated_samples : number of samples, from the first on, whose motion is simulated as well
    horizon : s, of this simulation
    growth_rate_cap : 1/s; larger growth rates count as this in their indices, since a few would dominate the variance
    tol : tolerance of the cycles; motion_tol : tolerance of the motions
    """

    distributions: Annotated[dict[str, Distribution], Field(min_length=1)]
    # the grid contains it: the result of a sample does not depend on their number
    samples: Annotated[Count, Field(ge=2, le=2**16, exclude=True)] = 64
    seed: Annotated[Count, Field(ge=0)] = 0
    simulated_samples: Annotated[Count, Field(ge=0)] = 0
    horizon: Seconds = 500.0
    growth_rate_cap: Annotated[Positive, Unit("1/s")] = 0.5
    tol: CycleTolerance = 1e-12
    motion_tol: Tolerance = 1e-10

    @classmethod
    def _units(cls, data: Mapping[str, Any]) -> dict[str, Units]:
        raw = data.get("distributions")
        names = map(str, raw if isinstance(raw, Mapping) else ())
        of_modes = {name: "rad/s" for name in names if name.startswith("omega_")}
        return super()._units(data) | {"distributions": {name: Parameters.unit(name) for name in NUMBERS} | of_modes}

    _rules = ((lambda o: o.samples & (o.samples - 1) == 0, "samples={0.samples} must be a power of two"),)

    over: ClassVar = SAMPLE
    COLUMNS: ClassVar = {
        "status": STATUS,
        "parameter_values": Variable(
            "", "values of the distributed parameters, SI units", dims=("sample_matrix", "parameter")
        ),
        "cycle": Variable("1", "class of the cycle near the static start", SAMPLE_CYCLES, dims=("variant",)),
        "growth_rate": Variable(
            "s-1", "growth rate of disturbances of the stick-slip cycle, nan without one", dims=("variant",)
        ),
        "outcome": Variable("1", "what becomes of the static start of A within the horizon", SAMPLE_OUTCOMES),
        "first_separation": SCALARS["first_separation"],
    }
    COORDINATES: ClassVar = {
        "sample_matrix": Coordinate("", "one of the two draws of a sample", lambda o: DRAWS),
        "parameter": Coordinate("", "distributed parameter", lambda o: sorted(o.distributions)),
        "variant": Coordinate(
            "", "draw A, draw B, or A with this parameter taken from B", lambda o: (*DRAWS, *sorted(o.distributions))
        ),
    }
    SUMMARY_COLUMNS: ClassVar = {
        "n_known_cycles": Variable("1", "number of draws, A and B, whose cycle is known", whole=True),
        "n_known_outcomes": Variable("1", "number of draws whose outcome is known", whole=True),
        **_with_interval("probability_unstable", "probability that the static start is near no stable motion"),
        **_with_interval("probability_separation", "probability of separation within the horizon"),
        **_with_interval(
            "cycle_fraction", "share of the draws near whose static start there is this", ("cycle_class",)
        ),
        **_with_interval("outcome_fraction", "share of the followed draws that have this outcome", ("outcome_class",)),
        **_with_interval("sobol_first", "first-order Sobol index", _INDEX),
        **_with_interval("sobol_total", "total Sobol index", _INDEX),
        "excluded_fraction": Variable(
            "1", "share of samples that the indices leave out: an output is missing", dims=("output",)
        ),
    }
    SUMMARY_COORDINATES: ClassVar = {
        "cycle_class": Coordinate("", "class of the cycle near the static start", lambda o: KNOWN),
        "outcome_class": Coordinate("", "what becomes of the static start", lambda o: FOLLOWED),
        "output": Coordinate("", "of what the indices are", lambda o: OUTPUTS),
        "parameter": Coordinate("", "distributed parameter", lambda o: sorted(o.distributions)),
    }

    @property
    def seconds(self) -> float:
        return CYCLE * (2 + len(self.distributions)) + SIMULATED * self.horizon / 4 * (self.simulated_samples > 0)

    @property
    def dimensions(self) -> Mapping[str, Blocks]:
        """The samples: a block of 64, and blocks that each double their number."""
        ends = [0, min(64, self.samples)]
        while ends[-1] < self.samples:
            ends.append(2 * ends[-1])
        return {SAMPLE: tuple(tuple(range(*block)) for block in pairwise(ends))}

    def faults(self, grid: Any) -> Iterator[Fault]:
        """Check distributions: of numbers only, of no parameter that varies otherwise, and within valid values.

        Each rule is reported where it is broken first.
        """
        path, numbers = ("options", "distributions"), _numbers(grid)
        varied = {*grid.varied, *({*numbers}.difference(NUMBERS) if "disc" in grid.varied else ())}
        faults = []
        for name, distribution in self.distributions.items():
            nominal = _own(name, grid.base)
            if name not in numbers:
                rule = f"must be of a parameter that is a number (known: {', '.join(numbers)})"
                faults.append(Fault((*path, name), "", rule))
            elif not distribution.relative and name in varied:
                faults.append(Fault((*path, name), "", "must be relative, since it varies along an axis as well"))
            elif distribution.relative and name not in varied and (not is_number(nominal) or nominal == 0):
                faults.append(Fault((*path, name), "", f"must not be relative to {as_text(nominal)}"))
        yield from faults
        first: dict[str, Fault] = {}
        for fault in () if faults else self._out_of_reach(grid):
            first.setdefault(fault.path[0], fault)
        for fault in first.values():
            inside = path if fault.path[0] in self.distributions else ("base",)
            yield Fault((*inside, *fault.path), fault.value, f"{fault.rule}; distributions reach that far")

    def _out_of_reach(self, grid: Any) -> Iterator[Fault]:
        """Rules broken by an end of a distribution at any point; rules between parameters are tested at all corners."""
        related = [name for name in sorted(self.distributions) if name in RELATED]
        every = (point.items() for point in grid.points_of([*self.distributions, *RELATED]))
        for point in dict.fromkeys(tuple((name, value) for name, value in items if name != SAMPLE) for items in every):
            case = case_of({**grid.base, **dict(point)}, grid.discs)
            ends: dict[str, list[float]] = {}
            for name, distribution in self.distributions.items():
                scale = _own(name, case) if distribution.relative else 1.0
                ends[name] = [scale * end for end in distribution.ends]
                for end in ends[name]:
                    try:
                        if name in NUMBERS:
                            SomeParameters.model_validate({name: end})
                        else:
                            case["disc"].with_numbers(**{name: end})
                    except ParameterError as error:
                        yield from (Fault((name,), fault.value, fault.rule) for fault in error.faults)
            for corner in product(*(ends[name] for name in related)):
                yield from cross_faults(DEFAULTS | case | dict(zip(related, corner, strict=True)))

    def compute_point(self, point: Point) -> tuple[dict[str, Any], str]:
        """Compute one sample about the point's own parameters."""
        p, names = point.parameters, sorted(self.distributions)
        shares = unit_draws(self.seed, len(names), point.sample)
        numbers = dict(p) | ({} if p.disc is None else p.disc.numbers)
        marginals = [(self.distributions[name], float(numbers[name])) for name in names]
        drawn = np.array([[quantile(*of_name, x) for of_name, x in zip(marginals, row, strict=True)] for row in shares])
        rows = [dict(zip(names, row, strict=True)) for row in variants(drawn).tolist()]
        cycles, messages = zip(*(tried("cycle", evaluate, p, row, self.tol) for row in rows), strict=True)
        values = listed(cycles) | {"status": "ok", "parameter_values": drawn, "outcome": "not_simulated"}
        if point.sample < self.simulated_samples:
            more, message = tried("outcome", _followed, p.replace(**rows[0]), self)
            values |= more
            messages += (message,)
        return values, "; ".join(dict.fromkeys(filter(None, messages)))

    def summarise(self, cell: xr.Dataset) -> dict[str, Any]:
        """Summarise over the samples that no rule of the grid leaves out."""
        from disc_model.analysis.sobol import Indices, sobol_intervals

        cell = cell.isel(sample=flag_names(cell["status"]) != EXCLUDED)
        if not cell.sizes["sample"]:
            return {}
        words = flag_names(cell["cycle"].transpose("sample", "variant"))
        drawn = words[:, : len(DRAWS)].ravel()
        outcomes = flag_names(cell["outcome"])
        outcomes = outcomes[outcomes != "not_simulated"]
        values: dict[str, Any] = {
            "n_known_cycles": np.count_nonzero(drawn != FAILED),
            "n_known_outcomes": np.count_nonzero(outcomes != FAILED),
        }
        values |= _shares("cycle_fraction", drawn, [(word,) for word in KNOWN])
        values |= _shares("outcome_fraction", outcomes, [(word,) for word in FOLLOWED])
        values |= _shares("probability_unstable", drawn, [UNSTABLE])
        values |= _shares("probability_separation", outcomes, [("separation",)])
        # of the indices: (samples, variants), nan where not known
        unstable = np.where(words == FAILED, np.nan, np.isin(words, UNSTABLE))
        growth_rate = cell["growth_rate"].transpose("sample", "variant").values
        outputs = unstable, np.minimum(growth_rate, self.growth_rate_cap)
        indices = [sobol_intervals(output, self.seed) for output in outputs]
        for name in Indices._fields:
            values[f"sobol_{name}"] = np.array([getattr(index, name) for index in indices])
        values["excluded_fraction"] = np.array([np.mean(~np.isfinite(output).all(axis=1)) for output in outputs])
        return values


def _numbers(grid: Any) -> list[str]:
    """Names that can be distributed: parameters that are numbers, and those of the modes that all discs have."""
    discs: list[Disc] = [*grid.discs.values()] if "disc" in grid.varied else []
    discs += [disc] if (disc := grid.base.get("disc")) is not None else []
    if not discs:
        return [*NUMBERS]
    common = [name for name in discs[0].numbers if all(name in disc.numbers for disc in discs)]
    return [*(name for name in NUMBERS if name not in (*PLATE, "damping_ratio")), *common]


def _own(name: str, values: Mapping[str, Any]) -> Any:
    """A point's own value of a parameter, if it has one."""
    if isinstance(disc := values.get("disc"), Disc) and name in disc.numbers:
        return disc.numbers[name]
    return values[name] if name in values else DEFAULTS.get(name)


# ----------------------------------------------------------------------------------------------------
# Samples
BLOCK = 64
"""Number of samples that are drawn at once."""
EDGE = 1e-10
"""Fraction of a normal distribution that is cut off, in both tails together."""


def unit_draws(seed: int, count: int, number: int) -> Array:
    """A and B of one sample, shape (2, count), in the unit cube."""
    block, row = divmod(number, BLOCK)
    return _block(seed, count, block)[row].reshape(2, count)


@lru_cache(maxsize=8)
def _block(seed: int, count: int, block: int) -> Array:
    from scipy.stats import qmc

    sequence = qmc.Sobol(2 * count, scramble=True, rng=np.random.default_rng(seed))
    if block:  # scipy rejects 0
        sequence.fast_forward(block * BLOCK)
    return np.asarray(sequence.random(BLOCK), dtype=float)


def quantile(distribution: Distribution, nominal: float, share: float) -> float:
    """Quantile of a parameter's distribution, which may be relative to the point's own value."""
    from scipy.special import ndtr, ndtri

    scale = nominal if distribution.relative else 1.0
    low, high = distribution.ends
    if distribution.distribution == "uniform":
        return float(scale * (low + share * (high - low)))
    first, last = EDGE / 2, 1 - EDGE / 2
    if distribution.distribution == "truncated_normal":
        first, last = (ndtr((end - distribution.mean) / distribution.deviation) for end in (low, high))
    value = distribution.mean + distribution.deviation * float(ndtri(first + share * (last - first)))
    # rounding must not exceed the ends
    return float(scale * min(max(value, low), high))


def variants(drawn: Array) -> Array:
    """A, B, and A with each parameter in turn taken from B: shape (2 + n, n), of draws of shape (2, n)."""
    a, b = drawn
    return np.vstack([a, b, np.where(np.eye(len(a), dtype=bool), b, a)])


# ----------------------------------------------------------------------------------------------------
# Results of one sample


def evaluate(p: Parameters, values: Mapping[str, float], tol: float) -> tuple[Row, str]:
    """Compute the cycle of a case with some parameters replaced: its class and growth rate (1/s), and a message."""
    from disc_model.stability.cycle import floquet

    cycle = floquet(p.replace(**values), tol=tol)
    word = cycle_word(cycle)
    return {"cycle": word, "growth_rate": cycle.growth_rate}, cycle.message if word == "failed" else ""


def cycle_word(cycle: FloquetResult) -> str:
    """The class of a cycle in `SAMPLE_CYCLES`."""
    if cycle.status is CycleStatus.OK:
        return "stable" if cycle.stable else "unstable"
    if cycle.status is CycleStatus.NO_STICK_SLIP:
        return "steady_sliding" if cycle.sliding.stable else "unstable_sliding"
    return cycle.status.value if cycle.status.value in SAMPLE_CYCLES else "failed"


def _followed(p: Parameters, options: Sensitivity) -> tuple[Row, str]:
    """Simulate the static start and return its outcome."""
    from disc_model.stability.attractor.outcome import find_outcome

    result = find_outcome(p, options.horizon, tol=options.motion_tol)
    return {"outcome": result.word, "first_separation": result.first_separation}, result.message


def _shares(name: str, words: NDArray[np.str_], classes: list[tuple[str, ...]]) -> dict[str, Any]:
    """Fraction of each class of words among those that are known, with its interval."""
    from disc_model.analysis.sobol import share

    known = words[words != FAILED]
    shares = np.array([share(int(np.isin(known, word).sum()), len(known), len(words) - len(known)) for word in classes])
    return with_ends(name, shares[0] if len(classes) == 1 else shares.T)
