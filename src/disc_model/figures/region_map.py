"""Maps of regions: outcomes over two parameters as cells, and below them the growth rates of the cycle."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, ClassVar, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from disc_model.data.variables import flag_names, stated_in
from disc_model.errors import Fault
from disc_model.figures import drawing, maps
from disc_model.figures.drawing import BLACK, BORDERS, MODES, PAGE, PAPER, Artist, Axes, Figure, mpl, panels
from disc_model.figures.kind import CURVES, Plot, Roles, Values
from disc_model.figures.maps import OUTCOME_LOOKS, curves_of, draw_curves, growth_panels, parted, patches
from disc_model.parameters import Parameters
from disc_model.units import Finite, Strict, Units

PAPER_MARKERS = {"quiet": "o", "growing": "^", "separation": "s"}  # the marker of each outcome of the paper


class Mark(Strict):
    """A case of the paper: where it lies, and what the paper says of it."""

    x: Finite
    y: Finite
    paper_outcome: Literal["quiet", "growing", "separation"]
    assumed: bool = False  # whether the paper does not state where, so that nothing is said of its start


class RegionMap(Plot):
    """Regions of outcomes over two parameters, and the growth rate of the cycle below."""

    quantities = ("regions",)
    several = True
    named_above = True
    roles: ClassVar[Roles] = {"curves": CURVES}
    kind: Literal["region_map"] = "region_map"
    x: str
    y: str
    marks: dict[str, Mark] = Field({})

    @classmethod
    def _units(cls, data: Mapping[str, Any]) -> dict[str, Units]:
        axes = {axis: Parameters.unit(str(data.get(axis))) for axis in ("x", "y")}
        marks = data.get("marks")
        return super()._units(data) | {"marks": dict.fromkeys(marks, axes) if isinstance(marks, dict) else ""}

    def place_title(self, figure: Figure, text: str) -> None:
        figure.legends[0].set_title(text)

    def faults(self, values: Values) -> Iterator[Fault]:
        yield from super().faults(values)
        for name, mark in self.marks.items():
            for axis, dim, value in (("x", self.x, mark.x), ("y", self.y, mark.y)):
                along = [float(x) for x, *more in values.get(dim, ()) if not more and not isinstance(x, str)]
                if along and not any(math.isclose(value, x, rel_tol=1e-12) for x in along):
                    yield Fault.of(("marks", name, axis), value, f"must be a value of {dim}, such as an extra one")
        if "curves" in self.overlays and (self.x, self.y) != ("Omega", "N"):
            yield Fault.of(("overlays", "curves"), self.overlays["curves"], "needs x: Omega and y: N")

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw two panels for each normalization; lines are those of the study ``curves``, or lie between cells."""
        norms = drawing.normalizations(study)
        shown = [drawing.of(study, norm).transpose(self.y, self.x, ...) for norm in norms]
        figure, axes = panels(PAGE, 5.6, 2, len(norms), sharex=True, sharey=True)
        above, below = axes[: len(norms)], axes[len(norms) :]
        drawing.letters(axes, [MODES[norm] for norm in norms])
        gaps = growth_panels(figure, below, shown) - {"alone"}
        # branches are continued along the study's first dimension, which may be either axis
        upward = [name for name in study["outcome"].dims if name in (self.x, self.y)] == [self.y, self.x]
        outcomes: set[str] = set()
        lines: list[Artist] = []
        for upper, lower, plane in zip(above, below, shown, strict=True):
            outcomes |= maps.outcome_cells(upper, plane["outcome"])
            for ax in (upper, lower):
                lines += _curves(ax, plane, overlays["curves"]) if "curves" in overlays else _borders(ax, plane, upward)
        _set_scales(axes, study, self.axes)
        named = {line.get_label(): line for line in lines}.values()
        marks = _marks(axes[0], self) if norms[0] == "as_published" else []
        handles = [*patches(maps.CELL_LOOKS, outcomes), *named, *marks]
        figure.legend(handles=handles, loc="outside upper center", ncols=min(len(handles), 4), title_fontsize=8)
        without, said = patches(maps.CYCLE_LOOKS, gaps), "\n".join(_captions(study, self))
        figure.legend(handles=without, loc="outside lower center", ncols=max(len(without), 1), title=said)
        return figure


def _curves(ax: Axes, data: xr.Dataset, curves: xr.Dataset) -> list[Artist]:
    """Draw continued curves of the map's cycle, within its points."""
    paths = []
    for curve in parted(curves_of(drawing.of(curves, drawing.normalizations(data)[0])), data)[0]:
        along = ((curve.Omega, data["Omega"].values), (curve.N, data["N"].values))
        inside = [values == np.clip(values, points.min(), points.max()) for values, points in along]
        paths.append(curve._replace(N=np.where(np.all(inside, axis=0), curve.N, np.nan), label=""))
    return draw_curves(ax, paths)


