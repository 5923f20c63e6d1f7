"""Claims of Section 4.3: one parameter after the other."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np

from disc_model.analysis.classify import Kind, separation_location
from disc_model.claims import measures
from disc_model.claims.cases import OTHERS, PARAMETERS, REPEATS, asked, others, repeated
from disc_model.claims.measures import BETWEEN, first_separation, said_growth
from disc_model.claims.model import Cases, CaseView, Claim, Finding, Missing, Needed, claim, finding, undecided
from disc_model.claims.section41 import INTRICATE, RETURNS
from disc_model.claims.section42 import ELSEWHERE, separations_by_load
from disc_model.data.variables import flag_names
from disc_model.parameters import Parameters
from disc_model.plate import plate_modes

STIFFNESSES = {"k": (50, 60, 70, 80, 90, 100, 110, 130, 148, 200), "k_p": (20, 30, 36, 47, 55, 63, 73, 84, 130, 200)}
"""Of the springs normal to the disc and in its plane, kN/m: between those that the paper tries."""
SPEEDS = (7.5, 8.75, 10, 12.6, 15, 20, 30, 50)
"""rad/s, at which twice the disc's damping is tried."""
ORDER = "only the order is claimed"
SEEN = "the paper shows or says that it happens, without a time"
WAITED = 2000.0
"""How long a separation is waited for at low speeds, s: longer than any of the paper's runs."""
SCAN = {name: Needed(own, WAITED) for name, own in PARAMETERS.items() if name.startswith("S43c")}
"""N = 200 N, speeds from 10 to 14.5 rad/s."""


@claim(
    "S43N0",
    "Sec. 4.3",
    "Without preload the slider slides and the system is stable at low speed",
    paper="stable at 15 rad/s, far below 608 rad/s",
    tolerance="1 rad/s in the speed of onset",
    reason="the step at which speeds are tried",
    bound=1.0,
    needs=asked(S43N0=90),
)
def no_preload(cases: Cases, claim: Claim) -> Finding:
    from disc_model.stability.sliding import steady_sliding

    case = cases["S43N0"]
    p = case.parameters
    speeds = np.arange(p.Omega, 1000.0, claim.bound)
    growth_rates = np.array([steady_sliding(p.replace(Omega=float(speed))).growth_rate for speed in speeds])
    unstable = speeds[~(growth_rates < 1e-6)]  # nan: no equilibrium, at a resonance
    onset = float(unstable.min(initial=math.inf))
    share = case["time_stick"] / case["time_reached"]
    ours = f"{first_separation(case)}; sticks {100 * share:.2g} % of the time; "
    ours += f"steady sliding is stable up to {onset - claim.bound:g} rad/s"
    slides = not case.separates and share < 0.01 and onset > case["Omega"]
    modes = plate_modes(p).query("diameters > 0")
    critical = float(np.min(modes["omega"] / modes["diameters"]))
    remark = "stable up to the moving load's true critical speed, not to 608 rad/s: see P07"
    return finding(ours, slides, remark if abs(onset - critical) <= claim.bound else "")


@claim(
    "S43Ninf",
    "Sec. 4.3",
    "With an extremely large preload the slider sticks as long as it is watched",
    paper="sticks",
    tolerance="1 % in the time of release",
    reason="the contact force differs from N by little until then",
    bound=0.01,
    needs=asked(S43Ninf=0.9, S43N3e3=50),
)
def huge_preload(cases: Cases, claim: Claim) -> Finding:
    stuck, large = cases["S43Ninf"], cases["S43N3e3"]
    p = large.parameters
    times = large.events["time"].values
    if not times.size:
        raise Missing(f"case {large.name} keeps no event")
    released = float(times[0])
    expected = p.mu_s * p.N / (p.r_0 * p.k_p * p.Omega)
    needed = p.r_0 * p.k_p * p.Omega / p.mu_s
    late = measures.late_range(large, "P")
    ours = (
        f"N = {stuck['N']:g} N: sticks all of {stuck['time_reached']:g} s; N = {large['N']:g} N: released at "
        f"{1e3 * released:.1f} ms (μ_s N/(r_0 k_p Ω) = {1e3 * expected:.1f} ms), P {late.low:.0f}..{late.high:.0f} N"
    )
    holds = stuck["time_slip"] == 0 and abs(released / expected - 1) < claim.bound
    return finding(ours, holds, f"as a matter of time only: sticking for T seconds takes {needed:.0f} N times T")


