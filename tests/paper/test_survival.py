"""What survives: every verdict on data made up so that it holds, that it does not, and that they do not tell."""

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
from disc_model.paper.model import FAILS, HOLDS, NOT_COMPUTED, REMARK, UNDECIDED, Finding
from disc_model.paper.survival import CONCLUSIONS, MODELS, Evidence, judge, page_of
from disc_model.studies.study import load_study
from tests.paper.made_up import grid, kept_events, logistic

BY_TITLE = {one.id: one for one in CONCLUSIONS}
CONFIG = Path(__file__).parents[2] / "config"
DIM = "normalization_contact_compliance_contact_force"


def judged(title: str, *cases: CaseView, **grids: xr.Dataset) -> Finding:
    return BY_TITLE[title].judge(Evidence(cases, {f"survival_{name}": grid for name, grid in grids.items()}))


# ----------------------------------------------------------------------------------------------------
# Grids

POINTS = {"N": [50.0, 385.0], "Omega": [10.0, 20.0, 30.0]}


def growth(*rates: float) -> xr.Dataset:
    return grid(POINTS, growth_rate=np.reshape(rates, (2, 3)))


def outcome(letters: str) -> xr.Dataset:
    """A letter for each point: s separates, q is quiet, g grows without, x failed."""
    words = {"s": "separation", "q": "quiet", "g": "growing", "x": "failed"}
    return grid(POINTS, outcome=np.reshape([words[letter] for letter in letters], (2, 3)))


NAN = float("nan")


def onset(letters: str, *rates: float, fold: float = 29.0) -> dict[str, xr.Dataset]:
    return {"outcome": outcome(letters), "growth": growth(*rates), "curves": curves("fold", (fold, fold))}


def curves(
    kind: str, speeds: tuple[float, float], border: str = "yes", status: str = "ok", missed: int = 0
) -> xr.Dataset:
    """One curve from 380 to 390 N, and room for another."""
    return grid(
        {"curve": [0, 1], "curve_point": [0, 1, 2]},
        kind=[kind, "none"],
        x=[[*speeds, NAN], [NAN] * 3],
        y=[[380.0, 390.0, NAN], [NAN] * 3],
        adjoins_stable_cycle=np.full((2, 3), border),
        status=status,
        n_continuation_failures=missed,
    )


QUIET, UNSTABLE = growth(*[-0.1] * 5, 0.1), growth(*[0.1] * 6)


def speeds(*begins: float, status: str = "ok") -> xr.Dataset:
    """At 385 N alone; the second crossing is an end of separation at 15.1 rad/s, which counts for nothing."""
    kinds = [*["begins"] * len(begins), "ends"]
    axes = {"N": [385.0], "horizon": [1000.0], "crossing_number": range(len(kinds))}
    return grid(axes, {"precision": 0.1}, status=[status], crossing=[[[*begins, 15.1]]], crossing_kind=[[kinds]])


def at_fold(found: xr.Dataset, *begins: float, rates: xr.Dataset = QUIET) -> dict[str, xr.Dataset]:
    return {"curves": found, "speed": speeds(*begins), "growth": rates}


def critical(*found: float) -> dict[str, xr.Dataset]:
    axes = {"N": [50.0, 100.0, 200.0, 385.0], "horizon": [1000.0]}
    return {"speed": grid(axes, critical_speed=np.array(found)[:, None], status=["ok"] * 4)}


def damping(name: str, without: np.ndarray, damped: np.ndarray, status: str = "ok") -> dict[str, xr.Dataset]:
    """Growth rates over preload and speed without and with one damper."""
    rates = np.stack([without, damped])
    axes = {"c_c_p": [0, 1], "N": [50.0, 385.0], "Omega": np.linspace(10, 50, rates.shape[2])}
    study = grid(axes, growth_rate=rates, status=np.where(np.isnan(rates), status, "ok"))
    return {"damping": study.assign_coords({each: ("c_c_p", [0.0, 0.5 * (each == name)]) for each in ("c", "c_p")})}


