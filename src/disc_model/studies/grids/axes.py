"""Values along one axis of a grid: lists, linear and logarithmic ranges, and blocks of them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from disc_model.schema import Count, Finite, Real, Strict
from disc_model.studies.faults import Faults, validated

Value = float | int | str
Blocks = tuple[tuple[Value, ...], ...]

MOST = 100_000
"""Values along one axis, at most; a slip of the pen can ask for more than fit into memory."""


class Range(Strict):
    """Evenly spaced values from `start` to `stop`, both included: `count` of them, or one each `step`.

    On a logarithmic scale the ratio of neighbours is constant.
    """

    start: Finite
    stop: Finite
    count: Annotated[Count, Field(ge=2)] | None = None
    step: Annotated[Real, Field(gt=0, allow_inf_nan=False)] | None = None
    scale: Literal["linear", "log"] = "linear"

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if not self.start < self.stop:
            raise ValueError(f"start={self.start:g} must be < stop={self.stop:g}")
        if not math.isfinite(self.stop - self.start):
            raise ValueError("stop - start must be finite")
        if (self.count is None) == (self.step is None):
            raise ValueError("must give either count or step")
        if self.scale == "log" and (self.step is not None or self.start <= 0):
            raise ValueError("a logarithmic range must give count, and start > 0")
        intervals = self._intervals
        if intervals >= MOST:
            raise ValueError(f"must be at most {MOST} values")
        if self.step is not None and abs(intervals - round(intervals)) > 1e-9 * intervals:
            raise ValueError(f"stop - start must be a multiple of step={self.step:g}")
        return self

    @property
    def _intervals(self) -> float:
        return self.count - 1 if self.count is not None else (self.stop - self.start) / self.step  # type: ignore[operator]

    @property
    def intervals(self) -> int:
        """One less than the number of values."""
        return round(self._intervals)

    def blocks(self, resolution: int = 1) -> Blocks:
        """The range's own values, then those that divide each interval further.

        A finer grid adds blocks and keeps what there is: resolution 4 has the blocks of 2, and one more.
        """
        n = self.intervals * resolution
        found: dict[int, list[Value]] = {}
        for i in range(n + 1):
            # the lowest resolution at which this value is there
            level = resolution // math.gcd(i, resolution)
            found.setdefault(level, []).append(self._at(i / n))
        return tuple(tuple(found[level]) for level in sorted(found))

    def _at(self, share: float) -> float:
        """The value at a share of the way, to 12 digits, so that ranges and lists agree on 0.3."""
        if share in (0.0, 1.0):
            return self.stop if share else self.start
        if self.scale == "log":
            return float(f"{self.start * (self.stop / self.start) ** share:.12g}")
        return float(f"{self.start + share * (self.stop - self.start):.12g}")


def values_of(range_: Range) -> list[float]:
    """The values of a range, ascending."""
    return [float(value) for value in range_.blocks()[0]]


def parse_blocks(raw: Any, path: tuple[str, ...], faults: Faults, resolution: int = 1) -> Blocks | None:
    """Blocks of raw values: a list, a range, or ``{blocks: [list or range, ...]}``.

    The values of a range's ``extra`` are a block of their own, so that what there is without them stays.

    A value that stands in several blocks belongs to the first. What the values mean is not checked here.
    """
    if isinstance(raw, Mapping) and "blocks" in raw:
        for key in raw.keys() - {"blocks"}:
            faults.add((*path, str(key)), raw[key], "unknown key")
        if not isinstance(raw["blocks"], list) or not raw["blocks"]:
            faults.add((*path, "blocks"), raw["blocks"], "must be a list of lists or ranges")
            return None
        each = [
            parse_blocks(part, (*path, "blocks", str(i)), faults, resolution) for i, part in enumerate(raw["blocks"])
        ]
        return None if None in each else tuple(block for part in each if part for block in part)
    if isinstance(raw, Mapping):
        extra = raw.get("extra", [])
        if not isinstance(extra, list):
            faults.add((*path, "extra"), extra, "must be a list of values")
        given = validated(Range, {key: value for key, value in raw.items() if key != "extra"}, path, faults)
        if given is None or not isinstance(extra, list):
            return None
        if given.intervals * resolution >= MOST:
            faults.add(path, "", f"must be at most {MOST} values, and not {given.intervals * resolution + 1}")
            return None
        return (*given.blocks(resolution), *([tuple(extra)] if extra else []))
    if isinstance(raw, list) and raw:
        return (tuple(raw),)
    faults.add(path, raw, "must be a list of values, or a range {start, stop, count or step}")
    return None


def without_repeats(blocks: Iterable[Iterable[Any]]) -> tuple[tuple[Any, ...], ...]:
    """Blocks of sorted values, each value in the first block that has it; empty blocks are dropped."""
    seen: set[Any] = set()
    kept = []
    for block in blocks:
        new = sorted(set(block) - seen)
        seen.update(new)
        if new:
            kept.append(tuple(new))
    return tuple(kept)
