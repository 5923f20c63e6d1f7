"""Rows on Section 4.3: effects of single parameters."""

import math
from itertools import product
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.stats import spearmanr

from disc_model.analysis.classify import SAME, distinct_points, separation_location
from disc_model.data.dataset import Missing
from disc_model.data.variables import Outcome, flag_names, values_text
from disc_model.paper import measures
from disc_model.paper.measures import STRETCH, Array, CaseView, extent, published, sound
from disc_model.paper.model import AMBIGUOUS, FALSE, NOT_COMPUTED, PART, TRUE, Answer, graded
from disc_model.parameters import Parameters


def stays_calm(case: CaseView) -> bool:
    """Whether contact is kept, and the contact force has no wider range at the end than at
    first."""
    return (
        not case.separates and not 1.02 * case.early.width < case.late.width
    )  # sampling adds far less than 2 %


def calm_text(case: CaseView) -> str:
    """What becomes of a case; where contact is kept, with the ranges of the contact force, if it
    stores them."""
    if case.separates or "history" not in case.node:
        return case.fate
    widths = (
        f"{case.early.width:.2f} N between 1 and 21 s, and {case.late.width:.2f} N in the last 20 s"
    )
    return f"{case.fate} The range of the contact force is {widths}."


def stays_small(
    case: CaseView, *_: CaseView, share: float, within: float, last: float = 0, same: float = 1
) -> Answer:
    intervals = case.intervals()
    spread = float(intervals.std() / intervals.mean())
    points = [_different(case, last, x) for x in (same, 1e-4)] if last else [0]
    holds = stays_calm(case) and case.late.width < share * case["N"] and spread <= within
    small = not last or (case.disc.width / 2 < case["h"] and points[0] <= last / 2)
    widths = (1e3 * case.disc.width, 1e6 * case.late_range("u").width) if last else ()
    told = {"fate": calm_text(case), "rate": 1 / intervals.mean(), "spread": spread}
    return Answer(holds if small or not holds else PART, points=points, widths=widths, **told)


def becomes_unstable(case: CaseView) -> Answer:
    other = measures.growth_of(case.parameters.replace(normalization="orthonormal"))
    return Answer(case.separates, case.fate, other=other)


def only_between(*cases: CaseView, largest: float) -> Answer:
    shown = sum(case["N"] <= largest for case in cases)
    stable = [
        stays_calm(x) if x["N"] <= largest or "history" in x.node else not x.separates
        for x in cases
    ]
    holds, rows = (
        stable[:shown] == [True, False, True],
        [(cases[i].place, calm) for i, calm in enumerate(stable)],
    )
    return Answer(PART if holds and not all(stable[shown:]) else holds, rows=rows)


def hardly_moves(large: CaseView, huge: CaseView, *, held: float) -> Answer:
    p = huge.parameters
    released = p.mu_s * p.N / (p.r_0 * p.k_p * p.Omega)
    rows = [(case.place, case.stick_in_all, case["time_reached"]) for case in (large, huge)]
    sticks = huge.stick_in_all == 1 and not huge.separates
    verdict = AMBIGUOUS if sticks and released < held else sticks
    return Answer(verdict, rows=rows, released=released, needed=1e-6 * p.N * held / released)


def critical_speed(known: CaseView, *cases: CaseView, printed: float, within: float) -> Answer:
    times = {
        case["Omega"]: case["first_separation"]
        for case in sorted(cases, key=lambda case: case["Omega"])
    }
    horizon, end = known["first_separation"], cases[0]["time_reached"]
    never = [speed for speed, time in times.items() if math.isnan(time)]
    lower = [speed for speed, time in times.items() if speed < printed - within and time <= horizon]
    apart, rows = times[printed] <= horizon, [row for row in times.items() if row[0] not in never]
    verdict = PART if apart and lower else apart
    return Answer(
        verdict, N=known["N"], rows=rows, never=never, end=end, horizon=horizon, lower=lower
    )


def undamped_separates_lower(*cases: CaseView) -> Answer:
    undamped, damped = (
        [case for case in cases if (case["D_star"] == 0) == free] for free in (True, False)
    )
    lowest = [
        min((case["Omega"] for case in each if case.separates), default=math.inf)
        for each in (undamped, damped)
    ]
    return Answer(lowest[0] < lowest[1], N=cases[0]["N"], lowest=lowest)


def twice_the_damping(*cases: CaseView) -> Answer:
    stable = [stays_calm(case) for case in cases]
    return Answer(
        stable[0] if len({*stable}) == 1 else AMBIGUOUS, fates=[calm_text(case) for case in cases]
    )


def inplane_damping(without: CaseView, case: CaseView) -> Answer:
    verdict = not without.separates and case.separates
    return Answer(verdict, fates=(without.fate, case.fate))


