"""Which results Snakemake has no record of.

Snakemake keeps a record of how each file was made, and compares it with what is asked for now. Without one it takes the
file for up to date, whatever has changed since, and says nothing.
"""

from __future__ import annotations

import json
from base64 import urlsafe_b64encode
from collections.abc import Iterable
from pathlib import Path


def unrecorded(files: Iterable[str], folder: Path = Path(".snakemake")) -> list[str]:
    """Those of the files that are there without a readable record.

    What an interrupted run left unfinished is not among them: Snakemake knows of it.
    """
    return [
        file
        for file in files
        if Path(file).exists()
        and not _readable(folder / "metadata" / _name(file))
        and not (folder / "incomplete" / _name(file)).exists()
    ]


def _name(file: str) -> str:
    return urlsafe_b64encode(file.encode()).decode()


def _readable(record: Path) -> bool:
    try:
        json.loads(record.read_bytes())
    except (OSError, ValueError):
        return False
    return True
