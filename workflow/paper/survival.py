"""Model sensitivity: the paper's main conclusions, judged like rows of the ledger under seven models."""

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from disc_model.analysis.classify import FEWEST, motion_of
from disc_model.data.dataset import Missing
from disc_model.data.texts import Section
from disc_model.data.variables import Outcome, flag_names, stated_in
from disc_model.display import counted
from workflow.paper import ledger, measures, section41
from workflow.paper.measures import Cases, CaseView, Found, rate_text, sound
from workflow.paper.model import read_texts, rows_of

CHANGED = ("normalization", "contact_compliance", "contact_force", "friction_offset", "stretching")
"""Parameters by which the models differ; of the second and the fourth, whether they are 0."""
MODELS = {
    "as published": ("as_published", False, "vertical", False, "none"),
    "orthonormal": ("orthonormal", False, "vertical", False, "none"),
    "+ residual flexibility": ("orthonormal", True, "vertical", False, "none"),
    "+ normal contact force": ("orthonormal", True, "normal", False, "none"),
    "+ friction on the surface": ("orthonormal", True, "normal", True, "none"),
    "as published, stretching": ("as_published", False, "vertical", False, "clamped"),
    "orthonormal, stretching": ("orthonormal", False, "vertical", False, "clamped"),
}
"""The models by name: five, each with one more change, and the first two on a plate that stretches."""
SLOW = 1e-3
"""Growth rate in 1/s below which a cycle counts as neither stable nor unstable."""


def by_model(cases: Mapping[str, CaseView]) -> dict[str, dict[str, CaseView]]:
    """Return the cases and grid studies of each model, by name.

    Of the grid studies these are the points that belong to the model.
    """
    models: dict[str, dict[str, CaseView]] = {name: {} for name in MODELS}
    for name, case in cases.items():
        known = case.node.to_dataset().variables if case.is_grid else vars(case.parameters)
        columns = [np.atleast_1d(known[parameter]).tolist() for parameter in CHANGED]
        points = [(n, bool(c), f, bool(o), s) for n, c, f, o, s in zip(*columns, strict=True)]
        for model, values in MODELS.items():
            if points.count(values) == 1:
                models[model][name] = case
                if case.is_grid:
                    study = case.node.to_dataset()
                    along = {study["normalization"].dims[0]: points.index(values)}
                    models[model][name] = CaseView(name, xr.DataTree(study.isel(along)))
    return models


# ---- Separation and cycles


def at_points(points: xr.Dataset, rates: xr.Dataset) -> tuple[Any, Any]:
    """Return at points of preload and speed whether the slider separates, and growth rates, 1/s."""
    outcome = flag_names(sound(points)["outcome"].transpose("N", "Omega"))
    try:
        selected = rates["growth_rate"].sel(N=points["N"], Omega=points["Omega"])
    except KeyError as error:
        raise Missing(f"study survival_growth lacks points of survival_outcome: {error}") from None
    return outcome == "separation", selected.transpose("N", "Omega").values


def separations_by_cycle(
    points: xr.Dataset, rates: xr.Dataset, curves: xr.Dataset, fold_distance: float
) -> Found:
    """Count points that separate by whether their cycle is unstable, not found or stable.

    Parameters
    ----------
    points : outcomes over preload and speed
    rates : growth rates of the cycle at these points
    curves : curves on which cycles become unstable or end
    fold_distance : rad/s below a fold within which a stable cycle may be left: where it ends just
        above a speed, small disturbances suffice for that
    """
    separates, growth = at_points(points, rates)
    stable = growth < -SLOW
    kinds = (separates & (growth > SLOW), separates & np.isnan(growth), separates & stable)
    early = []
    at_fold = True
    for i, j in np.argwhere(kinds[2]):
        load = float(points["N"][i])
        speed = float(points["Omega"][j])
        early.append(measures.place(load, speed))
        above = np.array([*folds_at(curves, load)]) - speed
        at_fold = at_fold and bool(np.any((above >= 0) & (above <= fold_distance)))
    return {
        "at_fold": at_fold,
        "compared": kinds[0].any() and stable.any(),
        "points": (int(separates.sum()), separates.size),
        "kinds": [int(each.sum()) for each in kinds],
        "keep": int((stable & ~separates).sum()),
        "early": early if at_fold else [],
    }


