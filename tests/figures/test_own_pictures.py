"""Pictures that results draw of themselves name their quantities and units, and show their values in
them."""

import functools
import re
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text

import disc_model as dm
from disc_model.data.variables import CycleStatus
from disc_model.figures.branch import _mark_special_points
from disc_model.figures.disc import Motion, scale_of
from disc_model.figures.film import film as film_of
from disc_model.simulation.api import snapshots
from disc_model.simulation.states import static_start
from disc_model.stability.critical_values import Critical
from disc_model.stability.curves import NeutralCurves
from disc_model.stability.cycle import FloquetResult
from disc_model.stability.lyapunov import Lyapunov
from tests.blocks import RIG
from tests.figures.every_kind import flag
from tests.figures.measured import Shown, assert_shows, drawn_values
from tests.figures.reading import as_map, draw, labels, lines
from tests.refusals import refusal

P = dm.Parameters(N=385, Omega=15.1)


@functools.cache
def run() -> dm.Result:
    windows = {"late": dm.Window(last=0.05, rate=2e4, theta=0.5)}
    return dm.simulate(P, 56, windows)


def figure_of(drawn: object) -> Figure:
    return np.ravel(np.asarray(drawn, dtype=object))[0].get_figure()


def test_a_run_has_its_windows_in_seconds_newtons_and_millimetres() -> None:
    late = run()["late"]
    figure = figure_of(run().plot("late", variables=["P", "w_point"]))
    shown = [
        Shown(0, "y", "Contact force P", late["P"][::20], "N"),
        Shown(1, "y", r"Disc at r_0, \theta = 0.5 rad", late["w_point"][::20], "m"),
        Shown(1, "x", "Time", late["time"][::20], "s"),
    ]
    for expected in shown:
        assert_shows(figure, expected)


def test_a_portrait_and_a_section_have_the_units_of_their_variables() -> None:
    late = run()["late"]
    figure = figure_of(run().plot_phase_portrait("late", x="w", y="u_velocity"))
    assert_shows(figure, Shown(0, "x", "Disc under the slider w", late["w"][::20], "m"))
    assert_shows(figure, Shown(0, "y", "Slider du/dt", late["u_velocity"][::20], "m/s"))
    section = figure_of(run().plot_poincare())
    assert [ax.get_xlabel().split()[-1] for ax in section.axes[:2]] == ["(rad)", "(mm)"]
    assert [ax.get_ylabel().split()[-1] for ax in section.axes[:2]] == ["(rad/s)", "(m/s)"]


def test_a_section_shows_the_samples_that_were_recorded_of_it() -> None:
    """It was always that of the whole run, whatever had been recorded."""
    windows = {
        "late": dm.Poincare(start=4),
        "one": dm.Poincare(start=9.7),
        "none": dm.Poincare(start=9.99),
        "w": dm.Window(rate=9),
    }
    recorded = dm.simulate(P, 10, windows)
    drawn = np.concatenate(
        [marks.get_offsets()[:, 0] for marks in recorded.plot_poincare("late")[0].collections]
    )
    assert sorted(drawn) == pytest.approx(sorted(recorded["late"]["psi"].values))
    rule = r"must be a recorded Poincare with samples.* \(known: late, one\)"
    assert recorded.plot_poincare("one").size == 2  # it divided by the range of one sample
    for name in ("none", "w", "x"):  # no sample, no section, not recorded
        with refusal(rf"window='{name}': {rule}"):
            recorded.plot_poincare(name)


def test_the_head_of_a_run_with_ramps_has_the_speeds_that_they_lead_to() -> None:
    """It had the speed at the start alone."""
    up = dm.Ramp(parameter="Omega", to=16, start=0, end=0.1)
    down = dm.Ramp(parameter="Omega", to=8, start=0.2, end=0.3)
    head = figure_of(dm.simulate(P, 0.4, ramps=(up, down)).plot()).get_suptitle()
    assert head == "N = 385 N, Ω = 15.1 to 16 to 8 rad/s"


