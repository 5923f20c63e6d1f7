"""Claims of Section 4.3: one parameter after the other."""

from __future__ import annotations

import math

import numpy as np

from disc_model.claims import measures
from disc_model.claims.model import Cases, Check, Claim, Finding, Missing, Needed
from disc_model.claims.wording import finding, first_separation

F11 = Needed({"N": 385, "Omega": 15}, 190)
F16 = Needed({"N": 50, "Omega": 15}, 290)
F17 = Needed({"N": 200, "Omega": 15}, 850)
F18 = Needed({"N": 200, "Omega": 10, "D_star": 0}, 300)
F19 = Needed({"N": 385, "Omega": 15, "c_p": 0.5}, 100)
KP2E3 = Needed({"N": 300, "Omega": 50, "k_p": 2e3}, 350)
KP2E4 = Needed({"N": 300, "Omega": 50}, 100)
KP2E5 = Needed({"N": 300, "Omega": 50, "k_p": 2e5}, 200)


def _grew(cases: Cases, name: str) -> bool:
    """Whether the contact force ranges wider at the end than at first, by more than sampling can feign."""
    early, late = (measures.early_range(cases[name], "P"), measures.late_range(cases[name], "P"))
    return late.width > 1.02 * early.width + 1e-3 * cases[name]["N"]


def _range(cases: Cases, name: str) -> str:
    late = measures.late_range(cases[name], "P")
    return f"P {late.low:.2f}..{late.high:.2f} N in the end"


def _stable(name: str, remark: str = "") -> Check:
    def check(cases: Cases, claim: Claim) -> Finding:
        case = cases[name]
        ours = f"{first_separation(case)}; {_range(cases, name)}"
        return finding(ours, not case.separates and not _grew(cases, name), remark)

    return check


def _small_periodic(cases: Cases, claim: Claim) -> Finding:
    case = cases["F16"]
    intervals = measures.release_intervals(case)
    spread = measures.irregularity(intervals)
    ours = f"{first_separation(case)}; {_range(cases, 'F16')}; {1 / intervals.mean():.3f} Hz, spread {spread:.1e}"
    return finding(ours, not case.separates and not _grew(cases, "F16") and spread <= claim.bound)


def _separates(name: str) -> Check:
    def check(cases: Cases, claim: Claim) -> Finding:
        return finding(first_separation(cases[name]), cases[name].separates)

    return check


def _preload(cases: Cases, claim: Claim) -> Finding:
    found = {name: cases[name].separates for name in ("F16", "F17", "F11")}
    ours = "; ".join(f"N = {cases[name]['N']:g} N: {first_separation(cases[name])}" for name in found)
    return finding(ours, list(found.values()) == [False, True, False])


def _disc_damping(cases: Cases, claim: Claim) -> Finding:
    names = ("S43a126", "S43a10")
    stable = [not cases[name].separates and not _grew(cases, name) for name in names]
    ours = "; ".join(
        f"{cases[name]['Omega']:g} rad/s: {first_separation(cases[name])}, {_range(cases, name)}" for name in names
    )
    remark = "the paper does not say at which speed"
    if any(stable) and not all(stable):
        bad = ", ".join(f"{cases[name]['Omega']:g}" for name, good in zip(names, stable, strict=True) if not good)
        remark += f"; at {bad} rad/s the vibration still grows, slowly"
    return finding(ours, any(stable), remark)


def _inplane_damping(cases: Cases, claim: Claim) -> Finding:
    case = cases["F19"]
    intervals = measures.release_intervals(case)
    period = measures.shortest_period(intervals, claim.bound)
    ours = f"c_p = 0: {first_separation(cases['F11'])}; c_p = 0.5: {first_separation(case)}, then "
    ours += f"one release per {1e3 * intervals.mean():.3f} ms, " + (f"period {period}" if period else "no period")
    return finding(ours, not cases["F11"].separates and case.separates and period > 0)


def _normal_damping(cases: Cases, claim: Claim) -> Finding:
    case = cases["F20"]
    intervals = measures.release_intervals(case)
    spread = measures.irregularity(intervals)
    ours = f"{first_separation(case)}; {_range(cases, 'F20')}; {1 / intervals.mean():.3f} Hz, spread {spread:.1e}"
    return finding(ours, not case.separates and not _grew(cases, "F20") and spread <= claim.bound)


