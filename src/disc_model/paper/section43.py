"""Claims of Section 4.3: effects of single parameters."""

import math
from collections.abc import Sequence
from functools import cache
from itertools import groupby, product
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from disc_model.analysis.classify import irregularity, separation_location, stick_disappears
from disc_model.analysis.poincare import distinct_points
from disc_model.data.dataset import Missing
from disc_model.data.variables import Outcome, flag_names
from disc_model.paper import measures
from disc_model.paper.disc import BASE, moving_load_speed
from disc_model.paper.measures import STRETCH, Array, CaseView, growth_or_nan, is_kind, rate_text, sliding_growth
from disc_model.paper.model import Answer
from disc_model.parameters import Parameters

STIFFENED = {
    "E": (1e9, "GPa", (100, 150, 200)),
    "k": (1e3, "kN/m", (20, 30, 50, 60, 70, 80, 90, 100, 110, 130, 148, 200)),
    "k_p": (1e3, "kN/m", (2, 20, 30, 36, 47, 55, 63, 73, 84, 130, 200)),
}
"""Parameters of disc and springs with units and values: those of the paper, and others between them."""
SPEEDS = (7.5, 8.75, 10, 12.6, 15, 20, 30, 50)
"""Speeds at which twice the disc's damping is tested, rad/s."""
GREW = 1.02
"""Least factor by which a grown range is wider: sampling causes far less."""


def no_preload(case: CaseView, *, step: float, share: float) -> Answer:
    onset = _sliding_onset(case.parameters, step)
    holds = not case.separates and case.stick_in_all < share and onset > case["Omega"]
    at_load = abs(onset - moving_load_speed(case.parameters)) <= step
    return Answer(holds, stable_to=onset - step, true_speed=at_load)


@cache
def _sliding_onset(p: Parameters, step: float) -> float:
    """The first speed, tried at a step in rad/s, at which steady sliding is unstable, or has no equilibrium."""
    speeds = map(float, np.arange(p.Omega, 1000.0, step))
    return next((speed for speed in speeds if not sliding_growth(p.replace(Omega=speed)) < 1e-6), math.inf)


def huge_preload(stuck: CaseView, large: CaseView, *, share: float) -> Answer:
    p, times = large.parameters, large.events["time"].values
    if not times.size:
        raise Missing(f"case {large.name} keeps no event")
    released, needed = float(times[0]), p.r_0 * p.k_p * p.Omega / p.mu_s
    expected = p.N / needed
    holds = stuck["time_slip"] == 0 and abs(released / expected - 1) < share
    return Answer(holds, released=released, expected=expected, needed=needed)


def stable_while_it_sticks(stuck: CaseView, large: CaseView) -> Answer:
    """Whether the case only sticks, which is damped; and whether the largest preload with releases is not stable."""
    stable = _stays_calm(large) and large.growth_rate < 0
    return Answer(stuck["time_slip"] == 0 and not stuck.separates, released=not stable)


def stick_longer(*cases: CaseView) -> Answer:
    small, large = (measures.cycle_of(case.parameters).stick_fraction for case in cases)
    return Answer(large > small, small=small, large=large)


def critical_speed(known: CaseView, *cases: CaseView, printed: float, within: float, wait: float) -> Answer:
    scan = {case["Omega"]: case["first_separation"] for case in cases}
    horizon = known["first_separation"]
    apart = {speed: time for speed, time in scan.items() if not math.isnan(time)}
    slower = {speed: time for speed, time in apart.items() if speed < printed - within}
    lower = [speed for speed, time in slower.items() if time <= horizon]
    first = min(slower.values(), default=math.inf)  # at shorter horizons no clearly lower speed separates
    some = scan[printed] < first < math.inf
    holds = scan[printed] <= horizon and not lower
    return Answer(
        None if some and not holds else holds,
        "wait",
        speeds=[f"{speed:g}: {measures.or_none(scan[speed], '.0f', ' s')}" for speed in sorted(scan)],
        latest=min(apart, default=math.nan),
        lower=[{"horizon": horizon, "least": min(lower)}] if lower else [],
        exactly=[{"low": scan[printed], "high": first}] if some else [],
    )


def damping_stabilises(case: CaseView, **damper: float) -> Answer:
    """Whether a damper, and twice as much, lowers the growth of all growing cycles on a grid of loads and speeds."""
    ((name, value),) = damper.items()
    effects = [_effect_of(case, name, little, little + value) for little in (0.0, value)]
    growing, lowered = (sum(effect[key] for effect in effects) for key in ("growing", "lowered_growing"))
    raised = [place for effect in effects for place in effect["places"]]
    return Answer(growing == lowered > 0, growing=growing, lowered=lowered, raised=raised)


