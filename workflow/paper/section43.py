"""Rows on Section 4.3: effects of single parameters."""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from disc_model.analysis import spectra
from disc_model.analysis.classify import Settled, separation_location
from disc_model.data.dataset import Missing
from disc_model.data.variables import Outcome, flag_names, values_text
from disc_model.parameters import Parameters
from workflow.paper import growth, measures, paper_tables
from workflow.paper.measures import STRETCH, Array, CaseView, Mask, extent
from workflow.paper.model import (
    AMBIGUOUS,
    FALSE,
    NOT_COMPUTED,
    NOT_TESTED,
    PART,
    TRUE,
    Answer,
    graded,
    partly,
    verdict_on,
)
from workflow.paper.signals import SAME, distinct_points

LOADS = (50, 125, 200, 300, 385, 600)
"""Preloads of the paper and beyond, N."""
SPEEDS = (10, 15, 20, 30, 40)
"""Speeds of the paper and beyond, rad/s."""

EARLY_LENGTH = 10.0
"""Length of the stretch of the window ``early`` whose spectrum is taken, s."""

PLACE = 1e-4
"""Share of their range by which points of a section must differ to lie at different places.

A motion that repeats comes back far closer. Neighbours among 500 points of a closed curve are on
average some fifty times farther apart, so that a curve is not taken for a few places.
"""

SAMPLING = 1.02
"""Factor by which the range of a steady contact force may differ; sampling adds far less."""


def _combinations(p: Parameters) -> list[Parameters]:
    """Return a case at all combinations of `LOADS` and `SPEEDS`."""
    return [p.replace(N=N, Omega=speed) for N in LOADS for speed in SPEEDS]


def stays_steady(case: CaseView) -> bool:
    """Return whether contact is kept, and the contact force has no wider range in the end."""
    return not case.separates and not SAMPLING * case.early.width < case.late.width


def steadiness_text(case: CaseView) -> str:
    """Return what becomes of a case, in words.

    Where contact is kept, ranges of the contact force are named, if the case stores them.
    """
    if case.separates or "history" not in case.node:
        return case.fate
    early = case.early.width
    late = case.late.width
    return (
        f"{case.fate} The range of the contact force is {early:.2f} N between 1 and 21 s, "
        f"and {late:.2f} N in the last 20 s."
    )


def stays_small(
    case: CaseView, *_: CaseView, share: float, within: float, last: float = 0
) -> Answer:
    """Judge whether a case stays in contact with a small periodic vibration.

    Parameters
    ----------
    case : the run; further ones only belong to the figure
    share : of the preload, below which the range of the contact force is small
    within : greatest spread of the intervals between releases, over their mean
    last : number of the last points of the section that are compared, if any; the answer also
        counts places that differ by 1 %
    """
    intervals = case.intervals()
    mean = intervals.mean()
    spread = float(intervals.std() / mean)
    small_force = case.late.width < share * case["N"]
    holds = stays_steady(case) and small_force and spread <= within

    points = [0]
    widths: tuple[float, ...] = ()
    small = True
    if last:
        points = [_different_points(case, last, limit) for limit in (PLACE, 1e-2)]
        disc = case.disc.width
        widths = (1e3 * disc, 1e6 * case.late_range("u").width)
        small = disc / 2 < case["h"] and points[0] <= last / 2
    return Answer(
        partly(holds, not small),
        points=points,
        widths=widths,
        fate=steadiness_text(case),
        rate=1 / mean,
        spread=spread,
    )


def becomes_unstable(case: CaseView) -> Answer:
    """Judge whether a case separates; the answer has its growth with modes by Eq. (17)."""
    other = growth.growth_of(case.parameters.replace(normalization="orthonormal"))
    return Answer(case.separates, case.fate, other=other)


