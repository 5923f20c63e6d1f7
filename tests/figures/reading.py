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
    """A figure of a kind, as a file asks for it, with further studies by their roles."""
    shown = {"study": study, **(others or {})}
    inputs = {name: xr.DataTree(dataset) for name, dataset in shown.items()}
    return render(kind_of(kind).model_validate({"kind": kind, **phrase}), inputs)


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


def assert_fit_for_print(figure: Figure) -> None:
    """Nothing lies outside the page, and axes are named; an empty panel says why."""
    figure.draw_without_rendering()
    width, height = figure.get_size_inches()
    page = figure.get_tightbbox()
    margin = 0.05  # inch
    assert min(page.x0, page.y0, width - page.x1, height - page.y1) > -margin
    for ax in figure.axes:
        if not ax.axison:
            assert ax.texts or ax.get_label() == "<colorbar>"
        elif ax.has_data() and ax.get_label() != "<colorbar>":
            assert any(one.get_ylabel() for one in (ax, *ax.get_shared_y_axes().get_siblings(ax)))
            assert any(one.get_xlabel() for one in figure.axes)


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
