"""Heat maps and curves: any variable of a grid study over any of its dimensions."""

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import cycle
from textwrap import fill
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from disc_model.data.variables import EXCLUDED
from disc_model.errors import Fault, suggestion
from disc_model.figures import drawing
from disc_model.figures.cells import CYCLE_LOOKS, edges_of, growth_panels, patches
from disc_model.figures.drawing import BLACK, COLUMN, GREY, PAGE, Axes, Figure, Patch, ScalarMappable, panels
from disc_model.figures.kind import NORM, Plot
from disc_model.parameters import Parameters
from disc_model.units import Finite, Unit

COLOURS = (drawing.BLUE, drawing.ORANGE, drawing.GREEN, drawing.VERMILION, drawing.SKY, drawing.PURPLE, GREY)
"""Colours of the values of a flag."""
HATCH: dict[str, Any] = {"facecolor": "white", "hatch": "//////", "edgecolor": GREY}
"""Look of missing values."""
LINEAR = 0.1
"""Growth rate up to which its scale is linear, 1/s; a greater step leads to another cycle and breaks the line."""
FEW = 12
"""Counts below which each has a colour of its own."""
MARKS = "os^Dv<>"
"""Marks of the lines; they are open, so that lines on top of each other show."""


class General(Plot):
    """Any variable of any quantity over dimensions of the study, those of the quantity's own included.

    at : values at which the dimensions that are not shown are taken; those of one value need none
    by : a dimension with a panel, or a line, for each of its values; normalization if it varies
    log : whether the scale of the variable is logarithmic
    """

    several = True
    room: ClassVar[int] = 4
    """Greatest number of values of `by`."""

    variable: str
    x: str
    at: Annotated[dict[str, Finite | str], Unit({name: Parameters.unit(name) for name in Parameters.model_fields})] = (
        Field({})
    )
    by: str | None = None
    log: bool = False

    def chosen(self, study: xr.Dataset) -> list[str]:
        """Values of all dimensions that the figure takes at one place."""
        shown = drawing.picked(study, self.at)[self.variable]
        alone = [str(name) for name, size in study.sizes.items() if size > 1 and name not in shown.dims]
        return [drawing.coordinate_text(shown, name) for name in alone if name in shown.coords]

    def faults_among(
        self, dims: Mapping[str, Sequence[Any]], variables: Mapping[str, Sequence[str]]
    ) -> Iterator[Fault]:
        """Faults that keep it from being drawn.

        Parameters
        ----------
        dims : values along each dimension, the quantity's own included; tuples for a zip; none if it has faults
        variables : dimensions of each variable
        """
        yield from self._wrong_overlays()
        if self.variable not in variables:
            yield Fault.of(("variable",), self.variable, f"unknown variable{suggestion(self.variable, variables)}")
            return
        dims_of_variable = {name: dims[name] for name in variables[self.variable] if name in dims}
        places = self.axes | ({"by": self.by} if self.by is not None else {})
        for role, name in places.items():
            yield from self._wrong_place(role, name, dims_of_variable)
        used = [*places.values()]
        for name in sorted({name for name in used if used.count(name) > 1}):
            role = "y" if self.axes.get("y") == name else "by"
            yield Fault.of((role,), name, "must differ from the other dimensions shown")
        free_dims = {name: values for name, values in dims_of_variable.items() if name not in used}
        for name, value in self.at.items():
            if name not in free_dims:
                rule = f"is no dimension that remains (known: {', '.join(free_dims) or 'none'})"
                yield Fault.of(("at", name), value, rule)
            elif free_dims[name] and not any(_same(value, known) for known in free_dims[name]):
                yield Fault.of(("at", name), value, f"must be one of {_listed(free_dims[name])}")
        for name, values in free_dims.items():
            panels = self.by is None and name == NORM and len(values) <= self.room
            if name not in self.at and len(values) > 1 and not panels:
                yield Fault(("at", name), "", f"is required, or by: {name}; one of {_listed(values)}")

    def _wrong_place(self, role: str, name: str, dims: Mapping[str, Sequence[Any]]) -> Iterator[Fault]:
        if name not in dims:
            yield Fault.of((role,), name, f"is no dimension of {self.variable}{suggestion(name, dims)}")
        elif role == "by":
            if len(dims[name]) > self.room:
                yield Fault.of((role,), name, f"has {len(dims[name])} values, and there is room for {self.room}")
        elif any(isinstance(value, str | tuple) for value in dims[name]):
            yield Fault.of((role,), name, "must be one parameter, and a number")
        elif len(dims[name]) == 1:
            yield Fault.of((role,), name, "must have two values or more")


def _same(value: Any, other: Any) -> bool:
    if isinstance(value, str) or isinstance(other, str | tuple):
        return bool(value == other)
    return math.isclose(value, other, rel_tol=1e-12)


