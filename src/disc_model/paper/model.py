"""A row of the ledger: a quotation of the paper, and the function that judges it from cases and
grid studies."""

import json
from collections.abc import Callable, Iterable, Mapping
from functools import cache
from itertools import product
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pandas as pd
import yaml
from pydantic import BaseModel, ConfigDict, TypeAdapter

from disc_model.analysis.classify import Settled
from disc_model.data.dataset import Missing
from disc_model.data.texts import fill
from disc_model.paper.measures import Absent, CaseView, facts
from disc_model.parameters import Parameters

TRUE, PART, FALSE = "true", "true in part", "false"
AMBIGUOUS, NOT_COMPUTED = "ambiguous in the paper", "not computed"
VERDICTS = (TRUE, PART, FALSE, AMBIGUOUS, NOT_COMPUTED)


def read_texts(name: str) -> Any:
    """A file of texts, by its path from the package on."""
    return yaml.safe_load((Path(__file__).parents[1] / name).read_text(encoding="utf-8"))


@cache
def paper_cases() -> dict[str, dict[str, Any]]:
    """The named cases of the paper: the values of each, beside the study's base values."""
    return dict(read_texts("config/paper.yaml")["cases"])


class Answer:
    """Result of a check: verdict, or whether the statement is true; words; values for the words of
    the row."""

    def __init__(
        self, verdict: bool | np.bool_ | str, here: str = "", *notes: str, **values: Any
    ) -> None:
        self.verdict = verdict if isinstance(verdict, str) else TRUE if verdict else FALSE
        self.here, self.notes, self.values = here, " ".join(filter(None, notes)), values


def graded(holds: Iterable[bool | np.bool_]) -> str:
    """The verdict on a statement by what becomes of its parts."""
    each = [bool(part) for part in holds]
    return TRUE if all(each) else PART if any(each) else FALSE


