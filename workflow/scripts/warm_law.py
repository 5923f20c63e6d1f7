"""Compile what grid studies of another law of contact need to find cycles, as warm_studies does for the paper's."""

from __future__ import annotations

import argparse

from disc_model.parameters import RESIDUAL, Parameters
from disc_model.stability.cycle import floquet


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("law", help="as in disc_model.studies.grids.schema: compliant_normal, for example")
    contact, force = parser.parse_args().law.split("_")
    compliance = RESIDUAL if contact == "compliant" else 0.0
    point = Parameters(N=385, Omega=15, contact_compliance=compliance, contact_force=force)
    print(floquet(point).message or "kernels compiled and cached")


if __name__ == "__main__":
    main()
