"""What is shown to a reader: numbers in words, pictures, and the progress of what takes long."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
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


@contextmanager
def progress_bar(title: str, total: int | None, shown: bool) -> Iterator[Callable[[str], None]]:
    """A bar on standard error, of a `total` if that is known, while it is needed; nothing unless it is
    shown. Yields what counts one more that is done, with a text that says what."""
    if not shown:
        yield lambda _: None
        return
    from rich.console import Console
    from rich.progress import MofNCompleteColumn, Progress, TimeElapsedColumn

    with Progress(
        *Progress.get_default_columns(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        console=Console(stderr=True),
    ) as progress:
        task = progress.add_task(title, total=total)
        yield lambda text: progress.update(task, advance=1, description=text)
