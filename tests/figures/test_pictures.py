"""Every kind of figure names the quantities on its axes and their units, and shows the values of its
data in these units."""

from itertools import combinations
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from disc_model.figures.draw import PAGE, edges, lone_cells
from disc_model.figures.kinds import KINDS, kind_of, render, save
from disc_model.figures.looks import LOOKS, looks_of
from disc_model.studies.quantity import HOMES, quantity_of
from tests.figures.examples import (
    DAMPERS,
    EXAMPLES,
    KINDS_OF_STUDIES,
    PERIODS,
    SPRINGS,
    Example,
    simulated,
)
from tests.figures.measured import assert_shows

OF_GRIDS = [function.__name__ for function in KINDS_OF_STUDIES]
MARGIN = 0.05  # inch


def drawn(kind: str, example: Example) -> Figure:
    """A figure of an example, as a file asks for it."""
    inputs = {
        name: xr.DataTree(data) if isinstance(data, xr.Dataset) else data
        for name, data in example.inputs.items()
    }
    return render(kind_of(kind).model_validate({"kind": kind, **example.phrase}), inputs)


def said(figure: Figure) -> str:
    """What titles and legend of a figure say, in one line."""
    titles = [ax.get_title(loc="left") for ax in figure.axes]
    entries = [text.get_text() for legend in figure.legends for text in legend.texts]
    return " ".join(" ".join([*titles, *entries]).replace("$", "").split())


def test_each_kind_has_an_example() -> None:
    assert {*KINDS} == {*EXAMPLES}


@pytest.mark.parametrize("kind", EXAMPLES)
def test_labels_units_and_values_are_those_of_the_data(kind: str) -> None:
    """Microseconds for milliseconds, metres for millimetres and 1/min for 1/s were not noticed."""
    example = EXAMPLES[kind]()
    figure = drawn(kind, example)
    assert example.shown
    for expected in example.shown:
        assert_shows(figure, expected)
    for text in example.said:
        assert text.replace("$", "") in said(figure), text


@pytest.mark.parametrize("kind", EXAMPLES)
def test_nothing_lies_outside_the_page(kind: str) -> None:
    figure = drawn(kind, EXAMPLES[kind]())
    figure.draw_without_rendering()
    width, height = figure.get_size_inches()
    page = figure.get_tightbbox()
    assert min(page.x0, page.y0, width - page.x1, height - page.y1) > -MARGIN


def without_numbers(study: xr.Dataset) -> xr.Dataset:
    """A study of which each point has failed."""
    changed = {name: x.where(False) for name, x in study.data_vars.items() if x.dtype.kind == "f"}
    for name, x in study.data_vars.items():
        words = x.attrs.get("flag_meanings", "").split()
        if "failed" in words:
            changed[name] = xr.full_like(x, words.index("failed"))
    return study.assign(changed)


@pytest.mark.parametrize("kind", OF_GRIDS)
@pytest.mark.filterwarnings("error")
def test_a_study_that_has_failed_is_drawn(kind: str) -> None:
    example = EXAMPLES[kind]()
    inputs = {name: without_numbers(study) for name, study in example.inputs.items()}
    drawn(kind, example._replace(inputs=inputs)).draw_without_rendering()


@pytest.mark.parametrize("kind", [kind for kind in OF_GRIDS if kind != "sensitivity"])
def test_a_study_of_one_point_is_drawn(kind: str) -> None:
    example = EXAMPLES[kind]()
    study = example.inputs["study"]
    grid = {"Omega", "N", "c_p", "k_p", "value", "rate"} & {*study.dims}
    first = study.isel(dict.fromkeys(grid, slice(1)))
    drawn(
        kind, example._replace(inputs={**example.inputs, "study": first})
    ).draw_without_rendering()


@pytest.mark.parametrize("kind", ["heat_map", "curve", "region_map", "sliding_outcome"])
@pytest.mark.parametrize(
    ("names", "expected"),
    [({2e4: "soft", "60000": "stiff"}, ["soft", "stiff"]), ({}, ["k = 20 kN/m", "k = 60 kN/m"])],
)
def test_models_stand_beside_each_other_and_are_told_apart(
    kind: str, names: dict[Any, str], expected: list[str]
) -> None:
    """Two models of one thing are panels or lines of one figure, with names of the file's own."""
    example = EXAMPLES[kind]()
    study, *others = example.inputs
    first = example.inputs[study].isel(k_p=0) if kind == "curve" else example.inputs[study]
    first = first.squeeze("normalization", drop=True) if "normalization" in first.dims else first
    both = xr.concat([first.assign_coords(k=value) for value in (2e4, 6e4)], "k")
    both["k"].attrs["units"] = "N m-1"
    inputs = {study: both, **{role: example.inputs[role] for role in others}}
    phrase = {**example.phrase, "by": "k", "names": names}
    figure = drawn(kind, example._replace(phrase=phrase, inputs=inputs))
    assert all(text in said(figure) for text in expected)


