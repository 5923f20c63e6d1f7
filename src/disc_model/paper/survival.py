"""Model sensitivity: the paper's main conclusions, each judged under four models of disc and contact.

Each model changes one more thing, so that the last has all changes. All conclusions are judged from the merged cases
and grids of config/survival.yaml: undecided if the evidence does not decide, not computed if it is missing.
"""

import math
import sys
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray

from disc_model.analysis.classify import FEWEST, stick_disappears
from disc_model.data.dataset import Missing
from disc_model.data.texts import Section, fill
from disc_model.data.variables import Outcome, flag_names, stated_in
from disc_model.paper import measures, section42
from disc_model.paper.measures import STRETCH, STRETCHES, Array, CaseView, rate_text
from disc_model.paper.model import Answer, claims, judge, read_texts

MODELS = {
    "as published": ("as_published", False, "vertical"),
    "orthonormal": ("orthonormal", False, "vertical"),
    "+ residual flexibility": ("orthonormal", True, "vertical"),
    "+ normal contact force": ("orthonormal", True, "normal"),
}
"""The models by name: normalization, whether the contact has a flexibility, contact_force."""


def by_model(cases: Mapping[str, CaseView]) -> dict[str, dict[str, CaseView]]:
    """The cases and grid studies of each model; of the grid studies the points that belong to it."""
    models: dict[str, dict[str, CaseView]] = {name: {} for name in MODELS}
    for name, case in cases.items():
        study = case.node.to_dataset()
        if case.is_grid:
            (dim,) = study["normalization"].dims
            varied: list[Any] = [
                study[name].values for name in ("normalization", "contact_compliance", "contact_force")
            ]
        else:
            p = case.parameters
            varied = [[p.normalization], [p.contact_compliance], [p.contact_force]]
        points = [(normalization, give != 0, force) for normalization, give, force in zip(*varied, strict=True)]
        for model, values in MODELS.items():
            if case.is_grid and points.count(values) == 1:
                models[model][name] = CaseView(name, xr.DataTree(study.isel({dim: points.index(values)})))
            elif points == [values]:
                models[model][name] = case
    return models


SLOW = 1e-3
"""Growth rate below which a cycle counts as neither stable nor unstable, 1/s."""


def onset(points: xr.Dataset, rates: xr.Dataset, curves: xr.Dataset, *, beside: float) -> Answer:
    outcome, growth = _beside(points, rates)
    if (outcome == "failed").any():
        raise Missing("study survival_outcome has points that failed")
    apart = outcome == "separation"
    cycles = {"stable": growth < -SLOW, "unstable": growth > SLOW, "without": np.isnan(growth)}
    counts = {kind: int((apart & where).sum()) for kind, where in cycles.items()}
    stable = cycles["stable"]
    early = [(float(points["N"][i]), float(points["Omega"][j])) for i, j in np.argwhere(apart & stable)]
    # where a stable cycle ends at a fold just above a speed, small disturbances suffice to leave it
    soon = all(any(0 <= fold - speed <= beside for fold in _folds_at(curves, load)) for load, speed in early)
    compared = counts["unstable"] > 0 and bool(stable.any())
    return Answer(
        soon if compared or not soon else None,
        "nothing",
        apart=int(apart.sum()),
        count=apart.size,
        quiet=int((stable & ~apart).sum()),
        early=[measures.place(*at) for at in early] if soon else [],
        **counts,
    )


def _beside(outcome: xr.Dataset, growth: xr.Dataset) -> tuple[NDArray[np.str_], Array]:
    """Outcomes, and growth rates at the same points, 1/s: both (N, Omega)."""
    try:
        rates = growth["growth_rate"].sel(N=outcome["N"], Omega=outcome["Omega"])
    except KeyError as error:
        raise Missing(f"study survival_growth lacks points of survival_outcome: {error}") from None
    return flag_names(outcome["outcome"].transpose("N", "Omega")), rates.transpose("N", "Omega").values


