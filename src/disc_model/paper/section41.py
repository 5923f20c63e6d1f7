"""Rows on Sections 4.1 and 4.2: separation occurs, ignoring it changes the motion, and the critical
speed."""

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from scipy.signal import find_peaks

from disc_model.analysis import spectra
from disc_model.analysis.classify import motion_of
from disc_model.data.dataset import Missing
from disc_model.data.texts import fill
from disc_model.data.variables import Outcome, flag_names
from disc_model.disc.plate import modal_damping, mode_arrays
from disc_model.paper import measures
from disc_model.paper.measures import (
    Absent,
    Array,
    CaseView,
    extent,
    facts,
    or_none,
    pairs,
    published,
    sound,
)
from disc_model.paper.model import FALSE, NOT_COMPUTED, PART, TRUE, Answer, graded, read_texts
from disc_model.paper.section2 import BASE, moving_load_speed
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Window


def force_grows_to_zero(case: CaseView, *, factor: float) -> Answer:
    if not case.separates:
        raise Absent(f"case {case.name}: no separation in {case['time_reached']:g} s")
    before = case["first_separation"]
    late = case.range_of("P", before - 20, before)
    return Answer(late.width > factor * case.early.width, ranges=(case.early, late), first=before)


def upward(*cases: CaseView, share: float) -> Answer:
    parts = []
    for case in cases:
        velocity = case.switches("separation")["u_velocity"].values
        if not velocity.size:
            raise Missing(f"case {case.name} keeps no separation")
        parts.append(float(np.mean(velocity > 0)))
    return Answer(min(parts) >= share, up=extent(100 * part for part in parts), cases=len(cases))


def separations_are_short(*cases: CaseView, share: float) -> Answer:
    parts = extent(case.longest_separation * case.rate_of("separation") for case in cases)
    return Answer(
        parts.high < share,
        lasts=extent(1e3 * case.longest_separation for case in cases),
        parts=parts,
    )


def preload_closes(case: CaseView, *, share: float) -> Answer:
    window = case.samples("zoom")
    apart = window["phase"].values == measures.SEPARATION
    if not apart.any():
        raise Missing(f"no separation in the window of case {case.name}")
    spring = case["k"] * float(np.mean(window["u"].values[apart] - case["u_0"]))
    part = case["N"] / (case["N"] + spring)
    return Answer(
        TRUE if part >= share else PART if part > 0 else FALSE,
        part=part,
        N=case["N"],
        spring=spring,
    )


def bounded_by_separation(*cases: CaseView, factor: float) -> Answer:
    """Whether what bounds the disc's vibration is separation: the control is the same motion
    without it."""
    widths = [bonded.last_widths("w_point", measures.STRETCH, 2) for _, bonded in pairs(cases)]
    also = [late <= factor * before for late, before in widths]
    return Answer(PART if any(also) else TRUE, also=sum(also), of=len(also))


def keeps_sticking(*evidence: Any, share: float) -> Answer:
    *cases, study = evidence
    settled = flag_names(study["settled"]) == "settled"
    shares = study["stick_fraction"].transpose(*study["settled"].dims).values
    least, most = np.min(shares[settled], initial=np.inf), np.max(shares[settled], initial=0.0)
    rows = [f"{100 * case.stick:.0f} % at {case.place}" for case in cases]
    told = {"size": settled.size, "settled": settled.sum(), "extent": (100 * least, 100 * most)}
    return Answer(min(least, *(case.stick for case in cases)) > share, sticks=rows, **told)


def releases_regularly(*cases: CaseView, within: float) -> Answer:
    intervals = [(case.place, case.intervals()) for case in cases]
    rows = [
        (place, 1e3 * each.mean(), float(each.std() / each.mean())) for place, each in intervals
    ]
    return Answer(graded(spread <= within for *_, spread in rows), rows=rows)


def more_frequencies(*cases: CaseView, floor: float) -> Answer:
    rows = list[tuple[str, int, int]]()
    for pair in pairs(cases):
        late = [
            (x["time"].values, x["w_point"].values) for x in (case.samples("late") for case in pair)
        ]
        if pair[0].from_rest:
            free, bonded = (len(spectra.lines(*x, above=1.0, floor=floor)) for x in late)
            rows.append((pair[0].place, free, bonded))
    return Answer(
        graded(free > bonded for _, free, bonded in rows) if rows else NOT_COMPUTED, rows=rows
    )