class Row(BaseModel):
    """A statement of the paper, as a file has it. Its words may name values of the answer, those in
    `given`, the `place` of the first case, and what the first grid study has `stated`."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    id: str
    place: str  # in the paper
    quote: str = ""  # literally; or, of what it does not say,
    statement: str = ""  # the statement in words of ours
    check: Callable[..., Answer] | None = (
        None  # judges it; a file has its name. None for what nothing is computed for:
    )
    verdict: str = ""  # then the verdict
    here: str = (
        ""  # and what is said for it; otherwise what is said of the check's values, as in the note
    )
    matters: str = ""  # the consequence, in one sentence
    judged: str = ""  # the rule by which the check judges, with the numbers below
    note: str = ""  # what should be known in any case
    given: dict[str, bool | float | str | list[float]] = {}  # for the check and for the rule
    cases: dict[
        str, float
    ] = {}  # for the check, of config/paper.yaml: the time in s to which each must have run
    every: bool = False  # the check is given all cases instead, whatever their names
    separates: (
        Literal[True] | tuple[str, ...]
    ) = ()  # it speaks of these after separation; of all cases if true
    steady: Literal[True] | tuple[str, ...] = ()  # it is about the steady states of these
    scans: tuple[str, ...] = ()  # the grid studies that the check is given besides
    beside: tuple[str, ...] = ()  # further ones, for notes: None instead of one that is missing
    tables: tuple[str, ...] = ()  # further ones of results on which it rests
    figures: tuple[
        str, ...
    ] = ()  # of the paper's study, or names of grid studies with a figure of the same name
    print_error: bool = False  # it is an error in print, counted apart
    after_the_fact: bool = False  # the rule was chosen when the numbers were known
    also: str = ""  # the row of the ledger that judges the same, of a conclusion that is judged under several models

    @property
    def rule(self) -> str:
        """How it is judged, in words."""
        return fill(self.judged, **self.given)

    def judge(self, cases: Mapping[str, CaseView]) -> Answer:
        """Judge it by these cases and grid studies; evidence that is missing or does not decide is
        named."""
        try:
            return self._judge(cases)
        except Missing as missing:
            return Answer(FALSE if isinstance(missing, Absent) else NOT_COMPUTED, f"{missing}.")

    def _judge(self, cases: Mapping[str, CaseView]) -> Answer:
        if self.check is None:
            return Answer(self.verdict, self.here, self.note)
        needed = {name: _needed(cases, name, until) for name, until in self.cases.items()}
        if self.every:
            needed = {name: case for name, case in cases.items() if not case.is_grid}
        for name in self.scans:
            if name not in cases:
                raise Missing(f"study {name} is not among those of this run")
        for case in needed.values():
            if (self.separates is True or case.name in self.separates) and not (
                case.separates or case.bonded
            ):
                raise Missing(f"no separation in {case['time_reached']:g} s (case {case.name})")
        steady = [
            case for name, case in needed.items() if self.steady is True or name in self.steady
        ]
        for case in steady:
            if (settling := case.settling()).answer is not Settled.SETTLED:
                raise Missing(
                    f"case {case.name} has not settled in {case['time_reached']:g} s: {settling}"
                )
        studies = [cases[name].node.to_dataset() for name in self.scans]
        beside = [cases[name].node.to_dataset() if name in cases else None for name in self.beside]
        answer = self.check(*needed.values(), *studies, *beside, **self.given)
        which = "The motion has" if len(steady) == 1 else "All motions judged here have"
        place, stated = (
            next((case.place for case in needed.values()), ""),
            facts(studies[0]) if studies else {},
        )
        texts = (
            (self.here, self.note) if not answer.here or not self.here else ("", "")
        )  # nothing fills them
        here, note = (
            fill(text, **{"place": place, "stated": stated} | self.given | answer.values)
            for text in texts
        )
        return Answer(
            answer.verdict,
            answer.here or here,
            answer.notes,
            note,
            f"{which} settled." * bool(steady),
        )


def rows_of(file: str, checks: Mapping[str, Any]) -> tuple[Row, ...]:
    """The rows of a file, in its order, with their checks by name; raises pydantic.ValidationError
    with all faults."""
    texts = {f"{file}: {name}": {"id": name, **raw} for name, raw in read_texts(file).items()}
    for text in texts.values():
        if "check" in text:
            text["check"] = checks.get(text["check"], text["check"])
    return tuple(TypeAdapter(dict[str, Row]).validate_python(texts).values())


def judge(rows: Iterable[Row], models: Mapping[str, Mapping[str, CaseView]]) -> pd.DataFrame:
    """Judge rows under models, each with its own cases: a row for every statement and model, see
    `Answer`."""
    pairs = product(models, rows)
    return pd.DataFrame(
        {"id": row.id, "model": name, **vars(row.judge(models[name]))} for name, row in pairs
    )


def _needed(cases: Mapping[str, CaseView], name: str, until: float) -> CaseView:
    """The case that equals the paper's case of this name and has run this far (s); raises
    `Missing`."""
    if name not in cases:
        raise Missing(f"case {name} is not in this study")
    case, paper = cases[name], paper_cases()[name]
    if case.status not in ("ok", "stopped"):
        raise Missing(f"{case.status} (case {name})")
    p, expected = case.parameters, parameters_of(name, case.parameters.normalization)
    if p != expected:
        differ = [
            key for key in Parameters.model_fields if getattr(p, key) != getattr(expected, key)
        ]
        raise Missing(f"case {name} has another {', '.join(differ)} in this study")
    starts = (json.loads(case.node.attrs.get("start", "{}")), paper.get("start", {}))
    ours, its = (
        [(start.get("prerun") or {}).get("parameters"), start.get("perturbation") or {}]
        for start in starts
    )
    if ours != its:
        raise Missing(f"case {name} has another start in this study")
    if case.status == "ok" and case["time_reached"] < until:
        raise Missing(f"case {name} ends at {case['time_reached']:g} s, {until:g} s are needed")
    return case


@cache
def parameters_of(name: str, normalization: str) -> Parameters:
    """Those of a case of the paper, with the study's normalisation."""
    return Parameters(**paper_cases()[name]["parameters"], normalization=normalization)
