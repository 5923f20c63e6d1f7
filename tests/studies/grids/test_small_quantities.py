"""What quantities make of followed motions, sweeps and curves: from stand-ins whose outcome is known."""

from __future__ import annotations

import json
import math
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.errors import DiscModelError
from disc_model.figures.grids import bifurcation as attractors
from disc_model.figures.grids import critical_speed as curves
from disc_model.figures.grids import stability_map as maps
from disc_model.figures.grids import thresholds
from disc_model.figures.grids.kinds import Bifurcation, CriticalSpeed, GrowthMap, Mark, StabilityMap, Thresholds
from disc_model.figures.style import save
from disc_model.parameters import Parameters
from disc_model.stability import settling
from disc_model.stability.settling import Late
from disc_model.status import Status
from disc_model.studies.grids.merge import merge_batches
from disc_model.studies.grids.quantities import critical_speed, hysteresis, outcome
from disc_model.studies.grids.quantities.schema import (
    QUANTITIES,
    CriticalSpeedOptions,
    HysteresisOptions,
    OutcomeOptions,
)
from disc_model.studies.grids.quantities.table import STATUSES, compute
from disc_model.studies.grids.run import run_batch
from disc_model.studies.grids.schema import parse_grid
from tests.stability.toy_map import fold_at, outside, toy

__all__ = ["toy"]
SMALL = {"n_diameters": 1}


def computed(**raw) -> xr.Dataset:
    study = parse_grid({"study": "small", **raw})
    return merge_batches([run_batch(text) for text in study.batches.values()], study.grid, {})


# ---- outcome


@pytest.fixture
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(settling, "FIRST_PROBE", 0.2)


@pytest.mark.usefixtures("impatient")
def test_outcomes_of_a_damped_and_of_a_separating_motion() -> None:
    options = {"horizon": 3.0, "late": 0.05, "after_separation": 0.05, "tol": 1e-9}
    damped = computed(
        quantity="outcome", options=options, base=SMALL | {"c": 20.0, "D_star": 1e-3}, axes={"N": [200], "Omega": [20]}
    ).squeeze()
    assert flag_names(damped["outcome"]) == "stable"
    assert damped["settled"] == damped["time_reached"] < 3.0
    assert damped["distance"] < 1e-4
    assert damped["difference_rate"] < 0
    # the late stretch is the cycle itself
    assert damped["share_stick"] + damped["share_slip"] == pytest.approx(1)
    base = SMALL | {"mu_s": 1.4, "mu_k": 0.2, "k": 0}
    apart = computed(quantity="outcome", options=options, base=base, axes={"N": [700], "Omega": [50]}).squeeze()
    assert flag_names(apart["outcome"]) == "separation"
    assert apart["time_reached"] == pytest.approx(float(apart["first_separation"]) + 0.05)
    assert np.isnan(apart["settled"])
    assert apart["P_min"] == 0


def test_growth_without_separation_is_unstable(monkeypatch: pytest.MonkeyPatch) -> None:
    def followed(status: Status, growing: bool) -> SimpleNamespace:
        state = SimpleNamespace(time=7.0)
        return SimpleNamespace(
            result=SimpleNamespace(status=status, message="why", final_state=state),
            settling=SimpleNamespace(growing=growing, rate=0.1, differences=[0.5]),
            orbit=None, late=None, settled=False, first_separation=math.nan, simulated=7.0,
        )  # fmt: skip

    for status, growing, expected in (
        (Status.OK, True, "unstable"),
        (Status.OK, False, "stable"),
        (Status.STEP_LIMIT, True, "unknown"),
    ):
        monkeypatch.setattr(outcome, "follow", lambda *_, s=status, g=growing, **__: followed(s, g))
        table = compute(outcome, [Parameters(N=1, Omega=1)], OutcomeOptions(horizon=9))
        assert outcome.OUTCOMES[table.arrays["outcome"][0]] == expected
        assert table.arrays["difference"][0] == 0.5
        assert list(table.messages) == ["why" if status is Status.STEP_LIMIT else ""]


# ---- thresholds


def separates_at(p: Parameters) -> float:
    """First separation, s: never below 12.35 rad/s nor from 14.15 to 14.45, sooner at higher speed and load."""
    if p.Omega < 12.35 or 14.15 < p.Omega < 14.45:
        return math.inf
    return 2e5 / p.N - 50 * (p.Omega - 12)