def _stays_calm(case: CaseView, factor: float = GREW) -> bool:
    """Whether contact is kept, and the contact force has no wider range at the end than at first."""
    return not case.separates and not factor * case.early.width < case.late.width


def stays_small(case: CaseView, *_: CaseView, part: float, within: float) -> Answer:
    """Whether a case does not separate, its contact force varies little and ever less, and its releases are regular."""
    intervals = case.intervals()
    spread = irregularity(intervals)
    small = _stays_calm(case) and case.late.width < part * case["N"]
    return Answer(small and spread <= within, rate=1 / intervals.mean(), spread=spread)


def only_between(
    small: CaseView, middle: CaseView, large: CaseView, largest: CaseView, *again: CaseView, factor: float
) -> Answer:
    """Whether only the middle preload is unstable; undecided if preloads larger than those of the paper are as well."""
    *stable, largest_stable = [_stays_calm(case, factor) for case in (small, middle, large, largest)]
    first = again[0].first_separation(*again[1:])
    beyond = [{"case": again[0], "first": first}, {"case": largest, "first": largest.first_separation()}]
    holds, decides = stable == [True, False, True], largest_stable and not again[0].separates
    return Answer(None if holds and not decides else holds, "beyond", loads=[small, middle, large], beyond=beyond)


def undamped_separates_lower(*cases: CaseView, wait: float) -> Answer:
    undamped, damped, slow = cases[0], cases[1:4], cases[4:]
    runs = [slow, [undamped], *([case] for case in damped)]
    lowest = [
        min((case["Omega"] for case in group if case["first_separation"] <= wait), default=math.inf)
        for group in ((undamped, slow[0]), damped)
    ]
    found = [{"case": case, "first": case.first_separation(*again)} for case, *again in runs]
    return Answer(lowest[0] < lowest[1], runs=found)


def disc_damping(*cases: CaseView, factor: float) -> Answer:
    rates = {speed: growth_or_nan(cases[1].parameters.replace(Omega=float(speed))) for speed in SPEEDS}
    texts = [f"{speed:g}: {rate_text(rate)}" for speed, rate in rates.items()]
    stable = [_stays_calm(case, factor) for case in cases]
    holds = all(stable) if len({*stable}) == 1 else None
    return Answer(holds, "speed", rates=texts)


def inplane_damping(without: CaseView, case: CaseView, *, closes: float) -> Answer:
    periodic = case.late_motion(closes).period > 0
    return Answer(not without.separates and case.separates and periodic, **_effect_of(case, "c_p", 0.0, case["c_p"]))


def disc_repeats(case: CaseView, *, within: float, factor: float) -> Answer:
    """Whether the disc's motion repeats and, as an unstable one would, departs from itself at a growing rate."""
    motion, released = case.late_motion(), case.switches("stick_to_slip")
    period = max(motion.period, 1)
    units = {"u": abs(case["u_0"]), "u_velocity": abs(case["u_0"]) * case["Omega"]}
    scaled = np.array([released[name] / unit for name, unit in units.items()])
    early, late = (float(part.max()) for part in np.array_split(np.abs(scaled[:, period:] - scaled[:, :-period]), 2, 1))
    apart = max(early, late)
    holds = motion.period > 0 and apart <= within
    return Answer(
        None if holds and late <= factor * early else holds,
        "attracts",
        text=case.motion.removeprefix("periodic: "),
        apart=apart,
        points=distinct_points(case.late_section(150)),
    )


def soft_disc(case: CaseView, *, factor: float, bounded: float) -> Answer:
    count = int(case["time_reached"] / (4 * STRETCH))
    widths = case.last_widths("P", STRETCH, 2 * count)
    last, before = float(np.median(widths[:count])), float(np.median(widths[count:]))
    grown = last > factor * case.early.width
    return Answer(not case.separates and grown and last < bounded * before, last=last, before=before, most=max(widths))


def seems_quasi_periodic(case: CaseView, *, closes: float) -> Answer:
    motion = case.late_motion(closes)
    irregular = motion.kind is Outcome.IRREGULAR
    return Answer(None, "irregular") if irregular else Answer(*is_kind(Outcome.QUASI_PERIODIC, motion))


