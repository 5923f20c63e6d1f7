"""Compile what grid studies need beyond the simulation, so that jobs started in parallel find it in the cache."""

from __future__ import annotations

from disc_model.parameters import Parameters
from disc_model.stability.cycle import floquet


def main() -> None:
    print(floquet(Parameters(N=385, Omega=15)).message or "kernels compiled and cached")


if __name__ == "__main__":
    main()
