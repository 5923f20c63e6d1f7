"""Rows of the ledger: quotations of the paper, and the checks that judge them."""

import json
from collections.abc import Callable, Container, Iterable, Mapping
from functools import cache
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
import pandas as pd
import xarray as xr
import yaml
from pydantic import BaseModel, ConfigDict, TypeAdapter

from disc_model.analysis.classify import Settled
from disc_model.data.dataset import Missing
from disc_model.data.texts import fill
from disc_model.parameters import Parameters
from workflow.paper.measures import Absent, CaseView, facts

TRUE = "true"
PART = "true in part"
FALSE = "false"
AMBIGUOUS = "ambiguous in the paper"
NOT_TESTED = "cause not tested"
NOT_COMPUTED = "not computed"
VERDICTS = (TRUE, PART, FALSE, AMBIGUOUS, NOT_TESTED, NOT_COMPUTED)
# that of C, where there is one, takes a tenth of the time
_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def read_texts(name: str) -> Any:
    """Return the content of a YAML file, by its path from this folder on."""
    path = Path(__file__).parent / name
    return yaml.load(path.read_text(encoding="utf-8"), _LOADER)


@cache
def paper_cases() -> dict[str, dict[str, Any]]:
    """Return the named cases of the paper: what each adds to the study's base values."""
    return dict(read_texts("../../config/paper.yaml")["cases"])


@cache
def parameters_of(name: str, normalization: str) -> Parameters:
    """Return the parameters of a case of the paper, with a normalisation of the modes."""
    return Parameters(**paper_cases()[name]["parameters"], normalization=normalization)


class Answer:
    """Result of a check.

    Attributes
    ----------
    verdict : one of `VERDICTS`; the constructor also takes whether the statement is true
    here : what was computed, instead of the row's own text
    notes : remarks, in one text
    values : values that the row's texts may name
    """

    def __init__(
        self, verdict: bool | np.bool_ | str, here: str = "", *notes: str, **values: Any
    ) -> None:
        self.verdict = verdict_on(verdict)
        self.here = here
        self.notes = " ".join(filter(None, notes))
        self.values = values


def verdict_on(holds: bool | np.bool_ | str) -> str:
    """Return the verdict on a statement that holds or does not; a verdict stays as it is."""
    if isinstance(holds, str):
        return holds
    return TRUE if holds else FALSE


def graded(holds: Iterable[bool | np.bool_]) -> str:
    """Return the verdict on a statement by whether each of its parts holds."""
    each = [bool(part) for part in holds]
    if all(each):
        return TRUE
    return PART if any(each) else FALSE


def partly(holds: bool | np.bool_, reservation: bool | np.bool_) -> str:
    """Return the verdict on a statement that holds, perhaps with a reservation, or does not."""
    if not holds:
        return FALSE
    return PART if reservation else TRUE


class Evidence(NamedTuple):
    """What a row is judged by."""

    cases: list[CaseView]
    steady: list[CaseView]
    """Those whose steady state the row is about; each has settled."""
    studies: list[xr.Dataset]
    optional_studies: list[xr.Dataset | None]
    """Grid studies for notes, None where one is missing."""
    tables: dict[str, pd.DataFrame]


