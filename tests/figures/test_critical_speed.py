"""Charts over speed and preload: thresholds, sweeps, and what lies behind them."""

from collections.abc import Callable

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure

from disc_model.data.variables import OUTCOMES_TO_HORIZON
from disc_model.figures import critical_speed, swept_speeds
from disc_model.figures.borders import Curve, _resonance_of, curves_of, parts_of
from disc_model.figures.drawing import BLUE, SEPARATED
from disc_model.figures.onsets import branches
from tests.figures.every_kind import flag
from tests.figures.made_up import status
from tests.figures.reading import draw, labels, lines
from tests.studies.conftest import SCAN, computed, growth_over

SPEEDS = np.linspace(12, 15, 10)
LOADS = [100.0, 200, 400]
NEUTRAL = Curve(SPEEDS, np.linspace(300, 100, 10), "neutral")
FOLD = Curve(SPEEDS, SPEEDS * 20, "fold", "2 f_s = 135.42 Hz")
NEVER = "none found from 12 to 15 rad/s\nin steps of 0.1 rad/s within 900 s"
PAPER_POINTS = {"paper": (200, 12.6)}


@pytest.fixture
def chart(fake_motions: None, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Figure]:
    """Of known curves, where separation never comes at 100 N, from 14 rad/s on at 200 N, and ends
    again at 400 N."""
    options = {"horizons": [900], "scan": SCAN | {"step": 0.1}, "precision": 0.1}
    scanned = computed(
        quantity="critical_speed",
        options=options,
        axes={"N": LOADS, "normalization": ["as_published"]},
    )
    monkeypatch.setattr(critical_speed, "curves_of", lambda _: [NEUTRAL, FOLD, FOLD])
    curves = xr.Dataset()
    return lambda **others: draw(
        "critical_speed", scanned, {"curves": curves, **others}, paper_points=PAPER_POINTS
    )


def test_curves_crossings_and_what_the_paper_says_are_named(chart: Callable[..., Figure]) -> None:
    figure = chart()
    named = {"cycle loses stability", "stable cycle ends (fold)", "separation begins, within 900 s"}
    named |= {"paper", "2 $f_s$ = 135.42 Hz", NEVER}
    assert set(labels(figure)) == named
    (ax,) = figure.axes
    assert {text.get_text() for text in ax.texts} == {"1"}


@pytest.mark.parametrize("loads", [[260.0], LOADS])
def test_loads_without_a_critical_speed_stand_beside_the_panel(loads: list[float]) -> None:
    """They were left out, and nothing said so."""
    lowest = xr.DataArray([[12.5]], dims=("N", "horizon"), coords={"N": [180.0]})
    study = _scanned(lowest.reindex(N=[180.0, *loads]).sortby("N"))
    (ax,) = draw("critical_speed", study).axes
    beside = lines(ax)["none found from 8 to 10 rad/s\nin steps of 1 rad/s within 60 s"]
    assert beside.get_ydata().tolist() == loads


def test_a_chart_without_any_critical_speed_is_drawn() -> None:
    lowest = xr.DataArray([[np.nan]], dims=("N", "horizon"), coords={"N": [180.0]})
    (ax,) = draw("critical_speed", _scanned(lowest)).axes
    beside = lines(ax)["none found from 8 to 10 rad/s\nin steps of 1 rad/s within 60 s"]
    assert beside.get_ydata().tolist() == [180.0]


def _scanned(lowest: xr.DataArray) -> xr.Dataset:
    """Critical speeds of several loads, which have no further crossings."""
    dims = ("N", "horizon", "crossing_number")
    count = lowest.sizes["N"]
    data = {
        "critical_speed": lowest,
        "crossing": (dims, np.full((count, 1, 1), np.nan)),
        "crossing_kind": flag(dims, np.full((count, 1, 1), "none"), ("none", "begins", "ends")),
        "status": status(("N",), ["ok"] * count),
    }
    coords = {"horizon": [60.0], "crossing_number": [0], "scan_Omega": [8.0, 9.0, 10.0]}
    return xr.Dataset(data, coords, {"base": '{"normalization": "as_published"}'})


