"""Rows on Section 4.1: separation occurs, and ignoring it changes the motion."""

from typing import Any

import numpy as np

from disc_model.analysis import spectra
from disc_model.analysis.classify import irregularity
from disc_model.data.dataset import Missing
from disc_model.data.variables import Outcome, flag_names
from disc_model.paper import energy, measures
from disc_model.paper.measures import Absent, CaseView, listed, mm, pairs
from disc_model.paper.model import FALSE, NOT_COMPUTED, PART, TRUE, Answer, graded


def force_grows_to_zero(case: CaseView, *, factor: float) -> Answer:
    if not case.separates:
        raise Absent(f"case {case.name}: no separation in {case['time_reached']:g} s")
    before = case["first_separation"]
    late, count = case.range_of("P", before - 20, before), case["n_separations"]
    return Answer(
        late.width > factor * case.early.width,
        f"The contact force is {case.early:.2f} N at first, and {late:.1f} N before the first separation at "
        f"{before:.2f} s. {count:.0f} separations follow until {case['time_reached']:g} s.",
    )


def upward(*cases: CaseView, share: float) -> Answer:
    """Whether the disc, and with it the slider, moves upward where contact is lost, in that part of the separations."""
    rows, parts = [], []
    for case in cases:
        lost = case.switches("separation")
        velocity, height = lost["u_velocity"].values, lost["u"].values - case["u_0"]
        if not velocity.size:
            raise Missing(f"case {case.name} keeps no separation")
        parts.append(float(np.mean(velocity > 0)))
        rows.append(
            f"{case.place}: {100 * parts[-1]:.0f} %, at {velocity.mean():+.2f} m/s and {1e3 * height.mean():+.1f} mm"
        )
    return Answer(min(parts) >= share, f"Upward in {'; '.join(rows)} from equilibrium.")


def separations_are_short(*cases: CaseView, share: float) -> Answer:
    rows, parts = [], []
    for case in cases:
        durations, still_open = case.separation_durations()
        longest, period = max(durations.max(), still_open), 1 / case.rate_of("separation")
        parts.append(longest / period)
        rows.append(f"{1e3 * longest:.2f} ms at {case.place}")
    return Answer(
        max(parts) < share,
        f"The longest take {100 * min(parts):.0f} to {100 * max(parts):.0f} % of the {1e3 * period:.2f} ms between "
        f"two: {', '.join(rows)}.",
    )


def preload_closes(case: CaseView, *, share: float) -> Answer:
    """Whether the preload is the larger part of the force that drives the slider back while it is separated."""
    window = case.samples("zoom")
    apart = window["phase"].values == measures.SEPARATION
    if not apart.any():
        raise Missing(f"no separation in the window of case {case.name}")
    spring = case["k"] * float(np.mean(window["u"].values[apart] - case["u_0"]))
    part = case["N"] / (case["N"] + spring)
    return Answer(
        TRUE if part >= share else PART if part > 0 else FALSE,
        f"During separation the preload pushes with {case['N']:g} N, and the spring k with {spring:.0f} N on average: "
        f"the preload is {100 * part:.0f} % of the closing force.",
    )


def bounded_by_separation(*cases: CaseView, factor: float) -> Answer:
    """Whether what bounds the disc's vibration is separation: the control is the same motion without it."""
    also, bounds = [], []
    for _, bonded in pairs(cases):
        late, before = bonded.last_widths("w_point", measures.STRETCH, 2)
        also.append(late <= factor * before)
        bounds.append(1e3 * late)
    return Answer(
        PART if any(also) else TRUE,
        f"Without separation the vibration stops growing as well, in {sum(also)} of {len(also)} cases, at a range of "
        f"{measures.extent(bounds):.1f} mm.",
    )


def keeps_sticking(*evidence: Any, share: float) -> Answer:
    *cases, study = evidence
    sticks = [case.stick for case in cases]
    settled = flag_names(study["settled"]) == "settled"
    shares = study["stick_fraction"].transpose(*study["settled"].dims).values
    least = np.min(shares[settled], initial=np.inf)
    moving = settled.size - settled.sum()
    rows = ", ".join(f"{100 * stick:.0f} % at {case.place}" for case, stick in zip(cases, sticks, strict=True))
    return Answer(
        min(*sticks, least) > share,
        f"The slider sticks {rows}. On a grid of {settled.size} preloads and speeds it sticks {100 * least:.2g} % of "
        f"the time or more at all {settled.sum()} that have settled.",
        f"{moving} of the grid had not settled after {measures.facts(study)['max_transient']:g} s." if moving else "",
    )


