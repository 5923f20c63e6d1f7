"""Model of a claim: a text, a check, and the cases that the check examines.

The text is data, in the YAML file of its section; see `Claim` for its keys.  It names the check, a function of the
module beside that file, or of another section's. The check receives cases and bounds. It returns an `Answer`: a
verdict, and the numbers for the text's sentences.
"""

import json
from collections import ChainMap
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any, Literal, Self

import numpy as np
import yaml
from pydantic import BaseModel, ConfigDict, TypeAdapter, field_validator

from disc_model.analysis.settling import Settled
from disc_model.data.dataset import Missing
from disc_model.data.texts import Part, Sentences
from disc_model.errors import DiscModelError
from disc_model.paper.measures import Absent, CaseView, another_motion, elsewhere, facts, rows, simulate_again
from disc_model.parameters import Parameters

HOLDS = "holds"
REMARK = "holds with a remark"
FAILS = "does not hold"
UNDECIDED = "undecided"
NOT_TESTABLE = "not testable"
NOT_COMPUTED = "not computed"
FOLDER = Path(__file__).parent
PHYSICAL = ("a", "b", "r_0", "h", "E", "nu", "rho", "D_star", "mu_s", "mu_k", "k", "k_p", "m", "N", "Omega")
PAPER = FOLDER.parent / "config/paper.yaml"


class ClaimError(DiscModelError):
    """A text with a number that its check does not return."""


def _read(path: Path) -> Any:
    return yaml.safe_load(path.read_text(encoding="utf-8"))


@cache
def paper_cases() -> Mapping[str, Mapping[str, Any]]:
    """The named cases of config/paper.yaml: the values of each, beside the study's base values."""
    cases: dict[str, Mapping[str, Any]] = _read(PAPER)["cases"]
    return cases


# ----------------------------------------------------------------------------------------------------
# Results of checks and their texts


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
    """Result of a check in words: what we found, the verdict, and remarks."""

    ours: str
    verdict: str
    remark: str = ""


Names = Literal[True] | tuple[str, ...]


RELATIVE = frozenset({"bounded", "factor", "part", "ratio", "share"})
"""Dimensionless bounds, which are compared with 1."""
SHARES = frozenset({"part", "share"})
"""Those of them that are parts of a whole."""


