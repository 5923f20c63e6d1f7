"""Rows on Sections 4.1 and 4.2.

Separation occurs, ignoring it changes the motion, and the critical speed for separation.
"""

from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from scipy.signal import find_peaks

from disc_model.analysis import classify, spectra
from disc_model.data import texts
from disc_model.data.dataset import Missing
from disc_model.data.variables import UNKNOWN_OUTCOMES, Outcome, flag_names
from disc_model.studies.quantities.swept_speeds import swept_speeds
from workflow.paper import energy, judging_tables, measures, model
from workflow.paper.measures import Absent, CaseView, extent, or_none, pairs, published
from workflow.paper.model import AMBIGUOUS, FALSE, NOT_COMPUTED, PART, TRUE, Answer, graded
from workflow.paper.section2 import BASE, moving_load_speed


def force_grows_to_zero(case: CaseView, *, factor: float) -> Answer:
    """Judge whether the range of the contact force grows by a factor before contact is lost."""
    if not case.separates:
        raise Absent(f"case {case.name}: no separation in {case['time_reached']:g} s")
    first = case["first_separation"]
    late = case.range_of("P", first - 20, first)
    early = case.early
    return Answer(late.width > factor * early.width, ranges=(early, late), first=first)


def upward(*cases: CaseView, share: float) -> Answer:
    """Judge whether the slider moves upward at a share of the separations of each case."""
    parts = []
    for case in cases:
        velocity = case.switches("separation")["u_velocity"].values
        if not velocity.size:
            raise Missing(f"case {case.name} keeps no separation")
        parts.append(float(np.mean(velocity > 0)))
    percent = extent(100 * part for part in parts)
    return Answer(min(parts) >= share, up=percent, cases=len(cases))


def separations_are_short(*cases: CaseView, share: float) -> Answer:
    """Judge whether separations take less than a share of the time from one to the next."""
    longest = []
    parts = []
    for case in cases:
        duration = case.longest_separation
        longest.append(1e3 * duration)
        parts.append(duration * case.rate_of("separation"))
    return Answer(max(parts) < share, lasts=extent(longest), parts=extent(parts))


def preload_closes(case: CaseView, *, share: float) -> Answer:
    """Judge whether the preload is a share of the forces that push the separated slider back."""
    window = case.samples("zoom")
    separated = window["phase"].values == measures.SEPARATION
    if not separated.any():
        raise Missing(f"no separation in the window of case {case.name}")
    height = window["u"].values[separated] - case["u_0"]
    spring = case["k"] * float(np.mean(height))
    part = case["N"] / (case["N"] + spring)
    verdict = FALSE
    if part >= share:
        verdict = TRUE
    elif part > 0:
        verdict = PART
    return Answer(verdict, part=part, N=case["N"], spring=spring)


def bounded_by_separation(*cases: CaseView, factor: float) -> Answer:
    """Judge whether what bounds the disc's vibration is separation.

    The control is the same motion without it, which must keep growing by a factor.
    """
    bounded = []
    for _, bilateral in pairs(cases):
        late, before = bilateral.last_widths("w_point", measures.STRETCH, 2)
        bounded.append(late <= factor * before)
    verdict = PART if any(bounded) else TRUE
    return Answer(verdict, also=sum(bounded), of=len(bounded))


def keeps_sticking(*evidence: Any, share: float) -> Answer:
    """Judge whether the slider sticks for more than a share of the time without separation.

    Parameters
    ----------
    evidence : cases without separation, and last a grid study of such motions
    share : of time
    """
    *cases, study = evidence
    settled = flag_names(study["settled"]) == "settled"
    shares = study["stick_fraction"].transpose(*study["settled"].dims).values
    least = np.min(shares[settled], initial=np.inf)
    most = np.max(shares[settled], initial=0.0)
    holds = min(least, *(case.stick for case in cases)) > share
    return Answer(
        AMBIGUOUS if holds else FALSE,
        sticks=[f"{100 * case.stick:.0f} % at {case.place}" for case in cases],
        size=settled.size,
        settled=settled.sum(),
        extent=(100 * least, 100 * most),
    )


