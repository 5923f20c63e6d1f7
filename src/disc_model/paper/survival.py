"""Model sensitivity: the paper's main conclusions, judged like rows of the ledger under five
models."""

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray

from disc_model.analysis.classify import FEWEST, motion_of
from disc_model.data.dataset import Missing
from disc_model.data.texts import Section
from disc_model.data.variables import Outcome, flag_names, stated_in
from disc_model.display import counted
from disc_model.paper import measures
from disc_model.paper.measures import STRETCH, STRETCHES, Array, CaseView, pairs, rate_text, sound
from disc_model.paper.model import FALSE, NOT_COMPUTED, TRUE, Answer, read_texts, rows_of
from disc_model.paper.section2 import moving_load_speed
from disc_model.paper.section41 import lowest_speeds

CHANGED = ("normalization", "contact_compliance", "contact_force", "friction_offset")
MODELS = {
    "as published": ("as_published", False, "vertical", False),
    "orthonormal": ("orthonormal", False, "vertical", False),
    "+ residual flexibility": ("orthonormal", True, "vertical", False),
    "+ normal contact force": ("orthonormal", True, "normal", False),
    "+ friction on the surface": ("orthonormal", True, "normal", True),
}
"""The models by name, each with one more change; of contact_compliance and friction_offset: whether there is any."""


def by_model(cases: Mapping[str, CaseView]) -> dict[str, dict[str, CaseView]]:
    """The cases and grid studies of each model; of the grid studies the points that belong to
    it."""
    models: dict[str, dict[str, CaseView]] = {name: {} for name in MODELS}
    for name, case in cases.items():
        study = case.node.to_dataset()
        holds = study.variables if case.is_grid else vars(case.parameters)
        varied = [np.atleast_1d(holds[parameter]).tolist() for parameter in CHANGED]
        points = [
            (scale, give != 0, force, offset != 0)
            for scale, give, force, offset in zip(*varied, strict=True)
        ]
        for model in (model for model, values in MODELS.items() if points.count(values) == 1):
            models[model][name] = case
            if case.is_grid:
                point = study.isel({study["normalization"].dims[0]: points.index(MODELS[model])})
                models[model][name] = CaseView(name, xr.DataTree(point))
    return models


SLOW = 1e-3  # growth rate below which a cycle counts as neither stable nor unstable, 1/s


def onset(points: xr.Dataset, rates: xr.Dataset, curves: xr.Dataset, *, beside: float) -> Answer:
    try:
        growth = (
            rates["growth_rate"]
            .sel(N=points["N"], Omega=points["Omega"])
            .transpose("N", "Omega")
            .values
        )
    except KeyError as error:
        raise Missing(f"study survival_growth lacks points of survival_outcome: {error}") from None
    outcome = flag_names(sound(points)["outcome"].transpose("N", "Omega"))
    apart, stable = outcome == "separation", growth < -SLOW
    unstable, without = (int((apart & kind).sum()) for kind in (growth > SLOW, np.isnan(growth)))
    early = [
        (float(points["N"][i]), float(points["Omega"][j])) for i, j in np.argwhere(apart & stable)
    ]
    # where a stable cycle ends at a fold just above a speed, small disturbances suffice to leave it
    soon = all(
        any(0 <= fold - speed <= beside for fold in _folds_at(curves, load))
        for load, speed in early
    )
    compared = unstable > 0 and bool(stable.any())
    verdict, places = (
        soon if compared or not soon else NOT_COMPUTED,
        [measures.place(*x) for x in early if soon],
    )
    size, kinds, keep = (
        (int(apart.sum()), apart.size),
        (unstable, without, len(early)),
        int((stable & ~apart).sum()),
    )
    return Answer(verdict, points=size, kinds=kinds, keep=keep, early=places)


