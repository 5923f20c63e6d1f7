"""Pictures on a reader's axes in figures as low and narrow as those of a journal's column."""

import functools
import json
from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot
from matplotlib.colors import same_color, to_hex
from matplotlib.text import Text

import disc_model as dm
from disc_model.figures.gap_rows import rows_above
from disc_model.figures.labels import break_labels, in_lines
from disc_model.figures.legends import finds_room_inside
from disc_model.figures.names import Names
from disc_model.figures.rate_scale import OPEN
from disc_model.figures.sizes import COLUMN, INCH, PAGE
from disc_model.figures.symbols import broken
from tests.figures.reading import assert_numbers_are_apart

CASE = dm.Parameters(N=385, Omega=15, n_diameters=2)
LEAST = 23.0
"""Side of panels, mm, that the documentation promises."""


def assert_on_page(figure: Any) -> None:
    """All words lie on the page, and none of a legend on numbers or labels."""
    figure.draw_without_rendering()
    width, height = figure.bbox.size
    for ax in figure.axes:
        legend = ax.get_legend()
        labels = [axis.label for axis in (ax.xaxis, ax.yaxis) if axis.get_visible()]
        texts = [*labels, *ax.texts]
        texts += [each for each in ax.get_children() if isinstance(each, Text)]
        texts += legend.get_texts() if legend is not None else []
        for text in texts:
            box = text.get_window_extent()
            inside = min(box.x0, box.y0) > -1 and box.x1 < width + 1 and box.y1 < height + 1
            assert inside or not text.get_text().strip(), text.get_text()
        assert_numbers_are_apart(ax)


def side(ax: Any) -> float:
    """The shorter side of a panel, mm."""
    return float(min(ax.bbox.width, ax.bbox.height) / ax.figure.dpi * INCH)


@pytest.mark.parametrize("layout", [None, "constrained"])
@pytest.mark.parametrize("width", [COLUMN, pytest.param(PAGE, marks=pytest.mark.slow)])
@pytest.mark.parametrize("count", [pytest.param(1, marks=pytest.mark.slow), 2])
def test_multipliers_keep_their_circle_beside_their_legend(
    layout: Any, width: float, count: int
) -> None:
    """The legend stood below it even on wide pages, and left a circle of 8 mm below a note that ran
    off the page."""
    figure, ax = pyplot.subplots(figsize=(width, 2.4), layout=layout)
    for speed in (15, 13)[:count]:
        dm.floquet(CASE.replace(Omega=speed)).plot(ax=ax)
    assert_on_page(figure)
    assert side(ax) >= LEAST
    pyplot.close(figure)


def test_a_label_of_an_axis_that_is_shorter_than_its_words_is_broken() -> None:
    """It stayed in one line, and left the page."""
    figure, ax = pyplot.subplots(figsize=(COLUMN, 2.4))
    ax.set_position((0.2, 0.2, 0.05, 0.05))
    words = "a note of some words"
    ax.set_title(words, loc="left")
    break_labels(figure, [ax])
    assert ax.get_title(loc="left") == in_lines(words, len(words.split()))
    pyplot.close(figure)


@pytest.mark.parametrize("layout", [None, "constrained"])
def test_labels_of_panels_beside_each_other_stay_off_these(layout: Any) -> None:
    """In a grid without a layout those of the second column stood on the first."""
    figure, axes = pyplot.subplots(2, 2, figsize=(COLUMN, 4.6), layout=layout)
    for row in axes:
        for ax, name in zip(row, ("growth_rate", "period"), strict=True):
            dm.plot_sweep(growth([0.01, 0.0, -0.1, np.nan, 0.6, 0.1]), name, ax=ax)
    figure.draw_without_rendering()
    for left, right in axes:
        assert right.yaxis.label.get_window_extent().x0 > left.bbox.x1
    pyplot.close(figure)


SPEEDS = [10.0, 12.0, 14.0, 16.0, 18.0, 20.0]
STATUS = {"flag_values": np.arange(2, dtype=np.int8), "flag_meanings": "ok no_cycle"}