class Claim(BaseModel):
    """A statement of the paper: what a file says of it, and the function that decides it.

    Attributes
    ----------
    id : our name for it
    check : the function that decides it, which a file names
    location : the place in the paper
    claim : the statement in our own words
    paper : the value the paper gives, or "" if it only shows it
    tolerance, reason : what counts as agreement, and why that much
    bounds, given : numbers for the check and for sentences: thresholds of ours, and others or lists of them
    cases : those of config/paper.yaml that the check is given, each with the time in s to which it must have run
    separates : those of them that the claim says something of after separation: without one it is not testable; true
        stands for all in which contact can be lost
    steady : those whose steady state it is about: one that has not come to it by its end decides nothing
    computed : whether it is judged again with each of their parameters changed, which must not need other runs
    simulated : whether it is judged again with each changed in new simulations of the cases, up to their times
    scans : the grid studies that the check is given besides
    beside : further ones, for remarks only: None instead of one that is missing
    ours : what we found
    remark, remarks : what should be known besides: in any case; where the value of that name is true. Any may have
        ``elsewhere`` and ``another``, see `elsewhere` and `another_motion` in `disc_model.paper.measures`
    undecided : by name, reasons why the evidence may decide nothing
    parts : by name of a value, how its rows are said
    apart : why the tally leaves it out: it repeats another claim, is a definition, or concerns a misprint
    also : the claim that says the same, of a conclusion that is judged under several models
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    id: str
    check: Callable[..., Answer]
    location: str
    claim: str
    paper: str = ""
    tolerance: str = ""
    reason: str = ""
    bounds: dict[str, float] = {}
    given: dict[str, float | list[float]] = {}
    cases: dict[str, float] = {}
    separates: Names = ()
    steady: Names = ()
    computed: bool = False
    simulated: bool = False
    scans: tuple[str, ...] = ()
    beside: tuple[str, ...] = ()
    ours: str
    remark: str = ""
    remarks: dict[str, str] = {}
    undecided: dict[str, str] = {}
    parts: dict[str, Part] = {}
    apart: str = ""
    also: str = ""

    @field_validator("cases")
    @classmethod
    def _of_the_paper(cls, cases: dict[str, float]) -> dict[str, float]:
        if unknown := cases.keys() - paper_cases().keys():
            raise ValueError(f"no case {', '.join(sorted(unknown))} in the paper's")
        return cases

    def fill(self, sentence: str) -> str:
        """A sentence with the claim's numbers, such as the paper's value or the tolerance."""
        return Sentences({}, self.numbers).fill(sentence)

    @property
    def numbers(self) -> dict[str, Any]:
        """Numbers that the check receives besides its evidence."""
        return self.given | self.bounds

    def judge(self, *evidence: Any) -> Finding:
        """Apply the check to this evidence; the verdict names missing evidence."""
        try:
            return self._found(self.check(*evidence, **self.numbers), {})
        except Missing as missing:
            return _without(missing)

    def evaluate(self, cases: Mapping[str, CaseView], changed: str = "") -> Finding:
        """Check the claim; the verdict names missing evidence.

        changed : a parameter that is taken to be 0.1 % larger
        """
        try:
            needed = {name: _needed(cases, name, until) for name, until in self.cases.items()}
            if changed:
                needed = {name: self._changed(case, changed) for name, case in needed.items()}
            for name in self.scans:
                if name not in cases:
                    raise Missing(f"study {name} is not among those of this run")
            quiet = [case for case in _named(needed, self.separates) if not (case.separates or case.bonded)]
            if quiet:
                text = "; ".join(f"case {case.name}: no separation in {case['time_reached']:g} s" for case in quiet)
                return Finding(text, NOT_TESTABLE)
            wanted = (*self.scans, *self.beside)
            studies = {name: cases[name].node.to_dataset() if name in cases else None for name in wanted}
            answer = self.check(*needed.values(), *studies.values(), **self.numbers)
            answer.values |= {name: facts(study) for name, study in studies.items() if study is not None}
            if "elsewhere" in self.remarks:
                answer.values["elsewhere"] = elsewhere(needed.values(), cases.get("basins"))
            if "another" in self.remarks:
                answer.values["another"] = another_motion(needed.values())
            found = self._found(answer, needed)
            return _of_steady_state(found, _named(needed, self.steady))
        except Missing as missing:
            return _without(missing)

    def _changed(self, case: CaseView, parameter: str) -> CaseView:
        """The case with a parameter taken to be 0.1 % larger, or simulated with it."""
        other = replace(case, larger=parameter)
        if not self.simulated:
            return other
        return CaseView(case.name, simulate_again(other.parameters, self.cases[case.name]))

    def settle(self, judge: Callable[..., Finding]) -> tuple[Finding, str]:
        """Final result of the claim, undecided if a halved or doubled threshold changes the verdict; and such changes.

        So do changes of a parameter if it is `computed`. That other simulations change it is a remark: the paper speaks
        of one, with exactly its values. The changes are "stable" if there are none, and "" if nothing can be changed.

        judge : result of a claim, this one or with other thresholds; with a parameter changed if a name is given
        """
        found = judge(self)
        verdict = found.verdict
        if verdict.startswith(NOT_COMPUTED) or not (self.bounds or self.computed or self.simulated):
            return found, ""
        others = {text: judge(other).verdict for text, other in self._with_other_bounds().items()}
        larger = {name: judge(self, name).verdict for name in (PHYSICAL if self.computed or self.simulated else ())}
        if self.computed:
            others |= {f"{name} 0.1 % larger": other for name, other in larger.items()}
        turned, only = _turns(others, verdict), _turns(larger, verdict) if self.simulated else ""
        if turned and verdict != UNDECIDED:
            found = replace(found, verdict=UNDECIDED, remark=_joined(f"not robust: {turned}", found.remark))
        if only:
            only += " (each 0.1 % larger)"
            remark = _joined(found.remark, f"only for these very values: {only}")
            found = replace(found, verdict=REMARK if found.verdict == HOLDS else found.verdict, remark=remark)
        return found, _joined(turned, only) or "stable"

    def _with_other_bounds(self) -> dict[str, Self]:
        """The claim with each bound halved and doubled, by what is changed.

        Of ratios between 0.5 and 2 the distance from 1 is halved or doubled, of parts of a whole the ratio to the rest.
        """
        found = {}
        for name, bound in self.bounds.items():
            for factor in (0.5, 2.0):
                other = factor * bound
                if name in RELATIVE and 0.5 < bound < 2:
                    other = 1 + factor * (bound - 1)
                elif name in SHARES:
                    other /= 1 + (factor - 1) * bound
                found[f"{name} = {other:.4g}"] = self.model_copy(update={"bounds": self.bounds | {name: other}})
        return found

    def _found(self, answer: Answer, cases: Mapping[str, CaseView]) -> Finding:
        values = self.numbers | {**cases, "cases": rows(cases.values())} | answer.values
        if cases:
            values.setdefault("case", next(iter(cases.values())))
        if answer.holds is None and not answer.why:
            remarks, verdict = [self.remark], NOT_TESTABLE
        elif answer.holds is None:
            remarks, verdict = [self.undecided[answer.why]], UNDECIDED
        else:
            remarks = [*filter(None, [self.remark]), *(text for name, text in self.remarks.items() if values[name])]
            verdict = (REMARK if remarks else HOLDS) if answer.holds else FAILS
        sentences = Sentences(self.parts, values)
        try:
            return Finding(sentences.fill(self.ours), verdict, "; ".join(map(sentences.fill, remarks)))
        except KeyError as name:
            raise ClaimError(
                f"claim {self.id}: no value {name} among those of its check: {', '.join(values)}"
            ) from None


def claims(*modules: ModuleType) -> tuple[Claim, ...]:
    """The claims of these modules, in the order of the files beside them.

    Raises
    ------
    pydantic.ValidationError
        With all faults of the files.
    """
    checks, common = ChainMap(*map(vars, modules)), _read(FOLDER / "common.yaml")
    texts: dict[str, dict[str, Any]] = {}
    for module in modules:
        file = Path(str(module.__file__)).with_suffix(".yaml")
        for name, raw in _read(file).items():
            check = raw.get("check")
            texts[f"{file.name}: {name}"] = text = raw | {"id": name, "check": checks.get(check, check)}
            for key in {"remarks", "undecided"} & raw.keys():  # names without a text have the common one
                text[key] = {one: sentence or common.get(one) for one, sentence in raw[key].items()}
    return tuple(TypeAdapter(dict[str, Claim]).validate_python(texts).values())


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


def _without(missing: Missing) -> Finding:
    """Finding for evidence that is missing, or lacks the feature searched for."""
    if isinstance(missing, Absent):
        return Finding(str(missing), FAILS)
    return Finding("", f"{NOT_COMPUTED}: {missing}")


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
    found = case.parameters
    wanted = _parameters(name, found.normalization)
    if wanted != found:
        differ = [key for key in Parameters.model_fields if getattr(wanted, key) != getattr(found, key)]
        raise Missing(f"case {name} has another {', '.join(differ)} in this study")
    after = paper.get("start", {}).get("prerun", {}).get("parameters")
    if _after(case) != after:
        start = "static start" if after is None else f"last state of {after}"
        raise Missing(f"case {name} does not begin with the {start} in this study")
    if case.status == "ok" and case["time_reached"] < until:
        raise Missing(f"case {name} ends at {case['time_reached']:g} s, {until:g} s are needed")
    return case


@cache
def _parameters(name: str, normalization: str) -> Parameters:
    """Those of a case of the paper, with the study's normalisation."""
    return Parameters(**paper_cases()[name]["parameters"], normalization=normalization)


def _after(case: CaseView) -> Mapping[str, Any] | None:
    """Parameters of the motion after which a case begins; empty for another start, None for the static start."""
    if "start" not in case.node.attrs:
        return None
    start = json.loads(case.node.attrs["start"])
    prepared = (start["prerun"] or {}).get("parameters", {})
    return {} if start["perturbation"] else prepared
