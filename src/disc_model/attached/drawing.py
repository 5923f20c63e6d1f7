"""The room of figures, for what draws itself."""

from __future__ import annotations

from types import ModuleType
from typing import Any

from disc_model.display import brought


def drawings() -> ModuleType:
    """Return `disc_model.figures.results`, the functions that draw, imported when something is
    drawn; raises `ModuleNotFoundError`, with the command to install it, without matplotlib."""
    brought("matplotlib", "plot")
    from disc_model.figures import results

    return results


def draw(picture: str, *inputs: Any, **options: Any) -> Any:
    """Draw by a function of `disc_model.figures.results`, which is given by its name."""
    function = getattr(drawings(), picture)
    return function(*inputs, **options)