def growth(rates: Any) -> xr.Dataset:
    """Growth rates of a cycle over the speed, nan where none was found, and its periods."""
    found = np.array(rates)
    data = {
        "growth_rate": (
            "Omega",
            found,
            {"units": "s-1", "long_name": "growth rate of the stick-slip cycle"},
        ),
        "period": (
            "Omega",
            np.where(np.isnan(found), np.nan, 0.016 - 1e-4 * np.arange(6)),
            {"units": "s", "long_name": "period of the stick-slip cycle"},
        ),
        "status": ("Omega", np.isnan(found).astype(np.int8), STATUS),
    }
    speed = ("Omega", SPEEDS, {"units": "rad s-1"})
    return xr.Dataset(data, {"Omega": speed}, {"base": '{"N": 385}'})


def rows_of(figure: Any) -> list[Any]:
    """The rows of marks above all panels of a figure."""
    return [row for ax in figure.axes for row in rows_above(ax)]


@pytest.mark.parametrize("layout", [None, "constrained"])
def test_twin_axes_of_a_column_say_once_what_has_no_value(layout: Any) -> None:
    """Each wrote it over the words of the other, and labels of many lines left the page."""
    study = growth([0.01, 0.0, -0.1, np.nan, 0.6, 0.1])
    figure, ax = pyplot.subplots(figsize=(COLUMN, 2.4), layout=layout)
    dm.plot_sweep(study, "growth_rate", ax=ax)
    dm.plot_sweep(study, "period", ax=ax.twinx())
    assert_on_page(figure)
    said = [row.words.get_text().replace("\n", " ") for row in rows_of(figure)]
    assert said == ["no cycle found", OPEN]
    assert [len(row.rows) for row in rows_of(figure)] == [2, 2]
    assert side(ax) > 18
    pyplot.close(figure)


def test_a_row_of_marks_is_nearer_to_its_own_words_on_a_strip() -> None:
    """A stroke lay midway between two notes, and a ring above the frame looked like a value."""
    figure, ax = pyplot.subplots(figsize=(COLUMN, 2.4))
    dm.plot_sweep(growth([0.01, 0.0, -0.1, np.nan, 0.6, 0.1]), "growth_rate", ax=ax)
    figure.draw_without_rendering()
    below, above = rows_above(ax)
    middle = above.rows[0].get_window_extent()
    centre = 0.5 * (middle.y0 + middle.y1)
    to_own = above.words.get_window_extent().y0 - centre
    to_other = centre - below.words.get_window_extent().y1
    assert to_other > 1.3 * to_own
    for each in (below, above):
        strip = each.strip.get_window_extent()
        marks = each.rows[0].get_window_extent()
        assert strip.y0 <= 0.5 * (marks.y0 + marks.y1) <= strip.y1
        assert strip.width == pytest.approx(ax.bbox.width)
    pyplot.close(figure)


def test_numbers_of_a_low_scale_of_growth_rates_do_not_meet() -> None:
    """0.5, 0.2 and 0.1 were printed on each other."""
    figure, ax = pyplot.subplots(figsize=(COLUMN, 1.8))
    dm.plot_sweep(growth([0.01, 0.0, -0.1, -0.1, 0.6, 0.1]), "growth_rate", ax=ax)
    assert_on_page(figure)
    assert "0.1" in {each.get_text() for each in ax.get_yticklabels()}
    pyplot.close(figure)


