"""What all schemas of this package share: the kinds of numbers, and the base of what files say."""

from __future__ import annotations

import math
import numbers
from typing import Annotated, Any

from pydantic import BaseModel, BeforeValidator, ConfigDict


def number(value: Any) -> Any:
    """Turn what stands for a number into a float; leave the rest for pydantic to refuse.

    Strings are accepted because YAML reads ``1e-3`` as one. A bool is no number here, although Python says
    so.
    """
    if isinstance(value, str):
        return float(value)
    if isinstance(value, bool) or not isinstance(value, int | float | numbers.Real):
        raise ValueError("must be a number")
    try:
        return float(value) + 0.0  # adding zero turns -0.0 into 0.0
    except OverflowError:  # a whole number beyond the range of floats
        return math.inf if str(value)[0] != "-" else -math.inf


def whole(value: Any) -> Any:
    """Like `number`, for counts: 4, 4.0 and "4" are the same, 4.5 is refused."""
    if isinstance(value, int) and not isinstance(value, bool):
        return value
    found = number(value)
    if not found.is_integer():
        raise ValueError("must be a whole number")
    return int(found)


Real = Annotated[float, BeforeValidator(number)]
Count = Annotated[int, BeforeValidator(whole)]


class Strict(BaseModel):
    """What a file says: immutable, unknown keys refused."""

    model_config = ConfigDict(frozen=True, extra="forbid")


def shown(value: Any) -> str:
    """A value as messages show it: as written, but short."""
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."
