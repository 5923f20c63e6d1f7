"""Clean up results after a fault.

Every netCDF file is compared with its checksum, and set aside if damaged. Remains of killed jobs are removed, and so
are the files without a record of Snakemake, read from standard input as a JSON list. Files with times in the future get
the present one, since Snakemake refuses results older than their inputs.

Not to be run while jobs are running.
"""

import json
import os
import sys
import time
from pathlib import Path

from disc_model.data.dataset import DamagedFile, set_aside, verify_checksum
from disc_model.errors import script


def whole(path: Path) -> bool:
    try:
        verify_checksum(path)
    except DamagedFile:
        return False
    return True


@script
def main(folder: str = "results") -> None:
    results = Path(folder)
    unrecorded = [Path(name) for name in json.load(sys.stdin)]
    datasets = sorted(results.rglob("*.nc"))
    damaged = [path for path in datasets if not whole(path)]
    for path in damaged:
        print(f"{path}: damaged, now called {set_aside(path).name}")
    for path in unrecorded:
        print(f"{path}: not known how it was made, removed")
    leftovers = sorted(results.rglob(".*.tmp"))
    for path in [*leftovers, *unrecorded]:
        path.unlink(missing_ok=True)
    now = time.time()
    early = [path for path in results.rglob("*") if path.stat().st_mtime > now]
    for path in early:
        os.utime(path, (now, now))
    print(f"{len(datasets)} datasets, {len(damaged)} damaged; {len(leftovers)} left-overs of killed jobs removed")
    if early:
        print(f"{len(early)} files had times in the future and now have the present one")
    if damaged or unrecorded or early:
        print("Run snakemake again: it makes anew what is needed.")
