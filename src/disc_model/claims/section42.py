"""Claims of Section 4.2: N = 385 N around the critical speed, and the critical speed in general."""

from __future__ import annotations

from disc_model.claims import measures
from disc_model.claims.disc import moving_load_speed
from disc_model.claims.measures import CaseView, between_only, first_separation, rows
from disc_model.claims.model import CHECKS, Answer


@CHECKS("F11")
def quiet(case: CaseView, *, part: float, newtons: float) -> Answer:
    early, late = case.early.width, case.late.width
    return Answer(not case.separates and max(early, late) < part * case["N"] and late <= early + newtons)


@CHECKS("F13", "F27")
def when_it_separates(case: CaseView, *, printed: float, within: float) -> Answer:
    return Answer(abs(case["first_separation"] - printed) <= within)


@CHECKS("F13b")
def onset(below: CaseView, above: CaseView) -> Answer:
    return Answer(not below.separates and above.separates)


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
    return Answer(measures.late_motion(case)[0].period > 0)


@CHECKS("F15a")
def falls_then_rises(*cases: CaseView) -> Answer:
    """Critical speeds of four preloads against 15 rad/s: above it, below it, above it again."""
    beyond = cases[3]
    again = [{"case": beyond, "first": first_separation(*cases[3:])}] if beyond.separates else []
    return Answer(between_only(cases[:3]), loads=rows(cases[:3]), again=again)


@CHECKS("F15b")
def far_below(*cases: CaseView, share: float) -> Answer:
    critical = moving_load_speed(cases[0].parameters)
    lower = [case for case in cases if case["Omega"] < share * critical]
    said = [{"case": case, "percent": 100 * case["Omega"] / critical} for case in lower]
    return Answer(any(case.separates for case in lower), lower=said, critical=critical)
