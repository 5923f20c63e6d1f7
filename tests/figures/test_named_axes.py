"""Several pictures on the same axes: what they may have in common, and what they are called."""

import functools
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot

import disc_model as dm
from disc_model.figures.gap_rows import rows_above
from disc_model.figures.labels import words_of
from disc_model.figures.sweep_lines import common_words
from tests.figures.reading import as_map
from tests.figures.test_wishes import CASE, DRAWN, branch, legend_texts, run
from tests.refusals import refusal

SPEED = {"units": "rad s-1"}
ANOTHER = {
    "portrait": ("run", "along x"),
    "run": ("portrait", "along x"),
    "spectrum": ("run", "along x"),
    "multipliers": ("eigenvalues", "along x"),
    "eigenvalues": ("multipliers", "along x"),
    "exponents": ("branch", "along x"),
    "branch": ("line", "along y"),
    "line": ("branch", "along y"),
    "map": ("words", "by colour"),
    "words": ("map", "by colour"),
}
"""For each picture, one of something else, and the axis along which it is."""


@functools.cache
def by_load() -> Any:
    return dm.continue_cycle(CASE.replace(Omega=14.9), "N", (380, 390))


def speeds() -> xr.Dataset:
    """Speeds of a hysteresis over the load."""
    onset = ("N", [14.0, 15.0, 16.0], {**SPEED, "long_name": "speed at which it begins"})
    offset = ("N", [11.0, 12.0, np.nan], {**SPEED, "long_name": "lowest speed to which it lasts"})
    period = ("N", [0.01, 0.02, 0.03], {"units": "s", "long_name": "period"})
    return xr.Dataset(
        {"begin": onset, "end": offset, "time": period},
        {"N": [300.0, 350.0, 400.0]},
        {"base": '{"Omega": 14}'},
    )


TELLING = ("run", "multipliers", "branch", "line", "map", "words")
"""Pictures of each kind of axes; the others are tried by slow tests."""


@pytest.mark.parametrize(
    "name",
    [name if name in TELLING else pytest.param(name, marks=pytest.mark.slow) for name in DRAWN],
)
def test_a_picture_of_something_else_is_refused_and_leaves_axes_as_they_are(name: str) -> None:
    """The label of the second picture stood beside the values of the first."""
    figure, ax = pyplot.subplots(layout="constrained")
    other, along = ANOTHER[name]
    DRAWN[other](ax=ax)
    before = (ax.get_xlabel(), ax.get_ylabel(), len(ax.get_children()), len(figure.axes))
    with refusal(rf"^ax: shows “.*” {along}, and “.*” is something"):
        DRAWN[name](ax=ax)
    assert (ax.get_xlabel(), ax.get_ylabel(), len(ax.get_children()), len(figure.axes)) == before
    if along != "by colour":  # which would cover the first
        DRAWN[other](ax=ax)  # the same again
    ax.clear()
    DRAWN[name](ax=ax)


def test_another_parameter_is_refused_on_axes_beside_it_and_on_its_twin() -> None:
    _, ax = pyplot.subplots()
    branch().plot("range", ax=ax)
    twin = ax.twinx()
    branch().plot("growth_rate", ax=twin)
    assert ax.get_ylabel().startswith("Range")
    assert twin.get_ylabel().startswith("Growth rate")
    for each in (ax, twin):
        with refusal(r"shows “Speed Ω \(rad/s\)” along x.*twiny"):
            by_load().plot("range", ax=each, labels={"y": "both"})
    below = pyplot.figure().subplots(2, 1, sharex=True)
    branch().plot("range", ax=below[0])
    by_load().plot("range", ax=below[1])


@pytest.mark.parametrize("width", [84, pytest.param(174, marks=pytest.mark.slow)])
def test_a_shared_axis_has_its_label_beside_its_numbers_alone(width: int) -> None:
    """The upper panel repeated "Speed Ω (rad/s)" where no numbers stand."""
    size = (width / 25.4, 120 / 25.4)
    _, panels = pyplot.subplots(2, 2, figsize=size, sharex=True, sharey="row", layout="constrained")
    for top, bottom in panels.T:
        branch().plot("range", ax=top, legend=False)
        branch().plot("growth_rate", ax=bottom, legend=False)
    speed = "Speed Ω (rad/s)"
    for ax in panels[0]:
        assert not ax.get_xlabel()
    for ax in panels[1]:
        assert words_of(ax.xaxis.label) == speed
    assert all(left.get_ylabel() and not right.get_ylabel() for left, right in panels)


