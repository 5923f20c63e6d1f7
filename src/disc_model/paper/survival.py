"""Model sensitivity: the paper's main conclusions, each judged under four models of disc and contact.

Each model changes one more thing, so that the last has all changes. All conclusions are judged from the merged cases
and grids of config/survival.yaml: undecided if the evidence does not decide, not computed if it is missing.
"""

import math
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray

from disc_model.analysis.classify import FEWEST, stick_disappears
from disc_model.data.dataset import Missing
from disc_model.data.variables import Outcome, flag_names, stated_in
from disc_model.paper import measures, section42
from disc_model.paper.measures import STRETCH, STRETCHES, Array, CaseView, rate_text
from disc_model.paper.model import Answer, claims
from disc_model.paper.pages import TEXTS, Comparison

# ----------------------------------------------------------------------------------------------------
# The models and the data of each


class Model(NamedTuple):
    """Values that identify cases and points of a model; compliant: whether the contact has a flexibility."""

    name: str
    normalization: str
    compliant: bool
    contact_force: str


MODELS = (
    Model("as published", "as_published", False, "vertical"),
    Model("orthonormal", "orthonormal", False, "vertical"),
    Model("+ residual flexibility", "orthonormal", True, "vertical"),
    Model("+ normal contact force", "orthonormal", True, "normal"),
)


@dataclass(frozen=True)
class Evidence:
    """Evidence under one model: cases, and grid studies by name, without the dimension of models."""

    cases: tuple[CaseView, ...]
    grids: Mapping[str, xr.Dataset]

    def grid(self, name: str) -> xr.Dataset:
        """A grid study; raises `Missing` if there is none."""
        if name not in self.grids:
            raise Missing(f"study {name} has nothing of this model")
        return self.grids[name]

    def separating(self) -> list[CaseView]:
        """Cases that lose contact; raises `Missing` if one did not reach its end."""
        for case in self.cases:
            if case.status != "ok":
                raise Missing(f"{case.status} (case {case.name})")
        return [case for case in self.cases if not case.bonded and case.separates]


def evidence(model: Model, cases: xr.DataTree, grids: Mapping[str, xr.Dataset]) -> Evidence:
    """Evidence on a model from merged cases and grid studies."""
    views = [CaseView(name, node) for name, node in cases.children.items()]
    found = {name: one for name, grid in grids.items() if (one := _of_model(grid, model)) is not None}
    own = [(p.normalization, p.contact_compliance != 0, p.contact_force) for p in (view.parameters for view in views)]
    return Evidence(tuple(view for view, values in zip(views, own, strict=True) if values == model[1:]), found)


def _of_model(grid: xr.Dataset, model: Model) -> xr.Dataset | None:
    """The part of a grid study that belongs to a model."""
    (dim,) = grid["normalization"].dims
    varied = [grid[name].values for name in ("normalization", "contact_compliance", "contact_force")]
    models = [(normalization, give != 0, force) for normalization, give, force in zip(*varied, strict=True)]
    return grid.isel({dim: models.index(model[1:])}) if models.count(model[1:]) == 1 else None


# ----------------------------------------------------------------------------------------------------
# Conclusions

SLOW = 1e-3
"""Growth rate below which a cycle counts as neither stable nor unstable, 1/s."""


def onset(found: Evidence, *, beside: float) -> Answer:
    points = found.grid("survival_outcome")
    outcome, growth = _beside(points, found.grid("survival_growth"))
    if (outcome == "failed").any():
        raise Missing("study survival_outcome has points that failed")
    apart = outcome == "separation"
    cycles = {"stable": growth < -SLOW, "unstable": growth > SLOW, "none": np.isnan(growth)}
    counts = {kind: int((apart & where).sum()) for kind, where in cycles.items()}
    stable = cycles["stable"]
    early = [(float(points["N"][i]), float(points["Omega"][j])) for i, j in np.argwhere(apart & stable)]
    folds = found.grid("survival_curves")
    # where a stable cycle ends at a fold just above a speed, small disturbances suffice to leave it
    soon = all(any(0 <= fold - speed <= beside for fold in _folds_at(folds, load)) for load, speed in early)
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
        there = growth.sel(N=outcome["N"], Omega=outcome["Omega"])
    except KeyError as error:
        raise Missing(f"study survival_growth lacks points of survival_outcome: {error}") from None
    words = outcome["outcome"].transpose("N", "Omega")
    return flag_names(words), there["growth_rate"].transpose("N", "Omega").values