def fold(
    curves: xr.Dataset, speed: xr.Dataset, rates: xr.Dataset, *, load: float, within: float
) -> Answer:
    folds = np.array(sorted(_folds_at(curves, load)))
    one = sound(speed.sel(N=load).isel(horizon=0))
    highs = one["crossing"].values[flag_names(one["crossing_kind"]) == "begins"]
    width = float(stated_in(speed, "options")["precision"])
    off = [
        np.min(np.maximum(high - width - folds, folds - high), initial=math.inf) for high in highs
    ]
    if not off or min(off) <= within:
        return Answer(TRUE if off else NOT_COMPUTED, folds=folds, highs=highs, growth=[], missed=0)
    # at the map's nearest speeds below and above each interval; nan without a cycle
    at_load = rates["growth_rate"].sel(N=load)
    try:
        before, after = (
            at_load.sel(Omega=highs - width, method="pad"),
            at_load.sel(Omega=highs, method="backfill"),
        )
    except KeyError:
        raise Missing("study survival_growth does not reach as far as survival_speed") from None
    beside = list(zip(before.values.tolist(), after.values.tolist(), strict=True))
    growth = [f"{rate_text(low, '/s')} to {rate_text(high, '/s')}" for low, high in beside]
    # one of the curves that could not be followed may be the fold
    missed = 0 if np.all(np.array(beside) > SLOW) else int(curves["n_continuation_failures"])
    return Answer(
        NOT_COMPUTED if missed else FALSE, folds=folds, highs=highs, growth=growth, missed=missed
    )


def _folds_at(curves: xr.Dataset, load: float) -> Iterator[float]:
    """Speeds at which folds with a stable cycle beside them cross a preload, rad/s."""
    for i in np.flatnonzero(flag_names(sound(curves)["kind"]) == "fold"):
        one = curves.isel(curve=int(i))
        x, y = one["x"].values, one["y"].values
        border = flag_names(one["adjoins_stable_cycle"]) == "yes"
        crosses = ((y[:-1] - load) * (y[1:] - load) <= 0) & (y[:-1] != y[1:])
        for j in np.flatnonzero(crosses & border[:-1] & border[1:]):
            yield float(x[j] + (load - y[j]) / (y[j + 1] - y[j]) * (x[j + 1] - x[j]))


def below_critical(*cases: CaseView, share: float) -> Answer:
    apart, critical = _separating(cases), moving_load_speed(cases[0].parameters)
    rows = [(case.place, part) for case in apart if (part := case["Omega"] / critical) < share]
    return Answer(
        bool(rows) or NOT_COMPUTED,
        "" if rows else "No case separates.",
        rows=rows,
        critical=critical,
    )


def _separating(cases: Sequence[CaseView]) -> list[CaseView]:
    """Cases that lose contact; raises `Missing` if there is none, or if one did not reach its
    end."""
    for (
        case
    ) in cases:  # bilateral contact may end in Painlevé's paradox, when the disc has grown so steep
        if case.status != "ok" and not (case.bonded and case.status == "paradox"):
            raise Missing(f"{case.status} (case {case.name})")
    if not (apart := [case for case in cases if not case.bonded and case.separates]):
        raise Missing("No case separates")
    return apart


def falls_then_rises(speed: xr.Dataset, *, depth: float) -> Answer:
    study = sound(speed.isel(horizon=0))
    verdict, words = lowest_speeds(study, depth)
    return Answer(
        NOT_COMPUTED if np.isfinite(study["critical_speed"].values).sum() < 3 else verdict, words
    )


def smaller_vibration(*cases: CaseView, wider: float) -> Answer:
    smaller: list[bool | None] = []
    rows, steep = [], []
    for free, bonded in pairs([*_separating(cases), *(case for case in cases if case.bonded)]):
        fourth, third = free.last_quarters("w_point")
        ends = bonded.status == "paradox"
        other = bonded.last_widths("w_point", STRETCH, 1 if ends else STRETCHES)
        below = fourth <= (1 + wider) * third and max(third, fourth) < min(other)
        above = min(third, fourth) >= max(other)
        smaller.append(False if above else True if below else None)
        rows.append((free.place, max(third, fourth), min(other)))
        steep += [f"{free.place} after {bonded['time_reached']:.0f} s"] * ends
    return Answer(_all_cases(smaller), rows=rows, steep=steep)


