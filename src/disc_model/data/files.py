"""Whole files: their names, and how they are written in one piece."""

from __future__ import annotations

import os
import secrets
from collections.abc import Callable
from pathlib import Path

from disc_model.errors import DiscModelError, require


class WriteError(DiscModelError, OSError):
    """A file could not be written."""


class MissingFile(DiscModelError, FileNotFoundError):
    """A file that is to be read does not exist."""


class UnreadableFile(DiscModelError):
    """A file that is damaged, or that `save` has not written."""


def unreadable(path: str | Path, reason: object) -> UnreadableFile:
    """The error of a file that cannot be read, with the reason."""
    return UnreadableFile(f"{path}: cannot be read: {reason}")


def regular_file(path: str | os.PathLike[str], *suffixes: str) -> Path:
    """A path that may be that of a file, with one of some suffixes if there are any; raises
    `ParameterError`."""
    is_path = isinstance(path, str | os.PathLike)
    rule = "must be the name of a file"
    require((is_path and not os.path.isdir(path), "path", str(path), rule))
    file = Path(path)
    known = not suffixes or file.suffix in suffixes
    require((known, "path", str(path), f"must end in {' or '.join(suffixes)}"))
    return file


def write_atomically(path: Path, write: Callable[[str], object]) -> None:
    """Write a file by `write` under a temporary name, and rename it: after a failure `path` is
    unchanged. Raises `WriteError`."""
    # `write` makes the file, so that the umask determines its permissions; the name is short, as
    # the file's own may have the greatest length
    temporary = path.with_name(f".{secrets.token_hex(8)}.tmp")
    try:
        if not os.path.isdir(path.parent):
            raise WriteError(f"{path}: must be in a folder that exists")
        write(str(temporary))
        os.replace(temporary, path)
    except DiscModelError:
        raise
    except (OSError, RuntimeError, ValueError) as error:
        # the netCDF library raises RuntimeError, without the system's reason
        raise WriteError(f"{path}: cannot be written: {error}") from error
    finally:
        temporary.unlink(missing_ok=True)
