"""Rows of the ledger: quotations of the paper, with what is measured for each, and its rule.

A row is an entry of a file. It measures by expressions of jinja2, such as ``case.late.width`` or
``growth_over_steps(map_E, "E", 1)``, with the functions of `functions`; its rule is a
condition for each verdict, of which the first that holds gives the verdict; its texts are templates.
"""

import json
from collections.abc import Callable, Container, Iterable, Mapping
from functools import cache
from pathlib import Path
from typing import Any, Literal, NamedTuple, get_args

import jinja2
import pandas as pd
import yaml
from pydantic import BaseModel, ConfigDict, TypeAdapter

from disc_model.data.dataset import Missing
from disc_model.data.texts import fill
from disc_model.parameters import Parameters
from workflow.paper.measures import Absent, CaseView, Found, extent, facts

Verdict = Literal[
    "true", "true in part", "false", "ambiguous in the paper", "cause not tested", "not computed"
]
VERDICTS: tuple[Verdict, ...] = get_args(Verdict)
TRUE, PART, FALSE, _, _, NOT_COMPUTED = VERDICTS
# that of C, where there is one, takes a tenth of the time
_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)

_EXPRESSIONS = jinja2.Environment(undefined=jinja2.StrictUndefined, autoescape=False)
_EXPRESSIONS.filters |= {"all": all, "any": any, "extent": extent}


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


class Answer(NamedTuple):
    """What comes of a row: a verdict, what was computed, and remarks."""

    verdict: str
    here: str = ""
    notes: str = ""


