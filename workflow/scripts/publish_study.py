"""Copy a merged study, if it is intact, and its list of points that failed."""

from __future__ import annotations

import argparse
import shutil
from pathlib import Path

from disc_model.data.dataset import check_whole, each_intact
from disc_model.errors import exit_on_error


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("nc", "failed", "to_nc", "to_failed"):
        parser.add_argument(name, type=Path)
    args = parser.parse_args()
    each_intact(check_whole, [args.nc])
    shutil.copyfile(args.nc, args.to_nc)
    shutil.copyfile(args.failed, args.to_failed)


if __name__ == "__main__":
    exit_on_error(main)
