"""Figures of motions over one parameter: bifurcation diagrams, basins, ramps; the range law,
and locking."""

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot
from matplotlib.colors import to_rgb
from matplotlib.text import Annotation

from disc_model.figures import bifurcation_exponents
from disc_model.figures import ramps as drawn
from disc_model.figures.basins import LARGEST
from disc_model.figures.borders import Curve
from disc_model.figures.branch_lines import stable_segments
from disc_model.figures.campbell_peaks import peaks
from disc_model.figures.classes import LOOKS
from disc_model.figures.drawing import BLACK, GREY, SEPARATED
from disc_model.figures.locking import TOP
from disc_model.figures.sliding_outcome import percent
from disc_model.figures.types import Axes
from disc_model.studies.quantities.branches import Branches
from disc_model.studies.quantities.ramps import Ramps
from disc_model.studies.quantity import STATUSES
from disc_model.studies.reading import StudyError
from tests.figures.made_up import bifurcation as bifurcation_of_motions
from tests.figures.made_up import campbell, of_example, sensitivity, sliding_modes
from tests.figures.reading import crosses, draw, labels, lines
from tests.studies.conftest import computed, made_up_samples, with_failed
from tests.studies.quantities.test_basins import Made, made

__all__ = ["made"]

# ---- bifurcation diagrams


@pytest.mark.parametrize(
    ("section", "label"),
    [("stroboscopic", "Angle ψ once per turn of the drive (mrad)"), ("event", "Angle ψ (mrad)")],
)
def test_diagrams_say_that_samples_are_once_per_turn(section: str, label: str) -> None:
    """The figure of samples at events names these by its marks."""
    upper = bifurcation_of_motions(section).axes[0]
    assert " ".join(upper.get_ylabel().split()) == label


def test_diagrams_mark_points_that_failed_and_not_those_that_slide() -> None:
    samples, exponents = made_up_samples()
    axes = draw(
        "bifurcation", with_failed(samples, N=2), {"lyapunov": with_failed(exponents, N=3)}, x="N"
    ).axes
    assert [crosses(ax) for ax in axes] == [[[2]], [], [[3]]]
    assert axes[0].lines[0].get_xdata().tolist() == [1, 1, 3, 3]
    samples["phase"][{"N": slice(1, None)}] = 0  # not reached
    samples["kind"][1] = samples["kind"].attrs["flag_meanings"].split().index("steady_sliding")
    ax = draw("bifurcation", samples, x="N").axes[0]
    assert not crosses(ax)
    assert lines(ax)["steady sliding"].get_xdata() == [2]
    assert lines(ax)["no event while sampled"].get_xdata() == [3]


def test_periods_have_no_number_below_one() -> None:
    samples, _ = made_up_samples()
    axis = draw("bifurcation", samples, x="N").axes[1].yaxis
    assert axis.get_view_interval()[0] < 0.5
    assert min(axis.get_majorticklocs()) == 1


@pytest.mark.parametrize("seen_by", ["kind", "period_events"])
def test_all_exponents_are_open_where_samples_show_another_motion(seen_by: str) -> None:
    samples, exponents = made_up_samples()
    exponents = xr.concat([exponents, exponents], "exponent_number", data_vars="minimal")
    samples[seen_by][2] = 1
    ax = draw("bifurcation", samples, {"lyapunov": exponents}, x="N").axes[2]
    drawn = lines(ax)
    for name in ("largest exponent", "exponent 2"):
        gaps = np.isnan(drawn[name].get_ydata())
        assert gaps.tolist() == [False, False, True, False]
    assert "line open: another motion" in labels(ax)


def test_places_between_samples_belong_to_no_side_of_a_change() -> None:
    samples, _ = made_up_samples()
    samples["period_events"][:] = [1, 1, 2]
    along = np.array([1.0, 2.0, 3.0])
    changes = bifurcation_exponents.motion_changes(
        samples, along, np.array([1.0, 2 - 1e-12, 2.5, 2.6, 3])
    )
    assert changes.tolist() == [False, True, True, True]