def test_multipliers_come_with_growth_per_second_and_the_period_in_milliseconds() -> None:
    cycle = dm.floquet(P.replace(Omega=15))
    figure = figure_of(cycle.plot())
    title = " ".join(figure.axes[0].get_title(loc="left").split())
    growth = re.search(r"growth rate (-?[\d.]+)/s", title)
    period = re.search(r"period ([\d.]+) (m?s)", title)
    assert float(growth[1]) == pytest.approx(cycle.growth_rate, rel=5e-3)
    assert period[2] == "ms"
    assert float(period[1]) == pytest.approx(1e3 * cycle.period, rel=5e-4)
    assert_shows(figure, Shown(0, "x", "Re κ", cycle.multipliers.real))
    assert_shows(figure, Shown(0, "y", "Im κ", cycle.multipliers.imag))


def test_multipliers_outside_the_unit_circle_grow_whatever_their_angle() -> None:
    values = np.array([0.9 + 0.9j, 0.9 - 0.9j, -1.2, 0.99, -0.3])
    cycle = FloquetResult(P, 1e-12, CycleStatus.OK, "made up", 0.015, values, growth_rate=16.1)
    [ax] = figure_of(cycle.plot()).axes
    shown = lines(ax)
    assert not ax.texts, "multipliers may lie anywhere in the panel"
    assert labels(ax.figure) == ["decays", "grows", "largest |κ| = 1.2728"]
    assert shown["grows"].get_xdata().tolist() == [0.9, 0.9, -1.2]
    assert shown["decays"].get_xdata().tolist() == [0.99, -0.3]


def test_eigenvalues_are_in_hertz_and_per_second() -> None:
    sliding = dm.steady_sliding(P)
    values = sliding.eigenvalues[sliding.eigenvalues.imag >= 0]
    figure = figure_of(sliding.plot())
    assert_shows(figure, Shown(0, "x", "Growth rate", values.real, "1/s"))
    assert_shows(figure, Shown(0, "y", "Frequency", values.imag / (2 * np.pi), "Hz"))
    assert figure.get_suptitle() == "N = 385 N, Ω = 15.1 rad/s"


def test_a_mode_that_neither_grows_nor_decays_is_neutral() -> None:
    """An undamped slider's motion in the plane was drawn as one that decays."""
    figure = figure_of(dm.steady_sliding(P.replace(mu_k=0)).plot())
    alone = np.sqrt(P.k_p / P.m) / (2 * np.pi)  # the slider on its spring, without friction
    shown = lines(figure.axes[0])
    assert shown["neutral"].get_ydata() == pytest.approx([alone])


@functools.cache
def branch() -> Any:
    return dm.continue_cycle(P.replace(Omega=14.9), "Omega", (14.8, 15.0))


@pytest.mark.parametrize(
    ("y", "words", "unit"),
    [
        ("growth_rate", "Growth rate of the cycle", "1/s"),
        ("period", "Period", "s"),
        ("stick_fraction", "Share of the period spent sticking", ""),
        ("range", "Range of the slider's height over a period", "m"),
    ],
)
def test_a_branch_has_the_variable_that_is_asked_for(y: str, words: str, unit: str) -> None:
    figure = figure_of(branch().plot(y))
    label = figure.axes[0].get_ylabel().replace("\n", " ")
    assert label.startswith(words)
    assert_shows(figure, Shown(0, "x", "Speed Ω", branch().values[:, 0], "rad/s"))
    known = label.rpartition(" (")[0] or label
    assert_shows(figure, Shown(0, "y", known, getattr(branch(), y), unit))


@pytest.mark.parametrize(
    ("y", "factor"), [("growth_rate", 1.0), ("period", 1e3), ("stick_fraction", 1.0)]
)
def test_a_special_point_is_marked_in_the_units_of_both_axes(y: str, factor: float) -> None:
    """The axis of periods is in ms."""
    p = P.replace(Omega=14.9)
    branch = dm.continue_cycle(p, "Omega", (14.8, 15.2))
    (fold,) = [special for special in branch.special if special.kind == "fold"]
    (ax,) = figure_of(branch.plot(y)).axes
    shown = lines(ax)
    mark = shown["fold at 15.095 rad/s"]
    speed = fold.values[0]
    height = factor * getattr(fold, y)
    # the same numbers, but for the factor's rounding
    assert mark.get_xdata() == pytest.approx([speed], rel=1e-12)
    assert mark.get_ydata() == pytest.approx([height], rel=1e-12)


