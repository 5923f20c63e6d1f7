"""Conclusions under seven models.

Each is judged by made-up data on which it is true, on which it is not, and which do not tell.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from disc_model import Parameters
from disc_model.data.variables import STATUSES
from tests.analysis.test_classify import logistic
from tests.paper.evidence import critical_speeds, grid, kept_events
from workflow.paper import survival
from workflow.paper.measures import CaseView
from workflow.paper.model import FALSE, NOT_COMPUTED, PART, TRUE
from workflow.paper.survival import CHANGED, CONCLUSIONS, MODELS

BY_TITLE = {row.id: row for row in CONCLUSIONS}
CONFIG = Path(__file__).parents[2] / "config"
NAN = float("nan")
POINTS = {"N": [50.0, 385.0], "Omega": [10.0, 20.0, 30.0]}


# ---- Grids


def growth(*rates: float) -> xr.Dataset:
    """Return growth rates of the cycle at `POINTS`, 1/s."""
    return grid(POINTS, growth_rate=np.reshape(rates, (2, 3)))


def outcome(letters: str) -> xr.Dataset:
    """Return outcomes at `POINTS` by letters: s separates, q is quiet, g grows, x failed."""
    words = {"s": "separation", "q": "stick_slip", "g": "growing", "x": "failed"}
    found = [words[letter] for letter in letters]
    return grid(POINTS, outcome=np.reshape(found, (2, 3)))


def curves(
    kind: str, *speeds: float, border: str | Sequence[str] = "yes", missed: int = 0
) -> xr.Dataset:
    """Return one curve from 380 to 390 N, and room for another.

    Parameters
    ----------
    kind : of the curve
    speeds : at its ends, rad/s
    border : whether a stable cycle adjoins it, or each of its points
    missed : number of curves that could not be followed
    """
    return grid(
        {"curve": [0, 1], "curve_point": [0, 1, 2]},
        kind=[kind, "none"],
        x=[[*speeds, NAN], [NAN] * 3],
        y=[[380.0, 390.0, NAN], [NAN] * 3],
        adjoins_stable_cycle=np.full((2, 3), border),
        status="ok",
        n_continuation_failures=missed,
    )


def onset(letters: str, *rates: float, fold: float = 29.0) -> dict[str, xr.Dataset]:
    """Return outcomes, growth rates, and a fold at a speed in rad/s."""
    return {
        "outcome": outcome(letters),
        "growth": growth(*rates),
        "curves": curves("fold", fold, fold),
    }


def at_fold(found: xr.Dataset, *begins: float, rate: float = -0.1) -> dict[str, xr.Dataset]:
    """Return curves, and speeds at which separation begins at 385 N, rad/s.

    The last crossing is an end of separation, which counts for nothing.
    """
    kinds = [*["begins"] * len(begins), "ends"]
    axes = {"N": [385.0], "horizon": [1000.0], "crossing_number": range(len(kinds))}
    speed = grid(
        axes,
        {"precision": 0.1},
        status=["ok"],
        crossing=[[[*begins, 15.1]]],
        crossing_kind=[[kinds]],
    )
    return {"curves": found, "speed": speed, "growth": growth(*[rate] * 5, 0.1)}


def critical(*speeds: float) -> dict[str, xr.Dataset]:
    """Return the lowest speeds with separation at four preloads, rad/s."""
    found = critical_speeds([(speed, NAN) for speed in speeds])
    return {"speed": found.isel(normalization=0)}


def damping(name: str, without: np.ndarray, damped: np.ndarray) -> dict[str, xr.Dataset]:
    """Return growth rates over preload and speed, 1/s, without and with one damper, ``name``."""
    rates = np.stack([without, damped])
    axes = {"c_c_p": [0, 1], "N": [50.0, 385.0], "Omega": np.linspace(10, 50, rates.shape[2])}
    study = grid(axes, growth_rate=rates, status=np.full(rates.shape, "ok"))
    dampers = {each: ("c_c_p", [0.0, 0.5 * (each == name)]) for each in ("c", "c_p")}
    return {"damping": study.assign_coords(dampers)}


GROWING = np.array([[-0.1, 0.1, 0.2], [0.05, 0.1, NAN]])
MANY = np.tile(np.linspace(-0.1, 0.1, 12), (2, 1))


def raised(row: int, column: int, to: float) -> np.ndarray:
    """Return growth rates below `MANY`, but for one that is raised."""
    rates = MANY - 0.05
    rates[row, column] = to
    return rates


ONSET = "Onset"
FOLD = "Fold at N = 385 N"
CRITICAL = "Critical speed"
NORMAL = "Damper normal to the disc"
IN_PLANE = "Damper in the disc's plane"

STABLE_AND_NOT = (-0.1, -0.2, 0.1, -0.1, 0.05, NAN)
MORE_STABLE = (-0.1, -0.2, 0.1, -0.1, -0.05, NAN)
ALL_KNOWN = (-0.1, -0.2, 0.1, -0.1, 0.05, 0.1)

BELOW_FOLD = curves("fold", 14.9, 15.2)
OFF_FOLD = curves("fold", 15.0, 15.34)
NO_FOLD = curves("neutral", 14.9, 15.2, missed=2)
HALF_FOLD = curves("fold", 14.9, 15.2, border=["yes", "no", "no"])
FAILED = BELOW_FOLD.assign(grid({}, status="failed"))

STABLE_RAISED = np.array([[0.1, -0.1, -0.1], [-0.1, -0.1, 0.0]])
GROWING_RAISED = np.array([[0.0, -0.1, 0.01], [-0.1, -0.1, 0.0]])

WITHOUT_POINTS = onset("qqsqgs", *MORE_STABLE)
WITHOUT_POINTS["growth"] = WITHOUT_POINTS["growth"].isel(N=[0])

GRID_CASES = [
    (ONSET, onset("qqsqgs", *STABLE_AND_NOT), TRUE),
    (ONSET, onset("qssqgs", *STABLE_AND_NOT), FALSE),  # one from a stable cycle
    (ONSET, onset("qqqqgg", *ALL_KNOWN), NOT_COMPUTED),  # nothing separates
    (ONSET, onset("qqsqss", *MORE_STABLE, fold=20.2), FALSE),  # the cycle continues
    (ONSET, onset("qqsqss", *MORE_STABLE, fold=20.05), TRUE),  # a fold just above the speed
    (ONSET, onset("qqsqss", *MORE_STABLE, fold=19.95), FALSE),  # at the speed, the cycle is beyond
    (ONSET, onset("xqsqgs", *MORE_STABLE), NOT_COMPUTED),
    (ONSET, onset("ssssss", *[0.1] * 6), NOT_COMPUTED),  # no cycle is stable
    (ONSET, WITHOUT_POINTS, NOT_COMPUTED),  # the map of growth lacks points
    (FOLD, at_fold(BELOW_FOLD, 15.1), TRUE),  # at 15.05, within 15.0 .. 15.1
    (FOLD, at_fold(OFF_FOLD, 15.1), FALSE),  # at 15.17
    (FOLD, at_fold(HALF_FOLD, 15.1), FALSE),  # a stable cycle adjoins one end only
    (FOLD, at_fold(NO_FOLD, 15.1), NOT_COMPUTED),  # a curve that was missed may be the fold
    (FOLD, at_fold(NO_FOLD, 15.1, rate=0.1), FALSE),  # the cycle goes on, unstable
    (FOLD, at_fold(BELOW_FOLD), NOT_COMPUTED),  # separation begins nowhere
    (FOLD, at_fold(BELOW_FOLD, 40.0), NOT_COMPUTED),  # where no growth rate is known
    (FOLD, at_fold(FAILED, 15.1), NOT_COMPUTED),
    (CRITICAL, critical(30.0, 20.0, 12.0, NAN), TRUE),
    (CRITICAL, critical(30.0, NAN, 12.0, NAN), NOT_COMPUTED),  # two speeds do not fall and rise
    (CRITICAL, critical(30.0, 12.0, 20.0, 14.0), PART),  # at the end of the scan it falls again
    (CRITICAL, critical(30.0, 20.0, 12.0, 12.2), FALSE),  # no more than speeds are known to
    (NORMAL, damping("c", GROWING, GROWING - 0.15), TRUE),
    (NORMAL, damping("c", GROWING, GROWING + STABLE_RAISED), TRUE),  # stable ones do not count
    (NORMAL, damping("c", GROWING, GROWING + GROWING_RAISED), FALSE),
    (IN_PLANE, damping("c_p", MANY, MANY - 0.05), FALSE),
    (IN_PLANE, damping("c_p", MANY, raised(1, 0, 0.05)), TRUE),  # a stable cycle grows
    (
        IN_PLANE,
        damping("c_p", MANY, raised(1, 0, -0.02)),
        FALSE,
    ),  # it decays more slowly, and is stable still
    (
        IN_PLANE,
        damping("c_p", MANY[:, :3], MANY[:, :3] - 0.05),
        NOT_COMPUTED,
    ),  # few cycles say nothing
    (IN_PLANE, damping("c", GROWING, GROWING), NOT_COMPUTED),  # of the other damper
]


# ---- Cases


def case(
    *widths: float,
    N: float = 200,
    first: float = 100.0,
    intervals: np.ndarray | None = None,
    stick: float = 0.0,
    before: float = 0.1,
    status: str = "ok",
    last: float = 1.0,
) -> CaseView:
    """Return a run of 300 s.

    Parameters
    ----------
    widths : of the disc's motion in quarters of the time after 100 s, each of 50 s; all 1 if none
    N : preload, N
    first : time of the first separation, s; 0 where separation is ignored
    intervals : between separations of the last 60 s, s
    stick : share of these 60 s in stick
    before : share of the whole run in stick
    status : of the run
    last : share of that width in the last 20 s
    """
    p = Parameters(N=N, Omega=20, contact="unilateral" if first else "bilateral")
    scalars = {
        "N": N,
        "Omega": 20.0,
        "status": STATUSES.index(status),
        "first_separation": first or NAN,
        "n_separations": 5 * (first > 0),
        "time_reached": 300.0,
        "time_stick": 300 * before,
    }
    time = np.arange(0.25, 300, 0.5)
    half = np.repeat([0.01, 0.01, *(widths or [1.0] * 4)], 100) / 2
    half[-40:] *= last
    ranges = {"w_point_min": ("time", -half), "w_point_max": ("time", half)}
    released = 240 + 60 * stick
    rows = [(240.0, "slip_to_stick", "stick"), (released, "stick_to_slip", "slip")]
    times = 240 + np.cumsum(np.full(4000, 0.01) if intervals is None else intervals)
    for separation in times[(times > released) & (times < 299)]:
        rows.append((separation, "separation", "separation"))
        rows.append((separation + 1e-4, "reattachment", "slip"))
    groups = {
        "/": xr.Dataset(scalars, attrs={"parameters": p.canonical_json}),
        "/history": xr.Dataset(ranges, {"time": time}),
        "/events": kept_events(rows, 240.0, 300.0),
    }
    return CaseView(f"case{N:g}{first:g}", xr.DataTree.from_dict(groups))


BILATERAL = case(3, 3, 3, 3, first=0)
UNTIL_PARADOX = case(1, 1, 1, 3, first=0, status="paradox")
REPEATING = np.tile([0.01, 0.012, 0.011], 2000)
DRIFTING = 0.01 * (1 + 0.1 * np.sin(2.399963 * np.arange(6000)))
CHAOTIC = 0.01 * (0.7 + 0.6 * logistic(4.0, 8000))
FEW = np.full(20, 2.0)
TOO_FEW = np.full(30, 1.9)  # a period would show in twenty, but need not be the shortest

FAR = "Far below the moving load's critical speed"
SMALLER = "Smaller vibration"
STICK = "Stick vanishes"
PERIODIC = "Periodic afterwards"

CASES = [
    (FAR, (case(),), TRUE),
    (FAR, (case(first=0),), NOT_COMPUTED),
    (SMALLER, (case(9, 1, 1, 1.05), BILATERAL), TRUE),  # what is early does not count
    (SMALLER, (case(1, 1, 1, 1.3), BILATERAL), NOT_COMPUTED),  # it still grows
    (SMALLER, (case(1, 1, 2.9, 3.5), BILATERAL), NOT_COMPUTED),  # it grows through the other
    (SMALLER, (case(1, 1, 4, 4), BILATERAL), FALSE),
    (SMALLER, (case(1, 1, 4, 4, last=0.6), BILATERAL), NOT_COMPUTED),  # smaller over equal times
    (SMALLER, (case(1, 1, 1, 1), UNTIL_PARADOX), TRUE),  # bilateral contact grew until the end
    (STICK, (case(stick=5e-4),), TRUE),
    (STICK, (case(stick=5e-4, status="failed"),), NOT_COMPUTED),
    (STICK, (case(stick=5e-4, before=5e-4),), FALSE),  # it never stuck
    (PERIODIC, (case(intervals=CHAOTIC), case(N=300, intervals=DRIFTING)), FALSE),
    (PERIODIC, (case(intervals=CHAOTIC), case(N=300, intervals=REPEATING)), TRUE),
    (PERIODIC, (case(intervals=CHAOTIC), case(N=300, intervals=FEW)), NOT_COMPUTED),
    (PERIODIC, (case(intervals=CHAOTIC), case(N=300, intervals=TOO_FEW)), NOT_COMPUTED),
]


@pytest.mark.parametrize(("title", "data", "verdict"), [*GRID_CASES, *CASES])
def test_conclusions(title: str, data: Any, verdict: str) -> None:
    """By grid studies under their names in config/survival, or by cases."""
    if isinstance(data, dict):
        views = [CaseView(f"survival_{name}", xr.DataTree(grid)) for name, grid in data.items()]
    else:
        views = data
    known = {view.name: view for view in views}
    assert BY_TITLE[title].judge(known, {}, survival.FUNCTIONS).verdict == verdict


# ---- Models


def test_each_model_is_judged_by_its_own_data() -> None:
    """Of one map of growth for all models, with a separation from a stable cycle in one."""
    axes = {}
    for name, values in zip(CHANGED, zip(*MODELS.values(), strict=True), strict=True):
        numbers = [1e-3 * value if isinstance(value, bool) else value for value in values]
        axes[name] = ("model", numbers)
    outcomes = ("qqsqgs", "qqsqgs", "qssqgs", "qqqqgg", "qqsqgs", "qqsqgs", "qqqqgg")
    of_models = [onset(letters, *STABLE_AND_NOT) for letters in outcomes]
    cases = {}
    for part in of_models[0]:
        study = xr.concat([each[part] for each in of_models], "model", combine_attrs="override")
        name = f"survival_{part}"
        cases[name] = CaseView(name, xr.DataTree(study.assign_coords(axes)))
    page, *_ = survival.pages_of(survival.judged(cases))
    rows = page[2].set_index("Conclusion").drop(columns="True if")
    verdicts = dict(zip(BY_TITLE, rows.to_numpy().tolist(), strict=True))
    assert verdicts[ONSET] == [TRUE, TRUE, FALSE, NOT_COMPUTED, TRUE, TRUE, NOT_COMPUTED]
    assert verdicts[CRITICAL] == [NOT_COMPUTED] * 7


def test_a_case_belongs_to_its_own_model() -> None:
    node = case(stick=5e-4).node
    law = {"contact_force": "normal", "contact_compliance": "residual"}
    p = Parameters(N=200, Omega=20, normalization="orthonormal", **law)
    node.attrs["parameters"] = p.canonical_json
    known = survival.by_model({"sticks": CaseView("sticks", node)})
    assert [model for model, cases in known.items() if cases] == ["+ normal contact force"]
