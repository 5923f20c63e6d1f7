"""Claims of Section 4.2: N = 385 N around the critical speed, and the critical speed in general."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from disc_model.analysis.classify import irregularity
from disc_model.claims import measures
from disc_model.claims.disc import moving_load_speed
from disc_model.claims.measures import first_separation, said_growth, said_onset
from disc_model.claims.model import CHECKS, Answer, CaseView


@CHECKS("F11")
def quiet(case: CaseView, *, part: float, newtons: float) -> Answer:
    early, late = measures.early_range(case, "P"), measures.late_range(case, "P")
    small = max(early.width, late.width) < part * case["N"]
    return Answer(
        not case.separates and small and late.width <= early.width + newtons,
        first=first_separation(case),
        early=early,
        late=late,
        growth=said_growth(case),
    )


@CHECKS("F12")
def periodic(case: CaseView, *, within: float) -> Answer:
    intervals = measures.release_intervals(case)
    spread = irregularity(intervals)
    return Answer(spread <= within, rate=1 / intervals.mean(), spread=spread)


@CHECKS("F13", "F27")
def when_it_separates(case: CaseView, *, printed: float, within: float) -> Answer:
    holds = abs(case["first_separation"] - printed) <= within
    return Answer(holds, first=first_separation(case))


@CHECKS("F13b")
def onset(below: CaseView, above: CaseView) -> Answer:
    cases = [{"Omega": case["Omega"], "onset": said_onset(case)} for case in (below, above)]
    return Answer(not below.separates and above.separates, cases=cases)


@CHECKS("F11b")
def disc_does_not_grow(case: CaseView, *, part: float) -> Answer:
    early, late = (of(case, "w_point").width for of in (measures.early_range, measures.late_range))
    return Answer(late <= (1 + part) * early, early=1e3 * early, late=1e3 * late)


@CHECKS("F13c")
def larger_range(*cases: CaseView, factor: float) -> Answer:
    below, above = (measures.late_range(case, "w_point").width for case in cases)
    return Answer(above > factor * below, below=1e3 * below, above=1e3 * above)


@CHECKS("F14")
def later_periodic(case: CaseView) -> Answer:
    motion, said = measures.late_motion(case)
    return Answer(motion.period > 0, said=said)


@CHECKS("F15a")
def falls_then_rises(*cases: CaseView) -> Answer:
    """Critical speeds of four preloads against 15 rad/s: above it, below it, above it again."""
    beyond, *repeats = cases[3:]
    again = [{"N": beyond["N"], "first": first_separation(beyond, *repeats)}] if beyond.separates else []
    return Answer(between_only(cases[:3]), loads=by_load(cases[:3]), again=again)


def by_load(cases: Sequence[CaseView]) -> list[dict[str, Any]]:
    """When cases of several preloads first separate."""
    return [{"N": case["N"], "first": first_separation(case)} for case in cases]


def between_only(cases: Sequence[CaseView]) -> bool:
    """Whether of three preloads only the one in between separates."""
    return [case.separates for case in cases] == [False, True, False]


@CHECKS("F15b")
def far_below(*cases: CaseView, share: float) -> Answer:
    critical = moving_load_speed(cases[0].parameters)
    lower = [case for case in cases if case["Omega"] < share * critical]
    rows = [
        {"first": first_separation(case), "Omega": case["Omega"], "percent": 100 * case["Omega"] / critical}
        for case in lower
    ]
    return Answer(any(case.separates for case in lower), cases=rows, critical=critical)
