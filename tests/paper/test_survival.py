"""Conclusions under seven models.

Each is judged by made-up data on which it is true, on which it is not, and which do not tell.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from disc_model import Parameters
from disc_model.data.variables import STATUSES
from tests.analysis.test_classify import logistic
from tests.paper.evidence import grid, kept_events
from workflow.paper import survival
from workflow.paper.measures import CaseView
from workflow.paper.model import FALSE, NOT_COMPUTED, PART, TRUE, Answer
from workflow.paper.survival import CHANGED, CONCLUSIONS, MODELS

BY_TITLE = {row.id: row for row in CONCLUSIONS}
CONFIG = Path(__file__).parents[2] / "config"
NAN = float("nan")
POINTS = {"N": [50.0, 385.0], "Omega": [10.0, 20.0, 30.0]}


def judged(title: str, *cases: CaseView, **grids: xr.Dataset) -> Answer:
    """Judge a conclusion by cases, and by grid studies under their names in config/survival."""
    views = {case.name: case for case in cases}
    for short, study in grids.items():
        name = f"survival_{short}"
        views[name] = CaseView(name, xr.DataTree(study))
    return BY_TITLE[title].judge(views, {}, survival.FUNCTIONS)


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
    axes = {"N": [50.0, 100.0, 200.0, 385.0], "horizon": [1000.0], "scan_Omega": [5.0, 24.0]}
    study = grid(
        axes, {"precision": 0.1}, critical_speed=np.array(speeds)[:, None], status=["ok"] * 4
    )
    return {"speed": study}


def damping(
    name: str, without: np.ndarray, damped: np.ndarray, status: str = "ok"
) -> dict[str, xr.Dataset]:
    """Return growth rates over preload and speed without and with one damper.

    Parameters
    ----------
    name : of the damper
    without, damped : the growth rates, 1/s
    status : of points without one
    """
    rates = np.stack([without, damped])
    speeds = np.linspace(10, 50, rates.shape[2])
    study = grid(
        {"c_c_p": [0, 1], "N": [50.0, 385.0], "Omega": speeds},
        growth_rate=rates,
        status=np.where(np.isnan(rates), status, "ok"),
    )
    for damper in ("c", "c_p"):
        with_it = 0.5 * (damper == name)
        study = study.assign_coords({damper: ("c_c_p", [0.0, with_it])})
    return {"damping": study}


def in_plane(damped: np.ndarray, status: str = "ok") -> dict[str, xr.Dataset]:
    """Return the study of the damper in the disc's plane, for `MANY` cycles."""
    columns = damped.shape[1]
    return damping("c_p", MANY[:, :columns], damped, status)


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

GRID_CASES = [
    (ONSET, onset("qqsqgs", *STABLE_AND_NOT), TRUE),
    (ONSET, onset("qssqgs", *STABLE_AND_NOT), FALSE),  # one from a stable cycle
    (ONSET, onset("qqqqgg", *ALL_KNOWN), NOT_COMPUTED),  # nothing separates
    (ONSET, onset("qqsqss", *MORE_STABLE, fold=20.2), FALSE),  # the cycle continues
    (ONSET, onset("qqsqss", *MORE_STABLE, fold=20.05), TRUE),  # a fold just above the speed
    (ONSET, onset("qqsqss", *MORE_STABLE, fold=19.95), FALSE),  # at the speed, the cycle is beyond
    (ONSET, onset("xqsqgs", *MORE_STABLE), NOT_COMPUTED),
    (ONSET, onset("ssssss", *[0.1] * 6), NOT_COMPUTED),  # no cycle is stable
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
    (IN_PLANE, in_plane(MANY - 0.05), FALSE),
    (IN_PLANE, in_plane(raised(1, 0, 0.05)), TRUE),  # a stable cycle grows
    (IN_PLANE, in_plane(raised(1, 0, -0.02)), FALSE),  # it decays more slowly, and is stable still
    (IN_PLANE, in_plane(MANY[:, :3] - 0.05), NOT_COMPUTED),  # few cycles say nothing
    (IN_PLANE, damping("c", GROWING, GROWING), NOT_COMPUTED),  # of the other damper
]


@pytest.mark.parametrize(("title", "grids", "verdict"), GRID_CASES)
def test_conclusions_about_grids(title: str, grids: dict[str, xr.Dataset], verdict: str) -> None:
    assert judged(title, **grids).verdict == verdict


def test_a_map_of_growth_that_lacks_points_decides_nothing() -> None:
    grids = onset("qqsqgs", *MORE_STABLE)
    grids["growth"] = grids["growth"].isel(N=[0])
    assert judged(ONSET, **grids).verdict == NOT_COMPUTED


# ---- Cases