@pytest.mark.parametrize("kind", [kind for kind in OF_GRIDS if len(EXAMPLES[kind]().inputs) > 1])
def test_further_studies_may_be_left_out(kind: str) -> None:
    example = EXAMPLES[kind]()
    needed = {"study", *(name for name, role in KINDS[kind].roles.items() if role.required)}
    inputs = {name: study for name, study in example.inputs.items() if name in needed}
    overlays = {name: "s" for name in inputs if name != "study"}
    phrase = {**example.phrase, "overlays": overlays}
    drawn(kind, example._replace(phrase=phrase, inputs=inputs)).draw_without_rendering()


# ---- Where values are


def test_a_point_of_a_line_is_at_its_value() -> None:
    example = EXAMPLES["curve"]()
    lines = drawn("curve", example).axes[0].lines
    for drawn_line, periods in zip(lines, PERIODS, strict=False):
        np.testing.assert_allclose(drawn_line.get_xdata(), DAMPERS, rtol=1e-12)
        np.testing.assert_allclose(drawn_line.get_ydata(), 1e3 * periods, rtol=1e-12)


def test_a_cell_of_a_map_is_at_its_point() -> None:
    figure = drawn("heat_map", EXAMPLES["heat_map"]())
    [mesh] = figure.axes[0].collections
    corners = mesh.get_coordinates()
    middles = (corners[1:, 1:] + corners[:-1, :-1]) / 2
    np.testing.assert_allclose(middles[0, :, 0], DAMPERS)
    np.testing.assert_allclose(middles[:, 0, 1], np.array(SPRINGS) / 1e3)
    np.testing.assert_allclose(mesh.get_array(), 1e3 * PERIODS)


def test_a_mode_is_thick_where_it_grows() -> None:
    example = EXAMPLES["sliding_modes"]()
    rates = example.inputs["study"]["mode_growth_rate"].values
    lines = drawn("sliding_modes", example).axes[1].lines
    thick = [line.get_ydata().ravel() for line in lines if line.get_label() == "mode that grows"]
    found = np.concatenate(thick)
    np.testing.assert_allclose(np.sort(found[np.isfinite(found)]), np.sort(rates[rates > 1e-9]))


def test_points_of_a_section_are_marked_by_the_stage_of_the_run() -> None:
    turns = simulated(True)["poincare"].to_dataset()
    first = float(simulated(True)["first_separation"])
    lines = drawn("poincare", EXAMPLES["poincare"]()).axes[0].lines
    points = {line.get_label(): line.get_xdata()[np.isfinite(line.get_ydata())] for line in lines}
    before = turns["psi"].values[turns["time"].values < first]
    np.testing.assert_allclose(points["before the first separation"], before)
    assert sum(map(len, points.values())) == turns.sizes["time"]


def test_points_on_the_way_are_told_from_the_final_motion() -> None:
    """A run that separates at 10 s, and whose section repeats after ten points from 40 s on; that it
    has settled was not shown."""
    tree = simulated(True).copy()
    time = np.arange(200.0)
    size = np.where(time < 40, 3 - time / 40, 1)
    section = {
        "psi": size * np.cos(0.2 * np.pi * time),
        "psi_velocity": size * np.sin(0.2 * np.pi * time),
        "w_point": size * np.cos(0.2 * np.pi * time),
        "w_point_velocity": size * np.sin(0.2 * np.pi * time),
        "phase": np.where(time == 20, 2, 1).astype(np.int8),
    }
    kept = tree["poincare"].to_dataset()
    columns = {name: ("time", values, kept[name].attrs) for name, values in section.items()}
    tree["poincare"] = xr.DataTree(xr.Dataset(columns, {"time": time}, kept.attrs))
    tree.dataset = tree.to_dataset().assign(first_separation=10.0, settled_since=np.nan)
    figure = drawn("poincare", Example({"case": "A"}, {"A": tree}))
    assert "first separation at 10.00 s, final motion since 40 s" in said(figure)
    counts = {x.get_label(): np.isfinite(x.get_ydata()).sum() for x in figure.axes[0].lines}
    assert counts["in contact, on the way to the final motion"] == 29
    assert counts["separated, on the way to the final motion"] == 1
    assert counts["in contact, final motion"] == 160


