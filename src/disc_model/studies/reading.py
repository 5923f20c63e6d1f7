"""Study files as YAML: what they hold, or one error that says what is wrong and where.

Read by the rules of YAML 1.1, but refused is what these would read in silence as something else:
a key that is given twice, numbers with another base than ten that do not look like it, and aliases
that stand for more values than fit into memory.
"""

from functools import partial
from pathlib import Path
from typing import Any

import yaml
from yaml.composer import ComposerError
from yaml.constructor import ConstructorError

from disc_model.data.files import MissingFile, unreadable
from disc_model.display import counted
from disc_model.errors import DiscModelError

MOST_EXPANDED = 50_000
"""Greatest number of values that a file may have by its aliases, beyond those that it spells out.
Ten levels of ten aliases, in 300 bytes, stand for ten thousand million."""

MOST_SHOWN = 50  # greatest number of faults in a message


class StudyError(DiscModelError, ValueError):
    """A study file that breaks rules; `faults` are all of them, each once, as ``path=value: rule``."""

    def __init__(self, *faults: str, source: str = "study") -> None:
        self.faults = tuple(dict.fromkeys(map(str, faults)))
        self.source = source
        lines = [f"{source}: {counted(len(self.faults), 'fault')}", *self.faults[:MOST_SHOWN]]
        if len(self.faults) > MOST_SHOWN:
            lines.append(f"and {len(self.faults) - MOST_SHOWN} more")
        super().__init__("\n  ".join(lines))

    def __reduce__(self) -> tuple[Any, ...]:
        return (partial(type(self), source=self.source), self.faults)


def read_file(path: Path) -> Any:
    """The content of a YAML file.

    Raises
    ------
    MissingFile
        If there is no such file.
    UnreadableFile
        If it is no file, or no text in UTF-8.
    StudyError
        If it is not the YAML that a study may have.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise MissingFile(f"{path}: there is no such file") from None
    except OSError as error:
        raise unreadable(path, error.strerror) from None
    except ValueError as error:  # a name with a null byte, or a text in another encoding
        raise unreadable(path, error) from None
    try:
        return yaml.load(text, _Loader)
    except yaml.YAMLError as error:
        reason = str(error).replace('in "<unicode string>", ', "")
    except RecursionError:
        reason = "its values are nested too deeply"
    except (ValueError, AttributeError, KeyError, TypeError) as error:
        # a text looks like a date, or has a tag, that it does not fit
        reason = f"a value does not fit its tag or form: {error}"
    raise StudyError(f"cannot be read as YAML: {reason}", source=str(path))


class _Loader(yaml.SafeLoader):
    """Refuses what YAML itself would take for something else than it looks like."""

    def get_single_node(self) -> yaml.Node | None:
        """The tree of the file's nodes, in which an alias is the node that it stands for."""
        node = super().get_single_node()
        if node is not None:
            _refuse_expansion(node)
        return node

    def compose_mapping_node(self, anchor: Any) -> yaml.MappingNode:
        """Refuse a key that is given twice, of which YAML would take the last value."""
        node = super().compose_mapping_node(anchor)
        known = set[str]()
        for key, _ in node.value:
            if key.value in known and key.value != "<<":
                raise ComposerError(None, None, f"{key.value} is given twice", key.start_mark)
            known.add(key.value)
        return node

    def construct_number(self, node: yaml.ScalarNode) -> Any:
        """Refuse numbers to the base 60, such as 1:30, and octal ones without 0o, such as 0100."""
        is_float = node.tag.endswith(":float")
        value = self.construct_yaml_float(node) if is_float else self.construct_yaml_int(node)
        text = node.value
        if ":" in text:
            rule = f"{text} means {value:g} in YAML (base 60): write that, or quote a text"
        elif not is_float and text.lstrip("+-").replace("_", "").isdigit() and _is_octal(text):
            rule = (
                f"{text} means {value} in YAML (octal): write that, or leave out the zeros before"
            )
        else:
            return value
        raise ConstructorError(None, None, rule, node.start_mark)


for _tag in ("int", "float"):
    _Loader.add_constructor(f"tag:yaml.org,2002:{_tag}", _Loader.construct_number)


def _is_octal(text: str) -> bool:
    """Whether YAML takes a whole number for an octal one: it begins with a zero, and is not zero."""
    digits = text.lstrip("+-").replace("_", "")
    return digits.startswith("0") and digits.strip("0") != ""


def _refuse_expansion(root: yaml.Node) -> None:
    """Raise `ComposerError` where aliases stand for too many values, or an alias stands for a node
    that holds it."""
    sizes: dict[int, int] = {}  # number of values of a node, by its identity; 0 while it is counted

    def size_of(node: yaml.Node) -> int:
        known = sizes.get(id(node))
        if known == 0:
            raise ComposerError(None, None, "an alias stands for what it is in", node.start_mark)
        if known is not None:
            return known
        sizes[id(node)] = 0
        total = 1
        if isinstance(node, yaml.SequenceNode):
            total += sum(map(size_of, node.value))
        elif isinstance(node, yaml.MappingNode):
            total += sum(size_of(key) + size_of(value) for key, value in node.value)
        sizes[id(node)] = total
        return total

    by_aliases = size_of(root) - len(sizes)
    if by_aliases > MOST_EXPANDED:
        rule = f"its aliases stand for {by_aliases} values, and may stand for {MOST_EXPANDED}"
        raise ComposerError(None, None, rule, root.start_mark)
