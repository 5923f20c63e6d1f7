"""What is shown to a reader: summaries of objects, their pictures, and the progress of what takes
long."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from importlib import import_module
from types import ModuleType
from typing import Any

WRITTEN_OUT = 1e6  # numbers below it have no power of ten


class Summarised:
    """An object that has a summary, which the command line shows."""

    def _summary(self) -> Iterable[tuple[str, object]]:
        raise NotImplementedError

    def summary(self) -> list[tuple[str, str]]:
        """Names and values in words; those without a value are left out."""
        return [(name, str(value)) for name, value in self._summary() if value not in ("", None)]


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


# ---- Progress


class Bar:
    """A bar that counts what is done; one of rich, if it is shown."""

    def __init__(self, shown: Any = None) -> None:
        self._shown = shown

    def advance(self) -> None:
        """Count one more that is done."""
        self._update(advance=1)

    def describe(self, text: str) -> None:
        """Say beside the bar what is done now."""
        self._update(description=text)

    def _update(self, **changes: Any) -> None:
        if self._shown is not None:
            self._shown.update(0, **changes)


@contextmanager
def progress_bar(title: str, total: int | None, shown: bool) -> Iterator[Bar]:
    """A bar on standard error while it is needed, of a `total` if that is known; nothing unless it is
    shown."""
    if not shown:
        yield Bar()
        return
    from rich.console import Console
    from rich.progress import MofNCompleteColumn, Progress, TimeElapsedColumn

    columns = [*Progress.get_default_columns(), MofNCompleteColumn(), TimeElapsedColumn()]
    with Progress(*columns, console=Console(stderr=True)) as progress:
        progress.add_task(title, total=total)
        yield Bar(progress)
