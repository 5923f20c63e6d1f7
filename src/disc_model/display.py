"""What a session shows: tables of objects in notebooks, their pictures, and the progress of long simulations."""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from html import escape
from importlib import import_module
from typing import Any


def html_table(head: Iterable[object], rows: Iterable[Iterable[object]]) -> str:
    """A table for notebooks."""
    lines = [("th", head), *(("td", row) for row in rows)]
    cells = ("".join(f"<{tag}>{escape(str(cell))}</{tag}>" for cell in row) for tag, row in lines)
    return f"<table>{''.join(f'<tr>{row}</tr>' for row in cells)}</table>"


class Summarised:
    """An object that has a summary, which a notebook and the command line show."""

    def _summary(self) -> Iterable[tuple[str, object]]:
        raise NotImplementedError

    def summary(self) -> list[tuple[str, str]]:
        """Names and values in words; those without a value are left out."""
        return [(name, str(value)) for name, value in self._summary() if value not in ("", None)]

    def _repr_html_(self) -> str:
        return html_table((type(self).__name__, ""), self.summary())


def number_text(value: float, unit: str = "", digits: int = 6) -> str:
    """A number with its unit; empty if there is none."""
    return "" if math.isnan(value) else f"{value:.{digits}g} {unit}".strip()


def draw(picture: str, *inputs: Any, **options: Any) -> Any:
    """Draw by a function of `disc_model.figures.results`, which is above all that it draws.

    It is imported by its name, so that no result depends on how it is drawn.  Raises ModuleNotFoundError without
    matplotlib; the message names the extra that brings it.
    """
    try:
        return getattr(import_module("disc_model.figures.results"), picture)(*inputs, **options)
    except ModuleNotFoundError as error:
        if str(error.name).startswith("disc_model"):
            raise
        text = f"pictures need {error.name}: pip install 'disc_model[plot]' brings it"
        raise ModuleNotFoundError(text, name=error.name) from None


# ----------------------------------------------------------------------------------------------------
# Progress on stderr: a bar, or a line where there is no terminal

Progress = Callable[[float], object] | bool | None
"""Argument `progress` of callers: a function that receives the time reached, or False for silence."""
PATIENCE = 2.0
"""s, after which the progress of a simulation is shown."""

_shown = False
"""Whether a bar is shown: what it stands for may simulate as well, also in other threads."""


@contextmanager
def simulating(progress: Progress, t_end: float, text: str = "") -> Iterator[Callable[[float], object]]:
    """Yield a function that receives the time reached (s) and by default displays the progress of a long run."""
    global _shown
    if callable(progress) or progress is False:
        yield progress or (lambda _: None)
        return
    began, bar = time.perf_counter(), None

    def tell(now: float) -> None:
        nonlocal bar
        global _shown
        if bar is None and not _shown and time.perf_counter() - began > PATIENCE:
            bar, _shown = _open_bar(text or f"simulating {t_end:g} s", t_end), True
        if bar is not None:
            bar.update(bar.task_ids[0], completed=min(now, t_end))

    try:
        yield tell
    finally:
        if bar is not None:
            bar.stop()
            _shown = False


@contextmanager
def counting(total: int) -> Iterator[Callable[[Any], Any]]:
    """Yield a function that returns what it receives, the results of so many calls, and displays their progress."""
    done = 0
    with simulating(None, total, f"computing {total} points") as tell:

        def counted(result: Any) -> Any:
            nonlocal done
            done += 1
            tell(done)
            return result

        yield counted


def _open_bar(text: str, total: float) -> Any:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    terminal = sys.stderr.isatty()
    if not terminal:  # a notebook, where rich's bars need further packages, or a file
        print(text, file=sys.stderr, flush=True)
    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn(), TextColumn("left:"))
    console = Console(stderr=True)
    bar = Progress(*columns, TimeRemainingColumn(), console=console, transient=True, disable=not terminal)
    bar.add_task(text, total=total)
    bar.start()
    return bar