def onset_at_fold(
    curves: xr.Dataset, speed: xr.Dataset, rates: xr.Dataset, load: float, within: float
) -> Found:
    """Compare speeds at which separation begins at a preload with folds of the quiet cycle.

    Parameters
    ----------
    curves : curves on which cycles become unstable or end
    speed : crossings of the lowest speeds with separation, by preload
    rates : growth rates of the cycle over preload and speed
    load : preload, N
    within : rad/s by which a fold may be off

    Returns
    -------
    dict
        ``folds`` and ``highs``, the speeds, rad/s; ``apart``, their distances; where none is small,
        ``growth`` across the speeds, and how many curves, of which one may be the fold, were ``missed``.
    """
    folds = np.array(sorted(folds_at(curves, load)))
    crossings = sound(speed.sel(N=load).isel(horizon=0))
    highs = crossings["crossing"].values[flag_names(crossings["crossing_kind"]) == "begins"]
    # a crossing lies between its speed and one step of the bisection below it
    width = float(stated_in(speed, "options")["precision"])
    outside = [np.maximum(high - width - folds, folds - high) for high in highs]
    found: Found = {"folds": folds, "highs": highs, "growth": [], "missed": 0}
    found["apart"] = [np.min(each, initial=math.inf) for each in outside]
    if not found["apart"] or min(found["apart"]) <= within:
        return found

    # growth at the map's nearest speeds below and above each interval; nan without a cycle
    at_load = rates["growth_rate"].sel(N=load)
    try:
        before = at_load.sel(Omega=highs - width, method="pad").values.tolist()
        after = at_load.sel(Omega=highs, method="backfill").values.tolist()
    except KeyError:
        raise Missing("study survival_growth does not reach as far as survival_speed") from None
    if not np.all(np.array([before, after]) > SLOW):
        found["missed"] = int(curves["n_continuation_failures"])
    texts = [[rate_text(rate, "/s") for rate in each] for each in zip(before, after, strict=True)]
    return {**found, "growth": [" to ".join(each) for each in texts]}


def folds_at(curves: xr.Dataset, load: float) -> Iterator[float]:
    """Yield speeds at which folds with a stable cycle beside them cross a preload, rad/s."""
    for i in np.flatnonzero(flag_names(sound(curves)["kind"]) == "fold"):
        curve = curves.isel(curve=int(i))
        x = curve["x"].values
        above = curve["y"].values - load
        ends_stable_cycle = flag_names(curve["adjoins_stable_cycle"]) == "yes"
        crosses = (above[:-1] * above[1:] <= 0) & (above[:-1] != above[1:])
        crosses &= ends_stable_cycle[:-1] & ends_stable_cycle[1:]
        for j in np.flatnonzero(crosses):
            share = -above[j] / (above[j + 1] - above[j])
            yield float(x[j] + share * (x[j + 1] - x[j]))


def separating(cases: Cases) -> list[CaseView]:
    """Return cases that lose contact.

    Raises `Missing` if there is none, or if a case did not reach its end. Bilateral contact may end
    in Painlevé's paradox, when the disc has become so steep.
    """
    for case in cases:
        if case.status != "ok" and not (case.bilateral and case.status == "paradox"):
            raise Missing(f"{case.status} (case {case.name})")
    found = [case for case in cases if not case.bilateral and case.separates]
    if not found:
        raise Missing("No case separates")
    return found


def first_lowest_speeds(speed: xr.Dataset, depth: float) -> Found:
    """Return the verdict of `section41.lowest_speeds`, in words, and from how many speeds."""
    study = sound(speed.isel(horizon=0))
    verdict, words = section41.lowest_speeds(study, depth)
    known = np.isfinite(study["critical_speed"].values).sum()
    return {"found": verdict, "words": words, "known": known}


# ---- Motion after a separation


def late_widths(cases: Cases, wider: float) -> Found:
    """Compare the disc's late range with separation with that without it.

    Parameters
    ----------
    cases : with separation and without it, which form pairs
    wider : share by which a range that has settled may grow from the third quarter of the time
        after the first separation to the last

    Returns
    -------
    dict
        Whether it is ``smaller``, None where it has not settled, ``rows`` of both ranges, and where
        and when bilateral contact becomes too ``steep``.
    """
    found: dict[str, list[Any]] = {"smaller": [], "rows": [], "steep": []}
    bilateral_cases = [case for case in cases if case.bilateral]
    for case, bilateral in measures.pairs([*separating(cases), *bilateral_cases]):
        fourth, third = case.quarters
        # up to a paradox, only the last stretch of bilateral contact is compared
        stretches = measures.STRETCHES
        if bilateral.status == "paradox":
            stretches = 1
            found["steep"].append(f"{case.place} after {bilateral['time_reached']:.0f} s")
        other = bilateral.last_widths("w_point", measures.STRETCH, stretches)
        # an irregular motion has a wider range over a longer time, so that equal times count as well
        alike = case.last_widths("w_point", measures.STRETCH, measures.STRETCHES)
        smaller = None
        if min(third, fourth, *alike) >= max(other):
            smaller = False
        elif fourth <= (1 + wider) * third and max(third, fourth) < min(other):
            smaller = True
        found["smaller"].append(smaller)
        found["rows"].append((case.place, max(third, fourth), min(other)))
    return found