def releases_regularly(*cases: CaseView, within: float) -> Answer:
    intervals = [case.intervals() for case in cases]
    rows = [
        f"{case.place}: one release per {1e3 * each.mean():.3f} ms, spread {irregularity(each):.0e}"
        for case, each in zip(cases, intervals, strict=True)
    ]
    return Answer(graded(irregularity(each) <= within for each in intervals), f"{'; '.join(rows)}.")


def more_frequencies(*cases: CaseView, floor: float) -> Answer:
    rows: list[str] = []
    more: list[bool] = []
    too: list[bool] = []
    for free, bonded in pairs(cases):
        counts = []
        for case in (free, bonded):
            late = case.samples("late")
            counts.append(len(spectra.lines(late["time"].values, late["w_point"].values, above=1.0, floor=floor)))
        (more if free.from_rest else too).append(counts[0] > counts[1])
        begun = "" if free.from_rest else ", begun in a separated motion"
        rows.append(f"{free.place}{begun}: {counts[0]} lines with separation, {counts[1]} without")
    verdict = graded([*more, *too]) if any(more) else FALSE
    return Answer(verdict, f"{'; '.join(rows)}.")


def quasi_periodic(*cases: CaseView, count: float) -> Answer:
    """Whether the first ``count`` cases are quasi-periodic. As many follow with a spring 0.1 % stiffer, then others."""
    number = int(count)
    shown, stiffer, begun = cases[:number], cases[number : 2 * number], cases[2 * number :]
    motions = [case.late_motion() for case in shown]
    if any(motion.kind is Outcome.UNDECIDED for motion in motions):
        return Answer(NOT_COMPUTED, "The 0-1 test lies between regular and chaotic motion.")
    rows = [f"{case.place}: {case.motion}" for case in shown]
    near = [f"{case.place}: {case.late_motion()}" for case in stiffer]
    other = [f"{case.place}: {_separations(case)}" for case in begun if not case.sticks]
    return Answer(
        graded(motion.kind is Outcome.QUASI_PERIODIC for motion in motions),
        f"{'; '.join(rows)}.",
        f"Neighbouring systems have other periods. With k 0.1 % larger: {'; '.join(near)}.",
        "Begun in the separated motion of 385 N, 15.1 rad/s, the slider does not stick. The period: "
        f"{'; '.join(other)}."
        if other
        else "",
    )


def _separations(case: CaseView) -> str:
    """Number of separations after which the motion repeats, in words."""
    motion = measures.classify_intervals(tuple(case.intervals("separation")))
    return measures.counted(motion.period, "separation") if motion.period else str(motion)


def smaller_range(*cases: CaseView, ratio: float, shown: float) -> Answer:
    """Decided by the first ``shown`` pairs; the results of the others are told."""
    parts = [measures.width_ratio(*pair) for pair in pairs(cases)]
    first, others = pairs(cases)[: int(shown)], parts[int(shown) :]
    rows = [
        f"{case.place}: {mm(case.disc.width)} with separation, {mm(bonded.disc.width)} without"
        for case, bonded in first
    ]
    return Answer(
        max(parts[: int(shown)]) < ratio,
        f"{'; '.join(rows)}. The ratio is {listed(parts[: int(shown)], '.2f')}.",
        f"In the other pairs it is {listed(others, '.2f')}." if others else "",
    )


def excites_less(*cases: CaseView, share: float) -> Answer:
    """Whether separation withholds energy that maintained contact supplies, at the amplitude that separation allows."""
    rows, withheld = [], []
    for free, bonded in pairs(cases):
        held = energy.in_the_end(energy.course(free.parameters, free["time_reached"]))
        course = energy.course(bonded.parameters, bonded["time_reached"])
        powers, cycle = energy.at_width(course, held.width), float(free.intervals("separation").mean())
        withheld.append(measures.ratio(powers.supplied - held.supplied, powers.gained, f"the surplus of {bonded.name}"))
        with_, without, damped, impacts = (
            1e3 * cycle * power for power in (held.supplied, powers.supplied, held.damped, held.impacts)
        )
        rows.append(
            f"{free.place}: {with_:.2f} mJ per cycle, without separation {without:.2f} mJ; damping takes {damped:.2f} "
            f"mJ, impacts take {impacts:.2f} mJ"
        )
    steady = energy.of_windows(pairs(cases)[0][1], "field")
    return Answer(
        min(withheld) >= share,
        f"The contact force supplies as much at equal amplitude, and impacts take the surplus. {'; '.join(rows)}. "
        f"Without separation, at {cases[0].place}, the force supplies {steady.pushes:.2f} W while positive and takes "
        f"{-steady.pulls:.2f} W while negative.",
    )