class Row(BaseModel):
    """A statement of the paper with the check that judges it, as an entry of a file.

    Texts are templates. They may name values of the answer, those in `given`, the ``place`` of the
    first case, and what the first grid study has ``stated``.

    Attributes
    ----------
    id : name of the row
    place : where the statement stands in the paper
    quote : the statement, literally
    statement : the statement in words of ours, of what the paper does not say literally
    check : function that judges the row, which a file names; None if nothing is computed for it
    verdict : the verdict, without a check
    here : what is said for the verdict, or of the check's values
    matters : the consequence, in one sentence
    judged : the rule by which the check judges, with the numbers of `given`
    note : what should be known in any case
    given : numbers for the check and the rule
    cases : cases of config/paper.yaml for the check, with the time in s to which each must have run
    every : whether the check is given all cases instead
    separates : cases of which the row speaks after separation, or True for all
    steady : cases whose steady state the row is about, or True for all
    scans : grid studies that the check is given after the cases
    optional_scans : further ones, for notes; the check is given None for one that is missing
    tables : tables of results on which the row rests as well
    from_tables : tables that the check is given, each as an argument of its name
    computed : what the check computes besides, of which no dataset is kept
    figures : figures of the paper's study, or grid studies with a figure of the same name
    print_error : whether the row is on an error in print, which is counted separately
    after_the_fact : whether the rule was chosen when the numbers were known
    also : the row of the ledger that judges the same as a conclusion under several models
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    id: str
    place: str
    quote: str = ""
    statement: str = ""
    check: Callable[..., Answer] | None = None
    verdict: str = ""
    here: str = ""
    matters: str = ""
    judged: str = ""
    note: str = ""
    given: dict[str, bool | float | str | list[float]] = {}
    cases: dict[str, float] = {}
    every: bool = False
    separates: Literal[True] | tuple[str, ...] = ()
    steady: Literal[True] | tuple[str, ...] = ()
    scans: tuple[str, ...] = ()
    optional_scans: tuple[str, ...] = ()
    tables: tuple[str, ...] = ()
    from_tables: tuple[str, ...] = ()
    computed: str = ""
    figures: tuple[str, ...] = ()
    print_error: bool = False
    after_the_fact: bool = False
    also: str = ""

    @property
    def rule(self) -> str:
        """How the row is judged, in words."""
        return fill(self.judged, **self.given)

    def judge(
        self, cases: Mapping[str, CaseView], tables: Mapping[str, pd.DataFrame] | None = None
    ) -> Answer:
        """Judge the row by cases and grid studies, and by tables made of cases, by name.

        Evidence that is missing, or that does not decide, is named in the answer.
        """
        if self.check is None:
            return Answer(self.verdict, self.here, self.note)
        try:
            evidence = self._gather(cases, tables or {})
            answer = self.check(
                *evidence.cases,
                *evidence.studies,
                *evidence.optional_studies,
                **evidence.tables,
                **self.given,
            )
            return self._put_in_words(answer, evidence)
        except Absent as absent:
            return Answer(FALSE, f"{absent}.")
        except Missing as missing:
            return Answer(NOT_COMPUTED, f"{missing}.")

    def _gather(
        self, known: Mapping[str, CaseView], tables: Mapping[str, pd.DataFrame]
    ) -> Evidence:
        """Return the evidence for the check; raises `Missing` if there is not enough of it."""
        if self.every:
            cases = [case for case in known.values() if not case.is_grid]
        else:
            cases = [required_case(known, name, until) for name, until in self.cases.items()]
        _require("study", self.scans, known)
        _require("table", self.from_tables, tables)

        for case in self._those(self.separates, cases):
            if not (case.separates or case.bilateral):
                raise Missing(f"no separation in {case['time_reached']:g} s (case {case.name})")
        steady = self._those(self.steady, cases)
        for case in steady:
            settling = case.settling()
            if settling.answer is not Settled.SETTLED:
                raise Missing(
                    f"case {case.name} has not settled in {case['time_reached']:g} s: {settling}"
                )

        studies = [known[name].node.to_dataset() for name in self.scans]
        optional: list[xr.Dataset | None] = []
        for name in self.optional_scans:
            if name in known:
                optional.append(known[name].node.to_dataset())
            else:
                optional.append(None)
        given = {name: tables[name] for name in self.from_tables}
        return Evidence(cases, steady, studies, optional, given)

    @staticmethod
    def _those(named: Literal[True] | tuple[str, ...], cases: list[CaseView]) -> list[CaseView]:
        """Return the cases that a key of the row names, all of them if it is True."""
        if named is True:
            return cases
        return [case for case in cases if case.name in named]

    def _put_in_words(self, answer: Answer, evidence: Evidence) -> Answer:
        """Return an answer with the row's texts, filled with the values of the check."""
        values: dict[str, Any] = {"place": "", "stated": {}}
        if evidence.cases:
            values["place"] = evidence.cases[0].place
        if evidence.studies:
            values["stated"] = facts(evidence.studies[0])
        values.update(self.given)
        values.update(answer.values)

        here = answer.here
        note = ""
        # where the check has words of its own, nothing fills the row's
        if not answer.here or not self.here:
            here = here or fill(self.here, **values)
            note = fill(self.note, **values)

        settled = ""
        if len(evidence.steady) == 1:
            settled = "The motion has settled."
        elif evidence.steady:
            settled = "All motions judged here have settled."
            if evidence.studies:
                settled = "All motions of the named cases have settled."
        return Answer(answer.verdict, here, answer.notes, note, settled)


