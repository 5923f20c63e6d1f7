"""Looks that a reader wishes for the stable and the unstable parts of a branch, and for its cycles."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from matplotlib.cbook import normalize_kwargs
from matplotlib.lines import Line2D

from disc_model.errors import Fault, ParameterError, require

NO_WISHES: Mapping[str, Any] = MappingProxyType({})
PARTS = ("stable", "unstable", "cycles")
"""What has looks: both parts of a branch, and the marks of the cycles that were computed."""
RULE = f"must be a dict of some of {', '.join(PARTS)}, each with properties of matplotlib's lines"
TAKEN = ("label", "transform", "gid", "markevery", "data")
"""Properties of lines that are no looks."""


class PartLooks(NamedTuple):
    """Properties of lines of matplotlib that a reader wishes for the parts of a branch."""

    stable: Mapping[str, Any] = NO_WISHES
    unstable: Mapping[str, Any] = NO_WISHES
    cycles: Mapping[str, Any] = NO_WISHES

    @property
    def tell_stability(self) -> bool:
        """Whether the reader's dashes tell stable from unstable parts, and not branches apart."""
        return "linestyle" in self.stable or "linestyle" in self.unstable

    @property
    def coloured(self) -> list[str]:
        """Which of both parts have a colour that the reader wishes."""
        parts = {"stable": self.stable, "unstable": self.unstable}
        return [part for part, look in parts.items() if "color" in look]


AS_USUAL = PartLooks()


def part_looks(wished: object) -> PartLooks:
    """The looks that a reader wishes, given as a dict or None; raises `ParameterError` if they cannot be
    understood."""
    wished = {} if wished is None else wished
    known = isinstance(wished, Mapping) and {*wished} <= {*PARTS}
    require((known, "looks", wished, RULE))
    assert isinstance(wished, Mapping)
    return PartLooks(**{part: _properties(part, wished[part]) for part in wished})


def _properties(part: str, given: object) -> dict[str, Any]:
    """Properties of lines by their whole names; raises `ParameterError` if matplotlib has none such."""
    require((isinstance(given, Mapping), f"looks.{part}", given, RULE))
    assert isinstance(given, Mapping)
    try:
        properties = dict(normalize_kwargs({**given}, Line2D))
        Line2D([], [], **properties)
    except (AttributeError, TypeError, ValueError) as error:
        raise ParameterError(Fault.of((f"looks.{part}",), given, f"{RULE}: {error}")) from None
    taken = [name for name in TAKEN if name in properties]
    require((not taken, f"looks.{part}", given, f"must leave {' and '.join(taken)} as they are"))
    return properties
