"""What a reader asks of pictures: own axes, legend, labels, title and settings of matplotlib."""

import functools
import warnings
from collections.abc import Callable
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib import pyplot
from matplotlib.axes import Axes

import disc_model as dm
from disc_model.figures.labels import titles_of
from disc_model.figures.placing import Row, check_room
from disc_model.figures.sizes import COLUMN, PAGE
from tests.figures.reading import as_map, assert_fit_for_print, assert_numbers_are_apart
from tests.refusals import refusal

CASE = dm.Parameters(N=385, Omega=15, n_diameters=2)
SEPARATING = dm.Parameters(N=385, Omega=15.1)
Draw = Callable[..., Any]


@functools.cache
def run() -> dm.Result:
    windows = {"late": dm.Window(last=0.5, rate=1e4)}
    return dm.simulate(CASE, 8, windows)


@functools.cache
def growth() -> Any:
    return dm.sweep(dm.floquet, CASE, Omega=[10.0, 12.0, 14.0], N=[300.0, 385.0, 400.0])


@functools.cache
def exponents() -> Any:
    return dm.lyapunov_exponents(CASE, 0.5, count=2)


@functools.cache
def branch() -> Any:
    return dm.continue_cycle(CASE, "Omega", (14.5, 15.5))


DRAWN: dict[str, Draw] = {
    "run": lambda **wishes: run().plot("late", variables=["P"], **wishes),
    "portrait": lambda **wishes: run().plot_phase_portrait("late", **wishes),
    "spectrum": lambda **wishes: run().plot_spectrum("late", **wishes),
    "multipliers": lambda **wishes: dm.floquet(CASE).plot(**wishes),
    "eigenvalues": lambda **wishes: dm.steady_sliding(CASE).plot(**wishes),
    "exponents": lambda **wishes: exponents().plot(**wishes),
    "branch": lambda **wishes: branch().plot("period", **wishes),
    "line": lambda **wishes: dm.plot_sweep(growth().sel(N=385), **wishes),
    "map": lambda **wishes: as_map(growth(), **wishes),
    "words": lambda **wishes: as_map(growth(), "stable", **wishes),
}
"""Pictures of one panel."""
WITH_LEGEND = ("portrait", "multipliers", "eigenvalues", "branch", "map", "words")


def one(drawn: Any) -> Axes:
    return np.ravel(np.asarray(drawn, dtype=object))[0]


@functools.cache
def usual(name: str) -> Axes:
    """The first panel of a picture of which nothing is asked, which tests only read."""
    return one(DRAWN[name]())


def legend_texts(ax: Axes) -> list[str]:
    legends = [*ax.figure.legends, *filter(None, [ax.get_legend()])]
    return [text.get_text() for legend in legends for text in legend.get_texts()]


@pytest.mark.parametrize("name", DRAWN)
def test_labels_and_titles_can_be_replaced(name: str) -> None:
    said = legend_texts(usual(name))
    labels = {"x": "abscissa", "y": "ordinate"} | {text: f"my {text}" for text in said}
    ax = one(DRAWN[name](labels=labels, title="My title"))
    assert ax.get_xlabel() == "abscissa"
    assert ax.get_ylabel() == "ordinate"
    assert legend_texts(ax) == [f"my {text}" for text in said]
    assert ax.figure.get_suptitle() == "My title"
    assert one(DRAWN[name](title="")).figure.get_suptitle() == ""


@pytest.mark.parametrize("name", WITH_LEGEND)
def test_a_legend_can_be_left_out_or_placed(name: str) -> None:
    assert legend_texts(usual(name))
    assert legend_texts(one(DRAWN[name](legend=False))) == []
    placed = one(DRAWN[name](legend={"loc": "upper left", "ncols": 2}))
    assert placed.figure.legends == []
    assert placed.get_legend()._loc == mpl.legend.Legend.codes["upper left"]


