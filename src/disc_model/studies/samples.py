"""Samples of a table, whose numbers vary together along one dimension of a sweep, and what stands beside
them."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from difflib import get_close_matches
from typing import Any, NamedTuple

import numpy as np

from disc_model.errors import Fault, suggestion
from disc_model.studies.swept_values import checked_values
from disc_model.units import is_missing, is_number

OF_SWEEPS = ("status", "message")
"""Variables that every sweep has."""
LIKE = 0.8
"""Likeness of two names from which the first is taken to be the second with a slip of the pen."""


@dataclass(frozen=True)
class Dimension:
    """Values of numbers of the case that vary together, in columns of one length by name.

    Attributes
    ----------
    columns : the values
    labels : words of the points beside them, such as names of samples
    beside : numbers of the points that are none of the case, such as the temperature in the laboratory
    """

    columns: Mapping[str, list[Any]]
    labels: Mapping[str, list[Any]] = field(default_factory=dict)
    beside: Mapping[str, list[float]] = field(default_factory=dict)

    @property
    def name(self) -> str:
        return "_".join(self.columns)

    @property
    def coordinates(self) -> list[str]:
        """Names of all that stands along the dimension."""
        return [*self.columns, *self.labels, *self.beside]

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))

    def points(self) -> list[dict[str, Any]]:
        """The values by name, at each place along the dimension."""
        names = self.columns.keys()
        rows = zip(*self.columns.values(), strict=True)
        return [dict(zip(names, row, strict=True)) for row in rows]


class Known(NamedTuple):
    """Names that columns of a table may have.

    names, numbers : all of the case that may vary, and those of them that are numbers
    alone : those that are dimensions by themselves
    arguments : of the function
    """

    names: Sequence[str]
    numbers: Sequence[str]
    alone: Sequence[str]
    arguments: Sequence[str]


def _columns_of(zipped: Any) -> dict[str, list[Any]]:
    """The columns of a mapping or of a pandas.DataFrame, of which an index of words with a name is
    one; none of anything else."""
    if not (isinstance(zipped, Mapping) or hasattr(zipped, "columns")):
        return {}
    table = dict(zipped.items())
    index: Any = getattr(zipped, "index", None)
    if isinstance(getattr(index, "name", None), str):
        words = list(index)
        if _are_labels(words):
            table = {index.name: words, **table}
    return table


def _are_labels(values: Any) -> bool:
    """Whether these are words, or yes and no, of which some may be missing."""
    present = _present_in(values)
    return bool(present) and all(isinstance(value, str | bool | np.bool_) for value in present)


def _labels_in(table: Mapping[str, Any], names: Sequence[str]) -> dict[str, list[Any]]:
    """The columns that only name the points: of words or of yes and no, under names that no number
    of the case has and that are no slip of the pen of one."""
    folded = [name.lower() for name in names]
    labels = {}
    for name, values in table.items():
        meant = get_close_matches(str(name).lower(), folded, n=1, cutoff=LIKE)
        if name in names or meant or not _are_labels(values):
            continue
        labels[str(name)] = ["" if is_missing(value) else value for value in values]
    return labels


def _numbers_beside(table: Mapping[str, Any], known: Known) -> dict[str, list[float]]:
    """The columns of numbers under names that are none of the case or of an argument, and that are
    no slip of the pen of one; a missing number is nan."""
    names = [*known.names, *known.arguments]
    beside = {}
    for name, values in table.items():
        if not _meant_by(name, names) and _are_numbers(values):
            beside[str(name)] = [np.nan if is_missing(value) else value for value in values]
    return beside


def _by_plain_names(columns: Mapping[str, list[Any]]) -> dict[str, list[Any]]:
    """The columns under names that coordinates may have in a file, of letters, digits and `_`."""
    return {"_".join(re.findall(r"\w+", name)) or name: values for name, values in columns.items()}


def _meant_by(name: object, names: Sequence[str]) -> str:
    """Which of the names may be meant by one, as text; "" if none."""
    return suggestion(str(name), names, all_of_them=False).partition(" (known")[0]


def _are_numbers(values: Any) -> bool:
    """Whether these are numbers, of which some may be missing."""
    present = _present_in(values)
    return bool(present) and all(map(is_number, present))


def _present_in(values: Any) -> list[Any]:
    """The values of a column that are not missing; none of what is no column."""
    if isinstance(values, str) or not np.iterable(values):
        return []
    return [value for value in values if not is_missing(value)]


def _rule_of_unknown(name: object, known: Known) -> str:
    """The rule that a column breaks whose name is none of the case."""
    if name in known.arguments:
        return "is an argument of the function, and no number of the case: give it in over"
    like = _meant_by(name, [*known.names, *known.arguments])
    rename = "; a column beside the samples must hold words or numbers under a name of its own"
    return f"is no number of the case{like} (known: {', '.join(known.numbers)}){rename}"


def zipped_dimension(zipped: Any, known: Known, faults: list[str]) -> Dimension:
    """The dimension of values that vary together, in SI units, with what stands beside them.

    Parameters
    ----------
    zipped : what the user gave
    known : names that its columns may have
    faults : gets what is wrong
    """
    table = _columns_of(zipped)
    labels = _labels_in(table, known.names)
    beside = _numbers_beside(table, known)
    kept = {**labels, **beside}
    for name in kept.keys() & {*OF_SWEEPS}:
        faults.append(Fault(("zip", name), "", "must have another name: every sweep has one"))
    values_by_name = {name: values for name, values in table.items() if str(name) not in kept}
    if not values_by_name:
        rule = "must have columns of values by the names of numbers of the case, such as N"
        faults.append(Fault.of(("zip",), zipped, rule))
    columns = {}
    for name, values in values_by_name.items():
        if name not in known.names:
            faults.append(Fault(("zip", str(name)), "", _rule_of_unknown(name, known)))
        elif name in known.alone:
            faults.append(Fault(("zip", name), "", "must not be an axis as well"))
        else:
            columns[name] = checked_values(name, values, faults, "zip")
    lengths = {name: len(values) for name, values in (columns | kept).items()}
    if len({*lengths.values()}) > 1:
        faults.append(Fault.of(("zip",), lengths, "must have columns of one length"))
    return Dimension(columns, _by_plain_names(labels), _by_plain_names(beside))
