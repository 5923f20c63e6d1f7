"""Progress displays for the compilation of kernels and for simulations.

A terminal shows a bar, a notebook a line that changes, and other outputs a line before and one after, all on stderr.
"""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from typing import Any

from numba.core import event

Progress = Callable[[float], object] | bool | None
"""Argument `progress` of callers: a function that receives the time reached, or False for silence."""
PATIENCE = 2.0
"""s, after which the progress of a simulation is shown."""
UNNOTICED = 1.0
"""s of compilation that are not reported: loading kernels from the cache takes some time as well."""
WIDTH = 30
"""Width of a bar in a notebook, in characters."""
COMPILING = "compiling kernels, once: 10 to 20 s for each kind"


@contextmanager
def simulating(progress: Progress, t_end: float) -> Iterator[Callable[[float], object]]:
    """Yield a function that receives the time reached (s) and by default displays the progress of a long run."""
    if callable(progress) or progress is False:
        yield progress or (lambda _: None)
        return
    began, reached, line = time.perf_counter(), 0.0, _Line(f"simulating {t_end:g} s", t_end)

    def tell(now: float) -> None:
        nonlocal reached
        reached = min(float(now), t_end)
        if time.perf_counter() - began > PATIENCE:
            line.show(f"simulating: {reached:.2f} of {t_end:g} s", reached)

    try:
        yield tell
    finally:
        line.stop(f"simulated {reached:g} s in {time.perf_counter() - began:.0f} s")
        line.close()


_watched = False


@contextmanager
def compiling(report: bool = True) -> Iterator[None]:
    """Report the compilation of kernels in the block if it takes long; also usable as a decorator.

    A nested use has no effect of its own.
    """
    global _watched
    if _watched:
        yield
        return
    _watched, kernels = True, _Kernels()
    try:
        with event.install_listener("numba:compile", kernels) if report else nullcontext():
            yield
    finally:
        _watched = False
        kernels.line.close()


class _Kernels(event.Listener):
    """Counts the compiled parts of kernels, which are nested, and measures the time."""

    def __init__(self) -> None:
        self.line = _Line(COMPILING)
        self.depth, self.count, self.seconds, self.began = 0, 0, 0.0, 0.0

    def on_start(self, found: Any) -> None:
        self.depth += 1
        if self.depth == 1:
            self.began = time.perf_counter()
        self._show()

    def on_end(self, found: Any) -> None:
        self.depth -= 1
        self.count += 1
        self._show()
        if self.depth == 0:
            self.seconds += time.perf_counter() - self.began
            self.line.stop(f"kernels compiled in {self.seconds:.0f} s")

    def _show(self) -> None:
        if self.seconds + time.perf_counter() - self.began > UNNOTICED:
            self.line.show(f"{COMPILING}, {self.count} parts done", self.count)


class _Line:
    """Progress in one line, by `show` and `stop`, which may repeat, and finally `close`; empty before the first `show`.

    Parameters
    ----------
    text : initial text
    total : final count of `show`, if it is known
    """

    def __init__(self, text: str, total: float | None = None) -> None:
        self.text, self.total, self.end = text, total, ""
        self.shown = False
        self.bar: Any = None
        self.handle: Any = None

    def _open(self) -> None:
        from rich.console import Console

        console = Console(stderr=True)
        if console.is_jupyter:  # here rich's own bars would need ipywidgets
            from IPython.display import display

            self.handle = display({"text/plain": self.text}, raw=True, display_id=True)
        elif sys.stderr.isatty():
            from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

            left = [TextColumn("left:"), TimeRemainingColumn()] if self.total else []
            columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn(), *left)
            self.bar = Progress(*columns, console=console, transient=True)
            self.task = self.bar.add_task(self.text, total=self.total)
        else:
            print(self.text, file=sys.stderr, flush=True)

    def show(self, text: str, count: float) -> None:
        """Start or continue the display, with this text and count."""
        if not self.shown:
            self._open()
            self.shown = True
        if self.bar is not None:
            self.bar.start()
            self.bar.update(self.task, description=text, completed=count)
        elif self.handle is not None:
            if self.total:
                filled = round(WIDTH * count / self.total)
                text = "█" * filled + "░" * (WIDTH - filled) + " " + text
            self.handle.update({"text/plain": text}, raw=True)

    def stop(self, text: str) -> None:
        """Pause or end the display, and show the result in `text`."""
        self.end = text
        if self.bar is not None:
            self.bar.stop()
        elif self.handle is not None:
            self.handle.update({"text/plain": text}, raw=True)

    def close(self) -> None:
        if self.shown and self.bar is None and self.handle is None:
            print(self.end, file=sys.stderr, flush=True)