def releases_regularly(*cases: CaseView, within: float) -> Answer:
    """Judge whether the intervals between releases spread by a share of their mean at most."""
    rows = []
    for case in cases:
        intervals = case.intervals()
        mean = intervals.mean()
        spread = float(intervals.std() / mean)
        rows.append((case.place, 1e3 * mean, spread))
    verdict = graded(spread <= within for *_, spread in rows)
    return Answer(verdict, rows=rows)


def more_frequencies(*cases: CaseView, floor: float) -> Answer:
    """Judge whether the disc's spectrum has more lines with separation than without it.

    Parameters
    ----------
    cases : with separation and without it, which form pairs; those from rest decide
    floor : amplitude over the strongest from which a line counts
    """
    rows: list[tuple[Any, ...]] = []
    for case, bilateral in pairs(cases):
        late = [each.samples("late") for each in (case, bilateral)]
        if case.from_rest:
            counts = []
            for each in late:
                time = each["time"].values
                lines = spectra.lines(time, each["w_point"].values, above=1.0, floor=floor)
                counts.append(len(lines))
            rows.append((case.place, *counts))
    if not rows:
        return Answer(NOT_COMPUTED, rows=rows)
    verdict = graded(with_it > without for _, with_it, without in rows)
    return Answer(verdict, rows=rows)


def quasi_periodic(*cases: CaseView) -> Answer:
    """Judge by the motions from rest whether the slider moves quasi-periodically.

    Motions from other starts are described as well, by the intervals between separations, because
    one that never sticks has no releases.
    """
    from_rest = [case for case in cases if case.from_rest]
    kinds = [case.late_motion.kind for case in from_rest]
    if Outcome.UNDECIDED in kinds:
        return Answer(NOT_COMPUTED, "The 0-1 test lies between regular and chaotic motion.")
    others = []
    for case in cases:
        if not case.from_rest:
            intervals = case.intervals("separation")
            motion = classify.motion_of(intervals)
            length = 1e3 * float(intervals[: motion.period].sum())
            others.append((case.place, measures.repeats(motion, "separation"), length))
    return Answer(
        graded(kind is Outcome.QUASI_PERIODIC for kind in kinds),
        rows=[(case.place, case.motion) for case in from_rest],
        others=others,
    )


def smaller_range(*cases: CaseView, ratio: float, shown: float) -> Answer:
    """Judge whether the range of the disc with separation is less than a share of that without.

    Parameters
    ----------
    cases : with separation and without it, which form pairs
    ratio : the share
    shown : number of pairs that decide, the first ones
    """
    rows = [
        (case.place, measures.width_ratio(case, other), case.disc, other.disc)
        for case, other in pairs(cases)
    ]
    largest = max(part for _, part, *_ in rows[: int(shown)])
    return Answer(largest < ratio, rows=rows)


def excites_less(*cases: CaseView, energies: pd.DataFrame, share: float) -> Answer:
    """Judge whether separation withholds energy that maintained contact supplies.

    The words have two readings. Over whole periods both are compared at the range that separation
    allows. Over the time apart, in which nothing is supplied, the comparison is with the negative
    force of maintained contact in the end.

    Parameters
    ----------
    cases : with separation and without it, which form pairs
    energies : of these pairs, as `judging_tables.energies`
    share : of the energy that the motion in maintained contact gains, which has to be withheld
    """
    table = energies.set_index("case")
    rows = []
    withheld = []
    by_sign = []
    less = []
    for free, bilateral in pairs(cases):
        found = table.loc[free.name]
        in_period = np.asarray(found[judging_tables.ENERGIES], dtype=float)
        if np.isnan(in_period).any():
            raise Absent(str(found["remark"]))
        supplied, maintained, damped, taken, gained = in_period.tolist()
        surplus = f"the surplus of {bilateral.name}"
        withheld.append(measures.ratio(maintained - supplied, gained, surplus))
        rows.append((free.place, supplied, maintained, damped, taken, gained))
        by_sign.append((free.place, *found[judging_tables.POWERS]))
        compliant = np.asarray(found[judging_tables.COMPLIANT], dtype=float)
        less.append(1 - compliant / supplied)

    over_periods = min(withheld) >= share
    while_negative = all(pulls > 0 for *_, pulls in by_sign)
    # by the second reading no statement is false: apart, nothing is supplied
    return Answer(
        TRUE if over_periods and while_negative else AMBIGUOUS,
        withheld=withheld,
        rows=rows,
        instant=energy.INSTANT,
        near=energy.NEAR,
        by_sign=by_sign,
        least_less=min(share for *_, share in less),
        most_less=max(share for _, share, _ in less),
        stretch=energy.STRETCH,
        stretches=energy.STRETCHES,
    )