def stick_vanishes(*cases: CaseView, share: float) -> Answer:
    apart = _separating(cases)
    stays = [case.place for case in apart if not case.stick_in_all > share >= case.stick]
    rows = [(case.place, case.stick) for case in apart]
    return Answer(len(stays) < len(apart), rows=rows, stays=stays)


def normal_damping(study: xr.Dataset) -> Answer:
    without, damped, _ = _damped(study, "c")
    compared = (without > SLOW) & np.isfinite(damped)
    lowered, stable, every = (
        int((compared & each).sum()) for each in (damped < without, damped < 0, compared)
    )
    return Answer(
        lowered == every if every else NOT_COMPUTED, lowered=lowered, compared=every, stable=stable
    )


def inplane_damping(study: xr.Dataset, *, large: float, fewest: float) -> Answer:
    without, damped, status = _damped(study, "c_p")
    heavy = (study["N"].values >= large)[:, None]
    both = np.isfinite(without) & np.isfinite(damped)
    higher = both & (damped > 0) & (damped > without + SLOW)
    ended = int(((without < -SLOW) & np.isin(status, ("no_cycle", "separates")) & heavy).sum())
    (above, of), (below, of_below) = (
        (int((higher & at).sum()), int((both & at).sum())) for at in (heavy, ~heavy)
    )
    verdict = NOT_COMPUTED if not above + ended and of < fewest else above + ended > 0
    told, few = counted(ended, "stable cycle"), 0 < 10 * (above + ended) <= of
    return Answer(verdict, ended=told, higher=(above, of, below, of_below), few=few)


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
    repeats = {case.place: _repeats(case) for case in _separating(cases)}
    known = {Outcome.QUASI_PERIODIC: True, Outcome.IRREGULAR: True, Outcome.UNDECIDED: None}
    here = " ".join(f"At {place} the motion {words}." for place, (_, words) in repeats.items())
    return Answer(_all_cases([known.get(kind, False) for kind, _ in repeats.values()]), here)


def _repeats(case: CaseView) -> tuple[Outcome, str]:
    """Class of a motion by the intervals between its releases, or separations; also in words."""
    for kind, name in (("stick_to_slip", "release"), ("separation", "separation")):
        intervals = np.diff(case.times_of(kind))
        if intervals.size >= 2 * FEWEST:
            motion = motion_of(intervals)
            length = float(intervals[: motion.period].sum())
            how = f" ({length:.4g} s)" if motion.period else f", judged by its {name}s"
            return motion.kind, measures.repeats(motion, name) + how
    return Outcome.UNDECIDED, "switches too rarely to be judged"


def _all_cases(holds: Sequence[bool | None]) -> bool | str:
    """The verdict on a statement about every case: one counterexample refutes it, an open case
    (None) keeps it open."""
    return False if False in holds else NOT_COMPUTED if None in holds else True


CONCLUSIONS = rows_of("paper/survival.yaml", globals())
TEXTS: dict[str, str] = read_texts("paper/pages.yaml")["survival"]


def page_of(table: pd.DataFrame) -> Section:
    """All verdicts of a table at a glance, with what decides."""
    verdicts = table.pivot(index="id", columns="model", values="verdict")
    names = [name[0].upper() + name[1:] for name in MODELS]
    rows = [(row.statement, *verdicts.loc[row.id, [*MODELS]], row.rule) for row in CONCLUSIONS]
    return "", TEXTS["introduction"], pd.DataFrame(rows, columns=["Conclusion", *names, "True if"])


def evidence_of(table: pd.DataFrame) -> list[Section]:
    """What was computed under each model, a section for every conclusion."""
    columns = {"model": "Model", "verdict": "Verdict", "here": "Found", "notes": "Remark"}
    parts = {name: part[[*columns]].rename(columns=columns) for name, part in table.groupby("id")}
    return [(row.id, f"{row.statement} True if {row.rule}.", parts[row.id]) for row in CONCLUSIONS]
