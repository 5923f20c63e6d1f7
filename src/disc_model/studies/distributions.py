"""Distributions of uncertain parameters, and samples of them from one scrambled Sobol' sequence."""

from collections.abc import Mapping
from functools import lru_cache
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import BeforeValidator, Field

from disc_model.arrays import Array
from disc_model.errors import Fault, ParameterError
from disc_model.studies.quantity import Ruled, Rules
from disc_model.units import Finite, Positive

BLOCK = 64  # number of samples that are drawn at once
FARTHEST = 6.47  # standard deviations beyond which a normal distribution has 1e-10 of its values
_FAR = f"low and high must be within {FARTHEST:g} deviations of mean={{0.mean:g}}"


class Uniform(Ruled):
    """A uniform distribution: all values from `low` to `high` are equally likely."""

    distribution: Literal["uniform"]
    relative: bool = (
        False  # whether the numbers are multiples of the parameter's own value at the point
    )
    low: Finite
    high: Finite

    _rules: ClassVar[Rules] = (
        (lambda d: d.low < d.high, "low={0.low:g} must be < high={0.high:g}"),
    )


class TruncatedNormal(Uniform):
    """A normal distribution, restricted to values from `low` to `high`; mean and deviation are
    those of the whole."""

    distribution: Literal["truncated_normal"]  # type: ignore[assignment]
    mean: Finite
    deviation: Positive

    _rules = (
        *Uniform._rules,
        (lambda d: max(d.low - d.mean, d.mean - d.high) <= FARTHEST * d.deviation, _FAR),
    )


DISTRIBUTIONS = ("uniform", "truncated_normal")


def _with_its_name(raw: Any) -> Any:
    """A distribution as it is given; raises `ParameterError` unless it says which one it is."""
    if not isinstance(raw, Mapping) or raw.get("distribution") in DISTRIBUTIONS:
        return raw
    known = " or ".join(DISTRIBUTIONS)
    if "distribution" in raw:
        fault = Fault.of(("distribution",), raw["distribution"], f"must be {known}")
    else:
        fault = Fault(("distribution",), "", f"is required: {known}")
    raise ParameterError(fault)


Distribution = Annotated[
    Uniform | TruncatedNormal, Field(discriminator="distribution"), BeforeValidator(_with_its_name)
]


# ---- Samples


@lru_cache(maxsize=8)
def unit_draws(seed: int, count: int, block: int) -> Array:
    """Points of a block of samples in the unit cube, shape (BLOCK, count)."""
    from scipy import stats  # few points have distributed parameters

    sequence = stats.qmc.Sobol(count, scramble=True, rng=np.random.default_rng(seed))
    if block:  # scipy rejects 0
        sequence.fast_forward(block * BLOCK)
    return np.asarray(sequence.random(BLOCK), dtype=float)


def quantile(distribution: Distribution, nominal: float, share: float) -> float:
    """Quantile of a parameter's distribution, which may be relative to the point's own value."""
    from scipy import special

    scale = nominal if distribution.relative else 1.0
    low = distribution.low
    high = distribution.high
    if not isinstance(distribution, TruncatedNormal):
        return float(scale * (low + share * (high - low)))
    first = special.ndtr((low - distribution.mean) / distribution.deviation)
    last = special.ndtr((high - distribution.mean) / distribution.deviation)
    deviations = float(special.ndtri(first + share * (last - first)))
    value = distribution.mean + distribution.deviation * deviations
    # rounding must not exceed the ends
    return float(scale * min(max(value, low), high))