def _soft_disc(cases: Cases, claim: Claim) -> Finding:
    case = cases["F21"]
    end = case["time_reached"]
    early = measures.early_range(case, "P")
    third, last = (measures.range_within(case, "P", a * end, b * end) for a, b in ((0.5, 0.75), (0.75, 1.0)))
    spread = measures.irregularity(measures.release_intervals(case))
    ours = (
        f"{first_separation(case)}; P {early.low:.1f}..{early.high:.1f} N grows to "
        f"{last.low:.0f}..{last.high:.0f} N; spread of the release intervals {spread:.2f}"
    )
    bounded = max(third.width, last.width) < 1.5 * min(third.width, last.width)
    return finding(ours, not case.separates and last.width > 2 * early.width and bounded and spread > claim.bound)


def _normal_stiffness(cases: Cases, claim: Claim) -> Finding:
    names = ("S43k2e4", "S43k3e4", "F02")
    times = [cases[name]["first_separation"] for name in names]
    stiff = cases["S43k2e5"]
    ours = "; ".join(f"k = {cases[name]['k']:g} N/m: {first_separation(cases[name])}" for name in (*names, "S43k2e5"))
    ordered = bool(np.all(np.diff(times) > 0)) and not any(map(math.isnan, times))
    return finding(ours, ordered and not stiff.separates and not _grew(cases, "S43k2e5"))


def _soft_inplane(cases: Cases, claim: Claim) -> Finding:
    case = cases["F22"]
    releases = measures.times_of(case.group("events"), "stick_to_slip")
    ours = first_separation(case)
    if releases.size < 20:
        raise Missing(f"case {case.name} keeps fewer than 20 stick-slip cycles")
    spread = measures.irregularity(np.diff(releases))
    return finding(
        f"{ours}; then spread of the release intervals {spread:.2f}", case.separates and spread > claim.bound
    )


def _inplane_stiffness(cases: Cases, claim: Claim) -> Finding:
    soft, base, stiff = (cases[name] for name in ("F22", "S43kp2e4", "S43kp2e5"))
    ours = "; ".join(f"k_p = {case['k_p']:g} N/m: {first_separation(case)}" for case in (soft, base, stiff))
    sooner = base.separates and base["first_separation"] < soft["first_separation"]
    return finding(
        f"{ours}, {_range(cases, 'S43kp2e5')}",
        sooner and not stiff.separates and not _grew(cases, stiff.name),
    )


def _lowest_position(cases: Cases, claim: Claim) -> Finding:
    case = cases["F23"]
    window = case.group("zoom")
    time, height = window["time"].values, window["u"].values - case["u_0"]
    starts = np.flatnonzero(np.diff((window["phase"].values == measures.SEPARATION).astype(int)) == 1)
    swing = float(np.ptp(height))
    ahead = int(round(2e-3 / (time[1] - time[0])))
    starts = starts[starts + ahead < time.size]
    if not starts.size:
        raise Missing("no separation in the window of case F23")
    lowest = [int(i + np.argmin(height[i : i + ahead])) for i in starts]
    drop = float(np.median([height[i] - height[j] for i, j in zip(starts, lowest, strict=True)]))
    delay = float(np.median([time[j] - time[i] for i, j in zip(starts, lowest, strict=True)]))
    events = case.group("events")
    lost = measures.is_kind(events, "separation")
    velocity = float(events["u_velocity"].values[lost].mean())
    where = float(events["u"].values[lost].mean()) - case["u_0"]
    ours = f"{first_separation(case)}; on average at {1e3 * where:.1f} mm, {velocity:+.2f} m/s"
    remark = f"still falling: the lowest point is {1e3 * drop:.1f} mm further down, {1e3 * delay:.2f} ms later"
    return finding(ours, 0 <= drop < claim.bound * swing, remark)


ORDER = "only the order is claimed"
SEEN = "the paper shows or says that it happens, without a time"

