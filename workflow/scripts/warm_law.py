"""Compile what grid studies of another law of contact need to find cycles, as warm_studies does for the paper's."""

from __future__ import annotations

import argparse

from disc_model.parameters import Parameters
from disc_model.stability.cycle import floquet
from disc_model.studies.grids.schema import LAWS


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("law", choices=LAWS)
    point = Parameters(N=385, Omega=15, **LAWS[parser.parse_args().law])
    print(floquet(point).message or "kernels compiled and cached")


if __name__ == "__main__":
    main()