def quasi_periodic(*cases: CaseView) -> Answer:
    """Judge by the motions from rest whether the slider moves quasi-periodically.

    Motions from other starts are described beside them, by the intervals between separations,
    because one that never sticks has no releases.
    """
    from_rest = [case for case in cases if case.from_rest]
    kinds = [case.late_motion.kind for case in from_rest]
    if Outcome.UNDECIDED in kinds:
        return Answer(NOT_COMPUTED, "The 0-1 test lies between regular and chaotic motion.")
    others = []
    for case in cases:
        if not case.from_rest:
            intervals = case.intervals("separation")
            motion = motion_of(intervals)
            length = 1e3 * float(intervals[: motion.period].sum())
            others.append((case.place, measures.repeats(motion, "separation"), length))
    return Answer(
        graded(kind is Outcome.QUASI_PERIODIC for kind in kinds),
        rows=[(case.place, case.motion) for case in from_rest],
        others=others,
    )


def smaller_range(*cases: CaseView, ratio: float, shown: float) -> Answer:
    """Decided by the first ``shown`` pairs; the results of the others are told."""
    rows = [
        (case.place, measures.width_ratio(case, other), case.disc, other.disc)
        for case, other in pairs(cases)
    ]
    return Answer(max(part for _, part, *_ in rows[: int(shown)]) < ratio, rows=rows)


def excites_less(*cases: CaseView, share: float) -> Answer:
    """Whether separation withholds energy that maintained contact supplies, at the amplitude that
    separation allows."""
    rows, withheld = [], []
    for free, bonded in pairs(cases):
        held = in_the_end(course(free.parameters, free["time_reached"]))
        kept = at_width(course(bonded.parameters, bonded["time_reached"], held.width), held.width)
        withheld.append(
            measures.ratio(
                kept.supplied - held.supplied, kept.gained, f"the surplus of {bonded.name}"
            )
        )
        told = np.array([held.supplied, kept.supplied, held.damped, held.impacts, kept.gained])  # W
        rows.append((free.place, *1e3 * free.intervals("separation").mean() * told))
    bonded = pairs(cases)[0][1]
    windows = [
        bonded.samples(f"field{i}") for i in range(2 * bonded.parameters.n_diameters + 1)
    ]  # one for each angle
    theta = np.array([window.attrs["theta"] for window in windows])
    steady = powers(bonded.parameters, bonded["u_0"], theta, windows)
    return Answer(
        min(withheld) >= share,
        withheld=withheld,
        rows=rows,
        pushes=steady.pushes,
        pulls=-steady.pulls,
    )


# ---- Section 4.2: 385 N around the critical speed, and the critical speed in general
PHYSICAL = ("a", "b", "r_0", "h", "E", "nu", "rho", "D_star", "mu_s", "mu_k", "k", "k_p", "m", "N")
"""Parameters that are changed by 0.1 %, one at a time."""


def quiet(case: CaseView, *, share: float, newtons: float, within: float) -> Answer:
    early, late = case.early, case.late
    before, after, under = (
        each.width for each in (case.range_of("w_point", 1, 21), case.disc, case.late_range("u"))
    )
    force = max(early.width, late.width) < share * case["N"] and late.width <= early.width + newtons
    disc = abs(after - before) <= within * before and under < case["h"]
    holds = not case.separates and force and disc
    widths = 1e3 * before, 1e3 * after, 1e3 * under
    return Answer(
        PART if holds and after >= case["h"] else holds,
        fate=case.fate,
        ranges=(early, late),
        widths=widths,
    )


def bracketed(below: CaseView, above: CaseView, *, until: float) -> Answer:
    lost = []
    for case in (below, above):
        larger = {
            name: case.parameters.replace(**{name: 1.001 * getattr(case.parameters, name)})
            for name in PHYSICAL
        }
        lost.append(
            [x for x, p in larger.items() if measures.separates_within(p, until) != case.separates]
        )
    fates, speeds = (below.fate, above.fate), (below["Omega"], above["Omega"])
    return Answer(not below.separates and above.separates, fates=fates, lost=lost, speeds=speeds)


