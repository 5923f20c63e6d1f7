"""Which results Snakemake has no record of.

Snakemake keeps a record of how each file was made, and compares it with what is asked for now. Without one it takes the
file for up to date, whatever has changed since, and says nothing.

Where it keeps them is its own affair; `why_unknown` says whether it is where they are looked for here.
"""

from __future__ import annotations

import json
import os
from base64 import urlsafe_b64encode
from collections.abc import Iterable
from pathlib import Path
from typing import Any

_EXAMPLE = "results/paper/cases/F02.nc"


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


def why_unknown(workflow: Any) -> str:
    """What of Snakemake is not as `unrecorded` takes it to be, of the running ``workflow``; "" if all is."""
    try:
        from snakemake.persistence.file import FilePersistence
        from snakemake.settings.enums import PersistenceBackend

        if workflow.workflow_settings.persistence_backend != PersistenceBackend.FILE:
            return "they are in a database"
        store = FilePersistence.__new__(FilePersistence)  # which makes no folders
        store._max_len = 255
        place = store._record_path("metadata", _EXAMPLE)
    except (ImportError, AttributeError, TypeError) as error:
        return str(error)
    return "" if place == os.path.join("metadata", _name(_EXAMPLE)) else f"one is called {place}"


def _name(file: str) -> str:
    return urlsafe_b64encode(file.encode()).decode()


def _readable(record: Path) -> bool:
    try:
        json.loads(record.read_bytes())
    except (OSError, ValueError):
        return False
    return True
