"""A bar on standard error that shows how much of a long computation is done."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from typing import Any

NOTEBOOK = 90  # characters of a line in a notebook


class Bar:
    """A bar that counts what is done; without one of rich it is not shown."""

    def __init__(self, total: int, bar: Any = None, task: Any = None) -> None:
        self.total = total
        self.bar = bar
        self.task = task

    def advance(self) -> None:
        """Count one more that is done."""
        if self.bar is not None:
            self.bar.advance(self.task)

    def expect(self, more: int) -> None:
        """Count more that are to be done."""
        self.total += more
        if self.bar is not None:
            self.bar.update(self.task, total=self.total)


@contextmanager
def progress_bar(title: str, total: int, shown: bool) -> Iterator[Bar]:
    """A bar on standard error, while it is needed."""
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

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=_console()) as bar:
        yield Bar(total, bar, bar.add_task(title, total=total))


def _console() -> Any:
    """Standard error for a bar: as text in a notebook without ipywidgets, where rich would draw
    nothing."""
    from rich.console import Console

    console = Console(stderr=True)
    if console.is_jupyter and find_spec("ipywidgets") is None:
        return Console(stderr=True, force_jupyter=False, force_terminal=True, width=NOTEBOOK)
    return console
