"""What each answer costs, from methods, from the cycle itself, and with other modes.

Of a method the tolerance or step varies. The line ``cycle`` finds onset and growth rate without a
simulation. In the lines ``rigid`` and ``residual`` the number of nodal diameters varies, and errors
are distances from the answers of `own_answers.RICHEST`.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import pandas as pd
import xarray as xr

from benchmarks import own_answers, replies, study
from benchmarks.methods import METHODS
from benchmarks.questions import FLAGS, QUESTIONS, AnswerStatus, Replies, reference, verdict
from benchmarks.study import CONTACTS, TABLES, Row
from disc_model.data.dataset import json_attribute
from disc_model.data.variables import flag_names

CYCLE_SETTINGS = (1e-6, 1e-8, 1e-10, 1e-12)
"""Tolerances of the search for a cycle."""
LINES: Mapping[str, tuple[str, str]] = TABLES["lines"]


def answers(
    part: str,
    settings: Sequence[float] | None = None,
    *,
    asked: Sequence[str] = tuple(replies.ASKED),
    models: Sequence[int] = (0, 1, 2, 3, 4, 6, 8),
) -> xr.Dataset:
    """Measure what answers cost, a row for each reply.

    Parameters
    ----------
    part : name of a method, ``cycle`` or ``models``
    settings : of a method, from coarse to fine; those of the scene ``stick_slip`` if None
    asked : questions to a method
    models : numbers of nodal diameters
    """
    points: list[Row] = []
    if part == "cycle":
        points = [{"line": part, "setting": tol} for tol in CYCLE_SETTINGS]
    elif part == "models":
        for line in CONTACTS:
            points += [{"line": line, "setting": count} for count in models]
    else:
        for value in settings or METHODS[part].settings["stick_slip"]:
            points += [{"line": part, "setting": value, "question": name} for name in asked]
    described = {}
    for name, question in QUESTIONS.items():
        right = reference(name)
        described[name] = {**question, "error": f"{right.error:.2g}, {right.by}"}
    return study.run(
        "answers",
        points,
        _Questioning().measure,
        flags=FLAGS,
        title="What each answer costs",
        questions=json_attribute(described),
    )


class _Questioning:
    """Asks lines at settings, and judges their replies.

    Attributes
    ----------
    hopeless : questions for which a method is too slow, which are skipped at finer settings
    """

    def __init__(self) -> None:
        self.hopeless: set[str] = set()

    def measure(self, line: str, setting: Any, question: str = "") -> Iterator[Row]:
        """Yield a row for each reply.

        Parameters
        ----------
        line : name of a method, ``cycle``, or a contact whose number of modes varies
        setting : of the line
        question : to a method
        """
        if question in self.hopeless:
            return
        found, right = self._ask(line, setting, question)
        label, varies = _words(line)
        for answer, reply in found.items():
            yield {
                "answer": answer,
                "label": label,
                "varies": varies,
                "right": right[answer],
                "found": reply.value,
                "error": abs(reply.value - right[answer]),
                "verdict": verdict(answer, reply, right[answer]),
                **reply._asdict(),
            }

    def _ask(self, line: str, setting: Any, question: str) -> tuple[Replies, Mapping[str, float]]:
        """Return the replies of a line, and the right answers."""
        if line == "cycle":
            right = {"onset": "fold", "growth_rate": "growth_rate"}
            return own_answers.ask_cycle({}, setting), {
                answer: reference(name).value for answer, name in right.items()
            }
        if line in CONTACTS:
            found = own_answers.ask_model({"n_diameters": setting, **CONTACTS[line]})
            return found, {answer: reply.value for answer, reply in own_answers.richest().items()}
        function, budget = replies.ASKED[question]
        found = function(replies.setting_of(METHODS[line], setting), budget)
        if any(reply.status is AnswerStatus.TOO_SLOW for reply in found.values()):
            self.hopeless.add(question)
        return found, {answer: reference(answer).value for answer in found}


def _words(line: str) -> tuple[str, str]:
    """Return a line in words, and what its setting is."""
    if line in LINES:
        label, varies = LINES[line]
        return label, varies
    return METHODS[line].label, METHODS[line].setting


def in_words(dataset: xr.Dataset) -> pd.DataFrame:
    """Return all rows, in the order in which they were measured.

    Status, verdict and setting (``at``) are in words.
    """
    frame = dataset.to_dataframe()
    settings = []
    for varies, setting in zip(frame["varies"], frame["setting"], strict=True):
        if varies == "diameters":
            settings.append(f"{setting:.0f} diameters")
        else:
            settings.append(f"{varies}={setting:g}")
    return frame.assign(
        at=settings, status=flag_names(dataset["status"]), verdict=flag_names(dataset["verdict"])
    )
