"""Rows on Sections 4.1 and 4.2: separation occurs, ignoring it changes the motion, and the critical speed."""

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from disc_model.analysis import spectra
from disc_model.analysis.classify import irregularity
from disc_model.data.dataset import Missing
from disc_model.data.variables import Outcome, flag_names
from disc_model.disc.plate import modal_damping, mode_arrays
from disc_model.paper import measures
from disc_model.paper.measures import Absent, Array, CaseView, listed, mm, pairs, published
from disc_model.paper.model import FALSE, NOT_COMPUTED, PART, TRUE, Answer, graded
from disc_model.paper.section2 import BASE, moving_load_speed
from disc_model.parameters import Parameters


def force_grows_to_zero(case: CaseView, *, factor: float) -> Answer:
    if not case.separates:
        raise Absent(f"case {case.name}: no separation in {case['time_reached']:g} s")
    before = case["first_separation"]
    late = case.range_of("P", before - 20, before)
    return Answer(
        late.width > factor * case.early.width,
        place=case.place,
        ranges=(case.early, late),
        first=before,
        count=int(case["n_separations"]),
        end=case["time_reached"],
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
        heights = f"{1e3 * height.mean():.1f} mm ({1e3 * (case.late_range('u').high - case['u_0']):.1f} mm)"
        rows.append(f"{velocity.mean():+.2f} m/s and {heights} at {case.place}")
    return Answer(min(parts) >= share, up=measures.extent(100 * part for part in parts), rows=rows)


def separations_are_short(*cases: CaseView, share: float) -> Answer:
    rows, parts, periods = [], [], [1 / case.rate_of("separation") for case in cases]
    for case, period in zip(cases, periods, strict=True):
        durations, still_open = case.separation_durations()
        longest = max(durations.max(), still_open)
        parts.append(longest / period)
        rows.append(f"{1e3 * longest:.2f} ms at {case.place}")
    return Answer(max(parts) < share, rows=rows, parts=(min(parts), max(parts)), periods=measures.extent(periods))


def preload_closes(case: CaseView, *, share: float) -> Answer:
    """Whether the preload is the larger part of the force that drives the slider back while it is separated."""
    window = case.samples("zoom")
    apart = window["phase"].values == measures.SEPARATION
    if not apart.any():
        raise Missing(f"no separation in the window of case {case.name}")
    spring = case["k"] * float(np.mean(window["u"].values[apart] - case["u_0"]))
    part = case["N"] / (case["N"] + spring)
    verdict = TRUE if part >= share else PART if part > 0 else FALSE
    return Answer(verdict, part=part, place=case.place, N=case["N"], spring=spring)


def bounded_by_separation(*cases: CaseView, factor: float) -> Answer:
    """Whether what bounds the disc's vibration is separation: the control is the same motion without it."""
    also, bounds = [], []
    for _, bonded in pairs(cases):
        late, before = bonded.last_widths("w_point", measures.STRETCH, 2)
        also.append(late <= factor * before)
        bounds.append(1e3 * late)
    return Answer(PART if any(also) else TRUE, also=sum(also), of=len(also), bounds=measures.extent(bounds))


def keeps_sticking(*evidence: Any, share: float) -> Answer:
    *cases, study = evidence
    sticks = [case.stick for case in cases]
    settled = flag_names(study["settled"]) == "settled"
    shares = study["stick_fraction"].transpose(*study["settled"].dims).values
    least = np.min(shares[settled], initial=np.inf)
    return Answer(
        min(*sticks, least) > share,
        sticks=[f"{100 * stick:.0f} % at {case.place}" for case, stick in zip(cases, sticks, strict=True)],
        size=settled.size,
        settled=settled.sum(),
        extent=(100 * least, 100 * np.max(shares[settled], initial=0.0)),
        moving=measures.counted(settled.size - settled.sum(), "point") if not settled.all() else "",
        waited=measures.facts(study)["max_transient"],
    )


def releases_regularly(*cases: CaseView, within: float) -> Answer:
    intervals = [case.intervals() for case in cases]
    rows = [(case.place, 1e3 * each.mean(), irregularity(each)) for case, each in zip(cases, intervals, strict=True)]
    return Answer(graded(irregularity(each) <= within for each in intervals), rows=rows)


def more_frequencies(*cases: CaseView, floor: float) -> Answer:
    rows: list[tuple[Any, ...]] = []
    more, too = list[bool](), list[bool]()
    for free, bonded in pairs(cases):
        late = [(each["time"].values, each["w_point"].values) for each in (x.samples("late") for x in (free, bonded))]
        counts = [len(spectra.lines(*x, above=1.0, floor=least)) for least in (floor, floor / 10) for x in late]
        (more if free.from_rest else too).append(counts[0] > counts[1])
        rows.append((free.place, free.from_rest, *counts))
    return Answer(graded([*more, *too]) if any(more) else FALSE, rows=rows)


def quasi_periodic(*cases: CaseView, count: float) -> Answer:
    """Whether the first ``count`` cases are quasi-periodic. As many follow with a spring 0.1 % stiffer, then others."""
    number = int(count)
    shown, stiffer, begun = cases[:number], cases[number : 2 * number], cases[2 * number :]
    motions = [case.late_motion() for case in shown]
    if any(motion.kind is Outcome.UNDECIDED for motion in motions):
        return Answer(NOT_COMPUTED, "The 0-1 test lies between regular and chaotic motion.")
    near = [(case.place, measures.repeats(case.late_motion(), "release")) for case in stiffer]
    slips = [case for case in begun if case.stick <= 1e-3]
    separating = [measures.classify_intervals(tuple(case.intervals("separation"))) for case in slips]
    other = [(case.place, measures.repeats(each, "separation")) for case, each in zip(slips, separating, strict=True)]
    verdict = graded(motion.kind is Outcome.QUASI_PERIODIC for motion in motions)
    return Answer(verdict, rows=[(case.place, case.motion) for case in shown], near=near, other=other)


def smaller_range(*cases: CaseView, ratio: float, shown: float) -> Answer:
    """Decided by the first ``shown`` pairs; the results of the others are told."""
    parts = [measures.width_ratio(*pair) for pair in pairs(cases)]
    both = list(zip(pairs(cases), parts, strict=True))
    first, others = both[: int(shown)], both[int(shown) :]
    rows = [
        f"At {case.place}, the range of the disc is {mm(case.disc.width)} with separation and {mm(bonded.disc.width)} "
        f"without it; the ratio is {part:.2f}."
        for (case, bonded), part in first
    ]
    over = measures.extent(1 / part for part in parts)
    return Answer(
        max(parts[: int(shown)]) < ratio,
        " ".join(rows),
        f"In the other pairs the ratio is {'; '.join(f'{part:.2f} at {case.place}' for (case, _), part in others)}."
        * bool(others),
        f"In all {len(parts)} pairs, the range without separation is {over:.1f} times the range with separation.",
    )


def excites_less(*cases: CaseView, share: float) -> Answer:
    """Whether separation withholds energy that maintained contact supplies, at the amplitude that separation allows."""
    rows, withheld = [], []
    for free, bonded in pairs(cases):
        held = in_the_end(course(free.parameters, free["time_reached"]))
        kept = at_width(course(bonded.parameters, bonded["time_reached"], held.width), held.width)
        withheld.append(measures.ratio(kept.supplied - held.supplied, kept.gained, f"the surplus of {bonded.name}"))
        told = np.array([held.supplied, kept.supplied, held.damped, held.impacts, kept.gained])  # W
        rows.append((free.place, *1e3 * free.intervals("separation").mean() * told))
    steady = of_windows(pairs(cases)[0][1], "field")
    return Answer(min(withheld) >= share, withheld=withheld, rows=rows, pushes=steady.pushes, pulls=-steady.pulls)


# ---- Section 4.2: 385 N around the critical speed, and the critical speed in general
PHYSICAL = ("a", "b", "r_0", "h", "E", "nu", "rho", "D_star", "mu_s", "mu_k", "k", "k_p", "m", "N")
"""Parameters that are changed by 0.1 %, one at a time."""


def quiet(case: CaseView, *, share: float, newtons: float, within: float) -> Answer:
    """Whether the range of the contact force is small and that of a point fixed on the disc is constant and small."""
    early, late = case.early, case.late
    before, after, under = (each.width for each in (case.range_of("w_point", 1, 21), case.disc, case.late_range("u")))
    force = max(early.width, late.width) < share * case["N"] and late.width <= early.width + newtons
    disc = abs(after - before) <= within * before and under < case["h"]
    holds = not case.separates and force and disc
    widths = 1e3 * before, 1e3 * after, 1e3 * under
    return Answer(PART if holds and after >= case["h"] else holds, fate=case.fate, ranges=(early, late), widths=widths)


def bracketed(below: CaseView, above: CaseView, *, until: float) -> Answer:
    """Whether only the second case separates; which parameters, 0.1 % larger, make it otherwise is told."""
    lost = [
        [
            name
            for name in PHYSICAL
            if measures.separates_within(
                case.parameters.replace(**{name: 1.001 * getattr(case.parameters, name)}), until
            )
            != case.separates
        ]
        for case in (below, above)
    ]
    fates, speeds, rate = (below.fate, above.fate), (below["Omega"], above["Omega"]), below.rate_of("stick_to_slip")
    verdict = not below.separates and above.separates
    return Answer(verdict, fates=fates, lost=lost, speeds=speeds, rate=rate, until=until)


def falls_then_rises(study: xr.Dataset, *, depth: float) -> Answer:
    """Whether the lowest speed with separation has one minimum between higher ones, at every horizon."""
    study = _scanned(study)
    lowest = [measures.lowest_speeds(study.sel(horizon=horizon), depth) for horizon in study["horizon"]]
    falls, last = all(each.falls for each in lowest), lowest[-1]
    return Answer(
        PART if falls and last.again else falls,
        f"Runs from rest were tried for up to {float(study['horizon'][-1]):g} s, at speeds up to "
        f"{float(study['scan_Omega'][-1]):g} rad/s in steps of {float(study['scan_Omega'].diff('scan_Omega')[0]):g} "
        f"rad/s, and of {measures.facts(study)['precision']:g} rad/s where the outcome changes. {last.words}",
    )


def maintained_below(
    study: xr.Dataset, sweeps: xr.Dataset | None, basins: xr.Dataset | None, *, within: float
) -> Answer:
    """Whether contact is kept below the critical speed of the static start by other starts as well."""
    critical = _scanned(study)["critical_speed"].isel(horizon=-1)
    known, loads = np.isfinite(critical.values), critical["N"].values
    if not known.any():
        return Answer(FALSE, "No separation at any preload and speed.")
    begins, never = measures.extent(critical.values[known]), (listed(loads[~known], "g", ""), study["scan_Omega"][-1])
    below: list[tuple[float, ...]] = []
    if sweeps is not None:
        starts, turns = xr.align(critical, published(sweeps), join="inner")
        rows = zip(
            starts["N"].values, starts.values, turns["onset_speed"].values, turns["offset_speed"].values, strict=True
        )
        below = [(N, up, down, begin) for N, begin, up, down in rows if begin - min(up, down) > within]
    kicks: tuple[Any, ...] = (0,)
    if basins is not None:
        total = basins.sizes["energy"] * basins.sizes["start"]
        apart = round(total * float(published(basins)["separating_fraction"].sel(Omega=15.0)))
        kicks = apart, total, measures.extent(basins["energy"].values)
    wait = float(study["horizon"][-1]), sweeps is not None and measures.facts(sweeps)["dwell"]
    return Answer(PART if below or kicks[0] else TRUE, begins=begins, never=never, below=below, kicks=kicks, wait=wait)


def far_below(*cases: CaseView, share: float) -> Answer:
    critical = moving_load_speed(cases[0].parameters)
    lower = [case for case in cases if case["Omega"] < share * critical and case.separates]
    rows = [(case.place, case["Omega"] / critical) for case in lower]
    return Answer(bool(lower), "" if lower else "No case separates.", rows=rows, critical=critical)


def both_at_low_speed(study: xr.Dataset, *, share: float) -> Answer:
    """Whether cycles grow, and separation occurs, far below the critical speed of a moving load."""
    study, critical = published(study), moving_load_speed(BASE)
    low, without = study["Omega"] < share * critical, study["growth_rate"].isnull()
    unstable, apart = study["growth_rate"] > 0, study["outcome"].copy(data=flag_names(study["outcome"]) == "separation")
    most, method, kept = float(study["Omega"].max()), flag_names(study["method"]), unstable & ~apart
    known = [int((kept & (method == how)).sum()) for how in ("simulation", "settled", "multipliers")]
    return Answer(
        bool((low & unstable).any() and (low & apart).any()),
        most=most,
        part=most / critical,
        counts=[int(x.sum()) for x in (unstable, apart, kept, apart & (method == "simulation"), apart & without)],
        known=known,
        size=apart.size,
        horizon=measures.facts(study)["horizon"],
    )


def _scanned(study: xr.Dataset) -> xr.Dataset:
    """The scan with the published modes; raises `Missing` if a point failed."""
    study = published(study)
    if np.any(flag_names(study["status"]) != "ok"):
        raise Missing("study critical_speed has points that failed")
    return study


# ---- The transverse energy of a motion: what the slope supplies, and what damping and impacts take
STAGES, LENGTH, RATE = 60, 5.0, 400.0
"""Stages of a run; greatest time in s at the end of each over which powers are averaged, and samples per s there."""


class Powers(NamedTuple):
    """Mean powers, W, over a time in which the range of the slider's height is ``width``, m.

    pushes, pulls : supplied by the contact force on the slope, P f B, while it is positive and negative
    damped : taken by the damping of the disc and of the slider
    gained : rise of the energy of the disc and of the slider's vertical motion
    """

    width: float
    pushes: float
    pulls: float
    damped: float
    gained: float

    @property
    def supplied(self) -> float:
        return self.pushes + self.pulls

    @property
    def impacts(self) -> float:
        """Taken by impacts: the rest of the balance."""
        return self.supplied - self.damped - self.gained


def powers(p: Parameters, u_0: float, theta: Array, samples: Sequence[Mapping[Any, Any]]) -> Powers:
    """Mean powers from samples of the disc at as many angles as it has modes, which give its whole motion. f B is the
    velocity of the contact point less that of the disc's material under it."""
    order = np.argsort(mode_arrays(p).diameters)
    omega, psi, damping = (
        np.concatenate([each[order], each[order][1:]])[:, None]
        for each in (mode_arrays(p).omega, mode_arrays(p).psi, modal_damping(p))
    )
    time, force, drive, u, velocity = (np.asarray(samples[0][name]) for name in ("time", "P", "psi", "u", "u_velocity"))
    shapes = _waves(theta, p.n_diameters).T
    angle, speed = (
        np.linalg.solve(shapes, np.stack([np.asarray(each[name]) for each in samples]))
        for name in ("w_point", "w_point_velocity")
    )
    power = force * (velocity - np.sum(speed * _waves(p.Omega * time - drive, p.n_diameters), axis=0))
    energy = np.sum((speed / psi) ** 2 + (omega * angle / psi) ** 2, axis=0)
    energy += p.m * velocity**2 + p.k * (u - u_0) ** 2 + 2 * p.N * (u - u_0)
    damped = np.sum(damping * (speed / psi) ** 2, axis=0) + p.c * velocity**2
    pushes, pulls, taken = (float(np.mean(each)) for each in (power * (force > 0), power * (force < 0), damped))
    gained = float(energy[-1] - energy[0]) / 2 / float(time[-1] - time[0])
    return Powers(float(np.ptp(u)), pushes, pulls, taken, gained)


def of_windows(case: CaseView, prefix: str) -> Powers:
    """Powers in the windows of a case that are named by a prefix and a number, one for each angle."""
    windows = [case.samples(f"{prefix}{i}") for i in range(2 * case.parameters.n_diameters + 1)]
    theta = np.array([window.attrs["theta"] for window in windows])
    return powers(case.parameters, case["u_0"], theta, windows)


def _waves(angle: Array, most: int) -> Array:
    """1, then cosines and sines of multiples of an angle: (2 most + 1, number of angles)."""
    orders = np.arange(1, most + 1)[:, None] * angle
    return np.concatenate([np.ones((1, angle.size)), np.cos(orders), np.sin(orders)])


def course(p: Parameters, until: float, widest: float = math.inf) -> list[Powers]:
    """Powers at `STAGES` times of the motion from the static start, up to a time in s or beyond a width in m."""
    from disc_model.simulation.api import simulate
    from disc_model.simulation.case import Window

    theta = 2 * np.pi * np.arange(2 * p.n_diameters + 1) / (2 * p.n_diameters + 1)
    state, courses = None, []
    for begin, end in pairwise(np.linspace(0.0, until, STAGES + 1).tolist()):
        start = max(begin, end - LENGTH)
        windows = {f"at {angle:g}": Window(start=start, stop=end, rate=RATE, theta=angle) for angle in theta.tolist()}
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
    """Powers of a growing motion where it first has a width, which they follow as its square; raises `Absent`."""
    beyond = next((i for i, each in enumerate(courses) if i and each.width > width), 0)
    if not beyond:
        raise Absent(f"maintained contact comes to {1e3 * courses[-1].width:.3g} mm only")
    low, high = courses[beyond - 1 : beyond + 1]
    share = (width**2 - low.width**2) / (high.width**2 - low.width**2)
    return Powers(*((1 - share) * a + share * b for a, b in zip(low, high, strict=True)))