@claim(
    "S43s",
    "Sec. 4.3",
    "The stick phase is longer at 200 N than at 50 N",
    paper="longer",
    tolerance="none",
    reason="the periodic cycle, before its instability shows",
    needs=asked(F16=290, F17=850),
)
def stick_longer(cases: Cases, claim: Claim) -> Finding:
    small, large = (measures.cycle_of(cases[name].parameters) for name in ("F16", "F17"))
    ours = (
        f"sticks {100 * small.stick_fraction:.1f} % of the cycle at 50 N, {100 * large.stick_fraction:.1f} % at 200 N"
    )
    return finding(ours, large.stick_fraction > small.stick_fraction)


@claim(
    "S43c",
    "Sec. 4.3",
    "N = 200 N: the critical speed for separation is 12.6 rad/s",
    paper="12.6 rad/s",
    tolerance="0.05 rad/s",
    reason="half a unit of the last digit printed",
    bound=0.05,
    needs=asked(separates=True, F17=850) | SCAN,
)
def critical_speed(cases: Cases, claim: Claim) -> Finding:
    scan = {cases[name]["Omega"]: cases[name]["first_separation"] for name in claim.needs if name != "F17"}
    horizon = cases["F17"]["first_separation"]
    times = ", ".join(f"{speed:g}: {'none' if math.isnan(t) else f'{t:.0f} s'}" for speed, t in sorted(scan.items()))
    lower = [speed for speed, t in scan.items() if t <= horizon and speed < 12.6 - claim.bound]
    latest = [speed for speed, t in scan.items() if not math.isnan(t)]
    remark = f"it depends on how long one waits: given {WAITED:g} s, {min(latest, default=math.nan):g} rad/s separates"
    if lower:
        within = f"within the {horizon:.0f} s that the paper's own case at 15 rad/s takes"
        remark += f"; {within}, {min(lower):g} rad/s separates too"
    return finding(f"first separation by speed in rad/s: {times}", scan[12.6] <= horizon and not lower, remark)


@claim(
    "S43D",
    "Conclusion 4",
    "Disc damping stabilises",
    paper="stabilises",
    tolerance="none",
    reason=ORDER,
    needs=asked(F18=300),
)
def more_disc_damping(cases: Cases, claim: Claim) -> Finding:
    p = cases["F18"].parameters
    rates = [measures.cycle_of(p.replace(D_star=value)).growth_rate for value in (0.0, 1e-5, 2e-5)]
    ours = ", ".join(f"{rate:+.4f}/s" for rate in rates)
    return finding(
        f"growth at N = 200 N, 10 rad/s for D* = 0, 1e-5, 2e-5 N m s: {ours}", rates[0] > rates[1] > rates[2]
    )


@claim(
    "F16",
    "Sec. 4.3, Fig. 16",
    "N = 50 N, Omega = 15 rad/s: small periodic vibration, no separation",
    paper="periodic, small",
    tolerance="range not growing; spread of the release intervals 1e-4",
    reason="the cycle attracts slowly: a tenth of the first deviation is left after 300 s",
    bound=1e-4,
    needs=asked(steady=True, F16=290),
)
def small_periodic(cases: Cases, claim: Claim) -> Finding:
    return _stays_small(cases, claim, "F16")


@claim(
    "F17",
    "Sec. 4.3, Fig. 17",
    "N = 200 N, Omega = 15 rad/s: unstable, separation occurs",
    paper="separation",
    tolerance="any time within the run",
    reason=SEEN,
    needs=asked(F17=850),
)
def separates(cases: Cases, claim: Claim) -> Finding:
    return _separates(cases, claim, "F17")


