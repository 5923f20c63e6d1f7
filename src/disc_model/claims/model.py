"""What a claim is: a text, a check, and the cases that the check looks at.

The text is data, in the YAML file beside the module that holds the check; see `Text` for what it may say.  The check
is given cases and bounds; it returns an `Answer`: a verdict, and the numbers that the text's sentences are filled with.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
import xarray as xr
import yaml
from pydantic import BaseModel, ConfigDict, ValidationError

from disc_model.data import dataset
from disc_model.data.dataset import Missing
from disc_model.data.texts import Parts, Sentences
from disc_model.data.variables import STATUSES
from disc_model.errors import DiscModelError
from disc_model.parameters import Parameters

__all__ = ["Missing"]  # beside what is defined here

HOLDS = "holds"
REMARK = "holds with a remark"
FAILS = "does not hold"
UNDECIDED = "undecided"
NOT_COMPUTED = "not computed"
STRETCHES, STRETCH, STEADY = 3, 20.0, 0.01
"""A motion is steady if the ranges of contact force and disc over its last three stretches of 20 s differ by no more
than 1 % of the widest. What grows or decays by 3e-4/s or more does not pass."""
FOLDER = Path(__file__).parent
PAPER = FOLDER.parent / "config" / "paper.yaml"


class Absent(Missing):
    """The evidence is there, and what a claim finds in it is not: the claim does not hold."""


class ClaimError(DiscModelError):
    """Texts and checks that do not fit together."""


# ----------------------------------------------------------------------------------------------------
# What a check looks at


class Range(NamedTuple):
    """Least and greatest value; formatted as ``low..high``."""

    low: float
    high: float

    @property
    def width(self) -> float:
        return self.high - self.low

    def __format__(self, spec: str) -> str:
        return f"{self.low:{spec}}..{self.high:{spec}}"


@dataclass(frozen=True)
class CaseView:
    """One case, opened for reading."""

    name: str
    node: xr.DataTree

    def __getitem__(self, name: str) -> float:
        """A scalar: a parameter, or one of `disc_model.data.variables.SCALARS`."""
        return float(self.node.dataset[name].item())

    @property
    def parameters(self) -> Parameters:
        return Parameters.model_validate_json(self.node.attrs["parameters"])

    @property
    def status(self) -> str:
        return STATUSES[int(self["status"])]

    @property
    def separates(self) -> bool:
        """Whether contact was ever lost."""
        return self["n_separations"] > 0

    @property
    def events(self) -> xr.Dataset:
        """Switches kept; raises `Missing` if the case keeps none."""
        return self._held(dataset.events)

    def samples(self, window: str) -> xr.Dataset:
        """Samples of a window, or of the section ``poincare``; raises `Missing`."""
        return self._held(dataset.samples, window)

    def range_of(self, name: str, start: float, stop: float) -> Range:
        """Range of a variable from the whole bins of the window `history` between two times; raises `Missing`."""
        history = self.ranges("history")
        time = history["time"].values
        half = (time[1] - time[0]) / 2 if time.size > 1 else np.inf  # a single bin does not say how long it is
        inside = (time >= start + 0.99 * half) & (time <= stop - 0.99 * half)
        if not inside.any():
            raise Missing(f"case {self.name} has no history from {start:g} to {stop:g} s")
        low, high = (history[f"{name}_{end}"].values[inside] for end in ("min", "max"))
        return Range(float(low.min()), float(high.max()))

    def last_widths(self, name: str, length: float, count: int) -> list[float]:
        """Widths of a variable's ranges over so many stretches of a length (s) up to the end, the last one first."""
        end = self["time_reached"]
        spans = [(end - (i + 1) * length, end - i * length) for i in range(count)]
        return [self.range_of(name, *span).width for span in spans]

    def last_quarters(self, name: str) -> list[float]:
        """The same over the last two quarters of the time after the first separation."""
        return self.last_widths(name, (self["time_reached"] - self["first_separation"]) / 4, 2)

    def drift(self) -> float:
        """By how much the ranges of contact force and disc differ among the last stretches, share of the widest."""
        found = [self.last_widths(name, STRETCH, STRETCHES) for name in ("P", "w_point")]
        return max((max(widths) - min(widths)) / max(widths) if max(widths) > 0 else 0.0 for widths in found)

    def ranges(self, window: str) -> xr.Dataset:
        """Least and greatest values within the bins of a window; raises `Missing`."""
        return self._held(dataset.ranges, window)

    def _held(self, ask: Callable[..., xr.Dataset], *args: Any) -> xr.Dataset:
        try:
            return ask(self.node, *args)
        except Missing as reason:
            raise Missing(f"case {self.name} {reason}") from None


