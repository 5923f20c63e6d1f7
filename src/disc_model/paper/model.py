"""Model of a claim: a text, a check, and the cases that the check examines.

The text is data, in the YAML file of its section; see `Claim` for its keys.  It names the check, a function of the
module beside that file, or of another section's. The check receives cases and bounds. It returns an `Answer`: a
verdict, and the numbers for the text's sentences.
"""

import json
from collections import ChainMap
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any, Literal, Self

import jinja2
import numpy as np
import pandas as pd
import yaml
from pydantic import BaseModel, ConfigDict, TypeAdapter, field_validator

from disc_model.analysis.settling import Settled
from disc_model.data.dataset import Missing
from disc_model.data.texts import fill
from disc_model.errors import DiscModelError
from disc_model.paper.measures import Absent, CaseView, another_motion, elsewhere, facts, simulate_again
from disc_model.parameters import Parameters

HOLDS = "holds"
REMARK = "holds with a remark"
FAILS = "does not hold"
UNDECIDED = "undecided"
NOT_TESTABLE = "not testable"
NOT_COMPUTED = "not computed"
FOLDER = Path(__file__).parent
PHYSICAL = ("a", "b", "r_0", "h", "E", "nu", "rho", "D_star", "mu_s", "mu_k", "k", "k_p", "m", "N", "Omega")


class ClaimError(DiscModelError):
    """A text with a number that its check does not return."""


def read_texts(name: str) -> Any:
    """A file of texts beside this module, or by its path from the package on."""
    folder = FOLDER.parent if "/" in name else FOLDER
    return yaml.safe_load((folder / name).read_text(encoding="utf-8"))


@cache
def paper_cases() -> Mapping[str, Mapping[str, Any]]:
    """The named cases of the paper: the values of each, beside the study's base values."""
    cases: Mapping[str, Mapping[str, Any]] = read_texts("config/paper.yaml")["cases"]
    return cases


class Answer:
    """Result of a check.

    Parameters
    ----------
    holds : whether the claim holds; None if the evidence does not decide it
    why : in that case, the key of the text's reason for it; empty if no evidence of this kind can decide
    values : values for the sentences beside bounds, `facts` of grid studies (each by its name) and cases (each by its
        name, the first as ``case``, all as rows of ``cases``); a remark is added if the value of its name is true
    """

    def __init__(self, holds: bool | np.bool_ | None, why: str = "", /, **values: Any) -> None:
        self.holds, self.why, self.values = holds, why, values


@dataclass(frozen=True)
class Finding:
    """Result of a check in words: what was found, the verdict, remarks, and what turns the verdict.

    robust : changes that bring another verdict, "stable" if none does, "" if nothing can be changed
    """

    ours: str
    verdict: str
    remark: str = ""
    robust: str = ""


@dataclass(frozen=True)
class _Phrase:
    """Rows or cases in words, said only where a sentence has them: what is not said may lack evidence."""

    template: str
    rows: Sequence[dict[str, Any] | CaseView]
    values: dict[str, Any]

    def __bool__(self) -> bool:
        return bool(self.rows)

    def __str__(self) -> str:
        rows = (row if isinstance(row, dict) else {"case": row} for row in self.rows)
        return "; ".join(fill(self.template, **(self.values | row)) for row in rows)


Names = Literal[True] | tuple[str, ...]
RELATIVE = frozenset({"bounded", "factor", "part", "ratio", "share"})
"""Dimensionless bounds, which are compared with 1."""
SHARES = frozenset({"part", "share"})
"""Those of them that are parts of a whole."""


