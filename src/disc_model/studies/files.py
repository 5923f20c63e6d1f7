"""YAML files that people write: how they are read, and all that is wrong with one at once, in one `StudyError`."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated, Any, TypeVar

import yaml
from pydantic import BaseModel, StringConstraints, ValidationError

from disc_model.errors import DiscModelError, Fault, faults_of, shown
from disc_model.parameters import faults_of_names

# ----------------------------------------------------------------------------------------------------
# Faults, each with its path

M = TypeVar("M", bound=BaseModel)
T = TypeVar("T")
Name = Annotated[str, StringConstraints(pattern=r"^[A-Za-z][A-Za-z0-9_]*$")]


class StudyError(DiscModelError, ValueError):
    """A study file that breaks rules; lists every fault as ``path = value: rule``."""

    def __init__(self, *faults: str, source: str = "study") -> None:
        self.faults = faults
        self.source = source
        count = f"{len(faults)} fault{'s' if len(faults) > 1 else ''}"
        super().__init__("\n  ".join([f"{source}: {count}", *faults]))

    def __reduce__(self) -> tuple[Any, ...]:
        return (partial(type(self), source=self.source), self.faults)


class Faults(list[str]):
    """Faults in the order found; what several cases inherit is listed once."""

    def add(self, path: tuple[str, ...], value: Any, rule: str) -> None:
        self.add_shown(path, "" if value == "" else shown(value), rule)

    def add_shown(self, path: tuple[str, ...], value: str, rule: str) -> None:
        """As `add`, of a value as messages show it."""
        place = ".".join(path) if path else "study"
        self.add_text(f"{place}{f' = {value}' if value else ''}: {rule}")

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
    found = list(faults_of_names(raw))
    if not found:
        try:
            return model.model_validate(raw)
        except ValidationError as error:
            found += faults_of(error, raw, model)
    for fault in found:
        where = place.of(fault.path) if place and fault.path else (*path, *fault.path)
        faults.add_shown(where, fault.value, fault.rule)
    return None


def add_parameter_faults(found: Iterable[str], place: Callable[[str], tuple[str, ...]], faults: Faults) -> None:
    """Take over the faults of a `ParameterError`; `place` tells where the file gives a parameter."""
    for fault in found:
        if isinstance(fault, Fault) and fault.path:
            faults.add_shown(place(fault.path[0]), fault.value, fault.rule)
        else:
            faults.add_text(fault)


def first_of_each(found: Iterable[str]) -> list[Fault]:
    """Of each parameter the first fault."""
    first: dict[str, Fault] = {}
    for fault in found:
        if isinstance(fault, Fault):
            first.setdefault(fault.path[0], fault)
    return list(first.values())


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


# ----------------------------------------------------------------------------------------------------
# Reading: what YAML itself would pass over or end in an error of its own is a fault


def with_more_faults(parse: Callable[[Any], T], raw: Any, more: Sequence[str], source: str) -> T:
    """What ``parse`` makes of a file's content; faults found before come with its own, in one error with the source."""
    try:
        found = parse(raw)
    except StudyError as error:
        raise StudyError(*more, *error.faults, source=source) from None
    if more:
        raise StudyError(*more, source=source)
    return found


def read_file(path: Path) -> tuple[Any, list[str]]:
    """A YAML file's content and the keys that it gives twice; raises `StudyError` if it cannot be read."""
    try:
        return read_yaml(path.read_text(encoding="utf-8"), str(path))
    except OSError as error:
        raise StudyError(f"cannot be read: {error.strerror}", source=str(path)) from None
    except UnicodeDecodeError as error:
        raise StudyError(f"cannot be read: byte {error.start} is no UTF-8", source=str(path)) from None


def shown_path(path: Path) -> str:
    """A path as short as the current folder allows."""
    try:
        return str(path.resolve().relative_to(Path.cwd()))
    except ValueError:
        return str(path)


class _UniqueKeyLoader(yaml.SafeLoader):
    """Remembers keys given twice instead of silently taking the last."""

    def __init__(self, stream: Any) -> None:
        super().__init__(stream)
        self.faults: list[str] = []

    def construct_mapping(self, node: Any, deep: bool = False) -> Any:
        first: dict[Any, int] = {}
        for key_node, _ in node.value:
            key = key_node.value
            line = key_node.start_mark.line + 1
            if key in first and key != "<<":
                self.faults.append(f"{key}: given twice, in lines {first[key]} and {line}")
            first.setdefault(key, line)
        return super().construct_mapping(node, deep)


LARGEST = 100_000
"""Values in a file, repeated ones counted each time."""


def _count(node: yaml.Node, known: dict[int, int]) -> int:
    """Number of values below a node; a few lines of aliases of aliases can stand for more than fit into memory."""
    if id(node) in known:
        if not known[id(node)]:
            raise ValueError("a value contains itself")
        return known[id(node)]
    known[id(node)] = 0
    children: list[yaml.Node] = []
    if isinstance(node, yaml.MappingNode):
        children = [part for pair in node.value for part in pair]
    elif isinstance(node, yaml.SequenceNode):
        children = node.value
    known[id(node)] = 1 + sum(_count(child, known) for child in children)
    if known[id(node)] > LARGEST:
        raise ValueError(f"more than {LARGEST} values, repeated ones counted each time")
    return known[id(node)]


def _marked(error: yaml.MarkedYAMLError) -> str:
    """Where a text is no YAML, and why."""
    mark = error.problem_mark or error.context_mark
    place = f"line {mark.line + 1}, column {mark.column + 1}: " if mark else ""
    return place + ", ".join(part for part in (error.context, error.problem) if part)


def read_yaml(text: str, source: str = "study") -> tuple[Any, list[str]]:
    """A YAML document and the keys that it gives twice; raises `StudyError` if the text is none."""
    try:
        loader = _UniqueKeyLoader(text)
        try:
            node = loader.get_single_node()
            if node is None:
                return None, loader.faults
            _count(node, {})
            return loader.construct_document(node), loader.faults
        finally:
            loader.dispose()
    except yaml.MarkedYAMLError as error:
        raise StudyError(_marked(error), source=source) from None
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        # ValueError: numbers and dates that look like one but are none
        raise StudyError(" ".join(str(error).split()), source=source) from None
    except (AttributeError, KeyError, TypeError) as error:
        # so ends a tag such as !!timestamp or !!bool before a value that is none
        raise StudyError(f"a value does not fit its tag ({' '.join(str(error).split())})", source=source) from None
