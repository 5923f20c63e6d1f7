"""Types of arrays, and equality of objects that hold arrays."""

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Indices = NDArray[np.int64]
Mask = NDArray[np.bool_]
Words = NDArray[np.str_]


class EqualByValue:
    """Base of dataclasses with ``eq=False`` that are equal if all of their fields are, arrays
    number by number; nan equals nan."""

    def _compared(self) -> dict[str, Any]:
        """The fields that are compared, by name."""
        return {each.name: getattr(self, each.name) for each in dataclasses.fields(self)}  # type: ignore[arg-type]

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return equal_values(self._compared(), other._compared())

    def __hash__(self) -> int:
        texts = [value for value in self._compared().values() if isinstance(value, str)]
        return hash((type(self).__name__, *texts))


def equal_values(one: Any, other: Any) -> bool:
    """Return whether two values are equal: arrays, mappings and sequences by their parts."""
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return _equal_arrays(np.asarray(one), np.asarray(other))
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        return one.keys() == other.keys() and all(equal_values(one[key], other[key]) for key in one)
    if isinstance(one, Sequence) and not isinstance(one, str):
        if type(one) is not type(other) or len(one) != len(other):
            return False
        return all(map(equal_values, one, other))
    if hasattr(one, "equals"):  # a table of pandas
        return bool(one.equals(other))
    return bool(one == other) or bool(one != one and other != other)  # nan differs from itself


def _equal_arrays(one: NDArray[Any], other: NDArray[Any]) -> bool:
    """Return whether arrays have the same shape and numbers, nan included."""
    numbers = one.dtype.kind in "fc" and other.dtype.kind in "fc"
    return bool(np.array_equal(one, other, equal_nan=numbers))