def _read(path: Path) -> dict[str, Any]:
    found: dict[str, Any] = yaml.safe_load(path.read_text(encoding="utf-8"))
    return found


@cache
def paper_cases() -> Mapping[str, Mapping[str, Any]]:
    """The named cases of config/paper.yaml: what it says of each beside the study's base values."""
    cases: dict[str, Mapping[str, Any]] = _read(PAPER)["cases"]
    return cases


# ----------------------------------------------------------------------------------------------------
# What a check finds, and how that is said


class Answer:
    """What a check finds.

    Parameters
    ----------
    holds : whether the claim holds; None if the evidence does not decide it
    why : in that case, which of the text's reasons for it applies
    values : what the sentences are filled with; a remark is added if the value of its name is true
    """

    def __init__(self, holds: bool | np.bool_ | None, why: str = "", /, **values: Any) -> None:
        self.holds, self.why, self.values = holds, why, values


@dataclass(frozen=True)
class Finding:
    """Outcome of a check in words: what we found, whether the claim holds, and what should be known besides."""

    ours: str
    verdict: str
    remark: str = ""


Names = Literal[True] | tuple[str, ...]


class Text(BaseModel):
    """What a file says of a claim.

    Attributes
    ----------
    location : the place in the paper
    claim : the statement in our own words
    paper : the value the paper gives, or "" if it only shows it
    tolerance, reason : what counts as agreement, and why that much
    bounds : numbers that the check is given, and that sentences may be filled with
    cases : those of config/paper.yaml that the check is given, each with the time in s to which it must have run
    separates : those of them that the claim says something of after separation: without one it does not hold; true
        stands for all in which contact can be lost
    steady : those whose steady state it is about: one that has not come to it by its end decides nothing
    scans : the grid studies that the check is given besides
    ours : what we found
    remark, remarks : what should be known besides: in any case; where the value of that name is true
    undecided : by name, reasons why the evidence may decide nothing
    parts : by name of a value, how its rows are said
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    location: str
    claim: str
    paper: str = ""
    tolerance: str = ""
    reason: str = ""
    bounds: dict[str, float] = {}
    cases: dict[str, float] = {}
    separates: Names = ()
    steady: Names = ()
    scans: tuple[str, ...] = ()
    ours: str
    remark: str = ""
    remarks: dict[str, str] = {}
    undecided: dict[str, str] = {}
    parts: Parts = {}


@dataclass(frozen=True)
class Claim:
    """A statement of the paper, under our name for it, with the check that decides it."""

    id: str
    said: Text
    check: Callable[..., Answer]

    @property
    def text(self) -> str:
        return self.said.claim

    @property
    def tolerance(self) -> str:
        return Sentences({}, self.said.bounds).fill(self.said.tolerance)

    @property
    def separating(self) -> tuple[str, ...]:
        """The cases without whose separation the claim does not hold."""
        if self.said.separates is True:
            known = paper_cases()
            return tuple(name for name in self.said.cases if known[name]["parameters"].get("contact") != "bonded")
        return self.said.separates

    @property
    def steady(self) -> tuple[str, ...]:
        """The cases whose steady state it is about."""
        return tuple(self.said.cases) if self.said.steady is True else self.said.steady

    def judge(self, *evidence: Any) -> Finding:
        """What the check makes of this evidence; the verdict says what that lacks."""
        try:
            return self._found(self.check(*evidence, **self.said.bounds))
        except Missing as missing:
            return _without(missing)

    def evaluate(self, cases: Mapping[str, CaseView]) -> Finding:
        """Check the claim; without the evidence it needs, the verdict says what is missing."""
        try:
            needed = {name: _needed(cases, name, until) for name, until in self.said.cases.items()}
            for name in self.said.scans:
                if name not in cases:
                    raise Missing(f"study {name} is not among those of this run")
            quiet = [needed[name] for name in self.separating if not needed[name].separates]
            if quiet:
                said = "; ".join(f"case {case.name}: no separation in {case['time_reached']:g} s" for case in quiet)
                return Finding(said, FAILS)
            scans = [cases[name].node.to_dataset() for name in self.said.scans]
            found = self._found(self.check(*needed.values(), *scans, **self.said.bounds))
            return _of_steady_state(found, [needed[name] for name in self.steady])
        except Missing as missing:
            return _without(missing)

    def _found(self, answer: Answer) -> Finding:
        said, values = self.said, self.said.bounds | answer.values
        if answer.holds is None:
            remarks, verdict = [said.undecided[answer.why]], UNDECIDED
        else:
            remarks = [*filter(None, [said.remark]), *(text for name, text in said.remarks.items() if values[name])]
            verdict = (REMARK if remarks else HOLDS) if answer.holds else FAILS
        sentences = Sentences(said.parts, values)
        try:
            return Finding(sentences.fill(said.ours), verdict, "; ".join(map(sentences.fill, remarks)))
        except KeyError as name:
            raise ClaimError(
                f"claim {self.id}: no value {name} among those of its check: {', '.join(values)}"
            ) from None


class Checks(dict[str, Callable[..., Answer]]):
    """Checks by the claim that they decide; as a decorator it takes up one more."""

    def __call__(self, *names: str) -> Callable[[Callable[..., Answer]], Callable[..., Answer]]:
        def take(check: Callable[..., Answer]) -> Callable[..., Answer]:
            self.update(dict.fromkeys(names, check))
            return check

        return take

    def claims(self, *files: str, folder: Path = FOLDER) -> tuple[Claim, ...]:
        """The claims of these files, each with its check, in the files' order.

        Raises
        ------
        ClaimError
            For a text without a check, a check without a text, and whatever else is wrong with a text: all at once.
        """
        faults, found = [], []
        common, texts = _read(FOLDER / "common.yaml"), [(file, _read(folder / file)) for file in files]
        for file, name, raw in [(file, name, raw) for file, read in texts for name, raw in read.items()]:
            raw["remark"] = common.get(raw.get("remark"), raw.get("remark", ""))
            for key in ("remarks", "undecided"):  # one without a text has the common one
                raw[key] = {one: text or common.get(one) for one, text in raw.get(key, {}).items()}
            try:
                text = Text.model_validate(raw)
            except ValidationError as error:
                faults += [f"{file}: {name}.{'.'.join(map(str, e['loc']))}: {e['msg']}" for e in error.errors()]
                continue
            faults += [] if name in self else [f"{file}: {name}: no check"]
            faults += [
                f"{file}: {name}: no case {one} in the paper's" for one in text.cases if one not in paper_cases()
            ]
            found.append(Claim(name, text, self.get(name, Answer)))
        said = {name for _, read in texts for name in read}
        faults += [f"{name}: a check without a text" for name in self if name not in said]
        if faults:
            raise ClaimError("\n".join(faults))
        return tuple(found)


CHECKS = Checks()
"""Of the paper's claims."""


