"""What survives: the paper's main conclusions, each judged under four models of disc and contact.

The models change one thing after the other, so that the last has all changes.  Whatever is judged is read from the
merged cases and grid studies of config/survival.yaml; what they cannot tell is undecided, and what they lack is not
computed.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray

from disc_model.analysis.classify import FEWEST, Kind, motion_of, stick_disappears
from disc_model.claims import measures
from disc_model.claims.ledger import Comparison
from disc_model.claims.measures import many, place_of, said_rate
from disc_model.claims.model import STRETCH, STRETCHES, CaseView, Claim, Finding, Missing, finding, undecided
from disc_model.data.variables import flag_names

Array = NDArray[np.float64]

# ----------------------------------------------------------------------------------------------------
# The models, and what there is of each


class Model(NamedTuple):
    """Values by which cases and points of a model are known; compliant: whether the contact has a flexibility."""

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
    """What was computed under one model: cases, and grid studies by name, along which the model no longer varies."""

    cases: tuple[CaseView, ...]
    grids: Mapping[str, xr.Dataset]

    def grid(self, name: str) -> xr.Dataset:
        """A grid study; raises `Missing` if it is not there."""
        if name not in self.grids:
            raise Missing(f"study {name} has nothing of this model")
        return self.grids[name]

    def pairs(self) -> list[tuple[CaseView, CaseView]]:
        """Cases that separate, each with the one in which separation is ignored."""
        ignored = [case for case in self.cases if case.parameters.contact == "bonded"]
        return measures.pairs([*self.separating(), *ignored])

    def separating(self) -> list[CaseView]:
        """Cases that lose contact; raises `Missing` if one did not get to its end."""
        for case in self.cases:
            if case.status != "ok":
                raise Missing(f"{case.status} (case {case.name})")
        return [case for case in self.cases if case.parameters.contact != "bonded" and case.separates]


def evidence(model: Model, cases: xr.DataTree, grids: Mapping[str, xr.Dataset]) -> Evidence:
    """What merged cases and grid studies hold of a model."""
    views = [CaseView(name, node) for name, node in cases.children.items()]
    found = {name: one for name, grid in grids.items() if (one := _of_model(grid, model)) is not None}
    return Evidence(tuple(view for view in views if _is_of(view, model)), found)


def _is_of(case: CaseView, model: Model) -> bool:
    p = case.parameters
    return (p.normalization, p.contact_compliance != 0, p.contact_force) == model[1:]


def _of_model(grid: xr.Dataset, model: Model) -> xr.Dataset | None:
    """The one place along the dimension of models."""
    (dim,) = grid["normalization"].dims
    varied = [grid[name].values for name in ("normalization", "contact_compliance", "contact_force")]
    models = [(normalization, give != 0, force) for normalization, give, force in zip(*varied, strict=True)]
    return grid.isel({dim: models.index(model[1:])}) if models.count(model[1:]) == 1 else None


# ----------------------------------------------------------------------------------------------------
# Conclusions

LARGE = 300.0
"""N, the least preload that counts as large; the paper shows 385 N."""
SLOW = 1e-3
"""1/s, a growth rate below which a cycle counts as neither stable nor unstable."""


@Claim(
    "Onset",
    "Conclusions",
    "Friction makes the stick-slip cycle unstable, and separation follows from that only.",
    tolerance="nowhere on a grid of speeds and preloads does the published start separate where the cycle is stable; "
    "within 0.1 rad/s of the fold at which the cycle ends, that is a remark",
    reason="simulations that are never left early, beside multipliers; growth below 1e-3 per second shows too late",
)
def onset(found: Evidence) -> Finding:
    points = found.grid("survival_outcome")
    outcome, growth = _beside(points, found.grid("survival_growth"))
    if (outcome == "unknown").any():
        raise Missing("study survival_outcome has points that failed")
    apart = outcome == "separation"
    stable, unstable, none = growth < -SLOW, growth > SLOW, np.isnan(growth)
    counts = [int((apart & where).sum()) for where in (unstable, none, stable)]
    ours = (
        f"{int(apart.sum())} of {apart.size} points separate: {counts[0]} from an unstable cycle, {counts[1]} where "
        f"none is found, {counts[2]} from a stable one; {int((stable & ~apart).sum())} with a stable cycle do not"
    )
    early = [(float(points["N"][i]), float(points["Omega"][j])) for i, j in np.argwhere(apart & stable)]
    if not all(_ends_soon(found, load, speed) for load, speed in early):
        return finding(ours, False)
    if not counts[0] or not stable.any():
        return undecided(ours, "separation and a stable cycle are not both there to compare")
    if not early:
        return finding(ours, True)
    places = ", ".join(measures.place(*at) for at in early)
    return finding(ours, True, f"it separates shortly before the stable cycle ends at a fold, too: {places}")


def _ends_soon(found: Evidence, load: float, speed: float) -> bool:
    """Whether a stable cycle ends at a fold just above a speed: there, little keeps a motion with it."""
    return any(0 <= fold - speed <= 0.1 for fold in _folds_at(found.grid("survival_curves"), load))


def _beside(outcome: xr.Dataset, growth: xr.Dataset) -> tuple[NDArray[np.str_], Array]:
    """Outcomes, and growth rates at the same points, 1/s: both (N, Omega)."""
    try:
        there = growth.sel(N=outcome["N"], Omega=outcome["Omega"])
    except KeyError as error:
        raise Missing(f"study survival_growth lacks points of survival_outcome: {error}") from None
    words = outcome["outcome"].transpose("N", "Omega")
    return flag_names(words), there["growth_rate"].transpose("N", "Omega").values


NEAR_FOLD = 385.0
"""N, the preload at which the paper finds its critical speed between 15 and 15.1 rad/s."""


@Claim(
    "Fold at N = 385 N",
    "Conclusions",
    "At N = 385 N separation begins where the quiet cycle ends, at a fold.",
    tolerance="a fold lies within 0.05 rad/s of the interval in which separation begins as the speed rises; it does "
    "not hold where the cycle goes on unstable at the speeds of the growth map on both sides",
    reason="a fold is read off between points of its curve, to a hundredth; the interval is what bisection left; where "
    "some curve could not be followed, a fold may have been missed",
)
def fold(found: Evidence) -> Finding:
    folds = np.array(sorted(_folds_at(found.grid("survival_curves"), NEAR_FOLD)))
    highs, width = _beginnings(found.grid("survival_speed"), NEAR_FOLD)
    begins = many(highs, 1) or "none"
    ours = f"folds beside a stable cycle: {many(folds, 3) or 'none'}; separation begins: {begins} (rad/s)"
    if not highs.size:
        return undecided(ours, "no speed at which separation begins was found")
    off = [np.min(np.maximum(high - width - folds, folds - high), initial=math.inf) for high in highs]
    if min(off) <= 0.05:
        return finding(ours, True)
    beside = [_growth_beside(found.grid("survival_growth"), high - width, high) for high in highs]
    ours += "; growth there " + ", ".join(f"{said_rate(low, '/s')} to {said_rate(high, '/s')}" for low, high in beside)
    if all(rate > SLOW for rates in beside for rate in rates):
        return finding(ours, False)
    missed = int(found.grid("survival_curves")["n_unfollowed"])
    return undecided(ours, f"{missed} curves could not be followed") if missed else finding(ours, False)


def _growth_beside(growth: xr.Dataset, low: float, high: float) -> tuple[float, float]:
    """Growth rates at the nearest speeds of the map below and above an interval, 1/s; nan where there is no cycle."""
    speed, rate = growth["Omega"].values, growth["growth_rate"].sel(N=NEAR_FOLD).values
    below, above = np.searchsorted(speed, low, side="right") - 1, np.searchsorted(speed, high)
    if below < 0 or above >= speed.size:
        raise Missing("study survival_growth does not reach as far as survival_speed")
    return float(rate[below]), float(rate[above])


def _folds_at(curves: xr.Dataset, load: float) -> Iterator[float]:
    """Speeds at which folds with a stable cycle beside them cross a preload, rad/s."""
    _require_ok(curves, "survival_curves")
    for i in np.flatnonzero(flag_names(curves["kind"]) == "fold"):
        one = curves.isel(curve=int(i))
        x, y = one["x"].values, one["y"].values
        border = flag_names(one["border"]) == "yes"
        for j in np.flatnonzero((y[:-1] - load) * (y[1:] - load) <= 0):
            if y[j] != y[j + 1] and border[j] and border[j + 1]:
                yield float(x[j] + (load - y[j]) / (y[j + 1] - y[j]) * (x[j + 1] - x[j]))


def _beginnings(speed: xr.Dataset, load: float) -> tuple[Array, float]:
    """Upper ends of the intervals in which separation begins as the speed rises, and how wide they are, rad/s."""
    one = speed.sel(N=load).isel(horizon=0)
    _require_ok(one, "survival_speed")
    begins = flag_names(one["crossing_kind"]) == "begins"
    return one["crossing"].values[begins], float(json.loads(speed.attrs["options"])["precision"])


def _require_ok(grid: xr.Dataset, name: str) -> None:
    if not np.all(flag_names(grid["status"]) == "ok"):
        raise Missing(f"study {name} has points that failed")


@Claim(
    "Critical speed",
    "Conclusions",
    "The lowest speed with separation falls with the preload at first, then rises.",
    tolerance="between preloads at both of which it is higher, by 0.3 rad/s or more, or there is no separation at all",
    reason="speeds are found to 0.1 rad/s, but for stripes narrower than the scan's 1 rad/s; how long one waits, "
    "1000 s here, moves them all",
)
def falls_then_rises(found: Evidence) -> Finding:
    study = found.grid("survival_speed").isel(horizon=0)
    _require_ok(study, "survival_speed")
    speed, load = study["critical_speed"].values, study["N"].values
    ours = "; ".join(f"{N:g} N: {'none' if math.isnan(v) else f'{v:.1f}'}" for N, v in zip(load, speed, strict=True))
    height = np.where(np.isnan(speed), np.inf, speed)
    if np.isfinite(height).sum() < 3:
        return undecided(f"{ours} (rad/s)", "fewer than three preloads separate")
    dips = [bool(min(height[:i].max(), height[i + 1 :].max()) >= height[i] + 0.3) for i in range(1, len(height) - 1)]
    return finding(f"{ours} (rad/s)", any(dips))


@Claim(
    "Smaller vibration",
    "Conclusions",
    "Separation keeps the disc's vibration smaller than it is where separation is ignored.",
    tolerance="over the last half of the time after the first separation it is narrower than any 20 s without "
    "separation",
    reason="motions that wander have no single range; one whose last quarter is a fifth wider than the one before "
    "decides nothing",
)
def smaller_vibration(found: Evidence) -> Finding:
    smaller: list[bool | None] = []
    words = []
    for free, bonded in found.pairs():
        fourth, third = free.last_quarters("w_point")
        other = bonded.last_widths("w_point", STRETCH, STRETCHES)
        settled = fourth <= (1 + 0.2) * third
        if min(third, fourth) >= max(other):
            smaller.append(False)
        else:
            smaller.append(True if settled and max(third, fourth) < min(other) else None)
        words.append(f"{place_of(free)}: {1e3 * max(third, fourth):.1f} against {1e3 * min(other):.1f} mm")
    return _of_cases(words, smaller)


@Claim(
    "Stick vanishes",
    "Conclusions",
    "After a separation the stick phase disappears, under certain parameter values.",
    tolerance="0.1 % of the last 60 s in at least one case that stuck before; where it does not, that is a remark",
    reason="a stray stick would not refute the statement",
)
def stick_vanishes(found: Evidence) -> Finding:
    stays, words = [], []
    for case in found.separating():
        late = measures.phase_share(case, "stick")
        if not stick_disappears(case["time_stick"] / case["time_reached"], late, 1e-3):
            stays.append(place_of(case))
        words.append(f"{place_of(case)}: {100 * late:.2g} %")
    if not words:
        return undecided("", "no case separates")
    return finding("; ".join(words), len(stays) < len(words), f"not at {', '.join(stays)}" if stays else "")


@Claim(
    "Damper normal to the disc",
    "Conclusions",
    "Damping normal to the disc stabilises.",
    tolerance="c = 0.5 N s/m lowers the growth rate of every cycle that grows without it by 1e-3 per second or more",
    reason="growth rates are right to 1e-7; a cycle that is lost or found with the damper has no two rates to compare",
)
def normal_damping(found: Evidence) -> Finding:
    without, with_damper, _ = _damped(found, "c")
    compared = (without > SLOW) & np.isfinite(with_damper)
    lower = compared & (with_damper < without)
    stable = compared & (with_damper < 0)
    ours = (
        f"lower at {int(lower.sum())} of {int(compared.sum())} points with a growing cycle, stable at "
        f"{int(stable.sum())}"
    )
    if not compared.any():
        return undecided(ours, "no cycle grows without the damper")
    return finding(ours, bool(lower.sum() == compared.sum()))


@Claim(
    "Damper in the disc's plane",
    "Conclusions",
    "In-plane damping destabilises at some large preloads.",
    tolerance="at 300 N or more, somewhere on a grid, c_p = 0.5 N s/m raises a growth rate that is positive with it by "
    "1e-3 per second or more, or a stable cycle ends",
    reason="one place decides; ten cycles or more have to be there for none to mean anything",
)
def inplane_damping(found: Evidence) -> Finding:
    without, damped, status = _damped(found, "c_p")
    large = (found.grid("survival_damping")["N"].values >= LARGE)[:, None]
    both = np.isfinite(without) & np.isfinite(damped)
    higher = both & (damped > 0) & (damped > without + SLOW)
    ended = (without < -SLOW) & np.isin(status, ("no_cycle", "separates"))
    grows = [int((higher & place).sum()) for place in (large, ~large)]
    ends = measures.counted(int((ended & large).sum()), "stable cycle")
    ours = (
        f"at {LARGE:g} N or more higher at {grows[0]} of {int((both & large).sum())} points, and {ends} ended; below, "
        f"higher at {grows[1]} of {int((both & ~large).sum())}"
    )
    if grows[0] or (ended & large).any():
        return finding(ours, True)
    return finding(ours, False) if (both & large).sum() >= 10 else undecided(ours, "too few cycles to mean anything")


def _damped(found: Evidence, name: str) -> tuple[Array, Array, NDArray[np.str_]]:
    """Growth rates without and with one damper, 1/s, and what was found with it: each (N, Omega)."""
    study = found.grid("survival_damping")
    (dim,) = study["c"].dims
    on = list(zip(study["c"].values != 0, study["c_p"].values != 0, strict=True))
    wanted = [(False, False), (name == "c", name == "c_p")]
    if any(on.count(pair) != 1 for pair in wanted):
        raise Missing(f"study survival_damping lacks a pair of points without and with {name}")
    one, two = (study.isel({dim: on.index(pair)}).transpose("N", "Omega", ...) for pair in wanted)
    return one["growth_rate"].values, two["growth_rate"].values, flag_names(two["status"])


@Claim(
    "Not periodic afterwards",
    "Conclusions",
    "After a separation the motion does not settle to a periodic one.",
    tolerance="no period within half of the last 60 s, by releases of stick, or by separations where it hardly sticks: "
    "in every case; 1e-8 s",
    reason="far above rounding, far below what an irregular motion leaves; the paper judges sections by their looks",
)
def not_periodic(found: Evidence) -> Finding:
    cases = found.separating()
    repeats = [_repeats(case) for case in cases]
    words = [f"{place_of(case)}: {told}" for case, (_, told) in zip(cases, repeats, strict=True)]
    return _of_cases(words, [None if kind is Kind.UNDECIDED else kind is not Kind.PERIODIC for kind, _ in repeats])


def _repeats(case: CaseView) -> tuple[Kind, str]:
    """What a motion is by the intervals between its releases, or separations; and that in words."""
    for kind, name in (("stick_to_slip", "release"), ("separation", "separation")):
        intervals = np.diff(measures.times_of(case, kind))
        if intervals.size >= 2 * FEWEST:
            motion = motion_of(intervals)
            if motion.period:
                length = float(intervals[: motion.period].sum())
                return motion.kind, f"repeats after {measures.counted(motion.period, name)} = {length:.4g} s"
            return motion.kind, f"{motion.kind} by its {name}s"
    return Kind.UNDECIDED, "too few switches"


def _of_cases(words: Sequence[str], holds: Sequence[bool | None]) -> Finding:
    """The verdict on a statement about every case: one against it is enough, an open one (None) leaves it open."""
    ours = "; ".join(words)
    if False in holds:
        return finding(ours, False)
    if None in holds or not holds:
        return undecided(ours, "not every case decides" if holds else "no case separates")
    return finding(ours, True)


CONCLUSIONS = tuple(one for one in list(vars().values()) if isinstance(one, Claim))
"""In the order in which they stand here."""

# ----------------------------------------------------------------------------------------------------
# The page


def judge(cases: xr.DataTree, grids: Mapping[str, xr.Dataset]) -> pd.DataFrame:
    """Every conclusion under every model: a row each, columns conclusion, model, verdict, ours, remark."""
    rows = []
    for model in MODELS:
        found = evidence(model, cases, grids)
        for one in CONCLUSIONS:
            judged = one.judge(found)
            rows.append((one.id, model.name, judged.verdict, judged.ours, judged.remark))
    return pd.DataFrame(rows, columns=["conclusion", "model", "verdict", "ours", "remark"])


INTRODUCTION = (
    "Four models: the paper's (as published); the same with orthonormal modes, Eq. (17); with residual flexibility in "
    "the contact besides; with the contact force normal to the deformed disc besides, so that the last has all three "
    "changes. Nine modes, base values, the published start; the same checks for each. Undecided means that the motions "
    "computed do not tell."
)


def page_of(table: pd.DataFrame) -> Comparison:
    """What `judge` found, as a page: all verdicts at a glance, then what each rests on."""
    verdicts = table.pivot(index="conclusion", columns="model", values="verdict").loc[[one.id for one in CONCLUSIONS]]
    first = pd.DataFrame({"Conclusion": [one.text for one in CONCLUSIONS]})
    for model in MODELS:
        first[model.name[0].upper() + model.name[1:]] = verdicts[model.name].to_numpy()
    sections = [("At a glance", INTRODUCTION, first)]
    for one in CONCLUSIONS:
        rows = table[table["conclusion"] == one.id].drop(columns="conclusion")
        shown = rows.rename(columns={"model": "Model", "verdict": "Verdict", "ours": "Found", "remark": "Remark"})
        if not rows["remark"].any():
            shown = shown.drop(columns="Remark")
        sections.append((one.id, f"{one.text} Rule: {one.tolerance}. Why: {one.reason}.", shown))
    return Comparison("What survives of the paper's conclusions", tuple(sections))
