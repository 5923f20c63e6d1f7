"""What is shown to a reader: summaries of objects, their pictures, and the progress of what takes
long."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from importlib import import_module
from importlib.util import find_spec
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
    """A number with its unit; empty if there is none."""
    if math.isnan(value):
        return ""
    return f"{rounded_text(value, digits)} {unit}".strip()


def rounded_text(value: float, digits: int) -> str:
    """A number rounded to significant digits, with a power of ten from `WRITTEN_OUT` on."""
    text = f"{value:.{digits}g}"
    if "e+" in text and abs(value) < WRITTEN_OUT:
        return f"{float(text):.0f}"
    return text


def aligned(rows: Sequence[Sequence[str]]) -> list[str]:
    """Rows of texts as lines with columns, two blanks apart."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = []
    for row in rows:
        cells = [text.ljust(width) for text, width in zip(row, widths, strict=True)]
        lines.append("  ".join(cells).rstrip())
    return lines


def counted(number: int, noun: str) -> str:
    """A number with its noun in the singular or the plural."""
    if number == 1:
        return f"{number} {noun}"
    return f"{number} {noun}s"


def brought(module: str, extra: str) -> Any:
    """A module of an optional package, which an extra of the installation brings."""
    try:
        return import_module(module)
    except ModuleNotFoundError:
        raise ModuleNotFoundError(
            f"there is no module {module}: pip install 'disc_model[{extra}]'"
        ) from None


def drawings() -> ModuleType:
    """Return `disc_model.figures.results`, the pictures of results, imported when something is drawn;
    raises `ModuleNotFoundError`, with the command to install it, without matplotlib."""
    brought("matplotlib", "plot")
    from disc_model.figures import results

    return results


# ---- Progress

NOTEBOOK = 90  # characters of a line in a notebook


class Bar:
    """A bar that counts what is done, of a `total` if that is known; without one of rich it is not
    shown."""

    def __init__(self, total: int | None, bar: Any = None, task: Any = None) -> None:
        self.total = total
        self.bar = bar
        self.task = task

    def advance(self) -> None:
        """Count one more that is done."""
        if self.bar is not None:
            self.bar.advance(self.task)

    def expect(self, more: int) -> None:
        """Count more that are to be done."""
        if self.total is not None:
            self.total += more
        if self.bar is not None:
            self.bar.update(self.task, total=self.total)

    def describe(self, text: str) -> None:
        """Say beside the bar what is done now."""
        if self.bar is not None:
            self.bar.update(self.task, description=text)


@contextmanager
def progress_bar(title: str, total: int | None, shown: bool) -> Iterator[Bar]:
    """A bar on standard error, while it is needed; it only counts if the total is not known, and if it
    is not shown."""
    if not shown:
        yield Bar(total)
        return
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    if total is None:
        counts = [TextColumn("{task.completed}"), TimeElapsedColumn()]
    else:
        left = [TextColumn("left"), TimeRemainingColumn()]
        counts = [BarColumn(), MofNCompleteColumn(), TimeElapsedColumn(), *left]
    with Progress(TextColumn("{task.description}"), *counts, console=_console()) as bar:
        yield Bar(total, bar, bar.add_task(title, total=total))


def _console() -> Any:
    """Standard error for a bar: as text in a notebook without ipywidgets, where rich would draw
    nothing."""
    from rich.console import Console

    console = Console(stderr=True)
    if console.is_jupyter and find_spec("ipywidgets") is None:
        return Console(stderr=True, force_jupyter=False, force_terminal=True, width=NOTEBOOK)
    return console


def frequencies_text(frequencies: Sequence[float]) -> str:
    """The range of the frequencies of a disc, given in rad/s, in Hz."""
    low, high = (f"{omega / math.tau:.4g}" for omega in (min(frequencies), max(frequencies)))
    extent = low if low == high else f"{low} to {high}"
    return f"{extent} Hz"
