"""What a reader asks of pictures: own axes, legend, labels, title and settings of matplotlib."""

import functools
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from matplotlib import pyplot
from matplotlib.axes import Axes

import disc_model as dm
from disc_model.figures.sizes import COLUMN
from tests.figures.reading import as_map
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


@pytest.mark.parametrize("name", DRAWN)
def test_new_figures_have_their_title_unless_it_is_false(name: str) -> None:
    asked = one(DRAWN[name](title=True)).figure
    without = one(DRAWN[name](title=False)).figure
    assert asked.get_suptitle() == usual(name).figure.get_suptitle()
    assert without.get_suptitle() == ""


WRONG = {
    "legend": ({"lok": "best"}, "did you mean loc"),
    "labels": ({"x": 1}, "must be texts"),
    "title": (3, "must be a text, True or False"),
    "ax": ("axes", "must be 1 axes"),
}


def test_a_label_that_replaces_nothing_is_named() -> None:
    with refusal(r"labels='slipp': .*did you mean slip"):
        DRAWN["portrait"](labels={"slipp": "sliding"})


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


def test_variables_beside_each_other_have_labels_and_those_below_each_other_share_them() -> None:
    beside = pyplot.subplots(1, 2)[1]
    run().plot("late", variables=["P", "u"], ax=beside)
    assert [ax.get_xlabel() for ax in beside] == ["Time (s)", "Time (s)"]
    stacked = pyplot.subplots(2, 1)[1]
    run().plot("late", variables=["P", "u"], ax=stacked)
    assert [ax.get_xlabel() for ax in stacked] == ["", "Time (s)"]
    units = [ax.get_ylabel().rpartition(" ")[2] for ax in stacked]
    assert units == ["(N)", "(mm)"]
