"""What each answer costs: error against wall time of numbers that a study asks for.

``first_separation``
    N = 385 N, Omega = 15.1 rad/s, from the published start, s: every method, simulating `HORIZON` s
``onset``
    N = 385 N: the speed at which the quiet cycle ends in a fold, rad/s, by continuation of the cycle
``growth_rate``
    N = 200 N, Omega = 20 rad/s: of the stick-slip cycle, 1/s, from its Floquet multipliers

The last two are found without a simulation, by this package alone: rivals that integrate have no line there.

There are two kinds of lines, with errors of two kinds.  Lines of a method vary its tolerance or step, with the nine
modes of the published model; their error is that of the numbers, against `exact`.  The line ``modes`` varies the number
of nodal diameters, the engine at its default tolerance; its error is that of the model, against the disc with
`RICHEST` diameters: no tolerance makes up for it.
"""

from __future__ import annotations

import math
import time as clock
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
import xarray as xr

from disc_model.benchmarks.machine import machine, one_core
from disc_model.benchmarks.methods import METHODS, Outcome, Problem
from disc_model.benchmarks.scenes import static_start
from disc_model.benchmarks.work_precision import LOOK
from disc_model.data.dataset import json_attribute, markdown_table
from disc_model.data.provenance import versions
from disc_model.errors import ParameterError
from disc_model.figures.parts import BLACK
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.stability.continuation import continue_cycle
from disc_model.stability.cycle import floquet

HORIZON = 55.0
"""s that are simulated for the first separation."""
BUDGET = 120.0
"""s that a method may take for a point; it is not tried at finer settings then."""
REPEATS = 3
"""Runs of a point; the fastest counts, since disturbances only add."""
DEFAULT, TIGHTEST = 1e-10, 1e-14
TOLERANCES = (1e-6, 1e-8, 1e-10, 1e-12)
"""Of the answers that no method simulates; those that the search for a cycle takes."""
DIAMETERS = (0, 1, 2, 3, 4, 6, 8)
RICHEST = 12
LOAD, SPEED = Parameters(N=385.0, Omega=15.1), Parameters(N=200.0, Omega=20.0)
UNITS = {"first_separation": "s", "onset": "rad s-1", "growth_rate": "s-1"}


def first_separation(p: Parameters, tol: float) -> float:
    """Time of the first separation (s), nan if there is none within `HORIZON`."""
    return simulate(p, HORIZON, tol=tol, stop_at="first_separation").first_separation


def onset(p: Parameters, tol: float) -> float:
    """Speed (rad/s) of the first fold of the cycle above 14.5 rad/s, nan if there is none up to 16."""
    try:
        folds = continue_cycle(p.replace(Omega=14.8), "Omega", (14.5, 16.0), tol=tol).folds
    except ParameterError:  # no cycle to follow
        return math.nan
    return float(folds[0, 0]) if len(folds) else math.nan


def growth_rate(p: Parameters, tol: float) -> float:
    """Growth rate of the stick-slip cycle, 1/s, nan if there is no cycle."""
    return float(floquet(p, tol=tol).growth_rate)


ANSWERS: Mapping[str, tuple[Callable[[Parameters, float], float], Parameters, Sequence[float]]] = {
    "first_separation": (first_separation, LOAD, ()),
    "onset": (onset, LOAD, TOLERANCES),
    "growth_rate": (growth_rate, SPEED, TOLERANCES),
}
"""By answer: the function, its case, the tolerances at which it is asked where no method is measured."""


class Row(NamedTuple):
    """One measured point; ``found`` and ``error`` are nan where there was no answer."""

    answer: str
    line: str
    setting: float
    found: float
    error: float
    seconds: float


def exact(answer: str, diameters: int | None = None) -> float:
    """The answer at the tightest tolerance, with the nine modes of the published model or with so many diameters."""
    ask, p, _ = ANSWERS[answer]
    return ask(p if diameters is None else p.replace(n_diameters=diameters), TIGHTEST)


@one_core()
def measure(
    settings: Mapping[str, Sequence[float]] | None = None,
    *,
    answers: Sequence[str] = tuple(ANSWERS),
    diameters: Sequence[int] = DIAMETERS,
    richest: int = RICHEST,
    progress: Callable[[Row], object] | None = None,
) -> xr.Dataset:
    """Measure all points.

    Parameters
    ----------
    settings : by method, from coarse to fine; those of the scene ``stick_slip`` if not given
    answers, diameters, richest : what is asked, with which numbers of nodal diameters, and which one is the reference
    progress : called with each row

    Returns
    -------
    Dataset along ``row``: `answer`, `line`, `setting` (as the method's; number of diameters on the line ``modes``),
    ``found``, ``error``, ``seconds``, and how the line is called and drawn.
    """
    if settings is None:
        settings = {name: method.settings.get("stick_slip", ()) for name, method in METHODS.items()}
    rows = []
    for answer in answers:
        lines = [_of_modes(answer, diameters, richest)]
        lines += [_of_methods(settings)] if answer == "first_separation" else [_of_tolerances(answer)]
        for line in lines:
            for row in line:
                rows.append(row)
                if progress is not None:
                    progress(row)
    return _dataset(rows)