def only_between(*cases: CaseView, largest: float) -> Answer:
    """Judge whether the system is unstable at the second of three preloads only.

    Parameters
    ----------
    cases : by rising preload
    largest : preload of the paper's last case, N; larger ones are a reservation
    """
    shown = []
    further = []
    rows = []
    for case in cases:
        of_paper = case["N"] <= largest
        stable = not case.separates
        if of_paper or "history" in case.node:
            stable = stays_steady(case)
        if of_paper:
            shown.append(stable)
        else:
            further.append(stable)
        rows.append((case.place, stable))
    holds = shown == [True, False, True]
    return Answer(partly(holds, not all(further)), rows=rows)


def hardly_moves(large: CaseView, huge: CaseView, *, held: float) -> Answer:
    """Judge whether the slider sticks for good at a huge preload.

    Parameters
    ----------
    large, huge : runs at two preloads
    held : time in s for which the slider has to stick
    """
    p = huge.parameters
    friction = p.mu_s * p.N
    released = friction / (p.r_0 * p.k_p * p.Omega)
    needed = 1e-6 * p.N * held / released
    rows = []
    for case in (large, huge):
        rows.append((case.place, case.stick_in_all, case["time_reached"]))
    verdict = FALSE
    if huge.stick_in_all == 1 and not huge.separates:
        verdict = AMBIGUOUS if released < held else TRUE
    return Answer(verdict, rows=rows, released=released, needed=needed)


def critical_speed(known: CaseView, *cases: CaseView, printed: float, within: float) -> Answer:
    """Judge the printed critical speed for separation.

    Parameters
    ----------
    known : case of the paper, whose first separation is the horizon
    cases : at speeds around the printed one
    printed : rad/s
    within : rad/s by which lower speeds with separation may differ from it
    """
    by_speed = sorted(cases, key=lambda case: case["Omega"])
    times = {case["Omega"]: case["first_separation"] for case in by_speed}
    horizon = known["first_separation"]
    never = []
    rows = []
    lower = []
    for speed, time in times.items():
        if math.isnan(time):
            never.append(speed)
        else:
            rows.append((speed, time))
        if speed < printed - within and time <= horizon:
            lower.append(speed)
    return Answer(
        partly(times[printed] <= horizon, bool(lower)),
        N=known["N"],
        rows=rows,
        never=never,
        end=cases[0]["time_reached"],
        horizon=horizon,
        lower=lower,
    )


# ---- Damping


def undamped_separates_lower(*cases: CaseView) -> Answer:
    """Judge whether the disc without damping separates at lower speeds than that with damping."""
    undamped = math.inf
    damped = math.inf
    contacts = []
    for case in cases:
        speed = case["Omega"]
        separating = speed if case.separates else math.inf
        if case["D_star"] == 0:
            contacts.append(f"{case.contact} at {speed:g} rad/s")
            undamped = min(undamped, separating)
        else:
            damped = min(damped, separating)
    lowest = [undamped, damped]
    return Answer(undamped < damped, N=cases[0]["N"], lowest=lowest, contacts=contacts)


def twice_the_damping(*cases: CaseView) -> Answer:
    """Judge whether cases are stable; ambiguous if some are."""
    stable = {stays_steady(case) for case in cases}
    fates = [steadiness_text(case) for case in cases]
    if len(stable) > 1:
        return Answer(AMBIGUOUS, fates=fates)
    return Answer(stable.pop(), fates=fates)


def inplane_damping(without: CaseView, case: CaseView, study: xr.Dataset | None) -> Answer:
    """Judge whether in-plane damping makes a quiet case separate.

    Parameters
    ----------
    without, case : the runs without the damper and with it
    study : map of preload and in-plane damping, if there is one; it tells at which preloads it does
    """
    verdict = not without.separates and case.separates
    newly: list[float] = []
    size = 0
    if study is not None:
        over_damping = plane(study, "N", "c_p")
        newly = over_damping.first[over_damping.newly_separating(case["c_p"])].tolist()
        size = over_damping.first.size
    return Answer(verdict, fates=(without.fate, case.fate), newly=newly, size=size)