# ---- Section 4.2: 385 N around the critical speed, and the critical speed in general


def quiet(case: CaseView, *, share: float, newtons: float, within: float) -> Answer:
    """Judge whether the disc oscillates in a small constant range.

    Parameters
    ----------
    case : the run
    share : of the preload, below which the range of the contact force is small
    newtons : by which this range may rise between the first 20 s and the last, N
    within : share by which the range of the disc's point may change
    """
    early = case.early
    late = case.late
    before = case.range_of("w_point", 1, 21).width
    after = case.disc.width
    under_slider = case.late_range("u").width
    small_force = max(early.width, late.width) < share * case["N"]
    steady_force = late.width <= early.width + newtons
    steady_disc = abs(after - before) <= within * before
    thin = under_slider < case["h"]
    holds = not case.separates and small_force and steady_force and steady_disc and thin
    return Answer(
        model.partly(holds, after >= case["h"]),
        fate=case.fate,
        ranges=(early, late),
        widths=(1e3 * before, 1e3 * after, 1e3 * under_slider),
    )


def bracketed(below: CaseView, above: CaseView, *, small_changes: pd.DataFrame) -> Answer:
    """Judge whether separation begins between two speeds.

    The answer names parameters a thousandth of which changes that, by `judging_tables.small_changes`.
    """
    changed = []
    for case in (below, above):
        of_case = small_changes[small_changes["case"] == case.name]
        separates = of_case["first_s"].notna()
        changed.append(of_case["parameter"][separates != case.separates].to_list())
    return Answer(
        not below.separates and above.separates,
        fates=(below.fate, above.fate),
        lost=changed,
        speeds=(below["Omega"], above["Omega"]),
    )


def falls_then_rises(study: xr.Dataset, *, depth: float) -> Answer:
    """Judge whether the lowest speed with separation falls and then rises with the preload.

    Parameters
    ----------
    study : lowest speeds by preload and horizon
    depth : rad/s, from which a change counts
    """
    study = measures.sound(published(study))
    verdicts = []
    words = ""
    for horizon in study["horizon"]:
        verdict, words = lowest_speeds(study.sel(horizon=horizon), depth)
        verdicts.append(verdict)
    speeds = study["scan_Omega"].values
    return Answer(
        FALSE if FALSE in verdicts else verdicts[-1],
        longest=float(study["horizon"][-1]),
        fastest=speeds[-1],
        step=speeds[1] - speeds[0],
        words=words,
    )


def lowest_speeds(study: xr.Dataset, depth: float) -> tuple[str, str]:
    """Judge how the lowest speed with separation changes with the preload.

    Parameters
    ----------
    study : lowest speeds by preload
    depth : rad/s, from which a fall or a rise counts

    Returns
    -------
    tuple of str
        The verdict on whether it falls, rises and does not fall again; and how it changes, in
        sentences.
    """
    loads = study["N"].values
    speeds = study["critical_speed"].values
    separates = np.isfinite(speeds)

    # dips of the curve, also one at its end; no separation counts as a very high speed
    infinite = np.nanmax(speeds, initial=0.0) + 2 * depth
    known = np.where(separates, speeds, infinite)
    dips, _ = find_peaks(-known, prominence=depth)
    dips_with_last, _ = find_peaks(-np.append(known, infinite), prominence=depth)
    if not dips.size:
        listed = ", ".join(or_none(speed, ".1f") for speed in speeds)
        return FALSE, f"The lowest speeds in turn are {listed} rad/s."

    lowest = min(dips)
    later = [i for i in dips_with_last if i > lowest]
    end = later[0] if later else None
    top = lowest + np.nanargmax(speeds[lowest:end])
    again = top
    larger: list[int] = []
    if later:
        next_load = top + 1
        again, *larger = next_load + np.flatnonzero(separates[next_load:])

    turns = {"start": int(separates.argmax()), "lowest": lowest, "top": top, "again": again}
    values: dict[str, Any] = {}
    for name, i in turns.items():
        values[name] = (speeds[i], loads[i])
    words = texts.fill(
        model.read_texts("pages.yaml")["lowest_speeds"],
        never=loads[:lowest][~separates[:lowest]],
        later=later,
        last=loads[-1],
        beyond=larger and extent(speeds[larger]),
        **values,
    )
    return PART if later else TRUE, words


