"""Study files as YAML: what they hold, or one error that says what is wrong and where."""

from functools import partial
from pathlib import Path
from typing import Any

import yaml
from yaml.composer import ComposerError

from disc_model.data.files import MissingFile, unreadable
from disc_model.display import counted
from disc_model.errors import DiscModelError

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
    except (yaml.YAMLError, ValueError, RecursionError) as error:  # a text may look like a date
        reason = str(error).replace('in "<unicode string>", ', "")
    raise StudyError(f"cannot be read as YAML: {reason}", source=str(path))


class _Loader(yaml.SafeLoader):
    """Refuses a key that is given twice, of which YAML would take the last value."""

    def compose_mapping_node(self, anchor: Any) -> yaml.MappingNode:
        node = super().compose_mapping_node(anchor)
        known = set[str]()
        for key, _ in node.value:
            if key.value in known and key.value != "<<":
                raise ComposerError(None, None, f"{key.value} is given twice", key.start_mark)
            known.add(key.value)
        return node
