"""Simulate one case, given as the text of `disc_model.simulation.case.CaseSpec.canonical`, and save it.

A job that was killed goes on when it is run again: from a hidden file beside its output, which Snakemake, not knowing
of it, leaves alone when it removes what a failed job has written.
"""

from __future__ import annotations

import argparse
import logging
from pathlib import Path

from disc_model.data.dataset import save
from disc_model.simulation.api import run_case
from disc_model.simulation.case import CaseSpec
from disc_model.simulation.kept import SET_ASIDE
from disc_model.studies.modes import choose


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("case", help="canonical JSON text of the case")
    parser.add_argument("output", type=Path, help="netCDF file to write")
    args = parser.parse_args()
    logging.basicConfig(level=logging.INFO, format="%(name)s: %(message)s")
    args.output.parent.mkdir(parents=True, exist_ok=True)
    checkpoint = args.output.with_name(f".{args.output.stem}.checkpoint")
    save(run_case(CaseSpec.from_canonical(args.case), checkpoint, choose), args.output)
    for former in checkpoint.parent.glob(f"{checkpoint.name}.*{SET_ASIDE}"):  # of former contents of the case
        former.unlink()
    checkpoint.unlink(missing_ok=True)


if __name__ == "__main__":
    main()
