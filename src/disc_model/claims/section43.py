"""Claims of Section 4.3: one parameter after the other."""

from __future__ import annotations

import json
import math
from itertools import product
from typing import Any

import numpy as np
import xarray as xr

from disc_model.analysis.classify import closure, irregularity, separation_location
from disc_model.analysis.poincare import distinct_points
from disc_model.claims import measures
from disc_model.claims.disc import BASE, moving_load_speed
from disc_model.claims.measures import (
    CaseView,
    between_only,
    first_separation,
    growth_or_nan,
    is_kind,
    rows,
    said_rate,
)
from disc_model.claims.model import CHECKS, Answer
from disc_model.data.dataset import Missing
from disc_model.data.variables import Outcome, flag_names

STIFFNESSES = {"k": (50, 60, 70, 80, 90, 100, 110, 130, 148, 200), "k_p": (20, 30, 36, 47, 55, 63, 73, 84, 130, 200)}
"""Of the springs normal to the disc and in its plane, kN/m: between those that the paper tries."""
SPEEDS = (7.5, 8.75, 10, 12.6, 15, 20, 30, 50)
"""rad/s, at which twice the disc's damping is tried."""
GREW = 1.02
"""A range that is wider by less has not grown: sampling feigns far less."""


@CHECKS("S43N0")
def no_preload(case: CaseView, *, step: float, share: float) -> Answer:
    from disc_model.stability.sliding import steady_sliding

    p = case.parameters
    speeds = np.arange(p.Omega, 1000.0, step)
    growth_rates = np.array([steady_sliding(p.replace(Omega=float(speed))).growth_rate for speed in speeds])
    unstable = speeds[~(growth_rates < 1e-6)]  # nan: no equilibrium, at a resonance
    onset = float(unstable.min(initial=math.inf))
    stuck = case["time_stick"] / case["time_reached"]
    return Answer(
        not case.separates and stuck < share and onset > case["Omega"],
        percent=100 * stuck,
        stable_to=onset - step,
        true_speed=abs(onset - moving_load_speed(p)) <= step,
    )


@CHECKS("S43Ninf")
def huge_preload(stuck: CaseView, large: CaseView, *, share: float) -> Answer:
    p = large.parameters
    times = large.events["time"].values
    if not times.size:
        raise Missing(f"case {large.name} keeps no event")
    released = float(times[0])
    needed = p.r_0 * p.k_p * p.Omega / p.mu_s
    expected = p.N / needed
    return Answer(
        stuck["time_slip"] == 0 and abs(released / expected - 1) < share,
        released=1e3 * released,
        expected=1e3 * expected,
        needed=needed,
    )


@CHECKS("S43s")
def stick_longer(*cases: CaseView) -> Answer:
    small, large = (100 * measures.cycle_of(case.parameters).stick_fraction for case in cases)
    return Answer(large > small, small=small, large=large)


@CHECKS("S43c")
def critical_speed(known: CaseView, *cases: CaseView, printed: float, within: float, wait: float) -> Answer:
    scan = {case["Omega"]: case["first_separation"] for case in cases}
    horizon = known["first_separation"]
    lower = [speed for speed, t in scan.items() if t <= horizon and speed < printed - within]
    latest = [speed for speed, t in scan.items() if not math.isnan(t)]
    # waits for which no speed clearly lower separates
    first = min((t for speed, t in scan.items() if speed < printed - within and not math.isnan(t)), default=math.inf)
    some = scan[printed] < first < math.inf
    holds = scan[printed] <= horizon and not lower
    return Answer(
        None if some and not holds else holds,
        "wait",
        speeds=[{"Omega": speed, "time": measures.or_none(scan[speed], ".0f", " s")} for speed in sorted(scan)],
        latest=min(latest, default=math.nan),
        lower=[{"horizon": horizon, "least": min(lower)}] if lower else [],
        exactly=[{"low": scan[printed], "high": first}] if some else [],
    )


@CHECKS("S43D")
def more_disc_damping(case: CaseView) -> Answer:
    rates = [measures.cycle_of(case.parameters.replace(D_star=value)).growth_rate for value in (0.0, 1e-5, 2e-5)]
    return Answer(rates[0] > rates[1] > rates[2], rates=[said_rate(rate, "/s") for rate in rates])


def _grew(case: CaseView) -> bool:
    """Whether the contact force ranges wider at the end than at first."""
    return GREW * case.early.width < case.late.width


@CHECKS("F16", "F20")
def stays_small(case: CaseView, *_: CaseView, within: float) -> Answer:
    """Whether a case does not separate, its contact force ranges no wider in the end, and releases are regular."""
    intervals = measures.release_intervals(case)
    spread = irregularity(intervals)
    return Answer(
        not case.separates and not _grew(case) and spread <= within,
        rate=1 / intervals.mean(),
        spread=spread,
    )