def _timed(ask: Callable[[], float]) -> tuple[float, float]:
    ask()  # compiles, and warms caches
    seconds, found = math.inf, math.nan
    for _ in range(REPEATS):
        began = clock.perf_counter()
        found = ask()
        seconds = min(seconds, clock.perf_counter() - began)
    return found, seconds


def _of_modes(answer: str, diameters: Sequence[int], richest: int) -> Iterator[Row]:
    ask, p, _ = ANSWERS[answer]
    right = exact(answer, richest)
    for count in diameters:
        found, seconds = _timed(partial(ask, p.replace(n_diameters=count), DEFAULT))
        yield Row(answer, "modes", count, found, abs(found - right), seconds)


def _of_tolerances(answer: str) -> Iterator[Row]:
    ask, p, tolerances = ANSWERS[answer]
    right = exact(answer)
    for tol in tolerances:
        found, seconds = _timed(partial(ask, p, tol))
        yield Row(answer, "series", tol, found, abs(found - right), seconds)


def _of_methods(settings: Mapping[str, Sequence[float]]) -> Iterator[Row]:
    """All simulate to the horizon, since none but the engine stops by itself at a separation."""
    answer, p = "first_separation", ANSWERS["first_separation"][1]
    right, problem = exact(answer), Problem(p, static_start(p), HORIZON)
    for name, values in settings.items():
        if METHODS[name].unavailable():
            continue
        for value in values:
            results = [METHODS[name].solve(problem, value, BUDGET)]
            if results[0].seconds < 1.0:
                results += [METHODS[name].solve(problem, value, BUDGET) for _ in range(REPEATS)]
            times = [t for t, kind in zip(results[0].times, results[0].kinds, strict=True) if kind == "separation"]
            found = float(times[0]) if times else math.nan
            yield Row(answer, name, value, found, abs(found - right), min(result.seconds for result in results))
            if results[0].outcome is Outcome.TOO_SLOW:
                break


def _dataset(rows: Sequence[Row]) -> xr.Dataset:
    columns = {name: np.array([getattr(row, name) for row in rows]) for name in Row._fields}
    about = {
        "answer": {"long_name": "what is asked"},
        "line": {"long_name": "method; or modes, where their number varies"},
        "setting": {"long_name": "tolerance, step (s), regularisation (rad/s); number of nodal diameters"},
        "found": {"long_name": "answer in its own unit: s, rad s-1 or s-1; nan if there was none"},
        "error": {"long_name": "distance from the right answer, in its unit"},
        "seconds": {"units": "s", "long_name": "wall time"},
    }
    dataset = xr.Dataset({name: ("row", values, about[name]) for name, values in columns.items()})
    labels = [METHODS[row.line].label if row.line in METHODS else "series, number of modes" for row in rows]
    dataset["label"] = ("row", labels, {"long_name": "line in words"})
    looks = [METHODS[row.line].look if row.line in METHODS else (BLACK, "$n$", ":") for row in rows]
    for i, (name, text) in enumerate(LOOK.items()):
        dataset[name] = ("row", [look[i] for look in looks], {"long_name": text})
    title = "What each answer costs"
    return dataset.assign_attrs(machine=machine(), title=title, versions=json_attribute(versions()))


def to_markdown(dataset: xr.Dataset) -> str:
    """One table an answer, with the machine above."""
    text = ["# What each answer costs", "", f"Machine: {dataset.attrs['machine']}, one core.", ""]
    text += [
        "The error of the line `modes` is that of the model, against the richest disc; that of the others is of the"
    ]
    text += ["numbers, with nine modes. A dash: no answer.", ""]
    for answer in dict.fromkeys(map(str, dataset["answer"].values)):
        part = dataset.isel(row=dataset["answer"].values == answer)
        names = ("label", "setting", "found", "error", "seconds")
        rows = [[_short(value) for value in row] for row in zip(*(part[name].values for name in names), strict=True)]
        head = ("line", "setting", f"found ({UNITS[answer]})", "error", "wall time (s)")
        text += [f"## {answer.replace('_', ' ')}", "", *markdown_table(head, rows), ""]
    return "\n".join(text)


def _short(value: object) -> str:
    if isinstance(value, str):
        return value
    number = float(value)  # type: ignore[arg-type]
    return f"{number:.6g}" if math.isfinite(number) else "-"
