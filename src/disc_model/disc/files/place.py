"""Where the slider runs in the coordinates of a universal file."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Annotated, Any, Self

import numpy as np
from pydantic import BeforeValidator

from disc_model.disc.plate import Array
from disc_model.errors import Fault
from disc_model.units import Finite, Positive, Strict, Unit, in_si


def _axis(value: Any) -> Any:
    """The unit vector of an axis, from a word such as "-z" or three numbers."""
    rule = 'must be "x", "y", "z", one of these with a minus, or three numbers that are not all 0'
    if isinstance(value, str) and value.strip().lower() in AXES:
        return AXES[value.strip().lower()]
    vector = np.array(_three_numbers(value, rule))
    length = float(np.linalg.norm(vector))
    if not 0 < length < math.inf:
        raise ValueError(rule)
    return tuple((vector / length).tolist())


def _point(value: Any) -> Any:
    """Three numbers, also from a text with commas."""
    return _three_numbers(value, "must be three numbers, x, y and z in m")


def _three_numbers(value: Any, rule: str) -> tuple[float, ...]:
    """Three numbers from a text with commas or a sequence."""
    try:
        numbers = tuple(float(part) for part in _parts(value))
    except (TypeError, ValueError, OverflowError):
        raise ValueError(rule) from None
    if len(numbers) != 3:
        raise ValueError(rule)
    return numbers


def _parts(value: Any) -> Iterable[Any]:
    """What a text with commas or a sequence consists of."""
    if isinstance(value, str):
        return value.split(",")
    return iter(value)


def _two_units(value: Any) -> Any:
    """m and N in units of length and force, such as ("mm", "N")."""
    rule = 'must be units of length and of force, such as ("mm", "N")'
    try:
        length, force = _parts(value)
    except (TypeError, ValueError):
        raise ValueError(rule) from None
    faults: list[Fault] = []
    in_m = in_si(f"1 {length}", "m", faults, ())
    in_newton = in_si(f"1 {force}", "N", faults, ())
    if faults or not (isinstance(in_m, float) and isinstance(in_newton, float)):
        raise ValueError(rule)
    return in_m, in_newton


AXES = {
    "x": (1.0, 0.0, 0.0),
    "y": (0.0, 1.0, 0.0),
    "z": (0.0, 0.0, 1.0),
    "-x": (-1.0, 0.0, 0.0),
    "-y": (0.0, -1.0, 0.0),
    "-z": (0.0, 0.0, -1.0),
}
"""Directions of axes by their words."""


class Place(Strict):
    """Where the slider runs in the coordinates of a file, and units where the file has none.

    Attributes
    ----------
    r_0 : m, radius of the slider's circle
    axis : unit vector from the disc to the slider; found if it is None
    centre : m, a point on the axis; found if it is None
    units : m and N in units of length and force
    modal_mass : of modes whose modal mass or modal A is 0, in the file's unit of mass; None to
        refuse these
    """

    r_0: Annotated[Positive, Unit("m")]
    axis: Annotated[tuple[Finite, Finite, Finite], BeforeValidator(_axis)] | None = None
    centre: Annotated[tuple[Finite, Finite, Finite], BeforeValidator(_point), Unit("m")] | None = (
        None
    )
    units: Annotated[tuple[Positive, Positive], BeforeValidator(_two_units)] | None = None
    modal_mass: Positive | None = None

    @classmethod
    def of(cls, *, r_0: Any, **options: Any) -> Self:
        """The place of arguments, of which those that are None are left out."""
        given = {name: value for name, value in options.items() if value is not None}
        return cls(r_0=r_0, **given)

    @property
    def vectors(self) -> tuple[Array | None, Array | None]:
        """Axis and centre as vectors; None where they are to be found."""
        axis = centre = None
        if self.axis is not None:
            axis = np.array(self.axis)
        if self.centre is not None:
            centre = np.array(self.centre)
        return axis, centre