@pytest.mark.parametrize(
    ("width", "height"),
    [
        (84, 50),
        pytest.param(84, 60, marks=pytest.mark.slow),
        pytest.param(84, 76, marks=pytest.mark.slow),
        (174, 50),
        pytest.param(174, 60, marks=pytest.mark.slow),
        pytest.param(174, 76, marks=pytest.mark.slow),
    ],
)
def test_speeds_of_a_hysteresis_that_were_not_found_fit_a_low_page(
    width: float, height: float
) -> None:
    """Two long notes above the panel pushed label and legend off the page."""
    speed = {"units": "rad s-1"}
    begins = (
        "speed at which separation first is found on the way up, nan if at none or at the lowest"
    )
    ends = "lowest speed to which it persists on the way down, nan if it still does at the lowest"
    data = {
        name: ("N", [np.nan, np.nan], {**speed, "long_name": words})
        for name, words in (("onset_speed", begins), ("offset_speed", ends))
    }
    study = xr.Dataset(data, {"N": ("N", [300.0, 320.0], {"units": "N"})})
    figure, ax = pyplot.subplots(figsize=(width / INCH, height / INCH))
    dm.plot_sweep(study, ["onset_speed", "offset_speed"], ax=ax)
    assert_on_page(figure)
    [row] = rows_above(ax)
    assert row.words.get_text() == "none found within the bounds"
    pyplot.close(figure)


def test_margins_are_as_wide_as_the_last_picture_needs() -> None:
    """They were never narrower again than a former title had needed."""
    figures = []
    for former in (False, True):
        figure, ax = pyplot.subplots(figsize=(COLUMN, 2.4))
        if former:
            dm.plot_sweep(growth(6 * [0.02]), "growth_rate", ax=ax, title="a\nb\nc\nd")
            ax.clear()
        dm.plot_sweep(growth([0.01, 0.02, 0.03, 0.02, 0.01, 0.0]), "growth_rate", ax=ax)
        figure.draw_without_rendering()
        figures.append(ax.get_subplotspec().get_position(figure).bounds)
        pyplot.close(figure)
    assert figures[0] == pytest.approx(figures[1], abs=0.01)


def test_both_columns_of_runs_have_room_for_their_legend() -> None:
    """It stood below the second column alone, and left the page."""
    figure, axes = pyplot.subplots(3, 2, figsize=(COLUMN, 3.6))
    for speed in (15, 18):
        dm.simulate(CASE.replace(Omega=speed), 1).plot(ax=axes)
    assert_on_page(figure)
    legend = axes[2, 1].get_legend()
    assert legend.get_window_extent().x0 < axes[2, 1].bbox.x0
    pyplot.close(figure)


@functools.cache
def run() -> dm.Result:
    return dm.simulate(CASE, 8, {"late": dm.Window(last=0.5, rate=1e4)})


@pytest.mark.parametrize("width", [COLUMN, PAGE])
def test_legends_of_one_figure_have_letters_of_one_size(width: float) -> None:
    """Those in the panels had others than those below them."""
    rates = growth([0.01, np.nan, 0.03, 0.02, 0.01, 0.0])
    lines = xr.concat([rates, rates], xr.Variable("c", [0.0, 0.1], {"units": "N s m-1"}))
    lines["growth_rate"][1] += 0.01
    crowded = lines.assign(growth_rate=lines["growth_rate"].where(lines["Omega"] < 0, 0.0))
    crowded["growth_rate"][:, -1] = 0.05
    figure, axes = pyplot.subplots(3, 1, figsize=(width, 4))
    dm.plot_sweep(lines, "growth_rate", x="Omega", ax=axes[0])
    run().plot(windows="late", variables=["u"], ax=axes[1])
    dm.plot_sweep(crowded, "growth_rate", x="Omega", ax=axes[2])
    legends: list[Any] = [ax.get_legend() for ax in axes]
    sizes = {text.get_fontsize() for legend in legends for text in legend.get_texts()}
    assert len(sizes) == 1
    pyplot.close(figure)


def shown_of(ax: Any) -> Any:
    """The line of a variable, which has more points than those that mark something."""
    return max(ax.lines, key=lambda line: len(line.get_xdata()))


