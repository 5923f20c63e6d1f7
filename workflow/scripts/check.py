"""Clean up results after a fault, while no jobs are running.

Removed are netCDF files that cannot be read and remains of killed jobs. Times in the future become
the present: Snakemake refuses results older than their inputs. Where a symbolic link leads, nothing
is removed or changed.
"""

import os
import time
from collections.abc import Iterator
from pathlib import Path

from disc_model.data.dataset import MissingFile, UnreadableFile, load
from disc_model.data.files import run_command
from disc_model.errors import script


def put_right(results: Path, now: float) -> Iterator[Path]:
    """Files of which the time of change, in the future, has become `now` (s); of a symbolic link
    its own."""
    changeable = os.utime in os.supports_follow_symlinks
    for path in results.rglob("*"):
        is_link = path.is_symlink()
        if path.lstat().st_mtime > now and (changeable or not is_link):
            os.utime(path, (now, now), follow_symlinks=not is_link)
            yield path


@script
def main(folder: str = "results") -> None:
    results = Path(folder)
    datasets = [path for path in sorted(results.rglob("*.nc")) if not path.is_dir()]
    damaged = []
    for path in datasets:
        try:
            load(path)
        except (MissingFile, UnreadableFile) as error:
            print(f"{error}; removed")
            damaged.append(path)
    leftovers = [path for path in sorted(results.rglob(".*.tmp")) if not path.is_dir()]
    for path in [*leftovers, *damaged]:
        path.unlink(missing_ok=True)
    now = time.time()
    early = [*put_right(results, now)]
    print(
        f"{len(datasets)} datasets, {len(damaged)} damaged; {len(leftovers)} left-overs of killed jobs removed"
    )
    if early:
        print(f"{len(early)} files had times in the future and now have the present one")
    if damaged or early:
        print(f"Run `{run_command()}` again: it makes anew what is needed.")