@pytest.mark.parametrize("name", WITH_LEGEND)
def test_a_legend_of_another_look_stands_where_the_usual_one_does(name: str) -> None:
    """It lay over the data, also where the usual one stands below the panel."""
    smaller = one(DRAWN[name](legend={"fontsize": 6}))
    [legend] = smaller.figure.legends
    assert {text.get_fontsize() for text in legend.get_texts()} == {6}
    places = []
    for wish in (True, {"frameon": False}):
        figure, ax = pyplot.subplots(figsize=(COLUMN, 2.6), layout="constrained")
        DRAWN[name](ax=ax, legend=wish)
        figure.draw_without_rendering()
        framed: Any = ax.get_legend()
        assert framed.get_frame_on() == (wish is True)
        places.append(framed.get_window_extent().bounds)
    assert places[0] == pytest.approx(places[1], abs=1)


def test_a_legend_below_a_panel_has_the_columns_asked_for() -> None:
    figure, ax = pyplot.subplots(figsize=(COLUMN, 2.6), layout="constrained")
    lines = {"x": "Omega", "lines": "N", "ax": ax}
    for columns in ("ncols", "ncol"):
        dm.plot_sweep(growth(), "growth_rate", **lines, legend={"fontsize": 6, columns: 3})
        figure.draw_without_rendering()
        legend: Any = ax.get_legend()
        assert legend.get_window_extent().y1 < ax.bbox.y0
        heights = [text.get_window_extent().y0 for text in legend.get_texts()]
        assert heights == pytest.approx(3 * heights[:1])
        ax.clear()


@pytest.mark.parametrize("name", DRAWN)
def test_own_axes_are_used_and_their_figure_keeps_its_title(name: str) -> None:
    figure, ax = pyplot.subplots(layout="constrained")
    figure.suptitle("mine")
    assert one(DRAWN[name](ax=ax)) is ax
    assert figure.get_suptitle() == "mine"
    assert ax.get_xlabel()
    assert figure.legends == [], "which would be that of other panels too"
    DRAWN[name](ax=figure.add_subplot(), title="panel title")
    place = 1
    if name == "map":
        place = 2
    ax = figure.axes[place]
    assert ax.get_title(loc="left") == "panel title"


def title_above(ax: Axes) -> str:
    """What stands at the left above a panel, in one line."""
    title = ax.get_title(loc="left")
    return " ".join(title.split())


@pytest.mark.parametrize("name", DRAWN)
def test_own_axes_have_the_values_of_the_case_above_them_on_request(name: str) -> None:
    """Panels of several runs did not say which case they show."""
    _, ax = pyplot.subplots(layout="constrained")
    DRAWN[name](ax=ax, title=True)
    new = usual(name).figure
    note = title_above(new.axes[0])
    said = title_above(ax)
    in_one_line = " ".join(new.get_suptitle().split())
    assert said.startswith(in_one_line)
    assert said.endswith(note)


@pytest.mark.parametrize("name", DRAWN)
def test_new_figures_have_their_title_unless_it_is_false(name: str) -> None:
    asked = one(DRAWN[name](title=True)).figure
    without = one(DRAWN[name](title=False)).figure
    assert asked.get_suptitle() == usual(name).figure.get_suptitle()
    assert without.get_suptitle() == ""


def test_values_above_own_axes_are_those_that_all_cases_there_have() -> None:
    first = dm.floquet(CASE)
    slower = dm.floquet(CASE.replace(Omega=14))
    _, ax = pyplot.subplots(layout="constrained")
    first.plot(ax=ax, title=True)
    slower.plot(ax=ax)
    assert title_above(ax) == "N = 385 N, nodal diameters up to 2"


def test_a_title_of_a_reader_above_own_axes_is_kept() -> None:
    first = dm.floquet(CASE)
    lighter = dm.floquet(CASE.replace(N=300))
    _, ax = pyplot.subplots(layout="constrained")
    first.plot(ax=ax, title=True)
    ax.set_title("mine", loc="left")
    lighter.plot(ax=ax)
    assert title_above(ax) == "mine"


def test_values_above_a_narrow_panel_stay_whole() -> None:
    damped = dm.floquet(CASE.replace(c_p=4))
    _, axes = pyplot.subplots(2, 2, figsize=(3.31, 4), layout="constrained")
    ax = axes[0, 0]
    damped.plot(ax=ax, title=True, legend=False)
    first, second, *_ = ax.get_title(loc="left").splitlines()
    assert first.rstrip(",") == "N = 385 N"
    assert second.rstrip(",") == "Ω = 15 rad/s"