@claim(
    "F17c",
    "Sec. 4.3, Fig. 17",
    "The same case: after separation the stick-slip vibration becomes very complicated",
    paper="very complicated",
    tolerance=INTRICATE,
    reason="what 'very complicated' may mean beside one release a period before separation",
    bound=4.0,
    needs=asked(separates=True, steady=True, F17=850) | others("F17"),
)
def complicated(cases: Cases, claim: Claim) -> Finding:
    return measures.is_intricate(cases["F17"], cases[OTHERS["F17"]], claim.bound)


@claim(
    "S43N",
    "Sec. 4.3, conclusion 4",
    "Preload is not monotonous at 15 rad/s: 50 N stable, 200 N separates, 385 N stable",
    paper="stable, separation, stable",
    tolerance="none",
    reason="three runs from the published start decide it",
    needs=asked(F16=290, F17=850, F11=190, S43N600=590) | repeated("S43N550"),
)
def preload(cases: Cases, claim: Claim) -> Finding:
    ours, found = separations_by_load(cases)
    return finding(ours, found == [False, True, False], measures.joined(ELSEWHERE, _beyond(cases)))


@claim(
    "F18",
    "Sec. 4.3, Fig. 18",
    "No damping of the disc, N = 200 N, Omega = 10 rad/s: unstable, separation occurs",
    paper="separation",
    tolerance="any time within the run",
    reason=SEEN,
    needs=asked(F18=300),
)
def separates_undamped(cases: Cases, claim: Claim) -> Finding:
    return _separates(cases, claim, "F18")


@claim(
    "F18t",
    "Sec. 4.3, Fig. 18",
    "The same case: the trajectory of the in-plane motion changes after the first separation",
    paper="changes",
    tolerance="its width, or its share of stick, changes by three tenths at least",
    reason="what 'changes' may mean; sections are compared by eye in the paper",
    bound=0.3,
    needs=asked(separates=True, steady=True, F18=300),
)
def undamped_trajectory(cases: Cases, claim: Claim) -> Finding:
    said, changes = measures.trajectory_change(cases["F18"], claim.bound)
    return finding(f"{said}; {measures.said_motion(cases['F18'], measures.late_motion(cases['F18']))}", changes)


@claim(
    "S43z",
    "Sec. 4.3",
    "N = 200 N: without damping of the disc separation occurs at lower speeds than with D* = 1e-5 N m s",
    paper="10 rad/s against 12.6 rad/s",
    tolerance=f"within {WAITED:g} s",
    reason="longer than any of the paper's runs; how long one waits decides, see S43c",
    bound=WAITED,
    needs=asked(F18=300, S43c10=WAITED, S43c11=WAITED, S43c12=WAITED) | repeated("S43z4"),
)
def undamped_separates_lower(cases: Cases, claim: Claim) -> Finding:
    names = ("F18", "S43z4", "S43c10", "S43c11", "S43c12")
    found = sorted((cases[name]["D_star"], cases[name]["Omega"], cases[name]) for name in names)
    lowest = {
        damping: min(
            (speed for d, speed, case in found if d == damping and case["first_separation"] <= claim.bound),
            default=math.inf,
        )
        for damping in (0.0, 1e-5)
    }
    ours = "; ".join(f"D* = {damping:g}, {speed:g} rad/s: {_when(cases, case)}" for damping, speed, case in found)
    return finding(ours, lowest[0.0] < lowest[1e-5])


@claim(
    "S43d",
    "Sec. 4.3",
    "Disc damping of 2e-5 N m s makes both motions stable (speed not stated)",
    paper="stable",
    tolerance="contact force's range not growing by more than 2 %, at both speeds that the paper speaks of before",
    reason="a growth rate of 2e-5/s would show over the run",
    needs=asked(S43a126=1000, S43a10=1000),
)
def disc_damping(cases: Cases, claim: Claim) -> Finding:
    names = ("S43a126", "S43a10")
    stable = [not cases[name].separates and not _grew(cases, name) for name in names]
    ours = "; ".join(
        f"{case['Omega']:g} rad/s: {first_separation(case)}, {_range(cases, case.name)}, {said_growth(case)}"
        for case in (cases[name] for name in names)
    )
    rates = {speed: _rate_or_nan(cases["S43a10"].parameters.replace(Omega=float(speed))) for speed in SPEEDS}
    remark = f"growth by speed in rad/s: {', '.join(f'{speed:g}: {_said(rate)}' for speed, rate in rates.items())}"
    return finding(ours, all(stable), remark if any(rate > 0 for rate in rates.values()) else "")