def test_labels_of_a_shared_axis_stay_that_differ_or_are_those_of_a_reader() -> None:
    _, (top, middle, bottom) = pyplot.subplots(3, 1, sharex=True)
    middle.set_xlabel("Speed Ω (rad/s)")
    branch().plot("range", ax=top, labels={"x": "Speed of the slider (rad/s)"})
    branch().plot("range", ax=middle)
    branch().plot("range", ax=bottom)
    assert top.get_xlabel() == "Speed of the slider (rad/s)"
    assert middle.get_xlabel() == bottom.get_xlabel() == "Speed Ω (rad/s)"


def test_a_reader_answers_for_own_labels() -> None:
    _, ax = pyplot.subplots()
    branch().plot("range", ax=ax)
    both = "Range (mm), growth rate (1/s)"
    branch().plot("growth_rate", ax=ax, labels={"y": both})
    assert ax.get_ylabel() == both
    branch().plot("growth_rate", ax=ax)
    assert ax.get_ylabel() == both, "it stays"
    with refusal("is something else"):
        branch().plot("period", ax=ax)


@pytest.mark.parametrize(
    ("own", "refused"), [("ω (rpm)", True), ("ω (rad/s)", False), ("ω", False)]
)
def test_a_label_that_a_reader_has_written_stays_in_its_unit(own: str, refused: bool) -> None:
    _, ax = pyplot.subplots()
    ax.plot([14.6, 15.0], [1.0, 2.0], label="measured")
    ax.set_xlabel(own)
    if refused:
        with refusal(r"label “ω \(rpm\)” along x.*another unit"):
            branch().plot("range", ax=ax)
    else:
        branch().plot("range", ax=ax)
    assert ax.get_xlabel() == own


@pytest.mark.parametrize("listed", [True, False])
def test_variables_of_one_unit_have_looks_names_and_a_common_axis(listed: bool) -> None:
    """Both were black lines without a name, under the label of the second."""
    _, ax = pyplot.subplots(layout="constrained")
    if listed:
        dm.plot_sweep(speeds(), ["begin", "end"], ax=ax)
    else:
        dm.plot_sweep(speeds(), "begin", ax=ax)
        dm.plot_sweep(speeds(), "end", ax=ax)
    assert ax.get_ylabel() == "Speed (rad/s)"
    said = [text.replace("\n", " ") for text in legend_texts(ax)]
    assert said == ["Speed at which it begins", "Lowest speed to which it lasts"]
    begin, end = [line for line in ax.lines if len(line.get_xdata()) == 3]
    assert begin.get_color() != end.get_color()
    assert begin.get_linestyle() != end.get_linestyle()
    assert begin.get_marker() != end.get_marker()
    for wrong in ("time", ["begin", "time"]):
        with refusal(r"“Speed.*\(rad/s\)” along y, and “Period"):
            dm.plot_sweep(speeds(), wrong, ax=ax if wrong == "time" else None)


def test_lines_are_named_by_their_reader() -> None:
    called = {"begin": "up", "end": "down"}
    ax = dm.plot_sweep(speeds(), ["begin", "end"], labels=called)
    assert legend_texts(ax) == ["up", "down"]
    assert legend_texts(dm.plot_sweep(speeds(), "begin", labels={"begin": "up"})) == ["up"]


def test_sweeps_of_several_cases_are_named_by_what_differs() -> None:
    worn = speeds().assign_attrs(base='{"Omega": 14, "mu_k": 0.2}')
    new = speeds().assign_attrs(base='{"Omega": 14, "mu_k": 0.3}')
    ax = dm.plot_sweep(worn, "begin")
    dm.plot_sweep(new, "begin", ax=ax)
    assert [text[-3:] for text in legend_texts(ax)] == ["0.2", "0.3"]
    assert ax.figure.get_suptitle() == "Ω = 14 rad/s"
    assert ax.get_ylabel() == "Speed at which it begins (rad/s)"