def damping_stabilises(case: CaseView, *, name: str, value: float) -> Answer:
    """Judge whether damping lowers growth rates.

    Parameters
    ----------
    case : the run whose parameters are taken, at `LOADS` and `SPEEDS`
    name : parameter of the damping
    value : its value, which is raised from zero to this and to twice this
    """
    cases = _combinations(case.parameters)
    rates = []
    for damping in (0.0, value, 2 * value):
        damped = [p.replace(**{name: damping}) for p in cases]
        rates.append(np.array([growth.growth_of(p) for p in damped]))
    before = np.stack(rates[:-1])
    after = np.stack(rates[1:])
    counted = _counted(before, after)
    lowered = counted & (after < before)
    lost = (before > 0) & np.isnan(after)

    raised: list[str] = []
    for _, i in np.argwhere((before < 0) & (after > before)):
        p = cases[i]
        raised.append(measures.place(p.N, p.Omega))
    return Answer(
        _mostly(lowered, counted),
        most=values_text({name: 2 * value}),
        lowered=lowered.sum(),
        growing=counted.sum(),
        raised=raised,
        lost=lost.sum(),
    )


def _counted(before: Array, after: Array) -> Mask:
    """Return which steps of a parameter count: from a growing cycle to another cycle.

    Parameters
    ----------
    before, after : growth rates in 1/s before each step and after it, nan without a cycle
    """
    return (before > 0) & np.isfinite(after)


def _mostly(holds: Mask, counted: Mask) -> str:
    """Return the verdict on what holds in all steps that count, in most of them or in fewer."""
    share = holds.sum() / max(counted.sum(), 1)
    if share == 1:
        return TRUE
    return PART if share > 0.5 else FALSE


def damping_at_large_preloads(study: xr.Dataset, *, c_p: float) -> Answer:
    """Judge whether in-plane damping brings separation at large preloads.

    Parameters
    ----------
    study : map of preload and in-plane damping
    c_p : the paper's damping, N s/m; others are a reservation
    """
    over_damping = plane(study, "N", "c_p")
    loads = over_damping.first
    newly = loads[over_damping.newly_separating(c_p)]
    never = loads[~over_damping.separates.any(axis=1)]
    never = never[never > newly.max(initial=0)]
    verdict = partly(newly.size > 0, never.size > 0)
    return Answer(verdict, newly=[*newly], never=[*never])


# ---- Stiffness and modulus


def growth_over_steps(study: xr.Dataset, *, name: str, larger: bool) -> Answer:
    """Judge whether growth falls with a larger parameter, or rises with a smaller one.

    Parameters
    ----------
    study : map over the speed and the parameter
    name : of the parameter
    larger : whether its steps go from smaller values to larger ones
    """
    ordered = measures.published(study)["growth_rate"].sortby(name, ascending=larger)
    rates = ordered.transpose("Omega", name).values
    before = rates[:, :-1]
    after = rates[:, 1:]
    counted = _counted(before, after)
    if not counted.any():
        raise Missing(f"study {study.attrs.get('study', '')} has no growing cycle")
    change = after - before
    expected = change < 0 if larger else change > 0
    holds = counted & expected
    return Answer(
        _mostly(holds, counted),
        holds=holds.sum(),
        counted=counted.sum(),
        stable=(counted & (after < 0)).sum(),
    )


