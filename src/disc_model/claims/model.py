"""What a claim is, what a check finds, and what it may look at."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from disc_model.data import dataset
from disc_model.data.dataset import Missing
from disc_model.data.variables import STATUSES
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


class Absent(Missing):
    """The evidence is there, and what a claim finds in it is not: the claim does not hold."""


@dataclass(frozen=True)
class Finding:
    """Outcome of a check: what we found, whether the claim holds, and what should be known besides."""

    ours: str
    verdict: str
    remark: str = ""


@dataclass(frozen=True)
class Needed:
    """A case that a claim is about.

    Attributes
    ----------
    parameters : values it must have beside base values
    until : s, how far it must run
    separates : whether the claim is about what separation does: without one it does not hold
    steady : whether the claim is about its steady state: one that has not come to it by its end decides nothing
    after : parameters of the motion in whose last state it must begin; None for the published start
    """

    parameters: Mapping[str, Any]
    until: float = 0.0
    separates: bool = False
    steady: bool = False
    after: Mapping[str, Any] | None = None


class Range(NamedTuple):
    """Least and greatest value."""

    low: float
    high: float

    @property
    def width(self) -> float:
        return self.high - self.low

    def said(self, digits: int) -> str:
        return f"{self.low:.{digits}f}..{self.high:.{digits}f}"


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


def finding(ours: str, holds: bool, remark: str = "") -> Finding:
    """What was found, with the verdict that follows: for a statement that holds or not, with or without a remark."""
    kept = REMARK if remark else HOLDS
    return Finding(ours, kept if holds else FAILS, remark)


def undecided(ours: str, why: str) -> Finding:
    """What was found, where it decides nothing, and why not."""
    return Finding(ours, UNDECIDED, why)


Check = Callable[..., Finding]
"""Is given what its claim needs: the cases, then the grid studies, each in the order in which the claim names them."""


def _without_check(*evidence: Any) -> Finding:
    raise Missing("nothing checks it")


@dataclass(frozen=True)
class Claim:
    """A statement of the paper. As a decorator it becomes the one that the function below decides.

    Attributes
    ----------
    id, location : our name, and the place in the paper
    text : the statement in our own words
    paper : the value the paper gives, or "" if it only shows it
    tolerance, reason : what counts as agreement, and why that much
    needs : the cases it is about
    scans : the grid studies that it looks at besides, which stand among the cases under their names
    """

    id: str
    location: str
    text: str
    check: Check = _without_check
    paper: str = ""
    tolerance: str = ""
    reason: str = ""
    needs: Mapping[str, Needed] = field(default_factory=dict)
    scans: tuple[str, ...] = ()

    def __call__(self, check: Check) -> Claim:
        return replace(self, check=check)

    def judge(self, *evidence: Any) -> Finding:
        """What the check makes of this evidence; the verdict says what that lacks."""
        try:
            return self.check(*evidence)
        except Missing as missing:
            return _without(missing)

    def evaluate(self, cases: Mapping[str, CaseView]) -> Finding:
        """Check the claim; without the evidence it needs, the verdict says what is missing."""
        try:
            needed = {name: _needed(cases, name, what) for name, what in self.needs.items()}
            for name in self.scans:
                if name not in cases:
                    raise Missing(f"study {name} is not among those of this run")
            quiet = [case for name, case in needed.items() if self.needs[name].separates and not case.separates]
            if quiet:
                said = "; ".join(f"case {case.name}: no separation in {case['time_reached']:g} s" for case in quiet)
                return Finding(said, FAILS)
            scans = [cases[name].node.to_dataset() for name in self.scans]
            found = self.check(*needed.values(), *scans)
            return _of_steady_state(found, [case for name, case in needed.items() if self.needs[name].steady])
        except Missing as missing:
            return _without(missing)


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
        return undecided(found.ours, f"not yet steady: {moving}")
    return replace(found, ours=f"{found.ours} (steady: {', '.join(drifts)})") if drifts else found


def _needed(cases: Mapping[str, CaseView], name: str, needed: Needed) -> CaseView:
    """A case that is as it must be; raises `Missing`."""
    if name not in cases:
        raise Missing(f"case {name} is not in this study")
    case = cases[name]
    if case.status not in ("ok", "stopped"):
        raise Missing(f"{case.status} (case {name})")
    found = case.parameters
    wanted = Parameters(**needed.parameters, normalization=found.normalization)  # that is the study's choice
    if wanted != found:
        differ = [key for key in Parameters.model_fields if getattr(wanted, key) != getattr(found, key)]
        raise Missing(f"case {name} has another {', '.join(differ)} in this study")
    if _after(case) != needed.after:
        start = "published start" if needed.after is None else f"last state of {dict(needed.after)}"
        raise Missing(f"case {name} does not begin with the {start} in this study")
    if case.status == "ok" and case["time_reached"] < needed.until:
        raise Missing(f"case {name} ends at {case['time_reached']:g} s, {needed.until:g} s are needed")
    return case


def _after(case: CaseView) -> Mapping[str, Any] | None:
    """Parameters of the motion that a case begins after, empty if it begins in another way; None: published start."""
    if "start" not in case.node.attrs:
        return None
    start = json.loads(case.node.attrs["start"])
    prepared = (start["prepare"] or {}).get("parameters", {})
    return {} if start["kick"] else prepared
