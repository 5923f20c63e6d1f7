"""Remove files of grid studies to which no study refers any more, and say how much that was.

What to keep is read from standard input as JSON: by study, names of batches, motions and merged files.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

RULES = ("compute_batch", "merge_batches", "compute_motions")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--results", type=Path, default=Path("results"))
    args = parser.parse_args()
    kept = json.load(sys.stdin)
    for study, names in kept.items():
        stale = [path for path in _files(args.results / study) if path.name.split(".")[0] not in names]
        size = sum(path.stat().st_size for path in stale)
        for path in stale:
            path.unlink()
        print(f"{study}: {len(stale)} files, {size / 1e6:.1f} MB")
    for study in sorted(path.parent.name for path in args.results.glob("*/batches") if path.parent.name not in kept):
        print(f"{study}: no study of this configuration, left alone")


def _files(study: Path) -> list[Path]:
    folders = ("batches", "merged", "motions", *(f"logs/{rule}" for rule in RULES))
    return sorted(path for folder in folders for path in (study / folder).glob("*.*") if path.is_file())


if __name__ == "__main__":
    main()
