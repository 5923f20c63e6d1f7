"""Charts of the explorer, in Vega-Lite, which draw the data `points` and `samples` that the page has.

A row of `points` has the values of a point, its number `id`, its index along dimensions of which one
value is chosen as ``_dimension``, and on maps the edges of its cell, `_x0`, `_x1`, `_y0` and `_y1`. The
parameter `pick` is the `id` of the point that was clicked.
"""

from collections.abc import Sequence
from typing import Any

import altair as alt
from xarray import DataArray, Dataset

from disc_model.figures.draw import is_geometric
from disc_model.figures.looks import BLACK, GREY, OF_PHASE
from disc_model.figures.shown import label, parameter_of

Entries = dict[str, Any]
Names = Sequence[str]

SWEPT = ("x", "value")
"""Variables that are values of a parameter."""
HISTORIES = ("P", "u", "psi")
WIDTH = 370  # of a panel, pixels
HEIGHT = 300
NO_VALUE = {"color": {"value": "#e4e4e4"}}
IS_RATE = "test(/growth_rate/, numbers)"
COLOURS = alt.Scale(
    type="symlog",
    constant=alt.expr(f"{IS_RATE} ? 0.01 : 1e9"),  # linear up to 0.01/s, or all over
    scheme=alt.expr(f"{IS_RATE} ? 'redblue' : 'viridis'"),
    reverse=alt.expr(IS_RATE),
    domainMid=alt.expr(f"{IS_RATE} ? 0 : null"),
)
"""The colours of numbers: growth rates have two, which meet at zero."""
NUMBERS, COUNTS, WORDS = range(3)


def kind_of(along: DataArray) -> int:
    """Whether values along a dimension are numbers, or only count, or are words."""
    if along.dtype.kind not in "fi":
        return WORDS
    return COUNTS if along.dtype.kind == "i" and not parameter_of(along) else NUMBERS


def axes_of(group: Dataset, wished: Names) -> tuple[Names, Names]:
    """What is across and up in maps, or across alone where the variable that is shown is up; and the
    dimensions of which a list chooses one value.

    group : variables that have the same dimensions
    wished : dimensions across and up, if they can be
    """
    kinds = {str(dim): kind_of(group[dim]) for dim in group.dims}
    dims = sorted(kinds, key=lambda dim: (kinds[dim], [*wished, dim].index(dim)))
    swept = [name for name in SWEPT if name in group.data_vars]
    axes = [*swept, *dims][:1]
    if not swept and [kinds[dim] for dim in dims[:2]] == [NUMBERS, NUMBERS]:
        return dims[:2], dims[2:]
    return axes, [dim for dim in dims if kinds[dim] != COUNTS and dim not in axes]


def points_chart(group: Dataset, axes: Names, lists: Entries, words: Any, looks: Any) -> Entries:
    """Classes and numbers beside each other, and lists to choose from.

    axes : as from `axes_of`
    lists : labels of what can be chosen: values along a dimension by their index, `classes` and
        `numbers` by their names
    words : of each class
    looks : of all words
    """
    points: Any = alt.Chart(alt.NamedData("points"), width=WIDTH, height=HEIGHT)
    params = [alt.param("pick", value=0), alt.param("words", value=words)]
    for name, labels in lists.items():
        bind = alt.binding_select(options=[*labels], labels=[*labels.values()])
        params.append(alt.param(name, value=next(iter(labels)), bind=bind))
        if name in group.dims:
            points = points.transform_filter(f"datum._{name} == {name}")
    scale = alt.Scale(domain=[x.label for x in looks], range=[x.face for x in looks])
    shown = alt.expr("words[classes]")
    legend = alt.Legend(orient="bottom", columns=2, symbolStrokeColor=GREY, values=shown)
    colours = {
        "classes": alt.Color("shown:N", title=None, scale=scale, legend=legend),
        "numbers": alt.Color("shown:Q", title=None, scale=COLOURS),
    }
    panels = [_panel(points, group, axes, name, colours[name]) for name in colours if name in lists]
    chart = alt.hconcat(*panels).resolve_scale(color="independent").add_params(*params)
    return chart.configure_scale(invalid=NO_VALUE, zero=False).to_dict()


def _panel(points: Any, group: Dataset, axes: Names, name: str, colour: Any) -> Any:
    """The variable that a list names: in colours, and up where there is no other dimension."""
    points = points.transform_calculate(shown=f"datum[{name}]").encode(tooltip="shown:N")
    across = group[axes[0]]
    layers = []
    if len(axes) == 2:
        x = _axis(across, alt.X, "_x0")
        y = _axis(group[axes[1]], alt.Y, "_y0")
        marks = points.encode(x=x, x2="_x1", y=y, y2="_y1").mark_rect(invalid="show")
        ring = marks.mark_rect(filled=False, stroke=BLACK, strokeWidth=2)
    else:
        y = alt.Y(colour.shorthand, title=None)
        marks = points.encode(_axis(across, alt.X, axes[0]), y).mark_circle(
            opacity=1, stroke=GREY, strokeWidth=0.3
        )
        ring = marks.mark_point(size=150, stroke=BLACK)
        kinds = {kind_of(group[dim]) for dim in group.dims}
        if name == "numbers" and NUMBERS in kinds and COUNTS not in kinds:
            layers.append(marks.mark_line(color=GREY))
    layers += [marks.encode(colour), ring.transform_filter("datum.id == pick")]
    return alt.layer(*layers)


def _axis(x: DataArray, channel: Any, field: str) -> Any:
    """The encoding of a place across or up, logarithmic where numbers have equal ratios."""
    if kind_of(x) == WORDS:
        return channel(f"{field}:O", title=label(x), sort=None)
    kind = "log" if is_geometric(x.values) else "linear"
    return channel(f"{field}:Q", title=label(x)).scale(type=kind, nice=False)


def history_chart(motions: Dataset) -> Entries:
    """The histories of the motion that is shown, in the colours of its phases."""
    chart: Any = alt.Chart(alt.NamedData("samples"), width=2 * WIDTH, height=HEIGHT / 3)
    last = motions.sizes["sample"] - 1
    chart = chart.transform_calculate(time=f"datum.length * datum.sample / {last}")
    time = alt.X("time:Q", title="Time (s)")
    phase = alt.Color("phase:N").scale(domain=[*OF_PHASE], range=[*OF_PHASE.values()])
    chart = chart.mark_circle(size=12).encode(time, phase)
    rows = [chart.encode(y=alt.Y(f"{x}:Q", title=label(motions[x]))) for x in HISTORIES]
    return alt.vconcat(*rows).configure_scale(zero=False).to_dict()
