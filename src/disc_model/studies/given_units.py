"""The units in which a study file gives its values, and in which its figures show them."""

from collections.abc import Iterator, Mapping
from typing import Any

from disc_model.data.variables import SHOWN
from disc_model.figures.kinds.base import si_unit
from disc_model.units import PARTS_OF_AXES, size_of_unit, unit_of_text

OF_OPTIONS = {
    "scan": ("parameter", "Omega"),
    "x_range": ("x", "Omega"),
    "y_lines": ("y", "N"),
    "low": ("", "Omega"),
}
"""Options with values of a parameter: the option that names it, and the parameter where it does not."""


def given_units(content: Mapping[str, Any]) -> dict[str, str]:
    """Units of the parameters of a study file, along its axes, zips and ranges of its options, and of those of
    its base: those in which all values of an axis are given, where figures have another one by themselves."""
    stated = stated_units(content)
    return {name: unit for name, unit in stated.items() if _is_another(name, unit)}


def stated_units(content: Mapping[str, Any]) -> dict[str, str]:
    """Units of these parameters, in which all values of an axis are given, whether figures have them by
    themselves or not."""
    units = {}
    for name, values in _given(content):
        found = {unit_of_text(text) for text in _texts(values)}
        unit = found.pop() if len(found) == 1 else ""
        if unit and _size(name, unit):
            units[name] = unit
    return units


def _given(content: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """Yield the parameters of the base of a file, and then those that it varies, with their values as they are
    given."""
    base = content.get("base")
    if isinstance(base, Mapping):
        yield from base.items()
    options = content.get("options")
    for key, (naming, usual) in OF_OPTIONS.items():
        if isinstance(options, Mapping) and key in options:
            yield str(options.get(naming, usual)), options[key]
    zips = content.get("zip") or []
    groups = zips if isinstance(zips, list) else [zips]
    for group in (*groups, content.get("axes")):
        if isinstance(group, Mapping):
            yield from group.items()


def _texts(values: Any) -> Iterator[str]:
    """Yield the numbers of an axis as texts, with their units if they have any."""
    match values:
        case Mapping():
            for key in PARTS_OF_AXES:
                yield from _texts(values.get(key, []))
        case list() | tuple():
            for value in values:
                yield from _texts(value)
        case _:
            yield str(values)


def _is_another(name: str, unit: str) -> bool:
    """Whether a unit of a parameter is another one than figures have for it."""
    return abs(_size(name, unit) * SHOWN[name].factor - 1) > 1e-12


def _size(name: str, unit: str) -> float:
    """The size in SI of a unit of the kind of a parameter's; 0 of another kind."""
    if name not in SHOWN or si_unit(name) in ("", "1"):
        return 0.0
    return size_of_unit(unit, si_unit(name))