GROWING = np.array([[-0.1, 0.1, 0.2], [0.05, 0.1, NAN]])
MANY = np.tile(np.linspace(-0.1, 0.1, 12), (2, 1))


def raised(row: int, column: int, to: float) -> np.ndarray:
    found = MANY - 0.05
    found[row, column] = to
    return found


ONSET, FOLD, CRITICAL = "Onset", "Fold at N = 385 N", "Critical speed"
NORMAL, IN_PLANE = "Damper normal to the disc", "Damper in the disc's plane"
FAILED = f"{NOT_COMPUTED}: study survival_{{}} has points that failed"
TOO_SHORT = f"{NOT_COMPUTED}: study survival_growth does not reach as far as survival_speed"
NO_PAIR = f"{NOT_COMPUTED}: study survival_damping lacks a pair of points without and with c_p"
FOUND = at_fold(curves("fold", (14.9, 15.2)))


@pytest.mark.parametrize(
    ("title", "grids", "verdict"),
    [
        (ONSET, onset("qqsqgs", -0.1, -0.2, 0.1, -0.1, 0.05, NAN), HOLDS),
        (ONSET, onset("qssqgs", -0.1, -0.2, 0.1, -0.1, 0.05, NAN), FAILS),  # one from a stable cycle
        (ONSET, onset("qssqgs", -0.1, -5e-4, 0.1, -0.1, 0.05, NAN), HOLDS),  # too slow a growth to tell
        (ONSET, onset("qqqqgg", -0.1, -0.2, 0.1, -0.1, 0.05, 0.1), UNDECIDED),  # nothing separates
        (ONSET, onset("ssssss", 0.1, 0.2, 0.1, 0.1, 0.05, 0.1), UNDECIDED),  # nothing is stable
        (ONSET, onset("qqqqqs", -0.1, -0.2, -0.1, -0.1, -0.05, NAN), UNDECIDED),  # only where there is no cycle
        (ONSET, onset("qqsqss", -0.1, -0.2, 0.1, -0.1, -0.05, NAN, fold=20.2), FAILS),  # the cycle continues
        (ONSET, onset("qqsqss", -0.1, -0.2, 0.1, -0.1, -0.05, NAN, fold=19.95), FAILS),  # it begins there
        (ONSET, onset("qqsqgx", -0.1, -0.2, 0.1, -0.1, 0.05, NAN), FAILED.format("outcome")),
        (FOLD, at_fold(curves("fold", (14.9, 15.2)), 15.1), HOLDS),  # at 15.05, within 15.0 .. 15.1
        (FOLD, at_fold(curves("fold", (15.0, 15.28)), 15.1), HOLDS),  # at 15.14
        (FOLD, at_fold(curves("fold", (15.0, 15.34)), 15.1), FAILS),  # at 15.17
        (FOLD, at_fold(curves("fold", (14.9, 15.2), border="no"), 15.1), FAILS),
        (FOLD, at_fold(curves("neutral", (14.9, 15.2)), 15.1), FAILS),
        (FOLD, at_fold(curves("neutral", (14.9, 15.2), missed=2), 15.1), UNDECIDED),  # one of them may be the fold
        # the cycle continues, unstable
        (FOLD, at_fold(curves("neutral", (14.9, 15.2), missed=2), 15.1, rates=UNSTABLE), FAILS),
        (FOLD, at_fold(curves("neutral", (14.9, 15.2), missed=2), 15.1, rates=growth(*[0.1] * 4, NAN, 0.1)), UNDECIDED),
        (FOLD, FOUND, UNDECIDED),
        (FOLD, at_fold(curves("fold", (14.9, 15.2), status="failed"), 15.1), FAILED.format("curves")),
        (FOLD, FOUND | {"speed": speeds(15.1, status="failed")}, FAILED.format("speed")),
        (FOLD, at_fold(curves("neutral", (14, 16)), 35.0), TOO_SHORT),
        (CRITICAL, critical(NAN, 20.0, 12.0, 15.0), HOLDS),
        (CRITICAL, critical(30.0, 20.0, 12.0, NAN), HOLDS),
        (
            CRITICAL,
            critical(30.0, 12.0, 20.0, 14.0),
            UNDECIDED,
        ),  # at the end of the scan it falls again, as in the ledger
        (CRITICAL, critical(30.0, 20.0, 12.0, 12.2), FAILS),  # no more than speeds are known to
        (CRITICAL, critical(NAN, 20.0, 12.0, 11.0), FAILS),
        (CRITICAL, critical(10.0, 11.0, 12.0, 13.0), FAILS),
        (CRITICAL, critical(NAN, 20.0, NAN, 15.0), UNDECIDED),
        (NORMAL, damping("c", GROWING, GROWING - 0.15), HOLDS),
        # a stable one may do as it likes
        (NORMAL, damping("c", GROWING, GROWING + np.array([[0.1, -0.1, -0.1], [-0.1, -0.1, 0.0]])), HOLDS),
        (NORMAL, damping("c", GROWING, GROWING + np.array([[0.0, -0.1, 0.01], [-0.1, -0.1, 0.0]])), FAILS),
        (NORMAL, damping("c", -np.abs(GROWING), GROWING), UNDECIDED),
        (NORMAL, damping("c", GROWING, np.full((2, 3), NAN)), UNDECIDED),
        (IN_PLANE, damping("c_p", MANY, MANY - 0.05), FAILS),
        (IN_PLANE, damping("c_p", MANY, raised(1, 0, 0.05)), REMARK),  # a stable cycle grows
        (IN_PLANE, damping("c_p", MANY, raised(1, 11, 0.15)), REMARK),  # a growing one grows faster
        (IN_PLANE, damping("c_p", MANY, raised(0, 0, 0.05)), FAILS),  # at a small preload only
        (IN_PLANE, damping("c_p", MANY, raised(1, 0, -0.05)), FAILS),  # dies out more slowly, but does
        (IN_PLANE, damping("c_p", MANY, raised(1, 0, NAN), "no_cycle"), REMARK),
        # it slides, which is no instability
        (IN_PLANE, damping("c_p", MANY, raised(1, 0, NAN), "no_stick_slip"), FAILS),
        (IN_PLANE, damping("c_p", MANY, raised(1, 11, NAN), "no_cycle"), FAILS),  # it was not stable without, either
        (IN_PLANE, damping("c_p", MANY[:, :3], MANY[:, :3] - 0.05), UNDECIDED),  # few cycles say nothing
        (IN_PLANE, damping("c", MANY, MANY), NO_PAIR),
    ],
)
def test_conclusions_about_grids(title: str, grids: dict[str, xr.Dataset], verdict: str) -> None:
    assert judged(title, **grids).verdict == verdict