def test_a_ratio_is_no_difference_to_the_value_that_it_gives() -> None:
    """One was named by mu_k = 0.24, the other by mu_k/mu_s = 0.6."""
    ax = dm.plot_sweep(speeds().assign_attrs(base='{"N": 385, "mu_s": 0.4, "mu_k": 0.24}'), "begin")
    ratio = '{"N": 200, "mu_s": 0.4, "mu_k_over_mu_s": 0.6}'
    dm.plot_sweep(
        speeds().assign_attrs(base=ratio).rename(N="k"), "begin", ax=ax, labels={"x": "N"}
    )
    assert "0.6" not in "".join(legend_texts(ax))
    same = dm.plot_sweep(speeds().assign_attrs(base=ratio), "begin")
    dm.plot_sweep(speeds().assign_attrs(base=ratio.replace("0.6", "0.5")), "begin", ax=same)
    assert [text[-5:] for text in legend_texts(same)] == ["= 0.6", "= 0.5"]


def test_a_single_horizon_has_its_unit() -> None:
    ax = dm.plot_sweep(speeds(), "begin")
    within = speeds().assign_coords(horizon=((), 60.0, {"units": "s"}))
    dm.plot_sweep(within, "end", ax=ax)
    assert legend_texts(ax)[1].endswith("horizon 60 s")


def test_what_several_variables_say_alike_is_said_by_the_axis() -> None:
    """ "up, Least force at the end of the stay", beside another of the same length."""
    axes = {"direction": ["up", "down"], "Omega": [1.0, 2.0]}
    data = {}
    for name in ("least", "greatest"):
        attrs = {"units": "N", "long_name": f"{name} force at the end of the stay"}
        data[name] = ([*axes], np.eye(2), attrs)
    ax = dm.plot_sweep(xr.Dataset(data, axes, {"base": "{}"}), [*data])
    ends = ["least force", "greatest force"]
    assert legend_texts(ax) == [f"{way}, {end}" for end in ends for way in ("up", "down")]
    assert ax.get_ylabel().replace("\n", " ") == "Force at the end of the stay (N)"


def test_lines_of_several_sweeps_keep_the_names_of_their_values() -> None:
    """Directions of two cases."""
    attrs = {"units": "mm", "long_name": "reach"}
    axes = {"direction": ["up", "down"], "Omega": [1.0, 2.0]}
    study = xr.Dataset({"reach": ([*axes], np.eye(2), attrs)}, axes)
    ax = dm.plot_sweep(study.assign_attrs(base='{"mu_k": 0.2}'), "reach")
    dm.plot_sweep(study.assign_attrs(base='{"mu_k": 0.3}'), "reach", ax=ax)
    said = legend_texts(ax)
    assert len(set(said)) == 4
    assert [text.split(",")[0] for text in said] == ["up", "down", "up", "down"]


def test_rows_of_missing_values_of_several_variables_stand_apart() -> None:
    study = speeds()
    study["begin"] = study["begin"].where(study["N"] > 300)
    ax = dm.plot_sweep(study, ["begin", "end"])
    ax.figure.draw_without_rendering()
    rows = [row.get_window_extent() for row in rows_of(ax)]
    assert len(rows) == 2
    assert rows[0].y1 < rows[1].y0


def rows_of(ax: Any) -> list[Any]:
    """Marks above a panel."""
    return [row for each in rows_above(ax) for row in each.rows]


@pytest.mark.parametrize(
    ("empty", "layout"),
    [
        ("begin", None),
        pytest.param("begin", "constrained", marks=pytest.mark.slow),
        pytest.param("end", None, marks=pytest.mark.slow),
        ("end", "constrained"),
    ],
)
def test_a_variable_without_values_leaves_another_its_numbers_and_its_legend(
    empty: str, layout: Any
) -> None:
    """The common axis had no numbers, and the legend was off the page."""
    study = speeds()
    study["end"][:] = 12.0
    study[empty] = study[empty].where(False)
    figure, ax = pyplot.subplots(figsize=(3.31, 2.36), layout=layout)
    dm.plot_sweep(study, ["begin", "end"], ax=ax)
    figure.draw_without_rendering()
    assert [text.get_text() for text in ax.get_yticklabels()]
    box = ax.get_legend().get_window_extent()
    assert figure.bbox.count_contains(box.corners()) == 4


