"""Claims of Section 4.1: separation occurs, and ignoring it changes everything."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np
import xarray as xr

from disc_model.analysis import spectra
from disc_model.analysis.classify import closure, irregularity, stick_disappears
from disc_model.claims import measures
from disc_model.claims.cases import asked, others
from disc_model.claims.measures import first_separation, pairs
from disc_model.claims.model import CaseView, Claim, Finding, Missing, finding, undecided

PAIRED = asked(
    separates=True, steady=True, F02=600, F04=790, F06=200, F07=190, F08=500, F09=190, F13=110, F13bonded=110
) | asked(separates=True, steady=True, F17=850, F17bonded=850)
"""With separation and without it: three pairs that the paper shows, and two cases of it with counterparts of ours."""
INTRICATE = "no period of fewer than 4 releases"
PERIODIC = "a periodic motion repeats to rounding; 1e-6 leaves room for a slow approach to it"
POINTS = 500
"""Of a section: more than a closed curve takes to be full."""
FULL = 1.1
"""A section is full if its last points hold no more different ones than the last half of them, but for so much."""
RETURNS = "a period has to be seen twice and to close a thousand times better than near returns do"


@Claim(
    "F02a",
    "Sec. 4.1, Fig. 2a",
    "N = 200 N, Omega = 20 rad/s: the contact force's range grows until contact is lost",
    paper="shown",
    tolerance="range at least doubles",
    reason="the paper gives no time for it",
    needs=asked(separates=True, F02=600),
)
def force_grows_to_zero(case: CaseView) -> Finding:
    early, before = measures.early_range(case, "P"), case["first_separation"]
    late = case.range_of("P", before - 20, before)
    ours = f"{early.said(2)} N at first, {late.said(1)} N before separation; {first_separation(case)}"
    return finding(ours, late.width > 2 * early.width)


@Claim(
    "F02b",
    "Sec. 4.1, Fig. 2b",
    "Separations repeat within 602.115..602.150 s, with no contact force in them",
    paper="several",
    tolerance="at least 2; P exactly 0",
    reason="when the window begins within a cycle depends on the method's rounding",
    needs=asked(separates=True, steady=True, F02=602.15),
)
def separations_repeat(case: CaseView) -> Finding:
    window = case.samples("zoom")
    apart = window["phase"].values == measures.SEPARATION
    count = int(np.sum(np.diff(apart.astype(int)) == 1))
    force = float(np.abs(window["P"].values[apart]).max(initial=0.0))
    span = float(window["time"][-1] - window["time"][0])
    rate = measures.rate_of(case, "separation")
    ours = f"{count} in {span * 1e3:.0f} ms, {rate:.1f}/s; P = {force:g} N between"
    return finding(ours, count >= 2 and force == 0.0, "that P = 0 in them is so by construction")


@Claim(
    "F03a",
    "Sec. 4.1, Fig. 3",
    "Contact is lost while the disc moves upward",
    paper="upward",
    tolerance="99 % of separations",
    reason="a general statement; single exceptions would not refute it",
    needs=asked(separates=True, steady=True, F02=600),
)
def contact_is_lost_upward(case: CaseView) -> Finding:
    lost = measures.switches(case, "separation")
    velocity, height = lost["u_velocity"].values, lost["u"].values - case["u_0"]
    share = float(np.mean(velocity > 0))
    ours = (
        f"{100 * share:.0f} % of {velocity.size}: mean velocity {velocity.mean():+.2f} m/s, "
        f"{1e3 * height.mean():+.1f} mm from equilibrium"
    )
    return finding(ours, share >= 0.99)


@Claim(
    "F03b",
    "Sec. 4.1, conclusion 1",
    "Separations are very short and always end in contact",
    paper="very short",
    tolerance="each shorter than a quarter of the time between two, and none still open by then",
    reason="what 'short' may mean beside the vibration's period",
    needs=asked(separates=True, steady=True, F02=600),
)
def separations_are_short(case: CaseView) -> Finding:
    durations, still_open = measures.separation_durations(case)
    share = measures.phase_share(case, "separation")
    period = 1 / measures.rate_of(case, "separation")
    ours = (
        f"median {1e3 * np.median(durations):.2f} ms, longest {1e3 * durations.max():.2f} ms "
        f"of {1e3 * period:.2f} ms between separations; {100 * share:.0f} % of the time"
    )
    if still_open > 0:
        ours += f"; the last one lasts since {1e3 * still_open:.2f} ms"
    return finding(ours, bool(max(durations.max(), still_open) < 0.25 * period))


def _releases_regularly(case: CaseView) -> Finding:
    intervals, late = measures.release_intervals(case), measures.late_range(case, "P")
    spread = irregularity(intervals)
    ours = f"one release per {1e3 * intervals.mean():.3f} ms, spread {spread:.1e}; P {late.said(0)} N"
    return finding(ours, spread <= 1e-6)


without_separation = partial(
    Claim,
    check=_releases_regularly,
    paper="periodic",
    tolerance="spread of the release intervals 1e-6",
    reason=PERIODIC,
)
quasi_periodic = partial(
    Claim,
    check=measures.is_quasi_periodic,
    paper="quasi-periodic",
    tolerance="no period within half the record; 0-1 test below 0.3",
    reason=RETURNS,
)
bonded_is_periodic = without_separation(
    "F04",
    "Sec. 4.1, Figs. 4, A1",
    "Separation ignored, N = 200 N, Omega = 20 rad/s: in-plane motion becomes periodic",
    needs=asked(steady=True, F04=790),
)
separation_is_quasi_periodic = quasi_periodic(
    "F05",
    "Sec. 4.1, Figs. 5, A2",
    "With separation: in-plane motion is quasi-periodic",
    needs=asked(separates=True, steady=True, F02=600) | others("F02"),
)
bonded_is_periodic_with_larger_preload = without_separation(
    "F06",
    "Sec. 4.1, Fig. 6",
    "Separation ignored, N = 300 N, Omega = 20 rad/s: periodic",
    needs=asked(steady=True, F06=200),
)
separation_is_quasi_periodic_with_larger_preload = quasi_periodic(
    "F07",
    "Sec. 4.1, Fig. 7; Sec. 4.4, Fig. 28",
    "With separation, N = 300 N, Omega = 20 rad/s: in-plane motion is quasi-periodic",
    needs=asked(separates=True, steady=True, F07=190) | others("F07"),
)


@Claim(
    "F08",
    "Sec. 4.1, Fig. 8",
    "Separation ignored, N = 200 N, Omega = 50 rad/s: a steady state of stick and slip",
    paper="steady",
    tolerance="steady by the test; 1 % of the time sticking",
    reason="the text says steady here, periodic only of Figs. 4 and 6",
    needs=asked(steady=True, F08=500),
)
def bonded_is_steady(case: CaseView) -> Finding:
    late, share = measures.late_range(case, "P"), measures.phase_share(case, "stick")
    motion, said = measures.late_motion(case)
    remark = "" if motion.period else f"locked to the coupled mode but slowly modulated: {motion}"
    return finding(f"P {late.said(0)} N; sticks {100 * share:.0f} % of the time; {said}", share > 0.01, remark)


@Claim(
    "F09",
    "Sec. 4.1, Fig. 9; conclusion 3",
    "With separation, N = 200 N, Omega = 50 rad/s: the stick phase disappears",
    paper="no stick",
    tolerance="0.1 % of the time",
    reason="a stray stick would not refute the statement",
    needs=asked(separates=True, steady=True, F09=190),
)
def stick_is_gone(case: CaseView) -> Finding:
    whole, late = case["time_stick"] / case["time_reached"], measures.phase_share(case, "stick")
    ours = f"{first_separation(case)}; sticks {100 * whole:.1f} % of the whole run, {100 * late:.2f} % of the last 20 s"
    return finding(ours, stick_disappears(whole, late, 1e-3))


@Claim(
    "F10",
    "Sec. 4.1, Fig. 10",
    "Separation keeps the disc's vibration in a much smaller range, in the pairs of Figs. 4 to 9",
    paper="much smaller",
    tolerance="less than half",
    reason="what 'much smaller' may mean; read off a figure without numbers in the text",
    needs=PAIRED,
)
def much_smaller_range(*cases: CaseView) -> Finding:
    ratios, said = _ranges(pairs(cases)[:3])
    others, more = _ranges(pairs(cases)[3:])
    return finding(said, max(ratios) < 0.5, f"not in general: {more}" if max(others) >= 0.5 else "")


@Claim(
    "C3s",
    "Conclusion 3",
    "With separation the disc's vibration is bounded within a smaller range than without",
    paper="smaller",
    tolerance="smaller in each of five pairs",
    reason="only the order is claimed",
    needs=PAIRED,
)
def smaller_range(*cases: CaseView) -> Finding:
    ratios, said = _ranges(pairs(cases))
    return finding(said, max(ratios) < 1)


@Claim(
    "S41c",
    "Sec. 4.1, Figs. 4 to 7",
    "More frequencies take part in the disc's vibration with separation than without",
    paper="more",
    tolerance="lines above a thousandth of the strongest, below 2000 Hz",
    reason="the paper counts points by eye; lines do not depend on how long one looks",
    needs=asked(separates=True, steady=True, F02=600, F04=790, F06=200, F07=190),
)
def more_frequencies(*cases: CaseView) -> Finding:
    said, more = [], []
    for pair in pairs(cases):
        windows = [case.samples("late") for case in pair]
        lines = [len(spectra.lines(w["time"].values, w["w_point"].values, above=1.0, floor=1e-3)) for w in windows]
        said.append(f"N = {pair[0]['N']:g} N: {lines[0]} lines against {lines[1]}")
        more.append(lines[0] > lines[1])
    return finding("; ".join(said), all(more), "the paper argues from the number of points: see S41p")


@Claim(
    "S41p",
    "Sec. 4.1, Figs. 4 to 7",
    "There are more points in the disc's sections with separation than without",
    paper="more",
    tolerance="a fifth more, of the last 500, apart by more than a hundredth of the section",
    reason="by so much counts of one section differ; 500 points fill the sections without separation",
    needs=asked(separates=True, steady=True, F02=600, F04=790, F06=200, F07=190),
)
def more_points(*cases: CaseView) -> Finding:
    """More than the section without separation can have: as many points as it takes to fill that."""
    said, more, filling = [], [], []
    for free, bonded in pairs(cases):
        points, full = (measures.late_points(case, POINTS) for case in (free, bonded))
        said.append(f"N = {free['N']:g} N: {points} points against {full}")
        more.append(points >= 1.2 * full)
        if full > FULL * measures.late_points(bonded, POINTS // 2):
            filling.append(bonded.name)
    if filling:
        return undecided("; ".join(said), f"{POINTS} points do not fill the section of {', '.join(filling)}")
    return finding("; ".join(said), all(more))


@Claim(
    "S41d",
    "Sec. 4.1, conclusion 3",
    "After separation the slider's in-plane trajectory is another one",
    paper="totally different",
    tolerance="its width, or the share of time in stick, changes by three tenths at least",
    reason="what 'different' may mean; sections are compared by eye in the paper",
    needs=asked(separates=True, steady=True, F02=600, F07=190, F09=190) | others("F02", "F07"),
)
def trajectory_changes(*cases: CaseView) -> Finding:
    found = [measures.trajectory_change(case) for case in cases[:3]]
    remark = measures.another_motion(*zip(cases[:2], cases[3:], strict=True))
    return finding("; ".join(said for said, _ in found), all(changed for _, changed in found), remark)


@Claim(
    "A1",
    "Appendix, Fig. A1",
    "Separation ignored: the slider's orbit in the phase plane is a closed stick-slip cycle",
    paper="closed",
    tolerance="1e-6 of its width",
    reason=PERIODIC,
    needs=asked(steady=True, F04=790),
)
def bonded_orbit_closes(case: CaseView) -> Finding:
    """Whether it returns to itself at each release."""
    psi = measures.switches(case, "stick_to_slip")["psi"].values
    if psi.size < 20:
        raise Missing(f"case {case.name} keeps fewer than 20 releases")
    apart = min(closure(psi, n) for n in range(1, 9))
    width = float(np.ptp(case.samples("orbit")["psi"].values))
    apart = measures.ratio(apart, width, f"the width of the orbit of case {case.name}")
    return finding(f"releases of up to 8 cycles apart differ by {apart:.1e} of the orbit's width", apart <= 1e-6)


intricate_orbit = Claim(
    "A2",
    "Appendix, Fig. A2",
    "With separation: the orbit is no regular cycle any more but an intricate one",
    check=measures.is_intricate,
    paper="intricate",
    tolerance=INTRICATE,
    reason="what 'intricate' may mean beside one release a period without separation; F05 judges 'quasi-periodic'",
    needs=asked(separates=True, steady=True, F02=600) | others("F02"),
)


@Claim(
    "E24",
    "Sec. 2.3, Eq. (24)",
    "Slip goes on as long as r_0 |c_p ψ' + k_p ψ| < μ_s P",
    paper="<",
    tolerance="none",
    reason="any slip that ends in stick although the relation is true refutes it",
    needs=asked(F02=0, F04=0),
)
def slip_condition(*cases: CaseView) -> Finding:
    """The relation where the slider stops on the disc: ψ' = Ω there, and c_p = 0 in both cases."""
    true, ends = 0, 0
    for case in cases:
        stops = measures.switches(case, "slip_to_stick")
        pull = case["r_0"] * np.abs(case["c_p"] * case["Omega"] + case["k_p"] * stops["psi"].values)
        true += int(np.sum(pull < case["mu_s"] * stops["P"].values))
        ends += stops.sizes["event"]
    if not ends:
        raise Missing("no case keeps an end of slip")
    remark = "a misprint for ≥, as Eq. (2) has it: so printed it is Eq. (20), for stick" if true else ""
    return finding(f"true at {true} of {ends} ends of slip, where the slider sticks", not true, remark)