def test_onset_needs_growth_at_every_point() -> None:
    rates = growth(-0.1, -0.2, 0.1, -0.1, 0.05, NAN)
    found = judged(ONSET, outcome=outcome("qqsqgs"), growth=rates.isel(Omega=[0, 1]))
    assert found.verdict.startswith(f"{NOT_COMPUTED}: study survival_growth lacks points of survival_outcome")
    assert judged(ONSET, outcome=outcome("qqsqgs")).verdict.startswith(f"{NOT_COMPUTED}: study survival_growth")


def test_separation_just_below_a_fold_is_a_remark() -> None:
    found = judged(ONSET, **onset("qqsqss", -0.1, -0.2, 0.1, -0.1, -0.05, NAN, fold=20.05))
    assert found.verdict == REMARK
    assert found.remark.endswith("at a fold, too: 385 N, 20 rad/s")


# ----------------------------------------------------------------------------------------------------
# Cases


def case(
    *,
    N: float = 200,
    bonded: bool = False,
    first: float = 100.0,
    widths: Sequence[float] = (1.0, 1.0, 1.0, 1.0),
    intervals: np.ndarray | None = None,
    stick: float = 0.0,
    before: float = 0.1,
    status: str = "ok",
) -> CaseView:
    """A run of 300 s; widths of the disc's motion in quarters of the time after 100 s, each of 50 s.

    intervals : s, between separations of the last 60 s; stick : share of those 60 s
    """
    p = Parameters(N=N, Omega=20, contact="bonded" if bonded else "separable")
    t = np.arange(0.25, 300, 0.5)
    width = np.array([0.01, 0.01, *widths])[(t // 50).astype(int)]
    history = xr.Dataset({"w_point_min": ("time", -width / 2), "w_point_max": ("time", width / 2)}, {"time": t})
    times = 240 + np.cumsum(np.full(4000, 0.01) if intervals is None else intervals)
    released = 240 + 60 * stick
    times = times[(times > released) & (times < 299)]
    rows = [(240.0, "slip_to_stick", "stick"), (released, "stick_to_slip", "slip")]
    rows += [row for at in times for row in ((at, "separation", "separation"), (at + 1e-4, "reattachment", "slip"))]
    events = kept_events(sorted(rows), 240.0, 300.0)
    scalars = {
        "N": N,
        "Omega": 20.0,
        "status": STATUSES.index(status),
        "first_separation": NAN if bonded else first,
        "n_separations": 0 if bonded or np.isnan(first) else 5,
        "time_reached": 300.0,
        "time_stick": 300 * before,
    }
    root = xr.Dataset(scalars, attrs={"parameters": p.canonical_json})
    return CaseView(f"case{N:g}{bonded}", xr.DataTree.from_dict({"/": root, "/history": history, "/events": events}))


def free(*widths: float, N: float = 200) -> CaseView:
    return case(N=N, widths=widths)


BONDED = case(bonded=True, widths=(3.0, 3.0, 3.0, 3.0))
REPEATING = np.tile([0.01, 0.012, 0.011], 2000)
DRIFTING = 0.01 * (1 + 0.1 * np.sin(2.399963 * np.arange(6000)))
CHAOTIC = 0.01 * (1 + 0.3 * logistic(6000))


@pytest.mark.parametrize(
    ("title", "cases", "verdict"),
    [
        ("Smaller vibration", (free(1, 1, 1, 1.1), BONDED), HOLDS),
        ("Smaller vibration", (free(9, 1, 1, 1.1), BONDED), HOLDS),  # what is early does not count
        ("Smaller vibration", (free(1, 1, 1, 1.3), BONDED), UNDECIDED),  # it still grows
        ("Smaller vibration", (free(1, 1, 4, 4), BONDED), FAILS),
        ("Smaller vibration", (free(1, 1, 4, 2), BONDED), UNDECIDED),  # it wanders across
        ("Smaller vibration", (free(1, 1, 1, 1), BONDED, free(4, 4, 4, 4, N=300), case(N=300, bonded=True)), FAILS),
        ("Smaller vibration", (case(first=NAN), BONDED), UNDECIDED),  # nothing separates
        ("Smaller vibration", (free(1, 1, 1, 1),), UNDECIDED),  # nothing to compare with
        ("Smaller vibration", (case(status="failed"), BONDED), f"{NOT_COMPUTED}: failed (case case200False)"),
        ("Stick vanishes", (case(stick=5e-4),), HOLDS),
        ("Stick vanishes", (case(stick=5e-4), case(N=300, stick=0.01)), REMARK),
        ("Stick vanishes", (case(stick=0.01),), FAILS),
        ("Stick vanishes", (case(stick=5e-4, before=5e-4),), FAILS),  # it never stuck
        ("Stick vanishes", (case(first=NAN),), UNDECIDED),
        ("Not periodic afterwards", (case(intervals=DRIFTING),), HOLDS),
        ("Not periodic afterwards", (case(intervals=CHAOTIC), case(N=300, intervals=DRIFTING)), HOLDS),
        ("Not periodic afterwards", (case(intervals=CHAOTIC), case(N=300, intervals=REPEATING)), FAILS),
        ("Not periodic afterwards", (case(intervals=CHAOTIC), case(N=300, intervals=np.full(20, 2.0))), UNDECIDED),
        ("Not periodic afterwards", (case(first=NAN),), UNDECIDED),
    ],
)
def test_conclusions_about_cases(title: str, cases: Sequence[CaseView], verdict: str) -> None:
    assert judged(title, *cases).verdict == verdict


def test_a_period_is_said() -> None:
    found = judged("Not periodic afterwards", case(intervals=REPEATING))
    assert found.ours == "200 N, 20 rad/s: repeats after 3 separations = 0.033 s"


# ----------------------------------------------------------------------------------------------------
# All of it


def test_each_model_is_judged_by_its_own_data() -> None:
    """One map of growth for all four: separations from a stable cycle in one of them only."""
    models = {
        "normalization": (DIM, [model.normalization for model in MODELS]),
        "contact_compliance": (DIM, [3e-7 * model.compliant for model in MODELS]),
        "contact_force": (DIM, [model.contact_force for model in MODELS]),
    }
    rates = growth(-0.1, -0.2, 0.1, -0.1, 0.05, NAN)
    apart = [outcome("qqsqgs"), outcome("qqsqgs"), outcome("qssqgs"), outcome("qqqqgg")]
    grids = {
        "survival_curves": xr.concat([curves("fold", (29.0, 29.0))] * 4, DIM).assign_coords(models),
        "survival_growth": xr.concat([rates] * 4, DIM).assign_coords(models),
        "survival_outcome": xr.concat(apart, DIM, combine_attrs="override").assign_coords(models),
    }
    first = Parameters(N=200, Omega=20)
    cases = {}
    for i, model in enumerate(MODELS):
        p = first.replace(
            normalization=model.normalization,
            contact_compliance="residual" if model.compliant else 0.0,
            contact_force=model.contact_force,
        )
        node = case(stick=(1e-4, 0.01, 1e-4, 6e-4)[i]).node
        cases[f"/case{i}"] = node.to_dataset().assign_attrs(parameters=p.canonical_json)
        cases[f"/case{i}/events"] = node["events"].to_dataset()
    table = judge(xr.DataTree.from_dict(cases), grids)
    verdicts = table.pivot(index="conclusion", columns="model", values="verdict")[[model.name for model in MODELS]]
    assert [*verdicts.loc["Onset"]] == [HOLDS, HOLDS, FAILS, UNDECIDED]
    assert [*verdicts.loc["Stick vanishes"]] == [HOLDS, FAILS, HOLDS, UNDECIDED]  # half a bound is as good
    assert verdicts.loc["Critical speed"].str.startswith(NOT_COMPUTED).all()
    page = page_of(table)
    assert [heading for heading, _, _ in page.sections] == ["At a glance", *BY_TITLE]
    assert page.sections[0][2].shape == (len(CONCLUSIONS), 2 + len(MODELS))
    assert "from a stable one" in page.markdown()
    assert "<h2>Onset</h2>" in page.html()


def test_the_files_ask_for_the_four_models() -> None:
    study = load_study(CONFIG / "survival.yaml")
    views = {(spec.parameters.N, spec.parameters.Omega, spec.parameters.contact) for spec in study.specs.values()}
    assert len(study.specs) == len(MODELS) * len(views)
    flexible = Parameters(N=200, Omega=20, normalization="orthonormal")
    found = residual_flexibility(flexible)
    for name in SURVIVAL_GRIDS:
        raw = yaml.safe_load((CONFIG / "survival" / f"{name}.yaml").read_text())
        zips = raw["zip"] if isinstance(raw["zip"], list) else [raw["zip"]]
        (models,) = [one for one in zips if "normalization" in one]
        rows = list(zip(*models.values(), strict=True))
        for model, (normalization, compliance, force) in zip(MODELS, rows, strict=True):
            assert (normalization, compliance != 0, force) == model[1:]
            assert compliance == pytest.approx((found.total - found.kept) * model.compliant, rel=1e-12)
