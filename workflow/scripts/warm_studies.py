"""Compile what grid studies need beyond the simulation, so that jobs started in parallel find it in the cache."""

from __future__ import annotations

import argparse

from disc_model.parameters import RESIDUAL, Parameters
from disc_model.stability.cycle import floquet


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--law", default="rigid_vertical", help="law of contact, as in disc_model.studies.grids.schema")
    contact, force = parser.parse_args().law.split("_")
    compliance = RESIDUAL if contact == "compliant" else 0.0
    point = Parameters(N=385, Omega=15, contact_compliance=compliance, contact_force=force)
    print(floquet(point).message or "kernels compiled and cached")


if __name__ == "__main__":
    main()