@claim(
    "F19",
    "Sec. 4.3, Fig. 19; conclusion 4",
    "In-plane damping destabilises at N = 385 N, 15 rad/s: separation, then a periodic motion",
    paper="separation, periodic",
    tolerance="release intervals repeat to 1e-8 s",
    reason=SEEN,
    bound=1e-8,
    needs=asked(F11=190) | asked(steady=True, F19=100),
)
def inplane_damping(cases: Cases, claim: Claim) -> Finding:
    case = cases["F19"]
    motion = measures.late_motion(case, claim.bound)
    ours = f"c_p = 0: {first_separation(cases['F11'])}; c_p = 0.5: {first_separation(case)}, then "
    ours += measures.said_motion(case, motion)
    holds = not cases["F11"].separates and case.separates and motion.period > 0
    return finding(ours, holds, _where_damping_helps(case))


@claim(
    "F19d",
    "Sec. 4.3, Fig. 19",
    "The same case: after separation the disc's motion is an unstable periodic one, too",
    paper="unstable periodic",
    tolerance="height and velocity at the releases repeat to 1e-8 of the static height, or of it times Omega",
    reason="far above rounding, far below what an irregular motion would leave",
    bound=1e-8,
    needs=asked(separates=True, steady=True, F19=100),
)
def disc_repeats(cases: Cases, claim: Claim) -> Finding:
    case = cases["F19"]
    motion = measures.late_motion(case)
    events = case.events.isel(event=measures.is_kind(case.events, "stick_to_slip"))
    period = max(motion.period, 1)
    units = {"u": abs(case["u_0"]), "u_velocity": abs(case["u_0"]) * case["Omega"]}
    apart = max(
        float(np.max(np.abs(events[name].values[period:] - events[name].values[:-period]))) / unit
        for name, unit in units.items()
    )
    ours = f"seen from the slider it {measures.said_motion(case, motion)}; disc under the slider: to {apart:.0e}"
    remark = (
        "periodic as the slider sees it, and attracting, not unstable: the run came to it from elsewhere; a point "
        f"fixed to the disc has the drive's frequency besides, and its last 150 points of the section are "
        f"{measures.late_points(case, 150)} different ones"
    )
    return finding(ours.replace("it periodic: ", "it "), motion.period > 0 and apart <= claim.bound, remark)


@claim(
    "F20",
    "Sec. 4.3, Fig. 20",
    "Damping normal to the disc, c = 0.5: stable, periodic stick-slip in a small range",
    paper="stable, periodic",
    tolerance="range not growing; spread of the release intervals 1e-6",
    reason="the cycle attracts fast enough to be reached to rounding",
    bound=1e-6,
    needs=asked(steady=True, F20=300) | asked(F02=500),
)
def normal_damping(cases: Cases, claim: Claim) -> Finding:
    found = _stays_small(cases, claim, "F20")
    return replace(found, ours=f"{found.ours}, {said_growth(cases['F02'])} without the damper")


@claim(
    "F21",
    "Sec. 4.3, Fig. 21",
    "E = 100 GPa, N = 200 N, Omega = 11 rad/s: unstable but bounded, irregular, no separation",
    paper="no separation",
    tolerance="range at least doubles, then stays within a factor of 1.5; no period, 0-1 test above 0.7",
    reason="what 'unstable', 'bounded' and 'irregular' may mean; the amplitude wanders",
    needs=asked(F21=1000),
)
def soft_disc(cases: Cases, claim: Claim) -> Finding:
    case = cases["F21"]
    end = case["time_reached"]
    early = measures.early_range(case, "P")
    third, last = (case.range_of("P", a * end, b * end) for a, b in ((0.5, 0.75), (0.75, 1.0)))
    motion = measures.late_motion(case)
    ours = (
        f"{first_separation(case)}; P {early.low:.1f}..{early.high:.1f} N grows to "
        f"{last.low:.0f}..{last.high:.0f} N; then {measures.said_motion(case, motion)}"
    )
    bounded = max(third.width, last.width) < 1.5 * min(third.width, last.width)
    unstable = not case.separates and last.width > 2 * early.width and bounded
    if unstable and motion.kind is Kind.UNDECIDED:
        return undecided(ours, BETWEEN)
    remark = "irregular for good: 'seems quasi-periodic', as the paper also says, it is not by the 0-1 test"
    return finding(ours, unstable and motion.kind is Kind.IRREGULAR, remark if motion.kind is Kind.IRREGULAR else "")