def _require(what: str, names: Iterable[str], known: Container[str]) -> None:
    """Raise `Missing` for the first study or table that is not known."""
    for name in names:
        if name not in known:
            raise Missing(f"{what} {name} is not among those of this run")


def rows_of(file: str, checks: Mapping[str, Any]) -> tuple[Row, ...]:
    """Return the rows of a YAML file, in its order.

    Parameters
    ----------
    file : its path from this folder on
    checks : functions that judge rows, by the names that the file uses

    Raises
    ------
    pydantic.ValidationError
        With all faults of the file.
    """
    entries = {}
    for name, values in read_texts(file).items():
        entry = {"id": name, **values}
        if "check" in entry:
            entry["check"] = checks.get(entry["check"], entry["check"])
        entries[f"{file}: {name}"] = entry
    return tuple(TypeAdapter(dict[str, Row]).validate_python(entries).values())


def judge(
    rows: Iterable[Row],
    models: Mapping[str, Mapping[str, CaseView]],
    tables: Mapping[str, Mapping[str, pd.DataFrame]] | None = None,
) -> pd.DataFrame:
    """Judge rows under models, each with its own cases by name.

    Parameters
    ----------
    rows : statements with their checks
    models : cases and grid studies of each model
    tables : those that are made of the cases of each model, by name

    Returns
    -------
    table : a row for each statement and model: ``id``, ``model`` and the attributes of `Answer`
    """
    rows = tuple(rows)
    judged = []
    for model, cases in models.items():
        for row in rows:
            answer = row.judge(cases, (tables or {}).get(model))
            judged.append({"id": row.id, "model": model, **vars(answer)})
    return pd.DataFrame(judged)


def required_case(cases: Mapping[str, CaseView], name: str, until: float) -> CaseView:
    """Return the case that equals the paper's case of a name.

    Parameters
    ----------
    cases : the cases of a study, by name
    name : of the case
    until : time in s to which it must have run

    Raises
    ------
    disc_model.data.dataset.Missing
        If the study has no such case, if it failed, differs from the paper's, or ended earlier.
    """
    if name not in cases:
        raise Missing(f"case {name} is not in this study")
    case = cases[name]
    if case.status not in ("ok", "stopped"):
        raise Missing(f"{case.status} (case {name})")

    own = case.parameters
    expected = parameters_of(name, own.normalization)
    if own != expected:
        differ = [
            key for key in Parameters.model_fields if getattr(own, key) != getattr(expected, key)
        ]
        raise Missing(f"case {name} has another {', '.join(differ)} in this study")
    own_start = json.loads(case.node.attrs.get("start", "{}"))
    expected_start = paper_cases()[name].get("start", {})
    if _start(own_start) != _start(expected_start):
        raise Missing(f"case {name} has another start in this study")

    end = case["time_reached"]
    if case.status == "ok" and end < until:
        raise Missing(f"case {name} ends at {end:g} s, {until:g} s are needed")
    return case


def _start(stated: Mapping[str, Any]) -> tuple[Any, Any]:
    """Return what makes a start another one: parameters of a run before it, and perturbations."""
    prerun = stated.get("prerun") or {}
    return prerun.get("parameters"), stated.get("perturbation") or {}
