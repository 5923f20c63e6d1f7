"""Measures for rows on Sections 4.1 and 4.2.

Separation occurs, ignoring it changes the motion, and the critical speed for separation.
"""

from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from scipy.signal import find_peaks

from disc_model.analysis import classify, spectra
from disc_model.data.dataset import Missing
from disc_model.data.texts import fill
from disc_model.data.variables import UNKNOWN_OUTCOMES, flag_names
from disc_model.studies.quantities.hysteresis import swept_speeds
from workflow.paper import energy, judging_tables, measures
from workflow.paper.measures import (
    Absent,
    Cases,
    CaseView,
    Found,
    extent,
    or_none,
    pairs,
    published,
)
from workflow.paper.model import FALSE, PART, TRUE, read_texts
from workflow.paper.section2 import BASE, moving_load_speed


def push_of_spring(case: CaseView) -> float:
    """Return the mean force by which the spring pushes the separated slider back, N."""
    window = case.samples("zoom")
    separated = window["phase"].values == measures.SEPARATION
    if not separated.any():
        raise Missing(f"no separation in the window of case {case.name}")
    height = window["u"].values[separated] - case["u_0"]
    return case["k"] * float(np.mean(height))


def sticks_in_settled(study: xr.Dataset) -> Found:
    """Return the ``extent`` of shares of stick over the ``settled`` motions of a study of a ``size``."""
    settled = flag_names(study["settled"]) == "settled"
    shares = study["stick_fraction"].transpose(*study["settled"].dims).values
    least = np.min(shares[settled], initial=np.inf)
    most = np.max(shares[settled], initial=0.0)
    return {
        "size": settled.size,
        "settled": settled.sum(),
        "least": least,
        "extent": (100 * least, 100 * most),
    }


def line_counts(cases: Cases, floor: float) -> Found:
    """Count lines in the disc's late spectrum with separation and without it.

    Parameters
    ----------
    cases : which form pairs; there is one of ``rows`` for those from rest
    floor : amplitude over the strongest from which a line counts
    """
    rows: list[tuple[Any, ...]] = []
    for pair in pairs(cases):
        late = [case.samples("late") for case in pair]
        if pair[0].from_rest:
            counts = [
                len(
                    spectra.lines(each["time"].values, each["w_point"].values, above=1, floor=floor)
                )
                for each in late
            ]
            rows.append((pair[0].place, *counts))
    return {"rows": rows, "more": [with_it > without for _, with_it, without in rows]}


def between_separations(case: CaseView) -> tuple[str, float]:
    """Return when a motion repeats, by the intervals between separations, in words and in s."""
    intervals = case.intervals("separation")
    motion = classify.motion_of(intervals)
    return measures.repeats(motion, "separation"), float(intervals[: motion.period].sum())