def fold(curves: xr.Dataset, speed: xr.Dataset, rates: xr.Dataset, *, load: float, within: float) -> Answer:
    folds = np.array(sorted(_folds_at(curves, load)))
    highs, width = _beginnings(speed, load)
    speeds = {"folds": folds, "begins": highs}
    if not highs.size:
        return Answer(None, "no_speed", growth=[], **speeds)
    off = [np.min(np.maximum(high - width - folds, folds - high), initial=math.inf) for high in highs]
    if min(off) <= within:
        return Answer(True, growth=[], **speeds)
    # at the map's nearest speeds below and above each interval; nan without a cycle
    at_load = rates["growth_rate"].sel(N=load)
    try:
        beside = [
            (float(at_load.sel(Omega=high - width, method="pad")), float(at_load.sel(Omega=high, method="backfill")))
            for high in highs
        ]
    except KeyError:
        raise Missing("study survival_growth does not reach as far as survival_speed") from None
    growth = [f"{rate_text(low, '/s')} to {rate_text(high, '/s')}" for low, high in beside]
    missed = int(curves["n_continuation_failures"])
    goes_on = all(rate > SLOW for pair in beside for rate in pair)
    return Answer(None if missed and not goes_on else False, "missed", missed=missed, growth=growth, **speeds)


def _folds_at(curves: xr.Dataset, load: float) -> Iterator[float]:
    """Speeds at which folds with a stable cycle beside them cross a preload, rad/s."""
    _require_ok(curves, "survival_curves")
    for i in np.flatnonzero(flag_names(curves["kind"]) == "fold"):
        one = curves.isel(curve=int(i))
        x, y = one["x"].values, one["y"].values
        border = flag_names(one["adjoins_stable_cycle"]) == "yes"
        crosses = ((y[:-1] - load) * (y[1:] - load) <= 0) & (y[:-1] != y[1:])
        for j in np.flatnonzero(crosses & border[:-1] & border[1:]):
            yield float(x[j] + (load - y[j]) / (y[j + 1] - y[j]) * (x[j + 1] - x[j]))


def _beginnings(speed: xr.Dataset, load: float) -> tuple[Array, float]:
    """Upper ends of the intervals of speed in which separation begins, and their width, rad/s."""
    one = speed.sel(N=load).isel(horizon=0)
    _require_ok(one, "survival_speed")
    begins = flag_names(one["crossing_kind"]) == "begins"
    return one["crossing"].values[begins], float(stated_in(speed, "options")["precision"])


def _require_ok(grid: xr.Dataset, name: str) -> None:
    if not np.all(flag_names(grid["status"]) == "ok"):
        raise Missing(f"study {name} has points that failed")


def below_critical(*cases: CaseView, share: float) -> Answer:
    apart = _separating(cases)
    return section42.far_below(*apart, share=share) if apart else Answer(None, "none", lower=[], critical=math.nan)


def _separating(cases: Sequence[CaseView]) -> list[CaseView]:
    """Cases that lose contact; raises `Missing` if one did not reach its end."""
    for case in cases:
        if case.status != "ok":
            raise Missing(f"{case.status} (case {case.name})")
    return [case for case in cases if not case.bonded and case.separates]


def falls_then_rises(speed: xr.Dataset, *, depth: float) -> Answer:
    study = speed.isel(horizon=0)
    _require_ok(study, "survival_speed")
    falls, values = measures.lowest_speeds(study, depth)
    few = np.isfinite(study["critical_speed"].values).sum() < 3
    return Answer(None if few or values["again"] else falls, "few" if few else "again", **values)


def smaller_vibration(*cases: CaseView, wider: float) -> Answer:
    smaller: list[bool | None] = []
    rows = []
    for free, bonded in measures.pairs([*_separating(cases), *(case for case in cases if case.bonded)]):
        fourth, third = free.last_quarters("w_point")
        other = bonded.last_widths("w_point", STRETCH, STRETCHES)
        settled = fourth <= (1 + wider) * third
        below = settled and max(third, fourth) < min(other)
        above = min(third, fourth) >= max(other)
        smaller.append(False if above else True if below else None)
        rows.append({"case": free, "free": 1e3 * max(third, fourth), "bonded": 1e3 * min(other)})
    return Answer(*_all_cases(smaller), cases=rows)


def stick_vanishes(*cases: CaseView, share: float) -> Answer:
    apart = _separating(cases)
    stays = [case.place for case in apart if not stick_disappears(case.stick_in_all, case.stick, share)]
    return Answer(len(stays) < len(apart) if apart else None, "none", cases=apart, stays=stays)


def normal_damping(study: xr.Dataset) -> Answer:
    without, with_damper, _ = _damped(study, "c")
    compared = (without > SLOW) & np.isfinite(with_damper)
    lower, stable = compared & (with_damper < without), compared & (with_damper < 0)
    lowered, count = int(lower.sum()), int(compared.sum())
    return Answer(lowered == count if count else None, "none", lower=lowered, count=count, stable=int(stable.sum()))