def test_a_line_does_not_jump_to_another_branch() -> None:
    """The lowest speeds were joined, across speeds at which all stays quiet."""
    speeds = [
        np.array(at) for at in ([17.6], [11.5, 19.5], [12.7, 14.9, 21.3], [13.8, 15.9, 23.1], [])
    ]
    links = [(0, 17.6, 19.5), (1, 11.5, 12.7), (1, 19.5, 21.3)]
    # 13.8 is as near to 12.7 as to 14.9, which is nearer to 15.9
    assert branches(speeds, 5 * [[]]) == [*links, (2, 12.7, 13.8), (2, 14.9, 15.9), (2, 21.3, 23.1)]
    assert branches(speeds, [[], [12.9], [13.2, 16.1], [], []]) == [
        *links,
        (2, 14.9, 15.9),
        (2, 21.3, 23.1),
    ]


def test_a_branch_that_ends_above_the_lower_speed_is_not_joined() -> None:
    """Speeds that fall with load, and an end at 14 rad/s of either load."""
    lower = np.array([13.0])
    higher = np.array([15.0])
    end = [14.0]
    falling = (higher, lower)
    rising = (lower, higher)
    assert branches(falling, ([], end)) == []
    assert branches(falling, (end, [])) == [(0, 15.0, 13.0)]
    assert branches(rising, (end, [])) == []
    assert branches(rising, ([], end)) == [(0, 13.0, 15.0)]


def test_the_panel_beside_shows_where_both_motions_last(
    chart: Callable[..., Figure], sweep: xr.Dataset
) -> None:
    """By multipliers and a sweep, which ends at 13 rad/s; or, once many starts were followed, by
    what these came to."""
    growth = growth_over([200, 300, 400], np.linspace(12, 15, 7))
    apart = growth["growth_rate"].copy(
        data=np.full((3, 7, 1), OUTCOMES_TO_HORIZON.index("separation"))
    )
    regions = growth.assign(outcome=apart.assign_attrs(flag_meanings=" ".join(OUTCOMES_TO_HORIZON)))
    figure = chart(hysteresis=sweep, cycle=regions.assign_attrs(options='{"horizon": 900}'))
    assert "separation within 900 s" in labels(figure)
    (mesh,) = (shown for shown in figure.axes[1].collections if isinstance(shown, QuadMesh))
    rate = growth["growth_rate"].squeeze().values
    np.testing.assert_array_equal(
        mesh.get_array() == 1, (rate < 0) & (growth["Omega"].values >= 13)
    )
    classes = {"Omega": [12.0, 13, 14, 15], "attractor_class": ["quiet"]}
    quiet = (("Omega", "attractor_class"), [[0.2], [0.1], [0.1], [0.0]])
    shares = {
        "basin_fraction_low": quiet,
        "separating_fraction_low": ("Omega", [0.0, 0.1, 0.2, 0.3]),
    }
    basins = xr.Dataset(shares, classes, {"base": '{"N": 385}'})
    (bar,) = chart(hysteresis=sweep, basins=basins).axes[1].patches
    assert bar.get_x() == 13
    assert bar.get_width() == 1
    assert bar.get_y() + bar.get_height() / 2 == 385


def test_onset_and_end_of_sweeps_have_their_own_colours(
    chart: Callable[..., Figure], sweep: xr.Dataset
) -> None:
    marks = lines(chart(hysteresis=sweep).axes[1])
    assert marks["sweep up: separation begins"].get_color() == SEPARATED
    assert marks["sweep down: separation ends"].get_color() == BLUE


def test_only_the_longest_horizon_is_drawn(speeds: xr.Dataset) -> None:
    (ax,) = draw("critical_speed", speeds).axes
    assert [line.get_label() for line in ax.lines] == ["separation begins, within 1000 s"]
    onsets = ax.lines[0].get_xdata()
    assert np.nanmin(onsets) == np.nanmin(speeds["critical_speed"].sel(horizon=1000))


def swept(ends: list[float], *, lost: bool) -> xr.Dataset:
    """Sweeps from 10 to 20 rad/s at two loads, onset 18 rad/s, with their ends; contact may be lost
    on all of the way down."""
    rates = np.zeros((2, 2, 2))
    if lost:
        rates[:, 1] = 9.0
    data = {
        "onset_speed": ("N", [18.0, 18.0]),
        "offset_speed": ("N", ends),
        "separation_rate": (("N", "direction", "sweep_Omega"), rates),
        "status": status(("N",), ["ok", "ok"]),
    }
    coords = {"N": [200.0, 400.0], "direction": ["up", "down"], "sweep_Omega": [10.0, 20.0]}
    return xr.Dataset(data, coords)