def fold(found: Evidence, *, load: float, within: float) -> Answer:
    folds = np.array(sorted(_folds_at(found.grid("survival_curves"), load)))
    highs, width = _beginnings(found.grid("survival_speed"), load)
    speeds = {"folds": folds, "begins": highs}
    if not highs.size:
        return Answer(None, "no_speed", growth=[], **speeds)
    off = [np.min(np.maximum(high - width - folds, folds - high), initial=math.inf) for high in highs]
    if min(off) <= within:
        return Answer(True, growth=[], **speeds)
    beside = [_growth_beside(found.grid("survival_growth").sel(N=load), high - width, high) for high in highs]
    rows = [f"{rate_text(low, '/s')} to {rate_text(high, '/s')}" for low, high in beside]
    missed = int(found.grid("survival_curves")["n_continuation_failures"])
    goes_on = all(rate > SLOW for rates in beside for rate in rates)
    return Answer(
        None if missed and not goes_on else False, "missed", missed=missed, growth=[{"rates": rows}], **speeds
    )


def _growth_beside(growth: xr.Dataset, low: float, high: float) -> tuple[float, float]:
    """Growth rates at the map's nearest speeds below and above an interval, 1/s; nan without a cycle."""
    rate = growth["growth_rate"]
    try:
        return float(rate.sel(Omega=low, method="pad")), float(rate.sel(Omega=high, method="backfill"))
    except KeyError:
        raise Missing("study survival_growth does not reach as far as survival_speed") from None


def _folds_at(curves: xr.Dataset, load: float) -> Iterator[float]:
    """Speeds at which folds with a stable cycle beside them cross a preload, rad/s."""
    _require_ok(curves, "survival_curves")
    for i in np.flatnonzero(flag_names(curves["kind"]) == "fold"):
        one = curves.isel(curve=int(i))
        x, y = one["x"].values, one["y"].values
        border = flag_names(one["adjoins_stable_cycle"]) == "yes"
        for j in np.flatnonzero((y[:-1] - load) * (y[1:] - load) <= 0):
            if y[j] != y[j + 1] and border[j] and border[j + 1]:
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


def below_critical(found: Evidence, *, share: float) -> Answer:
    cases = found.separating()
    return section42.far_below(*cases, share=share) if cases else Answer(None, "none", lower=[], critical=math.nan)


def falls_then_rises(found: Evidence, *, depth: float) -> Answer:
    study = found.grid("survival_speed").isel(horizon=0)
    _require_ok(study, "survival_speed")
    falls, values = measures.lowest_speeds(study, depth)
    few = np.isfinite(study["critical_speed"].values).sum() < 3
    return Answer(None if few or values["again"] else falls, "few" if few else "again", **values)


def smaller_vibration(found: Evidence, *, wider: float) -> Answer:
    smaller: list[bool | None] = []
    rows = []
    ignored = [case for case in found.cases if case.bonded]
    for free, bonded in measures.pairs([*found.separating(), *ignored]):
        fourth, third = free.last_quarters("w_point")
        other = bonded.last_widths("w_point", STRETCH, STRETCHES)
        settled = fourth <= (1 + wider) * third
        below = settled and max(third, fourth) < min(other)
        above = min(third, fourth) >= max(other)
        smaller.append(False if above else True if below else None)
        rows.append({"case": free, "free": 1e3 * max(third, fourth), "bonded": 1e3 * min(other)})
    return Answer(*_all_cases(smaller), cases=rows)