@pytest.mark.parametrize("layout", [None, "constrained"])
def test_a_legend_as_wide_as_the_page_stays_on_it(layout: Any) -> None:
    """It was cut at the right, where the layout moved the panel once more."""
    figure, ax = pyplot.subplots(figsize=(3.31, 2.36), layout=layout)
    up = "speed at which separation first is found on the way up"
    down = "lowest speed to which it persists without a gap on the way down"
    sweep = {
        "onset_speed": ("N", [13.0, 14.0, 16.0], {**SPEED, "long_name": up}),
        "offset_speed": ("N", [np.nan] * 3, {**SPEED, "long_name": f"{down}, nan if it was not"}),
    }
    dm.plot_sweep(xr.Dataset(sweep, {"N": [300.0, 340.0, 385.0]}), [*sweep], ax=ax)
    lowest = {**SPEED, "long_name": "lowest speed with separation, nan if there is none"}
    scan = {"critical_speed": ("N", [np.nan, 15.5, 19.5, np.nan], lowest)}
    loads = {"N": [300.0, 385.0, 500.0, 600.0], "horizon": ((), 60.0, {"units": "s"})}
    dm.plot_sweep(xr.Dataset(scan, loads), "critical_speed", ax=ax)
    figure.draw_without_rendering()
    box = ax.get_legend().get_window_extent()
    assert figure.bbox.count_contains(box.corners()) == 4


def test_panels_that_share_an_axis_have_numbers_beside_one_without_values() -> None:
    study = speeds()
    study["end"] = study["end"].where(False)
    for order in (["begin", "end"], ["end", "begin"]):
        _, axes = pyplot.subplots(1, 2, sharey=True, layout="constrained")
        for ax, name in zip(axes, order, strict=True):
            dm.plot_sweep(study, name, ax=ax, labels={"y": "Speed (rad/s)"})
        assert axes[0].get_yticks().size


@pytest.mark.parametrize("layout", [None, "constrained"])
def test_what_has_no_value_is_said_once_above_the_marks_of_all_lines(layout: Any) -> None:
    """Three notes lay on each other and on the label, and all marks were alike."""
    figure, ax = pyplot.subplots(figsize=(3.31, 2.36), layout=layout)
    for number in range(3):
        study = speeds().assign_attrs(base=f'{{"Omega": {number}}}')
        study["begin"] = study["begin"].where(study["N"] != 300)
        dm.plot_sweep(study, "begin", ax=ax)
    figure.draw_without_rendering()
    [note] = [text for text in ax.texts if text.get_text() == "no value"]
    words = note.get_window_extent()
    boxes = [row.get_window_extent() for row in rows_of(ax)]
    assert len(boxes) == 3
    assert words.count_overlaps([*boxes, ax.bbox, ax.yaxis.label.get_window_extent()]) == 0
    assert len({row.get_marker() for row in rows_of(ax)}) == 3
    lines = [line for line in ax.lines if line.get_label()[0] != "_"]
    assert [row.get_marker() for row in rows_of(ax)] == [line.get_marker() for line in lines]
    assert [row.get_color() for row in rows_of(ax)] == [line.get_color() for line in lines]


@pytest.mark.parametrize("layout", [pytest.param(None, marks=pytest.mark.slow), "constrained"])
def test_a_long_reason_leaves_panels_their_width(layout: Any) -> None:
    """Panels were 7 mm wide beside it."""
    study = speeds()
    attrs = {**SPEED, "long_name": "speed, nan if at none or at the lowest"}
    study["end"] = study["end"].where(study["N"] > 300).assign_attrs(attrs)
    figure, axes = pyplot.subplots(2, 2, figsize=(3.31, 4), layout=layout)
    axes[0, 0].set_title("A title")
    for ax in axes.flat:
        dm.plot_sweep(study, "end", ax=ax)
    figure.draw_without_rendering()
    for ax in axes.flat:
        [note] = [
            text for text in ax.texts if "none found within" in text.get_text().replace("\n", " ")
        ]
        assert note.get_window_extent().width <= ax.bbox.width + 1
        # of which labels of the second column need the rest
        assert ax.bbox.width > 0.23 * figure.bbox.width
    for left, right in axes:
        assert right.yaxis.label.get_window_extent().x0 > left.bbox.x1
    [title] = [text for text in axes[0, 0].get_children() if text is axes[0, 0].title]
    [note] = axes[0, 0].texts
    assert title.get_window_extent().y0 > note.get_window_extent().y1


