"""Claims of Section 4.3: one parameter after the other."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from functools import partial
from itertools import product

import numpy as np
import xarray as xr

from disc_model.analysis.classify import Kind, closure, irregularity, separation_location
from disc_model.claims import measures
from disc_model.claims.cases import PARAMETERS, asked, others, repeated
from disc_model.claims.disc import moving_load_speed
from disc_model.claims.measures import first_separation, growth_or_nan, said_growth, said_onset, said_rate
from disc_model.claims.model import CaseView, Claim, Finding, Missing, Needed, finding
from disc_model.claims.section41 import INTRICATE, RETURNS
from disc_model.claims.section42 import ELSEWHERE, separations_by_load
from disc_model.data.variables import flag_names

STIFFNESSES = {"k": (50, 60, 70, 80, 90, 100, 110, 130, 148, 200), "k_p": (20, 30, 36, 47, 55, 63, 73, 84, 130, 200)}
"""Of the springs normal to the disc and in its plane, kN/m: between those that the paper tries."""
SPEEDS = (7.5, 8.75, 10, 12.6, 15, 20, 30, 50)
"""rad/s, at which twice the disc's damping is tried."""
STEP = 1.0
"""rad/s, at which speeds of onset are tried."""
ORDER = "only the order is claimed"
SEEN = "the paper shows or says that it happens, without a time"
WAITED = 2000.0
"""How long a separation is waited for at low speeds, s: longer than any of the paper's runs."""
SCAN = {name: Needed(own, WAITED) for name, own in PARAMETERS.items() if name.startswith("S43c")}
"""N = 200 N, speeds from 10 to 14.5 rad/s."""


@Claim(
    "S43N0",
    "Sec. 4.3",
    "Without preload the slider slides and the system is stable at low speed",
    paper="stable at 15 rad/s, far below 608 rad/s",
    tolerance="1 rad/s in the speed of onset",
    reason="the step at which speeds are tried",
    needs=asked(S43N0=90),
)
def no_preload(case: CaseView) -> Finding:
    from disc_model.stability.sliding import steady_sliding

    p = case.parameters
    speeds = np.arange(p.Omega, 1000.0, STEP)
    growth_rates = np.array([steady_sliding(p.replace(Omega=float(speed))).growth_rate for speed in speeds])
    unstable = speeds[~(growth_rates < 1e-6)]  # nan: no equilibrium, at a resonance
    onset = float(unstable.min(initial=math.inf))
    share = case["time_stick"] / case["time_reached"]
    ours = (
        f"{first_separation(case)}; sticks {100 * share:.2g} % of the time; steady sliding is stable up to "
        f"{onset - STEP:g} rad/s"
    )
    slides = not case.separates and share < 0.01 and onset > case["Omega"]
    remark = "stable up to the moving load's true critical speed, not to 608 rad/s: see P07"
    return finding(ours, slides, remark if abs(onset - moving_load_speed(p)) <= STEP else "")


@Claim(
    "S43Ninf",
    "Sec. 4.3",
    "With an extremely large preload the slider sticks as long as it is watched",
    paper="sticks",
    tolerance="1 % in the time of release",
    reason="the contact force differs from N by little until then",
    needs=asked(S43Ninf=0.9, S43N3e3=50),
)
def huge_preload(stuck: CaseView, large: CaseView) -> Finding:
    p = large.parameters
    times = large.events["time"].values
    if not times.size:
        raise Missing(f"case {large.name} keeps no event")
    released = float(times[0])
    expected = p.mu_s * p.N / (p.r_0 * p.k_p * p.Omega)
    needed = p.r_0 * p.k_p * p.Omega / p.mu_s
    ours = (
        f"N = {stuck['N']:g} N: sticks all of {stuck['time_reached']:g} s; N = {large['N']:g} N: released at "
        f"{1e3 * released:.1f} ms (μ_s N/(r_0 k_p Ω) = {1e3 * expected:.1f} ms), "
        f"P {measures.late_range(large, 'P').said(0)} N"
    )
    holds = stuck["time_slip"] == 0 and abs(released / expected - 1) < 0.01
    return finding(ours, holds, f"as a matter of time only: sticking for T seconds takes {needed:.0f} N times T")


