"""Figures from made-up studies, and what stands in them."""

from collections.abc import Mapping
from typing import Any

import pytest
import xarray as xr
from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

import disc_model as dm
from disc_model.figures.kinds import kind_of
from disc_model.figures.render import render

ON_EACH_SCALE = pytest.mark.parametrize(
    ("x", "values", "scale"),
    [
        ("Omega", [5.0, 10, 20], "linear"),
        ("D_star", [0, 1e-6, 1e-4], "symlog"),
        ("m", [0.01, 0.1, 1], "log"),
    ],
)
"""A parameter that maps show on each, with three values."""


def draw(
    kind: str, study: xr.Dataset, others: Mapping[str, xr.Dataset] | None = None, **phrase: Any
) -> Figure:
    """A figure of a kind, as a file asks for it, with further studies by their roles; fit for
    print."""
    shown = {"study": study, **(others or {})}
    inputs = {name: xr.DataTree(dataset) for name, dataset in shown.items()}
    figure = render(kind_of(kind).model_validate({"kind": kind, **phrase}), inputs)
    assert_fit_for_print(figure)
    return figure


def as_map(study: xr.Dataset, *chosen: Any, **wishes: Any) -> Axes:
    """Draw a sweep as a map, also if one of its dimensions has few values; along one dimension, as it is
    drawn there."""
    name = chosen[0] if chosen else "status"
    shown = study.get(name, study)
    plane = [dim for dim in shown.dims if study.sizes[dim] > 1 and study[dim].dtype.kind in "fi"]
    lines: Any = False if len(plane) == 2 else ""
    return dm.plot_sweep(study, *chosen, lines=lines, **wishes)


def small_axes() -> Axes:
    """Axes of a reader, of a column of a page."""
    return pyplot.subplots(figsize=(3.3, 2.9))[1]


LEAST_PANEL = 0.4  # inch


def assert_fit_for_print(figure: Figure) -> None:
    """Nothing lies outside the page or over a title, and all axes are named; an empty panel says
    why. Panels are not tiny, numbers along an axis do not overlap, and no name stands along an axis
    without them."""
    figure.draw_without_rendering()
    width, height = figure.get_size_inches()
    page = figure.get_tightbbox()
    margin = 0.05  # inch
    assert min(page.x0, page.y0, width - page.x1, height - page.y1) > -margin
    if title := figure.get_suptitle():
        above = figure._suptitle.get_window_extent()
        assert not [
            legend for legend in figure.legends if legend.get_window_extent().overlaps(above)
        ], title
    for ax in figure.axes:
        if not ax.axison:
            assert ax.texts or ax.get_label() == "<colorbar>"
        elif ax.has_data() and ax.get_label() != "<colorbar>":
            assert any(one.get_ylabel() for one in (ax, *ax.get_shared_y_axes().get_siblings(ax)))
            assert any(one.get_xlabel() for one in figure.axes)
    for text in (
        text for ax in figure.axes for text in (ax.xaxis.label, ax.yaxis.label) if text.get_text()
    ):
        assert text.get_fontsize() >= 6
    for ax in figure.axes:
        assert_numbers_are_apart(ax)
        assert not ax.get_xlabel() or ax.xaxis.get_tick_params()["labelbottom"]
        frame = ax.get_window_extent()
        if ax.axison and ax.get_label() != "<colorbar>" and ax.get_subplotspec() is not None:
            assert min(frame.width, frame.height) > LEAST_PANEL * figure.dpi


def assert_numbers_are_apart(ax: Axes) -> None:
    """No number along an axis covers another."""
    for axis in (ax.xaxis, ax.yaxis):
        low, high = sorted(axis.get_view_interval())
        ticks = [*axis.get_major_ticks(), *axis.get_minor_ticks()]
        shown = [
            tick.label1
            for tick in ticks
            if low <= tick.get_loc() <= high and tick.label1.get_text()
        ]
        boxes = [text.get_window_extent() for text in shown if text.get_visible()]
        for i, box in enumerate(boxes):
            assert not box.count_overlaps(boxes[i + 1 :]), [text.get_text() for text in shown]


def crosses(ax: Axes) -> list[list[float]]:
    """Where points are marked as failed, along the axis."""
    lines = [line for line in ax.lines if line.get_label() == "failed"]
    return [
        list(
            line.get_xdata()
            if line.get_transform() == ax.get_xaxis_transform()
            else line.get_ydata()
        )
        for line in lines
    ]


def labels(shown: Figure | Axes) -> list[str]:
    """What the legends of a figure, or that of a panel, say."""
    if isinstance(shown, Figure):
        legends = shown.legends
    else:
        legends = [shown.get_legend()]
    texts = [
        text.get_text() for legend in legends for text in (*legend.get_texts(), legend.get_title())
    ]
    return [text for text in texts if text]


def lines(ax: Axes) -> dict[str, Line2D]:
    """By what they are called."""
    return {str(line.get_label()): line for line in ax.lines}
