"""A batch of a grid study: all that its result depends on, in a text whose hash is its name."""

import math
from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any, Literal, Self

import pydantic
from pydantic import Field

from disc_model.data.variables import CHOICES
from disc_model.hashing import canonical_json, content_key
from disc_model.parameters import FORMAT, Disc
from disc_model.studies.quantity import Value
from disc_model.units import Strict

WORDS = (*CHOICES, "disc")  # what varies by words
Values = tuple[Value, ...]


def read_infinity(name: str, value: Value) -> Value:
    """Return a value of a JSON text, which has a word for an infinite number."""
    if value == "inf" and name not in WORDS:
        return math.inf
    return value


def _read_infinities(names: Sequence[str], rows: Sequence[Values]) -> tuple[Values, ...]:
    """Return rows of values along `names`, with infinite numbers in place of their words."""
    read = []
    for row in rows:
        pairs = zip(names, row, strict=True)
        read.append(tuple(read_infinity(name, value) for name, value in pairs))
    return tuple(read)


class GridAxis(Strict):
    """One dimension of a grid: an axis, or a zip, along which several parameters vary together."""

    names: tuple[str, ...]
    values: tuple[Values, ...]

    @pydantic.model_validator(mode="after")
    def _with_infinities(self) -> Self:
        object.__setattr__(self, "values", _read_infinities(self.names, self.values))
        return self

    @property
    def name(self) -> str:
        """Name of the dimension in a dataset."""
        return "_".join(self.names)


class MergePlan(Strict):
    """Names of the batches of a grid, its dimensions, and attributes of the merged dataset."""

    batches: tuple[str, ...]
    grid: tuple[GridAxis, ...]
    attrs: dict[str, str]

    @property
    def text(self) -> str:
        """JSON, which `model_validate_json` reads."""
        return canonical_json(self.model_dump())


class TileSides(Strict):
    """A tile of a plane whose points are computed together.

    Attributes
    ----------
    names : the plane's dimensions
    along : values along both sides, also those that belong to the next tile
    sampled : places, by their numbers along both sides, where the outcome is always computed
    """

    names: tuple[str, str]
    along: tuple[Values, Values]
    sampled: tuple[tuple[int, int], ...] = ()

    @pydantic.model_validator(mode="after")
    def _with_infinities(self) -> Self:
        along = []
        for name, side in zip(self.names, self.along, strict=True):
            along.append(tuple(read_infinity(name, value) for value in side))
        object.__setattr__(self, "along", tuple(along))
        return self


class Batch(Strict):
    """What one job computes: a quantity at some points of a grid.

    Attributes
    ----------
    quantity, options : its name, and its options
    base : values that do not vary
    names : of what varies
    points : the values of `names` at each point
    starts, discs : starts and tables of discs by the words that stand for them in `points`
    tile : of a plane whose points are computed together
    format : changes where equal texts get another meaning
    """

    quantity: str
    options: dict[str, Any]
    base: dict[str, Any]
    names: tuple[str, ...]
    points: tuple[Values, ...]
    discs: dict[str, Disc] = Field({})
    tile: TileSides | None = None
    format: Literal[1] = FORMAT

    @pydantic.model_validator(mode="after")
    def _with_infinities(self) -> Self:
        object.__setattr__(self, "points", _read_infinities(self.names, self.points))
        return self

    @cached_property
    def text(self) -> str:
        """JSON that is equal for equal batches; `model_validate_json` reads it."""
        return canonical_json(self.model_dump())

    @property
    def key(self) -> str:
        """Name of the batch: 12 hexadecimal digits."""
        return content_key(self.text)

    @cached_property
    def varied(self) -> list[Mapping[str, Value]]:
        """The varying values by name, at each point."""
        return [dict(zip(self.names, point, strict=True)) for point in self.points]