@CHECKS("F17", "F18")
def separates(case: CaseView) -> Answer:
    return Answer(case.separates)


@CHECKS("S43N")
def preload(*cases: CaseView) -> Answer:
    """Larger preloads than those that the paper tries may be unstable again: that is a remark."""
    largest, again = cases[3], cases[4:]
    beyond = [{"case": again[0], "onset": first_separation(*again)}] if again[0].separates else []
    if largest.separates or _grew(largest):
        beyond.append({"case": largest, "onset": largest.onset})
    return Answer(between_only(cases[:3]), loads=rows(cases[:3]), beyond=beyond)


@CHECKS("S43z")
def undamped_separates_lower(*cases: CaseView, wait: float) -> Answer:
    undamped, damped, slow = cases[0], cases[1:4], cases[4:]
    runs = [slow, [undamped], *([case] for case in damped)]
    lowest = [
        min((case["Omega"] for case in group if case["first_separation"] <= wait), default=math.inf)
        for group in ((undamped, slow[0]), damped)
    ]
    said = [{"case": case, "first": first_separation(case, *again)} for case, *again in runs]
    return Answer(lowest[0] < lowest[1], runs=said)


@CHECKS("S43d")
def disc_damping(*cases: CaseView) -> Answer:
    rates = {speed: growth_or_nan(cases[1].parameters.replace(Omega=float(speed))) for speed in SPEEDS}
    said = [f"{speed:g}: {said_rate(rate)}" for speed, rate in rates.items()]
    stable = [not case.separates and not _grew(case) for case in cases]
    holds = all(stable) if len({*stable}) == 1 else None
    return Answer(holds, "speed", rates=said)


@CHECKS("F19")
def inplane_damping(without: CaseView, case: CaseView) -> Answer:
    periodic = measures.late_motion(case)[0].period > 0
    return Answer(not without.separates and case.separates and periodic, **_effect_of(case, "c_p"))


@CHECKS("F19d")
def disc_repeats(case: CaseView, *, within: float) -> Answer:
    motion, said = measures.late_motion(case)
    released = measures.switches(case, "stick_to_slip")
    period = max(motion.period, 1)
    units = {"u": abs(case["u_0"]), "u_velocity": abs(case["u_0"]) * case["Omega"]}
    apart = max(closure(released[name].values, period) / unit for name, unit in units.items())
    return Answer(
        motion.period > 0 and apart <= within,
        said=said.removeprefix("periodic: "),
        apart=apart,
        points=distinct_points(measures.late_section(case, 150)),
    )


@CHECKS("F21")
def soft_disc(case: CaseView, *, factor: float, bounded: float) -> Answer:
    end = case["time_reached"]
    third, last = (case.range_of("P", a * end, b * end) for a, b in ((0.5, 0.75), (0.75, 1.0)))
    motion, _ = measures.late_motion(case)
    within = max(third.width, last.width) < bounded * min(third.width, last.width)
    return Answer(
        *is_kind(Outcome.IRREGULAR, motion, not case.separates and last.width > factor * case.early.width and within),
        last=last,
    )


@CHECKS("F21q")
def seems_quasi_periodic(case: CaseView) -> Answer:
    return Answer(*is_kind(Outcome.QUASI_PERIODIC, measures.late_motion(case)[0]))


@CHECKS("S43k")
def normal_stiffness(*cases: CaseView) -> Answer:
    times = [case["first_separation"] for case in cases[:3]]
    base, stiff = cases[2:]
    sooner = bool(np.all(np.diff(times) > 0))  # false if one does not separate
    return Answer(sooner and not stiff.separates and not _grew(stiff), between=_between(base, "k", 20, 50))


@CHECKS("F22")
def soft_inplane(case: CaseView, near: CaseView) -> Answer:
    motion, _ = measures.late_motion(case)
    repeats, nearby = motion.period > 0, measures.nearby(motion, near)
    return Answer(*is_kind(Outcome.IRREGULAR, motion, case.separates), repeats=repeats, nearby=nearby)


@CHECKS("S43kp")
def inplane_stiffness(soft: CaseView, base: CaseView, stiff: CaseView) -> Answer:
    sooner = base.separates and base["first_separation"] < soft["first_separation"]
    return Answer(sooner and not stiff.separates and not _grew(stiff), between=_between(base, "k_p", 50))