def case(
    *widths: float,
    N: float = 200,
    first: float = 100.0,
    intervals: np.ndarray | None = None,
    stick: float = 0.0,
    before: float = 0.1,
    status: str = "ok",
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
    """
    contact = "bilateral"
    if first:
        contact = "unilateral"
    p = Parameters(N=N, Omega=20, contact=contact)
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
    stages = np.array([0.01, 0.01, *(widths or [1.0] * 4)])
    half = stages[(time // 50).astype(int)] / 2
    history = xr.Dataset(
        {"w_point_min": ("time", -half), "w_point_max": ("time", half)}, {"time": time}
    )

    released = 240 + 60 * stick
    if intervals is None:
        intervals = np.full(4000, 0.01)
    times = 240 + np.cumsum(intervals)
    rows = [(240.0, "slip_to_stick", "stick"), (released, "stick_to_slip", "slip")]
    for separation in times[(times > released) & (times < 299)]:
        rows.append((separation, "separation", "separation"))
        rows.append((separation + 1e-4, "reattachment", "slip"))

    groups = {
        "/": xr.Dataset(scalars, attrs={"parameters": p.canonical_json}),
        "/history": history,
        "/events": kept_events(sorted(rows), 240.0, 300.0),
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
    (SMALLER, (case(1, 1, 1, 1), UNTIL_PARADOX), TRUE),  # bilateral contact grew until the end
    (STICK, (case(stick=5e-4),), TRUE),
    (STICK, (case(stick=5e-4, status="failed"),), NOT_COMPUTED),
    (STICK, (case(stick=5e-4, before=5e-4),), FALSE),  # it never stuck
    (PERIODIC, (case(intervals=CHAOTIC), case(N=300, intervals=DRIFTING)), FALSE),
    (PERIODIC, (case(intervals=CHAOTIC), case(N=300, intervals=REPEATING)), TRUE),
    (PERIODIC, (case(intervals=CHAOTIC), case(N=300, intervals=FEW)), NOT_COMPUTED),
    (PERIODIC, (case(intervals=CHAOTIC), case(N=300, intervals=TOO_FEW)), NOT_COMPUTED),
]


@pytest.mark.parametrize(("title", "cases", "verdict"), CASES)
def test_conclusions_about_cases(title: str, cases: Sequence[CaseView], verdict: str) -> None:
    assert judged(title, *cases).verdict == verdict


@pytest.mark.parametrize(("above", "few"), [(1, True), (3, False)])
def test_a_damper_that_destabilises_a_tenth_of_the_points_does_at_few(
    above: int, few: bool
) -> None:
    rates = MANY - 0.05
    rates[1, :above] = 0.05
    found = judged(IN_PLANE, **in_plane(rates))
    assert found.verdict == TRUE
    assert ("few points only" in found.notes) is few


# ---- Models


def grids_of_all_models() -> dict[str, xr.DataTree]:
    """Return one map of growth for all models, with a separation from a stable cycle in one."""
    coordinates = {}
    for name, values in zip(CHANGED, zip(*MODELS.values(), strict=True), strict=True):
        numbers = [1e-3 * value if isinstance(value, bool) else value for value in values]
        coordinates[name] = ("model", numbers)
    outcomes = ("qqsqgs", "qqsqgs", "qssqgs", "qqqqgg", "qqsqgs", "qqsqgs", "qqqqgg")
    parts = {
        "curves": [curves("fold", 29.0, 29.0)] * len(MODELS),
        "growth": [growth(*STABLE_AND_NOT)] * len(MODELS),
        "outcome": [outcome(letters) for letters in outcomes],
    }
    nodes = {}
    for name, studies in parts.items():
        study = xr.concat(studies, "model", combine_attrs="override")
        nodes[f"survival_{name}"] = xr.DataTree(study.assign_coords(coordinates))
    return nodes


def cases_of_all_models() -> dict[str, xr.DataTree]:
    """Return a case of each model, with shares of stick that differ."""
    shares = (1e-4, 0.01, 1e-4, 6e-4, 0.01, 1e-4, 0.01)
    nodes = {}
    for share, (name, model) in zip(shares, MODELS.items(), strict=True):
        scale, compliant, force, on_surface, stretching = model
        p = Parameters(
            N=200,
            Omega=20,
            normalization=scale,
            contact_force=force,
            contact_compliance="residual" if compliant else 0.0,
            friction_offset="surface" if on_surface else 0.0,
            stretching=stretching,
        )
        node = case(stick=share).node
        root = node.to_dataset().assign_attrs(parameters=p.canonical_json)
        groups = {"/": root, "/events": node["events"].to_dataset()}
        nodes[f"case {name}"] = xr.DataTree.from_dict(groups)
    return nodes


def test_each_model_is_judged_by_its_own_data() -> None:
    nodes = {**grids_of_all_models(), **cases_of_all_models()}
    cases = {name: CaseView(name, node) for name, node in nodes.items()}
    table = survival.judged(cases)
    page, *sections = survival.pages_of(table)
    rows = page[2].set_index("Conclusion").drop(columns="True if")
    verdicts = dict(zip(BY_TITLE, rows.to_numpy().tolist(), strict=True))
    assert verdicts[ONSET] == [TRUE, TRUE, FALSE, NOT_COMPUTED, TRUE, TRUE, NOT_COMPUTED]
    assert verdicts[STICK] == [TRUE, FALSE, TRUE, TRUE, FALSE, TRUE, FALSE]
    assert verdicts[CRITICAL] == [NOT_COMPUTED] * 7

    assert [heading for heading, _, _ in sections] == [*BY_TITLE]
    told = (
        "2 of 6 points separate. Of these points, 1 have an unstable cycle, "
        "1 have none that was found, and 0 have"
    )
    assert sections[0][2]["Found"].iloc[0].startswith(told)