def maintained_below(study: xr.Dataset, *optional: xr.Dataset | None, within: float) -> Answer:
    """Judge whether contact is always kept below the critical speed for separation.

    Parameters
    ----------
    study : critical speeds by preload and horizon
    optional : sweeps of the speed up and down, and basins of attraction at 385 N, if there are any
    within : rad/s by which separation must come below the critical speed to count
    """
    sweeps, basins = optional
    critical = measures.sound(published(study))["critical_speed"].isel(horizon=-1)
    if critical.isnull().all():
        return Answer(FALSE, "No separation at any preload and speed.")
    below: list[tuple[float, ...]] = []
    swept: dict[str, Any] = {}
    if sweeps is not None:
        below = _separations_below(critical, published(sweeps), within)
        swept = measures.facts(sweeps)
    kicks: tuple[Any, ...] = (0,)
    if basins is not None:
        kicks = _separating_kicks(basins)
    verdict = PART if below or kicks[0] else TRUE
    return Answer(verdict, below=below, kicks=kicks, swept=swept)


def _separating_kicks(basins: xr.Dataset) -> tuple[int, int, Any]:
    """Return how many kicks at 15 rad/s are known to lead to lasting separation, how many there
    are, and the least and the greatest of their energies (J)."""
    kicks = basins.sizes["energy"] * basins.sizes["start"]
    study = published(basins).sel(Omega=15.0)
    known = float(np.mean(~np.isin(flag_names(study["kind"]), UNKNOWN_OUTCOMES)))
    separating = 0
    if known:
        separating = round(kicks * known * float(study["separating_fraction"]))
    return separating, kicks, extent(basins["energy"].values)


def _separations_below(
    critical: xr.DataArray, sweeps: xr.Dataset, within: float
) -> list[tuple[float, ...]]:
    """Return preloads at which a sweep separates below the critical speed.

    Parameters
    ----------
    critical : critical speeds by preload, rad/s
    sweeps : speeds at which separation begins and ends on sweeps, by preload, rad/s; the lowest speed of a sweep
        that separates there
    within : rad/s by which one of them must be lower

    Returns
    -------
    list of tuple
        Preload, speed at which separation begins, speed at which it ends, critical speed.
    """
    begins, turns = xr.align(critical, sweeps, join="inner")
    swept = swept_speeds(turns)
    columns = (begins["N"], swept.onset, swept.end, begins)
    found: list[tuple[float, ...]] = []
    for N, up, down, begin in zip(*(column.values for column in columns), strict=True):
        if begin - np.fmin(up, down) > within:
            found.append((N, up, down, begin))
    return found


def far_below(*cases: CaseView, share: float) -> Answer:
    """Judge whether a case separates below a share of the critical speed of a moving load."""
    critical = moving_load_speed(cases[0].parameters)
    rows = []
    for case in cases:
        part = case["Omega"] / critical
        if part < share and case.separates:
            rows.append((case.place, part))
    here = "" if rows else "No case separates."
    return Answer(bool(rows), here, rows=rows, critical=critical)


def both_at_low_speed(study: xr.Dataset, *, share: float) -> Answer:
    """Judge whether cycles grow and contact is lost at low speeds of a map.

    Parameters
    ----------
    study : the map over speed and preload
    share : of the critical speed of a moving load, below which a speed is low
    """
    study = published(study)
    critical = moving_load_speed(BASE)
    low = study["Omega"] < share * critical
    rate = study["growth_rate"]
    grows = rate > 0
    outcome = study["outcome"]
    separates = outcome.copy(data=flag_names(outcome) == "separation")
    counts = (grows, separates, grows & ~separates, separates & rate.isnull())
    fastest = float(study["Omega"].max())
    return Answer(
        bool((low & grows).any() and (low & separates).any()),
        most=fastest,
        part=fastest / critical,
        counts=[int(each.sum()) for each in counts],
        size=separates.size,
        inferred=int(np.sum(flag_names(study["method"]) == "inferred")),
    )
