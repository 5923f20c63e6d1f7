"""Reading YAML files that people write: what YAML itself would pass over or end in an error of its own is a fault."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yaml

from disc_model.studies.faults import StudyError


def read_file(path: Path) -> tuple[Any, list[str]]:
    """A YAML file's content and the keys that it gives twice; raises `StudyError` if it cannot be read."""
    try:
        return read_yaml(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise StudyError(f"cannot be read: {error.strerror}", source=str(path)) from None
    except StudyError as error:
        raise StudyError(*error.faults, source=str(path)) from None


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


def read_yaml(text: str) -> tuple[Any, list[str]]:
    """A YAML document and the keys that it gives twice.

    Raises
    ------
    StudyError
        If the text is no YAML.
    """
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
        raise StudyError(_marked(error)) from None
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        # ValueError: numbers and dates that look like one but are none
        raise StudyError(" ".join(str(error).split())) from None
    except (AttributeError, KeyError, TypeError) as error:
        # so ends a tag such as !!timestamp or !!bool before a value that is none
        raise StudyError(f"a value does not fit its tag ({' '.join(str(error).split())})") from None
