"""Dimensions of a grid: axes, one parameter each, and zips, several parameters that vary together."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

from disc_model.data.variables import KICKS
from disc_model.errors import Fault, ParameterError
from disc_model.parameters import Parameters, cross_faults
from disc_model.schema import number, shown
from disc_model.studies.faults import Faults, add_parameter_faults, mapping
from disc_model.studies.grids.axes import Blocks, Value, parse_blocks, without_repeats
from disc_model.studies.start import START, SomeParameters
from disc_model.truncation import AUTO

PUBLISHED = "published"
"""The start that needs not be said."""
VARIED = (*Parameters.model_fields, START, *KICKS)
"""What a grid may vary, in the order of its dimensions: every parameter, and the start."""
RELATED = frozenset({"mu_s", "mu_k", "a", "b", "r_0", "E", "h", "nu"})
"""Parameters that rules relate to each other."""
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


def n_points(dims: Sequence[Dimension]) -> int:
    """Number of points of a grid."""
    return math.prod(len(dim.values) for dim in dims)


def parse_dimensions(
    raw: Mapping[str, Any], resolution: int, starts: Collection[str], faults: Faults
) -> tuple[Dimension, ...]:
    """The dimensions that a file gives rightly, in the order of `VARIED`."""
    dims: list[Dimension] = []
    for name, given in mapping(raw.get("axes")).items():
        path = ("axes", str(name))
        if name not in VARIED:
            faults.add(path, "", f"cannot be an axis (known: {', '.join(VARIED)})")
            continue
        blocks = parse_blocks(given, path, faults, resolution)
        checked = None if blocks is None else _checked(str(name), blocks, starts, path, faults)
        if checked is not None:
            dims.append(Dimension((str(name),), without_repeats([[(v,) for v in block] for block in checked])))
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
    columns: dict[str, list[Value]] = {}
    for name, given in group.items():
        if name not in VARIED:
            faults.add((*path, str(name)), "", f"cannot be an axis (known: {', '.join(VARIED)})")
            continue
        blocks = parse_blocks(given, (*path, name), faults)
        checked = None if blocks is None else _checked(name, blocks, starts, (*path, name), faults)
        if checked is not None:
            columns[name] = [value for block in checked for value in block]
    if not columns or len(columns) < len(group):
        return None
    lengths = {name: len(column) for name, column in columns.items()}
    if len(set(lengths.values())) > 1:
        faults.add(
            path, "", f"must have columns of equal length, not {', '.join(f'{n}: {k}' for n, k in lengths.items())}"
        )
        return None
    names = tuple(sorted(columns, key=VARIED.index))
    return Dimension(names, without_repeats([list(zip(*[columns[name] for name in names], strict=True))]))


def _checked(
    name: str, blocks: Blocks, starts: Collection[str], path: tuple[str, ...], faults: Faults
) -> Blocks | None:
    """Values as they are understood: floats, whole numbers, words. Each for itself; see `check_points`."""
    before = len(faults)
    found = tuple(tuple(_value(name, value, starts, path, faults) for value in block) for block in blocks)
    return found if len(faults) == before else None


def _value(name: str, value: Value, starts: Collection[str], path: tuple[str, ...], faults: Faults) -> Value:
    if name == START and not (isinstance(value, str) and value in starts):
        faults.add(path, value, f"no such start (known: {', '.join(starts)})")
    elif name == "n_diameters" and value == AUTO:
        faults.add(path, value, "cannot be varied: give it in base, for all points")
    elif name != START:
        try:
            return _kick(value) if name in KICKS else getattr(SomeParameters(**{name: value}), name)
        except ParameterError as error:
            add_parameter_faults(error.faults, lambda _: path, faults)
    return value


def _kick(value: Value) -> float:
    try:
        found = float(number(value))
    except ValueError:
        raise ParameterError(Fault(("kick",), shown(value), "must be a number")) from None
    if not math.isfinite(found):
        raise ParameterError(Fault(("kick",), shown(found), "must be finite"))
    return found


def check_points(dims: Sequence[Dimension], base: Mapping[str, Any], faults: Faults) -> None:
    """Faults for rules between parameters of which some vary, each where it is broken first."""
    related = [dim for dim in dims if not RELATED.isdisjoint(dim.names)]
    varied = [name for dim in related for name in dim.names]
    broken: set[str] = set()
    for point in product(*(dim.values for dim in related)):
        values = dict(zip(varied, (value for part in point for value in part), strict=True))
        for fault in cross_faults(Parameters, {**base, **values}):
            name = fault.path[0] if isinstance(fault, Fault) else ""
            if name not in broken:
                broken.add(name)
                add_parameter_faults([fault], lambda name: ("axes" if name in varied else "base", name), faults)


def check_size(dims: Sequence[Dimension], faults: Faults) -> None:
    """A fault for a grid of more than `MOST_POINTS`."""
    points = n_points(dims)
    if points > MOST_POINTS:
        faults.add(("axes",), "", f"must make at most {MOST_POINTS} points, and not {points}")