@claim(
    "S43k",
    "Sec. 4.3, conclusion 4",
    "A softer spring normal to the disc separates sooner; 2e5 N/m is stable",
    paper="sooner; stable",
    tolerance="none",
    reason=ORDER,
    needs=asked(S43k2e4=0, S43k3e4=0, F02=500, S43k2e5=500),
)
def normal_stiffness(cases: Cases, claim: Claim) -> Finding:
    names = ("S43k2e4", "S43k3e4", "F02")
    times = [cases[name]["first_separation"] for name in names]
    stiff = cases["S43k2e5"]
    ours = "; ".join(f"k = {cases[name]['k']:g} N/m: {first_separation(cases[name])}" for name in (*names, "S43k2e5"))
    ours += f", {said_growth(stiff)}"
    ordered = bool(np.all(np.diff(times) > 0)) and not any(map(math.isnan, times))
    return finding(
        ours, ordered and not stiff.separates and not _grew(cases, "S43k2e5"), _between(cases["F02"], "k", 20, 50)
    )


@claim(
    "F22",
    "Sec. 4.3, Fig. 22",
    "k_p = 2e3 N/m, N = 300 N, Omega = 50 rad/s: separation, then an unpredictable wandering",
    paper="separation, wandering",
    tolerance="no period within half the record; 0-1 test above 0.7",
    reason=RETURNS,
    needs=asked(steady=True, F22=350),
)
def soft_inplane(cases: Cases, claim: Claim) -> Finding:
    case = cases["F22"]
    motion = measures.late_motion(case)
    ours = f"{first_separation(case)}; then {measures.said_motion(case, motion)}"
    if case.separates and motion.kind is Kind.UNDECIDED:
        return undecided(ours, BETWEEN)
    remark = "it wanders within a range, but repeats exactly" if motion.period else ""
    return finding(ours, case.separates and motion.kind is Kind.IRREGULAR, remark)


@claim(
    "S43kp",
    "Sec. 4.3, conclusion 4",
    "k_p = 2e4 N/m separates sooner than 2e3 N/m; 2e5 N/m is stable",
    paper="sooner; stable",
    tolerance="none",
    reason=ORDER,
    needs=asked(F22=350, S43kp2e4=100, S43kp2e5=200),
)
def inplane_stiffness(cases: Cases, claim: Claim) -> Finding:
    soft, base, stiff = (cases[name] for name in ("F22", "S43kp2e4", "S43kp2e5"))
    ours = "; ".join(
        f"k_p = {case['k_p']:g} N/m: {first_separation(case)}, {said_growth(case)}" for case in (soft, base, stiff)
    )
    sooner = base.separates and base["first_separation"] < soft["first_separation"]
    return finding(
        f"{ours}, {_range(cases, 'S43kp2e5')}",
        sooner and not stiff.separates and not _grew(cases, stiff.name),
        _between(base, "k_p", 50),
    )