def repetitions(cases: Cases) -> list[tuple[str, bool | None, str]]:
    """Return of cases that separate their place, whether they repeat, None if that is open, and when.

    That is judged by the intervals between releases, or else separations.
    """
    rows = []
    for case in separating(cases):
        row: tuple[str, bool | None, str] = (case.place, None, "switches too rarely to be judged")
        for kind, name in (("separation", "separation"), ("stick_to_slip", "release")):
            intervals = np.diff(case.times_of(kind))
            if intervals.size >= 2 * FEWEST:
                motion = motion_of(intervals)
                length = float(intervals[: motion.period].sum())
                remark = f" ({length:.4g} s)" if motion.period else f", judged by its {name}s"
                repeats = motion.kind not in (Outcome.QUASI_PERIODIC, Outcome.IRREGULAR)
                known = None if motion.kind is Outcome.UNDECIDED else repeats
                row = (case.place, known, measures.repeats(motion, name) + remark)
        rows.append(row)
    return rows


# ---- Damping


def damped(study: xr.Dataset, name: str) -> tuple[Any, Any, Any]:
    """Return growth rates without a damper and with one alone, 1/s, and how the latter came out.

    Parameters
    ----------
    study : over preload and speed, with and without the dampers ``c`` and ``c_p``
    name : of the damper
    """
    (along,) = study["c"].dims
    on = list(zip(study["c"].values != 0, study["c_p"].values != 0, strict=True))
    wanted = [(False, False), (name == "c", name == "c_p")]
    if any(on.count(pair) != 1 for pair in wanted):
        raise Missing(f"study survival_damping lacks a pair of points without and with {name}")
    ordered = study.transpose("N", "Omega", ...)
    without, alone = (ordered.isel({along: on.index(pair)}) for pair in wanted)
    return without["growth_rate"].values, alone["growth_rate"].values, flag_names(alone["status"])


def normal_damping(study: xr.Dataset) -> dict[str, int]:
    """Count growing cycles that are ``compared``, ``lowered`` and made ``stable`` by damping."""
    without, alone, _ = damped(study, "c")
    compared = (without > SLOW) & np.isfinite(alone)
    counts = {"compared": compared, "lowered": compared & (alone < without)}
    counts["stable"] = compared & (alone < 0)
    return {name: int(points.sum()) for name, points in counts.items()}


def inplane_damping(study: xr.Dataset, large: float) -> Found:
    """Count cycles that in-plane damping makes grow faster, or ends.

    Parameters
    ----------
    study : growth rates over preload and speed, with and without dampers
    large : preload from which on it is judged, N

    Returns
    -------
    dict
        Numbers with ``higher`` growth and of all, at large preloads and at others; how many stable
        cycles are ``ended`` at large ones, also in ``words``.
    """
    without, alone, status = damped(study, "c_p")
    heavy = (study["N"].values >= large)[:, None]
    both = np.isfinite(without) & np.isfinite(alone)
    higher = both & (alone > 0) & (alone > without + SLOW)
    vanished = (without < -SLOW) & np.isin(status, ("no_cycle", "separates"))
    ended = int((vanished & heavy).sum())
    counts = [int((points & at).sum()) for at in (heavy, ~heavy) for points in (higher, both)]
    return {"higher": counts, "ended": ended, "words": counted(ended, "stable cycle")}


# ---- Judging, and pages

CONCLUSIONS = rows_of("survival.yaml")
TEXTS: dict[str, str] = read_texts("pages.yaml")["survival"]
FUNCTIONS = {**ledger.FUNCTIONS, **{name: each for name, each in vars().items() if callable(each)}}


def judged(cases: Mapping[str, CaseView]) -> pd.DataFrame:
    """Return a row for each conclusion and model: ``id``, ``model``, ``verdict``, ``here``, ``notes``."""
    rows = []
    for model, known in by_model(cases).items():
        for row in CONCLUSIONS:
            answer = row.judge(known, {}, FUNCTIONS)
            rows.append({"id": row.id, "model": model, **answer._asdict()})
    return pd.DataFrame(rows)


def pages_of(table: pd.DataFrame) -> list[Section]:
    """Return verdicts of a table of `judged` at a glance, then a section for every conclusion."""
    verdicts = table.pivot(index="id", columns="model", values="verdict")[[*MODELS]]
    verdicts.columns = [name[0].upper() + name[1:] for name in MODELS]
    ids = [row.id for row in CONCLUSIONS]
    page = verdicts.loc[ids].reset_index(drop=True)
    page.insert(0, "Conclusion", [row.statement for row in CONCLUSIONS])
    page["True if"] = [row.rule for row in CONCLUSIONS]
    heads = {"model": "Model", "verdict": "Verdict", "here": "Found", "notes": "Remark"}
    sections = [("", TEXTS["introduction"], page)]
    for row in CONCLUSIONS:
        part = table[table["id"] == row.id].rename(columns=heads)[[*heads.values()]]
        sections.append((row.id, f"{row.statement} True if {row.rule}.", part))
    return sections
