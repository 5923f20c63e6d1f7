"""Labels and titles in as few lines as their axes have room for."""

import numpy as np
import pytest
from matplotlib import pyplot
from matplotlib.figure import Figure
from matplotlib.text import Text

import disc_model as dm
from disc_model.figures.axis_numbers import part_numbers
from disc_model.figures.head_texts import head_text, what_case
from disc_model.figures.labels import break_labels, in_lines
from disc_model.figures.peak_names import name_lines
from disc_model.figures.sizes import COLUMN
from disc_model.figures.stated_case import stated
from tests.figures.reading import assert_numbers_are_apart


@pytest.mark.parametrize(
    ("text", "count", "lines"),
    [
        ("Speed Ω (rad/s)", 1, ["Speed Ω (rad/s)"]),
        ("Growth rate of the stick-slip cycle (1/s)", 2, ["Growth rate of the", "stick-slip cycle (1/s)"]),
        ("a bb cccccccc", 2, ["a bb", "cccccccc"]),
        ("one two", 5, ["one", "two"]),
        (r"$\theta$ first second", 2, [r"$\theta$ first", "second"]),
    ],
)  # fmt: skip
def test_the_longest_line_is_as_short_as_it_can_be(text: str, count: int, lines: list[str]) -> None:
    assert in_lines(text, count).split("\n") == lines


def test_titles_take_no_more_lines_than_they_need() -> None:
    """A title for which one long word set the width had a line for each word."""
    figure, axes = pyplot.subplots(1, 4, figsize=(174 / 25.4, 2.9), layout="constrained")
    for ax in axes:
        ax.set_title("(a) tangential motion left out, damping ratio 0.0001", loc="left", fontsize=8)
        ax.set_ylabel("Load")
    break_labels(figure)
    for ax in axes:
        text = ax.get_title(loc="left")
        assert text.count("\n") <= 4
    pyplot.close(figure)


def test_labels_that_fit_stay_as_they_are() -> None:
    figure, ax = pyplot.subplots(figsize=(4, 3), layout="constrained")
    ax.set_xlabel("Speed Ω (rad/s)")
    ax.set_ylabel("Growth rate of disturbances of the cycle that the static start follows (1/s)")
    break_labels(figure)
    assert ax.get_xlabel() == "Speed Ω (rad/s)"
    assert ax.get_ylabel().count("\n") >= 1
    figure.draw_without_rendering()
    assert ax.yaxis.label.get_window_extent().height <= 1.15 * ax.get_window_extent().height
    pyplot.close(figure)


@pytest.mark.parametrize(
    ("text", "whole"),
    [
        ("In-plane damper c (N s/m)", "(N s/m)"),
        ("sliding with P = 384.976 N, stable", "P = 384.976 N,"),
    ],
)
def test_units_and_values_are_never_broken(text: str, whole: str) -> None:
    """A unit was broken within its brackets, and a value stood below its name."""
    figure, ax = pyplot.subplots(figsize=(1.1, 2), layout="constrained")
    ax.set_xlabel(text)
    break_labels(figure)
    said = ax.get_xlabel()
    assert "\n" in said
    assert said.replace("\n", " ") == text
    assert whole in said
    pyplot.close(figure)


def test_labels_end_within_the_page() -> None:
    """On axes that fill their figure, the unit of a label was cut off."""
    figure, ax = pyplot.subplots(figsize=(84 / 25.4, 2.4), layout="constrained")
    ax.set_xlabel("Speed")
    ax.set_ylabel("Growth rate of the cycle (1/s)")
    break_labels(figure)
    figure.draw_without_rendering()
    box = ax.yaxis.label.get_window_extent()
    assert box.y0 >= 0
    assert box.y1 <= figure.bbox.y1
    pyplot.close(figure)


def test_numbers_of_narrow_axes_are_apart_and_more_than_one() -> None:
    """Times with six digits ran into each other."""
    figure, ax = pyplot.subplots(figsize=(1.5, 1.5), layout="constrained")
    ax.set_xlim(59.93, 60)
    figure.draw_without_rendering()
    part_numbers(ax)
    figure.draw_without_rendering()
    assert_numbers_are_apart(ax)
    assert len(ax.get_xticks()) > 1
    pyplot.close(figure)


@pytest.mark.parametrize("neighbour", [(136.0, 0.1), (144.4, 0.1)])
def test_the_frequency_of_a_line_stands_on_its_own_side(neighbour: tuple[float, float]) -> None:
    """The name of the weaker of two lines stood beyond the stronger one."""
    figure, ax = pyplot.subplots(figsize=(84 / 25.4, 2.4), layout="constrained")
    ax.set(xlim=(0, 400), ylim=(1e-5, 1), yscale="log")
    name_lines(ax, [(140.2, 0.05), neighbour])
    figure.draw_without_rendering()
    shown = {text.get_text(): text.get_window_extent() for text in ax.texts if text.get_visible()}
    assert set(shown) == {"140.2 Hz", f"{neighbour[0]:.1f} Hz"}
    own, _ = ax.transData.transform((140.2, 0.05))
    other, _ = ax.transData.transform(neighbour)
    box = shown["140.2 Hz"]
    if other < own:
        assert box.x0 > own
    else:
        assert box.x1 < own
    pyplot.close(figure)