class Row(BaseModel):
    """A statement of the paper, as an entry of a file.

    Expressions and texts know `functions`, the `cases` and grid studies of the row, the first of the
    cases as ``case``, what the first study has ``stated``, the tables, `given`, and what was measured
    before.

    Attributes
    ----------
    id : name of the row
    place : where the statement stands in the paper
    quote : the statement, literally
    statement : the statement in words of ours, of what the paper does not say literally
    measure : expression for several numbers by name
    let : expressions for further numbers, in turn
    when : conditions for verdicts; the first that holds counts, and FALSE if none does
    verdict : the verdict, where nothing is computed
    here : what is said of the numbers
    matters : the consequence, in one sentence
    judged : the rule in words
    note : what should be known in any case
    given : numbers for the rule
    cases : cases of config/paper.yaml, with the time in s to which each must have run
    every : whether the row is given all cases instead
    separates : cases of which the row speaks after separation, or True for all
    steady : cases whose steady state the row is about, or True for all
    scans : grid studies
    optional_scans : further ones, for notes; None where one is missing
    tables : tables of results on which the row rests as well
    from_tables : tables that the row is given
    computed : what is computed besides, of which no dataset is kept
    figures : figures of the paper's study, or grid studies with a figure of the same name
    counts : for a row that is counted separately, or whose rule was chosen when the numbers were known
    also : the row of the ledger that judges the same as a conclusion under several models
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    id: str
    place: str
    quote: str = ""
    statement: str = ""
    measure: str = ""
    let: dict[str, str] = {}
    when: dict[Verdict, str] = {}
    verdict: str = ""
    here: str = ""
    matters: str = ""
    judged: str = ""
    note: str = ""
    given: dict[str, float | str | list[float]] = {}
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
    counts: Literal["", "error in print", "after the fact"] = ""
    also: str = ""

    @property
    def rule(self) -> str:
        """How the row is judged, in words."""
        return fill(self.judged, **self.given)

    def judge(
        self,
        known: Mapping[str, CaseView],
        tables: Mapping[str, pd.DataFrame],
        functions: Mapping[str, Callable[..., Any]],
    ) -> Answer:
        """Judge the row; evidence that is missing, or that does not decide, is named in the answer.

        Parameters
        ----------
        known : cases and grid studies by name
        tables : made of cases, by name
        functions : that the row's expressions call
        """
        if self.verdict:
            return Answer(self.verdict, self.here, self.note)
        try:
            values = {**functions, **self._evidence(known, tables), **self.given}
            if self.measure:
                values |= _compiled(self.measure)(**values)
            for name, expression in self.let.items():
                values[name] = _compiled(expression)(**values)
            verdict = FALSE
            for each, condition in reversed(self.when.items()):
                if _compiled(condition)(**values):
                    verdict = each
            notes = [fill(self.note, **values), self._on_settling()]
            return Answer(verdict, fill(self.here, **values), " ".join(filter(None, notes)))
        except Absent as absent:
            return Answer(FALSE, f"{absent}.")
        except Missing as missing:
            return Answer(NOT_COMPUTED, f"{missing}.")

    def _evidence(self, known: Mapping[str, CaseView], tables: Mapping[str, pd.DataFrame]) -> Found:
        """Return what expressions know; raises `Missing` if it is not there."""
        _require("study", self.scans, known)
        _require("table", self.from_tables, tables)
        cases = self._cases(known)
        values: Found = {"cases": cases, "place": "", "stated": {}}
        if cases:
            values |= {"case": cases[0], "place": cases[0].place}
        for name in self.scans + self.optional_scans:
            values[name] = known[name].node.to_dataset() if name in known else None
        if self.scans:
            values["stated"] = facts(values[self.scans[0]])
        return values | {name: tables[name] for name in self.from_tables}

    def _cases(self, known: Mapping[str, CaseView]) -> list[CaseView]:
        """Return the cases; raises `Missing` if one of them is not as the row needs it."""
        if self.every:
            return [case for case in known.values() if not case.is_grid]
        cases = [required_case(known, name, until) for name, until in self.cases.items()]
        for case in cases:
            end = f"{case['time_reached']:g} s"
            kept = not (case.separates or case.bilateral)
            if kept and _among(case.name, self.separates):
                raise Missing(f"no separation in {end} (case {case.name})")
            if _among(case.name, self.steady) and not case.settled:
                raise Missing(f"case {case.name} has not settled in {end}: {case.settling()}")
        return cases

    def _on_settling(self) -> str:
        """Return a remark on the motions whose steady state the row is about."""
        if not self.steady:
            return ""
        if self.scans:
            return "All motions of the named cases have settled."
        named = self.cases if self.steady is True else self.steady
        if len(named) == 1:
            return "The motion has settled."
        return "All motions judged here have settled."


def _among(name: str, named: Literal[True] | tuple[str, ...]) -> bool:
    """Return whether a key of a row names a case, as it does all if it is True."""
    return named is True or name in named


def _require(what: str, names: Iterable[str], known: Container[str]) -> None:
    """Raise `Missing` for the first study or table that is not known."""
    for name in names:
        if name not in known:
            raise Missing(f"{what} {name} is not among those of this run")


@cache
def _compiled(expression: str) -> Callable[..., Any]:
    """Return an expression as a function of its values."""
    return _EXPRESSIONS.compile_expression(expression, undefined_to_none=False)


def rows_of(*files: str) -> tuple[Row, ...]:
    """Return the rows of YAML files in this folder, in order.

    Raises
    ------
    pydantic.ValidationError
        With all faults of the files.
    """
    entries = {}
    for file in files:
        for name, values in read_texts(file).items():
            entries[f"{file}: {name}"] = {"id": name, **values}
    return tuple(TypeAdapter(dict[str, Row]).validate_python(entries).values())


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
        differ = [each for each, value in own if value != getattr(expected, each)]
        raise Missing(f"case {name} has another {', '.join(differ)} in this study")
    own_start = json.loads(case.node.attrs.get("start", "{}"))
    if _start(own_start) != _start(paper_cases()[name].get("start", {})):
        raise Missing(f"case {name} has another start in this study")
    end = case["time_reached"]
    if case.status == "ok" and end < until:
        raise Missing(f"case {name} ends at {end:g} s, {until:g} s are needed")
    return case


def _start(stated: Mapping[str, Any]) -> tuple[Any, Any]:
    """Return what makes a start another one: parameters of a run before it, and perturbations."""
    prerun = stated.get("prerun") or {}
    return prerun.get("parameters"), [stated.get(name, 0) for name in ("u", "u_velocity", "f")]
