"""What a session shows: tables of objects in notebooks, their pictures, and the progress of simulations and studies."""

from __future__ import annotations

import logging
import math
import re
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from html import escape
from importlib import import_module
from itertools import chain
from pathlib import Path
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


def counted(number: int, noun: str) -> str:
    """A number with its noun in the singular or the plural."""
    return f"{number} {noun}{'' if number == 1 else 's'}"


def draw(picture: str, *inputs: Any, **options: Any) -> Any:
    """Draw by a function of `disc_model.figures.results`, imported by its name, so that no result depends on it."""
    try:
        return getattr(import_module("disc_model.figures.results"), picture)(*inputs, **options)
    except ModuleNotFoundError as error:
        if str(error.name).startswith("disc_model"):
            raise
        error.msg = f"pictures need {error.name}: pip install 'disc_model[plot]' brings it"
        raise


class Drawn:
    """A result with a picture, which a function of `disc_model.figures.results` draws."""

    _picture: str

    def plot(self, *, ax: Any = None) -> Any:
        """Draw the picture that the class describes, on axes of matplotlib or in a new figure; returns the axes.

        Raises `ParameterError` if `ax` is no axes, or there is nothing to draw, and `CycleError` without a cycle.

        Examples
        --------
        >>> import disc_model as dm
        >>> dm.floquet(dm.Parameters(N=385, Omega=15)).plot().get_xlabel()
        'Re κ'
        """
        return draw(self._picture, self, ax=ax)


# ---- Progress on stderr: a bar, or a line where there is no terminal

Progress = Callable[[float], object] | bool | None
"""Argument `progress` of callers: a function that receives the time reached, or False for silence."""
PATIENCE = 2.0  # s, after which the progress of a simulation is shown

_SHOWN = threading.Lock()  # of a bar: what it stands for may simulate as well, also in other threads


@contextmanager
def simulating(progress: Progress, t_end: float, text: str = "") -> Iterator[Callable[[float], object]]:
    """Yield a function that receives the time reached (s) and by default displays the progress of a long run."""
    if callable(progress) or progress is False:
        yield progress or (lambda _: None)
        return
    began, bar = time.perf_counter(), None

    def tell(now: float) -> None:
        nonlocal bar
        if bar is None and time.perf_counter() - began > PATIENCE and _SHOWN.acquire(blocking=False):
            bar = _open_bar(text or f"simulating {t_end:g} s", t_end)
        if bar is not None:
            bar.update(bar.task_ids[0], completed=min(now, t_end))

    try:
        yield tell
    finally:
        if bar is not None:
            bar.stop()
            _SHOWN.release()


def computed(function: Callable[[Any], Any], values: Sequence[Any], what: str) -> list[Any]:
    """The results of a function for each of some values, one by one; the progress of long work is shown."""
    results: list[Any] = []
    with simulating(None, len(values), f"computing {len(values)} {what}") as tell:
        for value in values:
            tell(len(results))
            results.append(function(value))
    return results