def test_a_name_that_would_stand_nearer_to_another_point_is_left_out() -> None:
    figure, ax = pyplot.subplots(figsize=(84 / 25.4, 2.4), layout="constrained")
    ax.set(xlim=(0, 400), ylim=(1e-5, 1), yscale="log")
    name_lines(ax, [(140.2, 0.05), (136.0, 0.1), (144.4, 0.1)])
    figure.draw_without_rendering()
    shown = {text.get_text() for text in ax.texts if text.get_visible()}
    assert shown == {"136.0 Hz", "144.4 Hz"}
    pyplot.close(figure)


@pytest.mark.parametrize("width", [30, 40, 84, 174])
def test_the_strongest_of_many_lines_is_named_and_none_but_the_five_strongest(width: float) -> None:
    """In a narrow panel the eighth strongest line of a crowded spectrum was named alone, and 208
    texts were made."""
    figure, ax = pyplot.subplots(figsize=(width / 25.4, 1.8), layout="constrained")
    ax.set(xlim=(0, 400), ylim=(1e-5, 30), yscale="log")
    frequencies = 4.8 * np.arange(1, 80)
    peaks = [(f, 3.8 / (1 + (f - 187.2) ** 2)) for f in frequencies.tolist()]
    peaks[0] = (4.8, 0.01)
    name_lines(ax, peaks)
    figure.draw_without_rendering()
    strongest = sorted(peaks, key=lambda peak: -peak[1])[:5]
    shown = {text.get_text(): text for text in ax.texts if text.get_visible()}
    assert "187.2 Hz" in shown
    assert shown.keys() <= {f"{frequency:.1f} Hz" for frequency, _ in strongest}
    assert len(ax.texts) == 5
    own, top = ax.transData.transform((187.2, 3.8))
    box = Text.get_window_extent(shown["187.2 Hz"])
    assert abs(np.clip(own, box.x0, box.x1) - own) < 6
    assert 0 < box.y0 - top < 15
    pyplot.close(figure)


def test_no_name_is_shown_without_that_of_the_strongest_line() -> None:
    figure, ax = pyplot.subplots(figsize=(84 / 25.4, 2.4), layout="constrained")
    ax.set(xlim=(0, 400), ylim=(1e-5, 1), yscale="log")
    name_lines(ax, [(140.2, 1.0), (300.0, 0.1)])  # the first has its peak at the frame
    ax.set_xlim(140, 400)
    ax.set_ylim(1e-5, 0.5)
    figure.draw_without_rendering()
    assert not [text for text in ax.texts if text.get_visible()]
    pyplot.close(figure)


@pytest.mark.parametrize("apart", [2.4, 8.0])
def test_a_name_stands_on_no_other_side_of_a_taller_line(apart: float) -> None:
    """The name of a weak line between two strong ones stood beside one of these."""
    figure, ax = pyplot.subplots(figsize=(84 / 25.4, 2.4), layout="constrained")
    ax.set(xlim=(0, 400), ylim=(1e-5, 100), yscale="log")
    peaks = [(135.4 - apart, 8.5), (135.4, 0.4), (135.4 + apart, 8.0), (2.4, 11.0)]
    name_lines(ax, peaks)
    figure.draw_without_rendering()
    boxes = {text.get_text(): text.get_window_extent() for text in ax.texts if text.get_visible()}
    assert boxes.keys() == {f"{frequency:.1f} Hz" for frequency, height in peaks if height > 1}
    for frequency, height in peaks[:1] + peaks[2:]:
        own, _ = ax.transData.transform((frequency, height))
        box = boxes[f"{frequency:.1f} Hz"]
        # three points beside its own line, of 100 dots an inch, and the rest of the last letter
        assert min(abs(box.x0 - own), abs(box.x1 - own)) < 6
    pyplot.close(figure)


def test_many_values_take_two_lines_above_a_figure() -> None:
    """The head of a map of a steel disc took seven lines, a third of its figure."""
    values = ", ".join(f"x{i} = {i} N" for i in range(40))
    title, *lines = head_text(3.5, "A title", values, most=2).split("\n")
    assert title == "A title"
    assert len(lines) == 2
    shown = " ".join(lines).count("=")
    assert lines[-1].endswith(f"and {40 - shown} further parameters")
    assert head_text(3.5, "", "N = 1 N", most=2) == "N = 1 N"
    assert head_text(3.5, "", values).count("=") == 40


def test_parameters_without_a_symbol_have_words() -> None:
    assert what_case({"contact_arc": 0.4}) == "a pad over 0.4 rad"


