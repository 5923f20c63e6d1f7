"""Files that are whole or not there, and whose damage is noticed.

HDF5 notices a changed byte in compressed arrays only: a changed scalar or attribute is read as if nothing had
happened. Files written here therefore end in a checksum, which readers of netCDF and HDF5 pass over.
"""

from __future__ import annotations

import hashlib
import os
import secrets
from collections.abc import Callable
from pathlib import Path

from disc_model.errors import DiscModelError

_LABEL = b"\nsha256 of the rest: "
_LENGTH = len(_LABEL) + 65


class WriteError(DiscModelError, OSError):
    """A file could not be written."""


class DamagedFile(DiscModelError):
    """A file that is not what was once written."""


def write_whole(path: Path, write: Callable[[str], object], size: int) -> None:
    """Write a file in one piece, with a checksum at its end: `path` is either what it was before or complete.

    Parameters
    ----------
    write : called with the name of a new file in the same folder, which it shall write
    size : bytes that the file will roughly have, to find out about a full disk

    Raises
    ------
    WriteError
        If the disk is full, or the file may not be that large.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    # made by `write`, so that the umask says who may read it
    temporary = path.with_name(f".{path.name}.{secrets.token_hex(8)}.tmp")
    try:
        write(str(temporary))
        _append_checksum(temporary)
        os.replace(temporary, path)
    except Exception:
        if refusal := _refusal(temporary, size):
            reason = refusal.strerror or str(refusal)
            raise WriteError(f"{path}: cannot be written: {reason} ({size / 1e6:.1f} MB needed)") from None
        raise
    finally:
        temporary.unlink(missing_ok=True)


def check_whole(path: Path) -> None:
    """Compare a file with the checksum at its end.

    Raises
    ------
    DamagedFile
        If it does not match or is not there.
    """
    content = path.read_bytes()
    body, end = content[:-_LENGTH], content[-_LENGTH:]
    if end != _checksum(body):
        raise DamagedFile(f"{path}: damaged or not written by this version of disc_model (its checksum does not match)")


def _append_checksum(path: Path) -> None:
    end = _checksum(path.read_bytes())
    with path.open("ab") as file:
        file.write(end)
        file.flush()
        os.fsync(file.fileno())  # else a crash of the machine may leave the new name with nothing in it


def _checksum(body: bytes) -> bytes:
    return _LABEL + hashlib.sha256(body).hexdigest().encode() + b"\n"


def _refusal(temporary: Path, size: int) -> OSError | None:
    """Why so many bytes cannot be written; the netCDF library only says that they were not."""
    try:
        with temporary.open("wb") as file:
            file.write(bytes(size))
    except OSError as error:
        return error
    return None
