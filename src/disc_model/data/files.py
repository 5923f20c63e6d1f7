"""Whole files: their names, how they are written in one piece, and the checksums by which damage is
noticed before a library reads a damaged file, which may give wrong numbers or end Python."""

from __future__ import annotations

import hashlib
import os
import secrets
from collections.abc import Callable
from pathlib import Path

from disc_model.errors import DiscModelError, Fault, ParameterError, require

SUFFIXES = (".nc", ".mat")
"""Endings of the files in which results and states are saved."""
_BLOCK = 1 << 20  # bytes that are read at once
_DIGITS = hashlib.sha256().digest_size * 2  # of a checksum, as text
_MARK = b"\ndisc_model: sha256 of the bytes before this line: "
_SEAL = len(_MARK) + _DIGITS + 1  # length of the line at the end of a netCDF file
MAT_TEXT = (
    116  # length of the text at the start of a .mat file, in which programs say what they like
)
_MAT_MARK = b"MATLAB 5.0 MAT-file, sha256 of bytes from 116 on: "


class WriteError(DiscModelError, OSError):
    """A file could not be written."""


class MissingFile(DiscModelError, FileNotFoundError):
    """A file that is to be read does not exist."""


RUN_BY = "DISC_MODEL_RUN_BY"
"""Variable of the environment with the command by which a reader runs a study, if it is not
snakemake."""


class UnreadableFile(DiscModelError):
    """A file that is damaged, or that `save` has not written."""


def run_command() -> str:
    """The command by which the reader runs a study."""
    return os.environ.get(RUN_BY, "snakemake")


def check_command() -> str:
    """The command that deletes damaged results."""
    if RUN_BY in os.environ:
        return f"{run_command()} --target check"
    return "snakemake check"


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


# ---- Checksums


def _digest(path: str | Path, start: int, stop: int) -> bytes:
    """The sha256 of the bytes of a file from `start` to `stop`, in hexadecimal digits."""
    sums = hashlib.sha256()
    with open(path, "rb") as file:
        file.seek(start)
        while start < stop:
            block = file.read(min(_BLOCK, stop - start))
            if not block:
                break
            sums.update(block)
            start += len(block)
    return sums.hexdigest().encode()


def seal_netcdf(path: str | Path) -> None:
    """Append the checksum of a netCDF file to it, as a line behind its end, which libraries do not
    read."""
    digest = _digest(path, 0, os.path.getsize(path))
    with open(path, "ab") as file:
        file.write(_MARK + digest + b"\n")


def check_netcdf(path: Path, *, required: bool = False) -> None:
    """Raise `UnreadableFile` if a netCDF file differs from the checksum at its end, or if it has
    none and one is `required`: files that other programs have written have none."""
    size = path.stat().st_size
    with open(path, "rb") as file:
        file.seek(max(size - _SEAL, 0))
        seal = file.read()
    if not required and not _resembles_seal(seal):
        return
    if not seal.startswith(_MARK):
        raise unreadable(path, "it has no checksum at its end, as it is damaged or another's")
    if seal != _MARK + _digest(path, 0, size - _SEAL) + b"\n":
        raise unreadable(path, "it is damaged, as it differs from the checksum at its end")


def _resembles_seal(end: bytes) -> bool:
    """Whether the end of a file is the line of a checksum, or was one before it was damaged."""
    agreeing = sum(a == b for a, b in zip(end, _MARK, strict=False))
    return 2 * agreeing > len(_MARK) or _MARK.strip() in end


def _mat_text(path: str | Path) -> bytes:
    """The text at the start of a .mat file, with the checksum of the rest. Other writers put the
    time there, so that equal results would give other bytes."""
    text = _MAT_MARK + _digest(path, MAT_TEXT, os.path.getsize(path))
    return text.ljust(MAT_TEXT)


def seal_mat(path: str | Path) -> None:
    """Enter the checksum of a .mat file in the text at its start."""
    text = _mat_text(path)
    with open(path, "r+b") as file:
        file.write(text)


def check_mat(path: Path) -> None:
    """Raise `UnreadableFile` if a .mat file differs from the checksum in the text at its start, or
    has none."""
    with open(path, "rb") as file:
        text = file.read(MAT_TEXT)
    if text != _mat_text(path):
        reason = "it is damaged or another's, as it differs from the checksum in its first line"
        raise unreadable(path, reason)
