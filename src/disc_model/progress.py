"""Progress on stderr: for long simulations a bar, or a line where there is no terminal."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

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