SCAN = {"start": 12, "stop": 15, "step": 0.5}


@pytest.fixture
def fake_motions(monkeypatch: pytest.MonkeyPatch) -> None:
    def follow(p, horizon, **_):
        first = separates_at(p)
        end = min(first, horizon)
        status = Status.STOPPED if first <= horizon else Status.OK
        return SimpleNamespace(
            result=SimpleNamespace(status=status, message=""), simulated=end,
            first_separation=first if first <= horizon else math.nan,
        )  # fmt: skip

    def late_stretch(p, state, duration, late, tol):
        """Separation begins at 14 rad/s on the way up, and stays down to 13."""
        apart = p.Omega >= 14 or (state is not None and state and p.Omega >= 13)
        share = 0.25 if apart else 0.0
        values = dict.fromkeys(Late.__dataclass_fields__, 0.0)
        found = Late(**values | {"share_separation": share, "share_slip": 1 - share, "separation_rate": 40 * share})
        return SimpleNamespace(final_state=apart, status=Status.OK, message=""), found

    monkeypatch.setattr(critical_speed, "follow", follow)
    monkeypatch.setattr(hysteresis, "late_stretch", late_stretch)


@pytest.fixture
def speeds(fake_motions: None) -> xr.Dataset:
    options = {"horizons": [900, 1000], "scan": SCAN, "precision": 0.1}
    return computed(
        quantity="critical_speed", options=options, axes={"N": [200, 400], "normalization": ["as_published"]}
    )


@pytest.fixture
def sweep(fake_motions: None) -> xr.Dataset:
    options = {"scan": SCAN, "dwell": 60, "late": 2}
    return computed(quantity="hysteresis", options=options, axes={"N": [200, 400], "normalization": ["as_published"]})


def test_every_crossing_is_found(speeds: xr.Dataset) -> None:
    one = speeds.squeeze("normalization")
    longest = one.sel(horizon=1000)
    # 2e5/200 = 1000 s at 12 rad/s: from 12.4 on it is less
    assert longest["critical_speed"].values.tolist() == [12.4, 12.4]
    assert longest["n_crossings"].values.tolist() == [1, 1]
    kinds = flag_names(longest["crossing_kind"].sel(N=200))
    assert kinds[:2].tolist() == ["begins", "none"]
    # at 200 N 900 s are reached at 14 rad/s only; then comes the gap, which the scan of 0.5 rad/s steps over
    shorter = one.sel(horizon=900, N=200)
    assert shorter["critical_speed"] == 14.0
    assert one["simulations"].sel(N=200) > 7
    assert flag_names(one["status"]).tolist() == ["ok", "ok"]


def test_hysteresis_is_the_gap_between_the_ways(sweep: xr.Dataset) -> None:
    one = sweep.squeeze("normalization").sel(N=200)
    assert one["onset"] == 14.0
    assert one["persists_to"] == 13.0
    assert (one["separation_rate"].sel(direction="up") > 0).values.tolist() == [False] * 4 + [True] * 3
    assert (one["separation_rate"].sel(direction="down") > 0).values.tolist() == [False] * 2 + [True] * 5


def test_a_sweep_that_cannot_go_on_says_where(monkeypatch: pytest.MonkeyPatch) -> None:
    def late_stretch(p, state, *_):
        failed = p.Omega > 13
        result = SimpleNamespace(status=Status.PARADOX if failed else Status.OK, message="why", final_state=state)
        return result, None if failed else Late(1, 2, 3, 4, 0.5, 0.5, 0, 0)

    monkeypatch.setattr(hysteresis, "late_stretch", late_stretch)
    options = HysteresisOptions.model_validate({"scan": SCAN, "dwell": 60, "late": 2})
    table = compute(hysteresis, [Parameters(N=200, Omega=0)], options)
    assert list(table.messages) == ["Omega=13.5: why"]
    statuses = [[hysteresis.STATUSES[i] for i in row] for row in table.arrays["sweep_status"][0]]
    assert statuses == [["ok", "ok", "ok", "paradox", "failed", "failed", "failed"], ["failed"] * 7]
    assert np.isnan(table.arrays["P_min"][0, 0, 3:]).all()
    assert np.isnan(table.arrays["onset"][0])


