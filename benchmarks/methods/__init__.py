"""The table of methods, from ``rivals.toml``: the package's engine and its rivals.

They share only physics, `kernels`. This module imports nothing heavy, because the workflow reads it
at every start.
"""

from __future__ import annotations

import math
import tomllib
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Literal, get_args

from pydantic import BaseModel, ConfigDict

if TYPE_CHECKING:
    from benchmarks.methods.integrators import MethodResult, Problem

Scene = Literal["stick_slip", "separating", "many_modes", "rigid"]
SCENES: tuple[Scene, ...] = get_args(Scene)
"""Names of the benchmark's scenes, see `benchmarks.scenes`."""
DECADES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11)


class Method(BaseModel):
    """A method that integrates a problem, as the file declares it.

    Attributes
    ----------
    name, label : its name, and in words
    function : key of `solvers.SOLVERS`
    arguments : further arguments of the function
    setting : what its one number is
    settings : its values by scene, from coarse to fine
    map_values : its values in maps of failures
    map_budget : seconds for a point of a map
    map_arguments : arguments of the function in maps, if they are others
    maps : scenes of its maps
    requires : packages that it needs
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    name: str
    label: str
    function: str
    arguments: tuple[str, ...] = ()
    setting: Literal["tol", "step"] = "tol"
    settings: dict[Scene, tuple[float, ...]]
    map_values: tuple[float, ...] = DECADES
    map_budget: float = 1.0
    map_arguments: tuple[str, ...] | None = None
    maps: tuple[Scene, ...] = ()
    requires: tuple[str, ...] = ()

    def absent(self) -> list[str]:
        """Return the packages that it needs and that are not installed."""
        return [name for name in self.requires if find_spec(name) is None]

    def economical(self) -> Method:
        """Return the variant for maps, where every run has other modes and another setting."""
        if self.map_arguments is None:
            return self
        return self.model_copy(update={"arguments": self.map_arguments})

    def solve(self, problem: Problem, value: float, budget: float = math.inf) -> MethodResult:
        """Advance a problem.

        Parameters
        ----------
        problem : what is integrated
        value : of the setting
        budget : seconds after which it should give up
        """
        from benchmarks.methods.solvers import SOLVERS  # heavy

        return SOLVERS[self.function](problem, value, budget, *self.arguments)


def _declared() -> dict[str, Method]:
    """Return the methods that the file declares, by name."""
    path = Path(__file__).with_name("rivals.toml")
    table = tomllib.loads(path.read_text(encoding="utf-8"))
    return {name: Method(name=name, **fields) for name, fields in table.items()}


METHODS = _declared()
"""All methods by name."""