def test_titles_beside_each_other_are_level_above_marks_set_apart_from_values() -> None:
    with pyplot.rc_context({"axes.spines.top": False}):
        figure, axes = pyplot.subplots(1, 2, sharey=True, layout="constrained")
    for ax, name in zip(axes, ("begin", "end"), strict=True):
        ax.set_title(f"Speed ({name})")
        dm.plot_sweep(speeds(), name, ax=ax, labels={"y": "Speed (rad/s)"})
    figure.draw_without_rendering()
    low, high = (ax.title.get_window_extent() for ax in axes)
    assert low.y0 == pytest.approx(high.y0)
    [rows] = rows_above(axes[1])
    assert high.y0 > rows.words.get_window_extent().y1
    assert [ax.spines["top"].get_visible() for ax in axes] == [False, True]


@pytest.mark.parametrize("values", [[0, 0, 0], [0.0, np.nan, 0.0]])
def test_counts_that_are_all_zero_have_whole_numbers(values: list[float]) -> None:
    steps = ("N", values, {"long_name": "number of steps"})
    ax = dm.plot_sweep(xr.Dataset({"steps": steps}, {"N": [300.0, 350.0, 400.0]}), "steps")
    ticks = ax.get_yticks()
    assert ticks == pytest.approx(np.round(ticks))


def test_symbols_on_axes_of_a_reader_are_upright_beside_labels_of_the_reader() -> None:
    """The index of k_p was slanted beside an upright Omega."""
    _, axes = pyplot.subplots(1, 2)
    axes[0].set_ylabel("reach of $k_p$ (rad/s)")
    for ax in axes:
        for friction in (0.2, 0.3):
            study = speeds().rename(N="k_p").assign_attrs(base=f'{{"mu_k": {friction}}}')
            dm.plot_sweep(study, "begin", ax=ax)
    for ax in axes:
        assert r"$\mathrm{k_p}$" in ax.get_xlabel()
        assert all("mathrm" in text for text in legend_texts(ax))
    assert axes[0].get_ylabel() == "reach of $k_p$ (rad/s)"


@pytest.mark.parametrize("log", [False, True])
@pytest.mark.parametrize("columns", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_numbers_of_a_short_bar_do_not_meet(log: bool, columns: int) -> None:
    """0.01, 0 and -0.01 lay on each other, and 28 on 29."""
    axes = {"N": [300.0, 350.0], "Omega": [14.0, 15.0]}
    rates = {"growth_rate": ([*axes], [[-0.2, 0.1], [0.2, 0.3]], {"units": "s-1"})}
    reach = {"reach": ([*axes], [[21.0, 24.0], [27.0, 29.9]], {"units": "mm"})}
    figure, panels = pyplot.subplots(2, columns, figsize=(2.95 * columns, 3.4), squeeze=False)
    for ax in panels.flat:
        dm.plot_sweep(xr.Dataset(reach if log else rates, axes), log=log, ax=ax)
    figure.draw_without_rendering()
    for bar in figure.axes[panels.size :]:
        labels = [*bar.get_yticklabels(), *bar.get_yticklabels(minor=True)]
        low, high = bar.get_ylim()
        shown = [
            text for text in labels if text.get_text() and low <= text.get_position()[1] <= high
        ]
        boxes = [text.get_window_extent() for text in shown]
        assert len(boxes) > 1
        assert all(box.count_overlaps(boxes) == 1 for box in boxes)


def test_variables_that_are_drawn_together_are_lines_over_one_dimension() -> None:
    study = dm.sweep(dm.floquet, CASE, Omega=[10.0, 12.0], N=[300.0, 385.0])
    with refusal("must be lines over the same dimension"):
        as_map(study, ["growth_rate", "period"])


@pytest.mark.parametrize(
    ("phrases", "common"),
    [
        (["Growth rate of a", "Growth rate of b"], "Growth rate"),
        (["Lowest position of it", "Highest position of it"], "Position"),
        (["Range", "Period"], ""),
        (["Highest height", "Least height"], "Height"),
    ],
)
def test_the_common_name_is_what_all_are_called(phrases: list[str], common: str) -> None:
    assert common_words(phrases) == common


@pytest.mark.parametrize(
    "drawn",
    [
        lambda: dm.plot_modes(CASE, 2),
        lambda: dm.critical(CASE, "mu_k", (0.2, 0.3), points=3).plot(),
        lambda: run().plot_poincare(),
    ],
    ids=["modes", "critical", "section"],
)
def test_a_branch_does_not_stand_on_a_picture_of_something_else(drawn: Callable[[], Any]) -> None:
    ax = np.ravel(np.asarray(drawn(), dtype=object))[0]
    with refusal(r"^ax: shows"):
        branch().plot("range", ax=ax)