@Claim(
    "S41a",
    "Sec. 4.1",
    "Separation ignored: stick and slip go on whatever preload and speed",
    paper="always",
    tolerance="0.1 % of the time sticking, at every point of a scan that has settled",
    reason="what counts as no stick in F09 and C3; where the motion still changes, its share of stick decides nothing",
    scans=("bonded",),
)
def bonded_always_sticks(study: xr.Dataset) -> Finding:
    """Over a grid of preloads and speeds; not only where the paper looks."""
    points = study[["share_stick", "settled"]].stack(point=("N", "Omega"))
    if np.isnan(points["share_stick"]).any():
        raise Missing("study bonded has points that failed")
    settled = points.where(np.isfinite(points["settled"]), drop=True)["share_stick"]
    moving = points.where(np.isnan(points["settled"]), drop=True)["share_stick"]
    N, Omega = study["N"].values, study["Omega"].values
    said = f"of {points.sizes['point']} points of {N.min():g}..{N.max():g} N, {Omega.min():g}..{Omega.max():g} rad/s, "
    if not settled.size:
        return undecided(f"{said}none has settled", "no motion of the scan is known to be in its steady state")
    ours = f"{said}{settled.size} have settled: sticks {_least_stick(settled)}"
    remark = f"undecided at {moving.size} that still change: by now {_least_stick(moving)}" if moving.size else ""
    return finding(ours, float(settled.min()) > 1e-3, remark)


