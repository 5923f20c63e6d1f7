"""The table of methods, from ``rivals.toml``: the package's engine and its rivals, which share only
physics, `kernels`.

This module imports nothing heavy: the workflow reads it at every start.
"""

from __future__ import annotations

import math
import tomllib
from importlib.util import find_spec
from pathlib import Path
from pkgutil import resolve_name
from typing import TYPE_CHECKING, Literal, get_args

from pydantic import BaseModel, ConfigDict

if TYPE_CHECKING:
    from disc_model.benchmarks.methods.integrators import MethodResult, Problem

Scene = Literal["stick_slip", "separating", "many_modes", "rigid"]
SCENES: tuple[str, ...] = get_args(
    Scene
)  # names of the benchmark's scenes, see `disc_model.benchmarks.scenes`


class Method(BaseModel):
    """A method that integrates a problem, as the file declares it; the file explains the keys."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    name: str
    label: str
    function: str
    arguments: tuple[str, ...] = ()
    setting: Literal["tol", "step", "epsilon"] = "tol"
    settings: dict[Scene, tuple[float, ...]]
    map_values: tuple[float, ...] = tuple(float(f"1e-{digits}") for digits in range(2, 12))
    map_budget: float = 1.0
    map_arguments: tuple[str, ...] | None = None
    maps: tuple[Scene, ...] = ()
    requires: tuple[str, ...] = ()

    def absent(self) -> list[str]:
        """Packages that it needs and that are not installed."""
        return [name for name in self.requires if find_spec(name) is None]

    def economical(self) -> Method:
        """The variant of the method for maps, where every run has other modes and another
        setting."""
        return (
            self
            if self.map_arguments is None
            else self.model_copy(update={"arguments": self.map_arguments})
        )

    def solve(self, problem: Problem, value: float, budget: float = math.inf) -> MethodResult:
        """Advance ``problem`` with the setting equal to ``value`` for at most about ``budget``
        seconds."""
        function = resolve_name(f"{__name__}.integrators:{self.function}")
        result: MethodResult = function(problem, value, budget, *self.arguments)
        return result


_DECLARED = tomllib.loads(Path(__file__).with_name("rivals.toml").read_text(encoding="utf-8"))
METHODS = {
    name: Method(name=name, **fields) for name, fields in _DECLARED.items()
}  # all of them by name
