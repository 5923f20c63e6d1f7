"""Claims of Section 4.2: N = 385 N around the critical speed, and the critical speed in general."""

from __future__ import annotations

from collections.abc import Sequence

from disc_model.analysis.classify import irregularity
from disc_model.claims import measures
from disc_model.claims.cases import asked, repeated
from disc_model.claims.disc import moving_load_speed
from disc_model.claims.measures import first_separation, said_growth, said_onset, separates_at
from disc_model.claims.model import CaseView, Claim, Finding, finding

ELSEWHERE = "from the published start; a separating state exists at 385 N and 15 rad/s as well, see Fig. 15b"


@Claim(
    "F11",
    "Sec. 4.2, Fig. 11",
    "N = 385 N, Omega = 15 rad/s: no separation, vibration in a small range that does not grow",
    paper="no separation",
    tolerance="range below 5 % of N, not growing by more than 0.05 N",
    reason="'small' read off Fig. 11; sampling finds the extremes to about 0.02 N",
    needs=asked(steady=True, F11=190),
)
def quiet(case: CaseView) -> Finding:
    early, late = measures.early_range(case, "P"), measures.late_range(case, "P")
    ours = f"{first_separation(case)}; P {early.said(2)} N at first, {late.said(2)} N in the end; {said_growth(case)}"
    small = max(early.width, late.width) < 0.05 * case["N"]
    return finding(ours, not case.separates and small and late.width <= early.width + 0.05, ELSEWHERE)


@Claim(
    "F12",
    "Sec. 4.2, Fig. 12",
    "The same case: in-plane motion is periodic",
    paper="periodic",
    tolerance="spread of the release intervals 1e-6",
    reason="what is left of the approach to the cycle after 200 s is below it",
    needs=asked(steady=True, F11=190),
)
def periodic(case: CaseView) -> Finding:
    intervals = measures.release_intervals(case)
    spread = irregularity(intervals)
    return finding(f"{1 / intervals.mean():.4f} Hz, spread {spread:.1e}", spread <= 1e-6)


@Claim(
    "F13",
    "Sec. 4.2, Fig. 13; Sec. 4.4",
    "N = 385 N, Omega = 15.1 rad/s: first separation",
    paper="54.5 s",
    tolerance="0.1 s",
    reason="the last digit printed; the method behind it may be off by as much",
    needs=asked(F13=59),
)
def when_it_separates(case: CaseView) -> Finding:
    return separates_at(case, 54.5, 0.1)


@Claim(
    "F13b",
    "Sec. 4.2",
    "N = 385 N: the critical speed for separation lies between 15 and 15.1 rad/s",
    paper="15 < Omega_c < 15.1 rad/s",
    tolerance="none",
    reason="two runs from the published start decide it",
    needs=asked(F11=190, F13=59),
)
def onset(below: CaseView, above: CaseView) -> Finding:
    said = [f"{case['Omega']:g} rad/s: {said_onset(case)}" for case in (below, above)]
    return finding("; ".join(said), not below.separates and above.separates, ELSEWHERE)


@Claim(
    "F11b",
    "Sec. 4.2, Fig. 11b",
    "N = 385 N, Omega = 15 rad/s: the disc's vibration does not grow",
    paper="constant range",
    tolerance="2 % between the first 20 s and the last",
    reason="the drive's period hits the extremes at other points each time",
    needs=asked(steady=True, F11=190),
)
def disc_does_not_grow(case: CaseView) -> Finding:
    early, late = (of(case, "w_point").width for of in (measures.early_range, measures.late_range))
    ours = f"disc within {1e3 * early:.2f} mm at first, {1e3 * late:.2f} mm in the end"
    return finding(ours, late <= (1 + 0.02) * early)


@Claim(
    "F13c",
    "Sec. 4.2, Fig. 13b",
    "N = 385 N, Omega = 15.1 rad/s: the disc vibrates in a larger range than at 15 rad/s",
    paper="larger",
    tolerance="half as much again",
    reason="'larger' to the eye",
    needs=asked(steady=True, F11=190, F13=110),
)
def larger_range(*cases: CaseView) -> Finding:
    below, above = (measures.late_range(case, "w_point").width for case in cases)
    ours = f"disc within {1e3 * below:.1f} mm at 15 rad/s, {1e3 * above:.1f} mm at 15.1 rad/s"
    return finding(ours, above > 1.5 * below)


@Claim(
    "F14",
    "Sec. 4.2, Fig. 14; Sec. 4.4, Fig. 26",
    "The same case: in-plane motion is periodic long after the first separation",
    paper="periodic",
    tolerance="release intervals repeat to 1e-8 s",
    reason="far above rounding, far below what an irregular motion would leave",
    needs=asked(separates=True, steady=True, F13=110),
)
def later_periodic(case: CaseView) -> Finding:
    motion, said = measures.late_motion(case)
    return finding(said, motion.period > 0)


@Claim(
    "F15a",
    "Sec. 4.2, Fig. 15",
    "The critical speed falls with preload at first, then rises",
    paper="falls, then rises",
    tolerance="none",
    reason="runs from the published start decide on which side of the critical speed they are",
    needs=asked(F16=290, F17=850, F11=190) | repeated("S43N550"),
)
def falls_then_rises(*cases: CaseView) -> Finding:
    """Critical speeds of four preloads against 15 rad/s: above it, below it, above it again."""
    ours, found = separations_by_load(cases[:3])
    beyond, *repeats = cases[3:]
    remark = "seen at one speed, where only the preload in between separates; the curve itself is that of Fig. 15"
    if beyond.separates:
        again = first_separation(beyond, *repeats)
        remark += f"; it falls again at larger preloads: N = {beyond['N']:g} N: {again}"
    return finding(f"at 15 rad/s: {ours}", found == [False, True, False], remark)


def separations_by_load(cases: Sequence[CaseView]) -> tuple[str, list[bool]]:
    """When each of three preloads separates at 15 rad/s, and whether."""
    said = "; ".join(f"N = {case['N']:g} N: {first_separation(case)}" for case in cases)
    return said, [case.separates for case in cases]


@Claim(
    "F15b",
    "Sec. 4.2, conclusion 2",
    "Separation occurs far below the critical speed of a moving load",
    paper="much lower",
    tolerance="less than 10 % of it",
    reason="what 'much lower' may mean; one case that separates there decides it",
    needs=asked(F02=500, F09=200),
)
def far_below(*cases: CaseView) -> Finding:
    critical = moving_load_speed(cases[0].parameters)
    lower = [case for case in cases if case["Omega"] < 0.1 * critical]
    said = [
        f"{first_separation(case)} at {case['Omega']:g} rad/s, {100 * case['Omega'] / critical:.1f} %" for case in lower
    ]
    return finding(f"{'; '.join(said)} of {critical:.2f} rad/s", any(case.separates for case in lower))