@CHECKS("F23")
def lowest_position(case: CaseView, *, bound: float) -> Answer:
    window = case.samples("zoom")
    time, height = window["time"].values, window["u"].values - case["u_0"]
    starts = np.flatnonzero(np.diff((window["phase"].values == measures.SEPARATION).astype(int)) == 1) + 1
    if not starts.size:
        raise Missing("no separation in the window of case F23")
    found = separation_location(time, height, starts, bound)
    # by its switches: samples come late, and the velocity of a light slider changes fast
    lost = measures.switches(case, "separation")
    if not lost.sizes["event"]:
        raise Missing("case F23 keeps no separation")
    where, speed = (float(np.median(lost[name].values)) for name in ("u", "u_velocity"))
    lowest, extent = height.min(), np.ptp(height)
    above = float(np.median(height[starts - 1]) - lowest) / extent
    swings = int(np.sum((np.diff(height)[1:] > 0) & (np.diff(height)[:-1] <= 0)))
    return Answer(
        found.kind == "at the lowest position" and above <= bound,
        kind=found.kind,
        mm=1e3 * (where - case["u_0"]),
        percent=100 * found.height,
        speed=speed,
        falling=speed < 0,
        further=100 * found.to_lowest,
        seldom=starts.size < 0.9 * swings,
        count=starts.size,
        swings=swings,
        above=100 * above,
        lowest=1e3 * lowest,
    )


@CHECKS("F23u")
def always_upward(*cases: CaseView, share: float) -> Answer:
    shares = {}
    for case in cases:
        velocity = measures.switches(case, "separation")["u_velocity"].values
        if case.separates and not velocity.size:
            raise Missing(f"case {case.name} keeps no separation")
        if velocity.size:
            shares[case.name] = float(np.mean(velocity > 0))
    said = [f"{name}: {100 * found:.0f} %" for name, found in shares.items()]
    return Answer(min(shares.values(), default=0.0) >= share, shares=said or ["none that separates"])


@CHECKS("C4N")
def damping_at_large_preloads(study: xr.Dataset, *, c_p: float) -> Answer:
    """Whether from some preload on all separate with the damper that do not without."""
    study = study.sel(normalization="as_published").sortby("N")
    outcome = flag_names(study["outcome"].sel(c_p=[0.0, c_p]).transpose("c_p", "N"))
    if np.any(outcome == "failed"):
        raise Missing("study map_c_p has points that failed")
    without, damped = outcome == "separation"
    loads, newly, spared = study["N"].values, damped & ~without, without & ~damped
    said = {name: [f"{N:g}" for N in loads[at]] or ["none"] for name, at in (("newly", newly), ("spared", spared))}
    return Answer(bool(newly[-1]), N=measures.extent(loads), Omega=json.loads(study.attrs["base"])["Omega"], **said)


@CHECKS("C4c")
def vertical_damping(case: CaseView) -> Answer:
    effect = _effect_of(case, "c")
    return Answer(effect["lowered"] == effect["points"] - effect["without"] > 0, **effect)


@CHECKS("C4")
def inplane_damping_alone(*cases: CaseView) -> Answer:
    without, shown, weak, strong, small = cases
    damped = [case.separates for case in (weak, shown, strong)]
    return Answer(
        not without.separates and any(damped) and not small.separates,
        large=rows((without, weak, shown, strong)),
        not_all=not all(damped),
        **_effect_of(shown, "c_p"),
    )


@CHECKS("S43E")
def elasticity(*cases: CaseView) -> Answer:
    points = [case.parameters for case in cases]
    *rates, soft, base = [measures.cycle_of(p).growth_rate for p in (*points, points[-1].replace(E=150e9))]
    monotonous = rates[0] > rates[1] > rates[2]
    return Answer(
        monotonous and rates[2] < 0,
        discs=[{"case": case, "GPa": case["E"] / 1e9} for case in cases[:3]],
        order="" if monotonous else "not monotonous: ",
        state="stable" if rates[0] < 0 else "unstable",
        soft=soft,
        base=base,
    )


@CHECKS("C4E")
def soft_enough(study: xr.Dataset, *, slow: float) -> Answer:
    study = study.sel(normalization="as_published").sortby(["E", "Omega"])
    outcome = flag_names(study["outcome"].transpose("E", "Omega"))
    if np.any(outcome == "failed"):
        raise Missing("study map_E has points that failed")
    E, Omega = study["E"].values / 1e9, study["Omega"].values
    at = Omega == slow
    apart = outcome == "separation"
    some = apart.any(axis=1)
    quiet = int(np.argmin(some))  # the softest that does not separate, if one does and one does not
    mixed = some.any() and not some.all()
    softer = [{"GPa": E[i], "Omega": Omega[apart[i]].min()} for i in range(quiet)] if mixed else []
    return Answer(
        mixed if some.any() else None,
        "nowhere",
        N=json.loads(study.attrs["base"])["N"],
        Omega=measures.extent(Omega),
        E=measures.extent(E),
        none_for=[{"quiet": list(E[~some])}] if mixed else [],
        base_too=at.any() and not apart[E <= BASE.E / 1e9][:, at].any(),
        alike=[] if mixed else [{"all": "every" if some.any() else "no"}],
        softer=softer,
    )


