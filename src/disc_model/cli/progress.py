"""What is shown while one waits: kernels that are compiled, and how far a simulation has come."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from disc_model.parameters import Parameters

LOOK = 0.2
"""s between two looks into the folder of kernels."""


@contextmanager
def simulating(t_end: float) -> Iterator[Callable[[float], None] | None]:
    """A progress bar on a terminal, nothing where stderr is a file."""
    if not sys.stderr.isatty():
        yield None
        return
    columns = (TextColumn("simulating"), BarColumn(), TextColumn("{task.completed:.2f} of {task.total:g} s"))
    with Progress(*columns, TimeRemainingColumn(), console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("simulating", total=t_end)
        yield lambda time: bar.update(task, completed=min(float(time), t_end))


@contextmanager
def compiling() -> Iterator[None]:
    """Says that kernels are being compiled as soon as the first one is, and how many there are so far.

    On a terminal as it goes on; elsewhere a line on stderr when it begins and one when it has ended.
    """
    from disc_model.engine import machine

    stats = getattr(machine.run, "stats", None)
    if stats is None:  # where compilation is switched off
        yield
        return
    folder = Path(stats.cache_path)
    before, ended = _kernels(folder), threading.Event()
    watch = threading.Thread(target=_watch, args=(folder, before, ended), daemon=True)
    watch.start()
    try:
        yield
    finally:
        ended.set()
        watch.join()


def _kernels(folder: Path) -> int:
    return sum(1 for _ in folder.glob("*.kernel"))


def _watch(folder: Path, before: int, ended: threading.Event) -> None:
    while not ended.wait(LOOK):
        if _kernels(folder) > before or not before:
            break
    else:
        return
    began = time.perf_counter()
    if not sys.stderr.isatty():
        typer.echo("compiling kernels, once: a minute or two", err=True)
        ended.wait()
        typer.echo(f"{_kernels(folder) - before} kernels compiled in {time.perf_counter() - began:.0f} s", err=True)
        return
    columns = (SpinnerColumn(), TextColumn("compiling kernels, once: {task.completed:.0f} done"), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("compiling", total=None)
        while not ended.wait(LOOK):
            bar.update(task, completed=_kernels(folder) - before)


def prepare(p: Parameters) -> None:
    """Have the kernels that a simulation of a case needs; says so if they must be compiled."""
    with compiling():
        from disc_model.simulation.api import simulate

        simulate(p, 1e-9, max_steps=1)