def normal_stiffness(*evidence: Any) -> Answer:
    """Whether softer springs separate sooner; undecided if on the map, at other speeds, some do not at all."""
    *cases, study = evidence
    times = [case["first_separation"] for case in cases]
    holds = bool(np.all(np.diff(times) > 0))  # false if one does not separate
    speed, _, apart = _map(study, "Omega", "k")
    returns = measures.runs(speed, np.any(np.diff(apart.astype(int)) > 0, axis=1))  # by rising stiffness
    return Answer(None if holds and returns else holds, "speed", returns=returns)


def stiff_enough(case: CaseView) -> Answer:
    """Whether the stiffness of a case makes motion stable at all points of a grid; undecided if at some of them."""
    points = _grid(case.parameters)
    others = [p for p in points if not _growth(p) < 0]
    calm = _stays_calm(case)
    return Answer(
        None if calm and 0 < len(others) < len(points) else calm and not others,
        "some",
        stable=len(points) - len(others),
        points=len(points),
        others=[
            f"{N:g} N and {', '.join(f'{p.Omega:g}' for p in group)} rad/s"
            for N, group in groupby(others, lambda p: p.N)
        ],
    )


def _growth(p: Parameters) -> float:
    """Largest growth rate of the stick-slip cycle, or of steady sliding where there is none, 1/s."""
    rate = growth_or_nan(p)
    return sliding_growth(p) if math.isnan(rate) else rate


def _grid(p: Parameters) -> list[Parameters]:
    """A case at loads and speeds of the paper and beyond."""
    grid = product((50, 125, 200, 300, 385, 600), (10, 15, 20, 30, 40))
    return [p.replace(N=N, Omega=speed) for N, speed in grid]


def soft_inplane(case: CaseView, near: CaseView, *, closes: float) -> Answer:
    motion, beside = (each.late_motion(closes) for each in (case, near))
    repeats, nearby = motion.period > 0, measures.nearby(motion, beside)
    return Answer(*is_kind(Outcome.IRREGULAR, motion, case.separates, beside), repeats=repeats, nearby=nearby)


def inplane_stiffness(soft: CaseView, base: CaseView, stiff: CaseView) -> Answer:
    sooner = base.separates and base["first_separation"] < soft["first_separation"]
    faster = base.growth_rate > soft.growth_rate
    (found,) = _stiffened(base.parameters, "k_p", base.parameters.Omega)
    changes = np.count_nonzero(np.diff(np.sign(found["growth"])))
    return Answer(sooner and faster and _stays_calm(stiff), between=changes > 1 and changes)


def lowest_position(case: CaseView, *, bound: float) -> Answer:
    window = case.samples("zoom")
    time, height = window["time"].values, window["u"].values - case["u_0"]
    starts = np.flatnonzero(np.diff((window["phase"].values == measures.SEPARATION).astype(int)) == 1) + 1
    if not starts.size:
        raise Missing("no separation in the window of case F23")
    found = separation_location(time, height, starts, bound)
    # by its events: samples come late, and the velocity of a light slider changes fast
    lost = case.switches("separation")
    if not lost.sizes["event"]:
        raise Missing("case F23 keeps no separation")
    where, speed = (float(np.median(lost[name].values)) for name in ("u", "u_velocity"))
    above = float(np.median(height[starts - 1]) - height.min()) / np.ptp(height)
    swings = int(np.sum((np.diff(height)[1:] > 0) & (np.diff(height)[:-1] <= 0)))
    return Answer(
        found.kind == "at the lowest position" and above <= bound,
        found=found,
        height=where - case["u_0"],
        speed=speed,
        falling=speed < 0,
        seldom=starts.size < 0.9 * swings,
        count=starts.size,
        swings=swings,
        above=above,
        lowest=height.min(),
    )


def always_upward(*cases: CaseView, share: float) -> Answer:
    """Whether the disc, and with it the slider, moves upward where contact is lost, in that part of the separations."""
    found: list[dict[str, Any]] = []
    for case in cases:
        lost = case.switches("separation")
        velocity, height = lost["u_velocity"].values, lost["u"].values - case["u_0"]
        if case.separates and not velocity.size:
            raise Missing(f"case {case.name} keeps no separation")
        if velocity.size:
            means = {"velocity": velocity.mean(), "height": height.mean()}
            found.append({"case": case, "upward": float(np.mean(velocity > 0)), "count": velocity.size, **means})
    return Answer(min((row["upward"] for row in found), default=0.0) >= share, shares=found)