TOO_MANY_POINTS = "continued no further: max_points"


def branch_of_three_points() -> dm.Branch:
    """A branch that is not continued to its bounds."""
    steps = dm.StepControl(max_points=3)
    case = P.replace(Omega=14.9)
    return dm.continue_cycle(case, "Omega", (14.8, 15.2), steps=steps)


def test_ends_at_which_a_branch_is_not_continued_say_so() -> None:
    """Their pictures ended as if the branch did, while other ends had a mark and words."""
    branch = branch_of_three_points()
    ax = branch.plot("period")
    last_speed = branch.values[-1, 0]
    mark = lines(ax)[TOO_MANY_POINTS]
    assert TOO_MANY_POINTS in labels(ax.figure)
    assert mark.get_xdata().tolist() == [last_speed]


def test_an_end_at_which_no_step_succeeds_says_so() -> None:
    in_milliseconds = (1.0, 1e3)
    lost = SimpleNamespace(kind="lost", values=[15.0], period=0.014)
    branch: Any = SimpleNamespace(special=[lost], parameters=("Omega",))
    _, ax = pyplot.subplots()
    [entry] = _mark_special_points(ax, branch, "period", in_milliseconds)
    assert entry.get_label() == "continued no further: no step succeeds"


def test_a_special_point_of_a_stiffness_is_marked_in_kilonewtons() -> None:
    branch = dm.continue_cycle(P.replace(Omega=15), "k_p", (1.9e4, 2.1e4))
    (fold,) = [special for special in branch.special if special.kind == "fold"]
    (ax,) = figure_of(branch.plot("growth_rate")).axes
    mark = lines(ax)["fold at 20.027 kN/m"]
    assert mark.get_xdata() == pytest.approx([fold.values[0] / 1e3], rel=1e-12)
    assert "kN/m" in ax.get_xlabel()


ORTHONORMAL = dm.Parameters(N=385, Omega=14.9, normalization="orthonormal")
QUIET = P.replace(Omega=14.9)


@functools.cache
def orthonormal_branch() -> Any:
    bounds = (10.9, 15.2)
    return dm.continue_cycle(ORTHONORMAL, "Omega", bounds)


def thick_ends(ax: Any) -> list[float]:
    """First and last place of each thick line, one after the other."""
    widths = [line.get_linewidth() for line in ax.lines]
    widest = max(widths)
    ends = []
    for line in ax.lines:
        places = line.get_xdata()
        if line.get_linewidth() == widest:
            ends += [places[0], places[-1]]
    return ends


def test_a_branch_is_thick_up_to_its_bifurcations() -> None:
    """It was thin from the last stable point computed, 12.48 rad/s, to the bifurcation at 12.83."""
    branch = orthonormal_branch()
    ax = branch.plot("period")
    ends = thick_ends(ax)
    located = []
    for special in branch.changes:
        if special.changes_stability:
            located.append(special.values[0])
    assert ends == pytest.approx(located, rel=1e-12)  # the located points themselves
    assert located == pytest.approx(
        [11.6371, 12.3311, 12.3291, 12.8303, 12.8363, 14.8274],
        abs=1e-4,  # as they are written here
    )


def test_a_branch_that_ends_at_a_fold_is_thick_up_to_it() -> None:
    """The fold is its last point, too, whose growth rate is rounding."""
    branch = dm.continue_cycle(QUIET, "Omega", (14.8, 15.2), stop_at="fold")
    ax = branch.plot()
    fold = branch.folds[0, 0]
    assert thick_ends(ax) == [14.8, fold]