def damping_stabilises(case: CaseView, *, name: str, value: float) -> Answer:
    grid, raised, growing, lowered, lost = _grid(case.parameters), list[str](), 0, 0, 0
    values = (0.0, value, 2 * value)
    none, some, twice = (
        np.array([measures.growth_of(p.replace(**{name: x})) for p in grid]) for x in values
    )
    for before, after in ((none, some), (some, twice)):
        grows = (before > 0) & np.isfinite(after)
        growing, lowered = (
            growing + int(grows.sum()),
            lowered + int((grows & (after < before)).sum()),
        )
        raised += [
            measures.place(grid[i].N, grid[i].Omega)
            for i in np.flatnonzero((before < 0) & (after > before))
        ]
        lost += int(((before > 0) & np.isnan(after)).sum())
    verdict, most = growing == lowered > 0, values_text({name: 2 * value})
    return Answer(verdict, most=most, lowered=lowered, growing=growing, raised=raised, lost=lost)


def _grid(p: Parameters) -> list[Parameters]:
    """A case at loads and speeds of the paper and beyond."""
    grid = product((50, 125, 200, 300, 385, 600), (10, 15, 20, 30, 40))
    return [p.replace(N=N, Omega=speed) for N, speed in grid]


def lowers_growth(study: xr.Dataset, *, name: str, trend: float) -> Answer:
    growth = published(study)["growth_rate"].transpose("Omega", name).values
    rows = [growing for row in growth if (growing := row[row > 0]).size > 2]
    if not rows:
        raise Missing(f"study {study.attrs.get('study', '')} has no growing cycle")
    part = np.mean(np.concatenate([np.diff(row) < 0 for row in rows]))
    ranks = [spearmanr(range(row.size), row)[0] for row in rows]
    rank = np.median(ranks)
    return Answer(TRUE if part == 1 else PART if rank <= -trend else FALSE, part=part, rank=rank)


def soft_disc(case: CaseView, *, factor: float, bounded: float, cause: bool = False) -> Answer:
    count = int(case["time_reached"] / (4 * STRETCH))
    if not count:
        if case.separates:  # where it was to be stopped
            return Answer(FALSE, case.fate)
        raise Missing(
            f"case {case.name} ends at {case['time_reached']:g} s, {4 * STRETCH:g} s are needed"
        )
    widths = case.last_widths("P", STRETCH, 2 * count)
    last, before = float(np.median(widths[:count])), float(np.median(widths[count:]))
    holds = not case.separates and last > factor * case.early.width and last < bounded * before
    verdict = PART if holds and cause else holds
    return Answer(verdict, fate=calm_text(case), before=before, last=last)


def quasi_periodic_and_irregular(case: CaseView) -> Answer:
    if case.late_motion.kind is Outcome.UNDECIDED:
        return Answer(
            NOT_COMPUTED, "The 0-1 test for chaos lies between regular and chaotic motion."
        )
    verdict = graded(
        case.late_motion.kind is kind for kind in (Outcome.QUASI_PERIODIC, Outcome.IRREGULAR)
    )
    return Answer(verdict, span=case.kept_span, motion=case.motion)


def softer_separates_sooner(*evidence: Any) -> Answer:
    *cases, study = evidence
    speed, _, apart, _ = plane(study, "Omega", "k")
    again = np.any(np.diff(apart.astype(int)) > 0, axis=1)  # by rising stiffness
    neighbours = np.split(
        np.flatnonzero(again), np.flatnonzero(np.diff(np.flatnonzero(again)) > 1) + 1
    )
    returns = [extent(speed[each]) for each in neighbours if each.size]
    holds = bool(
        np.all(np.diff([x["first_separation"] for x in cases]) > 0)
    )  # false if one does not separate
    rows, place = (
        [(1e-3 * case["k"], case.contact) for case in cases],
        measures.place(cases[0]["N"], cases[0]["Omega"]),
    )
    return Answer(PART if holds and returns else holds, place=place, rows=rows, returns=returns)


def stiff_enough(case: CaseView, *, name: str, larger: list[float]) -> Answer:
    points = _grid(case.parameters)
    calm, stable = stays_calm(case), sum(_growth(p) < 0 for p in points)
    more = [(x, sum(_growth(p.replace(**{name: 1e3 * x})) < 0 for p in points)) for x in larger]
    every = calm and all(count == len(points) for count in (stable, *dict(more).values()))
    verdict = PART if calm and stable and not every else every
    return Answer(verdict, fate=calm_text(case), stable=stable, size=len(points), more=more)


