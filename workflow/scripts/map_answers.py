"""Map where one method answers wrongly over its setting and the number of modes."""

from __future__ import annotations

import argparse

import xarray as xr

from disc_model.benchmarks.failure_maps import answer_map
from disc_model.benchmarks.register import RIVALS
from disc_model.data.dataset import save


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("method", choices=[rival.name for rival in RIVALS])
    parser.add_argument("output", help="netCDF file to write")
    args = parser.parse_args()
    save(xr.DataTree(answer_map(args.method)), args.output)


if __name__ == "__main__":
    main()
