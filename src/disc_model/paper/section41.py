"""Claims of Section 4.1: separation occurs, and ignoring it changes the motion."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from disc_model.analysis import spectra
from disc_model.analysis.classify import closure, irregularity
from disc_model.analysis.poincare import distinct_points
from disc_model.data.dataset import Missing
from disc_model.data.variables import Outcome, flag_names
from disc_model.paper import energy, measures
from disc_model.paper.measures import Absent, CaseView, is_kind, pairs
from disc_model.paper.model import Answer

FULL = 1.1
"""A section is full if its last points hold at most this factor more distinct points than their last half."""


def force_grows_to_zero(case: CaseView, *, factor: float, fewest: float) -> Answer:
    if not case.separates:
        raise Absent(f"case {case.name}: no separation in {case['time_reached']:g} s")
    before = case["first_separation"]
    late, count = case.range_of("P", before - 20, before), case["n_separations"]
    return Answer(late.width > factor * case.early.width and count >= fewest, late=late, count=count)


def separations_repeat(case: CaseView, *, fewest: float) -> Answer:
    window = case.samples("zoom")
    apart = window["phase"].values == measures.SEPARATION
    count = int(np.sum(np.diff(apart.astype(int)) == 1))
    force = float(np.abs(window["P"].values[apart]).max(initial=0.0))
    span = float(window["time"][-1] - window["time"][0])
    rate = case.rate_of("separation")
    return Answer(count >= fewest and force == 0.0, count=count, span=span, rate=rate, force=force)


def separations_are_short(*cases: CaseView, part: float) -> Answer:
    found = []
    for case in cases:
        durations, still_open = case.separation_durations()
        longest, period = max(durations.max(), still_open), 1 / case.rate_of("separation")
        found.append({"case": case, "lasts": longest, "period": period, "share": longest / period})
    return Answer(max(row["share"] for row in found) < part, longest=found)


def separations_end(*cases: CaseView, factor: float) -> Answer:
    """Whether no separation lasts much longer than the longest one that has ended."""
    lasting, count = [], 0
    for case in cases:
        durations, still_open = case.separation_durations()
        count += durations.size
        if still_open > factor * durations.max():
            lasting.append({"case": case, "time": still_open})
    return Answer(not lasting, count=count, lasting=lasting)


def releases_regularly(case: CaseView, *, within: float) -> Answer:
    intervals = case.intervals()
    spread = irregularity(intervals)
    return Answer(spread <= within, interval=intervals.mean(), rate=1 / intervals.mean(), spread=spread)


def is_quasi_periodic(case: CaseView, _: CaseView, near: CaseView, *, shown: float, closes: float) -> Answer:
    """Whether the in-plane motion is quasi-periodic; ``near`` has the same start and a spring 0.1 % stiffer."""
    motion, beside = (each.late_motion(closes) for each in (case, near))
    length = case.intervals()[: motion.period].sum() if motion.period else 0.0
    return Answer(
        *is_kind(Outcome.QUASI_PERIODIC, motion, near=beside),
        longer=length > shown,
        within=0 < length <= shown,
        irregular=motion.kind is Outcome.IRREGULAR,
        nearby=measures.nearby(motion, beside),
    )


def bonded_is_steady(case: CaseView, *, share: float) -> Answer:
    return Answer(case.stick > share, modulated=not case.late_motion().period)


def bonded_cases_stick(*cases: CaseView, share: float) -> Answer:
    return Answer(min(case.stick for case in cases) > share)


def smaller_range(*cases: CaseView, ratio: float, shown: float) -> Answer:
    """Decided by the first pairs, which the paper shows; the results of the others are a remark."""
    rows = _ranges(cases)
    first, others = rows[: int(shown)], rows[int(shown) :]
    exceeds = max((row["ratio"] for row in others), default=0.0) >= ratio
    return Answer(max(row["ratio"] for row in first) < ratio, ranges=first, others=others if exceeds else [])


def excites_while_negative(free: CaseView, bonded: CaseView) -> Answer:
    """Whether the contact force still feeds the disc where it is negative: there separation would end it."""
    found = []
    for case in (bonded, free):
        windows = [case.samples(f"field{i}") for i in range(2 * case.parameters.n_diameters + 1)]
        theta = np.array([window.attrs["theta"] for window in windows])
        found.append(energy.powers(case.parameters, case["u_0"], theta, windows))
    kept, held = found
    return Answer(kept.pulls > 0, kept=kept, held=held, takes=kept.pulls <= 0)


def excites_less(*cases: CaseView, part: float) -> Answer:
    """Whether separation withholds energy that maintained contact supplies, at the amplitude that separation allows."""
    rows, withheld = [], []
    for free, bonded in pairs(cases):
        held = energy.in_the_end(energy.course(free.parameters, free["time_reached"]))
        kept = energy.course(bonded.parameters, bonded["time_reached"])
        there, cycle = energy.at_width(kept, held.width), float(free.intervals("separation").mean())
        withheld.append(measures.ratio(there.supplied - held.supplied, there.gained, f"the surplus of {bonded.name}"))
        mJ = {"free": held.supplied, "kept": there.supplied, "surplus": there.gained}
        mJ |= {"damped": held.damped, "impacts": held.impacts}
        mJ = {name: 1e3 * power * cycle for name, power in mJ.items()}
        rows.append({"case": free, "width": held.width, "most": kept[-1].width, **mJ})
    return Answer(min(withheld) >= part, pairs=rows, impacts=max(withheld) < part)


def _ranges(cases: Sequence[CaseView]) -> list[dict[str, Any]]:
    """Pairs, and the late range of the disc with separation over that without it."""
    rows = []
    for case, bonded in pairs(cases):
        ratio = measures.ratio(case.disc.width, bonded.disc.width, f"the range of the disc in case {bonded.name}")
        rows.append({"case": case, "bonded": bonded, "ratio": ratio})
    return rows


def more_frequencies(*cases: CaseView, floor: float) -> Answer:
    rows: list[dict[str, Any]] = []
    for pair in pairs(cases):
        windows = [case.samples("late") for case in pair]
        free, bonded = (
            len(spectra.lines(w["time"].values, w["w_point"].values, above=1.0, floor=floor)) for w in windows
        )
        rows.append({"case": pair[0], "free": free, "bonded": bonded, "more": free > bonded})
    published, another = _by_start(rows)
    more, too = (all(row["more"] for row in found) for found in (published, another))
    return Answer(more, pairs=published, another=another, otherwise=more and not too)


def _by_start(rows: Sequence[dict[str, Any]]) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    """Rows of cases from the static start, and of those from another one that separate."""
    others = [row for row in rows if not row["case"].from_rest and row["case"].separates]
    return [row for row in rows if row["case"].from_rest], others


def more_points(*cases: CaseView, last: float, factor: float) -> Answer:
    """Whether the section has `factor` times as many points as one without separation that is filled."""
    found: list[dict[str, Any]] = []
    filling, more, points = [], [], int(last)
    for free, bonded in pairs(cases):
        sections = [case.late_section(points) for case in (free, bonded)]
        larger = np.maximum(*(np.ptp(section, axis=0) for section in sections))
        ours, full = map(distinct_points, sections)
        common, common_full = (distinct_points(section, larger) for section in sections)
        counts = {"points": ours, "full": full, "common": common, "common_full": common_full}
        found.append({"case": free, **counts})
        more += [ours >= factor * full, common >= factor * common_full] if free.from_rest else []
        if full > FULL * distinct_points(bonded.late_section(points // 2)):
            filling.append(bonded.name)
    published, another = _by_start(found)
    holds = None if filling or len({*more}) > 1 else more[0]
    why = "filling" if filling else "scale"
    return Answer(holds, why, pairs=published, another=another, filling=[*dict.fromkeys(filling)])


def trajectory_changes(*cases: CaseView, share: float) -> Answer:
    """Whether the width of the section, or the fraction of its points in stick, changes with the first separation.

    The control is the case without separation over the same times. A change that occurs there too decides nothing.
    """
    published = [case for case in cases if case.from_rest]
    found, changes, own = [], [], []
    for case, bonded in pairs(published):
        first, end = case["first_separation"], min(case["time_reached"], bonded["time_reached"])
        before, after = case.sections(first, end)
        _, control = bonded.sections(first, end)
        changed, ignored = before.changed(after, share), before.changed(control, share)
        changes.append(any(changed))
        own.append(any(a and a != b for a, b in zip(changed, ignored, strict=True)))
        found.append({"case": case, "before": before, "after": after, "ignored": control})
    return Answer(None if all(changes) and not all(own) else all(own), "control", changes=found)


def very_different(*cases: CaseView, factor: float, ways: float, part: float = 0.0) -> Answer:
    """Whether that part of the pairs, or one, differs by a factor in so many ``ways``: range of the disc, stick."""
    rows = _ranges([case for case in cases if case.from_rest])
    for row in rows:
        shares = row["case"].stick, row["bonded"].stick
        row["ways"] = (row["ratio"] * factor <= 1) + (max(shares) >= factor * min(shares))
    count = sum(row["ways"] >= ways for row in rows)
    return Answer(count >= max(1, part * len(rows)), pairs=rows, count=count, of=len(rows))


def should_be_considered(*cases: CaseView) -> Answer:
    """Undecided: computations of one system cannot decide for many."""
    return Answer(None, ranges=_ranges(cases))


def bonded_orbit_closes(case: CaseView, *, within: float) -> Answer:
    """Whether the orbit returns to itself at each release."""
    psi = case.switches("stick_to_slip")["psi"].values
    if psi.size < 20:
        raise Missing(f"case {case.name} keeps fewer than 20 releases")
    apart = min(closure(psi, n) for n in range(1, 9))
    width = float(np.ptp(case.samples("orbit")["psi"].values))
    apart = measures.ratio(apart, width, f"the width of the orbit of case {case.name}")
    return Answer(apart <= within, apart=apart)


def is_intricate(case: CaseView, _: CaseView, *near: CaseView, most: float) -> Answer:
    """Whether the in-plane motion has no short period; ``near`` as in `is_quasi_periodic`."""
    motion = case.late_motion()
    nearby = [row for each in near for row in measures.nearby(motion, each.late_motion())]
    return Answer(not 0 < motion.period <= most, periodic=motion.period > 0, nearby=nearby)


def slip_condition(*cases: CaseView) -> Answer:
    """Check the relation at a stop of the slider: ψ' = Ω there, and c_p = 0 in both cases."""
    true, ends = 0, 0
    for case in cases:
        stops = case.switches("slip_to_stick")
        pull = case["r_0"] * np.abs(case["c_p"] * case["Omega"] + case["k_p"] * stops["psi"].values)
        true += int(np.sum(pull < case["mu_s"] * stops["P"].values))
        ends += stops.sizes["event"]
    if not ends:
        raise Missing("no case keeps an end of slip")
    return Answer(not true, misprint=true, ends=ends)


