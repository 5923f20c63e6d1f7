"""Evenly spaced values, of axes and of options, and conditions between the keys of one part of a file."""

import math
from collections.abc import Callable
from itertools import chain
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import Field, model_validator

from disc_model.units import Count, Finite, Positive, Strict

Value = float | int | str
Blocks = tuple[tuple[Value, ...], ...]
MOST = 100_000
"""Greatest number of values along one axis; a slip of the pen can ask for more than fit into memory."""
Rules = tuple[tuple[Callable[[Any], bool], str], ...]


class Ruled(Strict):
    """A part of a file with conditions between its fields.

    _rules : conditions, each with its message, which may show values of the part
    """

    _rules: ClassVar[Rules] = ()

    @model_validator(mode="after")
    def _keep_rules(self) -> Self:
        for holds, stated in self._rules:
            if not holds(self):
                raise ValueError(stated.format(self))
        return self


class Range(Ruled):
    """Evenly spaced values from `start` to `stop`, both included: `count` of them, or one each `step`.

    On a logarithmic scale the ratio of neighbours is constant.
    """

    start: Finite
    stop: Finite
    count: Annotated[Count, Field(ge=2)] | None = None
    step: Positive | None = None
    scale: Literal["linear", "log"] = "linear"

    _rules = (
        (lambda r: r.start < r.stop, "start={0.start:g} must be < stop={0.stop:g}"),
        (lambda r: math.isfinite(r.stop - r.start), "stop - start must be finite"),
        (lambda r: (r.count is None) != (r.step is None), "must give either count or step"),
        (
            lambda r: r.scale == "linear" or (r.count and r.start > 0),
            "a logarithmic range must give count, and start > 0",
        ),
        (lambda r: r._steps < MOST, f"must be at most {MOST} values"),
        (
            lambda r: abs(r._steps - r.intervals) <= 1e-9 * r._steps,
            "stop - start must be a multiple of step={0.step:g}",
        ),
    )

    @property
    def _steps(self) -> float:
        return (self.stop - self.start) / self.step if self.step else float((self.count or 2) - 1)

    @property
    def intervals(self) -> int:
        """Number of intervals: one less than the number of values."""
        return round(self._steps)

    @property
    def values(self) -> list[float]:
        """All values, in ascending order."""
        return [float(value) for value in self.blocks()[0]]

    def blocks(self, resolution: int = 1) -> Blocks:
        """The range's own values, then those that divide each interval further.

        A finer grid adds blocks and keeps the existing ones: resolution 4 has the blocks of 2, and one more.
        """
        n = self.intervals * resolution
        if n >= MOST:
            raise ValueError(f"must be at most {MOST} values, and not {n + 1}")
        found: dict[int, list[Value]] = {}
        for i in range(n + 1):
            # the lowest resolution at which this value is there
            level = resolution // math.gcd(i, resolution)
            found.setdefault(level, []).append(self._at(i / n))
        if len({*chain(*found.values())}) <= n:
            raise ValueError(f"must be {n + 1} values that differ in their first 12 digits")
        return tuple(tuple(found[level]) for level in sorted(found))

    def _at(self, share: float) -> float:
        """The value at a fraction of the range, rounded to 12 digits, so that ranges and lists agree on 0.3."""
        if share in (0.0, 1.0):
            return self.stop if share else self.start
        if self.scale == "log":
            return float(f"{self.start * (self.stop / self.start) ** share:.12g}")
        return float(f"{self.start + share * (self.stop - self.start):.12g}")
