"""Conclusions under five models: each on data made up so that it is true, that it is not, or that
they do not tell."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
import yaml

from disc_model import Parameters, residual_flexibility
from disc_model.data.variables import STATUSES
from disc_model.paper import SURVIVAL_GRIDS
from disc_model.paper.measures import CaseView
from disc_model.paper.model import FALSE, NOT_COMPUTED, PART, TRUE, Answer, judge
from disc_model.paper.survival import CHANGED, CONCLUSIONS, MODELS, by_model, evidence_of, page_of
from disc_model.studies.study import load_study
from tests.analysis.test_classify import logistic
from tests.paper.evidence import grid, kept_events

BY_TITLE = {row.id: row for row in CONCLUSIONS}
CONFIG = Path(__file__).parents[2] / "config"
NAN = float("nan")
POINTS = {"N": [50.0, 385.0], "Omega": [10.0, 20.0, 30.0]}


def judged(title: str, *cases: CaseView, **grids: xr.Dataset) -> Answer:
    studies = {f"survival_{name}": xr.DataTree(study) for name, study in grids.items()}
    views = {name: CaseView(name, node) for name, node in studies.items()}
    return BY_TITLE[title].judge({case.name: case for case in cases} | views)


# ------------------------------------------------------------------------ Grids
def growth(*rates: float) -> xr.Dataset:
    return grid(POINTS, growth_rate=np.reshape(rates, (2, 3)))


def outcome(letters: str) -> xr.Dataset:
    """A letter for each point: s separates, q is quiet, g grows without, x failed."""
    words = {"s": "separation", "q": "quiet", "g": "growing", "x": "failed"}
    return grid(POINTS, outcome=np.reshape([words[letter] for letter in letters], (2, 3)))


def curves(kind: str, *speeds: float, border: str = "yes", missed: int = 0) -> xr.Dataset:
    """One curve from 380 to 390 N, and room for another."""
    axes = {"curve": [0, 1], "curve_point": [0, 1, 2]}
    x, y = [[*speeds, NAN], [NAN] * 3], [[380.0, 390.0, NAN], [NAN] * 3]
    borders = np.full((2, 3), border)
    return grid(
        axes,
        kind=[kind, "none"],
        x=x,
        y=y,
        adjoins_stable_cycle=borders,
        status="ok",
        n_continuation_failures=missed,
    )


def onset(letters: str, *rates: float, fold: float = 29.0) -> dict[str, xr.Dataset]:
    return {
        "outcome": outcome(letters),
        "growth": growth(*rates),
        "curves": curves("fold", fold, fold),
    }


def at_fold(found: xr.Dataset, *begins: float, rate: float = -0.1) -> dict[str, xr.Dataset]:
    """Speeds of separation at 385 N; the last crossing is an end of separation, which counts for
    nothing."""
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
    axes = {"N": [50.0, 100.0, 200.0, 385.0], "horizon": [1000.0], "scan_Omega": [5.0, 24.0]}
    return {
        "speed": grid(
            axes, {"precision": 0.1}, critical_speed=np.array(speeds)[:, None], status=["ok"] * 4
        )
    }


def damping(
    name: str, without: np.ndarray, damped: np.ndarray, status: str = "ok"
) -> dict[str, xr.Dataset]:
    """Growth rates over preload and speed without and with one damper."""
    rates = np.stack([without, damped])
    axes = {"c_c_p": [0, 1], "N": [50.0, 385.0], "Omega": np.linspace(10, 50, rates.shape[2])}
    study = grid(axes, growth_rate=rates, status=np.where(np.isnan(rates), status, "ok"))
    return {
        "damping": study.assign_coords(
            {each: ("c_c_p", [0.0, 0.5 * (each == name)]) for each in ("c", "c_p")}
        )
    }


GROWING = np.array([[-0.1, 0.1, 0.2], [0.05, 0.1, NAN]])
MANY = np.tile(np.linspace(-0.1, 0.1, 12), (2, 1))


def raised(row: int, column: int, to: float) -> np.ndarray:
    rates = MANY - 0.05
    rates[row, column] = to
    return rates


ONSET, FOLD, CRITICAL = "Onset", "Fold at N = 385 N", "Critical speed"
NORMAL, IN_PLANE = "Damper normal to the disc", "Damper in the disc's plane"
BESIDE = (-0.1, -0.2, 0.1, -0.1, -0.05, NAN)


@pytest.mark.parametrize(
    ("title", "grids", "verdict"),
    [
        (ONSET, onset("qqsqgs", -0.1, -0.2, 0.1, -0.1, 0.05, NAN), TRUE),
        (
            ONSET,
            onset("qssqgs", -0.1, -0.2, 0.1, -0.1, 0.05, NAN),
            FALSE,
        ),  # one from a stable cycle
        (
            ONSET,
            onset("qqqqgg", -0.1, -0.2, 0.1, -0.1, 0.05, 0.1),
            NOT_COMPUTED,
        ),  # nothing separates
        (ONSET, onset("qqsqss", *BESIDE, fold=20.2), FALSE),  # the cycle continues
        (FOLD, at_fold(curves("fold", 14.9, 15.2), 15.1), TRUE),  # at 15.05, within 15.0 .. 15.1
        (FOLD, at_fold(curves("fold", 15.0, 15.34), 15.1), FALSE),  # at 15.17
        (
            FOLD,
            at_fold(curves("neutral", 14.9, 15.2, missed=2), 15.1),
            NOT_COMPUTED,
        ),  # one of them may be the fold
        (
            FOLD,
            at_fold(curves("neutral", 14.9, 15.2, missed=2), 15.1, rate=0.1),
            FALSE,
        ),  # the cycle goes on, unstable
        (ONSET, onset("xqsqgs", *BESIDE), NOT_COMPUTED),
        (ONSET, onset("qqsqgs", *BESIDE) | {"growth": growth(*BESIDE).isel(N=[0])}, NOT_COMPUTED),
        (FOLD, at_fold(curves("fold", 14.9, 15.2)), NOT_COMPUTED),  # separation begins nowhere
        (
            FOLD,
            at_fold(curves("fold", 14.9, 15.2), 40.0),
            NOT_COMPUTED,
        ),  # where no growth rate is known
        (
            FOLD,
            at_fold(curves("fold", 14.9, 15.2).assign(grid({}, status="failed")), 15.1),
            NOT_COMPUTED,
        ),
        (IN_PLANE, damping("c", GROWING, GROWING), NOT_COMPUTED),  # of the other damper
        (CRITICAL, critical(30.0, 20.0, 12.0, NAN), TRUE),
        (CRITICAL, critical(30.0, 12.0, 20.0, 14.0), PART),  # at the end of the scan it falls again
        (CRITICAL, critical(30.0, 20.0, 12.0, 12.2), FALSE),  # no more than speeds are known to
        (NORMAL, damping("c", GROWING, GROWING - 0.15), TRUE),
        # a stable one may do as it likes
        (
            NORMAL,
            damping("c", GROWING, GROWING + np.array([[0.1, -0.1, -0.1], [-0.1, -0.1, 0.0]])),
            TRUE,
        ),
        (
            NORMAL,
            damping("c", GROWING, GROWING + np.array([[0.0, -0.1, 0.01], [-0.1, -0.1, 0.0]])),
            FALSE,
        ),
        (IN_PLANE, damping("c_p", MANY, MANY - 0.05), FALSE),
        (IN_PLANE, damping("c_p", MANY, raised(1, 0, 0.05)), TRUE),  # a stable cycle grows
        (IN_PLANE, damping("c_p", MANY, raised(1, 0, NAN), "no_cycle"), TRUE),
        (
            IN_PLANE,
            damping("c_p", MANY[:, :3], MANY[:, :3] - 0.05),
            NOT_COMPUTED,
        ),  # few cycles say nothing
    ],
)
def test_conclusions_about_grids(title: str, grids: dict[str, xr.Dataset], verdict: str) -> None:
    assert judged(title, **grids).verdict == verdict


# ------------------------------------------------------------------------ Cases
def case(
    *widths: float,
    N: float = 200,
    first: float = 100.0,
    intervals: np.ndarray | None = None,
    stick: float = 0.0,
    before: float = 0.1,
    status: str = "ok",
) -> CaseView:
    """A run of 300 s; widths of the disc's motion in quarters of the time after 100 s, each of 50
    s.

    first : s, of the separation; 0 where separation is ignored
    intervals : s, between separations of the last 60 s; stick : share of those 60 s
    """
    p = Parameters(N=N, Omega=20, contact="unilateral" if first else "bilateral")
    t = np.arange(0.25, 300, 0.5)
    width = np.array([0.01, 0.01, *(widths or [1.0] * 4)])[(t // 50).astype(int)]
    history = xr.Dataset(
        {"w_point_min": ("time", -width / 2), "w_point_max": ("time", width / 2)}, {"time": t}
    )
    released = 240 + 60 * stick
    times = 240 + np.cumsum(np.full(4000, 0.01) if intervals is None else intervals)
    rows = [(240.0, "slip_to_stick", "stick"), (released, "stick_to_slip", "slip")]
    for time in times[(times > released) & (times < 299)]:
        rows += [(time, "separation", "separation"), (time + 1e-4, "reattachment", "slip")]
    scalars = {
        "N": N,
        "Omega": 20.0,
        "status": STATUSES.index(status),
        "first_separation": first or NAN,
    }
    scalars |= {"n_separations": 5 * (first > 0), "time_reached": 300.0, "time_stick": 300 * before}
    root = xr.Dataset(scalars, attrs={"parameters": p.canonical_json})
    groups = {"/": root, "/history": history, "/events": kept_events(sorted(rows), 240.0, 300.0)}
    return CaseView(f"case{N:g}{first:g}", xr.DataTree.from_dict(groups))


BONDED = case(3, 3, 3, 3, first=0)
REPEATING = np.tile([0.01, 0.012, 0.011], 2000)
DRIFTING = 0.01 * (1 + 0.1 * np.sin(2.399963 * np.arange(6000)))
CHAOTIC = 0.01 * (0.7 + 0.6 * logistic(4.0, 8000))
SMALLER, STICK, PERIODIC = "Smaller vibration", "Stick vanishes", "Not periodic afterwards"


@pytest.mark.parametrize(
    ("title", "cases", "verdict"),
    [
        (SMALLER, (case(9, 1, 1, 1.05), BONDED), TRUE),  # what is early does not count
        (SMALLER, (case(1, 1, 1, 1.3), BONDED), NOT_COMPUTED),  # it still grows
        (SMALLER, (case(1, 1, 4, 4), BONDED), FALSE),
        (
            SMALLER,
            (case(1, 1, 1, 1), case(1, 1, 1, 3, first=0, status="paradox")),
            TRUE,
        ),  # it grew until the end
        (STICK, (case(stick=5e-4),), TRUE),
        (STICK, (case(stick=5e-4, status="failed"),), NOT_COMPUTED),
        (STICK, (case(stick=5e-4, before=5e-4),), FALSE),  # it never stuck
        (PERIODIC, (case(intervals=CHAOTIC), case(N=300, intervals=DRIFTING)), TRUE),
        (PERIODIC, (case(intervals=CHAOTIC), case(N=300, intervals=REPEATING)), FALSE),
        (
            PERIODIC,
            (case(intervals=CHAOTIC), case(N=300, intervals=np.full(20, 2.0))),
            NOT_COMPUTED,
        ),
    ],
)
def test_conclusions_about_cases(title: str, cases: Sequence[CaseView], verdict: str) -> None:
    assert judged(title, *cases).verdict == verdict


# ------------------------------------------------------------------------ Models
def test_each_model_is_judged_by_its_own_data() -> None:
    """One map of growth for all: separations from a stable cycle in one of them only."""
    models = {}
    for name, values in zip(CHANGED, zip(*MODELS.values(), strict=True), strict=True):
        models[name] = (
            "model",
            [1e-3 * value if isinstance(value, bool) else value for value in values],
        )
    apart = [outcome(letters) for letters in ("qqsqgs", "qqsqgs", "qssqgs", "qqqqgg", "qqsqgs")]
    rates = growth(-0.1, -0.2, 0.1, -0.1, 0.05, NAN)
    parts = {"curves": [curves("fold", 29.0, 29.0)] * 5, "growth": [rates] * 5, "outcome": apart}
    nodes = {
        f"survival_{name}": xr.DataTree(
            xr.concat(each, "model", combine_attrs="override").assign_coords(models)
        )
        for name, each in parts.items()
    }
    for share, (scale, give, force, bends) in zip(
        (1e-4, 0.01, 1e-4, 6e-4, 0.01), MODELS.values(), strict=True
    ):
        p = Parameters(N=200, Omega=20, normalization=scale, contact_force=force)
        p = p.replace(
            contact_compliance="residual" if give else 0.0,
            friction_offset="surface" if bends else 0.0,
        )
        node = case(stick=share).node
        root = node.to_dataset().assign_attrs(parameters=p.canonical_json)
        groups = {"/": root, "/events": node["events"].to_dataset()}
        nodes[f"case{share}{force}{give}{bends}"] = xr.DataTree.from_dict(groups)
    table = judge(
        CONCLUSIONS, by_model({name: CaseView(name, node) for name, node in nodes.items()})
    )
    rows = page_of(table)[2].set_index("Conclusion").drop(columns="True if")
    verdicts = dict(zip(BY_TITLE, rows.to_numpy().tolist(), strict=True))
    assert verdicts["Onset"] == [TRUE, TRUE, FALSE, NOT_COMPUTED, TRUE]
    assert verdicts[STICK] == [TRUE, FALSE, TRUE, TRUE, FALSE]
    assert verdicts[CRITICAL] == [NOT_COMPUTED] * 5
    headings, _, sections = zip(*evidence_of(table), strict=True)
    assert [*headings] == [*BY_TITLE]
    told = "2 of 6 points separate. Of these points, 1 have an unstable cycle, 1 have none that was found, and 0 have"
    assert sections[0]["Found"].iloc[0].startswith(told)


def test_the_files_ask_for_the_five_models() -> None:
    study = load_study(CONFIG / "survival.yaml")
    kinds = {
        (spec.parameters.N, spec.parameters.Omega, spec.parameters.contact)
        for spec in study.specs.values()
    }
    assert len(study.specs) == len(MODELS) * len(kinds)
    asked = {
        tuple(getattr(spec.parameters, name) for name in CHANGED) for spec in study.specs.values()
    }
    assert {(scale, give != 0, force, offset != 0) for scale, give, force, offset in asked} == {
        *MODELS.values()
    }
    plate = residual_flexibility(Parameters(N=200, Omega=20, normalization="orthonormal"))
    for name in SURVIVAL_GRIDS:
        raw = yaml.safe_load((CONFIG / "survival" / f"{name}.yaml").read_text())
        zips = raw["zip"] if isinstance(raw["zip"], list) else [raw["zip"]]
        (models,) = [columns for columns in zips if "normalization" in columns]
        points = zip(*(models[parameter] for parameter in CHANGED), strict=True)
        for model, (scale, compliance, force, offset) in zip(MODELS.values(), points, strict=True):
            assert (scale, compliance != 0, force, offset != 0) == model
            assert compliance == pytest.approx((plate.total - plate.kept) * model[1], rel=1e-12)
            assert offset == Parameters(N=200, Omega=20).h / 2 * model[3]