@Claim(
    "S43s",
    "Sec. 4.3",
    "The stick phase is longer at 200 N than at 50 N",
    paper="longer",
    tolerance="none",
    reason="the periodic cycle, before its instability shows",
    needs=asked(F16=290, F17=850),
)
def stick_longer(*cases: CaseView) -> Finding:
    small, large = (measures.cycle_of(case.parameters).stick_fraction for case in cases)
    return finding(f"sticks {100 * small:.1f} % of the cycle at 50 N, {100 * large:.1f} % at 200 N", large > small)


@Claim(
    "S43c",
    "Sec. 4.3",
    "N = 200 N: the critical speed for separation is 12.6 rad/s",
    paper="12.6 rad/s",
    tolerance="0.05 rad/s",
    reason="half a unit of the last digit printed",
    needs=asked(separates=True, F17=850) | SCAN,
)
def critical_speed(known: CaseView, *cases: CaseView) -> Finding:
    scan = {case["Omega"]: case["first_separation"] for case in cases}
    horizon = known["first_separation"]
    times = ", ".join(f"{speed:g}: {'none' if math.isnan(t) else f'{t:.0f} s'}" for speed, t in sorted(scan.items()))
    lower = [speed for speed, t in scan.items() if t <= horizon and speed < 12.6 - 0.05]
    latest = [speed for speed, t in scan.items() if not math.isnan(t)]
    remark = f"it depends on how long one waits: given {WAITED:g} s, {min(latest, default=math.nan):g} rad/s separates"
    if lower:
        within = f"within the {horizon:.0f} s that the paper's own case at 15 rad/s takes"
        remark += f"; {within}, {min(lower):g} rad/s separates too"
    return finding(f"first separation by speed in rad/s: {times}", scan[12.6] <= horizon and not lower, remark)


@Claim(
    "S43D",
    "Conclusion 4",
    "Disc damping stabilises",
    paper="stabilises",
    tolerance="none",
    reason=ORDER,
    needs=asked(F18=300),
)
def more_disc_damping(case: CaseView) -> Finding:
    rates = [measures.cycle_of(case.parameters.replace(D_star=value)).growth_rate for value in (0.0, 1e-5, 2e-5)]
    said = ", ".join(f"{rate:+.4f}/s" for rate in rates)
    ours = f"growth at N = 200 N, 10 rad/s for D* = 0, 1e-5, 2e-5 N m s: {said}"
    return finding(ours, rates[0] > rates[1] > rates[2])


def _grew(case: CaseView) -> bool:
    """Whether the contact force ranges wider at the end than at first, by more than 2 %; sampling feigns far less."""
    return 1.02 * measures.early_range(case, "P").width < measures.late_range(case, "P").width


def _range(case: CaseView) -> str:
    return f"P {measures.late_range(case, 'P').said(2)} N in the end"


def _stays_small(within: float, case: CaseView) -> Finding:
    """Whether a case does not separate, its contact force ranges no wider in the end, and releases are regular."""
    intervals = measures.release_intervals(case)
    spread = irregularity(intervals)
    ours = f"{first_separation(case)}; {_range(case)}; {1 / intervals.mean():.3f} Hz, spread {spread:.1e}"
    return finding(f"{ours}; {said_growth(case)}", not case.separates and not _grew(case) and spread <= within)


small_periodic = Claim(
    "F16",
    "Sec. 4.3, Fig. 16",
    "N = 50 N, Omega = 15 rad/s: small periodic vibration, no separation",
    check=partial(_stays_small, 1e-4),
    paper="periodic, small",
    tolerance="range not growing; spread of the release intervals 1e-4",
    reason="the cycle attracts slowly: a tenth of the first deviation is left after 300 s",
    needs=asked(steady=True, F16=290),
)


def _separates(case: CaseView) -> Finding:
    return finding(f"{first_separation(case)}; {said_growth(case)}", case.separates)


unstable = partial(Claim, check=_separates, paper="separation", tolerance="any time within the run", reason=SEEN)
separates = unstable(
    "F17",
    "Sec. 4.3, Fig. 17",
    "N = 200 N, Omega = 15 rad/s: unstable, separation occurs",
    needs=asked(F17=850),
)
complicated = Claim(
    "F17c",
    "Sec. 4.3, Fig. 17",
    "The same case: after separation the stick-slip vibration becomes very complicated",
    check=measures.is_intricate,
    paper="very complicated",
    tolerance=INTRICATE,
    reason="what 'very complicated' may mean beside one release a period before separation",
    needs=asked(separates=True, steady=True, F17=850) | others("F17"),
)