@pytest.mark.parametrize("variables", [("P", "u"), ("u", "u_velocity")])
@pytest.mark.parametrize("spectrum", [False, True])
def test_heights_of_twin_axes_have_the_colours_of_their_lines(
    variables: tuple[str, str], spectrum: bool
) -> None:
    """No word said which line belonged to which axis, and phases were shaded twice."""
    figure, ax = pyplot.subplots(figsize=(COLUMN, 2.4))
    both = [ax, ax.twinx()]
    for each, variable in zip(both, variables, strict=True):
        if spectrum:
            run().plot_spectrum("late", variable=variable, ax=each)
        else:
            run().plot("late", variables=[variable], ax=each)
    assert_on_page(figure)
    colours = [shown_of(each).get_color() for each in both]
    assert len({to_hex(colour) for colour in colours}) == 2
    for each, colour in zip(both, colours, strict=True):
        assert same_color(each.yaxis.label.get_color(), colour)
        assert all(same_color(text.get_color(), colour) for text in each.get_yticklabels())
    assert not both[1].collections, "shaded once"
    assert not both[1].texts, "peaks are named once"
    pyplot.close(figure)


def directions(up: Any, down: Any) -> xr.Dataset:
    """Ranges on the way up and down of a sweep of the speed."""
    values = ("direction", "Omega"), np.array([up, down]), {"units": "m", "long_name": "range"}
    coords = {"direction": ["up", "down"], "Omega": ("Omega", [8.0, 9.0, 10.0])}
    return xr.Dataset({"range": values}, coords)


def test_marks_below_those_of_another_line_are_larger() -> None:
    """Open marks of "up" were wholly hidden below those of "down"."""
    for up, larger in (([0.0, 0.0, 1.0], True), ([0.1, 0.2, 1.0], False)):
        ax = dm.plot_sweep(directions(up, [0.0, 0.0, 0.5]), "range", x="Omega")
        first, second = ax.lines[:2]
        assert (first.get_markersize() > 1.5 * second.get_markersize()) == larger
        pyplot.close("all")


def test_no_line_leads_to_a_value_at_the_bound_of_its_search() -> None:
    """Nothing is known of it but that it is there or below, and a gap had no reason."""
    value = {"units": "rad s-1", "long_name": "critical value of speed"}
    data = {
        "value": ("N", [12.0, 12.0, 12.6, 13.4, np.nan], value),
        "at_lower_bound": ("N", np.array([1, 1, 0, 0, 0], dtype=np.int8)),
    }
    attrs = {"function": "critical", "options": '{"bounds": [12, 14.5], "name": "Omega"}'}
    study = xr.Dataset(data, {"N": [280.0, 300.0, 320.0, 340.0, 385.0]}, attrs)
    ax = dm.plot_sweep(study, "value")
    joined = [line for line in ax.lines if line.get_linestyle() == "-"]
    lowest = [float(np.nanmin(line.get_ydata())) for line in joined if len(line.get_xdata())]
    assert min(lowest) > 12.1
    alone = [line for line in ax.lines if line.get_linestyle() == "None"]
    assert any([*line.get_xdata()] == [280.0, 300.0] for line in alone)
    [row] = rows_above(ax)
    assert row.words.get_text() == "none found from 12 to 14.5 rad/s"
    pyplot.close("all")


def named(ax: Any) -> list[str]:
    """What the legend of a panel says, in rows."""
    return [text.get_text().replace("\n", " ") for text in ax.get_legend().get_texts()]


def test_sweeps_are_named_by_options_that_differ_and_by_their_reader() -> None:
    """They were "sweep 1" and "sweep 2", and a label of the case was refused."""
    sweeps = []
    for stays in ("5.0, 5.0", "20.0, 160.0"):
        dwell, longest = stays.split(", ")
        options = f'{{"dwell": {dwell}, "max_dwell": {longest}, "tol": 1e-10}}'
        attrs = {"options": options, "base": '{"N": 300}'}
        found = directions([0.0, 0.1, 1.0], [0.5, 0.7, 0.9])
        sweeps.append(found.assign_attrs(attrs).isel(direction=0, drop=True))
    _, unnamed = pyplot.subplots(figsize=(PAGE, 4))
    for sweep in sweeps:
        dm.plot_sweep(sweep, "range", ax=unnamed)
    assert named(unnamed) == ["stays of 5 s", "stays of 20 to 160 s"]
    _, called = pyplot.subplots(figsize=(PAGE, 4))
    for sweep, name in zip(sweeps, ("short", "long"), strict=True):
        dm.plot_sweep(sweep, "range", ax=called, labels={"case": name})
    assert named(called) == ["short", "long"]
    pyplot.close("all")