@claim(
    "F23",
    "Sec. 4.3, Fig. 23; conclusion 4",
    "m = 0.01 kg: separation when the slider is at its lowest",
    paper="lowest position",
    tolerance="within 10 % of its swing and of the whole range",
    reason="read off a figure",
    bound=0.1,
    needs=asked(separates=True, F23=250),
)
def lowest_position(cases: Cases, claim: Claim) -> Finding:
    case = cases["F23"]
    window = case.samples("zoom")
    time, height = window["time"].values, window["u"].values - case["u_0"]
    starts = np.flatnonzero(np.diff((window["phase"].values == measures.SEPARATION).astype(int)) == 1) + 1
    if not starts.size:
        raise Missing("no separation in the window of case F23")
    found = separation_location(time, height, starts, claim.bound)
    # by its switches: samples come late, and the velocity of a light slider changes fast
    events = case.events.isel(event=measures.is_kind(case.events, "separation"))
    if not events.sizes["event"]:
        raise Missing("case F23 keeps no separation")
    where, speed = (float(np.median(events[name].values)) for name in ("u", "u_velocity"))
    ours = (
        f"{first_separation(case)}; {found.kind}: {1e3 * (where - case['u_0']):.1f} mm from equilibrium, "
        f"{100 * found.height:.0f} % of its swing above the lowest point of that, {speed:+.2f} m/s"
    )
    lowest, extent = height.min(), np.ptp(height)
    above = float(np.median(height[starts - 1]) - lowest) / extent
    swings = int(np.sum((np.diff(height)[1:] > 0) & (np.diff(height)[:-1] <= 0)))
    remark = ""
    if speed < 0:
        remark = f"still falling: the lowest point is {100 * found.to_lowest:.0f} % of its own swing further down"
    if starts.size < 0.9 * swings:
        remark = measures.joined(
            remark,
            f"contact is lost in {starts.size} of {swings} swings, {100 * above:.0f} % of the whole range above the "
            f"lowest point of all ({1e3 * lowest:.1f} mm)",
        )
    return finding(ours, found.kind == "at the lowest position" and bool(above <= claim.bound), remark)


@claim(
    "F23u",
    "Sec. 4.3, conclusion 4",
    "In all results but that of the light slider, separation happens while the disc moves upward",
    paper="always",
    tolerance="99 % of the separations of each case",
    reason="a general statement; single exceptions would not refute it",
    bound=0.99,
    needs=asked(steady=True, F02=600, F07=190, F09=190, F13=110, F17=850, F18=300, F19=100, F22=350),
)
def always_upward(cases: Cases, claim: Claim) -> Finding:
    shares = {}
    for name in claim.needs:
        events = cases[name].events
        velocity = events["u_velocity"].values[measures.is_kind(events, "separation")]
        if cases[name].separates and not velocity.size:
            raise Missing(f"case {name} keeps no separation")
        if velocity.size:
            shares[name] = float(np.mean(velocity > 0))
    said = ", ".join(f"{name}: {100 * share:.0f} %" for name, share in shares.items())
    return finding(f"upward in {said or 'none that separates'}", min(shares.values(), default=0.0) >= claim.bound)


@claim(
    "C4",
    "Sec. 4.3, conclusion 4",
    "In-plane damping destabilises at a large preload, though not in general",
    paper="destabilises at 385 N",
    tolerance="none",
    reason="runs of 200 s and more from the published start decide it",
    needs=asked(F11=190, F19=100, C4cp01=290, C4cp1=290, C4cpN50=290),
)
def inplane_damping_alone(cases: Cases, claim: Claim) -> Finding:
    names = ("F11", "C4cp01", "F19", "C4cp1")
    said = [f"{cases[name]['c_p']:g}: {first_separation(cases[name])}, {said_growth(cases[name])}" for name in names]
    small = cases["C4cpN50"]
    said.append(f"N = 50 N, c_p = {small['c_p']:g}: {first_separation(small)}")
    damped = [cases[name].separates for name in names[1:]]
    remark = ("" if all(damped) else "not for every value of c_p; ") + _where_damping_helps(cases["F19"])
    ours = "N = 385 N, c_p in N s/m = " + "; ".join(said)
    return finding(ours, not cases["F11"].separates and any(damped) and not small.separates, remark)