@Claim(
    "S43N",
    "Sec. 4.3, conclusion 4",
    "Preload is not monotonous at 15 rad/s: 50 N stable, 200 N separates, 385 N stable",
    paper="stable, separation, stable",
    tolerance="none",
    reason="three runs from the published start decide it",
    needs=asked(F16=290, F17=850, F11=190, S43N600=590) | repeated("S43N550"),
)
def preload(*cases: CaseView) -> Finding:
    """Larger preloads than those that the paper tries may be unstable again: that is a remark."""
    (ours, found), largest, again = separations_by_load(cases[:3]), cases[3], cases[4:]
    beyond = [f"N = {again[0]['N']:g} N: {first_separation(*again)}"] if again[0].separates else []
    if largest.separates or _grew(largest):
        beyond.append(f"N = {largest['N']:g} N: {said_onset(largest)}")
    further = f"further increase makes it unstable again: {'; '.join(beyond)}" if beyond else ""
    return finding(ours, found == [False, True, False], measures.joined(ELSEWHERE, further))


separates_undamped = unstable(
    "F18",
    "Sec. 4.3, Fig. 18",
    "No damping of the disc, N = 200 N, Omega = 10 rad/s: unstable, separation occurs",
    needs=asked(F18=300),
)


@Claim(
    "F18t",
    "Sec. 4.3, Fig. 18",
    "The same case: the trajectory of the in-plane motion changes after the first separation",
    paper="changes",
    tolerance="its width, or its share of stick, changes by three tenths at least",
    reason="what 'changes' may mean; sections are compared by eye in the paper",
    needs=asked(separates=True, steady=True, F18=300),
)
def undamped_trajectory(case: CaseView) -> Finding:
    said, changes = measures.trajectory_change(case)
    return finding(f"{said}; {measures.late_motion(case)[1]}", changes)


@Claim(
    "S43z",
    "Sec. 4.3",
    "N = 200 N: without damping of the disc separation occurs at lower speeds than with D* = 1e-5 N m s",
    paper="10 rad/s against 12.6 rad/s",
    tolerance=f"within {WAITED:g} s",
    reason="longer than any of the paper's runs; how long one waits decides, see S43c",
    needs=asked(F18=300, S43c10=WAITED, S43c11=WAITED, S43c12=WAITED) | repeated("S43z4"),
)
def undamped_separates_lower(*cases: CaseView) -> Finding:
    undamped, damped, slow = cases[0], cases[1:4], cases[4:]
    runs = [slow, [undamped], *([case] for case in damped)]
    ours = "; ".join(
        f"D* = {case['D_star']:g}, {case['Omega']:g} rad/s: {first_separation(case, *again)}" for case, *again in runs
    )
    lowest = [
        min((case["Omega"] for case in group if case["first_separation"] <= WAITED), default=math.inf)
        for group in ((undamped, slow[0]), damped)
    ]
    return finding(ours, lowest[0] < lowest[1])


@Claim(
    "S43d",
    "Sec. 4.3",
    "Disc damping of 2e-5 N m s makes both motions stable (speed not stated)",
    paper="stable",
    tolerance="contact force's range not growing by more than 2 %, at both speeds that the paper speaks of before",
    reason="a growth rate of 2e-5/s would show over the run",
    needs=asked(S43a126=1000, S43a10=1000),
)
def disc_damping(*cases: CaseView) -> Finding:
    stable = [not case.separates and not _grew(case) for case in cases]
    ours = "; ".join(
        f"{case['Omega']:g} rad/s: {first_separation(case)}, {_range(case)}, {said_growth(case)}" for case in cases
    )
    rates = [growth_or_nan(cases[1].parameters.replace(Omega=float(speed))) for speed in SPEEDS]
    said = ", ".join(f"{speed:g}: {said_rate(rate)}" for speed, rate in zip(SPEEDS, rates, strict=True))
    return finding(ours, all(stable), f"growth by speed in rad/s: {said}" if any(rate > 0 for rate in rates) else "")


@Claim(
    "F19",
    "Sec. 4.3, Fig. 19; conclusion 4",
    "In-plane damping destabilises at N = 385 N, 15 rad/s: separation, then a periodic motion",
    paper="separation, periodic",
    tolerance="release intervals repeat to 1e-8 s",
    reason=SEEN,
    needs=asked(F11=190) | asked(steady=True, F19=100),
)
def inplane_damping(without: CaseView, case: CaseView) -> Finding:
    motion, said = measures.late_motion(case)
    ours = f"c_p = 0: {first_separation(without)}; c_p = 0.5: {first_separation(case)}, then {said}"
    return finding(ours, not without.separates and case.separates and motion.period > 0, _where_damping_helps(case))