@pytest.mark.parametrize("name", [name for name in DRAWN if name not in ("map", "words")])
def test_widths_of_lines_and_marks_and_fonts_follow_the_settings(name: str) -> None:
    """Line widths were fixed."""

    def sizes(scale: float) -> dict[str, np.ndarray]:
        settings = {"lines.linewidth": scale, "lines.markersize": 6 * scale, "font.size": 8 * scale}
        with mpl.rc_context(settings):
            _, ax = pyplot.subplots()
            DRAWN[name](ax=ax)
        lines = [line for line in ax.lines if line.get_linestyle() != "None"]
        marks = [line for line in ax.lines if line.get_marker() not in ("", "None", None)]
        return {
            "lines": np.array([line.get_linewidth() for line in lines]),
            "marks": np.array([line.get_markersize() for line in marks]),
            "texts": np.array([text.get_fontsize() for text in ax.texts]),
        }

    single = sizes(1.0)
    doubled = sizes(2.0)
    assert sum(values.size for values in single.values()) > 0
    for what, values in single.items():
        np.testing.assert_allclose(doubled[what], 2 * values, rtol=1e-12, err_msg=what)


def test_a_new_figure_has_the_readers_font_and_otherwise_the_usual_style() -> None:
    plain = usual("line")
    assert not plain.spines["top"].get_visible()
    with mpl.rc_context({"font.family": "serif", "lines.linewidth": 3}):
        ax = one(DRAWN["line"]())
    assert ax.xaxis.label.get_fontfamily() == ["serif"]
    assert ax.lines[0].get_linewidth() == 3 * plain.lines[0].get_linewidth()
    assert not ax.spines["top"].get_visible()


@pytest.mark.parametrize("name", DRAWN)
def test_new_figures_fit_a_column_or_a_page_with_all_that_they_say(name: str) -> None:
    figure = usual(name).figure
    assert figure.get_figwidth() in (COLUMN, PAGE)
    assert_fit_for_print(figure)


WRONG = {
    "legend": ({"lok": "best"}, "did you mean loc"),
    "labels": ({"x": 1}, "must be texts"),
    "title": (3, "must be a text, True or False"),
    "ax": ("axes", "must be 1 axes"),
}


def test_a_label_that_replaces_nothing_is_named() -> None:
    with refusal(r"labels='slipp': .*did you mean slip"):
        DRAWN["portrait"](labels={"slipp": "sliding"})


def test_the_values_of_a_case_take_three_lines_at_most() -> None:
    """Those of another disc took six, and left half of the page to the picture."""
    other = dm.Parameters(
        N=3000,
        Omega=30,
        E=2.1e11,
        a=0.05,
        b=0.15,
        r_0=0.12,
        h=0.008,
        rho=7850,
        nu=0.3,
        D_star=0,
        k=1e6,
        k_p=5e5,
        contact_arc=0.3,
        normalization="orthonormal",
    )
    said = one(dm.steady_sliding(other).plot()).figure.get_suptitle()
    assert said.count("\n") == 2
    assert said.startswith("N = 3000 N")
    assert said.endswith(" and 5 further parameters")


@pytest.mark.parametrize("wish", WRONG)
def test_a_wish_that_cannot_be_understood_is_named(wish: str) -> None:
    value, rule = WRONG[wish]
    before = pyplot.get_fignums()
    with refusal(f"{wish}.*{rule}"):
        DRAWN["portrait"](**{wish: value})
    assert pyplot.get_fignums() == before, "no figure stays behind, half drawn"


def test_a_place_that_matplotlib_does_not_know_is_named_and_leaves_no_figure() -> None:
    with refusal(r"legend=.*nowhere"):
        DRAWN["portrait"](legend={"loc": "nowhere"})
    assert pyplot.get_fignums() == []