def stick_vanishes(found: Evidence, *, share: float) -> Answer:
    cases = found.separating()
    stays = [case.place for case in cases if not stick_disappears(case.stick_in_all, case.stick, share)]
    return Answer(len(stays) < len(cases) if cases else None, "none", cases=measures.rows(cases), stays=stays)


def normal_damping(found: Evidence) -> Answer:
    without, with_damper, _ = _damped(found, "c")
    compared = (without > SLOW) & np.isfinite(with_damper)
    lower, stable = compared & (with_damper < without), compared & (with_damper < 0)
    lowered, count = int(lower.sum()), int(compared.sum())
    return Answer(lowered == count if count else None, "none", lower=lowered, count=count, stable=int(stable.sum()))


def inplane_damping(found: Evidence, *, large: float, fewest: float) -> Answer:
    without, damped, status = _damped(found, "c_p")
    heavy = (found.grid("survival_damping")["N"].values >= large)[:, None]
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


def _damped(found: Evidence, name: str) -> tuple[Array, Array, NDArray[np.str_]]:
    """Growth rates without and with one damper, 1/s, and the result with it: each (N, Omega)."""
    study = found.grid("survival_damping")
    (dim,) = study["c"].dims
    on = list(zip(study["c"].values != 0, study["c_p"].values != 0, strict=True))
    wanted = [(False, False), (name == "c", name == "c_p")]
    if any(on.count(pair) != 1 for pair in wanted):
        raise Missing(f"study survival_damping lacks a pair of points without and with {name}")
    one, two = (study.isel({dim: on.index(pair)}).transpose("N", "Omega", ...) for pair in wanted)
    return one["growth_rate"].values, two["growth_rate"].values, flag_names(two["status"])


def not_periodic(found: Evidence) -> Answer:
    cases = found.separating()
    repeats = [_repeats(case) for case in cases]
    rows = [{"case": case, "motion": told} for case, (_, told) in zip(cases, repeats, strict=True)]
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

# ----------------------------------------------------------------------------------------------------
# The page


def judge(cases: xr.DataTree, grids: Mapping[str, xr.Dataset]) -> pd.DataFrame:
    """Judge every conclusion under every model: one row each, columns conclusion, model, verdict, ours, remark."""
    rows = []
    for model in MODELS:
        found = evidence(model, cases, grids)
        for one in CONCLUSIONS:
            judged, _ = one.settle(lambda claim, found=found: claim.judge(found))
            rows.append((one.id, model.name, judged.verdict, judged.ours, judged.remark))
    return pd.DataFrame(rows, columns=["conclusion", "model", "verdict", "ours", "remark"])


def page_of(table: pd.DataFrame) -> Comparison:
    """Results of `judge` as a page: all verdicts at a glance, then their evidence."""
    texts = TEXTS["survival"]
    verdicts = table.pivot(index="conclusion", columns="model", values="verdict").loc[[one.id for one in CONCLUSIONS]]
    first = pd.DataFrame([(one.claim, one.location) for one in CONCLUSIONS], columns=["Conclusion", "Place"])
    for model in MODELS:
        first[model.name[0].upper() + model.name[1:]] = verdicts[model.name].to_numpy()
    sections = [("At a glance", texts["introduction"], first)]
    for one in CONCLUSIONS:
        rows = table[table["conclusion"] == one.id].drop(columns="conclusion")
        shown = rows.rename(columns={"model": "Model", "verdict": "Verdict", "ours": "Found", "remark": "Remark"})
        if not rows["remark"].any():
            shown = shown.drop(columns="Remark")
        rule = texts["rule"].format(text=one.claim, tolerance=one.fill(one.tolerance), reason=one.reason)
        sections.append((one.id, rule, shown))
    return Comparison(texts["title"], tuple(sections))