def _open_bar(text: str, total: float, estimate: bool = True) -> Any:
    """A bar with the time that has passed and, by rich's estimate, what is left."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, ProgressColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    terminal = sys.stderr.isatty()
    if not terminal:  # a notebook, where rich's bars need further packages, or a file
        print(text, file=sys.stderr, flush=True)
    columns: list[ProgressColumn] = [TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn()]
    columns += [TextColumn("left:"), TimeRemainingColumn()] if estimate else []
    bar = Progress(*columns, console=Console(stderr=True), transient=True, disable=not terminal)
    bar.add_task(text, total=total)
    bar.start()
    return bar


# ---- What Snakemake shows of a study

# Snakemake's events that concern single jobs, or what it is about to do
_OF_JOBS = re.compile("job_.*|group_info|progress|run_info|resources_info|shellcmd|workflow_started")
_CHATTER = re.compile(
    "Assuming unrestricted|Building DAG|Using shell|Conda environments:|Select jobs|Execute [0-9]+ job"
    "|Exiting because a job|RuleException:\nCalledProcessError|Job [0-9]+ has been submitted"
)
_TRUST = 60.0  # s of work: expected durations count as much as the pace at which so much was done
_LAST = 10  # lines at the end of a log that are shown


class StudyProgress(logging.Handler):
    """Stands in for Snakemake's handler of the terminal: shows how much of a study is done and how long the rest takes,
    and at the end which jobs failed, by reason; what concerns no job is passed on. `durations` returns the expected
    durations (s) of the jobs that are to run, by number, and how many run at a time."""

    def __init__(self, own: Any, durations: Callable[[], tuple[Mapping[int, float], int]]) -> None:
        super().__init__()
        self.own, self.stream, self.durations, self.cores = own, own.stream, durations, 1
        self.expected: Mapping[int, float] = {}
        self.failed: dict[int, Any] = {}
        self.done = self.told_done = 0.0  # s of expected work
        self.began = self.told = time.monotonic()
        self.bar: Any = None

    def emit(self, record: Any) -> None:
        """Take in a message of Snakemake."""
        event, text = str(getattr(record, "event", "")), str(record.msg)
        if event == "run_info":
            (self.expected, self.cores), self.began = self.durations(), time.monotonic()
            self._write(f"{len(self.expected)} jobs, {self.left}")
        elif event == "job_finished":
            self.done += self.expected.get(record.job_id, 0.0)
            self.failed.pop(record.job_id, None)  # it was tried once more
        elif event == "job_error":
            self.failed[record.jobid] = record
        elif event == "progress":
            self._show(record.done, record.total)
        elif text.startswith("Exiting because a job"):
            self._write(self.failures)
        if not (_OF_JOBS.fullmatch(event) or _CHATTER.match(text)):
            self.own.handle(record)

    @property
    def left(self) -> str:
        """Time that the rest takes, by the expected durations and the pace of what is done."""
        pace = (time.monotonic() - self.began + _TRUST / self.cores) / (self.done + _TRUST)
        seconds = (sum(self.expected.values()) - self.done) * pace
        return f"about {seconds / 60:.0f} min left" if seconds > 90 else f"about {math.ceil(seconds / 5) * 5} s left"

    @property
    def failures(self) -> str:
        """The failed jobs by reason, the last line of a log but for its numbers, with what their logs end with."""
        reasons: dict[str, tuple[list[str], dict[str, None]]] = {}
        for record in self.failed.values():
            logs = [Path(log) for log in record.log if Path(log).is_file()]
            text = "\n".join([*(log.read_text(errors="replace") for log in logs), record.rule_msg or ""])
            ends = [f"    {line}" for line in text.splitlines() if line.strip()][-_LAST:]
            jobs, lines = reasons.setdefault(re.sub(r"\d[\d.e+-]*", "", "".join(ends[-1:])), ([], {}))
            jobs.append(f"{record.rule_name}: {', '.join(map(str, logs or record.output))}")
            lines.update(dict.fromkeys(ends))
        parts = [[*jobs, *[*lines][-3 * _LAST :]] for jobs, lines in reasons.values()]
        return "\n".join([f"failed jobs: {len(self.failed)}", *chain.from_iterable(parts)])

    def _show(self, done: int, total: int) -> None:
        """Move the bar; where there is no terminal, write a line after each tenth of the work or each minute."""
        failed = f", {len(self.failed)} failed" if self.failed else ""
        text, whole = f"{done} of {total} jobs done{failed}", sum(self.expected.values())
        if done == total:
            self._write(text)
        elif self.stream.isatty():
            if self.bar is None:
                self.bar = _open_bar("", whole, estimate=False)
                self.own.stream = sys.stderr  # rich's, which writes above the bar
            self.bar.update(self.bar.task_ids[0], completed=self.done, description=f"{text}, {self.left}")
        elif self.done - self.told_done > whole / 10 or time.monotonic() - self.told > 60.0:
            self._write(f"{text}, {self.left}")
            self.told_done, self.told = self.done, time.monotonic()

    def _write(self, text: str) -> None:
        self.close()
        print(text, file=self.stream, flush=True)

    def close(self) -> None:
        """Remove the bar, however the run ended."""
        if self.bar is not None:
            self.bar.stop()
            self.bar, self.own.stream = None, self.stream