def test_pictures_of_several_panels_take_as_many_axes() -> None:
    _, axes = pyplot.subplots(1, 2)
    drawn = dm.simulate(SEPARATING, 3).plot_poincare(ax=axes, title="first", legend=False)
    assert list(drawn) == list(axes)
    modes = len(dm.plate_modes(CASE))
    _, axes = pyplot.subplots(2, -(-modes // 2))
    dm.plot_modes(CASE, ax=axes.flat[:modes], title="not over a mode's own name")
    assert "Hz" in axes.flat[0].get_title()
    assert one(dm.plot_modes(CASE, title="Shapes")).figure.get_suptitle() == "Shapes"
    assert one(dm.plot_modes(CASE, title=True)).figure.get_suptitle().startswith("Modes")


PANEL = 42 / 25.4
"""Width of two panels beside each other in a column, inch."""
LEAST_WIDTH = 6 / 25.4
"""Of axes beside the label of a bar of colours, which has up to three lines, inch."""


QUICK = ("branch", "run", "words")
"""Kinds of pictures whose narrowest panels are tried quickly."""


@pytest.mark.parametrize(
    "name",
    [name if name in QUICK else pytest.param(name, marks=pytest.mark.slow) for name in DRAWN],
)
@pytest.mark.filterwarnings("ignore:the panel is")
def test_small_panels_keep_their_width_beside_their_legends(name: str) -> None:
    """A legend wider than a panel of 40 mm squeezed it to nothing, and ran into the next one."""
    with mpl.rc_context({"font.size": 7}):
        figure, axes = pyplot.subplots(1, 2, figsize=(2 * PANEL, 2.4), layout="constrained")
        for ax in axes:
            DRAWN[name](ax=ax)
        figure.draw_without_rendering()
    for i, ax in enumerate(axes):
        assert ax.get_window_extent().width > LEAST_WIDTH * figure.dpi
        assert_numbers_are_apart(ax)
        if ax.get_legend():
            box = ax.get_legend().get_window_extent()
            assert box.y0 >= 0
            assert box.width <= PANEL * figure.dpi
            assert not box.overlaps(axes[1 - i].get_window_extent())


def test_columns_on_own_axes_have_the_heights_that_stand_beside_the_first() -> None:
    """The last cycles had a scale of their own, and no numbers beside it."""
    _, axes = pyplot.subplots(3, 2)
    dm.simulate(SEPARATING, 56).plot(ax=axes)
    for left, right in axes:
        assert left.get_ylim() == right.get_ylim()
        for ax in (left, right):
            low, high = ax.dataLim.intervaly
            assert ax.get_ylim()[0] <= low
            assert ax.get_ylim()[1] >= high


@pytest.mark.parametrize("width", [COLUMN, pytest.param(PAGE, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", WITH_LEGEND)
def test_a_legend_on_own_axes_covers_no_data_and_no_words(name: str, width: float) -> None:
    """A legend covered ticks and marks of narrow axes, and the label below them."""
    figure, ax = pyplot.subplots(figsize=(width, 2.6), layout="constrained")
    DRAWN[name](ax=ax)
    figure.draw_without_rendering()
    box = ax.get_legend().get_window_extent()
    labels = [axis.label.get_window_extent() for axis in (ax.xaxis, ax.yaxis)]
    ticks = []
    for axis in (ax.xaxis, ax.yaxis):
        low, high = axis.get_view_interval()
        shown = [tick for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high]
        ticks += [tick.label1.get_window_extent() for tick in shown]
    texts = [text.get_window_extent() for text in ax.texts]
    assert box.count_overlaps([*labels, *ticks, *texts]) == 0
    for line in ax.lines:
        if line.get_marker() not in ("", "None", None):
            places = line.get_transform().transform(line.get_xydata())
            assert not box.count_contains(places), line.get_label()
    assert box.x0 >= 0
    assert box.x1 <= figure.bbox.x1


@pytest.mark.parametrize(
    ("loads", "height"),
    [
        ((385, 355), 2.4),
        pytest.param((385, 370, 355), 2.4, marks=pytest.mark.slow),
        pytest.param((385, 370, 355), 3.0, marks=pytest.mark.slow),
    ],
)
def test_legends_of_branches_beside_each_other_stand_clear_of_them(
    loads: tuple[int, ...], height: float
) -> None:
    """That of the first panel lay over its branches, once that of the second had made it lower."""
    size = (PAGE, height)
    branches = [dm.continue_cycle(CASE.replace(N=N, Omega=14), "Omega", (12, 16)) for N in loads]
    settings = {"font.family": "serif", "font.size": 8, "lines.linewidth": 0.8}
    with mpl.rc_context(settings):
        figure, axes = pyplot.subplots(1, 2, figsize=size, layout="constrained")
        for each in branches:
            each.plot("range", ax=axes[0], title="(a)")
        for number, each in enumerate(branches):
            name = {"branch": f"a long name of branch {number} of many words"}
            each.plot("range", ax=axes[1], title="(b)", labels=name)
        figure.draw_without_rendering()
    for ax in axes:
        box = ax.get_legend().get_window_extent()
        assert not any(_line_on_page(line).intersects_bbox(box, filled=False) for line in ax.lines)


def _line_on_page(line: Any) -> Any:
    """A line or the places of marks, in pixels."""
    return line.get_transform().transform_path(line.get_path())


def test_axes_that_a_bar_and_a_legend_would_squeeze_are_refused() -> None:
    """A map on axes of 40 mm was a strip of 4 mm."""
    study = growth()
    partly = study.assign(growth_rate=study["growth_rate"].where(study["Omega"] < 13))
    _, ax = pyplot.subplots(figsize=(40 / 25.4, 40 / 25.4), layout="constrained")
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # the error says it
        with refusal(r"ax=.*: must be larger, or legend=False: a colour bar"):
            as_map(partly, ax=ax)
    figure, ax = pyplot.subplots(figsize=(84 / 25.4, 70 / 25.4), layout="constrained")
    as_map(partly, ax=ax)
    assert min(ax.bbox.width, ax.bbox.height) / figure.dpi * 25.4 > 20
    pyplot.close("all")


def page_of_a_panel(millimetres: float) -> list[Axes]:
    """A panel of a width, with room around it."""
    figure = pyplot.figure(figsize=(4, 4))
    width = millimetres / 25.4 / 4
    ax = figure.add_axes((0.3, 0.3, width, 0.5))
    return [ax]


def test_a_panel_beside_a_bar_has_eight_millimetres_at_least() -> None:
    wide = page_of_a_panel(9.0)
    check_room(wide)
    narrow = page_of_a_panel(7.0)
    with refusal("must be larger, or legend=False: .* leave 7 mm for the panel"):
        check_room(narrow)


@pytest.mark.filterwarnings("ignore:the panel is")
def test_panels_of_a_row_are_stacked_where_they_are_alone_in_a_narrow_figure() -> None:
    size = (COLUMN, 60 / 25.4)
    windows = {"turns": dm.Poincare(start=0.5), "late": dm.Window(last=0.5, rate=1e4)}
    short = dm.simulate(CASE, 6, windows)
    draw = short.plot_poincare
    figure, axes = pyplot.subplots(1, 2, figsize=size, layout="constrained")
    upper, lower = draw("turns", ax=axes)
    figure.draw_without_rendering()
    assert lower.bbox.y1 < upper.bbox.y0
    assert min(upper.bbox.height, lower.bbox.height) > 0.9 * figure.dpi
    assert (
        max(ax.get_legend().get_window_extent().x1 for ax in axes if ax.get_legend())
        < figure.bbox.x1
    )

    wide, axes = pyplot.subplots(1, 2, figsize=(PAGE, 60 / 25.4), layout="constrained")
    assert is_row(draw("turns", ax=axes))
    assert wide.get_figheight() == pytest.approx(60 / 25.4)
    _, axes = pyplot.subplots(2, 2, figsize=(COLUMN, 3), layout="constrained")
    assert is_row(draw("turns", ax=axes[0])), "others have their places"
    single, ax = pyplot.subplots(figsize=(2, 1.5), layout="constrained")
    short.plot("late", variables=["P"], ax=ax)
    assert single.get_figheight() == 1.5
    _, axes = pyplot.subplots(1, 2, figsize=size, layout="constrained")
    assert not is_row(short.plot(["late", "late"], variables=["P"], ax=axes)), "columns of a run"
    pyplot.close("all")


@pytest.mark.parametrize(
    ("width", "layout"),
    [
        (COLUMN, "constrained"),
        (COLUMN, None),
        pytest.param(PAGE, "constrained", marks=pytest.mark.slow),
        (PAGE, None),
    ],
)
def test_pictures_on_twin_axes_have_one_legend_that_covers_neither(
    width: float, layout: Any
) -> None:
    """The legend of the second lay over that of the first, over its lines, and below narrow axes over
    the label that both share."""
    figure, ax = pyplot.subplots(figsize=(width, 60 / 25.4), layout=layout)
    branch().plot("range", ax=ax)
    alone = [text.get_text() for text in ax.get_legend().get_texts()]
    twin = ax.twinx()
    branch().plot("growth_rate", ax=twin)
    figure.draw_without_rendering()
    assert ax.get_legend() is None
    legend = twin.get_legend()
    assert [text.get_text() for text in legend.get_texts()] == alone, "as the lines look alike"
    box = legend.get_window_extent()
    assert not box.overlaps(ax.xaxis.get_tightbbox())
    curves = [line for line in (*ax.lines, *twin.lines) if len(line.get_xdata()) > 2]
    assert not any(_line_on_page(line).intersects_bbox(box, filled=False) for line in curves)
    assert box.y0 >= 0
    pyplot.close("all")


def test_lines_of_sweeps_on_twin_axes_differ_and_are_named() -> None:
    """Both were black with round marks, and no legend told which belonged to which axis."""
    figure, ax = pyplot.subplots(figsize=(COLUMN, 60 / 25.4), layout="constrained")
    dm.plot_sweep(growth().sel(N=385), "growth_rate", ax=ax)
    twin = ax.twinx()
    dm.plot_sweep(growth().sel(N=385), "period", ax=twin)
    texts = [text.get_text() for text in twin.get_legend().get_texts()]
    assert texts == ["Growth rate", "Period"]
    first, second = ax.lines[0], twin.lines[0]
    assert first.get_color() != second.get_color()
    assert first.get_marker() != second.get_marker()
    dm.plot_sweep(growth().sel(N=300), "period", ax=twin)
    texts = [text.get_text() for text in twin.get_legend().get_texts()]
    assert [text.partition(",")[0] for text in texts] == ["Growth rate", "Period", "Period"]
    assert len({text.replace("\n", " ") for text in texts}) == 3
    assert ax.get_legend() is None
    pyplot.close(figure)


def test_a_legend_on_twin_axes_stands_clear_of_one_that_its_reader_has_placed() -> None:
    figure, ax = pyplot.subplots(figsize=(PAGE, 3), layout="constrained")
    placed = {"loc": "center left"}
    branch().plot("range", ax=ax, legend=placed)
    twin = ax.twinx()
    branch().plot("growth_rate", ax=twin)
    figure.draw_without_rendering()
    own, other = (each.get_legend().get_window_extent() for each in (ax, twin))
    assert not own.overlaps(other)
    pyplot.close("all")


def is_row(axes: Any) -> bool:
    """Whether two panels stand beside each other."""
    left, right = (ax.get_subplotspec() for ax in np.ravel(axes))
    return bool(left.rowspan == right.rowspan and left.colspan != right.colspan)


@pytest.mark.parametrize("arranged", ["by a grid", "by tight_layout", "by hand"])
@pytest.mark.parametrize("name", ["map", "words", "line"])
def test_pictures_on_plain_axes_stay_on_the_page(name: str, arranged: str) -> None:
    """The legend of a map lay below the page, and `tight_layout` drew its bar over it."""
    figure = pyplot.figure()
    if arranged == "by hand":
        ax = figure.add_axes((0.15, 0.15, 0.7, 0.7))
    else:
        ax = figure.add_subplot()
    DRAWN[name](ax=ax)
    if arranged == "by tight_layout":
        figure.tight_layout()
    figure.draw_without_rendering()
    boxes = [each.get_tightbbox() for each in figure.axes]
    if ax.get_legend() is not None:
        boxes.append(ax.get_legend().get_window_extent())
    for box in boxes:
        # a pixel, to which texts are rounded
        assert min(box.x0, box.y0) >= -1
        assert box.x1 <= figure.bbox.width + 1
        assert box.y1 <= figure.bbox.height + 1
    for bar in figure.axes[1:]:
        assert bar.bbox.x0 > ax.bbox.x1
    assert ax.bbox.height > 0.5 * figure.bbox.height
    pyplot.close(figure)


def test_a_legend_of_a_map_stands_above_the_next_row_of_plain_axes() -> None:
    figure, axes = pyplot.subplots(2, 1, figsize=(5, 6))
    for ax in axes:
        DRAWN["map"](ax=ax)
    figure.draw_without_rendering()
    above, below = (ax.get_legend().get_window_extent() for ax in axes)
    assert above.y0 > axes[1].bbox.y1
    assert below.y0 >= 0
    pyplot.close(figure)


@pytest.mark.parametrize("row", [0, 1])
def test_a_run_in_a_grid_of_other_pictures_has_its_labels(row: int) -> None:
    """In an upper row it had neither time nor numbers, in a further column no force."""
    _, axes = pyplot.subplots(2, 2, figsize=(PAGE, 4), layout="constrained")
    ax = axes[row, 1]
    DRAWN["run"](ax=ax)
    assert ax.get_xlabel() == "Time (s)"
    assert "(N)" in ax.get_ylabel()
    shown = ax.xaxis.get_tick_params()["labelbottom"], ax.yaxis.get_tick_params()["labelleft"]
    assert shown == (True, True)


def test_variables_beside_each_other_have_labels_and_those_below_each_other_share_them() -> None:
    beside = pyplot.subplots(1, 2)[1]
    run().plot("late", variables=["P", "u"], ax=beside)
    assert [ax.get_xlabel() for ax in beside] == ["Time (s)", "Time (s)"]
    stacked = pyplot.subplots(2, 1)[1]
    run().plot("late", variables=["P", "u"], ax=stacked)
    assert [ax.get_xlabel() for ax in stacked] == ["", "Time (s)"]
    units = [ax.get_ylabel().rpartition(" ")[2] for ax in stacked]
    assert units == ["(N)", "(mm)"]


@pytest.mark.slow
def test_words_of_a_panel_fit_it_after_others_have_made_it_narrower() -> None:
    """The title of the first panel ran into the second one."""
    with mpl.rc_context({"font.size": 8}):
        figure, axes = pyplot.subplots(2, 2, figsize=(PAGE, 5), layout="constrained")
        DRAWN["eigenvalues"](ax=axes[0, 0])
        assert "\n" not in axes[0, 0].get_title(loc="left")
        for ax in axes.flat[1:]:
            DRAWN["map"](ax=ax)
        figure.draw_without_rendering()
    [title] = titles_of(axes[0, 0])
    assert title.get_window_extent().x1 < axes[0, 1].bbox.x0


def test_a_reader_keeps_words_that_replace_broken_ones() -> None:
    _, axes = pyplot.subplots(1, 2, figsize=(COLUMN, 2), layout="constrained")
    DRAWN["line"](ax=axes[0])
    assert "\n" in axes[0].get_ylabel()
    axes[0].set_ylabel("my\nrate")
    DRAWN["line"](ax=axes[1])
    assert axes[0].get_ylabel() == "my\nrate"


@pytest.mark.parametrize(
    ("gap", "wider", "least", "size"),
    [(0.2, 0.0, 0.1, 0.25), (0.2, 0.1, 0.1, 0.1833), (0.2, 0.3, 0.1, 0.1), (0.2, 0.3, 0.3, 0.25)],
)
def test_gaps_are_widened_while_panels_keep_their_least_size(
    gap: float, wider: float, least: float, size: float
) -> None:
    """Three panels and two gaps of a fifth of them: 0.25 and 0.05 of 0.85."""
    row = Row(0.85, 3, gap)
    found = row.gap_in(0.85, wider, least)
    assert 0.85 / (3 + 2 * found) == pytest.approx(size, abs=1e-4)  # as they are written above
    assert Row(0.85, 1, gap).gap_in(0.85, wider, least) == gap


def test_a_long_title_of_a_new_figure_stays_on_the_page() -> None:
    """It ran beyond both edges of a column."""
    words = "Growth rates of a steel disc of 6 mm " * 3
    figure = one(DRAWN["line"](title=words)).figure
    figure.draw_without_rendering()
    shown = figure.get_suptitle()
    [title] = [text for text in figure.texts if text.get_text() == shown]
    box = title.get_window_extent()
    assert shown.split() == words.split()
    assert box.x0 >= 0
    assert box.x1 <= figure.bbox.x1


@pytest.mark.filterwarnings("ignore:the panel is")
def test_pictures_leave_the_title_of_a_plain_figure_its_room() -> None:
    """It met the label of a low panel."""
    figure, ax = pyplot.subplots(figsize=(3.31, 1.8))
    title = figure.suptitle("A disc\nof steel\nand a slider\nof 300 g")
    DRAWN["line"](ax=ax)
    figure.draw_without_rendering()
    box = title.get_window_extent()
    panel = ax.get_tightbbox()
    assert box.y0 >= panel.y1
