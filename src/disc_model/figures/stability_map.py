"""Stability maps: outcome of the static start over two parameters, and the growth rate of the stick-slip cycle."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, ClassVar, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from disc_model.data.variables import flag_names
from disc_model.errors import Fault
from disc_model.figures import drawing
from disc_model.figures.cells import CYCLE_LOOKS, OUTCOME_LOOKS, growth_panels, patches, scale_of
from disc_model.figures.drawing import BLACK, BORDERS, MODES, PAGE, PAPER, Artist, Axes, Figure, panels
from disc_model.figures.kind import Plot, Role, Roles, Values
from disc_model.parameters import Parameters
from disc_model.units import Finite, Strict, Units

MARKS: dict[str, dict[str, Any]] = {
    "quiet": {"marker": "o", "facecolor": "white", "s": 9},
    "steady_sliding": {"marker": "o", "facecolor": "#c9b8dc", "s": 9},
    "at_rest": {"marker": "o", "facecolor": "#b9dcc6", "s": 9},
    "other_cycle": {"marker": "v", "facecolor": "white", "s": 13},
    "growing": {"marker": "^", "facecolor": "#9a9a9a", "s": 13},
    "undecided": {"marker": "D", "facecolor": "white", "s": 9},
    "separation": {"marker": "s", "facecolor": BLACK, "s": 10},
    "failed": {"marker": "X", "facecolor": BLACK, "s": 12},
}
"""The mark of each outcome."""


class Mark(Strict):
    """A case of the paper: where it lies, and what the paper says of it."""

    x: Finite
    y: Finite
    paper_outcome: Literal["quiet", "growing", "separation"]


class StabilityMap(Plot):
    """What becomes of the static start over two parameters, one panel for each normalization."""

    quantities = ("outcome",)
    several = True
    named_above = True
    roles: ClassVar[Roles] = {"growth": Role("floquet")}

    kind: Literal["stability_map"] = "stability_map"
    x: str
    y: str
    marks: dict[str, Mark] = Field({})

    @classmethod
    def _units(cls, data: Mapping[str, Any]) -> dict[str, Units]:
        axes = {axis: Parameters.unit(str(data.get(axis))) for axis in ("x", "y")}
        marks = data.get("marks")
        return super()._units(data) | {"marks": dict.fromkeys(marks, axes) if isinstance(marks, dict) else ""}

    def place_title(self, figure: Figure, text: str) -> None:
        """Write it into the legend, which a title of the figure would cover."""
        figure.legends[0].set_title(text)

    def faults(self, values: Values) -> Iterator[Fault]:
        """Faults as of any figure; in addition, each marked case must be a computed point, not between points."""
        yield from super().faults(values)
        for name, mark in self.marks.items():
            for axis, dim, value in (("x", self.x, mark.x), ("y", self.y, mark.y)):
                along = [
                    float(coordinate)
                    for coordinate, *more in values.get(dim, ())
                    if not more and not isinstance(coordinate, str)
                ]
                if along and not any(math.isclose(value, coordinate, rel_tol=1e-12) for coordinate in along):
                    yield Fault.of(("marks", name, axis), value, f"must be a value of {dim}, such as an extra one")

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw one panel per normalization and one mark per point, over the further study ``growth`` if it is given."""
        norms = drawing.normalizations(study)
        figure, axes = panels(PAGE, 3.3, 1, len(norms), sharex=True, sharey=True)
        drawing.letters(axes, [MODES[norm] for norm in norms])
        marks: dict[str, Artist] = {}
        for ax, plane in zip(axes, planes(study, norms, self), strict=True):
            x, y = np.meshgrid(*(plane[name].values * drawing.axis_of(name)[1] for name in (self.x, self.y)))
            outcome = flag_names(plane["outcome"])
            for name, look in MARKS.items():
                if (mask := outcome == name).any():
                    marks[name] = ax.scatter(x[mask], y[mask], zorder=3, clip_on=False, lw=0.5, edgecolor=BLACK, **look)
                    marks[name].set_label(OUTCOME_LOOKS[name].label)
        handles = finish(axes, study, self)
        if "growth" in overlays:
            growth = planes(overlays["growth"], norms, self)
            gaps = growth_panels(figure, axes, growth)
            for ax, plane in zip(axes, growth, strict=True):
                x, y = (plane[name].values * drawing.axis_of(name)[1] for name in (self.x, self.y))
                rate = plane["growth_rate"].values
                # the line on which the growth rate changes its sign
                if min(rate.shape) > 1 and np.isfinite(rate).any() and np.nanmin(rate) < 0 < np.nanmax(rate):
                    ax.contour(x, y, np.ma.masked_invalid(rate), levels=[0.0], colors=BLACK, linewidths=1.0)
            handles = [drawing.sample(**BORDERS["neutral"]), *patches(CYCLE_LOOKS, gaps), *handles]
        legend_above(figure, [*(marks[name] for name in MARKS if name in marks), *handles])
        return figure


