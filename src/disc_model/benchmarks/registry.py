"""Registry of the methods: each is one file in `disc_model.benchmarks.methods` and one line here.

The module imports nothing heavy: the workflow reads it at every start.
"""

from importlib.util import find_spec
from typing import NamedTuple

SCENES = ("stick_slip", "separating", "many_modes", "rigid")
"""Names of the benchmark's scenes, see `disc_model.benchmarks.scenes`."""


class Rival(NamedTuple):
    """A method: its name, its place (``module:class`` in `disc_model.benchmarks.methods`), and its class's arguments.

    ``requires`` are the packages that it needs; ``maps`` are the scenes with a failure map of it.
    """

    name: str
    place: str
    arguments: tuple[object, ...] = ()
    requires: tuple[str, ...] = ()
    maps: tuple[str, ...] = ("separating",)

    def missing(self) -> tuple[str, ...]:
        """Packages that are not installed."""
        return tuple(package for package in self.requires if find_spec(package) is None)


RIVALS = (
    Rival("series", "series:Series"),
    Rival("series-fewest", "series:Fewest", maps=()),
    Rival("RK4", "rk4:FixedStep", maps=("stick_slip", "separating")),
    Rival("RK45", "solve_ivp:SolveIvp", ("RK45", 5)),
    Rival("DOP853", "solve_ivp:SolveIvp", ("DOP853", 8)),
    Rival("LSODA", "solve_ivp:SolveIvp", ("LSODA",)),
    Rival("Radau", "solve_ivp:SolveIvp", ("Radau", 5)),
    Rival("regularised", "regularised:Regularised"),
    Rival("heyoka", "taylor_heyoka:Heyoka", requires=("heyoka",)),
    Rival("CVODE", "cvode:Cvode", ("Adams",), requires=("sksundae",)),
    Rival("CVODE-BDF", "cvode:Cvode", ("BDF",), requires=("sksundae",), maps=()),
)