class Claim(BaseModel):
    """A statement of the paper: what a file says of it, and the function that decides it.

    Sentences have placeholders for the numbers of the claim and of its `Answer`. Any of the remarks may have
    ``elsewhere`` and ``another``, see `elsewhere` and `another_motion` in `disc_model.paper.measures`.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    id: str
    check: Callable[..., Answer]  # decides it; a file has its name
    location: str  # the place in the paper
    claim: str  # the statement in our own words
    paper: str = ""  # the value that the paper gives, if it does not only show it
    tolerance: str = ""  # what counts as agreement
    reason: str = ""  # why that much
    bounds: dict[str, float] = {}  # thresholds of ours, for the check and for sentences
    given: dict[str, float | list[float]] = {}  # other numbers for them
    cases: dict[str, float] = {}  # for the check, of config/paper.yaml: the time in s to which each must have run
    every: bool = False  # the check is given all cases instead, whatever their names
    separates: Names = ()  # it speaks of these after separation: without one it is not testable; all that can if true
    steady: Names = ()  # it is about the steady states of these: one that has not come to it decides nothing
    computed: bool = False  # judged again with each parameter of the cases changed, which must not need other runs
    simulated: bool = False  # judged again with each changed in new simulations of the cases, up to their times
    scans: tuple[str, ...] = ()  # the grid studies that the check is given besides
    beside: tuple[str, ...] = ()  # further ones, for remarks only: None instead of one that is missing
    ours: str  # what was found
    remark: str = ""  # what should be known besides
    remarks: dict[str, str] = {}  # the same where the value of that name is true
    undecided: dict[str, str] = {}  # by name, reasons why the evidence may decide nothing
    parts: dict[str, str] = {}  # by name of a list of rows, how a sentence says each
    apart: str = ""  # why the tally leaves it out: it repeats another claim, is a definition, or concerns a misprint
    also: str = ""  # the claim that says the same, of a conclusion that is judged under several models

    @field_validator("cases")
    @classmethod
    def _of_the_paper(cls, cases: dict[str, float]) -> dict[str, float]:
        if unknown := cases.keys() - paper_cases().keys():
            raise ValueError(f"no case {', '.join(sorted(unknown))} in the paper's")
        return cases

    @property
    def numbers(self) -> dict[str, Any]:
        """Numbers that the check receives besides its evidence."""
        return self.given | self.bounds

    def fill(self, sentence: str) -> str:
        """A sentence with the claim's numbers, such as the paper's value or the tolerance."""
        return fill(sentence, **self.numbers)

    def judge(self, cases: Mapping[str, CaseView]) -> Finding:
        """Final result: undecided if a halved or doubled bound, or a parameter that it is computed with, changes it.

        That other simulations change it is a remark: the paper speaks of one, with exactly its values.
        """
        result = self.evaluate(cases)
        if result.verdict.startswith(NOT_COMPUTED) or not (self.bounds or self.computed or self.simulated):
            return result
        turned, only = self.robustness(cases, result.verdict)
        result = replace(result, robust=_joined(turned, only) or "stable")
        if turned and result.verdict != UNDECIDED:
            result = replace(result, verdict=UNDECIDED, remark=_joined(f"not robust: {turned}", result.remark))
        if only:
            verdict = REMARK if result.verdict == HOLDS else result.verdict
            remark = _joined(result.remark, f"only for these very values: {only}")
            result = replace(result, verdict=verdict, remark=remark)
        return result

    def robustness(self, cases: Mapping[str, CaseView], verdict: str) -> tuple[str, str]:
        """Other verdicts than this, with the changes that bring them: of what is computed, and of simulations."""
        computed = {text: other.evaluate(cases).verdict for text, other in self._with_other_bounds().items()}
        simulated = dict[str, str]()
        if self.computed or self.simulated:
            simulated = {name: self.evaluate(cases, name).verdict for name in PHYSICAL}
        if self.computed:
            computed |= {f"{name} 0.1 % larger": other for name, other in simulated.items()}
        only = _turns(simulated, verdict) if self.simulated else ""
        return _turns(computed, verdict), only and f"{only} (each 0.1 % larger)"

    def evaluate(self, cases: Mapping[str, CaseView], changed: str = "") -> Finding:
        """Result of the check for these cases and grid studies; the verdict names missing evidence.

        changed : a parameter that is taken to be 0.1 % larger
        """
        try:
            return self._evaluate(cases, changed)
        except Absent as absent:
            return Finding(str(absent), FAILS)
        except Missing as missing:
            return Finding("", f"{NOT_COMPUTED}: {missing}")

    def _evaluate(self, cases: Mapping[str, CaseView], changed: str) -> Finding:
        needed = {name: _needed(cases, name, until) for name, until in self.cases.items()}
        if self.every:
            needed = {name: case for name, case in cases.items() if not case.is_grid}
        if changed:
            needed = {name: self._changed(case, changed) for name, case in needed.items()}
        if missing := [name for name in self.scans if name not in cases]:
            raise Missing(f"study {missing[0]} is not among those of this run")
        if quiet := [case for case in _named(needed, self.separates) if not (case.separates or case.bonded)]:
            text = "; ".join(f"case {case.name}: no separation in {case['time_reached']:g} s" for case in quiet)
            return Finding(text, NOT_TESTABLE)
        wanted = (*self.scans, *self.beside)
        studies = {name: cases[name].node.to_dataset() if name in cases else None for name in wanted}
        answer = self.check(*needed.values(), *studies.values(), **self.numbers)
        values = self.numbers | {**needed, "cases": [*needed.values()], "case": next(iter(needed.values()), None)}
        values |= answer.values | {name: facts(study) for name, study in studies.items() if study is not None}
        if "elsewhere" in self.remarks:
            values["elsewhere"] = elsewhere(needed.values(), cases.get("basins"))
        if "another" in self.remarks:
            values["another"] = another_motion(needed.values())
        return _of_steady_state(self._said(answer, values), _named(needed, self.steady))

    def _changed(self, case: CaseView, parameter: str) -> CaseView:
        """The case with a parameter taken to be 0.1 % larger, or simulated with it."""
        other = replace(case, larger=parameter)
        if not self.simulated:
            return other
        return CaseView(case.name, simulate_again(other.parameters, self.cases[case.name]))

    def _with_other_bounds(self) -> dict[str, Self]:
        """The claim with each bound halved and doubled, by what is changed.

        Of ratios between 0.5 and 2 the distance from 1 is halved or doubled, of parts of a whole the ratio to the rest.
        """
        changed = {}
        for name, bound in self.bounds.items():
            for factor in (0.5, 2.0):
                other = factor * bound
                if name in RELATIVE and 0.5 < bound < 2:
                    other = 1 + factor * (bound - 1)
                elif name in SHARES:
                    other /= 1 + (factor - 1) * bound
                changed[f"{name} = {other:.4g}"] = self.model_copy(update={"bounds": self.bounds | {name: other}})
        return changed

    def _said(self, answer: Answer, values: dict[str, Any]) -> Finding:
        """The answer in the sentences of the text."""
        try:
            if answer.holds is None:
                remarks = [self.undecided[answer.why] if answer.why else self.remark]
                verdict = UNDECIDED if answer.why else NOT_TESTABLE
            else:
                remarks = [*filter(None, [self.remark]), *(text for name, text in self.remarks.items() if values[name])]
                verdict = (REMARK if remarks else HOLDS) if answer.holds else FAILS
            said = values | {
                name: _Phrase(part, values[name], values) for name, part in self.parts.items() if name in values
            }
            return Finding(fill(self.ours, **said), verdict, "; ".join(fill(remark, **said) for remark in remarks))
        except (KeyError, jinja2.UndefinedError) as missing:
            raise ClaimError(f"claim {self.id}: {missing} among the values of its check: {', '.join(values)}") from None


def claims(*modules: ModuleType) -> tuple[Claim, ...]:
    """The claims of these modules, in the order of the files beside them.

    Raises
    ------
    pydantic.ValidationError
        With all faults of the files.
    """
    checks, common = ChainMap(*map(vars, modules)), read_texts("common.yaml")
    texts: dict[str, dict[str, Any]] = {}
    for module in modules:
        file = Path(str(module.__file__)).with_suffix(".yaml")
        for name, raw in read_texts(str(file)).items():
            check = raw.get("check")
            texts[f"{file.name}: {name}"] = text = raw | {"id": name, "check": checks.get(check, check)}
            for key in {"remarks", "undecided"} & raw.keys():  # names without a text have the common one
                text[key] = {one: sentence or common.get(one) for one, sentence in raw[key].items()}
    return tuple(TypeAdapter(dict[str, Claim]).validate_python(texts).values())


def judge(claims: Iterable[Claim], models: Mapping[str, Mapping[str, CaseView]]) -> pd.DataFrame:
    """Judge claims under models, each with its own cases: a row for every claim and model, see `Finding`."""
    return pd.DataFrame(
        {"id": claim.id, "model": model, **asdict(claim.judge(cases))}
        for model, cases in models.items()
        for claim in claims
    )


# ----------------------------------------------------------------------------------------------------
# Checks of the evidence


def _joined(*texts: str) -> str:
    return "; ".join(filter(None, texts))


def _turns(others: Mapping[str, str], verdict: str) -> str:
    """The verdicts that differ from a verdict, each with the changes that bring it."""
    kind, names = verdict.replace(REMARK, HOLDS), dict[str, list[str]]()
    for name, other in others.items():
        if other.replace(REMARK, HOLDS) != kind:
            names.setdefault(other, []).append(name)
    return "; ".join(f"{other} with {', '.join(changes)}" for other, changes in names.items())


def _of_steady_state(found: Finding, cases: Sequence[CaseView]) -> Finding:
    """The finding, with the time at which each case became steady, if any; undecided if one did not."""
    ends = {f"{case.name} at {case['time_reached']:g} s": case.settling() for case in cases}
    moving = "; ".join(f"case {end}: {found}" for end, found in ends.items() if found.answer is not Settled.SETTLED)
    if moving:
        return Finding(found.ours, UNDECIDED, f"not yet steady: {moving}")
    return replace(found, ours=f"{found.ours} (steady: {', '.join(ends)})") if ends else found


def _named(cases: Mapping[str, CaseView], names: Names) -> list[CaseView]:
    """The cases of these names, all if true."""
    return [cases[name] for name in (cases if names is True else names)]


def _needed(cases: Mapping[str, CaseView], name: str, until: float) -> CaseView:
    """The case that equals the paper's case of this name and has run this far (s); raises `Missing`."""
    if name not in cases:
        raise Missing(f"case {name} is not in this study")
    case, paper = cases[name], paper_cases()[name]
    if case.status not in ("ok", "stopped"):
        raise Missing(f"{case.status} (case {name})")
    p, expected = case.parameters, _parameters(name, case.parameters.normalization)
    if p != expected:
        differ = [key for key in Parameters.model_fields if getattr(p, key) != getattr(expected, key)]
        raise Missing(f"case {name} has another {', '.join(differ)} in this study")
    start = _start_of(paper.get("start", {}))
    if _start_of(json.loads(case.node.attrs.get("start", "{}"))) != start:
        words = start if isinstance(start, str) else f"last state of {start}"
        raise Missing(f"case {name} does not begin with the {words} in this study")
    if case.status == "ok" and case["time_reached"] < until:
        raise Missing(f"case {name} ends at {case['time_reached']:g} s, {until:g} s are needed")
    return case


@cache
def _parameters(name: str, normalization: str) -> Parameters:
    """Those of a case of the paper, with the study's normalisation."""
    return Parameters(**paper_cases()[name]["parameters"], normalization=normalization)


def _start_of(start: Mapping[str, Any]) -> str | Mapping[str, float]:
    """Parameters of the motion after whose end a case begins, or another start in words."""
    if not any(start.values()):
        return "static start"
    prepared: Mapping[str, float] = (start.get("prerun") or {}).get("parameters", {})
    return "perturbed start" if start.get("perturbation") else prepared
