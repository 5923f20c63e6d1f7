"""Model sensitivity: the paper's main conclusions, judged like rows of the ledger under five models."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray

from disc_model.analysis.classify import FEWEST, motion_of
from disc_model.data.dataset import Missing
from disc_model.data.texts import Section
from disc_model.data.variables import Outcome, flag_names, stated_in
from disc_model.display import counted
from workflow.paper import measures, model, section2, section41
from workflow.paper.measures import Array, CaseView, rate_text, sound
from workflow.paper.model import FALSE, NOT_COMPUTED, TRUE, Answer

CHANGED = ("normalization", "contact_compliance", "contact_force", "friction_offset")
"""Parameters by which the models differ."""


class Model(NamedTuple):
    """A model of disc and contact, by the parameters in which it differs from others."""

    normalization: str
    compliant: bool
    """Whether the contact has a compliance."""
    contact_force: str
    on_surface: bool
    """Whether friction has an offset from the middle plane."""


MODELS = {
    "as published": Model("as_published", False, "vertical", False),
    "orthonormal": Model("orthonormal", False, "vertical", False),
    "+ residual flexibility": Model("orthonormal", True, "vertical", False),
    "+ normal contact force": Model("orthonormal", True, "normal", False),
    "+ friction on the surface": Model("orthonormal", True, "normal", True),
}
"""The models by name, each with one more change."""

SLOW = 1e-3
"""Growth rate in 1/s below which a cycle counts as neither stable nor unstable."""


def by_model(cases: Mapping[str, CaseView]) -> dict[str, dict[str, CaseView]]:
    """Return the cases and grid studies of each model, by name.

    Of the grid studies these are the points that belong to the model.
    """
    models: dict[str, dict[str, CaseView]] = {name: {} for name in MODELS}
    for name, case in cases.items():
        points = _models_of(case)
        for which, values in MODELS.items():
            if points.count(values) != 1:
                continue
            models[which][name] = case
            if case.is_grid:
                study = case.node.to_dataset()
                along = study["normalization"].dims[0]
                point = study.isel({along: points.index(values)})
                models[which][name] = CaseView(name, xr.DataTree(point))
    return models


def _models_of(case: CaseView) -> list[Model]:
    """Return the model of a case, or the models of a grid study along its axis of models."""
    values = _values_of(case)
    columns = [np.atleast_1d(values[parameter]).tolist() for parameter in CHANGED]
    models = []
    for scale, compliance, force, offset in zip(*columns, strict=True):
        models.append(Model(scale, compliance != 0, force, offset != 0))
    return models


def _values_of(case: CaseView) -> Mapping[Any, Any]:
    """Return the parameters of a case, or the variables of a grid study, by name."""
    if case.is_grid:
        return case.node.to_dataset().variables
    return vars(case.parameters)


# ---- Separation and cycles


def onset(
    points: xr.Dataset, rates: xr.Dataset, curves: xr.Dataset, *, fold_distance: float
) -> Answer:
    """Judge whether separation occurs only where the cycle is unstable, not found or at its fold.

    Parameters
    ----------
    points : outcomes over preload and speed
    rates : growth rates of the cycle at these points
    curves : curves on which cycles become unstable or end
    fold_distance : rad/s below a fold within which a stable cycle may be left
    """
    outcome = flag_names(sound(points)["outcome"].transpose("N", "Omega"))
    try:
        rate = rates["growth_rate"]
        selected = rate.sel(N=points["N"], Omega=points["Omega"])
    except KeyError as error:
        raise Missing(f"study survival_growth lacks points of survival_outcome: {error}") from None
    growth = selected.transpose("N", "Omega").values

    separates = outcome == "separation"
    stable = growth < -SLOW
    unstable = int((separates & (growth > SLOW)).sum())
    without_cycle = int((separates & np.isnan(growth)).sum())
    # where a stable cycle ends at a fold just above a speed, small disturbances suffice to leave it
    in_spite = []
    at_fold = True
    for i, j in np.argwhere(separates & stable):
        load = float(points["N"][i])
        speed = float(points["Omega"][j])
        in_spite.append(measures.place(load, speed))
        above = np.array([*_folds_at(curves, load)]) - speed
        at_fold = at_fold and bool(np.any((above >= 0) & (above <= fold_distance)))

    compared = unstable > 0 and bool(stable.any())
    verdict: bool | str = at_fold
    if at_fold and not compared:
        verdict = NOT_COMPUTED
    return Answer(
        verdict,
        points=(int(separates.sum()), separates.size),
        kinds=(unstable, without_cycle, len(in_spite)),
        keep=int((stable & ~separates).sum()),
        early=in_spite if at_fold else [],
    )


def fold(
    curves: xr.Dataset, speed: xr.Dataset, rates: xr.Dataset, *, load: float, within: float
) -> Answer:
    """Judge whether separation begins at a fold of the quiet cycle.

    Parameters
    ----------
    curves : curves on which cycles become unstable or end
    speed : crossings of the lowest speeds with separation, by preload
    rates : growth rates of the cycle over preload and speed
    load : preload, N
    within : rad/s by which a fold may be off
    """
    folds = np.array(sorted(_folds_at(curves, load)))
    crossings = sound(speed.sel(N=load).isel(horizon=0))
    begins = flag_names(crossings["crossing_kind"]) == "begins"
    highs = crossings["crossing"].values[begins]
    width = float(stated_in(speed, "options")["precision"])

    # a crossing lies between its speed and one step of the bisection below it
    off = []
    for high in highs:
        outside = np.maximum(high - width - folds, folds - high)
        off.append(np.min(outside, initial=math.inf))
    if not off or min(off) <= within:
        verdict = TRUE if off else NOT_COMPUTED
        return Answer(verdict, folds=folds, highs=highs, growth=[], missed=0)

    # growth at the map's nearest speeds below and above each interval; nan without a cycle
    at_load = rates["growth_rate"].sel(N=load)
    try:
        before = at_load.sel(Omega=highs - width, method="pad").values.tolist()
        after = at_load.sel(Omega=highs, method="backfill").values.tolist()
    except KeyError:
        raise Missing("study survival_growth does not reach as far as survival_speed") from None
    # unless the cycle goes on, unstable, a curve that could not be followed may be the fold
    missed = 0
    if not np.all(np.array([before, after]) > SLOW):
        missed = int(curves["n_continuation_failures"])
    growth = []
    for low, high in zip(before, after, strict=True):
        growth.append(f"{rate_text(low, '/s')} to {rate_text(high, '/s')}")
    verdict = NOT_COMPUTED if missed else FALSE
    return Answer(verdict, folds=folds, highs=highs, growth=growth, missed=missed)


def _folds_at(curves: xr.Dataset, load: float) -> Iterator[float]:
    """Yield speeds at which folds with a stable cycle beside them cross a preload, rad/s."""
    for i in np.flatnonzero(flag_names(sound(curves)["kind"]) == "fold"):
        curve = curves.isel(curve=int(i))
        x = curve["x"].values
        y = curve["y"].values
        above = y - load
        ends_stable_cycle = flag_names(curve["adjoins_stable_cycle"]) == "yes"
        crosses = (above[:-1] * above[1:] <= 0) & (y[:-1] != y[1:])
        crosses &= ends_stable_cycle[:-1] & ends_stable_cycle[1:]
        for j in np.flatnonzero(crosses):
            share = -above[j] / (y[j + 1] - y[j])
            yield float(x[j] + share * (x[j + 1] - x[j]))


def below_critical(*cases: CaseView, share: float) -> Answer:
    """Judge whether a case separates below a share of the critical speed of a moving load."""
    separating = _separating(cases)
    critical = section2.moving_load_speed(cases[0].parameters)
    rows = []
    for case in separating:
        part = case["Omega"] / critical
        if part < share:
            rows.append((case.place, part))
    if not rows:
        return Answer(NOT_COMPUTED, "No case separates.", rows=rows, critical=critical)
    return Answer(True, rows=rows, critical=critical)


def _separating(cases: Sequence[CaseView]) -> list[CaseView]:
    """Return cases that lose contact.

    Raises `Missing` if there is none, or if a case did not reach its end. Bilateral contact may end
    in Painlevé's paradox, when the disc has become so steep.
    """
    for case in cases:
        paradox = case.bilateral and case.status == "paradox"
        if case.status != "ok" and not paradox:
            raise Missing(f"{case.status} (case {case.name})")
    separating = [case for case in cases if not case.bilateral and case.separates]
    if not separating:
        raise Missing("No case separates")
    return separating


def falls_then_rises(speed: xr.Dataset, *, depth: float) -> Answer:
    """Judge whether the lowest speed with separation falls and then rises, by a depth in rad/s."""
    study = sound(speed.isel(horizon=0))
    verdict, words = section41.lowest_speeds(study, depth)
    if np.isfinite(study["critical_speed"].values).sum() < 3:
        verdict = NOT_COMPUTED
    return Answer(verdict, words)


# ---- Motion after a separation


def smaller_vibration(*cases: CaseView, wider: float) -> Answer:
    """Judge whether the disc's late range is smaller with separation than without it.

    Parameters
    ----------
    cases : with separation and without it, which form pairs
    wider : share by which a range that has settled may grow from the third quarter of the time
        after the first separation to the last
    """
    smaller: list[bool | None] = []
    rows = []
    steep = []
    bilateral_cases = [case for case in cases if case.bilateral]
    for case, bilateral in measures.pairs([*_separating(cases), *bilateral_cases]):
        fourth, third = case.last_quarters("w_point")
        # up to a paradox, only the last stretch of bilateral contact is compared
        stretches = measures.STRETCHES
        if bilateral.status == "paradox":
            stretches = 1
            steep.append(f"{case.place} after {bilateral['time_reached']:.0f} s")
        other = bilateral.last_widths("w_point", measures.STRETCH, stretches)

        steady = fourth <= (1 + wider) * third
        holds = None
        if min(third, fourth) >= max(other):
            holds = False
        elif steady and max(third, fourth) < min(other):
            holds = True
        smaller.append(holds)
        rows.append((case.place, max(third, fourth), min(other)))
    return Answer(_in_all_cases(smaller), rows=rows, steep=steep)


def stick_vanishes(*cases: CaseView, share: float) -> Answer:
    """Judge whether a case that stuck for more than a share of the time does not in the end."""
    separating = _separating(cases)
    stays = [case.place for case in separating if not case.stick_in_all > share >= case.stick]
    rows = [(case.place, case.stick) for case in separating]
    return Answer(len(stays) < len(separating), rows=rows, stays=stays)


def becomes_periodic(*cases: CaseView) -> Answer:
    """Judge whether some motion is periodic after a separation."""
    holds: list[bool | None] = []
    sentences = []
    for case in _separating(cases):
        kind, words = _repeats(case)
        sentences.append(f"At {case.place} the motion {words}.")
        if kind is Outcome.UNDECIDED:
            holds.append(None)
        else:
            holds.append(kind not in (Outcome.QUASI_PERIODIC, Outcome.IRREGULAR))
    return Answer(_in_some_case(holds), " ".join(sentences))


def _repeats(case: CaseView) -> tuple[Outcome, str]:
    """Return the class of a motion, also in words.

    It is that of the intervals between its releases, or else separations.
    """
    for kind, name in (("stick_to_slip", "release"), ("separation", "separation")):
        intervals = np.diff(case.times_of(kind))
        if intervals.size >= 2 * FEWEST:
            motion = motion_of(intervals)
            remark = f", judged by its {name}s"
            if motion.period:
                length = float(intervals[: motion.period].sum())
                remark = f" ({length:.4g} s)"
            return motion.kind, measures.repeats(motion, name) + remark
    return Outcome.UNDECIDED, "switches too rarely to be judged"


def _in_all_cases(holds: Sequence[bool | None]) -> bool | str:
    """Return the verdict on a statement about every case.

    One counterexample refutes it, and an open case (None) keeps it open.
    """
    if False in holds:
        return False
    return NOT_COMPUTED if None in holds else True


def _in_some_case(holds: Sequence[bool | None]) -> bool | str:
    """Return the verdict on a statement about at least one case.

    One example proves it, and an open case (None) keeps it open.
    """
    if True in holds:
        return True
    return NOT_COMPUTED if None in holds else False


# ---- Damping


class Damped(NamedTuple):
    """What one damper changes, over preload and speed."""

    without: Array
    """Growth rates without a damper, 1/s."""
    damped: Array
    """Growth rates with it, 1/s."""
    status: NDArray[np.str_]
    """What became of the computation with it."""


def _damped(study: xr.Dataset, name: str) -> Damped:
    """Return the points of a study without a damper and with one alone.

    Parameters
    ----------
    study : growth rates over preload and speed, with and without the dampers ``c`` and ``c_p``
    name : of the damper
    """
    (along,) = study["c"].dims
    normal = study["c"].values != 0
    in_plane = study["c_p"].values != 0
    on = list(zip(normal, in_plane, strict=True))
    wanted = [(False, False), (name == "c", name == "c_p")]
    if any(on.count(pair) != 1 for pair in wanted):
        raise Missing(f"study survival_damping lacks a pair of points without and with {name}")
    ordered = study.transpose("N", "Omega", ...)
    without, damped = (ordered.isel({along: on.index(pair)}) for pair in wanted)
    return Damped(
        without=without["growth_rate"].values,
        damped=damped["growth_rate"].values,
        status=flag_names(damped["status"]),
    )


def normal_damping(study: xr.Dataset) -> Answer:
    """Judge whether damping normal to the disc lowers the growth of every growing cycle."""
    without, damped, _ = _damped(study, "c")
    compared = (without > SLOW) & np.isfinite(damped)
    every = int(compared.sum())
    lowered = int((compared & (damped < without)).sum())
    stable = int((compared & (damped < 0)).sum())
    verdict: bool | str = lowered == every
    if not every:
        verdict = NOT_COMPUTED
    return Answer(verdict, lowered=lowered, compared=every, stable=stable)


def inplane_damping(study: xr.Dataset, *, large: float, fewest: float) -> Answer:
    """Judge whether in-plane damping makes a cycle grow faster, or a stable one vanish.

    Parameters
    ----------
    study : growth rates over preload and speed, with and without dampers
    large : preload from which on it is judged, N
    fewest : points that must be compared there if nothing is found
    """
    without, damped, status = _damped(study, "c_p")
    heavy = (study["N"].values >= large)[:, None]
    both = np.isfinite(without) & np.isfinite(damped)
    higher = both & (damped > 0) & (damped > without + SLOW)
    vanished = (without < -SLOW) & np.isin(status, ("no_cycle", "separates"))
    ended = int((vanished & heavy).sum())
    counts = []
    for loads in (heavy, ~heavy):
        for points in (higher, both):
            counts.append(int((points & loads).sum()))

    above, compared, *_ = counts
    destabilised = above + ended
    verdict: bool | str = destabilised > 0
    if not destabilised and compared < fewest:
        verdict = NOT_COMPUTED
    return Answer(
        verdict,
        ended=counted(ended, "stable cycle"),
        higher=counts,
        few=0 < 10 * destabilised <= compared,
    )


# ---- Pages

CONCLUSIONS = model.rows_of("survival.yaml", globals())
TEXTS: dict[str, str] = model.read_texts("pages.yaml")["survival"]


def page_of(table: pd.DataFrame) -> Section:
    """Return all verdicts of a table of `judge` at a glance, with what decides."""
    verdicts = table.pivot(index="id", columns="model", values="verdict")
    names = [name[0].upper() + name[1:] for name in MODELS]
    rows = []
    for row in CONCLUSIONS:
        rows.append((row.statement, *verdicts.loc[row.id, [*MODELS]], row.rule))
    page = pd.DataFrame(rows, columns=["Conclusion", *names, "True if"])
    return "", TEXTS["introduction"], page


def evidence_of(table: pd.DataFrame) -> list[Section]:
    """Return what was computed under each model, a section for every conclusion."""
    columns = {"model": "Model", "verdict": "Verdict", "here": "Found", "notes": "Remark"}
    found = table[["id", *columns]].rename(columns=columns)
    sections = []
    for row in CONCLUSIONS:
        part = found[found["id"] == row.id].drop(columns="id")
        sections.append((row.id, f"{row.statement} True if {row.rule}.", part))
    return sections