@Claim(
    "F19d",
    "Sec. 4.3, Fig. 19",
    "The same case: after separation the disc's motion is an unstable periodic one, too",
    paper="unstable periodic",
    tolerance="height and velocity at the releases repeat to 1e-8 of the static height, or of it times Omega",
    reason="far above rounding, far below what an irregular motion would leave",
    needs=asked(separates=True, steady=True, F19=100),
)
def disc_repeats(case: CaseView) -> Finding:
    motion, said = measures.late_motion(case)
    released = measures.switches(case, "stick_to_slip")
    period = max(motion.period, 1)
    units = {"u": abs(case["u_0"]), "u_velocity": abs(case["u_0"]) * case["Omega"]}
    apart = max(closure(released[name].values, period) / unit for name, unit in units.items())
    ours = f"seen from the slider it {said.removeprefix('periodic: ')}; disc under the slider: to {apart:.0e}"
    remark = (
        "periodic as the slider sees it, and attracting, not unstable: the run came to it from elsewhere; a point "
        f"fixed to the disc has the drive's frequency besides, and its last 150 points of the section are "
        f"{measures.late_points(case, 150)} different ones"
    )
    return finding(ours, motion.period > 0 and apart <= 1e-8, remark)


@Claim(
    "F20",
    "Sec. 4.3, Fig. 20",
    "Damping normal to the disc, c = 0.5: stable, periodic stick-slip in a small range",
    paper="stable, periodic",
    tolerance="range not growing; spread of the release intervals 1e-6",
    reason="the cycle attracts fast enough to be reached to rounding",
    needs=asked(steady=True, F20=300) | asked(F02=500),
)
def normal_damping(damped: CaseView, without: CaseView) -> Finding:
    found = _stays_small(1e-6, damped)
    return replace(found, ours=f"{found.ours}, {said_growth(without)} without the damper")


@Claim(
    "F21",
    "Sec. 4.3, Fig. 21",
    "E = 100 GPa, N = 200 N, Omega = 11 rad/s: unstable but bounded, irregular, no separation",
    paper="no separation",
    tolerance="range at least doubles, then stays within a factor of 1.5; no period, 0-1 test above 0.7",
    reason="what 'unstable', 'bounded' and 'irregular' may mean; the amplitude wanders",
    needs=asked(F21=1000),
)
def soft_disc(case: CaseView) -> Finding:
    end = case["time_reached"]
    early = measures.early_range(case, "P")
    third, last = (case.range_of("P", a * end, b * end) for a, b in ((0.5, 0.75), (0.75, 1.0)))
    motion, said = measures.late_motion(case)
    ours = f"{first_separation(case)}; P {early.said(1)} N grows to {last.said(0)} N; then {said}"
    bounded = max(third.width, last.width) < 1.5 * min(third.width, last.width)
    unstable = not case.separates and last.width > 2 * early.width and bounded
    remark = "irregular for good: 'seems quasi-periodic', as the paper also says, it is not by the 0-1 test"
    remark = remark if motion.kind is Kind.IRREGULAR else ""
    return measures.of_kind(Kind.IRREGULAR, motion, ours, besides=unstable, remark=remark)


@Claim(
    "S43k",
    "Sec. 4.3, conclusion 4",
    "A softer spring normal to the disc separates sooner; 2e5 N/m is stable",
    paper="sooner; stable",
    tolerance="none",
    reason=ORDER,
    needs=asked(S43k2e4=0, S43k3e4=0, F02=500, S43k2e5=500),
)
def normal_stiffness(*cases: CaseView) -> Finding:
    times = [case["first_separation"] for case in cases[:3]]
    base, stiff = cases[2:]
    ours = "; ".join(f"k = {case['k']:g} N/m: {first_separation(case)}" for case in cases)
    sooner = bool(np.all(np.diff(times) > 0))  # false if one does not separate
    holds = sooner and not stiff.separates and not _grew(stiff)
    return finding(f"{ours}, {said_growth(stiff)}", holds, _between(base, "k", 20, 50))


