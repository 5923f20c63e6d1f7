"""Measure what truncating the modes does to what a study asks for."""

from __future__ import annotations

import argparse

import xarray as xr

from disc_model.benchmarks.truncation import contact_study, truncation_study
from disc_model.data.dataset import save

STUDIES = {"truncation": truncation_study, "contact_truncation": contact_study}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("study", choices=STUDIES, help="rigid contact, or what residual flexibility changes")
    parser.add_argument("output", help="netCDF file to write")
    args = parser.parse_args()
    save(xr.DataTree(STUDIES[args.study]()), args.output)


if __name__ == "__main__":
    main()
