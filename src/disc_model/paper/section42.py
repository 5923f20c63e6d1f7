"""Rows on Section 4.2: 385 N around the critical speed, and the critical speed in general."""

import numpy as np
import xarray as xr

from disc_model.data.dataset import Missing
from disc_model.data.variables import flag_names
from disc_model.paper import measures
from disc_model.paper.measures import CaseView, listed, mm, published
from disc_model.paper.model import FALSE, PART, TRUE, Answer
from disc_model.paper.section2 import moving_load_speed

PHYSICAL = ("a", "b", "r_0", "h", "E", "nu", "rho", "D_star", "mu_s", "mu_k", "k", "k_p", "m", "N")
"""Parameters that are changed by 0.1 %, one at a time."""


def quiet(case: CaseView, *, share: float, newtons: float) -> Answer:
    early, late = case.early, case.late
    return Answer(
        not case.separates and max(early.width, late.width) < share * case["N"] and late.width <= early.width + newtons,
        f"{case.first_separation().capitalize()}. The contact force stays within {early:.2f} N at first and "
        f"{late:.2f} N in the end, the disc within {mm(case.disc.width)}. {case.growth.capitalize()}.",
    )


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
    early, none = (", ".join(names) or "none" for names in lost)
    return Answer(
        not below.separates and above.separates,
        "; ".join(f"{case.place}: {case.first_separation()}, {case.growth}" for case in (below, above)) + ".",
        "This holds for the paper's very values. With one parameter 0.1 % larger, contact is lost at "
        f"{below['Omega']:g} rad/s ({early}), or is not lost within {until:g} s at {above['Omega']:g} rad/s ({none}).",
    )


def falls_then_rises(study: xr.Dataset, *, depth: float) -> Answer:
    """Whether the lowest speed with separation has one minimum between higher ones, at every horizon."""
    study = _scanned(study)
    lowest = [measures.lowest_speeds(study.sel(horizon=horizon), depth) for horizon in study["horizon"]]
    falls, last = all(each.falls for each in lowest), lowest[-1]
    again = f"Up to {last.top:g} N it does. At larger preloads it falls again, to {', '.join(last.again)}."
    return Answer(
        PART if falls and last.again else falls,
        f"Lowest speed with separation within {float(study['horizon'][-1]):g} s, where it turns: "
        f"{'; '.join(last.speeds)} rad/s.",
        again if last.again else "",
    )


def maintained_below(
    study: xr.Dataset, sweeps: xr.Dataset | None, basins: xr.Dataset | None, *, within: float
) -> Answer:
    """Whether contact is kept below the critical speed of the static start by other starts as well."""
    critical = _scanned(study)["critical_speed"].isel(horizon=-1)
    if not np.isfinite(critical).any():
        return Answer(FALSE, "No separation at any preload and speed.")
    begins = measures.extent(critical.values[np.isfinite(critical)])
    below: list[str] = []
    if sweeps is not None:
        starts, ends = xr.align(critical, published(sweeps)["offset_speed"], join="inner")
        rows = zip(starts["N"].values, starts.values, ends.values, strict=True)
        below = [f"{N:g} N: to {end:g} instead of {begin:.1f} rad/s" for N, begin, end in rows if begin - end > within]
    kicked = ""
    if basins is not None:
        total = basins.sizes["energy"] * basins.sizes["start"]
        if apart := round(total * float(published(basins)["separating_fraction"].sel(Omega=15.0))):
            kicked = f"At 385 N, 15 rad/s, {apart} of {total} random perturbations lead to repeated separation."
    refuted = bool(below or kicked)
    return Answer(
        PART if refuted else TRUE,
        f"From rest it is so by definition: separation begins at {begins:.1f} rad/s, depending on the preload. "
        + (f"When the speed is lowered, separation lasts longer. {'; '.join(below)}." if below else ""),
        kicked,
    )


def far_below(*cases: CaseView, share: float) -> Answer:
    critical = moving_load_speed(cases[0].parameters)
    lower = [case for case in cases if case["Omega"] < share * critical and case.separates]
    speeds = [case["Omega"] for case in lower]
    shares = [100 * speed / critical for speed in speeds]
    text = (
        f"Contact is lost at {listed(speeds, 'g')} rad/s. These are {listed(shares, '.1f')} % of {critical:.2f} rad/s."
    )
    return Answer(bool(lower), text if lower else "No separation.")


def unstable_means_separation(study: xr.Dataset, scan: xr.Dataset) -> Answer:
    """Whether all points of the map with a growing cycle separate within its horizon."""
    study = published(study)
    unstable, apart = study["growth_rate"].values > 0, flag_names(study["outcome"]) == "separation"
    stays, stable = int((unstable & ~apart).sum()), int((apart & (study["growth_rate"].values < 0)).sum())
    kinds = _scanned(scan).isel(horizon=-1)["crossing_kind"]
    again = int((flag_names(kinds) == "ends").any(axis=kinds.get_axis_num("crossing_number")).sum())
    return Answer(
        PART if stays and stays < unstable.sum() else not stays,
        f"Of {unstable.sum()} combinations of speed and preload with a growing cycle, {stays} do not separate within "
        f"{measures.facts(study)['horizon']:g} s; {stable} separate with a stable one.",
        f"At {again} of {kinds.sizes['N']} preloads, contact is kept again above the critical speed." if again else "",
    )


def _scanned(study: xr.Dataset) -> xr.Dataset:
    """The scan with the published modes; raises `Missing` if a point failed."""
    study = published(study)
    if np.any(flag_names(study["status"]) != "ok"):
        raise Missing("study critical_speed has points that failed")
    return study
