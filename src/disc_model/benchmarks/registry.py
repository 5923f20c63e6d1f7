"""Registry of the methods, from ``rivals.toml``: each is an entry there and a class in `disc_model.benchmarks.methods`.

The module imports nothing heavy: the workflow reads it at every start.
"""

import math
import tomllib
from collections.abc import Iterable
from importlib.util import find_spec
from pathlib import Path
from typing import Literal

from pydantic import BaseModel, ConfigDict

SCENES = ("stick_slip", "separating", "many_modes", "rigid")
"""Names of the benchmark's scenes, see `disc_model.benchmarks.scenes`."""


def absent(packages: Iterable[str]) -> list[str]:
    """Those of some packages that are not installed."""
    return [name for name in packages if find_spec(name) is None]


class Rival(BaseModel):
    """A method as the file declares it; the file explains the keys."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    name: str
    label: str
    place: str
    arguments: tuple[str, ...] = ()
    setting: Literal["tol", "step", "epsilon"] = "tol"
    order: float = math.nan
    settings: dict[str, tuple[float, ...]]
    map_values: tuple[float, ...] = ()
    map_budget: float = 1.0
    maps: tuple[str, ...] = ()
    requires: tuple[str, ...] = ()


_DECLARED = tomllib.loads(Path(__file__).with_name("rivals.toml").read_text(encoding="utf-8"))
RIVALS = tuple(Rival(name=name, **given) for name, given in _DECLARED.items())