# ----------------------------------------------------------------------------------------------------
# Whether the evidence is what a claim needs


def _without(missing: Missing) -> Finding:
    """What follows from evidence that is not there, or does not have what was looked for."""
    if isinstance(missing, Absent):
        return Finding(str(missing), FAILS)
    return Finding("", f"{NOT_COMPUTED}: {missing}")


def _of_steady_state(found: Finding, cases: Sequence[CaseView]) -> Finding:
    """What was found, with the time at which each of some cases was steady, if any; undecided if one was not."""
    drifts = {f"{case.name} at {case['time_reached']:g} s": case.drift() for case in cases}
    moving = "; ".join(
        f"case {at}: ranges of successive {STRETCH:g} s differ by {100 * drift:.2g} %"
        for at, drift in drifts.items()
        if not drift <= STEADY
    )
    if moving:
        return Finding(found.ours, UNDECIDED, f"not yet steady: {moving}")
    return replace(found, ours=f"{found.ours} (steady: {', '.join(drifts)})") if drifts else found


def _needed(cases: Mapping[str, CaseView], name: str, until: float) -> CaseView:
    """A case that is what the paper's case of this name is, and has run so far (s); raises `Missing`."""
    if name not in cases:
        raise Missing(f"case {name} is not in this study")
    case, paper = cases[name], paper_cases()[name]
    if case.status not in ("ok", "stopped"):
        raise Missing(f"{case.status} (case {name})")
    found = case.parameters
    wanted = Parameters(**paper["parameters"], normalization=found.normalization)  # that is the study's choice
    if wanted != found:
        differ = [key for key in Parameters.model_fields if getattr(wanted, key) != getattr(found, key)]
        raise Missing(f"case {name} has another {', '.join(differ)} in this study")
    after = paper.get("start", {}).get("prepare", {}).get("parameters")
    if _after(case) != after:
        start = "published start" if after is None else f"last state of {after}"
        raise Missing(f"case {name} does not begin with the {start} in this study")
    if case.status == "ok" and case["time_reached"] < until:
        raise Missing(f"case {name} ends at {case['time_reached']:g} s, {until:g} s are needed")
    return case


def _after(case: CaseView) -> Mapping[str, Any] | None:
    """Parameters of the motion that a case begins after, empty if it begins in another way; None: published start."""
    if "start" not in case.node.attrs:
        return None
    start = json.loads(case.node.attrs["start"])
    prepared = (start["prepare"] or {}).get("parameters", {})
    return {} if start["kick"] else prepared