def test_branches_on_the_same_axes_share_a_legend() -> None:
    """All were black, with "fold at 15.095 rad/s" and "2 folds" beside each other."""
    bounds = (14.8, 15.2)
    folded = dm.continue_cycle(QUIET, "Omega", bounds)
    ax = branch().plot("period")
    folded.plot("period", ax=ax, labels={"branch": "quiet"})
    orthonormal_branch().plot("period", ax=ax)
    (legend,) = ax.figure.legends
    words = [text.get_text() for text in legend.get_texts()]
    kinds = ["stable", "unstable", "fold", "Neimark-Sacker bifurcation"]
    assert words[1] == "quiet"
    assert words[3:] == kinds
    colours = [line.get_color() for line in legend.get_lines()[:3]]
    assert len({*colours}) == 3
    drawn = {line.get_color() for line in ax.lines if line.get_linestyle() != "None"}
    assert {*colours} <= drawn
    said_of_all = [line.get_color() for line in legend.get_lines()[3:5]]
    assert not {*said_of_all} & drawn, "a black line was one more stability"


def test_a_doubled_branch_is_named_by_its_releases() -> None:
    """The first was "branch 1", and both needed names by hand."""
    case = dm.Parameters(N=400, Omega=14, mu_k=0.0675)
    bounds = (0.0671, 0.0685)
    single = dm.continue_cycle(case, "mu_k", bounds)
    [start] = [special for special in single.special if special.kind == "period_doubling"]
    doubled = dm.continue_cycle(start.case, "mu_k", bounds, guess=start.state, releases=2)
    ax = single.plot("period")
    doubled.plot("period", ax=ax)
    words = [text.get_text() for text in ax.figure.legends[0].get_texts()]
    assert words[:2] == ["1 release per period", "2 releases per period"]
    again = dm.Branch.from_dataset(doubled.to_dataset())
    assert {*again.releases.tolist()} == {2}


def test_branches_of_one_name_are_told_apart_by_numbers() -> None:
    """Of three branches two had the same name, and the legend left one out; then two had numbers, and
    which was the second was a guess."""
    ax = None
    for N, speed in ((350, 11.0), (385, 11.0), (350, 11.2)):
        branch = dm.continue_cycle(dm.Parameters(N=N, Omega=speed), "Omega", (10.9, 11.3))
        ax = branch.plot("period", ax=ax)
    assert ax is not None
    said = [text.get_text() for text in ax.figure.legends[0].get_texts()]
    assert said[:3] == ["N = 350 N, branch 1", "N = 385 N, branch 2", "N = 350 N, branch 3"]


def test_a_branch_at_values_of_table_1_is_named_by_them() -> None:
    """It was "branch 2" beside "m = 90 g" and "m = 110 g"."""
    ax = None
    for mass in (0.09, 0.1, 0.11):
        branch = dm.continue_cycle(dm.Parameters(N=350, Omega=11, m=mass), "Omega", (11, 11.2))
        ax = branch.plot("period", ax=ax)
    assert ax is not None
    assert {"m = 90 g", "m = 100 g", "m = 110 g"} <= {
        text.get_text() for text in ax.figure.legends[0].get_texts()
    }


"""A block on a rigid disc, whose stick-slip has no memory of the cycle before: all multipliers are 0."""


def all_words_of(ax: Axes) -> str:
    """All that stands in the figure of a picture."""
    texts = ax.figure.findobj(Text)
    return " ".join(text.get_text() for text in texts)


@functools.cache
def critical_stiffness() -> Critical:
    bounds = (1.8e4, 2.2e4)
    return dm.critical(P.replace(Omega=12), "k_p", bounds, points=5, precision=10.0)


def test_critical_values_of_minus_infinity_stand_at_the_lower_edge() -> None:
    """The picture had a legend, and nothing else."""
    found = dm.critical(RIG, "Omega", (1, 2), points=3)
    assert np.isneginf(found.growth_rate).all()
    ax = found.plot()
    assert "growth rate −∞" in labels(ax.figure)
    [triangles] = [line for line in ax.lines if line.get_marker() == "v"]
    assert triangles.get_xdata().tolist() == found.values.tolist()


def test_critical_values_are_over_the_parameter_and_growth_per_second() -> None:
    critical = critical_stiffness()
    figure = figure_of(critical.plot())
    assert_shows(figure, Shown(0, "x", "In-plane spring k_p", critical.values, "N/m"))
    assert_shows(figure, Shown(0, "y", "Growth rate of the cycle", critical.growth_rate, "1/s"))


