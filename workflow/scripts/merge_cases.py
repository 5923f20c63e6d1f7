"""Merge the files of cases, each named after its case, into one."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from disc_model.data.dataset import load_cases, save
from disc_model.errors import exit_on_error
from disc_model.studies.cases import merge_cases


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("output", help="netCDF file to write")
    parser.add_argument("cases", nargs="+", type=Path, help="netCDF files of the cases")
    parser.add_argument("--labels", type=json.loads, required=True, help="JSON: by case, its title and reference")
    args = parser.parse_args()
    save(merge_cases(load_cases(args.cases), args.labels), args.output)


if __name__ == "__main__":
    exit_on_error(main)