@Claim(
    "F22",
    "Sec. 4.3, Fig. 22",
    "k_p = 2e3 N/m, N = 300 N, Omega = 50 rad/s: separation, then an unpredictable wandering",
    paper="separation, wandering",
    tolerance="no period within half the record; 0-1 test above 0.7",
    reason=RETURNS,
    needs=asked(steady=True, F22=350),
)
def soft_inplane(case: CaseView) -> Finding:
    motion, said = measures.late_motion(case)
    ours = f"{first_separation(case)}; then {said}"
    remark = "it wanders within a range, but repeats exactly" if motion.period else ""
    return measures.of_kind(Kind.IRREGULAR, motion, ours, besides=case.separates, remark=remark)


@Claim(
    "S43kp",
    "Sec. 4.3, conclusion 4",
    "k_p = 2e4 N/m separates sooner than 2e3 N/m; 2e5 N/m is stable",
    paper="sooner; stable",
    tolerance="none",
    reason=ORDER,
    needs=asked(F22=350, S43kp2e4=100, S43kp2e5=200),
)
def inplane_stiffness(soft: CaseView, base: CaseView, stiff: CaseView) -> Finding:
    ours = "; ".join(f"k_p = {case['k_p']:g} N/m: {said_onset(case)}" for case in (soft, base, stiff))
    ours += f", {_range(stiff)}"
    sooner = base.separates and base["first_separation"] < soft["first_separation"]
    holds = sooner and not stiff.separates and not _grew(stiff)
    return finding(ours, holds, _between(base, "k_p", 50))


@Claim(
    "F23",
    "Sec. 4.3, Fig. 23; conclusion 4",
    "m = 0.01 kg: separation when the slider is at its lowest",
    paper="lowest position",
    tolerance="within 10 % of its swing and of the whole range",
    reason="read off a figure",
    needs=asked(separates=True, F23=250),
)
def lowest_position(case: CaseView) -> Finding:
    bound = 0.1
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
    ours = (
        f"{first_separation(case)}; {found.kind}: {1e3 * (where - case['u_0']):.1f} mm from equilibrium, "
        f"{100 * found.height:.0f} % of its swing above the lowest point of that, {speed:+.2f} m/s"
    )
    lowest, extent = height.min(), np.ptp(height)
    above = float(np.median(height[starts - 1]) - lowest) / extent
    swings = int(np.sum((np.diff(height)[1:] > 0) & (np.diff(height)[:-1] <= 0)))
    falling = f"still falling: the lowest point is {100 * found.to_lowest:.0f} % of its own swing further down"
    seldom = (
        f"contact is lost in {starts.size} of {swings} swings, {100 * above:.0f} % of the whole range above the "
        f"lowest point of all ({1e3 * lowest:.1f} mm)"
    )
    remark = measures.joined(falling if speed < 0 else "", seldom if starts.size < 0.9 * swings else "")
    return finding(ours, found.kind == "at the lowest position" and bool(above <= bound), remark)


@Claim(
    "F23u",
    "Sec. 4.3, conclusion 4",
    "In all results but that of the light slider, separation happens while the disc moves upward",
    paper="always",
    tolerance="99 % of the separations of each case",
    reason="a general statement; single exceptions would not refute it",
    needs=asked(steady=True, F02=600, F07=190, F09=190, F13=110, F17=850, F18=300, F19=100, F22=350),
)
def always_upward(*cases: CaseView) -> Finding:
    shares = {}
    for case in cases:
        velocity = measures.switches(case, "separation")["u_velocity"].values
        if case.separates and not velocity.size:
            raise Missing(f"case {case.name} keeps no separation")
        if velocity.size:
            shares[case.name] = float(np.mean(velocity > 0))
    said = ", ".join(f"{name}: {100 * share:.0f} %" for name, share in shares.items())
    return finding(f"upward in {said or 'none that separates'}", min(shares.values(), default=0.0) >= 0.99)


@Claim(
    "C4",
    "Sec. 4.3, conclusion 4",
    "In-plane damping destabilises at a large preload, though not in general",
    paper="destabilises at 385 N",
    tolerance="none",
    reason="runs of 200 s and more from the published start decide it",
    needs=asked(F11=190, F19=100, C4cp01=290, C4cp1=290, C4cpN50=290),
)
def inplane_damping_alone(*cases: CaseView) -> Finding:
    without, shown, weak, strong, small = cases
    said = [f"{case['c_p']:g}: {said_onset(case)}" for case in (without, weak, shown, strong)]
    said.append(f"N = 50 N, c_p = {small['c_p']:g}: {first_separation(small)}")
    damped = [case.separates for case in (weak, shown, strong)]
    remark = ("" if all(damped) else "not for every value of c_p; ") + _where_damping_helps(shown)
    ours = "N = 385 N, c_p in N s/m = " + "; ".join(said)
    return finding(ours, not without.separates and any(damped) and not small.separates, remark)


