"""Dimensions of a grid: axes, one parameter each, and zips, several parameters that vary together."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, product
from typing import Annotated, Any, Literal, Self

from pydantic import Field, create_model, model_validator

from disc_model.data.variables import KICKS
from disc_model.errors import ParameterError, suggestion
from disc_model.parameters import AUTO, RELATED, RESIDUAL, Count, Finite, Parameters, Real, Strict, cross_faults
from disc_model.simulation.case import START, SomeParameters
from disc_model.studies.files import Faults, add_parameter_faults, first_of_each, mapping, validated

# ----------------------------------------------------------------------------------------------------
# Values along one axis: lists, linear and logarithmic ranges, and blocks of them

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
            faults.add((*path, str(key)), raw[key], "unknown key (known: blocks)")
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


# ----------------------------------------------------------------------------------------------------
# Dimensions

PUBLISHED = "published"
"""The start that needs not be said."""
VARIED = (*Parameters.model_fields, START, *KICKS)
"""What a grid may vary, in the order of its dimensions: every parameter, and the start."""
_KICKS: dict[str, Any] = dict.fromkeys(KICKS, (Finite, 0.0))
_Varied = create_model("_Varied", __base__=SomeParameters, **_KICKS)
MOST_POINTS = 1_000_000
"""Of a grid. Snakemake takes hours over so many jobs, and much more does not fit into memory."""


@dataclass(frozen=True)
class Dimension:
    """One dimension of a grid: the parameters that vary along it, and their values in blocks of sorted tuples."""

    names: tuple[str, ...]
    blocks: tuple[tuple[tuple[Value, ...], ...], ...]

    @property
    def name(self) -> str:
        """The parameter, or the parameters of a zip, joined by _."""
        return "_".join(self.names)

    @property
    def values(self) -> tuple[tuple[Value, ...], ...]:
        """All values, sorted."""
        return tuple(sorted(value for block in self.blocks for value in block))


def points(dims: Sequence[Dimension]) -> Iterator[dict[str, Value]]:
    """What varies, by name, at every point of a grid."""
    names = [name for dim in dims for name in dim.names]
    for point in product(*(dim.values for dim in dims)):
        yield dict(zip(names, chain.from_iterable(point), strict=True))


def n_points(dims: Sequence[Dimension]) -> int:
    """Number of points of a grid."""
    return math.prod(len(dim.values) for dim in dims)


def thinned(dim: Dimension, most: int) -> Dimension:
    """A dimension of at most so many of its values, evenly spread by place and both ends among them; all, of words."""
    values = dim.values
    if len(values) > most and not any(isinstance(part, str) for value in values for part in value):
        last = len(values) - 1
        values = tuple(values[round(i * last / max(most - 1, 1))] for i in range(most))
    return Dimension(dim.names, (values,))


def parse_dimensions(
    raw: Mapping[str, Any], resolution: int, starts: Collection[str], faults: Faults
) -> tuple[Dimension, ...]:
    """The dimensions that a file gives rightly, in the order of `VARIED`."""
    dims: list[Dimension] = []
    for name, blocks in _columns(mapping(raw.get("axes")), ("axes",), starts, faults, resolution).items():
        dims.append(Dimension((name,), without_repeats([[(value,) for value in block] for block in blocks])))
    for i, group in enumerate(_zips(raw)):
        where = ("zip",) if isinstance(raw["zip"], Mapping) else ("zip", str(i))
        dim = _zipped(mapping(group), where, starts, faults)
        if dim is not None:
            dims.append(dim)
    return tuple(sorted(dims, key=lambda dim: VARIED.index(dim.names[0])))


def _zips(raw: Mapping[str, Any]) -> list[Any]:
    """What a file gives under ``zip``: one group, or a list of them."""
    zips = raw.get("zip")
    return [zips] if isinstance(zips, Mapping) else zips if isinstance(zips, list) else []


def asked(raw: Mapping[str, Any]) -> set[str]:
    """Parameters that a file wants to vary, whether or not it says rightly how."""
    return {str(name) for group in (raw.get("axes"), *_zips(raw)) for name in mapping(group)}


def _zipped(
    group: Mapping[Any, Any], path: tuple[str, ...], starts: Collection[str], faults: Faults
) -> Dimension | None:
    columns = {name: [*chain(*blocks)] for name, blocks in _columns(group, path, starts, faults).items()}
    if not columns or len(columns) < len(group):
        return None
    if len({len(column) for column in columns.values()}) > 1:
        lengths = ", ".join(f"{name}: {len(column)}" for name, column in columns.items())
        faults.add(path, "", f"must have columns of equal length, not {lengths}")
        return None
    names = tuple(sorted(columns, key=VARIED.index))
    return Dimension(names, without_repeats([list(zip(*[columns[name] for name in names], strict=True))]))


def _columns(
    given: Mapping[Any, Any], path: tuple[str, ...], starts: Collection[str], faults: Faults, resolution: int = 1
) -> dict[str, Blocks]:
    """Blocks of values by name, of what may vary and is right.

    Values are as they are understood: floats, whole numbers, words. Each for itself; see `check_points`.
    """
    found = {}
    for name, raw in given.items():
        place, before = (*path, str(name)), len(faults)
        if name not in VARIED:
            faults.add(place, "", f"cannot be an axis{suggestion(name, VARIED, all_of_them=False)}")
        elif (blocks := parse_blocks(raw, place, faults, resolution)) is not None:
            checked = tuple(tuple(_value(name, value, starts, place, faults) for value in block) for block in blocks)
            if len(faults) == before:
                found[str(name)] = checked
    return found


def _value(name: str, value: Value, starts: Collection[str], path: tuple[str, ...], faults: Faults) -> Value:
    if name == START and not (isinstance(value, str) and value in starts):
        faults.add(path, value, f"no such start{suggestion(value, starts)}")
    elif name == "n_diameters" and value == AUTO:
        faults.add(path, value, "cannot be varied: give it in base, for all points")
    elif name == "contact_compliance" and value == RESIDUAL:
        faults.add(path, value, "must be a number along an axis: give it in base, for all points")
    elif name != START:
        try:
            return getattr(_Varied(**{name: value}), name)
        except ParameterError as error:
            add_parameter_faults(error.faults, lambda _: path, faults)
    return value


def check_points(dims: Sequence[Dimension], base: Mapping[str, Any], faults: Faults) -> None:
    """Faults for rules between parameters of which some vary, each where it is broken first."""
    related = [dim for dim in dims if not set(RELATED).isdisjoint(dim.names)]
    varied = [name for dim in related for name in dim.names]
    broken = first_of_each(fault for point in points(related) for fault in cross_faults(Parameters, {**base, **point}))
    add_parameter_faults(broken, lambda name: ("axes" if name in varied else "base", name), faults)


def check_size(dims: Sequence[Dimension], faults: Faults) -> None:
    """A fault for a grid of more than `MOST_POINTS`."""
    if (size := n_points(dims)) > MOST_POINTS:
        faults.add(("axes",), "", f"must make at most {MOST_POINTS} points, and not {size}")
