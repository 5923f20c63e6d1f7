"""What is known of axes for further pictures on them, which ends with them."""

from typing import Any, Generic, TypeVar

from disc_model.figures.types import Axes

Value = TypeVar("Value")
KNOWN = "_disc_model_known"
"""Attribute of axes: what is known of them, by its name."""


class Known(dict[str, Any]):
    """What is known of axes, by its name; copies of the axes, as by pickle, begin with nothing."""

    def __reduce__(self) -> tuple[type["Known"], tuple[()]]:
        return Known, ()


class Kept(Generic[Value]):
    """Values of one kind, each kept by its axes.

    A dictionary of axes, even with weak references to them, would keep all axes for ever whose values
    have lines or texts, which refer to their axes.
    """

    def __init__(self, name: str) -> None:
        self.name = name

    def get(self, ax: Axes, default: Value) -> Value:
        """The value of axes, or another if they have none."""
        value: Value = vars(ax).get(KNOWN, {}).get(self.name, default)
        return value

    def __setitem__(self, ax: Axes, value: Value) -> None:
        vars(ax).setdefault(KNOWN, Known())[self.name] = value