def names_of_sweeps(function: str, *options: dict[str, Any]) -> list[str]:
    """What the legend says of sweeps of a function that differ in these options."""
    _, ax = pyplot.subplots()
    for each in options:
        study = xr.Dataset(
            {"value": ("N", [1.0, 2.0, 3.0])},
            {"N": [300.0, 320.0, 340.0]},
            {"function": function, "options": json.dumps(each)},
        )
        dm.plot_sweep(study, ax=ax)
    names = named(ax)
    pyplot.close("all")
    return names


@pytest.mark.parametrize(
    ("unset", "expected"),
    [
        ({}, "default order"),
        ({"order": None}, "default order"),
        ({"order": [1, 2]}, "order = 1 and 2"),
        ({"order": {"of": 2}}, "sweep 1"),
    ],
)
def test_an_option_that_is_not_set_has_words_beside_one_that_is(
    unset: dict[str, Any], expected: str
) -> None:
    """It was "sweep 1"."""
    first, _ = names_of_sweeps("own", unset, {"order": 3})
    assert first == expected


def test_the_precision_of_a_critical_value_has_words_where_it_is_not_set() -> None:
    unset = {"name": "c_p"}
    coarse = {"name": "c_p", "precision": 0.01}
    first, _ = names_of_sweeps("critical", unset, coarse)
    assert first == "precision of a millionth of the range"


OPTIONS_OF_PAIRS: dict[str, tuple[str, str, list[Any]]] = {
    "departures not extrapolated": ("outcome", "extrapolate", [False, True]),
    "early ends": ("outcome", "early_end", [True, False]),
    "with refine twice": ("own", "refine_twice", [True, False]),
    "energies 0.001 and 0.1 J": ("basins", "energies", [[0.001, 0.1], [0.1]]),
    "horizon 1, 2 and 5 s": ("critical_speed", "horizon", [[1, 2, 5], 5]),
    "bounds 8 to 9 rad/s": ("critical_speed", "bounds", [[8, 9], [8, 12]]),
    "horizon 1 min and 2 min": ("critical_speed", "horizon", [["1 min", "2 min"], 5]),
    "kinds = a and b": ("own", "kinds", [["a", "b"], ["a"]]),
    "sweep 1": ("basins", "progress", [True, False]),
}
"""Names of the first of two sweeps of a function that differ in an option."""


@pytest.mark.parametrize("expected", OPTIONS_OF_PAIRS)
def test_sweeps_are_named_by_options_that_are_true_or_false_or_lists(expected: str) -> None:
    """They were "sweep 1" and "sweep 2"."""
    function, option, values = OPTIONS_OF_PAIRS[expected]
    options = [{option: value} for value in values]
    first, _ = names_of_sweeps(function, *options)
    assert first == expected


def test_the_title_says_how_long_a_sweep_stays_at_each_value() -> None:
    """It was said only where sweeps differ in it."""
    attrs = {"options": '{"dwell": 20.0, "max_dwell": 160.0}', "base": '{"N": 300.0}'}
    sweep = directions([0.0, 0.1, 1.0], [0.5, 0.7, 0.9]).assign_attrs(attrs)
    sweep = sweep.isel(direction=0, drop=True)
    ax = dm.plot_sweep(sweep, "range")
    assert ax.figure.get_suptitle() == "N = 300 N, stays of 20 to 160 s"
    dm.plot_sweep(sweep.assign_attrs(base='{"N": 320.0}'), "range", ax=ax)
    assert ax.figure.get_suptitle() == "stays of 20 to 160 s"
    pyplot.close("all")


