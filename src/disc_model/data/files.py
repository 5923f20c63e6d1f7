"""Whole files: their names, and how they are written in one piece."""

from __future__ import annotations

import os
import secrets
from collections.abc import Callable
from pathlib import Path

from disc_model.errors import DiscModelError, Fault, ParameterError, require


class WriteError(DiscModelError, OSError):
    """A file could not be written."""


class MissingFile(DiscModelError, FileNotFoundError):
    """A file that is to be read does not exist."""


class UnreadableFile(DiscModelError):
    """A file that is damaged, or that `save` has not written."""


def unreadable(path: str | Path, reason: object) -> UnreadableFile:
    """The error of a file that cannot be read, with the reason."""
    return UnreadableFile(f"{path}: cannot be read: {reason}")


# ---- Names and writing


def regular_file(path: str | os.PathLike[str]) -> Path:
    """A path that leads to a file or to nothing; raises `ParameterError` otherwise."""
    rule = "must be the name of a file"
    possible = isinstance(path, str | os.PathLike) and "\0" not in str(path)
    require((possible, "path", str(path), rule))
    file = Path(path)
    try:
        named = file.is_file() or not file.exists()
    except OSError as error:  # such as a name that is too long
        raise ParameterError(Fault.of(("path",), str(path), f"{rule}: {error.strerror}")) from None
    require((named, "path", str(path), rule))
    return file


def write_atomically(path: Path, write: Callable[[str], object]) -> None:
    """Write a file by `write` under a temporary name, and rename it: after a failure `path` is
    unchanged. Raises `WriteError`."""
    if not path.parent.is_dir():
        raise WriteError(f"{path}: must be in a folder that exists")
    # `write` makes the file, so that the umask determines its permissions; the name is short, as
    # the file's own may have the greatest length
    temporary = path.with_name(f".{secrets.token_hex(8)}.tmp")
    try:
        write(str(temporary))
        os.replace(temporary, path)
    except (OSError, RuntimeError) as error:
        # the netCDF library raises RuntimeError, without the system's reason
        raise WriteError(f"{path}: cannot be written: {error}") from error
    finally:
        temporary.unlink(missing_ok=True)