@Claim(
    "S43E",
    "Sec. 4.3",
    "A stiffer disc is more stable, a softer one less",
    paper="monotonous",
    tolerance="none",
    reason=ORDER,
    needs=asked(S43E100=590, F02=500, S43E200=1000, F21=1000),
)
def elasticity(*cases: CaseView) -> Finding:
    points = [case.parameters for case in cases]
    *rates, soft, base = [measures.cycle_of(p).growth_rate for p in (*points, points[-1].replace(E=150e9))]
    said = "; ".join(f"{case['E'] / 1e9:g} GPa: {said_onset(case)}" for case in cases[:3])
    monotonous = rates[0] > rates[1] > rates[2]
    remark = (
        f"{'' if monotonous else 'not monotonous: '}at 20 rad/s the soft disc is "
        f"{'stable' if rates[0] < 0 else 'unstable'}; at 11 rad/s growth is {soft:+.4f}/s for 100 GPa and "
        f"{base:+.4f}/s for 150 GPa"
    )
    return finding(f"at 20 rad/s, {said}", monotonous and rates[2] < 0, remark)


@Claim(
    "C4E",
    "Conclusion 4",
    "Separation does not happen when the disc is soft enough",
    paper="may not happen",
    tolerance="none at any speed for the softest disc of a map, nor for any up to some stiffness",
    reason="'enough' names a bound below which it holds",
    scans=("map_E",),
)
def soft_enough(study: xr.Dataset) -> Finding:
    study = study.sel(normalization="as_published").sortby(["E", "Omega"])
    outcome = flag_names(study["outcome"].transpose("E", "Omega"))
    if np.any(outcome == "unknown"):
        raise Missing("study map_E has points that failed")
    E, Omega = study["E"].values / 1e9, study["Omega"].values
    apart = outcome == "separation"
    some = apart.any(axis=1)
    ours = f"at {json.loads(study.attrs['base'])['N']:g} N, {Omega.min():g}..{Omega.max():g} rad/s: "
    if not some.any() or some.all():
        return finding(f"{ours}separation for {'every' if some.any() else 'no'} E of {E[0]:g}..{E[-1]:g} GPa", False)
    ours += f"no separation for E = {', '.join(f'{value:.4g}' for value in E[~some])} GPa of {E[0]:g}..{E[-1]:g} GPa"
    quiet = int(np.argmin(some))  # the softest of these
    softer = [f"{E[i]:.4g} GPa from {Omega[apart[i]].min():.3g} rad/s up" for i in range(quiet)]
    return finding(ours, not softer, f"softer discs separate again: {', '.join(softer)}" if softer else "")


@Claim(
    "F22a",
    "Sec. 4.3, Fig. 22",
    "k_p = 2e3 N/m: at first the disc vibrates quasi-periodically",
    paper="quasi-periodic",
    tolerance="a line of ψ within 0.05 Hz of the frequency that the cycle's leading pair of multipliers brings",
    reason="twice what 40 s resolve; the line must be a thousandth of the strongest at least",
    needs=asked(F22=350),
)
def quasi_periodic_at_first(case: CaseView) -> Finding:
    """A second frequency of the in-plane motion, long before separation, and whether it is there to stay."""
    cycle = measures.cycle_of(case.parameters)
    leading = cycle.multipliers[0]
    start, stop = (float(case.samples("early")["time"][i]) for i in (0, -1))
    found = measures.lines(case, "early", start, stop, "psi", above=1.0, below=200.0, floor=1e-3)
    (strongest,) = measures.loudest(found, 1)
    turn = abs(float(np.angle(leading))) / (2 * np.pi)
    expected = np.array([turn, 1 - turn, 1 + turn]) * strongest.frequency
    off, second = min((float(np.min(np.abs(expected - line.frequency))), line) for line in found)
    ours = (
        f"leading multiplier {leading.real:+.3f} ± {abs(leading.imag):.3f}i; ψ in {start:.0f}..{stop:.0f} s at "
        f"{strongest.frequency:.2f} Hz and, {second.amplitude / strongest.amplitude:.1e} of that, at "
        f"{second.frequency:.2f} Hz"
    )
    widths = [case.range_of("P", time, time + 20).width for time in (start / 4, stop)]
    remark = (
        f"as a transient: the second frequency grows by {cycle.growth_rate:+.4f}/s until contact is lost (the force "
        f"ranges over {widths[0]:.1f} N at {start / 4:.0f} s, {widths[1]:.0f} N at {stop:.0f} s); f_s and f_Ω alone, "
        "which every section of the disc shows, the paper calls periodic in Figs. 12 and 16"
    )
    brings = abs(leading.imag) > 0 and second is not strongest and off <= 0.05
    return finding(ours, brings and cycle.growth_rate > 0, remark)