@claim(
    "S43E",
    "Sec. 4.3",
    "A stiffer disc is more stable, a softer one less",
    paper="monotonous",
    tolerance="none",
    reason=ORDER,
    needs=asked(S43E100=590, F02=500, S43E200=1000, F21=1000),
)
def elasticity(cases: Cases, claim: Claim) -> Finding:
    soft, base, stiff = (cases[name] for name in ("S43E100", "F02", "S43E200"))
    rates = [measures.growth_rate(case) for case in (soft, base, stiff)]
    said = [
        f"{case['E'] / 1e9:g} GPa: {first_separation(case)}, growth {rate:+.4f}/s"
        for case, rate in zip((soft, base, stiff), rates, strict=True)
    ]
    low = cases["F21"]
    low_rates = [measures.growth_rate(low), measures.cycle_of(low.parameters.replace(E=150e9)).growth_rate]
    remark = (
        f"at 20 rad/s the soft disc is {'stable' if rates[0] < 0 else 'unstable'}; at 11 rad/s growth "
        f"is {low_rates[0]:+.4f}/s for 100 GPa and {low_rates[1]:+.4f}/s for 150 GPa"
    )
    monotonous = rates[0] > rates[1] > rates[2]
    return finding(
        "at 20 rad/s, " + "; ".join(said),
        monotonous and rates[2] < 0,
        remark if monotonous else f"not monotonous: {remark}",
    )


@claim(
    "C4E",
    "Conclusion 4",
    "Separation does not happen when the disc is soft enough",
    paper="may not happen",
    tolerance="none at any speed for the softest disc of a map, nor for any up to some stiffness",
    reason="'enough' names a bound below which it holds",
    scans=("map_E",),
)
def soft_enough(cases: Cases, claim: Claim) -> Finding:
    study = cases["map_E"].node.to_dataset().sel(normalization="as_published").sortby(["E", "Omega"])
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
    softer = [
        (value, Omega[row].min()) for value, row in zip(E, apart, strict=True) if row.any() and value < E[~some].min()
    ]
    said = ", ".join(f"{value:.4g} GPa from {speed:.3g} rad/s up" for value, speed in softer)
    return finding(ours, not softer, f"softer discs separate again: {said}" if softer else "")


@claim(
    "F22a",
    "Sec. 4.3, Fig. 22",
    "k_p = 2e3 N/m: at first the disc vibrates quasi-periodically",
    paper="quasi-periodic",
    tolerance="a line of ψ within 0.05 Hz of the frequency that the cycle's leading pair of multipliers brings",
    reason="twice what 40 s resolve; the line must be a thousandth of the strongest at least",
    bound=0.05,
    needs=asked(F22=350),
)
def quasi_periodic_at_first(cases: Cases, claim: Claim) -> Finding:
    """A second frequency of the in-plane motion, long before separation, and whether it is there to stay."""
    case = cases["F22"]
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
    brings = abs(leading.imag) > 0 and second is not strongest and off <= claim.bound
    return finding(ours, brings and cycle.growth_rate > 0, remark)


@claim(
    "S43b",
    "Sec. 4.1, 4.3; conclusion 3",
    "After separation the disc's vibration is bounded",
    paper="bounded",
    tolerance="range of the last quarter after the first separation no more than 1.02 times that of the one before",
    reason="the amplitude wanders a little",
    bound=1.02,
    needs=asked(separates=True, F02=600, F07=190, F17=850, F13=110),
)
def bounded(cases: Cases, claim: Claim) -> Finding:
    said, bounded = [], []
    for name in ("F02", "F07", "F17", "F13"):
        case = cases[name]
        first, end = case["first_separation"], case["time_reached"]
        quarter = (end - first) / 4
        before = case.range_of("w_point", end - 2 * quarter, end - quarter).width
        late = case.range_of("w_point", end - quarter, end).width
        said.append(f"{name}: {1e3 * late:.1f} mm")
        bounded.append(late <= claim.bound * before)
    return finding("range of the disc in the end, " + ", ".join(said), all(bounded))