def _listed(values: Sequence[Any]) -> str:
    """A few values as messages show them."""
    texts = [str(value) if isinstance(value, str | tuple) else f"{value:g}" for value in values]
    return ", ".join(texts if len(texts) <= 12 else [*texts[:6], "...", texts[-1]])


def remaining(variable: xr.DataArray, plot: General) -> str | None:
    """The dimension that is on no axis, if there is one."""
    return next((str(name) for name in variable.dims if name not in plot.axes.values()), None)


def scale(name: str, values: np.ndarray) -> str:
    """Scale of an axis: that of the range of its values."""
    steps = np.diff(np.log(values)) if values[0] > 0 else values
    return "log" if len(values) > 2 and values[0] > 0 and np.allclose(steps, steps[0], rtol=1e-6) else "linear"


def in_steps(colours: Sequence[Any]) -> dict[str, Any]:
    """Colour map and scale for matplotlib: a colour for each of the numbers 0, 1, ..."""
    from matplotlib.colors import from_levels_and_colors

    cmap, norm = from_levels_and_colors((np.arange(len(colours) + 1) - 0.5).tolist(), colours)
    return {"cmap": cmap, "norm": norm}


def colour_bar(
    figure: Figure, axes: Sequence[Axes], colours: ScalarMappable, label: str, names: Sequence[str] = ()
) -> None:
    """Draw a scale of colours beside panels, with the names of its steps."""
    bar = figure.colorbar(colours, ax=list(axes), pad=0.01, aspect=30, label=label)
    if names:
        bar.set_ticks(range(len(names)), labels=list(names))
        bar.minorticks_off()


