"""Remove files of grid studies to which no study refers any more, and report their size. Standard
input has, as JSON, the names of batches and motions to keep, by study."""

import json
import sys
from pathlib import Path

from disc_model.errors import script

FOLDERS = ("batches", "motions", "logs/compute_batch", "logs/compute_motions")


@script
def main(results: str = "results") -> None:
    kept = json.load(sys.stdin)
    for study, names in kept.items():
        files = [
            path
            for folder in FOLDERS
            for path in Path(results, study, folder).glob("*.*")
            if path.is_file()
        ]
        stale = [path for path in files if path.name.split(".")[0] not in names]
        size = sum(path.stat().st_size for path in stale)
        for path in stale:
            path.unlink()
        print(f"{study}: {len(stale)} files, {size / 1e6:.1f} MB")
    for study in sorted(
        {path.parent.name for path in Path(results).glob("*/batches")} - kept.keys()
    ):
        print(f"{study}: no study of this configuration, left alone")