@pytest.mark.parametrize(
    ("kind", "words", "height"),
    [("ramps", "falling, 8 to 20", 0.015), ("basins", "no start is known", 0.985)],
)
def test_a_missing_value_stands_at_the_edge_beyond_which_it_is(
    kind: str, words: str, height: float
) -> None:
    """That no start separates was read as a low energy."""
    found = [line for ax in drawn(kind, EXAMPLES[kind]()).axes for line in ax.lines]
    [crosses] = [line for line in found if str(line.get_label()).startswith(words)]
    assert {*np.asarray(crosses.get_ydata())} == {height}


def test_divergence_is_told_from_flutter() -> None:
    example = EXAMPLES["sliding_modes"]()
    study = example.inputs["study"].copy(deep=True)
    study["mode_growth_rate"][{"mode": 0}] = [-1, 0.5, 1, 0.5, -1]
    study["mode_growth_rate"][{"mode": 1}] = [-1, -1, 0.5, -1, -1]
    study["frequency"][{"mode": 0}] = 0
    study["diameters"][{"mode": 1}] = 1
    ax = drawn("sliding_modes", example._replace(inputs={"study": study})).axes[1]
    growing = {line.get_label(): line for line in ax.lines}
    assert {"0 Hz", "l = 1"} <= {*growing}
    assert np.nanmax(growing["0 Hz"].get_ydata()) == 1


def test_a_class_of_a_map_is_painted_at_its_points() -> None:
    """The cell at 14 rad/s and 310 N grows, those beside it separate."""
    ax = drawn("region_map", EXAMPLES["region_map"]()).axes[0]
    areas = {patch.get_label(): patch.get_path() for patch in ax.patches}
    for label, inside, outside in (
        ("growing, in contact", (14, 310), (16, 310)),
        ("stick-slip, small", (12, 310), (14, 310)),
        ("separation", (14, 120), (14, 310)),
    ):
        assert areas[label].contains_point(inside), label
        assert not areas[label].contains_point(outside), label


def test_a_value_along_another_dimension_is_chosen() -> None:
    """By its number in SI units, or with a unit."""
    for value in (5e4, "50 kN/m"):
        phrase = {"variable": "period", "x": "c_p", "at": {"k_p": value}}
        ax = drawn("curve", Example(phrase, EXAMPLES["curve"]().inputs)).axes[0]
        np.testing.assert_allclose(ax.lines[0].get_ydata(), 1e3 * PERIODS[1], rtol=1e-12)


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ([1.0, 2.0, 4.0], [0.5, 1.5, 3.0, 5.0]),
        ([1.0, 10.0, 100.0], 10.0 ** np.array([-0.5, 0.5, 1.5, 2.5])),
        ([8.0], [7.6, 8.4]),
        ([0.0], [-1.0, 1.0]),
    ],
)
def test_cells_end_halfway_between_values(values: list[float], expected: Any) -> None:
    np.testing.assert_allclose(edges(xr.DataArray(values)), expected)


def test_single_cells_of_a_class_are_hatched_as_finer_than_the_grid() -> None:
    words = np.full((3, 5), "a", dtype=object)
    words[1, 2] = "b"
    words[:, 4] = "c"
    alone = lone_cells(xr.DataArray(words, dims=("N", "Omega")))
    assert np.argwhere(alone.values).tolist() == [[1, 2]]


def test_classes_of_a_flag_are_told_apart_in_grey_print() -> None:
    """By lightness, or by pattern, and none is called as another."""
    for name in HOMES:
        for variable, column in quantity_of(name).columns.items():
            words = [str(word) for word in column.flags if word in LOOKS]
            for one, other in combinations(looks_of(words).values(), 2):
                assert one.label != other.label, variable
                apart = abs(lightness(one.face) - lightness(other.face))
                assert one.hatch != other.hatch or apart > 0.08, (variable, one, other)


def lightness(colour: str) -> float:
    """Of a colour in grey print; paper is seen where nothing is painted."""
    return float(np.dot(to_rgb(colour.replace("none", "white")), (0.3, 0.59, 0.11)))


# ---- Titles, widths, and figures of several cases


def test_a_title_stands_above_a_figure_unless_it_has_a_caption() -> None:
    example = EXAMPLES["curve"]()
    for caption, head in (("", "Periods"), ("Periods of cycles.", "")):
        phrase = {**example.phrase, "title": "Periods", "caption": caption, "width": "page"}
        figure = drawn("curve", example._replace(phrase=phrase))
        assert figure.get_suptitle() == head
        assert figure.get_figwidth() == PAGE