@claim(
    "C3",
    "Sec. 4.3, conclusion 3",
    "After separation the stick phase disappears under some parameter values",
    paper="under some",
    tolerance="0.1 % of the time",
    reason="a stray stick would not refute the statement",
    bound=1e-3,
    needs=asked(separates=True, steady=True, F02=600, F07=190, F09=190, F13=110, F17=850) | others("F02", "F07", "F17"),
)
def stick_may_vanish(cases: Cases, claim: Claim) -> Finding:
    shares = {name: measures.phase_share(cases[name], "stick") for name in ("F02", "F07", "F09", "F13", "F17")}
    remark = measures.another_motion(*((cases[name], cases[other]) for name, other in OTHERS.items()))
    said = [
        f"N = {cases[name]['N']:g} N, {cases[name]['Omega']:g} rad/s: {100 * share:.1f} %"
        for name, share in shares.items()
    ]
    return finding(
        "time sticking long after the first separation: " + "; ".join(said), min(shares.values()) <= claim.bound, remark
    )


# ----------------------------------------------------------------------------------------------------
# What several checks use


def _where_damping_helps(case: CaseView) -> str:
    """At how many loads and speeds in-plane damping lowers the growth of the cycle, raises it, or ends the cycle."""
    points = [
        case.parameters.replace(N=N, Omega=speed)
        for N in (50, 125, 200, 300, 385, 600)
        for speed in (10, 15, 20, 30, 40)
    ]
    rates = [(p, _rate_or_nan(p.replace(c_p=0.0)), _rate_or_nan(p)) for p in points]
    lower = sum(damped < without for _, without, damped in rates)
    raised = [
        f"{p.N:g} N, {p.Omega:g} rad/s: {without:+.4f} to {damped:+.4f}/s"
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
        rates = np.array([_rate_or_nan(p) for p in stiffened])
        falls &= not np.any(np.diff(rates[np.isfinite(rates)]) > 0)
        said.append(
            f"at {speed:g} rad/s growth is {', '.join(map(_said, rates))} per second for "
            f"{', '.join(map(str, STIFFNESSES[spring]))} kN/m"
        )
    return "" if falls else f"in between, the effect is not monotonous: {'; '.join(said)}"


def _said(rate: float) -> str:
    """A growth rate."""
    return "no cycle" if math.isnan(rate) else f"{rate:+.4f}"


def _when(cases: Cases, case: CaseView) -> str:
    """When a case first separates, by all that repeat it."""
    return first_separation(case, *(cases[name] for name in REPEATS.get(case.name, ())))


def _beyond(cases: Cases) -> str:
    """What larger preloads than those that the paper tries do, if they are not stable; else nothing."""
    further, largest = cases["S43N550"], cases["S43N600"]
    said = [f"N = {further['N']:g} N: {_when(cases, further)}"] if further.separates else []
    if largest.separates or _grew(cases, largest.name):
        said.append(f"N = {largest['N']:g} N: {first_separation(largest)}, {said_growth(largest)}")
    return f"further increase makes it unstable again: {'; '.join(said)}" if said else ""


def _rate_or_nan(p: Parameters) -> float:
    try:
        return measures.cycle_of(p).growth_rate
    except Missing:
        return math.nan


def _stays_small(cases: Cases, claim: Claim, name: str) -> Finding:
    """Whether a case does not separate, its contact force ranges no wider in the end, and releases are regular."""
    case, intervals = cases[name], measures.release_intervals(cases[name])
    spread = measures.irregularity(intervals)
    ours = f"{first_separation(case)}; {_range(cases, name)}; {1 / intervals.mean():.3f} Hz, spread {spread:.1e}"
    ours += f"; {said_growth(case)}"
    return finding(ours, not case.separates and not _grew(cases, name) and spread <= claim.bound)


def _grew(cases: Cases, name: str) -> bool:
    """Whether the contact force ranges wider at the end than at first, by more than 2 %; sampling feigns far less."""
    early, late = (measures.early_range(cases[name], "P"), measures.late_range(cases[name], "P"))
    return late.width > 1.02 * early.width


def _range(cases: Cases, name: str) -> str:
    late = measures.late_range(cases[name], "P")
    return f"P {late.low:.2f}..{late.high:.2f} N in the end"


def _separates(cases: Cases, claim: Claim, name: str) -> Finding:
    return finding(f"{first_separation(cases[name])}; {said_growth(cases[name])}", cases[name].separates)