def damping_at_large_preloads(study: xr.Dataset, *, c_p: float, largest: float, few: float) -> Answer:
    """Whether, from some preload on, all separate with any damper that do not without it: the largest decide.

    If one of them separates with none, there is no such preload. Undecided if each does with some, or if the
    largest preload of the paper does with the damper ``c_p``.
    """
    loads, damping, apart = _map(study, "N", "c_p")
    quiet, dampers = ~apart[:, damping == 0][:, 0], damping[damping > 0]
    newly, compared = apart[quiet][:, damping > 0], loads[quiet][-int(few) :]
    decisive, shown = newly[-int(few) :], newly[loads[quiet] == largest][:, dampers == c_p]
    rows = [
        {"N": N, "count": row.sum(), "of": row.size, "c_p": dampers[row].min()}
        for N, row in zip(compared, decisive, strict=True)
        if row.any()
    ]
    each = decisive.any(axis=1).all()
    return Answer(
        True if decisive.all() else None if each or shown.any() else False,
        "some" if each else "beyond",
        compared=compared,
        newly=loads[quiet][newly[:, dampers == c_p].any(axis=1)],
        some=rows,
        partly=[] if each else rows,
    )


def _map(study: xr.Dataset, *names: str) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Values of two parameters, ascending, and whether the static start separates: (first, second)."""
    outcome = _published(study, "outcome", *names)
    words = flag_names(outcome)
    if np.any(words == "failed"):
        raise Missing(f"study {study.attrs['study']} has points that failed")
    one, other = (outcome[name].values for name in names)
    return one, other, words == "separation"


def _published(study: xr.Dataset, variable: str, *names: str) -> xr.DataArray:
    """A variable of a map with the published modes, by ascending values of the map's parameters."""
    return study[variable].sel(normalization="as_published").sortby(list(names)).transpose(*names)


def not_monotonous(*evidence: Any) -> Answer:
    """Whether each of three parameters acts both ways; damping by new separations, and by lower growth."""
    *cases, study = evidence
    loads, damping, apart = _map(study, "N", "c_p")
    growth = _published(study, "growth_rate", "N", "c_p").values
    newly = (apart & ~apart[:, :1]).any(axis=1)
    growing = (growth[:, 0] > 0) & np.isfinite(growth[:, -1])
    lowered = growing & (growth[:, -1] < growth[:, 0])
    (stiffened,) = _stiffened(cases[0].parameters.replace(N=300), "k_p", 50)
    signs = {*np.sign(np.diff(stiffened["growth"]))}
    by_preload = [case.separates for case in cases] == [False, True, False]
    return Answer(
        by_preload and newly.any() and lowered.any() and {-1, 1} <= signs,
        loads=cases,
        rates=stiffened["text"],
        newly=loads[newly],
        most=damping[-1],
        lowered=lowered.sum(),
        growing=growing.sum(),
    )


def inplane_damping_alone(*cases: CaseView) -> Answer:
    without, shown, weak, strong, small = cases
    damped = [case.separates for case in (weak, shown, strong)]
    return Answer(
        not without.separates and any(damped) and not small.separates,
        large=[without, weak, shown, strong],
        not_all=not all(damped),
        **_effect_of(shown, "c_p", 0.0, shown["c_p"]),
    )


def stiffer(case: CaseView, *_: CaseView, **speeds: Sequence[float]) -> Answer:
    """Whether growth falls with each of the stiffnesses, at which there must be cycles, at some speeds in rad/s."""
    ((name, those),) = speeds.items()
    found = _stiffened(case.parameters, name, *those)
    every = all(row["growth"].size == len(STIFFENED[name][2]) for row in found)
    return Answer(every and all(np.all(np.diff(row["growth"]) < 0) for row in found), rates=found)


def stiffer_inplane(case: CaseView) -> Answer:
    found = _stiffened(case.parameters, "k_p", 20, 50)
    rising = [row["growth"][: np.argmax(row["growth"]) + 1] for row in found]
    return Answer(all(np.all(np.diff(rates) > 0) for rates in rising), rates=found)


def soft_enough(study: xr.Dataset, *, slow: float) -> Answer:
    E, Omega, apart = _map(study, "E", "Omega")
    E, at = E / 1e9, Omega == slow
    some = apart.any(axis=1)
    quiet = int(np.argmin(some))  # the softest disc without separation, if some separate
    mixed = some.any() and not some.all()
    softer = [f"{E[i]:.4g} GPa from {Omega[apart[i]].min():.3g} rad/s up" for i in range(quiet)] if mixed else []
    return Answer(
        mixed if some.any() and not softer else None,
        "enough" if softer else "nowhere",
        E=measures.extent(E),
        quiet=[*E[~some]] if mixed else [],
        every=some.any(),
        base_too=at.any() and not apart[E <= BASE.E / 1e9][:, at].any(),
        softer=softer,
    )