def test_what_is_unstable_is_shaded_in_the_unit_of_the_axis() -> None:
    """The in-plane spring in kN/m, of 1e3 N/m; outside, the motion is stable."""
    made = Critical(
        parameters=P,
        name="k_p",
        value=2.1e4,
        crossings=np.array([2.1e4, 2.3e4, 2.6e4]),
        unstable_above=np.array([True, False, True]),
        values=np.array([2e4, 2.5e4, 3e4]),
        growth_rate=np.array([-0.1, np.nan, 0.3]),
        resolution=5e3,
    )
    ax = figure_of(made.plot()).axes[0]
    assert ax.get_xlabel() == r"In-plane spring $\mathrm{k_p}$ (kN/m)"
    spans = [(patch.get_x(), patch.get_x() + patch.get_width()) for patch in ax.patches]
    assert spans == [pytest.approx((21, 23)), pytest.approx((26, 30))]
    assert ax.get_xlim() == (20, 30)
    names = [text.get_text() for text in ax.figure.legends[0].get_texts()]
    assert names == ["unstable near the static start", "cycles computed", "no cycle found"]
    assert lines(ax)["no cycle found"].get_xdata().tolist() == [25]
    note = "unstable from 21 kN/m\ntongues narrower than 5 kN/m may be missed"
    assert ax.get_title(loc="left") == note


def test_neutral_curves_have_both_parameters_in_their_units() -> None:
    curves = dm.neutral_curves(P, {"Omega": (14, 15.5), "k_p": (1.9e4, 2.1e4)}, [2e4], points=5)
    figure = figure_of(curves.plot())
    points = np.concatenate([curve.values for curve in curves])
    assert_shows(figure, Shown(0, "x", "Speed Ω", points[:, 0], "rad/s"))
    assert_shows(figure, Shown(0, "y", "In-plane spring k_p", points[:, 1], "N/m"))


def test_without_a_neutral_curve_there_is_an_error_and_no_empty_picture() -> None:
    """Axes were empty, without a word."""
    nothing = NeutralCurves(P, {"Omega": (14.0, 16.0), "N": (350.0, 420.0)}, (), ())
    with refusal("curves=0: there is nothing to draw"):
        nothing.plot()
    assert pyplot.get_fignums() == []


def test_exponents_are_per_second() -> None:
    exponents = dm.lyapunov_exponents(P, 0.5, count=2)
    figure = figure_of(exponents.plot())
    assert_shows(figure, Shown(0, "y", "Lyapunov exponent", exponents.exponents, "1/s"))
    assert figure.get_suptitle() == "N = 385 N, Ω = 15.1 rad/s"
    assert figure.axes[0].get_title(loc="left").startswith("over 0.5 s")


def test_modes_have_their_frequencies_in_hertz() -> None:
    modes = dm.plate_modes(P).sort_values("omega")
    titles = [ax.get_title(loc="center") for ax in dm.plot_modes(P)]
    shown = [float(re.search(r"([\d.]+) Hz", title)[1]) for title in titles]
    assert shown == pytest.approx((modes["omega"] / (2 * np.pi)).tolist(), abs=0.5)
    kinds = zip(modes["diameters"], modes["circles"], strict=True)
    names = [f"({diameters}, {circles})" for diameters, circles in kinds]
    assert [title.partition("  ")[0] for title in titles] == names
    with_circles = P.replace(n_diameters=1, n_circles=1)
    titles = [ax.get_title(loc="center") for ax in dm.plot_modes(with_circles)]
    assert {title.partition("  ")[0] for title in titles} == {
        "(0, 0)",
        "(1, 0)",
        "(0, 1)",
        "(1, 1)",
    }