def test_stable_stretches_are_thick_and_jumps_have_arrows(monkeypatch: pytest.MonkeyPatch) -> None:
    """A quiet branch with a fold at 13, and one that separates above it."""
    values = {
        "status": "ok",
        "n_branches": 2,
        "separations": [0, 2],
        "value": [[10.0, 12.0, 13.0, 12.0], [11.0, 14.0]],
        "range": [[1e-5, 2e-5, 3e-5, 1e-4], [2e-2, 3e-2]],
        "growth_rate": [[-0.1, -0.1, 0.0, 0.2], [-0.1, -0.1]],
        "sweep_range": np.array([[1e-5, 1e-5, 2e-5, 2e-5, 3e-2], [1e-5, 2e-2, 2e-2, 2e-2, 3e-2]]),
        "sweep_separation_rate": np.array([[0, 0, 0, 0, 135.0], [0, 135.0, 135.0, 135.0, 135.0]]),
        "sweep_settled": np.full((2, 5), 2),
        "sliding_growth_rate": [0.1, 0.1, -0.1, -0.1, -0.1],
    }
    monkeypatch.setattr(Branches, "compute_point", lambda *_, **__: (values, ""))
    options = {"scan": {"start": 10, "stop": 14, "step": 1}, "dwell": 1, "evaluation_time": 1}
    study = computed(
        quantity="branches",
        options=options,
        base={"N": 385},
        axes={"normalization": ["as_published"]},
    )
    figure = draw("branches", study, paper_cases={"F11": 12}, title="t")
    (ax,) = figure.axes
    thick = [line for line in ax.lines if line.get_linewidth() == 2 and len(line.get_xdata())]
    assert [(line.get_color(), [*line.get_xdata()]) for line in thick] == [
        (BLACK, [10, 12, 13]),
        (SEPARATED, [11, 14]),
        (GREY, [12, 13, 14]),  # steady sliding, which the text called thick and was not
    ]
    arrows = [
        text for text in ax.texts if isinstance(text, Annotation) and text.arrow_patch is not None
    ]
    assert [(arrow.xyann[0], arrow.xy[0]) for arrow in arrows] == [(13, 14), (11, 10)]
    assert "jump" in labels(figure)


@pytest.mark.parametrize(
    ("growth", "stable"),
    [
        ("- - + +", "yes no no"),
        ("- 0 +", "yes no"),
        ("+ 0 - 0", "no yes yes"),
        ("+ 0 0 +", "no yes no"),
        ("- 0 0 -", "yes no yes"),
        ("0 0 -", "no yes"),
        ("- nan -", "no no"),
    ],
)
def test_a_branch_changes_stability_where_its_growth_rate_is_exactly_0(
    growth: str, stable: str
) -> None:
    """Between two such points it is what it is not before them."""
    numbers = {"-": -1.0, "0": 0.0, "+": 1.0, "nan": np.nan}
    rates = [numbers[sign] for sign in growth.split()]
    found = stable_segments(np.array(rates))
    words = np.where(found, "yes", "no")
    assert " ".join(words) == stable


# ---- basins


@pytest.fixture
def shares(made: None, monkeypatch: pytest.MonkeyPatch) -> xr.Dataset:
    """All quiet at 12 rad/s, some at 13 and 14, none at 15."""
    monkeypatch.setattr(
        Made, "least", lambda _, p, i: {12: 9.0, 13: 0.5, 14: 0.05, 15: -1.0}[p.Omega]
    )
    options = {"energies": [0.01, 0.1, 1], "n_starts": 4}
    return computed(
        quantity="basins", options=options, base={"N": 385}, axes={"Omega": [12, 13, 14, 15]}
    )


def test_shares_attractors_and_kicks_are_drawn(shares: xr.Dataset) -> None:
    figure = draw("basins", shares, x="Omega")
    assert labels(figure) == ["quiet", "separating", "95 % interval of the share that separates"]
    shown = [
        [bar.get_height() for bar in ax.patches] for ax in figure.axes[:3]
    ]  # separating, then quiet
    assert shown == [[0, 0, 0, 1, 1, 1, 1, 0], [0, 0, 1, 1, 1, 1, 0, 0], [0, 1, 1, 1, 1, 0, 0, 0]]
    starts = 12  # at three energies, each with four
    quiet = [*to_rgb(LOOKS["quiet"].face), 1.0]
    [marks] = [
        marks
        for marks in figure.axes[-2].collections
        if marks.get_offsets().size and np.allclose(marks.get_facecolor(), quiet)
    ]
    areas = zip(marks.get_offsets()[:, 0], marks.get_sizes(), strict=True)
    by_share = {float(x): float(area) / LARGEST for x, area in areas}
    assert by_share == pytest.approx({12.0: 1.0, 13.0: 8 / starts, 14.0: 4 / starts})
    kicks = lines(figure.axes[-1])["by bisection"].get_ydata()
    np.testing.assert_allclose(kicks, [np.nan, 0.5, 0.05, np.nan], rtol=0.06)
    # what separates without a kick has no place on a logarithmic scale, and is not left out
    ax = figure.axes[-1]
    zero = lines(ax)["zero"]
    assert zero.get_xdata() == [15]
    # no energy of the axis is at its height
    figure.draw_without_rendering()
    height = zero.get_transform().transform(zero.get_xydata())[0, 1]
    end, _ = ax.spines["left"].get_bounds()
    assert height < ax.transData.transform((15, end))[1]
    assert min([*ax.get_yticks(), *ax.get_yticks(minor=True)]) >= end
    assert crosses(draw("basins", with_failed(shares, Omega=13.0), x="Omega").axes[0]) == [[13]]