def falls_then_rises(study: xr.Dataset, *, depth: float) -> Answer:
    study = sound(published(study))
    verdicts, words = zip(
        *(lowest_speeds(study.sel(horizon=x), depth) for x in study["horizon"]), strict=True
    )
    longest, speeds = float(study["horizon"][-1]), study["scan_Omega"].values
    verdict, step = FALSE if FALSE in verdicts else verdicts[-1], speeds[1] - speeds[0]
    return Answer(verdict, longest=longest, fastest=speeds[-1], step=step, words=words[-1])


def lowest_speeds(study: xr.Dataset, depth: float) -> tuple[str, str]:
    """Whether the lowest speed with separation falls, rises and does not fall again with the
    preload, by ``depth`` (rad/s) or more; and how it changes, in sentences."""
    loads, speeds = study["N"].values, study["critical_speed"].values
    infinite = np.nanmax(speeds, initial=0.0) + 2 * depth  # stands for no separation
    known = np.where(np.isnan(speeds), infinite, speeds)
    dips, also_last = (
        find_peaks(-each, prominence=depth)[0] for each in (known, np.append(known, infinite))
    )
    if not dips.size:
        return (
            FALSE,
            f"The lowest speeds in turn are {', '.join(or_none(x, '.1f') for x in speeds)} rad/s.",
        )
    first, start = min(dips), int(np.isfinite(speeds).argmax())
    later = [i for i in also_last if i > first]
    top = first + np.nanargmax(speeds[first : later[0] if later else None])
    again, *larger = top + 1 + np.flatnonzero(np.isfinite(speeds[top + 1 :])) if later else [top]
    turns = {"start": start, "lowest": first, "top": top, "again": again}
    told = {"never": loads[:first][np.isnan(speeds[:first])], "later": later, "last": loads[-1]}
    told |= {name: (speeds[i], loads[i]) for name, i in turns.items()} | {
        "beyond": larger and extent(speeds[larger])
    }
    return PART if later else TRUE, fill(read_texts("paper/pages.yaml")["lowest_speeds"], **told)


def maintained_below(study: xr.Dataset, *beside: xr.Dataset | None, within: float) -> Answer:
    sweeps, basins = beside
    critical = sound(published(study))["critical_speed"].isel(horizon=-1)
    if critical.isnull().all():
        return Answer(FALSE, "No separation at any preload and speed.")
    below: list[tuple[float, ...]] = []
    kicks: tuple[Any, ...] = (0,)
    if sweeps is not None:
        starts, turns = xr.align(critical, published(sweeps), join="inner")
        columns = (starts["N"], turns["onset_speed"], turns["offset_speed"], starts)
        rows = zip(*(column.values for column in columns), strict=True)
        below = [
            (N, up, down, begin) for N, up, down, begin in rows if begin - min(up, down) > within
        ]
    if basins is not None:
        total = basins.sizes["energy"] * basins.sizes["start"]
        apart = round(total * float(published(basins)["separating_fraction"].sel(Omega=15.0)))
        kicks = apart, total, extent(basins["energy"].values)
    swept = facts(sweeps) if sweeps is not None else {}
    return Answer(PART if below or kicks[0] else TRUE, below=below, kicks=kicks, swept=swept)


def far_below(*cases: CaseView, share: float) -> Answer:
    critical = moving_load_speed(cases[0].parameters)
    lower = [case for case in cases if case["Omega"] < share * critical and case.separates]
    rows = [(case.place, case["Omega"] / critical) for case in lower]
    return Answer(bool(lower), "" if lower else "No case separates.", rows=rows, critical=critical)


def both_at_low_speed(study: xr.Dataset, *, share: float) -> Answer:
    study, critical = published(study), moving_load_speed(BASE)
    low, without = study["Omega"] < share * critical, study["growth_rate"].isnull()
    unstable, apart = (
        study["growth_rate"] > 0,
        study["outcome"].copy(data=flag_names(study["outcome"]) == "separation"),
    )
    most = float(study["Omega"].max())
    counts = [int(x.sum()) for x in (unstable, apart, unstable & ~apart, apart & without)]
    inferred = int(np.sum(flag_names(study["method"]) == "inferred"))
    holds = (low & unstable).any() and (low & apart).any()
    return Answer(
        bool(holds),
        most=most,
        part=most / critical,
        counts=counts,
        size=apart.size,
        inferred=inferred,
    )


# ---- The transverse energy of a motion: what the slope supplies, and what damping and impacts take
STAGES = 60  # of a run
LENGTH, RATE = (
    5.0,
    400.0,
)  # greatest time at the end of each over which powers are averaged, s; samples per s


