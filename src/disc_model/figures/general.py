"""What heat maps and curves share: any variable of a grid study over any of its dimensions."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated, Any, ClassVar

import numpy as np
import xarray as xr
from pydantic import Field

from disc_model.errors import Fault, suggestion
from disc_model.figures import drawing
from disc_model.figures.drawing import Axes, Figure, ScalarMappable
from disc_model.figures.kind import NORM, Plot
from disc_model.parameters import Parameters
from disc_model.units import Finite, Unit


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
        own = {name: dims[name] for name in variables[self.variable] if name in dims}
        places = self.axes | ({"by": self.by} if self.by is not None else {})
        for place, name in places.items():
            yield from self._wrong_place(place, name, own)
        used = [*places.values()]
        for name in sorted({name for name in used if used.count(name) > 1}):
            place = "y" if self.axes.get("y") == name else "by"
            yield Fault.of((place,), name, "must differ from the other dimensions shown")
        left = {name: values for name, values in own.items() if name not in used}
        for name, value in self.at.items():
            if name not in left:
                rule = f"is no dimension that remains (known: {', '.join(left) or 'none'})"
                yield Fault.of(("at", name), value, rule)
            elif left[name] and not any(_same(value, one) for one in left[name]):
                yield Fault.of(("at", name), value, f"must be one of {_listed(left[name])}")
        for name, values in left.items():
            panels = self.by is None and name == NORM and len(values) <= self.room
            if name not in self.at and len(values) > 1 and not panels:
                yield Fault(("at", name), "", f"is required, or by: {name}; one of {_listed(values)}")

    def _wrong_place(self, place: str, name: str, own: Mapping[str, Sequence[Any]]) -> Iterator[Fault]:
        if name not in own:
            yield Fault.of((place,), name, f"is no dimension of {self.variable}{suggestion(name, own)}")
        elif place == "by":
            if len(own[name]) > self.room:
                yield Fault.of((place,), name, f"has {len(own[name])} values, and there is room for {self.room}")
        elif any(isinstance(value, str | tuple) for value in own[name]):
            yield Fault.of((place,), name, "must be one parameter, and a number")
        elif len(own[name]) == 1:
            yield Fault.of((place,), name, "must have two values or more")


def _same(one: Any, other: Any) -> bool:
    if isinstance(one, str) or isinstance(other, str | tuple):
        return bool(one == other)
    return math.isclose(one, other, rel_tol=1e-12)


def _listed(values: Sequence[Any]) -> str:
    """A few values as messages show them."""
    texts = [str(value) if isinstance(value, str | tuple) else f"{value:g}" for value in values]
    return ", ".join(texts if len(texts) <= 12 else [*texts[:6], "...", texts[-1]])


def remaining(found: xr.DataArray, plot: General) -> str | None:
    """The dimension that is on no axis, if there is one."""
    return next((str(name) for name in found.dims if name not in plot.axes.values()), None)


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
