"""Types of arrays, and equality of objects that hold arrays."""

import dataclasses
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Indices = NDArray[np.int64]
Mask = NDArray[np.bool_]
Words = NDArray[np.str_]


class EqualByValue:
    """Base of dataclasses with ``eq=False`` that are equal if all of their fields but those with
    ``compare=False`` are, arrays number by number; nan equals nan."""

    def _compared(self) -> dict[str, Any]:
        """The fields that are compared, by name."""
        every = dataclasses.fields(self)  # type: ignore[arg-type]
        return {each.name: getattr(self, each.name) for each in every if each.compare}

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        try:
            np.testing.assert_equal(self._compared(), other._compared())
        except AssertionError:
            return False
        return True

    def __hash__(self) -> int:
        texts = [value for value in self._compared().values() if isinstance(value, str)]
        return hash((type(self).__name__, *texts))
