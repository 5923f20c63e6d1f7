"""How uncertain parameters are distributed: what a study file may say, and whether parameters can have such values.

What the values amount to is worked out where they are used, in `disc_model.studies.grids.quantities.sensitivity`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import Annotated, Any, Literal, Self

from pydantic import Field, PrivateAttr, model_validator

from disc_model.errors import ParameterError, shown
from disc_model.parameters import RELATED, Count, Finite, Parameters, Positive, Strict, cross_faults, is_number
from disc_model.simulation.case import SomeParameters
from disc_model.studies.files import Faults, first_of_each
from disc_model.studies.grids.dimensions import Dimension, points

# ----------------------------------------------------------------------------------------------------
# What a file may say

FARTHEST = 6.47
"""Standard deviations that a normal distribution reaches: 1e-10 of it lies beyond, and is left out."""


class _Distribution(Strict):
    """Of one parameter.

    relative : whether the numbers are multiples of the point's own value of the parameter
    """

    relative: bool = False


class _Bounded(_Distribution):
    """Of values from low to high."""

    low: Finite
    high: Finite

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        if not self.low < self.high:
            raise ValueError(f"low={self.low:g} must be < high={self.high:g}")
        return self

    def ends(self) -> tuple[float, float]:
        return self.low, self.high


class Uniform(_Bounded):
    """All values from low to high are equally likely."""

    distribution: Literal["uniform"]


class Normal(_Distribution):
    """By mean and standard deviation, to 6.47 deviations."""

    distribution: Literal["normal"]
    mean: Finite
    deviation: Positive

    def ends(self) -> tuple[float, float]:
        return self.mean - FARTHEST * self.deviation, self.mean + FARTHEST * self.deviation


class TruncatedNormal(_Bounded):
    """What lies between low and high of a normal distribution that has this mean and this deviation as a whole."""

    distribution: Literal["truncated_normal"]
    mean: Finite
    deviation: Positive

    @model_validator(mode="after")
    def _near_the_mean(self) -> Self:
        if max(self.low - self.mean, self.mean - self.high) > FARTHEST * self.deviation:
            raise ValueError(f"low and high must be within {FARTHEST:g} deviations of mean={self.mean:g}")
        return self


Distribution = Annotated[Uniform | Normal | TruncatedNormal, Field(discriminator="distribution")]


class Sampled(Strict):
    """Options of a quantity that is computed at samples of distributed parameters, each a point of the grid.

    distributions : by parameter
    samples : number of them, a power of two; more of them leave those that there are
    seed : whole number; a sample hangs on it and on the sample's own number alone
    """

    distributions: Annotated[dict[str, Distribution], Field(min_length=1)]
    # the grid says it already: what is computed of a sample does not hang on how many there are
    samples: Annotated[Count, Field(ge=2, le=2**16, exclude=True)] = 64
    seed: Annotated[Count, Field(ge=0)] = 0
    _number: int = PrivateAttr(0)

    @model_validator(mode="after")
    def _balanced(self) -> Self:
        if self.samples & (self.samples - 1):
            raise ValueError(f"samples={self.samples} must be a power of two")
        return self

    @property
    def number(self) -> int:
        """Of the sample at hand."""
        return self._number

    @property
    def names(self) -> tuple[str, ...]:
        """Of the distributed parameters, in the order in which they are drawn, whatever the file's."""
        return tuple(sorted(self.distributions))

    def numbered(self, number: int) -> Self:
        """The options of one sample."""
        found = self.model_copy()
        found._number = int(number)
        return found


# ----------------------------------------------------------------------------------------------------
# Whether parameters can have such values

PLACE = ("options", "distributions")
NUMBERS = tuple(name for name in Parameters.model_fields if Parameters.unit(name) and not name.startswith("n_"))
"""Parameters that can be distributed."""


def check_distributions(options: Sampled, base: Mapping[str, Any], dims: Sequence[Dimension], faults: Faults) -> None:
    """Faults of distributions: of no number, of what varies besides, or reaching what a parameter may not be.

    Each rule is shown where it is broken first.
    """
    varied = {name for dim in dims for name in dim.names}
    before = len(faults)
    for name, given in options.distributions.items():
        if name not in NUMBERS:
            faults.add((*PLACE, name), "", f"must be of a parameter that is a number (known: {', '.join(NUMBERS)})")
        elif not given.relative and name in varied:
            faults.add((*PLACE, name), "", "must be relative, since it varies along an axis as well")
        elif given.relative and name not in varied and (not is_number(value := _own(name, base)) or value == 0):
            faults.add((*PLACE, name), "", f"must not be relative to {shown(value)}")
    if len(faults) > before:
        return
    for fault in first_of_each(_broken(options, base, dims)):
        name = fault.path[0]
        place = (*PLACE, name) if name in options.distributions else ("base", name)
        faults.add_shown(place, fault.value, f"{fault.rule}; distributions reach that far")


def _broken(options: Sampled, base: Mapping[str, Any], dims: Sequence[Dimension]) -> Iterator[str]:
    """Rules that ends of the distributions break, at any point; those between parameters hold if their corners do."""
    related = [name for name in options.names if name in RELATED]
    wanted = [dim for dim in dims if not {*options.names, *RELATED}.isdisjoint(dim.names)]
    for point in points(wanted):
        here = {**base, **point}
        ends: dict[str, list[float]] = {}
        for name, given in options.distributions.items():
            scale = _own(name, here) if given.relative else 1.0
            ends[name] = [scale * end for end in given.ends()]
            for end in ends[name]:
                yield from _refused(name, end)
        for corner in product(*(ends[name] for name in related)):
            values = {**here, **dict(zip(related, corner, strict=True))}
            yield from cross_faults(Parameters, values)


def _own(name: str, values: Mapping[str, Any]) -> Any:
    return values.get(name, Parameters.model_fields[name].default)


def _refused(name: str, value: float) -> Sequence[str]:
    try:
        SomeParameters(**{name: value})
    except ParameterError as error:
        return error.faults
    return ()