class Powers(NamedTuple):
    """Mean powers, W, over a time."""

    width: float  # range of the slider's height, m
    pushes: float  # supplied by the contact force on the slope, P f B, while it is positive,
    pulls: float  # and while it is negative
    damped: float  # taken by the damping of the disc and of the slider
    gained: float  # rise of the energy of the disc and of the slider's vertical motion

    @property
    def supplied(self) -> float:
        return self.pushes + self.pulls

    @property
    def impacts(self) -> float:
        """Taken by impacts: the rest of the balance."""
        return self.supplied - self.damped - self.gained


def powers(p: Parameters, u_0: float, theta: Array, samples: Sequence[Mapping[Any, Any]]) -> Powers:
    """Mean powers from samples of the disc at as many angles as it has modes, which give its whole
    motion. f B is the velocity of the contact point less that of the disc's material under it."""
    order = np.argsort(mode_arrays(p).diameters)
    omega, psi, damping = (
        np.concatenate([each[order], each[order][1:]])[:, None]
        for each in (mode_arrays(p).omega, mode_arrays(p).psi, modal_damping(p))
    )
    time, force, drive, u, velocity = (
        np.asarray(samples[0][name]) for name in ("time", "P", "psi", "u", "u_velocity")
    )
    disc = [
        np.stack([np.asarray(each[name]) for each in samples])
        for name in ("w_point", "w_point_velocity")
    ]
    angle, speed = (np.linalg.solve(_waves(theta, p.n_diameters).T, values) for values in disc)
    power = force * (
        velocity - np.sum(speed * _waves(p.Omega * time - drive, p.n_diameters), axis=0)
    )
    energy = np.sum((speed / psi) ** 2 + (omega * angle / psi) ** 2, axis=0)
    energy += p.m * velocity**2 + p.k * (u - u_0) ** 2 + 2 * p.N * (u - u_0)
    damped = np.sum(damping * (speed / psi) ** 2, axis=0) + p.c * velocity**2
    pushes, pulls, taken = (
        float(np.mean(each)) for each in (power * (force > 0), power * (force < 0), damped)
    )
    gained = float(energy[-1] - energy[0]) / 2 / float(time[-1] - time[0])
    return Powers(float(np.ptp(u)), pushes, pulls, taken, gained)


def _waves(angle: Array, most: int) -> Array:
    """1, then cosines and sines of multiples of an angle: (2 most + 1, number of angles)."""
    orders = np.arange(1, most + 1)[:, None] * angle
    return np.concatenate([np.ones((1, angle.size)), np.cos(orders), np.sin(orders)])


def course(p: Parameters, until: float, widest: float = math.inf) -> list[Powers]:
    """Powers at `STAGES` times of the motion from the static start, up to a time in s or beyond a
    width in m."""
    theta = 2 * np.pi * np.arange(2 * p.n_diameters + 1) / (2 * p.n_diameters + 1)
    state, courses = None, []
    for begin, end in pairwise(np.linspace(0.0, until, STAGES + 1).tolist()):
        start = max(begin, end - LENGTH)
        windows = {
            f"at {angle:g}": Window(start=start, stop=end, rate=RATE, theta=angle)
            for angle in theta.tolist()
        }
        run = simulate(p, end, windows, initial_state=state).raise_for_status()
        state = run.final_state
        courses.append(powers(p, run.u_0, theta, [*run.samples.values()]))
        if len(courses) > 1 and courses[-1].width > widest:
            break
    return courses


def in_the_end(courses: Sequence[Powers]) -> Powers:
    """Means over the last quarter of the stages, for the steady state."""
    return Powers(*np.mean(courses[-len(courses) // 4 :], axis=0).tolist())


def at_width(courses: Sequence[Powers], width: float) -> Powers:
    """Powers of a growing motion where it first has a width, which they follow as its square;
    raises `Absent`."""
    beyond = next((i for i, each in enumerate(courses) if i and each.width > width), 0)
    if not beyond:
        raise Absent(f"maintained contact comes to {1e3 * courses[-1].width:.3g} mm only")
    low, high = courses[beyond - 1 : beyond + 1]
    share = (width**2 - low.width**2) / (high.width**2 - low.width**2)
    return Powers(*((1 - share) * a + share * b for a, b in zip(low, high, strict=True)))