def supplied_energies(cases: Cases, energies: pd.DataFrame) -> Found:
    """Measure which energy separation withholds of what maintained contact supplies.

    Parameters
    ----------
    cases : with separation and without it, which form pairs
    energies : of these pairs, as `judging_tables.energies`

    Returns
    -------
    dict
        ``rows`` of energies in a period, what is ``withheld`` over what the motion in maintained
        contact gains, powers ``by_sign`` of the force there, and how much ``less`` a compliant
        contact supplies, at least and at most.
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
        supplied, maintained, _, _, gained = in_period.tolist()
        surplus = f"the surplus of {bilateral.name}"
        withheld.append(measures.ratio(maintained - supplied, gained, surplus))
        rows.append((free.place, *in_period.tolist()))
        by_sign.append((free.place, *found[judging_tables.POWERS]))
        less += (
            1 - np.asarray(found[judging_tables.COMPLIANT[1:]], dtype=float) / supplied
        ).tolist()
    return {
        "rows": rows,
        "withheld": withheld,
        "by_sign": by_sign,
        "less": extent(less),
        "instant": energy.INSTANT,
        "near": energy.NEAR,
        "stretch": energy.STRETCH,
        "stretches": energy.STRETCHES,
    }


# ---- Section 4.2: 385 N around the critical speed, and the critical speed in general


def changed_by(small_changes: pd.DataFrame, case: CaseView) -> list[str]:
    """Return the parameters a thousandth of which changes whether a case separates."""
    of_case = small_changes[small_changes["case"] == case.name]
    separates = of_case["first_s"].notna()
    return list(of_case["parameter"][separates != case.separates])


def lowest_speeds_in_time(study: xr.Dataset, depth: float) -> Found:
    """Measure how the lowest speed with separation changes with the preload, at each horizon.

    Parameters
    ----------
    study : lowest speeds by preload and horizon
    depth : rad/s, from which a change counts

    Returns
    -------
    dict
        Verdicts of `lowest_speeds` for all horizons, and ``words`` for the last one.
    """
    study = measures.sound(published(study))
    found = [lowest_speeds(study.sel(horizon=horizon), depth) for horizon in study["horizon"]]
    speeds = study["scan_Omega"].values
    return {
        "verdicts": [verdict for verdict, _ in found],
        "words": found[-1][1],
        "longest": float(study["horizon"][-1]),
        "fastest": speeds[-1],
        "step": speeds[1] - speeds[0],
    }


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
    top = lowest + np.nanargmax(speeds[lowest : later[0] if later else None])
    again = top
    larger: list[int] = []
    if later:
        again, *larger = top + 1 + np.flatnonzero(separates[top + 1 :])
    turns = {"start": int(separates.argmax()), "lowest": lowest, "top": top, "again": again}
    words = fill(
        read_texts("pages.yaml")["lowest_speeds"],
        never=loads[:lowest][~separates[:lowest]],
        later=later,
        last=loads[-1],
        beyond=larger and extent(speeds[larger]),
        **{name: (speeds[i], loads[i]) for name, i in turns.items()},
    )
    return PART if later else TRUE, words


def separations_below(
    study: xr.Dataset, sweeps: xr.Dataset | None, basins: xr.Dataset | None, within: float
) -> Found:
    """Find separations below the critical speed for separation.

    Parameters
    ----------
    study : critical speeds by preload and horizon
    sweeps : of the speed up and down, by preload, if there are any
    basins : basins of attraction at 385 N, if there are any
    within : rad/s by which separation must come below the critical speed to count

    Returns
    -------
    dict
        ``below``: preloads with the speeds at which separation begins and ends on sweeps, and the
        critical speed; ``swept``: facts of the sweeps; ``kicks``: how many of how many random kicks at
        15 rad/s separate, and their energies.
    """
    critical = measures.sound(published(study))["critical_speed"].isel(horizon=-1)
    found: Found = {"known": critical.notnull().any(), "below": [], "swept": {}}
    if sweeps is not None:
        begins, turns = xr.align(critical, published(sweeps), join="inner")
        swept = swept_speeds(turns)
        columns = (begins["N"], *swept, begins)
        for row in zip(*(column.values for column in columns), strict=True):
            _, up, down, begin = row
            if begin - np.fmin(up, down) > within:
                found["below"].append(row)
        found["swept"] = measures.facts(sweeps)
    found["kicks"] = (0,) if basins is None else _separating_kicks(basins)
    return found


def _separating_kicks(basins: xr.Dataset) -> tuple[int, int, Any]:
    """Return how many kicks at 15 rad/s are known to lead to lasting separation, how many there
    are, and the least and the greatest of their energies (J)."""
    kicks = basins.sizes["energy"] * basins.sizes["start"]
    study = published(basins).sel(Omega=15.0)
    known = float(np.mean(~np.isin(flag_names(study["kind"]), UNKNOWN_OUTCOMES)))
    separating = round(kicks * known * float(study["separating_fraction"])) if known else 0
    return separating, kicks, extent(basins["energy"].values)


def slow_separations(cases: Cases, share: float) -> list[tuple[str, float]]:
    """Return cases that separate below a share of the critical speed of a moving load.

    There is a row for each, of its place and its speed over that critical speed.
    """
    critical = moving_load_speed(cases[0].parameters)
    rows = [(case.place, case["Omega"] / critical) for case in cases if case.separates]
    return [(place, part) for place, part in rows if part < share]


def slow_growth_and_separation(study: xr.Dataset, share: float) -> Found:
    """Count growing cycles and separations on a map over speed and preload, and at low speeds.

    Parameters
    ----------
    study : the map
    share : of the critical speed of a moving load, below which a speed is low
    """
    study = published(study)
    critical = moving_load_speed(BASE)
    rate = study["growth_rate"]
    grows = rate > 0
    separates = study["outcome"].copy(data=flag_names(study["outcome"]) == "separation")
    low = study["Omega"] < share * critical
    counts = (grows, separates, grows & ~separates, separates & rate.isnull())
    fastest = float(study["Omega"].max())
    return {
        "slow": [int((low & each).sum()) for each in (grows, separates)],
        "counts": [int(each.sum()) for each in counts],
        "most": fastest,
        "part": fastest / critical,
        "size": separates.size,
    }