def test_the_label_of_a_colour_bar_is_no_longer_than_the_bar() -> None:
    """It ran up to the title above a low map."""
    figure, ax = pyplot.subplots(figsize=(3.5, 2.0), layout="constrained")
    label = "Largest speed of the disc's surface relative to the drive's"
    bar = figure.colorbar(ax.pcolormesh([[0.0, 1.0]]), label=label)
    break_labels(figure)
    figure.draw_without_rendering()
    assert bar.ax.yaxis.label.get_window_extent().height <= bar.ax.get_window_extent().height
    pyplot.close(figure)


def test_symbols_are_upright_in_new_figures_and_keep_their_words() -> None:
    """With an index they were slanted beside N, k and Ω, if the figure was saved with another number
    of dots per inch."""
    case = dm.Parameters(N=385, Omega=15, c_p=4, k_p=8000)
    study = dm.sweep(dm.steady_sliding, case, mu_k=[0.1, 0.2])
    ax = dm.plot_sweep(study, "growth_rate")
    symbols = r"$\mathrm{c_p}$ = 4 N s/m, $\mathrm{k_p}$ = 8 kN/m"
    assert " ".join(ax.figure.get_suptitle().split()).endswith(symbols)
    other = dm.sweep(dm.steady_sliding, case.replace(k_p=9000), mu_k=[0.1, 0.2])
    dm.plot_sweep(other, "growth_rate", ax=ax)
    assert ax.figure.get_suptitle().endswith(r"$\mathrm{c_p}$ = 4 N s/m"), "what is common"
    [legend] = ax.figure.legends
    assert [text.get_text() for text in legend.get_texts()] == [
        rf"$\mathrm{{k_p}}$ = {value} kN/m" for value in (8, 9)
    ]
    pyplot.close("all")


def test_titles_say_choices_of_the_model_before_the_size_of_the_disc() -> None:
    """At 84 mm, friction on the surface and its coefficients were counted behind “and 6 more”."""
    steel = {"E": 2.1e11, "rho": 7850.0, "nu": 0.3, "h": 0.02, "a": 0.05, "b": 0.15, "r_0": 0.12}
    options = {"friction_offset": "surface", "mu_s": 0.45, "mu_k": 0.35, "c_p": 5.0}
    said = what_case({**steel, "k": 1e6, **options, "N": 8000.0, "Omega": 50.0})
    first = "N = 8000 N, Ω = 50 rad/s, μ_s = 0.45, μ_k = 0.35, friction on the surface, "
    disc = "k = 1000 kN/m, E = 210 GPa, h = 20 mm, "
    assert said.startswith(f"{first}{disc}c_p = 5 N s/m, a = 50 mm, ")
    lines = head_text(COLUMN, "", said, 3).splitlines()
    assert len(lines) == 3
    assert "friction on the surface" in " ".join(lines)
    assert lines[-1].endswith("further parameters")


def test_titles_say_which_disc_and_slider_before_how_they_are_computed() -> None:
    """At 84 mm, stiffness, thickness, mass and spring of a steel disc were among “and 8 more”."""
    steel = {
        "N": 5000.0,
        "Omega": 60.0,
        "E": 2.1e11,
        "rho": 7850.0,
        "nu": 0.3,
        "h": 6e-3,
        "m": 0.3,
        "k": 5e5,
        "k_p": 2e5,
        "c_p": 20.0,
        "mu_s": 0.45,
        "mu_k": 0.35,
        "friction_offset": "surface",
        "contact_arc": 0.4,
        "damping_ratio": 5e-4,
        "normalization": "orthonormal",
        "n_diameters": 6,
    }
    said = what_case(steel)
    shown = head_text(COLUMN, "", said, 3)
    for value in ("E = 210 GPa", "h = 6 mm", "m = 300 g", "k = 500 kN/m"):
        assert value in shown
    assert said.endswith("nodal diameters up to 6, orthonormal modes")


def test_titles_tell_discs_that_are_given_by_their_modes_apart() -> None:
    """Two discs of as many modes had the same title."""
    titles = []
    for highest in (1820, 2300):
        disc = dm.Disc(diameters=[0, 2], omega=[1490, highest], amplitude=[1.5, 2.2])
        titles.append(stated(dm.Parameters(N=385, Omega=15, disc=disc)))
    start = "N = 385 N, Ω = 15 rad/s, a disc given by 2 modes of 237.1 to"
    assert titles == [f"{start} {highest} Hz" for highest in ("289.7", "366.1")]


def test_a_value_with_its_unit_alone_is_not_broken() -> None:
    """A title of "18 rad/s" above a small panel was."""
    figure = Figure(figsize=(1.0, 1.0))
    ax = figure.subplots()
    ax.set_title("18 rad/s", loc="left", fontsize=12)
    break_labels(figure)
    assert ax.get_title(loc="left") == "18 rad/s"