def test_errors_of_exponents_are_in_the_legend() -> None:
    """Their bars had no word."""
    _, ax = pyplot.subplots(figsize=(COLUMN, 3))
    dm.lyapunov_exponents(CASE, 0.5, count=2).plot(ax=ax)
    assert all("± standard error" in each for each in named(ax))
    pyplot.close("all")


def test_a_legend_keeps_values_with_their_symbols_and_units() -> None:
    """Lines ended after "Preload N = 300" and after "μ_s =" in narrow panels."""
    name = "Preload N = 300 N, $\\mu_s$ = 0.4, not settled"
    assert broken(name, 12).splitlines() == [
        "Preload",
        "N = 300 N,",
        "$\\mu_s$ = 0.4,",
        "not settled",
    ]
    assert broken("In-plane spring", 12).splitlines() == ["In-plane", "spring"]
    assert broken("largest |κ| = 0.99844", 12).splitlines() == ["largest |κ|", "= 0.99844"]


def test_a_name_of_a_curve_is_nearer_to_it_than_to_others() -> None:
    """The name of one curve stood beside another."""
    figure, ax = pyplot.subplots(figsize=(4, 4))
    ax.set_xlim(0, 1)
    ax.set_ylim(0, 1)
    names = Names(ax)
    rival = np.column_stack([np.linspace(0, 1, 101), np.full(101, 0.47)])
    names.add_along("name", [(0.5, 0.5)], [(0, -4), (0, 4)], rival)
    figure.canvas.draw()
    [text] = ax.texts
    assert text.get_visible()
    assert text.get_window_extent().y0 > ax.transData.transform((0.5, 0.5))[1]
    pyplot.close(figure)


LONG_NAMES = [
    "stiffer spring at the drive, fourth batch of measured discs",
    "softer spring, heavier pad, with five nodal diameters",
    "load of the third measurement, and a contact at a point",
    "as published in the paper, without in-plane modes",
    "with friction on the surface, and with residual flexibility",
]
SHORTER_NAMES = [name.partition(",")[0] for name in LONG_NAMES]


@pytest.mark.parametrize(
    ("names", "least", "layout"),
    [
        pytest.param(SHORTER_NAMES[:3], 10.0, None, marks=pytest.mark.slow),
        pytest.param(SHORTER_NAMES[:3], 10.0, "constrained", marks=pytest.mark.slow),
        pytest.param(SHORTER_NAMES, 9.0, None, marks=pytest.mark.slow),
        pytest.param(SHORTER_NAMES, 9.0, "constrained", marks=pytest.mark.slow),
        pytest.param(LONG_NAMES[:3], 10.0, None, marks=pytest.mark.slow),
        (LONG_NAMES[:3], 10.0, "constrained"),
        (LONG_NAMES, 3.5, None),  # beside letters of 6 points there is no more room
        pytest.param(LONG_NAMES, 3.5, "constrained", marks=pytest.mark.slow),
    ],
)
@pytest.mark.filterwarnings("ignore:the panel is")
def test_a_legend_of_long_names_lies_on_a_page_of_84_by_51_mm(
    names: list[str], least: float, layout: Any
) -> None:
    """In letters of 10 points, three long names stood off the page, or left a panel of 5 mm; words above
    a panel left the page in a constrained layout."""
    with pyplot.rc_context({"font.size": 10}):
        figure, ax = pyplot.subplots(figsize=(COLUMN, 2.0), layout=layout)
        rates = np.array([-0.1, 0.2, 0.1, 0.3, 0.2, 0.4])
        for place, name in enumerate(names):
            study = growth(rates + 0.02 * place)
            dm.plot_sweep(study, "growth_rate", ax=ax, labels={"growth_rate": name})
        assert_on_page(figure)
    box = ax.get_legend().get_window_extent()
    width, height = figure.bbox.size
    assert min(box.x0, box.y0) > -1
    assert box.x1 < width + 1
    assert box.y1 < height + 1
    assert side(ax) >= least
    assert ax.get_legend().get_texts()[0].get_size() >= 6
    pyplot.close(figure)


