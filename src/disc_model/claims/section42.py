"""Claims of Section 4.2: N = 385 N around the critical speed, and the critical speed in general."""

from __future__ import annotations

import numpy as np

from disc_model.claims import measures
from disc_model.claims.growth import growth
from disc_model.claims.model import Cases, Check, Claim, Finding, Missing, Needed
from disc_model.claims.wording import finding, first_separation
from disc_model.parameters import Parameters
from disc_model.plate import plate_modes

F11 = Needed({"N": 385, "Omega": 15}, 190)
F13 = Needed({"N": 385, "Omega": 15.1}, 59)


def _quiet(cases: Cases, claim: Claim) -> Finding:
    case = cases["F11"]
    early, late = measures.early_range(case, "P"), measures.late_range(case, "P")
    ours = (
        f"{first_separation(case)}; P {early.low:.2f}..{early.high:.2f} N at first, "
        f"{late.low:.2f}..{late.high:.2f} N in the end"
    )
    ours += f"; {growth(case)}"
    small = max(early.width, late.width) < claim.bound * case["N"]
    return finding(ours, not case.separates and small and late.width <= early.width + 0.05)


def _periodic(cases: Cases, claim: Claim) -> Finding:
    intervals = measures.release_intervals(cases["F11"])
    spread = measures.irregularity(intervals)
    return finding(f"{1 / intervals.mean():.4f} Hz, spread {spread:.1e}", spread <= claim.bound)


def _first(name: str, paper: float) -> Check:
    def check(cases: Cases, claim: Claim) -> Finding:
        time = cases[name]["first_separation"]
        return finding(first_separation(cases[name]), bool(abs(time - paper) <= claim.bound))

    return check


def _later_periodic(cases: Cases, claim: Claim) -> Finding:
    intervals = measures.release_intervals(cases["F13"])
    period = measures.shortest_period(intervals, claim.bound)
    ours = f"mean release rate {1 / intervals.mean():.2f} Hz, "
    if not period:
        return finding(f"{ours}no period of up to 8 releases", False)
    length = f"{1e3 * period * intervals.mean():.3f} ms"
    return finding(
        f"{ours}repeats after {period} of them ({length}) to {measures.closure(intervals, period):.0e} s",
        True,
    )


def _onset(cases: Cases, claim: Claim) -> Finding:
    below, above = cases["F11"], cases["F13"]
    said = [f"{case['Omega']:g} rad/s: {first_separation(case)}, {growth(case)}" for case in (below, above)]
    return finding("; ".join(said), not below.separates and above.separates)


def _falls_then_rises(cases: Cases, claim: Claim) -> Finding:
    """Critical speeds of four preloads against 15 rad/s: above it, below it, above it again."""
    names = ("F16", "F17", "F11", "S43N600")
    ours = "; ".join(f"N = {cases[name]['N']:g} N: {first_separation(cases[name])}" for name in names)
    remark = "seen at one speed, where only the preload in between separates; the curve itself is that of Fig. 15"
    return finding(
        f"at 15 rad/s: {ours}", [cases[name].separates for name in names] == [False, True, False, False], remark
    )


def _far_below(cases: Cases, claim: Claim) -> Finding:
    modes = plate_modes(Parameters(N=0, Omega=0)).query("diameters > 0")
    critical = float(np.min(modes["omega"] / modes["diameters"]))
    speeds = [case["Omega"] for case in cases.values() if case.separates]
    if not speeds:
        raise Missing("no case of this study separates")
    ours = f"at {max(speeds):g} rad/s and less, {100 * max(speeds) / critical:.1f} % of {critical:.2f} rad/s"
    return finding(ours, max(speeds) < claim.bound * critical)


CLAIMS = (
    Claim(
        "F11",
        "Sec. 4.2, Fig. 11",
        "N = 385 N, Omega = 15 rad/s: no separation, vibration in a small range that does not grow",
        "no separation",
        "range below 5 % of N, not growing by more than 0.05 N",
        "'small' read off Fig. 11; sampling finds the extremes to about 0.02 N",
        _quiet,
        0.05,
        {"F11": F11},
    ),
    Claim(
        "F12",
        "Sec. 4.2, Fig. 12",
        "The same case: in-plane motion is periodic",
        "periodic",
        "spread of the release intervals 1e-6",
        "what is left of the approach to the cycle after 200 s is below it",
        _periodic,
        1e-6,
        {"F11": F11},
    ),
    Claim(
        "F13",
        "Sec. 4.2, Fig. 13; Sec. 4.4",
        "N = 385 N, Omega = 15.1 rad/s: first separation",
        "54.5 s",
        "0.1 s",
        "the last digit printed; the method behind it may be off by as much",
        _first("F13", 54.5),
        0.1,
        {"F13": F13},
    ),
    Claim(
        "F13b",
        "Sec. 4.2",
        "N = 385 N: the critical speed for separation lies between 15 and 15.1 rad/s",
        "15 < Omega_c < 15.1 rad/s",
        "none",
        "two runs from the published start decide it",
        _onset,
        0.0,
        {"F11": F11, "F13": F13},
    ),
    Claim(
        "F14",
        "Sec. 4.2, Fig. 14; Sec. 4.4, Fig. 26",
        "The same case: in-plane motion is periodic long after the first separation",
        "periodic",
        "release intervals repeat to 1e-8 s",
        "far above rounding, far below what an irregular motion would leave",
        _later_periodic,
        1e-8,
        {"F13": Needed(F13.parameters, 110, separates=True)},
    ),
    Claim(
        "F15a",
        "Sec. 4.2, Fig. 15",
        "The critical speed falls with preload at first, then rises",
        "falls, then rises",
        "none",
        "runs from the published start decide on which side of the critical speed they are",
        _falls_then_rises,
        0.0,
        {
            "F16": Needed({"N": 50, "Omega": 15}, 290),
            "F17": Needed({"N": 200, "Omega": 15}, 850),
            "F11": F11,
            "S43N600": Needed({"N": 600, "Omega": 15}, 590),
        },
    ),
    Claim(
        "F15b",
        "Sec. 4.2, conclusion 2",
        "Separation occurs far below the critical speed of a moving load",
        "much lower",
        "less than 10 % of it",
        "what 'much lower' may mean",
        _far_below,
        0.1,
    ),
)