@CHECKS("F22a")
def quasi_periodic_at_first(case: CaseView, *, within: float, floor: float) -> Answer:
    """A second frequency of the in-plane motion, long before separation, and whether it is there to stay."""
    cycle = measures.cycle_of(case.parameters)
    leading = cycle.multipliers[0]
    start, stop = (float(case.samples("early")["time"][i]) for i in (0, -1))
    found = measures.lines(case, "early", start, stop, "psi", above=1.0, below=200.0, floor=floor)
    (strongest,) = measures.loudest(found, 1)
    turn = abs(float(np.angle(leading))) / (2 * np.pi)
    expected = np.array([turn, 1 - turn, 1 + turn]) * strongest.frequency
    off, second = min((float(np.min(np.abs(expected - line.frequency))), line) for line in found)
    brings = abs(leading.imag) > 0 and second is not strongest and off <= within
    return Answer(
        brings and cycle.growth_rate > 0,
        real=leading.real,
        imag=abs(leading.imag),
        start=start,
        stop=stop,
        strongest=strongest.frequency,
        relative=second.amplitude / strongest.amplitude,
        second=second.frequency,
        rate=cycle.growth_rate,
        early=start / 4,
        widths=[case.range_of("P", time, time + 20).width for time in (start / 4, stop)],
    )


@CHECKS("S43b")
def bounded(*cases: CaseView, factor: float) -> Answer:
    widths = {case.name: case.last_quarters("w_point") for case in cases}
    said = [f"{name}: {1e3 * late:.1f} mm" for name, (late, _) in widths.items()]
    return Answer(all(late <= factor * before for late, before in widths.values()), ranges=said)


@CHECKS("C3")
def stick_may_vanish(*cases: CaseView, share: float) -> Answer:
    shares = [measures.phase_share(case, "stick") for case in cases[:5]]
    said = [f"N = {case.place}: {100 * stick:.1f} %" for case, stick in zip(cases[:5], shares, strict=True)]
    another = measures.another_motion(*zip((*cases[:2], cases[4]), cases[5:], strict=True))
    return Answer(min(shares) <= share, shares="; ".join(said), another=another)


def _effect_of(case: CaseView, damper: str) -> dict[str, Any]:
    """At how many loads and speeds a damper lowers growth, raises it, or ends a stable cycle.

    Where it leaves no stick-slip cycle near the start, the motion is steady sliding, whose growth is compared.
    """
    from disc_model.stability.sliding import steady_sliding

    loads_and_speeds = [*product((50, 125, 200, 300, 385, 600), (10, 15, 20, 30, 40))]
    lowered, slides, ended, lost, raised = 0, 0, 0, 0, []
    for N, speed in loads_and_speeds:
        p = case.parameters.replace(N=N, Omega=speed)
        without, damped = growth_or_nan(p.replace(**{damper: 0.0})), growth_or_nan(p)
        gone = math.isnan(damped)
        rate = steady_sliding(p).growth_rate if gone and damper == "c_p" else damped
        lowered += rate < without
        slides += gone and rate < without
        ended += gone and without < 0 and not rate < without
        lost += math.isnan(rate)
        if not gone and rate > without:
            raised.append(f"{measures.place(N, speed)}: {without:+.4f} to {rate:+.4f}/s")
    return {
        "points": len(loads_and_speeds),
        "value": case[damper],
        "lowered": lowered,
        "slides": [{"count": slides}] if slides else [],
        "raised": [{"count": len(raised), "where": "; ".join(raised)}] if raised else [],
        "ended": [{"count": ended}] if ended else [],
        "without": lost,
    }


def _between(case: CaseView, spring: str, *speeds: float) -> list[dict[str, Any]]:
    """Growth at stiffnesses of a spring between those of the paper, at some speeds; nothing if it only falls."""
    found, falls = [], True
    for speed in speeds:
        stiffened = [case.parameters.replace(Omega=speed, **{spring: 1e3 * k}) for k in STIFFNESSES[spring]]
        rates = np.array([growth_or_nan(p) for p in stiffened])
        falls &= not np.any(np.diff(rates[np.isfinite(rates)]) > 0)
        found.append({"Omega": speed, "rates": [*map(said_rate, rates)], "stiffnesses": [*STIFFNESSES[spring]]})
    return [] if falls else found