def _least_stick(shares: xr.DataArray) -> str:
    """The least share of stick of some points, and where it is."""
    least = shares[int(np.argmin(shares.values))]
    return f"{100 * least.item():.2g} % of the time or more, least at {measures.place(least.N, least.Omega)}"


@Claim(
    "S41b",
    "Sec. 4.1",
    "Poincare points of the stick phase lie on a horizontal line",
    paper="horizontal",
    tolerance="1e-12 rad/s",
    reason="sticking fixes the relative velocity exactly",
    needs=asked(F02=0, F04=790),
)
def stick_on_a_line(*cases: CaseView) -> Finding:
    worst, count = 0.0, 0
    for case in cases:
        samples = case.samples("poincare")
        stuck = samples["phase"].values == measures.STICK
        count += int(stuck.sum())
        deviation = np.abs(samples["psi_velocity"].values[stuck] - case["Omega"])
        worst = max(worst, float(deviation.max(initial=0.0)))
    ours = f"largest deviation from Omega {worst:g} rad/s at {count} stick points"
    return finding(ours, worst <= 1e-12, "by construction: to stick is to move with the drive")


def _ranges(compared: Sequence[tuple[CaseView, CaseView]]) -> tuple[list[float], str]:
    """Late ranges of the disc with separation over those without, and all of it in words."""
    ratios, said = [], []
    for case, ignored in compared:
        free, bonded = (measures.late_range(each, "w_point").width for each in (case, ignored))
        ratios.append(measures.ratio(free, bonded, f"the range of the disc in case {ignored.name}"))
        said.append(
            f"N = {measures.place_of(case)}: {1e3 * free:.1f} mm, without separation {1e3 * bonded:.1f} mm "
            f"(ratio {ratios[-1]:.2f})"
        )
    return ratios, "; ".join(said)
