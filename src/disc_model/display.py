"""What is shown to a reader: numbers in words, pictures, and the progress of what takes long."""

from __future__ import annotations

import math
from collections.abc import Sequence
from importlib import import_module
from types import ModuleType
from typing import Any

WRITTEN_OUT = 1e6  # numbers below it have no power of ten


def number_text(value: float, unit: str = "", digits: int = 6) -> str:
    """A number with its unit, and with a power of ten from `WRITTEN_OUT` on; empty if there is none."""
    if math.isnan(value):
        return ""
    text = f"{value:.{digits}g}"
    if "e+" in text and abs(value) < WRITTEN_OUT:
        text = f"{float(text):.0f}"
    return f"{text} {unit}".strip()


def modes_text(frequencies: Sequence[float]) -> str:
    """The number of the modes of a disc, and the range of their frequencies, given in rad/s, in Hz."""
    ends = {f"{omega / math.tau:.4g}": None for omega in (min(frequencies), max(frequencies))}
    return f"{counted(len(frequencies), 'mode')} of {' to '.join(ends)} Hz"


def counted(number: int, noun: str) -> str:
    """A number with its noun in the singular or the plural."""
    return f"{number} {noun}{'s' * (number != 1)}"


def brought(module: str, extra: str) -> Any:
    """A module of an optional package, which an extra of the installation brings."""
    try:
        return import_module(module)
    except ModuleNotFoundError:
        remedy = f"pip install 'disc_model[{extra}]'"
        raise ModuleNotFoundError(f"there is no module {module}: {remedy}") from None


def drawings() -> ModuleType:
    """Return `disc_model.figures.results`, the pictures of results, imported when something is drawn;
    raises `ModuleNotFoundError`, with the command to install it, without matplotlib."""
    brought("matplotlib", "plot")
    from disc_model.figures import results

    return results


def progress_bar(shown: bool) -> Any:
    """A display of progress on standard error, one of rich; it does nothing unless it is shown."""
    from rich.console import Console
    from rich.progress import MofNCompleteColumn, Progress, TimeElapsedColumn

    columns = [*Progress.get_default_columns(), MofNCompleteColumn(), TimeElapsedColumn()]
    return Progress(*columns, console=Console(stderr=True), disable=not shown)