def test_cases_below_each_other_say_what_differs_and_what_they_come_to() -> None:
    inputs = {"A": simulated(True), "B": simulated(False)}
    figure = drawn("poincare", Example({"case": "A", "below": ["B"]}, inputs))
    assert len(figure.axes) == 4
    assert (
        "N = 385 N, Ω = 15.1 rad/s, first separation at 54.42 s, settling not shown here"
        in said(figure)
    )
    assert "Ω = 15 rad/s, no separation" in said(figure)


# ---- Doubts, gaps, and units of the reader


def curve_of(values: Any, **columns: Any) -> tuple[Example, xr.Dataset]:
    """A line of growth rates over three speeds."""
    study = xr.Dataset(
        {"growth_rate": ("Omega", values, {"units": "s-1", "long_name": "growth rate"}), **columns},
        {"Omega": ("Omega", [10.0, 11.0, 12.0], {"units": "rad s-1"})},
    )
    study["growth_rate"].attrs["missing"] = "there is no cycle"
    return Example({"variable": "growth_rate", "x": "Omega"}, {"study": study}, ()), study


def test_a_point_without_a_value_is_a_cross_that_says_why() -> None:
    example, _ = curve_of([0.01, np.nan, 0.02])
    figure = drawn("curve", example)
    assert "no value: there is no cycle" in said(figure)
    crosses = [line for line in figure.axes[0].lines if line.get_marker() == "x"]
    assert [line.get_xdata().tolist() for line in crosses] == [[11.0]]


def test_a_value_in_doubt_is_hollow() -> None:
    settled = ("Omega", np.array([1, 0, 1], np.int8), {"flag_meanings": "undecided settled"})
    example, _ = curve_of([0.01, 0.02, 0.03], settled=settled)
    figure = drawn("curve", example)
    [hollow] = [line for line in figure.axes[0].lines if line.get_markerfacecolor() == "white"]
    assert hollow.get_xdata().tolist() == [11.0]
    assert "hollow" in said(figure)


def test_a_line_of_growth_rates_is_open_where_another_cycle_may_follow() -> None:
    example, _ = curve_of([0.01, 5.0, 5.1])
    [line] = [line for line in drawn("curve", example).axes[0].lines if len(line.get_xdata()) == 4]
    assert np.flatnonzero(np.isnan(line.get_ydata())).tolist() == [1]


def test_values_are_drawn_in_the_units_of_the_reader() -> None:
    example, study = curve_of([0.01, 0.02, 0.03])
    figure = drawn("curve", example._replace(phrase={**example.phrase, "units": {"Omega": "rpm"}}))
    ax = figure.axes[0]
    assert ax.get_xlabel() == "Speed Ω (rpm)"
    expected = study["Omega"].values * 30 / np.pi
    np.testing.assert_allclose(ax.lines[0].get_xdata(), expected, rtol=1e-12)  # of one product


def test_a_product_has_its_power_of_ten_once() -> None:
    study = xr.Dataset(
        {"period": (("D_star", "Omega"), [[0.01, 0.02], [0.03, 0.04]], {"units": "s"})},
        {
            "D_star": ("D_star", [1e-5, 2e-5], {"units": "N m s"}),
            "Omega": ("Omega", [10.0, 11.0], {"units": "rad s-1"}),
        },
    )
    phrase = {"variable": "period", "x": "Omega", "by": "D_star"}
    assert "D* = 1·10⁻⁵ N m s" in said(drawn("curve", Example(phrase, {"study": study}, ())))


# ---- Files


@pytest.mark.parametrize("suffix", ["pdf", "png"])
def test_equal_figures_give_equal_bytes_whatever_the_users_settings(
    suffix: str, tmp_path: Path
) -> None:
    example = Example({"case": "A", "window": "history"}, {"A": simulated(True)}, ())
    save(drawn("history", example), tmp_path / f"a.{suffix}")
    before = dict(mpl.rcParams)
    with mpl.rc_context({"axes.labelsize": 30, "lines.linewidth": 9}):
        save(drawn("history", example), tmp_path / f"b.{suffix}")
    assert dict(mpl.rcParams) == before
    content = (tmp_path / f"a.{suffix}").read_bytes()
    assert content == (tmp_path / f"b.{suffix}").read_bytes()
    assert b"CreationDate" not in content
    assert b"/Type3" not in content, "fonts are embedded as TrueType"


def test_a_case_without_what_is_shown_says_so() -> None:
    tree = simulated(True).copy()
    del tree["zoom"]
    example = Example({"case": "A", "window": "zoom"}, {"A": tree}, ())
    figure = drawn("history", example)
    assert figure.axes[0].texts[0].get_text() == "not shown: the case did not record zoom"