CLAIMS = (
    Claim(
        "F16",
        "Sec. 4.3, Fig. 16",
        "N = 50 N, Omega = 15 rad/s: small periodic vibration, no separation",
        "periodic, small",
        "range not growing; spread of the release intervals 1e-4",
        "the cycle attracts slowly: a tenth of the first deviation is left after 300 s",
        _small_periodic,
        1e-4,
        {"F16": F16},
    ),
    Claim(
        "F17",
        "Sec. 4.3, Fig. 17",
        "N = 200 N, Omega = 15 rad/s: unstable, separation occurs",
        "separation",
        "any time within the run",
        SEEN,
        _separates("F17"),
        0.0,
        {"F17": F17},
    ),
    Claim(
        "S43N",
        "Sec. 4.3, conclusion 4",
        "Preload is not monotonous at 15 rad/s: 50 N stable, 200 N separates, 385 N stable",
        "stable, separation, stable",
        "none",
        "three runs from the published start decide it",
        _preload,
        0.0,
        {"F16": F16, "F17": F17, "F11": F11},
    ),
    Claim(
        "F18",
        "Sec. 4.3, Fig. 18",
        "No damping of the disc, N = 200 N, Omega = 10 rad/s: unstable, separation occurs",
        "separation",
        "any time within the run",
        SEEN,
        _separates("F18"),
        0.0,
        {"F18": F18},
    ),
    Claim(
        "S43a",
        "Sec. 4.3",
        "Disc damping of 2e-5 N m s makes both motions stable (speed not stated)",
        "stable",
        "contact force's range not growing by more than 2 %",
        "a growth rate of 2e-5/s would show over the run",
        _disc_damping,
        0.0,
        {
            "S43a126": Needed({"N": 200, "Omega": 12.6, "D_star": 2e-5}, 1000),
            "S43a10": Needed({"N": 200, "Omega": 10, "D_star": 2e-5}, 1000),
        },
    ),
    Claim(
        "F19",
        "Sec. 4.3, Fig. 19; conclusion 4",
        "In-plane damping destabilises at N = 385 N, 15 rad/s: separation, then a periodic motion",
        "separation, periodic",
        "release intervals repeat to 1e-8 s",
        SEEN,
        _inplane_damping,
        1e-8,
        {"F11": F11, "F19": F19},
    ),
    Claim(
        "F20",
        "Sec. 4.3, Fig. 20",
        "Damping normal to the disc, c = 0.5: stable, periodic stick-slip in a small range",
        "stable, periodic",
        "range not growing; spread of the release intervals 1e-6",
        "the cycle attracts fast enough to be reached to rounding",
        _normal_damping,
        1e-6,
        {"F20": Needed({"N": 200, "Omega": 20, "c": 0.5}, 300)},
    ),
    Claim(
        "F21",
        "Sec. 4.3, Fig. 21",
        "E = 100 GPa, N = 200 N, Omega = 11 rad/s: unstable but bounded, irregular, no separation",
        "no separation",
        "range at least doubles, then stays within a factor of 1.5; spread of the intervals above 0.001",
        "what 'unstable', 'bounded' and 'irregular' may mean; the amplitude wanders",
        _soft_disc,
        1e-3,
        {"F21": Needed({"N": 200, "Omega": 11, "E": 1e11}, 1000)},
    ),
    Claim(
        "S43k",
        "Sec. 4.3, conclusion 4",
        "A softer spring normal to the disc separates sooner; 2e5 N/m is stable",
        "sooner; stable",
        "none",
        ORDER,
        _normal_stiffness,
        0.0,
        {
            "S43k2e4": Needed({"N": 200, "Omega": 20, "k": 2e4}),
            "S43k3e4": Needed({"N": 200, "Omega": 20, "k": 3e4}),
            "F02": Needed({"N": 200, "Omega": 20}, 500),
            "S43k2e5": Needed({"N": 200, "Omega": 20, "k": 2e5}, 500),
        },
    ),
    Claim(
        "F22",
        "Sec. 4.3, Fig. 22",
        "k_p = 2e3 N/m, N = 300 N, Omega = 50 rad/s: separation, then an unpredictable wandering",
        "separation, wandering",
        "spread of the release intervals above 0.05",
        SEEN,
        _soft_inplane,
        0.05,
        {"F22": KP2E3},
    ),
    Claim(
        "S43kp",
        "Sec. 4.3, conclusion 4",
        "k_p = 2e4 N/m separates sooner than 2e3 N/m; 2e5 N/m is stable",
        "sooner; stable",
        "none",
        ORDER,
        _inplane_stiffness,
        0.0,
        {"F22": KP2E3, "S43kp2e4": KP2E4, "S43kp2e5": KP2E5},
    ),
    Claim(
        "F23",
        "Sec. 4.3, Fig. 23; conclusion 4",
        "m = 0.01 kg: separation when the slider is at its lowest",
        "lowest position",
        "within 10 % of the swing",
        "read off a figure",
        _lowest_position,
        0.1,
        {"F23": Needed({"N": 200, "Omega": 20, "m": 0.01}, 250)},
    ),
)
