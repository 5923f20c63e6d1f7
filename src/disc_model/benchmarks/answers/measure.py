"""Measure the cost of each answer: error against wall time, for all settings of all methods and for our models.

Kinds of lines:

- of a method: its tolerance or step varies, with the nine modes of the published model; its error is that of the
  numbers, against the stored right answer;
- ``cycle``: onset and growth rate without a simulation, from the stick-slip cycle itself, at several tolerances;
- ``rigid`` and ``residual``: the number of nodal diameters varies, the engine at its default tolerance; the error is
  that of the model, against the richest one.  No tolerance makes up for it.
"""

import logging
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from disc_model.benchmarks.answers import modelled, questions, simulated
from disc_model.benchmarks.answers.questions import AnswerStatus, AnswerVerdict, Found, verdict
from disc_model.benchmarks.grid import variables
from disc_model.benchmarks.hardware import machine, one_core
from disc_model.benchmarks.registry import METHODS
from disc_model.benchmarks.truncation import CONTACTS
from disc_model.data.dataset import json_attribute
from disc_model.data.provenance import versions
from disc_model.data.variables import flag_names

log = logging.getLogger(__name__)

TOLERANCES = (1e-6, 1e-8, 1e-10, 1e-12)
"""Tolerances of the search for a cycle."""
LINES: Mapping[str, tuple[str, str]] = {
    "cycle": ("series, from the cycle itself", "tol"),
    "rigid": ("series, modes, rigid contact", "diameters"),
    "residual": ("series, modes, residual flexibility", "diameters"),
}
"""Lines that belong to no method: name in words, and meaning of the setting."""
VARIABLES = variables("answers", status=AnswerStatus, verdict=AnswerVerdict)
Row = dict[str, Any]
"""One measured point, by the names of `VARIABLES`."""


@one_core()
def measure(
    part: str,
    settings: Sequence[float] | None = None,
    *,
    asked: Sequence[str] = tuple(simulated.ASKED),
    models: Sequence[int] = (0, 1, 2, 3, 4, 6, 8),
) -> xr.Dataset:
    """Measure the points of a method, of the cycle itself, or of models, and log each of them.

    Parameters
    ----------
    part : name of a method, ``cycle`` or ``models``
    settings : of a method, from coarse to fine; those of the scene ``stick_slip`` if not given
    asked : questions put to a method
    models : numbers of nodal diameters, for each contact

    Returns
    -------
    Dataset along ``row``, the columns of `VARIABLES`.
    """
    others = {"cycle": _of_the_cycle, "models": lambda: _of_models(models)}
    return _dataset([*(others[part]() if part in others else _of_method(part, settings, asked))])


def merged(parts: Sequence[xr.Dataset]) -> xr.Dataset:
    """All parts as one dataset, with the attributes of the first."""
    return xr.concat(parts, "row", combine_attrs="override")


def points(dataset: xr.Dataset) -> pd.DataFrame:
    """All rows, in the order in which they were measured; status, verdict and setting (``at``) in words."""
    found = dataset.to_dataframe()
    counted = found["varies"] == "diameters"
    at = [f"{x:.0f} diameters" if count else f"{kind}={x:g}"
          for count, kind, x in zip(counted, found["varies"], found["setting"], strict=True)]  # fmt: skip
    return found.assign(at=at, **{name: flag_names(dataset[name]) for name in ("status", "verdict")})


def _of_method(name: str, values: Sequence[float] | None, asked: Sequence[str]) -> Iterator[Row]:
    """Measure a method; a question for which it is too slow is skipped at finer settings."""
    own, hopeless = METHODS[name], set[str]()
    for value in values or own.settings["stick_slip"]:
        for question in asked:
            if question in hopeless:
                continue
            for answer, found in simulated.ask(simulated.by(own, value), question).items():
                yield _row(answer, name, value, questions.reference(answer).value, found)
                if found.status is AnswerStatus.TOO_SLOW:
                    hopeless.add(question)


def _of_the_cycle() -> Iterator[Row]:
    for tol in TOLERANCES:
        onset, growth = modelled.onset(questions.SEPARATING, tol), modelled.growth_rate(questions.GROWING, tol)
        yield _row("onset", "cycle", tol, questions.reference("fold").value, onset)
        yield _row("growth_rate", "cycle", tol, questions.reference("growth_rate").value, growth)


def _of_models(models: Sequence[int]) -> Iterator[Row]:
    right = {answer: found.value for answer, found in modelled.ask(modelled.RICHEST)}
    for contact, fields in CONTACTS.items():
        for count in models:
            for answer, found in modelled.ask({"n_diameters": count} | fields):
                yield _row(answer, contact, count, right[answer], found)


def _row(answer: str, line: str, setting: float, right: float, found: Found) -> Row:
    label, varies = LINES[line] if line in LINES else (METHODS[line].label, METHODS[line].setting)
    row = {"answer": answer, "line": line, "label": label, "varies": varies, "setting": setting, "right": right}
    row |= {"error": abs(found.value - right), "verdict": verdict(answer, found, right), "found": found.value}
    row |= found._asdict()
    phrase = "%(answer)s %(line)s %(setting)g: %(found).10g, error %(error).3g, %(seconds).4g s, %(status)s %(message)s"
    log.info(phrase, row | {"status": found.status.name})
    return row


def _dataset(rows: Sequence[Row]) -> xr.Dataset:
    dataset = xr.Dataset()
    for name, own in VARIABLES.items():
        values = np.array([row[name] for row in rows], np.int8 if own.flags else None)
        dataset[name] = ("row", values, own.attributes)
    about = {}
    for name, question in questions.QUESTIONS.items():
        right = questions.reference(name)
        about[name] = question._asdict() | {"error": f"{right.error:.2g}, {right.by}"}
    title = "What each answer costs"
    return dataset.assign_attrs(
        machine=machine(), title=title, questions=json_attribute(about), versions=json_attribute(versions())
    )
