"""Simulate one case, given as the text of `disc_model.studies.case.CaseSpec.canonical`, and save it."""

from __future__ import annotations

import argparse
import logging

from disc_model.dataset import save
from disc_model.studies.batch import run_case
from disc_model.studies.case import CaseSpec


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("case", help="canonical JSON text of the case")
    parser.add_argument("output", help="netCDF file to write")
    args = parser.parse_args()
    logging.basicConfig(level=logging.INFO, format="%(name)s: %(message)s")
    save(run_case(CaseSpec.from_canonical(args.case)), args.output)


if __name__ == "__main__":
    main()