@Claim(
    "S43b",
    "Sec. 4.1, 4.3; conclusion 3",
    "After separation the disc's vibration is bounded",
    paper="bounded",
    tolerance="range of the last quarter after the first separation no more than 1.02 times that of the one before",
    reason="the amplitude wanders a little",
    needs=asked(separates=True, F02=600, F07=190, F17=850, F13=110),
)
def bounded(*cases: CaseView) -> Finding:
    widths = [case.last_quarters("w_point") for case in cases]
    said = ", ".join(f"{case.name}: {1e3 * late:.1f} mm" for case, (late, _) in zip(cases, widths, strict=True))
    return finding(f"range of the disc in the end, {said}", all(late <= 1.02 * before for late, before in widths))


@Claim(
    "C3",
    "Sec. 4.3, conclusion 3",
    "After separation the stick phase disappears under some parameter values",
    paper="under some",
    tolerance="0.1 % of the time",
    reason="a stray stick would not refute the statement",
    needs=asked(separates=True, steady=True, F02=600, F07=190, F09=190, F13=110, F17=850) | others("F02", "F07", "F17"),
)
def stick_may_vanish(*cases: CaseView) -> Finding:
    shares = [measures.phase_share(case, "stick") for case in cases[:5]]
    said = "; ".join(
        f"N = {measures.place_of(case)}: {100 * share:.1f} %" for case, share in zip(cases[:5], shares, strict=True)
    )
    remark = measures.another_motion(*zip((*cases[:2], cases[4]), cases[5:], strict=True))
    return finding(f"time sticking long after the first separation: {said}", min(shares) <= 1e-3, remark)


def _where_damping_helps(case: CaseView) -> str:
    """At how many loads and speeds in-plane damping lowers the growth of the cycle, raises it, or ends the cycle."""
    loads_and_speeds = product((50, 125, 200, 300, 385, 600), (10, 15, 20, 30, 40))
    points = [case.parameters.replace(N=N, Omega=speed) for N, speed in loads_and_speeds]
    rates = [(p, growth_or_nan(p.replace(c_p=0.0)), growth_or_nan(p)) for p in points]
    lower = sum(damped < without for _, without, damped in rates)
    raised = [
        f"{measures.place(p.N, p.Omega)}: {without:+.4f} to {damped:+.4f}/s"
        for p, without, damped in rates
        if damped > without
    ]
    ended = [p for p, without, damped in rates if math.isfinite(without) and math.isnan(damped)]
    remark = f"at {len(points)} loads and speeds c_p = {case['c_p']:g} N s/m lowers the growth of the cycle at {lower}"
    if raised:
        remark += f", raises it at {len(raised)} ({'; '.join(raised)})"
    if ended:
        remark += f", and leaves no cycle near the start at {len(ended)}"
        remark += ", the paper's case among them" if case.parameters in ended else ""
    return remark


def _between(case: CaseView, spring: str, *speeds: float) -> str:
    """Growth at stiffnesses of a spring between those of the paper, at some speeds; nothing if it only falls."""
    said, falls = [], True
    for speed in speeds:
        stiffened = [case.parameters.replace(Omega=speed, **{spring: 1e3 * k}) for k in STIFFNESSES[spring]]
        rates = np.array([growth_or_nan(p) for p in stiffened])
        falls &= not np.any(np.diff(rates[np.isfinite(rates)]) > 0)
        said.append(
            f"at {speed:g} rad/s growth is {', '.join(map(said_rate, rates))} per second for "
            f"{', '.join(map(str, STIFFNESSES[spring]))} kN/m"
        )
    return "" if falls else f"in between, the effect is not monotonous: {'; '.join(said)}"