def planes(study: xr.Dataset, norms: Sequence[str], plot: StabilityMap) -> list[xr.Dataset]:
    """A study over the two parameters, the vertical one first, for each normalization."""
    return [drawing.of(study, norm).transpose(plot.y, plot.x, ...) for norm in norms]


def finish(axes: Sequence[Axes], study: xr.Dataset, plot: StabilityMap) -> list[Artist]:
    """Scale and label the shared axes, and mark the paper's cases in the first panel, if it has the published modes.

    Returns legend entries, one for each shape among the marks.
    """
    set_scales(axes, study, plot)
    if drawing.normalizations(study)[0] != "as_published":
        return []
    for name, mark in plot.marks.items():
        _paper_mark(axes[0], plot, name, mark)
    outcomes = {mark.paper_outcome for mark in plot.marks.values()}
    ring: dict[str, Any] = {"linestyle": "", "markerfacecolor": "none", "markersize": 6, "markeredgewidth": 1.4}
    ring |= {"markeredgecolor": PAPER, "path_effects": drawing.outline(2.4, BLACK)}
    return [
        drawing.sample(marker=look["marker"], label=f"paper: {OUTCOME_LOOKS[name].label}", **ring)
        for name, look in MARKS.items()
        if name in outcomes
    ]


def _paper_mark(ax: Axes, plot: StabilityMap, name: str, mark: Mark) -> None:
    """Draw a large open mark whose shape is the paper's outcome, and beside it the case's name, towards the middle."""
    point = (mark.x * drawing.axis_of(plot.x)[1], mark.y * drawing.axis_of(plot.y)[1])
    edge: dict[str, Any] = {"edgecolor": PAPER, "linewidth": 1.4, "path_effects": drawing.outline(2.4, BLACK)}
    shape = MARKS[mark.paper_outcome]["marker"]
    ax.scatter(*point, 55.0, marker=shape, facecolor="none", zorder=4, clip_on=False, **edge)
    across, up = (ax.transData + ax.transAxes.inverted()).transform(point)
    offset = (-6 if across > 0.85 else 6, -5 if up > 0.85 else 5)
    drawing.say(ax, name, point, offset, fontsize=7, zorder=5, annotation_clip=False, path_effects=drawing.halo(2.0))


def set_scales(axes: Sequence[Axes], study: xr.Dataset, plot: StabilityMap) -> None:
    """Set limits, labels and scales of shared axes; a logarithmic scale with a 0 is linear up to the second value."""
    from matplotlib.ticker import FixedLocator, NullFormatter, NullLocator

    for which, name in plot.axes.items():
        label, factor = drawing.axis_of(name)
        values = study[name].values * factor
        axis = getattr(axes[0], f"{which}axis")
        if (scale := scale_of(name, values)) != "linear":
            start = {"linthresh": values[1], "linscale": 0.4} if scale == "symlog" else {}
            getattr(axes[0], f"set_{which}scale")(scale, **start)
            ticks = np.outer(10.0 ** np.arange(-9, 13), (1, 2, 5)).ravel()
            ticks = ticks[(ticks >= 0.999 * values[values > 0][0]) & (ticks <= 1.001 * values[-1])]
            axis.set_major_locator(FixedLocator([*[0.0] * (scale == "symlog"), *ticks]))
            axis.set_major_formatter("{x:g}")
            axis.set_minor_formatter(NullFormatter())
            if scale == "symlog":
                axis.set_minor_locator(NullLocator())
        to_axis = axis.get_transform()
        low, high = to_axis.transform(values[[0, -1]])
        margin = 0.02 * (high - low) or 0.02 * abs(high) or 1.0
        axes[0].set(**{f"{which}lim": to_axis.inverted().transform([low - margin, high + margin])})
        for ax in axes:
            ax.set(**{f"{which}label": label})
            ax.label_outer()


def legend_above(figure: Figure, handles: Sequence[Artist]) -> None:
    """Draw a legend over all panels; its title is the figure's."""
    figure.legend(handles=handles, loc="outside upper center", ncols=min(len(handles), 4), title_fontsize=8)