def quasi_periodic_at_first(case: CaseView, *, within: float, floor: float) -> Answer:
    """Whether the in-plane motion has a second frequency long before separation, and whether it persists."""
    cycle = measures.cycle_of(case.parameters)
    leading = cycle.multipliers[0]
    start, stop = (float(case.samples("early")["time"][i]) for i in (0, -1))
    found = case.signal("early", start, stop, "psi").lines(above=1.0, below=200.0, floor=floor)
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
        strongest=strongest,
        second=second,
        relative=second.amplitude / strongest.amplitude,
        rate=cycle.growth_rate,
        early=start / 4,
        widths=[case.range_of("P", time, time + 20).width for time in (start / 4, stop)],
    )


def bounded(*cases: CaseView, factor: float) -> Answer:
    """Whether no range grows on after separation; where none does without separation either, that is told."""
    widths = {case.name: case.last_quarters("w_point") for case in cases if not case.bonded}
    ignored = [case.last_widths("w_point", STRETCH, 2) for case in cases if case.bonded]
    texts = [f"{name}: {1e3 * late:.1f} mm" for name, (late, _) in widths.items()]
    free, bonded = (all(late <= factor * before for late, before in found) for found in (widths.values(), ignored))
    return Answer(free, ranges=texts, too=bonded)


def stick_may_vanish(*cases: CaseView, share: float) -> Answer:
    begun = [case for case in cases if case.from_rest]
    vanishes = any(stick_disappears(case.stick_in_all, case.stick, share) for case in begun)
    return Answer(vanishes, shares=begun)


def caused_by_friction(*cases: CaseView, growth: float) -> Answer:
    """Whether some cases separate for which sliding without friction is stable."""
    smooth = [sliding_growth(case.parameters.replace(mu_s=0.0, mu_k=0.0)) for case in cases]
    found = [{"case": case, "rate": rate_text(rate, "/s")} for case, rate in zip(cases, smooth, strict=True)]
    stable = [rate < growth for rate in smooth]
    return Answer(any(case.separates and calm for case, calm in zip(cases, stable, strict=True)), smooth=found)


def _effect_of(case: CaseView, damper: str, little: float, much: float) -> dict[str, Any]:
    """Number of loads and speeds at which more of a damper lowers growth, raises it, or ends a stable cycle.

    Without a stick-slip cycle near the start, the motion is steady sliding. Its growth is compared if the damper is the
    in-plane one. ``growing`` counts cycles that grow with little of it and exist with much.
    """
    points = _grid(case.parameters)
    without, damped = (
        np.array([growth_or_nan(p.replace(**{damper: value})) for p in points]) for value in (little, much)
    )
    gone = np.isnan(damped)
    rate = np.array([_growth(p.replace(c_p=much)) for p in points]) if damper == "c_p" else damped
    grows, lower, higher = without > 0, rate < without, ~gone & (rate > without)
    counts = {"lowered": lower, "growing": grows & ~gone, "lowered_growing": grows & (damped < without)}
    counts |= {"slides": gone & lower, "ended": gone & (without < 0) & ~lower, "raised": higher}
    places = [
        f"{measures.place(points[i].N, points[i].Omega)}: {without[i]:+.4f} to {rate[i]:+.4f}/s"
        for i in np.flatnonzero(higher)
    ]
    numbers = {name: int(at.sum()) for name, at in counts.items()}
    return {**numbers, "points": len(points), "value": much, "places": places}


def _stiffened(p: Parameters, name: str, *speeds: float) -> list[dict[str, Any]]:
    """Growth rates for the values of `STIFFENED` at some speeds in rad/s: those of cycles, 1/s; and all, in words."""
    unit, symbol, values = STIFFENED[name]
    rows = []
    for speed in speeds:
        rates = np.array([growth_or_nan(p.replace(**{name: unit * value, "Omega": speed})) for value in values])
        text = f"{', '.join(map(rate_text, rates))} per second for {', '.join(map(str, values))} {symbol}"
        rows.append({"Omega": speed, "growth": rates[np.isfinite(rates)], "text": text})
    return rows
