"""What is wrong with a file that people write: all faults at once, each with its path, in one `StudyError`."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from disc_model.errors import DiscModelError, Fault
from disc_model.schema import faults_of, shown

M = TypeVar("M", bound=BaseModel)


class StudyError(DiscModelError, ValueError):
    """A study file that breaks rules; lists every fault as ``path = value: rule``."""

    def __init__(self, *faults: str, source: str = "study") -> None:
        self.faults = faults
        self.source = source
        count = f"{len(faults)} fault{'s' if len(faults) > 1 else ''}"
        super().__init__("\n  ".join([f"{source}: {count}", *faults]))

    def __reduce__(self) -> tuple[Any, ...]:
        return (_rebuild_error, (self.faults, self.source))


def _rebuild_error(faults: tuple[str, ...], source: str) -> StudyError:
    return StudyError(*faults, source=source)


class Faults(list[str]):
    """Faults in the order found; what several cases inherit is listed once."""

    def add(self, path: tuple[str, ...], value: Any, rule: str) -> None:
        self.add_text(f"{dotted(path)}{'' if value == '' else f' = {shown(value)}'}: {rule}")

    def add_text(self, text: str) -> None:
        if text not in self:
            self.append(text)


@dataclass(frozen=True)
class Origin:
    """Tells for a place in an expanded case where the file says it: in the case, or in what it inherits."""

    path: tuple[str, ...]
    own: Mapping[str, Any]
    inherited: Mapping[str, Any]

    def of(self, place: tuple[str, ...]) -> tuple[str, ...]:
        if _depth(self.own, place) >= _depth(self.inherited, place):
            return (*self.path, *place)
        return ("base" if place[0] == "parameters" else place[0], *place[1:])


def _depth(mapping: Any, place: tuple[str, ...]) -> int:
    """How many steps of the way to a place lead through mappings that say something."""
    if not place or not isinstance(mapping, Mapping) or place[0] not in mapping:
        return 0
    return 1 + _depth(mapping[place[0]], place[1:])


def validated(model: type[M], raw: Any, path: tuple[str, ...], faults: Faults, place: Origin | None = None) -> M | None:
    """`raw` as a model, or None and its faults under `path`; `place` tells where inherited values stand."""
    try:
        return model.model_validate(raw)
    except ValidationError as error:
        for fault in faults_of(error, raw, model.model_fields):
            where = place.of(fault.path) if place and fault.path else (*path, *fault.path)
            faults.add_text(_said(where, fault))
        return None


def add_parameter_faults(found: Iterable[str], place: Callable[[str], tuple[str, ...]], faults: Faults) -> None:
    """Take over the faults of a `ParameterError`; `place` tells where the file gives a parameter."""
    for fault in found:
        faults.add_text(_said(place(fault.path[0]), fault) if isinstance(fault, Fault) and fault.path else fault)


def _said(where: tuple[str, ...], fault: Fault) -> str:
    return f"{dotted(where)}{f' = {fault.value}' if fault.value else ''}: {fault.rule}"


def dotted(path: tuple[str, ...]) -> str:
    """A path as messages show it."""
    return ".".join(path) if path else "study"


def is_name(text: str) -> bool:
    """Whether a text is letters, digits and _, beginning with a letter."""
    return text.isascii() and text.replace("_", "a").isalnum() and text[:1].isalpha()


def mapping(value: Any) -> Mapping[Any, Any]:
    """The value if it is a mapping, else an empty one."""
    return value if isinstance(value, Mapping) else {}


def inherit(base: Mapping[str, Any], own: Mapping[str, Any]) -> dict[str, Any]:
    """`own` over `base`, mappings merged key by key; None drops what is inherited."""
    merged = dict(base)
    for key, value in own.items():
        if value is None and key in base:
            del merged[key]
            continue
        old = merged.get(key)
        if isinstance(old, Mapping) and isinstance(value, Mapping):
            merged[key] = inherit(old, value)
        else:
            merged[key] = value
    return merged