def soft_disc(case: CaseView, *, factor: float, bounded: float, cause: bool = False) -> Answer:
    """Judge whether the vibration of a soft disc grows and stays bounded, in contact.

    Parameters
    ----------
    case : the run
    factor : by which the range of the contact force must have grown
    bounded : factor by which its median range may still grow over the last half of the run
    cause : whether the statement names a cause, which no run takes away
    """
    end = case["time_reached"]
    needed = 4 * STRETCH
    count = int(end / needed)
    if not count:
        if case.separates:  # where it was to be stopped
            return Answer(FALSE, case.fate)
        raise Missing(f"case {case.name} ends at {end:g} s, {needed:g} s are needed")
    widths = case.last_widths("P", STRETCH, 2 * count)
    last = float(np.median(widths[:count]))
    before = float(np.median(widths[count:]))
    grown = last > factor * case.early.width
    holds = not case.separates and grown and last < bounded * before
    verdict = verdict_on(holds)
    if holds and cause:
        verdict = NOT_TESTED
    return Answer(verdict, fate=steadiness_text(case), before=before, last=last)


def quasi_periodic_and_irregular(case: CaseView) -> Answer:
    """Judge whether a motion is both quasi-periodic and irregular; one of them is a part."""
    kind = case.late_motion.kind
    if kind is Outcome.UNDECIDED:
        return Answer(
            NOT_COMPUTED, "The 0-1 test for chaos lies between regular and chaotic motion."
        )
    verdict = graded([kind is Outcome.QUASI_PERIODIC, kind is Outcome.IRREGULAR])
    return Answer(verdict, span=case.kept_span, motion=case.motion)


def softer_separates_sooner(*evidence: Any) -> Answer:
    """Judge whether a softer spring brings separation sooner.

    Parameters
    ----------
    evidence : cases by rising stiffness, and last the map of speed and stiffness
    """
    *cases, study = evidence
    times = [case["first_separation"] for case in cases]
    holds = bool(np.all(np.diff(times) > 0))  # false if one does not separate: its time is nan

    # speeds at which a stiffer spring separates again, in groups of neighbours
    speed, _, separates, *_ = plane(study, "Omega", "k")
    begins = np.diff(separates.astype(int)) > 0
    again = np.flatnonzero(begins.any(axis=1))
    gaps = np.flatnonzero(np.diff(again) > 1)
    groups = np.split(again, gaps + 1)
    returns = [extent(speed[group]) for group in groups if group.size]
    return Answer(
        partly(holds, bool(returns)),
        place=measures.place(cases[0]["N"], cases[0]["Omega"]),
        rows=[(1e-3 * case["k"], case.contact) for case in cases],
        returns=returns,
    )


def stiff_enough(case: CaseView, *, name: str, larger: Sequence[float]) -> Answer:
    """Judge whether a stiffness is enough for stability.

    Parameters
    ----------
    case : the run with this stiffness, which is also taken to `LOADS` and `SPEEDS`
    name : of the stiffness
    larger : values from which on all combinations must be stable too, kN/m
    """
    cases = _combinations(case.parameters)
    steady = stays_steady(case)
    stable = sum(_growth(p) < 0 for p in cases)
    more = []
    for stiffness in larger:
        stiffer = [p.replace(**{name: 1e3 * stiffness}) for p in cases]
        count = sum(_growth(p) < 0 for p in stiffer)
        more.append((stiffness, count))
    counts = [stable]
    counts += [count for _, count in more]
    verdict = FALSE
    if steady and all(count == len(cases) for count in counts):
        verdict = TRUE
    elif steady and stable:
        verdict = PART
    return Answer(verdict, fate=steadiness_text(case), stable=stable, size=len(cases), more=more)


def _growth(p: Parameters) -> float:
    """Return the largest growth rate of the stick-slip cycle in 1/s.

    Where there is none, it is that of steady sliding.
    """
    rate = growth.growth_of(p)
    if math.isnan(rate):
        return growth.sliding_growth(p)
    return rate


def faster_and_sooner(soft: CaseView, base: CaseView) -> Answer:
    """Judge whether the stiffer of two springs brings faster growth and an earlier separation."""
    sooner = base.separates and base["first_separation"] < soft["first_separation"]
    faster = base.growth_rate > soft.growth_rate
    return Answer(
        graded([sooner, faster]),
        place=measures.place(base["N"], base["Omega"]),
        rows=[(1e-3 * case["k_p"], case.contact_and_growth) for case in (soft, base)],
    )


