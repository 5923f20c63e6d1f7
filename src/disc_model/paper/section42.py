"""Claims of Section 4.2: N = 385 N around the critical speed, and the critical speed in general."""

from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.dataset import Missing
from disc_model.data.variables import flag_names
from disc_model.paper import measures
from disc_model.paper.disc import moving_load_speed
from disc_model.paper.measures import Absent, CaseView, Range
from disc_model.paper.model import Answer


def quiet(case: CaseView, *, part: float, newtons: float) -> Answer:
    early, late = case.early.width, case.late.width
    return Answer(not case.separates and max(early, late) < part * case["N"] and late <= early + newtons)


def when_it_separates(case: CaseView, *, printed: float, digit: float, within: float) -> Answer:
    return Answer(abs(case["first_separation"] - printed) <= digit / 2 + within)


def only_one_separates(*cases: CaseView, which: float) -> Answer:
    return Answer([case.separates for case in cases] == [i + 1 == which for i in range(len(cases))])


def disc_does_not_grow(case: CaseView, *, part: float) -> Answer:
    early = case.range_of("w_point", *measures.EARLY)
    return Answer(case.disc.width <= (1 + part) * early.width, early=early)


def larger_range(below: CaseView, above: CaseView, *, factor: float) -> Answer:
    return Answer(factor * below.disc.width < above.disc.width)


def later_periodic(case: CaseView, bonded: CaseView, *, closes: float) -> Answer:
    periodic, too = (each.late_motion(closes).period > 0 for each in (case, bonded))
    return Answer(periodic, too=too)


def falls_then_rises(study: xr.Dataset, *, depth: float) -> Answer:
    """Whether the lowest speed with separation has one minimum between higher ones, at every horizon."""
    study = _scanned(study)
    found = [measures.lowest_speeds(study.sel(horizon=horizon), depth) for horizon in study["horizon"]]
    holds, values = all(falls for falls, _ in found), found[-1][1]
    again = holds and values["again"]
    scan, horizon = study["scan_Omega"].values, float(study["horizon"][-1])
    return Answer(None if again else holds, "again", step=scan[1] - scan[0], horizon=horizon, **values)


def wider_force_range(below: CaseView, above: CaseView, *, factor: float) -> Answer:
    rows = [{"case": case, "motion": case.late_motion()} for case in (below, above)]
    return Answer(factor * below.late.width < above.late.width, motions=rows)


def can_separate_above(study: xr.Dataset, sweeps: xr.Dataset | None, *, within: float) -> Answer:
    """Whether there is a speed above which contact is lost somewhere.

    Remarks: windows wider than ``within`` in which contact is kept again, and sweeps that still separate so far below.
    """
    study = _scanned(study).isel(horizon=-1)
    rows: list[dict[str, Any]] = []
    top = float(study["scan_Omega"][-1])
    for N in study["N"].values:
        kinds, speeds = (study.sel(N=N)[name] for name in ("crossing_kind", "crossing"))
        ends = np.flatnonzero(flag_names(kinds) == "ends")
        # without a next crossing contact is kept up to the end of the scan
        edges = [*speeds.values[np.isfinite(speeds)], top]
        windows = [Range(*edges[i : i + 2]) for i in ends if edges[i + 1] - edges[i] > within]
        rows += [{"N": N, "windows": windows}] if windows else []
    lowest = study["critical_speed"].values
    found = np.isfinite(lowest)
    if not found.any():
        raise Absent("no separation at any preload and speed")
    begins, horizon = measures.extent(lowest[found]), float(study["horizon"])
    below = [] if sweeps is None else _lasts_below(study["critical_speed"], sweeps, within)
    counts = {"some": found.sum(), "count": found.size}
    return Answer(True, loads=rows, begins=begins, horizon=horizon, top=top, below=below, **counts)


def _lasts_below(critical: xr.DataArray, sweeps: xr.Dataset, within: float) -> list[dict[str, float]]:
    """Preloads at which separation in a sweep down ends further than ``within`` below the critical speed."""
    ends = sweeps["offset_speed"].sel(normalization="as_published")
    begins, lasts = xr.align(critical, ends, join="inner")
    pairs = zip(begins["N"].values, begins.values, lasts.values, strict=True)
    return [{"N": N, "lasts": end, "begins": begin} for N, begin, end in pairs if begin - end > within]


def _scanned(study: xr.Dataset) -> xr.Dataset:
    """The scan with the published modes; raises `Missing` if a point failed."""
    study = study.sel(normalization="as_published")
    if np.any(flag_names(study["status"]) != "ok"):
        raise Missing("study critical_speed has points that failed")
    return study


def far_below(*cases: CaseView, share: float) -> Answer:
    critical = moving_load_speed(cases[0].parameters)
    lower = [case for case in cases if case["Omega"] < share * critical]
    rows = [{"case": case, "part": case["Omega"] / critical} for case in lower]
    return Answer(any(case.separates for case in lower), lower=rows, critical=critical)