def critical_values(function: str, options: str) -> xr.Dataset:
    """Critical speeds over loads, as a function finds them with its options."""
    name = "value" if function == "critical" else "critical_speed"
    attrs = {"units": "rad/s", "long_name": "critical value of angular speed of the disc"}
    speeds = xr.DataArray([13.0, 15.0], dims="N", name=name, attrs=attrs)
    study = speeds.to_dataset().assign_coords(N=[350.0, 385.0])
    return study.assign_attrs(function=function, options=options, base="{}")


def test_critical_speeds_of_two_functions_are_named_by_what_is_sought() -> None:
    """They were named by raw options, such as "max crossings 12" and "points 201"."""
    search = critical_values("critical", '{"name": "Omega", "points": 201, "kind": "stick_slip"}')
    scan = critical_values("critical_speed", '{"horizon": 50.0, "step": 0.5, "max_crossings": 12}')
    longer = critical_values("critical_speed", '{"horizon": 90.0, "step": 0.1, "max_crossings": 9}')
    _, ax = pyplot.subplots(figsize=(PAGE, 4))
    dm.plot_sweep(search, "value", ax=ax)
    dm.plot_sweep(scan, "critical_speed", ax=ax)
    names = ["instability of the stick-slip cycle", "separation, horizon 50 s"]
    assert named(ax) == names
    _, ax = pyplot.subplots(figsize=(PAGE, 4))
    dm.plot_sweep(scan, "critical_speed", ax=ax)
    dm.plot_sweep(longer, "critical_speed", ax=ax)
    both = ["horizon 50 s, steps of 0.5 rad/s, up to 12 crossings"]
    both += ["horizon 90 s, steps of 0.1 rad/s, up to 9 crossings"]
    assert named(ax) == both
    pyplot.close("all")


def test_a_legend_covers_no_line_of_two_points() -> None:
    """It lay on it, as it may on a line of zero across the panel."""
    _, ax = pyplot.subplots()
    ax.axhline(0.5)
    ax.legend(["zero"], loc="center")
    assert finds_room_inside(ax)
    ax.plot([0.0, 1.0], [0.0, 1.0])
    assert not finds_room_inside(ax)
    pyplot.close("all")


def test_arrows_below_values_keep_their_room_beside_further_lines() -> None:
    """They lay on the numbers of the axis once another line was drawn."""
    _, ax = pyplot.subplots(figsize=(PAGE, 3.2))
    options = '{"name": "Omega", "points": 5, "kind": "stick_slip"}'
    study = critical_values("critical", options).assign(at_lower_bound=("N", [True, False]))
    dm.plot_sweep(study, "value", ax=ax)
    alone = ax.margins()
    dm.plot_sweep(critical_values("critical_speed", "{}"), "critical_speed", ax=ax)
    assert ax.margins() == alone
    pyplot.close("all")


@pytest.mark.parametrize("count", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_four_panels_on_a_square_page_keep_their_size(count: int) -> None:
    """Labels in four lines beside low panels left these 9 mm of width and 6 mm of height."""
    first = growth([0.01, 0.0, -0.1, np.nan, 0.6, 0.1])
    second = growth([0.02, 0.01, -0.05, 0.0, 0.5, 0.2]).assign_attrs(base='{"N": 300}')
    with pyplot.rc_context({"font.size": 8}):
        figure, axes = pyplot.subplots(2, 2, figsize=(COLUMN, COLUMN), layout="constrained")
        for ax in axes.ravel():
            for study in (first, second)[:count]:
                dm.plot_sweep(study, "growth_rate", ax=ax)
        figure.draw_without_rendering()
    sizes = np.array([[ax.bbox.width, ax.bbox.height] for ax in axes.ravel()])
    least = 25.4 / figure.dpi * sizes.min(axis=0)  # mm
    assert least[0] > 15
    assert least[1] > 9
    assert {rows.words.get_text() for rows in rows_above(axes[0, 0])} >= {"line open"}
    pyplot.close("all")