# ---- Motions before and after separation


def two_frequencies(case: CaseView, *, share: float, least: float) -> Answer:
    """Judge whether the disc vibrates at two frequencies before it separates.

    They are the stick-slip rate and the drive's frequency, with their combinations.

    Parameters
    ----------
    case : the run, with the window ``early``
    share : of the power, which combinations must have
    least : share of the power in which the stick-slip rate must take part
    """
    start = float(case.samples("early")["time"].values[0])
    stop = start + EARLY_LENGTH
    first = case["first_separation"]
    if not stop < first:
        raise Missing(f"case {case.name} separates at {first:g} s, before {stop:g} s")
    rate = case.signal("early", start, stop, "psi").lines(1, above=2 * case.drive)[0].frequency
    total = 0.0
    combined = 0.0
    with_rate = 0.0
    for line in case.signal("early", start, stop).lines(above=1.0, floor=1e-3):
        power = line.amplitude**2
        total += power
        name = spectra.identify(line.frequency, rate, case.drive)
        if abs(name.deviation) <= paper_tables.COMBINED:
            combined += power
            with_rate += power * (name.n > 0)
    return Answer(
        combined >= share * total and with_rate >= least * total,
        span=(start, stop),
        rate=rate,
        drive=case.drive,
        part=combined / total,
        with_rate=with_rate / total,
    )


def unstable_periodic(case: CaseView, *, last: float) -> Answer:
    """Judge whether slider and disc move periodically in the end, and the motion is unstable.

    Parameters
    ----------
    case : the run
    last : number of the last points of the section that are compared
    """
    points = _different_points(case, last)
    settled = case.settling().answer is Settled.SETTLED
    return Answer(
        graded([case.late_motion.period > 0, points <= last / 2, not settled]),
        span=case.kept_span,
        motion=case.motion,
        points=points,
        settled=settled,
    )


def wanders(case: CaseView, near: CaseView, *, last: float) -> Answer:
    """Judge whether points of the section wander and the motion is irregular.

    Parameters
    ----------
    case : the run
    near : one at a speed nearby, whose period is told
    last : number of the last points of the section that are compared
    """
    points = _different_points(case, last)
    motion = case.late_motion
    verdict = FALSE
    if case.separates:
        irregular = motion.kind is Outcome.IRREGULAR
        verdict = graded([points > last / 2, irregular])
    period = float(case.intervals()[: motion.period].sum())
    return Answer(
        verdict,
        fate=case.fate,
        points=points,
        motion=case.motion,
        turns=period * case.drive,
        near=measures.repeats(near.late_motion, "release"),
    )


def _different_points(case: CaseView, last: float, share: float = PLACE) -> int:
    """Return at how many places the last points of the disc's section lie.

    Parameters
    ----------
    case : the run
    last : number of points
    share : of their range, by which different places differ along an axis
    """
    section = case.samples("poincare")
    section = section.isel(time=slice(-int(last), None))
    columns = [section[name].values for name in ("w_point", "w_point_velocity")]
    points = np.column_stack(columns)
    extents = np.ptp(points, axis=0)
    return distinct_points(points, extents * share / SAME)


def lowest_position(case: CaseView, *, share: float) -> Answer:
    """Judge whether separations begin in the lowest part of the slider's motion.

    Parameters
    ----------
    case : the run, with the window ``zoom``
    share : of the range of the height, which this part takes
    """
    window = case.samples("zoom")
    height = window["u"].values - case["u_0"]
    separated = window["phase"].values == measures.SEPARATION
    begins = np.diff(separated.astype(int)) == 1
    starts = np.flatnonzero(begins) + 1
    separations = case.switches("separation")
    if not starts.size or not separations.sizes["event"]:
        raise Missing(f"no separation in the window of case {case.name}")
    part = separation_location(height, starts)
    typical = np.median(height[starts - 1])
    above = float(typical - height.min()) / np.ptp(height)
    # by the events: samples come late, and the velocity of a light slider changes fast
    speed = float(np.median(separations["u_velocity"].values))
    rises = np.diff(height) > 0
    swings = int(np.sum(rises[1:] & ~rises[:-1]))
    return Answer(
        part <= share and above <= share,
        counts=(starts.size, swings),
        span=extent(window["time"].values),
        part=part,
        above=above,
        speed=speed,
    )