def bonded_always_sticks(study: xr.Dataset, *, share: float) -> Answer:
    """Check a grid of preloads and speeds, not only the paper's points."""
    points = study[["stick_fraction", "settled"]].stack(point=("N", "Omega"))
    if np.isnan(points["stick_fraction"]).any():
        raise Missing("study bonded has points that failed")
    still = points["settled"].copy(data=flag_names(points["settled"]) == "settled")
    settled, moving = (points["stick_fraction"].where(there, drop=True) for there in (still, ~still))
    return Answer(
        None if moving.size else float(settled.min()) > share,
        "moving",
        count=points.sizes["point"],
        settled=[{"count": settled.size, "least": _least_stick(settled)}] if settled.size else [],
        moving=moving.size,
        least=_least_stick(moving) if moving.size else "",
    )


def _least_stick(shares: xr.DataArray) -> str:
    """The least fraction of stick among some points, and its place."""
    least = shares[int(np.argmin(shares.values))]
    return f"{100 * least.item():.2g} % of the time or more, least at {measures.place(least.N, least.Omega)}"


def stick_on_a_line(*cases: CaseView, within: float) -> Answer:
    worst, count = 0.0, 0
    for case in cases:
        samples = case.samples("poincare")
        stuck = samples["phase"].values == measures.STICK
        count += int(stuck.sum())
        deviation = np.abs(samples["psi_velocity"].values[stuck] - case["Omega"])
        worst = max(worst, float(deviation.max(initial=0.0)))
    return Answer(worst <= within, worst=worst, count=count)