def _borders(ax: Axes, data: xr.Dataset, upward: bool) -> list[Artist]:
    """Draw borders between cells, but not around unresolved ones: where the same cycle changes its stability, and where
    a stable one ends, because the next cell has no cycle and does not stay quiet. A start that follows no cycle, or
    another one, does not prove an end. Upward: the study's first dimension is the vertical one."""
    x, y = maps.edges_of(data["outcome"])
    state = maps.stability_of(data)
    state[maps.unresolved(state)] = "unresolved"
    stable, unstable = state == "stable", state == "unstable"
    gone = (flag_names(data["cycle"]) == "no_cycle") & (flag_names(data["outcome"]) != "quiet")
    names = ("branch_continues_first", "branch_continues_second")
    up, right = names if upward else names[::-1]
    segments: dict[str, list[list[tuple[float, float]]]] = {"neutral": [], "fold": []}
    for joined, ahead, current, ends in (
        (up, np.s_[1:, :], np.s_[:-1, :], lambda i, j: [(x[j], y[i + 1]), (x[j + 1], y[i + 1])]),
        (right, np.s_[:, 1:], np.s_[:, :-1], lambda i, j: [(x[j + 1], y[i]), (x[j + 1], y[i + 1])]),
    ):
        same = flag_names(data[joined])[current] == "yes"
        changes = (stable[current] & unstable[ahead]) | (unstable[current] & stable[ahead])
        stops = (stable[current] & gone[ahead]) | (gone[current] & stable[ahead])
        segments["neutral"] += [ends(i, j) for i, j in np.argwhere(changes & same)]
        segments["fold"] += [ends(i, j) for i, j in np.argwhere(stops)]
    for kind, lines in segments.items():
        capstyle = "projecting" if kind == "neutral" else None
        ax.add_collection(mpl.collections.LineCollection(lines, capstyle=capstyle, **BORDERS[kind]))
    return [drawing.sample(**BORDERS[kind]) for kind, lines in segments.items() if lines]


def _captions(study: xr.Dataset, plot: RegionMap) -> Iterator[str]:
    """The horizon, and disagreements between paper, start and cycle."""
    horizon = stated_in(study, "options")["horizon"]
    yield f"Within {horizon:g} s of the static start."
    published = "as_published" in drawing.normalizations(study)
    for name, mark in plot.marks.items() if published else ():
        if mark.assumed:
            continue
        data = drawing.of(study, "as_published")
        point = data.sel({plot.x: mark.x, plot.y: mark.y}, method="nearest")
        outcome, rate = str(flag_names(point["outcome"])), float(point["growth_rate"])
        label, of_paper = OUTCOME_LOOKS[outcome].label, OUTCOME_LOOKS[mark.paper_outcome].label
        if label != of_paper:
            still = f"still growing at {horizon:g} s" if outcome == "growing" else label
            yield f"{name}: paper: “{of_paper}”, static start: {still}."
        if (outcome == "quiet") != (rate < 0) and np.isfinite(rate):
            kind = "stable" if rate < 0 else "unstable"
            why = "another motion is reached" if rate < 0 else "its growth is not seen within the horizon"
            yield f"{name}: {label}, beside a cycle that is {kind} ({rate:.2g}/s): {why}."


def _marks(ax: Axes, plot: RegionMap) -> list[Artist]:
    """Mark the paper's cases: a large open mark whose shape is the paper's outcome, and beside it the case's name,
    towards the middle. Returns legend entries, one for each shape among the marks."""
    edge: dict[str, Any] = {"edgecolor": PAPER, "linewidth": 1.4, "path_effects": drawing.halo(2.4, BLACK)}
    look: dict[str, Any] = {"fontsize": 7, "zorder": 5, "annotation_clip": False, "path_effects": drawing.halo(2.0)}
    outcomes = {mark.paper_outcome for mark in plot.marks.values()}
    for name, mark in plot.marks.items():
        point = (mark.x * drawing.axis_of(plot.x)[1], mark.y * drawing.axis_of(plot.y)[1])
        shape = PAPER_MARKERS[mark.paper_outcome]
        ax.scatter(*point, 55.0, marker=shape, facecolor="none", zorder=4, clip_on=False, **edge)
        across, up = (ax.transData + ax.transAxes.inverted()).transform(point)
        drawing.say(ax, name, point, (-6 if across > 0.85 else 6, -5 if up > 0.85 else 5), **look)
    ring: dict[str, Any] = {"linestyle": "", "markerfacecolor": "none", "markersize": 6, "markeredgewidth": 1.4}
    ring |= {"markeredgecolor": PAPER, "path_effects": edge["path_effects"]}
    said = [(f"paper: {OUTCOME_LOOKS[name].label}", shape) for name, shape in PAPER_MARKERS.items() if name in outcomes]
    return [drawing.sample(marker=shape, label=label, **ring) for label, shape in said]


def _set_scales(axes: Sequence[Axes], study: xr.Dataset, names: Mapping[str, str]) -> None:
    """Set limits, labels and scales of shared axes; a logarithmic scale with a 0 is linear up to the second value."""
    for which, name in names.items():
        label, factor = drawing.axis_of(name)
        values = study[name].values * factor
        axis = getattr(axes[0], f"{which}axis")
        if (scale := maps.scale_of(name, values)) != "linear":
            start = {"linthresh": values[1], "linscale": 0.4} if scale == "symlog" else {}
            getattr(axes[0], f"set_{which}scale")(scale, **start)
            ticks = [x for x in drawing.DECADES if 0.999 * values[values > 0][0] <= x <= 1.001 * values[-1]]
            axis.set_major_locator(mpl.ticker.FixedLocator([0.0] * (scale == "symlog") + ticks))
            axis.set_major_formatter("{x:g}")
            axis.set_minor_formatter(mpl.ticker.NullFormatter())
            if scale == "symlog":
                axis.set_minor_locator(mpl.ticker.NullLocator())
        to_axis = axis.get_transform()
        low, high = to_axis.transform(values[[0, -1]])
        margin = 0.02 * (high - low) or 0.02 * abs(high) or 1.0
        axes[0].set(**{f"{which}lim": to_axis.inverted().transform([low - margin, high + margin])})
        for ax in axes:
            ax.set(**{f"{which}label": label})
            ax.label_outer()
