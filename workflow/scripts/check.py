"""Clean up results after a fault, while no jobs are running.

Removed are netCDF files that cannot be read, remains of killed jobs, and files without a record of
Snakemake, a JSON list on standard input. Times in the future become the present: Snakemake refuses
results older than their inputs.
"""

import json
import os
import sys
import time
from pathlib import Path

from disc_model.data.dataset import UnreadableFile, load
from disc_model.errors import script


@script
def main(folder: str = "results") -> None:
    results = Path(folder)
    unrecorded = [Path(name) for name in json.load(sys.stdin)]
    datasets = sorted(results.rglob("*.nc"))
    damaged = []
    for path in datasets:
        try:
            load(path)
        except UnreadableFile as error:
            print(f"{error}; removed")
            damaged.append(path)
    for path in unrecorded:
        print(f"{path}: not known how it was made, removed")
    leftovers = sorted(results.rglob(".*.tmp"))
    for path in [*leftovers, *damaged, *unrecorded]:
        path.unlink(missing_ok=True)
    now = time.time()
    early = [path for path in results.rglob("*") if path.stat().st_mtime > now]
    for path in early:
        os.utime(path, (now, now))
    print(
        f"{len(datasets)} datasets, {len(damaged)} damaged; {len(leftovers)} left-overs of killed jobs removed"
    )
    if early:
        print(f"{len(early)} files had times in the future and now have the present one")
    if damaged or unrecorded or early:
        print("Run snakemake again: it makes anew what is needed.")