def test_separation_that_persists_at_the_lowest_speed_points_to_lower_ones() -> None:
    """Its end is not known, and neither is it left out."""
    ax = pyplot.figure().subplots()
    swept_speeds.draw_sweeps(ax, swept([np.nan, np.nan], lost=True), None, None)
    found = lines(ax)
    assert found["sweep down: separation ends"].get_xdata().tolist() == [10.0, 10.0]
    assert found["at or below the lower bound"].get_xdata().tolist() == [10.0, 10.0]
    ax = pyplot.figure().subplots()
    swept_speeds.draw_sweeps(ax, swept([12.0, 14.0], lost=False), None, None)
    assert "at or below the lower bound" not in lines(ax)


def test_speeds_that_rest_on_motions_which_had_not_settled_are_filled() -> None:
    """The onset at 200 N rests on all stays below it, and the end on the first one that keeps
    contact; nothing showed that either may change with longer stays."""
    speeds = [10.0, 12.0, 14.0, 16.0]
    rates = np.zeros((2, 2, 4))
    rates[:, 0, 3] = 9.0
    rates[:, 1, 2:] = 9.0
    settled = np.full(rates.shape, "settled", dtype=object)
    settled[:, :, 3] = "changing"  # separates
    settled[0, 0, 0] = "undecided"
    settled[0, 1, 0] = "changing"  # below the stay that ends separation
    settled[1, 1, 1] = "changing"
    sweep = swept([14.0, 14.0], lost=False).drop_vars(["separation_rate", "sweep_Omega"])
    sweep["onset_speed"] = ("N", [16.0, 16.0])
    dims = ("N", "direction", "sweep_Omega")
    sweep = sweep.assign_coords(sweep_Omega=speeds)
    sweep = sweep.assign(separation_rate=(dims, rates), sweep_settled=(dims, settled.astype(str)))
    ax = pyplot.figure().subplots()
    swept_speeds.draw_sweeps(ax, sweep, None, None)
    assert "filled: not settled" in lines(ax)
    filled = [line for line in ax.lines if line.get_markerfacecolor() == line.get_color()]
    found = [
        (line.get_marker(), *line.get_xydata().ravel()) for line in filled if line.get_xdata().size
    ]
    assert found == [("^", 16.0, 200.0), ("v", 14.0, 400.0)]

    longer = sweep.assign(sweep_settled=(dims, np.full(rates.shape, "settled")))
    ax = pyplot.figure().subplots()
    swept_speeds.draw_sweeps(ax, longer, None, None)
    assert "filled: not settled" not in lines(ax)


@pytest.mark.parametrize(("kind", "drawn"), [("fold", True), ("neutral", False)])
def test_a_fold_bounds_a_cycle_beyond_which_there_is_none(kind: str, drawn: bool) -> None:
    """Beyond a neutral curve there is an unstable one."""
    axes = {"N": np.arange(100.0, 501, 50), "Omega": np.arange(10.0, 17)}
    rate = np.full((9, 7), -1.0)
    rate[:, 4:] = np.nan
    cycle = xr.Dataset({"growth_rate": (("N", "Omega"), rate)}, axes)
    curve = Curve(np.full(5, 13.4), np.linspace(150, 450, 5), kind)
    assert bool(parts_of([curve], cycle)) == drawn


@pytest.mark.parametrize(
    ("detuning", "label"),
    [
        (-5.0, ""),
        (-2.0, "2 f_s = 135.42 Hz − 1 f_Ω"),
        (2.0, "2 f_s = 135.42 Hz − 1 f_Ω"),
        (5.0, ""),
    ],
)
def test_a_fold_is_named_within_three_hertz_of_a_resonance(detuning: float, label: str) -> None:
    point = xr.Dataset(
        {
            "resonance_harmonic": 2.0,
            "resonance_frequency": 135.42,
            "resonance_diameters": 1,
            "resonance_sign": -1,
            "resonance_detuning": detuning,
        }
    )
    assert _resonance_of(point) == label


@pytest.mark.parametrize(("stable", "drawn"), [(["yes", "yes", "no"], 1), (["yes", "no", "no"], 0)])
def test_two_points_beside_a_stable_cycle_make_a_curve(stable: list[str], drawn: int) -> None:
    points = ("curve", "curve_point")
    curves = xr.Dataset(
        {
            "kind": flag(("curve",), ["neutral"], ("none", "neutral")),
            "adjoins_stable_cycle": flag(points, [stable], ("no", "yes")),
            "x": (points, [[10.0, 11.0, 12.0]]),
            "y": (points, [[200.0, 210.0, 220.0]]),
        }
    )
    found = curves_of(curves)
    assert len(found) == drawn