def test_each_bar_has_the_interval_of_the_share_that_separates(shares: xr.Dataset) -> None:
    """The number of starts and the interval were not told, which say what a share rests on."""
    separating = shares.sel(energy=0.1, attractor_class="separating")
    low = separating["basin_fraction_by_energy_low"].values
    high = separating["basin_fraction_by_energy_high"].values
    ax = draw("basins", shares, x="Omega").axes[1]
    np.testing.assert_allclose(
        [line.get_ydata() for line in ax.lines], np.column_stack([low, high])
    )
    assert draw("basins", shares, x="Omega").axes[0].get_ylabel() == "Share of 4 starts"

    without = shares.drop_vars(["basin_fraction_by_energy_low"])
    figure = draw("basins", without, x="Omega")
    assert not figure.axes[1].lines
    assert labels(figure) == ["quiet", "separating"]


@pytest.mark.parametrize("speed", [12.0, 15.0], ids=["none", "all"])
def test_bars_have_intervals_also_where_no_start_or_each_separates(
    shares: xr.Dataset, speed: float
) -> None:
    """A bar of four quiet starts looked certain."""
    study = shares.sel(Omega=[speed], energy=[0.1])
    separating = study.sel(energy=0.1, attractor_class="separating")
    low = separating["basin_fraction_by_energy_low"].item()
    high = separating["basin_fraction_by_energy_high"].item()
    assert high - low > 0.4
    figure = draw("basins", study, x="Omega")
    [interval] = figure.axes[0].lines
    assert interval.get_ydata() == pytest.approx([low, high])
    assert "95 % interval of the share that separates" in labels(figure)


# ---- ramps