def inplane_damping(study: xr.Dataset, *, large: float, fewest: float) -> Answer:
    without, damped, status = _damped(study, "c_p")
    heavy = (study["N"].values >= large)[:, None]
    both = np.isfinite(without) & np.isfinite(damped)
    higher = both & (damped > 0) & (damped > without + SLOW)
    ended = int(((without < -SLOW) & np.isin(status, ("no_cycle", "separates")) & heavy).sum())
    above, below = ({"higher": int((higher & at).sum()), "of": int((both & at).sum())} for at in (heavy, ~heavy))
    destabilises = above["higher"] + ended > 0
    return Answer(
        destabilises if destabilises or above["of"] >= fewest else None,
        "few",
        above=above,
        ended=measures.counted(ended, "stable cycle"),
        below=below,
        few=0 < 10 * (above["higher"] + ended) <= above["of"],
    )


def _damped(study: xr.Dataset, name: str) -> tuple[Array, Array, NDArray[np.str_]]:
    """Growth rates without and with one damper, 1/s, and the result with it: each (N, Omega)."""
    (dim,) = study["c"].dims
    on = list(zip(study["c"].values != 0, study["c_p"].values != 0, strict=True))
    wanted = [(False, False), (name == "c", name == "c_p")]
    if any(on.count(pair) != 1 for pair in wanted):
        raise Missing(f"study survival_damping lacks a pair of points without and with {name}")
    one, two = (study.isel({dim: on.index(pair)}).transpose("N", "Omega", ...) for pair in wanted)
    return one["growth_rate"].values, two["growth_rate"].values, flag_names(two["status"])


def not_periodic(*cases: CaseView) -> Answer:
    apart = _separating(cases)
    repeats = [_repeats(case) for case in apart]
    rows = [{"case": case, "motion": told} for case, (_, told) in zip(apart, repeats, strict=True)]
    holds = [
        None if kind is Outcome.UNDECIDED else kind in (Outcome.QUASI_PERIODIC, Outcome.IRREGULAR)
        for kind, _ in repeats
    ]
    return Answer(*_all_cases(holds), cases=rows)


def _repeats(case: CaseView) -> tuple[Outcome, str]:
    """Class of a motion by the intervals between its releases, or separations; also in words."""
    for kind, name in (("stick_to_slip", "release"), ("separation", "separation")):
        intervals = np.diff(case.times_of(kind))
        if intervals.size >= 2 * FEWEST:
            motion = measures.classify_intervals(tuple(intervals))
            if motion.period:
                length = float(intervals[: motion.period].sum())
                return motion.kind, f"repeats after {measures.counted(motion.period, name)} = {length:.4g} s"
            return motion.kind, f"{motion} by its {name}s"
    return Outcome.UNDECIDED, "too few switches"


def _all_cases(holds: Sequence[bool | None]) -> tuple[bool | None, str]:
    """The verdict on a statement about every case: one counterexample refutes it, an open case (None) keeps it open."""
    if False in holds:
        return False, ""
    return (None, "open" if holds else "none") if None in holds or not holds else (True, "")


CONCLUSIONS = claims(sys.modules[__name__])

TEXTS: dict[str, str] = read_texts("pages.yaml")["survival"]


def page_of(cases: Mapping[str, CaseView]) -> list[Section]:
    """Every conclusion under every model, as sections of a page: all verdicts at a glance, then their evidence."""
    table = judge(CONCLUSIONS, by_model(cases))
    verdicts = table.pivot(index="id", columns="model", values="verdict")
    rows = [(one.claim, one.location, *verdicts.loc[one.id, [*MODELS]]) for one in CONCLUSIONS]
    names = [name[0].upper() + name[1:] for name in MODELS]
    sections = [("At a glance", TEXTS["introduction"], pd.DataFrame(rows, columns=["Conclusion", "Place", *names]))]
    columns = {"model": "Model", "verdict": "Verdict", "ours": "Found", "remark": "Remark"}
    for one in CONCLUSIONS:
        evidence = table.loc[table["id"] == one.id, [*columns]].rename(columns=columns)
        if not evidence["Remark"].any():
            evidence = evidence.drop(columns="Remark")
        rule = fill(TEXTS["rule"], text=one.claim, tolerance=one.fill(one.tolerance), reason=one.reason)
        sections.append((one.id, rule, evidence))
    return sections