def _growth(p: Parameters) -> float:
    """Largest growth rate of the stick-slip cycle, or of steady sliding where there is none,
    1/s."""
    rate = measures.growth_of(p)
    return measures.sliding_growth(p) if math.isnan(rate) else rate


def wanders(case: CaseView, near: CaseView, *, last: float, same: float) -> Answer:
    points, motion = _different(case, last, same), case.late_motion
    verdict = (
        graded([points > last / 2, motion.kind is Outcome.IRREGULAR]) if case.separates else FALSE
    )
    turns = float(case.intervals()[: motion.period].sum()) * case.drive
    other = measures.repeats(near.late_motion, "release")
    return Answer(
        verdict, fate=case.fate, points=points, motion=case.motion, turns=turns, near=other
    )


def _different(case: CaseView, last: float, same: float) -> int:
    """How many of the last points of the disc's section differ, along an axis, by more than a share
    of their range."""
    section = case.samples("poincare").isel(time=slice(-int(last), None))
    points = np.column_stack([section[name].values for name in ("w_point", "w_point_velocity")])
    return distinct_points(points, np.ptp(points, axis=0) * same / SAME)


def faster_and_sooner(soft: CaseView, base: CaseView) -> Answer:
    sooner = base.separates and base["first_separation"] < soft["first_separation"]
    verdict = graded([sooner, base.growth_rate > soft.growth_rate])
    rows = [(1e-3 * case["k_p"], case.contact_and_growth) for case in (soft, base)]
    return Answer(verdict, place=measures.place(base["N"], base["Omega"]), rows=rows)


def lowest_position(case: CaseView, *, share: float) -> Answer:
    window = case.samples("zoom")
    time, height = window["time"].values, window["u"].values - case["u_0"]
    starts = (
        np.flatnonzero(np.diff((window["phase"].values == measures.SEPARATION).astype(int)) == 1)
        + 1
    )
    lost = case.switches("separation")
    if not starts.size or not lost.sizes["event"]:
        raise Missing(f"no separation in the window of case {case.name}")
    part = separation_location(height, starts)
    # by its events: samples come late, and the velocity of a light slider changes fast
    speed = float(np.median(lost["u_velocity"].values))
    above = float(np.median(height[starts - 1]) - height.min()) / np.ptp(height)
    swings = int(np.sum((np.diff(height)[1:] > 0) & (np.diff(height)[:-1] <= 0)))
    counts = (starts.size, swings)
    holds = part <= share and above <= share
    return Answer(holds, counts=counts, span=extent(time), part=part, above=above, speed=speed)


def seen_in_section(case: CaseView, *, share: float) -> Answer:
    samples = case.samples("poincare")
    late = samples.isel(time=samples["time"].values > case["first_separation"])
    w, apart = late["w_point"].values, late["phase"].values == measures.SEPARATION
    if not apart.any():
        raise Missing(f"case {case.name} has no point of the section in separation")
    lost, every = extent(1e3 * w[apart]), extent(1e3 * w)
    return Answer(
        FALSE if lost.high <= every.low + share * every.width else PART, lost=lost, every=every
    )


def bounded(*cases: CaseView, factor: float) -> Answer:
    widths = [case.last_quarters("w_point") for case in cases]
    widest, most = (
        max(late / before for late, before in widths),
        max(late for late, _ in widths) / cases[0]["h"],
    )
    return Answer(
        graded(late <= factor * before for late, before in widths), widest=widest, most=most
    )


def stick_may_vanish(*cases: CaseView, share: float) -> Answer:
    vanishes = any(case.stick_in_all > share >= case.stick for case in cases if case.from_rest)
    begun = [
        [(x.place, x.stick, x.stick_in_all) for x in cases if x.from_rest == rest]
        for rest in (True, False)
    ]
    return Answer(vanishes, begun=begun)


def damping_at_large_preloads(study: xr.Dataset, *, c_p: float) -> Answer:
    loads, damping, apart, _ = plane(study, "N", "c_p")
    quiet = ~apart[:, 0]
    newly = loads[quiet & apart[:, damping == c_p][:, 0]]
    never = loads[quiet & ~apart[:, 1:].any(axis=1)]
    never = never[never > newly.max(initial=0)]
    verdict = FALSE if not newly.size else PART if never.size else TRUE
    return Answer(verdict, newly=[*newly], never=[*never])


def plane(
    study: xr.Dataset, first: str, second: str
) -> tuple[Array, Array, NDArray[np.bool_], Array]:
    """Values of two parameters of a map, ascending; whether the static start separates, and growth
    rates, 1/s."""
    study = sound(published(study)).sortby([first, second]).transpose(first, second, ...)
    apart = flag_names(study["outcome"]) == "separation"
    return study[first].values, study[second].values, apart, study["growth_rate"].values