class HeatMap(General):
    """A variable in colour over two dimensions; a panel for each value of a third, if wanted."""

    kind: Literal["heat_map"] = "heat_map"
    y: str

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw panels with a common colour scale; missing values are hatched.

        Growth rates have the colours of all growth maps; variables of both signs are centred on 0.
        """
        from cmcrameri import cm
        from matplotlib.colors import ListedColormap
        from matplotlib.patches import Patch

        study = drawing.picked(study, self.at)
        ruled = EXCLUDED in study["status"].attrs["flag_meanings"]
        left_out = drawing.statuses(study) == EXCLUDED
        variable = study[self.variable].where(~left_out) if ruled else study[self.variable]
        by = remaining(variable, self)
        shown = drawing.slices(variable, by)
        figure, axes = panels(PAGE if len(shown) > 1 else COLUMN * 1.2, 2.9, 1, len(shown), sharex=True, sharey=True)
        handles: list[Patch] = []
        if self.variable == "growth_rate" and not self.log:
            handles = _growth(figure, axes, study, self, by)
        else:
            words, colours = drawing.flags_of(variable), _colours(variable, self)
            if variable.dtype.kind == "i" and not words and variable.max() < FEW:  # a count
                words = [str(count) for count in range(int(variable.max()) + 1)]
                colours = in_steps([cm.batlow(i / len(words)) for i in range(len(words))])
            for ax, (_, panel) in zip(axes, shown, strict=True):
                ax.patch.set(linewidth=0, **HATCH)
                mesh = _cells(ax, panel, self, **colours)
            if ruled:
                for ax, (_, panel) in zip(axes, drawing.slices(left_out, by), strict=False):
                    _cells(ax, panel.where(panel), self, cmap=ListedColormap(["white"]))
                handles += patches(CYCLE_LOOKS, {EXCLUDED})
            colour_bar(figure, axes, mesh, drawing.label_of(variable)[0], words)
            if not words and (gaps := drawing.gaps(study, variable)):
                handles.append(Patch(label=", ".join(gaps), **HATCH))
        for axis, name in self.axes.items():  # axes are shared
            axes[0].set(**{f"{axis}scale": scale(name, study[name].values)})
        width = round(figure.get_figwidth() / len(axes) / 0.08)
        # a value stays on the line of its name
        names = [
            fill(f"({letter}) " + text.replace(" = ", "\u00a0=\u00a0"), width)
            for letter, (text, _) in zip("abcd", shown, strict=False)
        ]
        for ax, name in zip(axes, names, strict=True):
            ax.set_title(name if len(axes) > 1 else "", loc="left")
            ax.set(xlabel=drawing.label_of(variable[self.x])[0], ylabel=drawing.label_of(variable[self.y])[0])
            ax.label_outer()
        if handles:
            figure.legend(handles=handles, loc="outside lower right", ncols=len(handles))
        return figure


def _growth(figure: Figure, axes: Sequence[Axes], study: xr.Dataset, plot: HeatMap, by: str | None) -> list[Patch]:
    """Draw growth rates, or the status without a cycle, as in all growth maps."""
    names = [name for name in ("growth_rate", "cycle", "status", "sliding_growth_rate") if name in study]
    shown = [plane.transpose(plot.y, plot.x) for _, plane in drawing.slices(study[names], by)]
    return patches(CYCLE_LOOKS, growth_panels(figure, axes, shown))


def _cells(ax: Axes, panel: xr.DataArray, plot: HeatMap, **colours: Any) -> ScalarMappable:
    """Draw the values of a panel in colour, where there are any."""
    from matplotlib.colors import LogNorm

    plane = panel.transpose(plot.y, plot.x)
    values = np.ma.masked_invalid(plane.values.astype(float))
    if isinstance(colours.get("norm"), LogNorm):
        values = np.ma.masked_where(values <= 0, values)
    return ax.pcolormesh(*edges_of(plane, scale), values, rasterized=True, **colours)


def _colours(variable: xr.DataArray, plot: HeatMap) -> dict[str, Any]:
    """Colour map and scale for matplotlib."""
    from cmcrameri import cm
    from matplotlib.colors import LogNorm, Normalize

    if words := drawing.flags_of(variable):
        return in_steps([COLOURS[i % len(COLOURS)] for i in range(len(words))])
    values = variable.values[np.isfinite(variable.values)]
    if plot.log:
        above = values[values > 0]
        low, high = (above.min(), above.max()) if above.size else (1.0, 10.0)
        return {"cmap": cm.batlow, "norm": LogNorm(low, high if high > low else 10 * low)}
    low, high = (float(values.min()), float(values.max())) if values.size else (0.0, 1.0)
    if low < 0 < high:
        most = max(-low, high)
        return {"cmap": cm.vik, "norm": Normalize(-most, most)}
    return {"cmap": cm.batlow, "norm": Normalize(low, high)}


class CurvePlot(General):
    """A variable against one dimension; a line for each value of a second, if wanted.

    limits : ends of the variable's axis, so that figures can be compared
    """

    room = 12

    kind: Literal["curve"] = "curve"
    limits: tuple[Finite, Finite] | None = None

    def draw(self, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
        """Draw a line, or one for each value of a second dimension; marks at the axis stand for missing values.

        A second dimension of numbers has a colour scale, one of words or pairs a legend.
        """
        from cmcrameri import cm
        from matplotlib.cm import ScalarMappable

        study = drawing.picked(study, self.at)
        variable = study[self.variable]
        by = remaining(variable, self)
        lines = drawing.slices(variable, by)
        numbers = variable[by] if by in variable.coords and variable[by].dtype.kind in "fi" else None
        figure, [ax] = panels(COLUMN, 2.9)
        label, factor = drawing.label_of(variable[self.x])
        along = variable[self.x].values * factor
        words = drawing.flags_of(variable)
        colours = [cm.batlow(i / len(lines)) for i in range(len(lines))] if by else [BLACK]
        jump = np.inf if self.log or self.variable != "growth_rate" else LINEAR
        for colour, (text, line), mark in zip(colours, lines, cycle(MARKS), strict=False):
            name = text if numbers is None else ""
            x, y = drawing.broken(along, line.values, jump)
            ax.plot(
                x, y, mark + "-" * (not words), color=colour, label=name or None,
                markersize=3, markerfacecolor="none", markeredgewidth=0.6, linewidth=0.7,
            )  # fmt: skip
        if self.limits is not None:
            ax.set_ylim(self.limits)
        if self.log:
            ax.set_yscale("log")
        elif self.variable == "growth_rate":  # peaks of tens occur beside hundredths
            ax.set_yscale("symlog", linthresh=LINEAR)
            ax.yaxis.set_major_formatter("{x:g}")
            ax.axhline(0, color=GREY, linewidth=0.6, zorder=0)
        ax.set_xscale(scale(self.x, along))
        ax.margins(0.03)
        ax.set(xlabel=label, ylabel=fill(drawing.label_of(variable)[0], 32))
        if words:
            ax.set_yticks(range(len(words)), labels=words)
        for (name, gone), mark in zip(drawing.gaps(study, variable).items(), "x+|12", strict=False):
            mask = gone.any([dim for dim in gone.dims if dim != self.x]).values
            drawing.mark_failed(ax, along[mask], name=name, mark=mark)
        if numbers is not None:
            label, factor = drawing.label_of(numbers)
            steps = ScalarMappable(**in_steps(colours))
            colour_bar(figure, [ax], steps, label, [f"{value * factor:g}" for value in numbers.values])
        if ax.get_legend_handles_labels()[0]:
            # names of more letters do not fit there
            beside = by is not None and numbers is None and max(len(text) for text, _ in lines) < 25
            figure.legend(
                loc="outside right upper" if beside else "outside lower right", ncols=1 if beside or by else 2
            )
        return figure