def test_onset_and_end_are_drawn_and_what_has_none_is_marked(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    values = {
        "status": "ok",
        "rate_status": np.array([0, 0, STATUSES.index("stalled")]),
        "onset_speed": np.array([15.3, np.nan, np.nan]),
        "top_separation_rate": np.array([135.0, 0.0, np.nan]),
        "offset_speed": np.array([9.7, 9.3, np.nan]),
    }
    monkeypatch.setattr(Ramps, "compute_point", lambda *_, **__: (values, ""))
    options = {
        "low": 8,
        "high": 20,
        "rates": {"start": 0.01, "stop": 1, "count": 3, "scale": "log"},
    }
    study = computed(
        quantity="ramps", options=options, base={"N": 385}, axes={"normalization": ["as_published"]}
    )
    folds = [
        Curve(np.array([15.0, 15.2]), np.array([380.0, 390.0]), "fold"),
        Curve(np.array([12.0, 12.5]), np.array([380.0, 390.0]), "neutral"),
        Curve(
            np.array([11.0, 11.2, np.nan, 30.0, 31.0]),
            np.array([380.0, 390.0, np.nan, 380.0, 390.0]),
            "fold",
        ),
    ]
    monkeypatch.setattr(drawn, "curves_of", lambda _: folds)
    ax = draw("ramps", study, {"curves": xr.Dataset()}, title="t").axes[0]
    shown = lines(ax)
    np.testing.assert_allclose(shown["onset, rising ramp"].get_ydata(), [15.3, np.nan, np.nan])
    np.testing.assert_allclose(shown["end, falling ramp"].get_ydata(), [9.7, 9.3, np.nan])
    assert list(shown["none up to the highest speed, 20 rad/s"].get_xdata()) == [0.1]
    assert list(shown["stable cycle ends (fold)"].get_ydata()) == pytest.approx([15.1, 15.1])
    assert [text.get_text() for text in ax.texts] == ["15.10"], (
        "the fold of another cycle, at 11 rad/s, was drawn too"
    )


def test_ramps_on_which_separation_never_ends_are_marked_at_the_lowest_speed() -> None:
    """A legend named ends that were not drawn, and nothing said why there were none."""
    data = {
        "rate_status": ("rate", [0, 0, 0]),
        "onset_speed": ("rate", [15.0, 16.0, np.nan]),
        "top_separation_rate": ("rate", [135.0, 130.0, 0.0]),
        "offset_speed": ("rate", [np.nan, np.nan, np.nan]),
    }
    study = xr.Dataset(data, {"rate": [0.1, 0.2, 0.4]})
    study.attrs = {"options": '{"low": 8, "high": 20}', "base": '{"N": 385, "disc": "a"}'}
    ax = draw("ramps", study).axes[0]
    shown = lines(ax)
    assert "end, falling ramp" not in shown
    on = shown["separation goes on at the lowest speed, 8 rad/s"]
    assert (on.get_xdata().tolist(), on.get_ydata().tolist()) == ([0.1, 0.2], [8, 8])


def test_the_limit_of_slow_ramps_is_below_all_onsets(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of folds at 12, 15 and 17 rad/s, with onsets from 16 rad/s on."""
    folds = [
        Curve(np.array([speed, speed]), np.array([380.0, 390.0]), "fold")
        for speed in (12.0, 15.0, 17.0)
    ]
    monkeypatch.setattr(drawn, "curves_of", lambda _: folds)
    study = xr.Dataset(attrs={"base": '{"N": 385}'})
    onset = np.array([18.0, np.nan, 16.0])
    assert drawn._end_of_cycle(study, {"curves": xr.Dataset()}, onset) == 15.0
    assert drawn._end_of_cycle(study, {}, onset) is None


# ---- branches and peaks


def test_peaks_are_the_highest_rates_from_a_tenth_on_with_their_crossings() -> None:
    """A peak of 0.05/s is none; of two within a hundredth of the speeds the higher one is; one at
    3 rad/s has the crossing of its own leading mode rather than a nearer one of another mode."""
    speeds = np.linspace(0, 10, 201)
    rate = np.full(201, -0.2)
    for place, height in ((60, 3.0), (61, 2.95), (120, 0.05), (160, 0.5)):
        rate[place] = height
        rate[place + 1] = max(rate[place + 1], height - 0.09)
    modes = np.column_stack([rate - 1, rate])
    study = xr.Dataset(
        {
            "growth_rate": ("Omega", rate),
            "cycle_growth_rate": (("Omega", "mode"), modes),
            "crossing_Omega": ("crossing", [3.0, 3.05, 8.5]),
            "crossing_mode": ("crossing", [1, 2, 2]),
        },
        {"Omega": speeds, "mode": [1, 2]},
    )
    first, second = peaks(study)
    assert (first.place, second.place) == (60, 160)
    assert first.crossing is not None
    assert first.crossing["crossing_Omega"] == 3.05
    assert second.crossing is None, "none is near"


# ---- the range law


def separating_motions() -> xr.Dataset:
    """Four motions of two masses: one in contact, one of several frequencies, one far off."""
    pinned = np.array([[4e-3, 8e-3], [np.nan, 16e-3]])
    excess = np.array([[0.01, 0.9], [np.nan, 0.03]])
    shares = np.array([[1.0, 0.99], [np.nan, 0.98]])
    values = {
        "range": pinned * (1 + excess),
        "pinned_range": pinned,
        "deviation": excess,
        "separation_fraction": np.array([[0.1, 0.3], [np.nan, 0.15]]),
        "vibration_share": shares,
        "force_share": np.array([[1.0, 0.5], [np.nan, 0.97]]),
    }
    data = {name: (("m", "begin"), column) for name, column in values.items()}
    base = {"base": '{"normalization": "as_published"}'}
    return xr.Dataset(data, {"m": [0.1, 0.2], "begin": ["static", "displaced"]}, base)


def test_motions_of_one_frequency_are_filled_and_those_set_apart_have_their_own_mark() -> None:
    figure = draw("range_law", separating_motions(), set_apart={"heavy": {"m": 0.2}})
    whole, enlarged = figure.axes
    marks = {}
    for line in whole.lines:
        if line.get_marker() != "None" and line.get_xdata().size:
            is_filled = line.get_markerfacecolor() != "white"
            marks[line.get_marker(), is_filled] = line.get_xydata().ravel().tolist()
    assert marks == {
        ("o", True): pytest.approx([4.0, 1.0]),
        ("o", False): pytest.approx([8.0, 90.0]),
        ("s", True): pytest.approx([16.0, 3.0]),
    }
    heights = np.concatenate(
        [line.get_ydata() for line in enlarged.lines if line.get_marker() in "os"]
    )
    assert sorted(heights) == pytest.approx([1.0, 3.0, 35.0]), "what is far off stands at the edge"
    assert labels(figure) == [
        "(b) from flights: (π · time apart)²/8",
        "modes as published",
        "heavy",
        "no frequency carries 95 % of height and contact force",
    ]


def _said(ax: Axes) -> list[str]:
    """Words in a panel."""
    return [text.get_text() for text in ax.texts]


# ---- locking


def locked_at(speeds: list[float], releases: list[int], separations: list[int]) -> xr.Dataset:
    """Motions over the speed; a period of no release is undecided."""
    words = ["undecided", "locked", "without_stick"]
    data = {
        "motion": ("Omega", np.array([int(n > 0) for n in releases], dtype=np.int8)),
        "period_releases": ("Omega", np.array(releases)),
        "period_separations": ("Omega", np.array(separations)),
        "separations_per_release": ("Omega", np.full(len(speeds), 10.7)),
    }
    study = xr.Dataset(data, {"Omega": speeds}, {"base": '{"normalization": "as_published"}'})
    study["motion"].attrs["flag_meanings"] = " ".join(words)
    return study


def test_equal_periods_side_by_side_are_one_step_and_undecided_ones_are_rings() -> None:
    coarse = locked_at([19.8, 19.9, 20.0, 20.2], [34, 34, 35, 0], [371, 371, 371, 0])
    fine = locked_at([19.96, 20.0, 20.1], [69, 35, 41], [742, 371, 449])
    slipping = locked_at([19.8, 20.2], [0, 0], [0, 0])
    slipping["motion"][:] = 2
    phrase = {"x": "Omega", "zooms": [[19.95, 20.05]]}
    overlays = {"fine": fine, "slipping": slipping}
    figure = draw("staircase", coarse, overlays, **phrase)
    whole, zoom = figure.axes
    steps = [line.get_xydata().tolist() for line in whole.lines if line.get_linestyle() == "-"]
    assert steps == [
        [[19.8, pytest.approx(371 / 34)], [19.9, pytest.approx(371 / 34)]],
        [[19.96, pytest.approx(742 / 69)], [19.96, pytest.approx(742 / 69)]],
        [[20.0, pytest.approx(371 / 35)], [20.0, pytest.approx(371 / 35)]],
        [[20.1, pytest.approx(449 / 41)], [20.1, pytest.approx(449 / 41)]],
    ]
    marks = [line for line in whole.lines if line.get_linestyle() == "None"]
    places = {line.get_marker(): line.get_xydata().tolist() for line in marks}
    assert places["o"] == [[20.2, 10.7]]
    # the motion that never sticks
    assert places["D"] == [[19.8, TOP], [20.2, TOP]]
    assert [text.get_text() for text in zoom.texts] == ["69 releases", "35"]


def test_motions_without_a_release_stand_above_the_axis_of_separations_per_release() -> None:
    study = locked_at([19.8, 19.9, 20.0], [34, 35, 36], [371, 372, 373])
    slipping = locked_at([19.8, 20.0], [0, 0], [0, 0])
    slipping["motion"][:] = 2
    [ax] = draw("staircase", study, {"slipping": slipping}, x="Omega").axes
    low, high = ax.get_ylim()
    _, end = ax.spines["left"].get_bounds()
    assert max(ax.get_yticks()) <= end < low + TOP * (high - low)
    assert max(max(line.get_ydata()) for line in ax.lines if line.get_marker() == "o") < end


def test_periods_of_other_separations_are_other_steps() -> None:
    study = locked_at([19.8, 19.9, 20.0], [34, 34, 34], [371, 372, 372])
    (ax,) = draw("staircase", study, x="Omega").axes
    steps = [[*line.get_xdata()] for line in ax.lines if line.get_linestyle() == "-"]
    assert steps == [[19.8, 19.8], [19.9, 20.0]]


def test_zooms_must_ascend() -> None:
    grid = {"quantity": "locking", "base": {"N": 200}, "axes": {"Omega": [19, 20]}}
    figures = {"a": {"kind": "staircase", "x": "Omega", "zooms": [[20, 19]]}}
    with pytest.raises(StudyError, match=r"zooms=.*must be two ascending values of x"):
        computed(**grid, figures=figures)


def test_the_map_of_phases_names_the_pieces_near_the_motion() -> None:
    phase = np.linspace(0.6, 0.98, 39)
    around = np.tile([0.05, -0.05, np.nan], 13)
    study = xr.Dataset(
        {
            "map_phase": ("probe", phase),
            "map_next_phase": ("probe", np.where(phase < 0.8, phase + 0.1, phase - 0.05)),
            "map_separations": ("probe", np.where(phase < 0.8, 17.0, 2.0)),
            # beside 0.94 and 0.97 slopes vary, also to unknown ones
            "map_slope": ("probe", np.where(phase < 0.8, 0.94, 0.97) + around),
            "release_phase": ("release", np.array([0.76, 0.86, 0.81, np.nan])),
        },
        attrs={"base": '{"normalization": "as_published"}'},
    )
    whole, near = draw("phase_map", study).axes
    assert not whole.texts
    assert {text.get_text() for text in near.texts} == {
        "17 separations,\nslope 0.94",
        "2 separations,\nslope 0.98",  # 0.97 and a fifth of 0.05: of five slopes that are known
    }
    rings = [line for line in near.lines if line.get_marker() == "o"]
    assert rings[0].get_xydata().tolist() == [[0.76, 0.86], [0.86, 0.81]]


def test_the_share_of_starts_that_have_separated_rises_at_each_separation() -> None:
    """Of four starts that were computed two separate, and one more has failed."""
    dims = ("N", "perturbation_u")
    data = {
        "status": (dims, [[0, 0, 0, 0, 1]], {"flag_meanings": "ok failed"}),
        "first_separation": (dims, [[9.0, np.nan, 4.0, np.nan, np.nan]]),
    }
    axes = {"N": [550.0], "perturbation_u": 1e-9 * np.arange(5)}
    study = xr.Dataset(data, axes, {"options": '{"horizon": 20}', "base": '{"disc": "table"}'})
    (ax,) = draw("escape", study).axes
    line, interval = ax.lines
    np.testing.assert_allclose(line.get_xdata(), [0, 4, 9, 20])
    np.testing.assert_allclose(line.get_ydata(), [0, 0.25, 0.5, 0.5])
    # each share lasts from its separation to the next one, so none rises before its cause
    assert line.get_drawstyle() == "steps-post"
    low, high = interval.get_ydata()
    assert low < 0.5 < high
    assert 0.5 - low == pytest.approx(high - 0.5)
    assert _said(ax) == ["2 of 4"]
    [counted] = ax.texts
    ax.figure.draw_without_rendering()
    assert counted.get_window_extent().x0 > ax.bbox.x1, "no line is there"


def test_preloads_of_late_ranges_have_their_symbol() -> None:
    """ "0.12 kN" stood for a line, and nothing said of what."""
    said = labels(of_example("late_range"))
    assert "N = 0.12 kN" in said
    pyplot.close("all")


def test_frequencies_of_a_campbell_diagram_end_at_the_highest_asked_for() -> None:
    above = campbell(highest="0.15 kHz").axes[0]
    assert above.get_ylim() == (0, 150)
    named = {text.get_text() for text in above.texts}
    assert "l = 2" in named
    assert "l = 3" not in named, "its mode ends at 182 Hz"


def test_sliding_modes_above_the_highest_frequency_are_counted() -> None:
    assert not [text for text in labels(sliding_modes()) if text.startswith("cut")]
    cut = labels(sliding_modes(highest=150.0))
    assert [text for text in cut if text.startswith("cut at 150 Hz: ")]


def test_lines_of_sliding_modes_and_of_probabilities_are_named() -> None:
    *lines_of_modes, below_the_axis = labels(sliding_modes())
    assert lines_of_modes == ["mode decays", "mode grows"]
    assert below_the_axis == "decays faster than 0.9/s: l = 1, l = 3"
    assert "all of its values" in labels(sensitivity())


@pytest.mark.parametrize(
    ("share", "text"), [(0.0, "0 %"), (0.004, "< 1 %"), (0.006, "1 %"), (0.52, "52 %")]
)
def test_a_share_that_rounds_to_nothing_is_told_from_none(share: float, text: str) -> None:
    assert percent(share) == text.replace(" ", "\u00a0")