def seen_in_section(case: CaseView, *, share: float) -> Answer:
    """Judge whether separations show in the section elsewhere than at its least displacements.

    Parameters
    ----------
    case : the run
    share : of the range of displacements, below which they are least
    """
    samples = case.samples("poincare")
    late = samples.isel(time=samples["time"].values > case["first_separation"])
    w = late["w_point"].values
    separated = late["phase"].values == measures.SEPARATION
    if not separated.any():
        raise Missing(f"case {case.name} has no point of the section in separation")
    lost = extent(1e3 * w[separated])
    every = extent(1e3 * w)
    lowest = lost.high <= every.low + share * every.width
    verdict = FALSE if lowest else PART
    return Answer(verdict, lost=lost, every=every)


def bounded(*cases: CaseView, factor: float) -> Answer:
    """Judge whether the disc's range stays bounded after the first separation.

    Parameters
    ----------
    cases : the runs
    factor : by which the range may grow from the third quarter of the time after it to the last
    """
    widths = [case.last_quarters("w_point") for case in cases]
    largest = max(late for late, _ in widths)
    return Answer(
        graded(late <= factor * before for late, before in widths),
        widest=max(late / before for late, before in widths),
        most=largest / cases[0]["h"],
    )


def stick_may_vanish(*cases: CaseView, share: float) -> Answer:
    """Judge whether a run from rest that stuck does not in the end.

    Parameters
    ----------
    cases : the runs
    share : of time, above which a run sticks
    """
    vanishes = False
    from_rest = []
    from_elsewhere = []
    for case in cases:
        row = (case.place, case.stick, case.stick_in_all)
        if case.from_rest:
            from_rest.append(row)
            vanishes = vanishes or case.stick_in_all > share >= case.stick
        else:
            from_elsewhere.append(row)
    return Answer(vanishes, begun=[from_rest, from_elsewhere])


# ---- Maps


STABLE_IN_CONTACT = [
    Outcome.STICK_SLIP,
    Outcome.OTHER_CYCLE,
    Outcome.STEADY_SLIDING,
    Outcome.AT_REST,
]


class Plane(NamedTuple):
    """A map with the published modes."""

    first: Array
    """Values of its first parameter, ascending."""
    second: Array
    """Values of its second parameter, ascending."""
    separates: Mask
    """Whether the static start separates, shape (first, second)."""
    stable: Mask
    """Whether it comes to a stable motion in contact, of the same shape."""
    growth: Array
    """Growth rates of the cycle, 1/s, of the same shape."""

    def newly_separating(self, second: float | None = None) -> Mask:
        """Return for each first value whether it is stable at the least second value, and separates
        at another one, or at any if none is given."""
        separates = self.separates
        if second is not None:
            separates = separates[:, self.second == second]
        return np.asarray(self.stable[:, 0] & separates.any(axis=1))


def plane(study: xr.Dataset, first: str, second: str) -> Plane:
    """Return a map over two parameters; raises `Missing` if a point failed."""
    ordered = measures.sound(measures.published(study)).sortby([first, second])
    ordered = ordered.transpose(first, second, ...)
    outcome = flag_names(ordered["outcome"])
    return Plane(
        first=ordered[first].values,
        second=ordered[second].values,
        separates=outcome == Outcome.SEPARATION,
        stable=np.isin(outcome, STABLE_IN_CONTACT),
        growth=ordered["growth_rate"].values,
    )