@pytest.mark.parametrize(("breaks_at", "persists_to"), [(13.5, math.nan), (12.5, math.nan), (12.0, 13.0)])
def test_a_sweep_that_breaks_off_on_the_way_down_says_what_it_has_seen(
    breaks_at: float, persists_to: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Separation begins at 14 rad/s and persists to 13."""

    def late_stretch(p, state, *_):
        down = bool(state) and (state == "down" or p.Omega == 15)
        failed = down and p.Omega == breaks_at
        rate = float(p.Omega >= (13 if down else 14))
        end = "down" if down or p.Omega == 15 else "up"
        result = SimpleNamespace(status=Status.STALLED if failed else Status.OK, message="why", final_state=end)
        return result, None if failed else Late(1, 2, 3, 4, 0.5, 0.5, 0, rate)

    monkeypatch.setattr(hysteresis, "late_stretch", late_stretch)
    options = HysteresisOptions.model_validate({"scan": SCAN, "dwell": 60, "late": 2})
    found = compute(hysteresis, [Parameters(N=200, Omega=0)], options).arrays
    assert found["onset"][0] == 14.0
    assert found["persists_to"][0] == pytest.approx(persists_to, nan_ok=True)
    assert hysteresis.STATUSES[found["status"][0]] == "stalled"


@pytest.mark.parametrize(("fails_at", "lowest", "crossings"), [(None, 12.4, 1), (13.0, 12.4, 1), (12.0, math.nan, 0)])
def test_a_run_that_breaks_off_is_no_quiet_run(
    fails_at: float | None, lowest: float, crossings: int, fake_motions: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = critical_speed.follow

    def follow(p, horizon, **more):
        if p.Omega != fails_at:
            return whole(p, horizon, **more)
        result = SimpleNamespace(status=Status.PARADOX, message="why")
        return SimpleNamespace(result=result, simulated=1.0, first_separation=math.nan)

    monkeypatch.setattr(critical_speed, "follow", follow)
    options = CriticalSpeedOptions.model_validate({"horizons": [1000], "scan": SCAN | {"stop": 14}})
    found = compute(critical_speed, [Parameters(N=400, Omega=0)], options).arrays
    assert found["critical_speed"][0, 0] == pytest.approx(lowest, nan_ok=True)
    assert found["n_crossings"][0, 0] == crossings == np.isfinite(found["crossing"]).sum()
    status = STATUSES[found["status"][0]]
    assert status == ("ok" if fails_at is None else "paradox")
    assert {STATUSES[i] for i in found["scan_status"][0]} == {"ok", status}


class Unmade(DiscModelError):
    """A point that could not be made."""


@pytest.mark.parametrize(
    ("quantity", "options", "statuses"),
    [
        (critical_speed, {"horizons": [900], "scan": SCAN}, {"status", "scan_status"}),
        (hysteresis, {"scan": SCAN, "dwell": 60}, {"status", "sweep_status"}),
        (outcome, {"horizon": 9}, {"status"}),
    ],
    ids=["critical_speed", "hysteresis", "outcome"],
)
def test_of_a_failed_point_nothing_is_known(quantity, options, statuses, fake_motions: None) -> None:
    """Nor is anything computed for what stands in the place of parameters that could not be made."""
    table = compute(
        quantity, [Unmade("no modes")], QUANTITIES[quantity.__name__.rpartition(".")[2]].options.model_validate(options)
    )
    assert table.messages == ["Unmade: no modes"]
    for name, array in table.arrays.items():
        flags = quantity.COLUMNS[name].variable.flags
        if flags:
            assert {flags[i] for i in array.ravel()} == {"failed" if name in statuses else flags[0]}
        elif array.dtype.kind == "f":
            assert np.isnan(array).all()


# ---- curves, maps and their figures


@pytest.fixture
def plane(toy: None) -> xr.Dataset:
    options = {"x_range": [3, 18], "y_lines": {"start": 180, "stop": 420, "count": 3}, "points": 9, "max_points": 60}
    return computed(quantity="stability_curves", options=options, axes={"normalization": ["as_published"]})


def test_curves_are_stored_point_by_point(plane: xr.Dataset) -> None:
    one = plane.squeeze("normalization")
    assert one["n_curves"] == 2
    assert one["n_unfollowed"] == 0
    kinds = flag_names(one["kind"])
    assert sorted(kinds[:2]) == ["fold", "neutral"]
    for i, kind in enumerate(kinds[:2]):
        x, y = (one[name].isel(curve=i).dropna("curve_point").values for name in ("x", "y"))
        assert np.abs(outside(x, y) if kind == "neutral" else x - fold_at(y)).max() < 1e-5
    # the ellipse only borders on stable cycles
    (drawn,) = thresholds.curves_of(one)
    assert drawn.kind == "neutral"


def growth_over(N, Omega) -> xr.Dataset:
    """Growth of the toy's cycle; nan beyond the fold."""
    load, speed = np.meshgrid(N, Omega, indexing="ij")
    rate = np.where(speed < fold_at(load), outside(speed, load), np.nan)[..., None]
    axes = {"N": np.asarray(N, float), "Omega": np.asarray(Omega, float), "normalization": ["as_published"]}
    return xr.Dataset({"growth_rate": (("N", "Omega", "normalization"), rate)}, axes)


def test_growth_and_thresholds_are_drawn(plane: xr.Dataset, speeds: xr.Dataset, tmp_path) -> None:
    growth = growth_over(np.linspace(200, 400, 5), np.linspace(5, 18, 9))
    mapped = thresholds.draw(growth, {"curves": plane}, GrowthMap())
    assert mapped.axes[0].get_xlim() == (5, 18)
    save(mapped, tmp_path / "growth.png")
    chart = thresholds.draw(speeds, {"curves": plane, "cycle": growth}, Thresholds(claim={"a": (200, 12.6)}))
    labels = [text.get_text() for text in chart.legends[0].get_texts()]
    assert "separation within 1000 s" in labels
    assert "paper" in labels
    save(chart, tmp_path / "chart.png")
    both = xr.concat([growth, growth.assign_coords(normalization=["orthonormal"])], "normalization")
    assert len(thresholds.draw(both, {}, GrowthMap()).axes) == 3  # two panels and the colour bar
    without = thresholds.draw(speeds, {"curves": plane}, Thresholds())
    assert len(without.axes) == 1


def test_the_critical_speed_is_drawn_with_and_without_hysteresis(
    speeds: xr.Dataset, sweep: xr.Dataset, tmp_path
) -> None:
    plot = CriticalSpeed(claim={"x": (200, 12.6)})
    growth = growth_over([200.0, 400.0], np.linspace(12, 15, 7))
    both = curves.draw(speeds, {"hysteresis": sweep, "cycle": growth}, plot)
    assert [ax.get_title(loc="left") for ax in both.axes] == ["(a)", "(b)"]
    save(both, tmp_path / "both.png")
    alone = curves.draw(speeds, {}, CriticalSpeed())
    (ax,) = alone.axes
    lowest = next(line for line in ax.lines if line.get_label() == "within 1000 s")
    assert lowest.get_ydata().tolist() == [12.4, 12.4]
    # more than one crossing is explained
    twice = speeds.assign(n_crossings=speeds["n_crossings"] + 1)
    twice["crossing"][..., 1], twice["crossing_kind"][..., 1] = 14.2, 2
    labels = [text.get_text() for text in curves.draw(twice, {}, CriticalSpeed()).axes[0].get_legend().get_texts()]
    assert "open: separation ends again" in labels
    save(alone, tmp_path / "alone.png")


def with_failed(study: xr.Dataset, **place) -> xr.Dataset:
    """The study with one point that failed; numbers that it has are not to be believed."""
    study = study.copy(deep=True)
    study["status"].loc[place] = STATUSES.index("failed")
    return study


def crosses(ax) -> list[list[float]]:
    """Where points are marked as failed, along the axis."""
    lines = [line for line in ax.lines if line.get_label() == "failed"]
    return [
        list(line.get_xdata() if line.get_transform() == ax.get_xaxis_transform() else line.get_ydata())
        for line in lines
    ]


def test_points_that_failed_are_marked_and_not_drawn(plane: xr.Dataset, speeds: xr.Dataset, sweep: xr.Dataset) -> None:
    lost = with_failed(speeds, N=200)
    both = curves.draw(lost, {"hysteresis": with_failed(sweep, N=400)}, CriticalSpeed())
    assert [crosses(ax) for ax in both.axes] == [[[200]], [[400]]]
    drawn = {line.get_label(): np.asarray(line.get_ydata()) for ax in both.axes for line in ax.lines}
    for label in ("within 1000 s", "from rest, within 1000 s"):
        assert np.isfinite(drawn[label]).tolist() == [False, True]
    for label in ("sweep up: separation begins", "sweep down: persists to"):
        assert np.isfinite(drawn[label]).tolist() == [True, False]
    growth = growth_over(np.linspace(200, 400, 5), np.linspace(5, 18, 9))
    (ax,) = thresholds.draw(lost, {"curves": plane, "cycle": growth}, Thresholds()).axes
    assert crosses(ax) == [[200]]
    separation = next(line for line in ax.lines if line.get_label() == "separation within 1000 s")
    assert separation.get_ydata().tolist() == [400]
    # nothing is known of any
    (ax,) = thresholds.draw(with_failed(lost, N=400), {"curves": plane, "cycle": growth}, Thresholds()).axes
    assert crosses(ax) == [[200, 400]]


def made_up_samples(normalization: str = "orthonormal") -> tuple[xr.Dataset, xr.Dataset]:
    """Samples and exponents over three loads, for base values with this normalization."""
    status = ("N", np.zeros(3, np.int8), {"flag_meanings": " ".join(STATUSES)})
    axes, attrs = {"N": ("N", [1.0, 2, 3], {"units": "N"})}, {"base": json.dumps({"normalization": normalization})}
    samples = {"phase": (("N", "sample"), np.ones((3, 2), np.int8)), "psi": (("N", "sample"), np.ones((3, 2)))}
    exponents = {name: (("N", "exponent_number"), np.ones((3, 1))) for name in ("exponent", "exponent_error")}
    return xr.Dataset(samples | {"status": status}, axes, attrs), xr.Dataset(
        exponents | {"status": status}, axes, attrs
    )


def test_diagrams_mark_points_that_failed() -> None:
    samples, exponents = made_up_samples()
    others = {"lyapunov": with_failed(exponents, N=3)}
    above, below = attractors.draw(with_failed(samples, N=2), others, Bifurcation(x="N")).axes
    assert [crosses(ax) for ax in (above, below)] == [[[2]], [[3]]]
    assert above.lines[0].get_xdata().tolist() == [1, 1, 3, 3]
    assert not crosses(attractors.draw(samples, {}, Bifurcation(x="N")).axes[0])


def in_base(study: xr.Dataset) -> xr.Dataset:
    """The study as if its one normalization were given in base."""
    attrs = {"base": json.dumps({"normalization": str(study["normalization"].item())})}
    return study.squeeze("normalization", drop=True).assign_attrs(attrs)


def test_the_normalization_may_be_given_in_base(plane: xr.Dataset, speeds: xr.Dataset, sweep: xr.Dataset) -> None:
    growth = growth_over(np.linspace(200, 400, 5), np.linspace(5, 18, 9))
    both = xr.concat([growth, growth.assign_coords(normalization=["orthonormal"])], "normalization")
    alone = in_base(speeds)
    assert len(curves.draw(alone, {"hysteresis": in_base(sweep), "cycle": both}, CriticalSpeed()).axes) == 2
    assert len(thresholds.draw(alone, {"curves": plane, "cycle": both}, Thresholds()).axes) == 1
    assert len(thresholds.draw(in_base(growth), {"curves": plane}, GrowthMap()).axes) == 2  # and the colour bar
    samples, exponents = made_up_samples("as_published")
    exponents = exponents.expand_dims(normalization=["as_published"])
    assert len(attractors.draw(samples, {"lyapunov": exponents}, Bifurcation(x="N")).axes) == 2


def test_grids_too_narrow_for_contours_are_drawn_without(plane: xr.Dataset, speeds: xr.Dataset) -> None:
    for growth in (growth_over([200.0], np.linspace(5, 18, 9)), growth_over([200.0, 400.0], [5.0, 9.0])):
        assert curves.draw(speeds, {"cycle": growth}, CriticalSpeed()).axes
        assert thresholds.draw(speeds, {"curves": plane, "cycle": growth}, Thresholds()).axes


OUTCOMES = {"flag_meanings": " ".join(outcome.OUTCOMES)}


@pytest.mark.parametrize(
    ("x", "values", "scale"),
    [("Omega", [5.0, 10, 20], "linear"), ("D_star", [0, 1e-6, 1e-4], "symlog"), ("m", [0.01, 0.1, 1], "log")],
)
def test_maps_show_outcomes_on_growth(x: str, values: list[float], scale: str, tmp_path) -> None:
    loads, norms = [100.0, 200.0], ["as_published", "orthonormal"]
    axes = {"N": loads, x: values, "normalization": norms}
    codes = np.arange(12).reshape(2, 3, 2) % 4
    study = xr.Dataset({"outcome": (("N", x, "normalization"), codes, OUTCOMES)}, axes)
    rate = np.linspace(-0.1, 0.1, 12).reshape(2, 3, 2)
    rate[0, 0, 0] = np.nan
    growth = xr.Dataset({"growth_rate": (("N", x, "normalization"), rate)}, axes)
    plot = StabilityMap(
        x=x,
        y="N",
        marks={"a": Mark(x=values[1], y=100, paper="stable"), "b": Mark(x=values[2], y=200, paper="separation")},
    )
    figure = maps.draw(study, {"growth": growth}, plot)
    assert figure.axes[0].get_xscale() == scale
    assert {text.get_text() for text in figure.axes[0].texts} == {"a", "b"}
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert {"stays quiet", "separation", "no cycle found", "what the paper says"} <= set(labels)
    save(figure, tmp_path / "map.png")
    bare = maps.draw(study.sel(normalization="orthonormal"), {}, StabilityMap(x=x, y="N"))
    assert len(bare.axes) == 1


@pytest.mark.parametrize(("x", "values"), [("n_diameters", [2, 4, 8]), ("n_circles", [0, 1]), ("c", [0.0])])
def test_maps_of_one_normalization_over_any_number(x: str, values: list[float], tmp_path) -> None:
    axes, shape = {"N": [100.0, 200.0], x: values}, (2, len(values))
    attrs = {"base": json.dumps({"normalization": "orthonormal"})}
    study = xr.Dataset({"outcome": (("N", x), np.ones(shape, int), OUTCOMES)}, axes, attrs)
    rate = xr.DataArray(np.linspace(-1, 1, 2 * len(values)).reshape(shape), dims=("N", x))
    norms = {"normalization": ["as_published", "orthonormal"]}
    growth = xr.Dataset({"growth_rate": rate.expand_dims(norms)}, axes | norms)
    plot = StabilityMap(x=x, y="N", marks={"a": Mark(x=values[0], y=100, paper="stable")})
    figure = maps.draw(study, {"growth": growth}, plot)
    panel, _ = figure.axes
    assert panel.get_title(loc="left") == "modes orthonormal"
    assert panel.get_xlabel() == {"c": "Damper c (N s/m)"}.get(x, f"Nodal {x[2:]}")
    # the paper's cases are of the other modes
    assert "what the paper says" not in [text.get_text() for text in figure.legends[0].get_texts()]
    save(figure, tmp_path / "map.png")


def test_diagrams_show_samples_and_exponents(tmp_path) -> None:
    options = {"transient": 0.1, "samples": 2, "tol": 1e-8}
    samples = computed(quantity="bifurcation", options=options, base={"N": 200} | SMALL, axes={"Omega": [45, 50]})
    assert flag_names(samples["phase"]).shape == (2, 2)
    assert set(np.unique(flag_names(samples["phase"]))) <= {"stick", "slip", "separation"}
    options = {"transient": 0.01, "duration": 0.04, "exponents": 2, "tol": 1e-8}
    exponents = computed(quantity="lyapunov", options=options, base={"N": 200} | SMALL, axes={"Omega": [45, 50]})
    assert exponents["exponent"].shape == (2, 2)
    assert exponents["covered"].values == pytest.approx([0.04, 0.04])
    figure = attractors.draw(samples, {"lyapunov": exponents}, Bifurcation(x="Omega"))
    assert figure.axes[0].get_ylabel() == "Angle ψ (mrad)"
    save(figure, tmp_path / "diagram.png")


def test_cycles_are_tabulated_with_their_status() -> None:
    found = computed(quantity="floquet", options={}, base={"Omega": 20} | SMALL, axes={"N": [0, 200]})
    assert flag_names(found["status"]).tolist() == ["no_stick_slip", "ok"]
    assert np.isfinite(found["growth_rate"].sel(N=200))
    assert str(found["message"].sel(N=0).item())