def test_a_film_is_in_milliseconds_newtons_and_millimetres() -> None:
    late = run()["late"]
    times = np.linspace(float(late["time"][0]), float(late["time"][-1]), 4)
    states = snapshots(P, times)
    figure = pyplot.figure()
    film = film_of(figure, Motion.of(P, states), late["time"].values, late["P"].values)
    film._draw_frame(3)
    _, circle, trace = figure.axes
    assert trace.get_xlabel() == "Time (ms)"
    duration = times[-1] - times[0]
    last = drawn_values(trace, "x").max()
    assert last == pytest.approx(1e3 * duration)
    assert_shows(figure, Shown(2, "y", "Contact force P", late["P"][::50], "N"))
    assert_shows(figure, Shown(1, "y", "Deflection at r_0", [states[3].u], "m"))
    assert circle.get_title().startswith("50.0 ms")
    scale = scale_of(Motion.of(P, states))
    assert circle.get_ylim() == pytest.approx((scale.vmin, scale.vmax))
    film._draw_frame(1)
    _, dot = figure.axes[2].lines
    assert dot.get_xdata()[0] == pytest.approx(1e3 * (times[1] - times[0]))
    force = np.interp(times[1], late["time"].values, late["P"].values)
    assert dot.get_ydata()[0] == pytest.approx(force)


@pytest.mark.parametrize("grows_above", [True, False])
def test_the_most_decisive_parameter_is_on_top_by_its_largest_change(grows_above: bool) -> None:
    """One parameter decides at one preload alone, another a little at both; whether more or less of
    it makes the motion unstable."""
    samples = 30
    share = (np.arange(samples) + 0.5) / samples
    values = np.stack([share, np.roll(share, 7), np.roll(share, 13)], axis=-1)
    words = np.full((2, samples), "stable", dtype=object)
    unstable = share > 1 / 3
    if not grows_above:
        unstable = share < 2 / 3
    words[0, unstable] = "unstable"
    study = xr.Dataset(
        {
            "parameter_values": (("N", "sample", "parameter"), np.stack([values, values])),
            "cycle": flag(("N", "sample"), words, ("failed", "stable", "unstable")),
            "status": flag(("N", "sample"), np.full((2, samples), "ok"), ("ok", "excluded")),
            "probability_unstable": ("N", [2 / 3, 0.0]),
        },
        {"N": [200.0, 385.0], "parameter": ["k", "mu_s", "c_p"]},
    )
    study["N"].attrs.update(units="N", long_name="preload")
    figure = draw("sensitivity", study)
    names = [text.get_text() for text in figure.axes[0].get_yticklabels()]
    assert names[-1] == "k"
    lowest, highest = figure.axes[0].containers
    assert lowest[0].get_xdata()[-1] == float(not grows_above)
    assert highest[0].get_xdata()[-1] == float(grows_above)


def test_a_map_has_the_colours_of_its_numbers_in_the_unit_of_its_bar() -> None:
    heights = xr.DataArray(
        [[1e-3, 4e-3], [2e-3, 3e-3]], dims=("N", "Omega"), name="u_max", attrs={"units": "m"}
    )
    study = heights.to_dataset().assign_coords(N=[100.0, 200.0], Omega=[10.0, 20.0])
    ax = as_map(study, "u_max")
    [mesh] = [shape for shape in ax.collections if shape.get_array() is not None]
    bar = ax.figure.axes[1]
    if bar.get_ylabel().endswith("(mm)"):
        factor = 1e3
    else:
        factor = 1.0
    assert mesh.norm.vmin == pytest.approx(1e-3 * factor)
    assert mesh.norm.vmax == pytest.approx(4e-3 * factor)
    assert bar.get_ylim() == pytest.approx((1e-3 * factor, 4e-3 * factor))


def test_exponents_that_have_not_converged_are_told_from_others() -> None:
    made = Lyapunov(
        status=dm.Status.OK,
        exponents=np.array([0.5, -0.1, -np.inf]),
        errors=np.array([0.1, 0.2, np.nan]),
        duration=20.0,
        separations=1,
        converged=np.array([True, False, False]),
        final_state=static_start(P),
    )
    figure = figure_of(made.plot())
    [ax] = figure.axes
    numbers = {}
    for bars in ax.containers:
        [points, *_] = bars
        numbers[bars.get_label()] = points.get_xdata().tolist()
        is_filled = points.get_markerfacecolor() != "white"
        assert is_filled is bars.get_label().startswith("filled"), "as in sweeps"
    assert numbers == {
        "converged, ± standard error": [1],
        "filled: not converged, ± standard error": [2],
    }
    assert ax.get_title(loc="left") == "over 20 s, 1 separation"
