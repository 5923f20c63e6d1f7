"""Kinds that show any variable of any quantity: heat maps and curves."""

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import chain
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field

from disc_model.errors import Fault, as_text, suggestion
from disc_model.figures.kinds.base import NORM, Names, Plot, Values, key_of, unknown
from disc_model.units import UNITS, Finite, Unit

Dims = Mapping[str, Sequence[Any]]
"""Values along the dimensions of one variable."""


Limits = tuple[Finite, Finite]
"""Ends of the scale of a variable, in the unit of its label."""


def _wrong_limits(limits: Limits | None) -> Iterator[Fault]:
    """The fault of limits that do not ascend."""
    if limits is not None and not limits[0] < limits[1]:
        yield Fault.of(("limits",), limits, "must be two ascending values")


class General(Plot):
    """Any variable of any quantity over dimensions of the study, those of the quantity's own
    included.

    at : values along dimensions that are not shown
    by : a dimension with a panel, or a line, for each of its values; normalization if it varies
    log : whether the scale of the variable is logarithmic, on both sides of zero if some values are
        negative or zero
    names : words for values of `by`
    limits : ends of the scale of the variable
    """

    several = True
    room: ClassVar[int] = 6
    """Greatest number of values of `by`."""

    variable: str
    x: str
    at: Annotated[dict[str, Finite | str], Unit(UNITS)] = Field({})
    by: str | None = None
    log: bool = False
    names: Names = Field({})
    limits: Limits | None = None

    def faults_among(
        self, dims: Values, variables: Mapping[str, Sequence[str]], classes: Collection[str] = ()
    ) -> Iterator[Fault]:
        """Faults by the values along each dimension (tuples for a zip, none if it has faults), and
        each variable's dimensions.

        classes : variables that are words, or true or false, and so have no scale
        """
        yield from self.wrong_overlays()
        if self.variable not in variables:
            rule = f"unknown variable{suggestion(self.variable, variables)}"
            yield Fault.of(("variable",), self.variable, rule)
            return
        own = {name: dims[name] for name in variables[self.variable] if name in dims}
        wrong = [*self.wrong_axes(own, self.variable), *self._wrong_by(own)]
        yield from wrong or self._wrong_places(own)  # these rest on what is on axes
        yield from unknown("names", self.names, "by", dims.get(self.by or "", ()))
        if self.variable in classes:
            yield from self._wrong_scales()
        else:
            yield from _wrong_limits(self.limits)

    def _wrong_scales(self) -> Iterator[Fault]:
        """Faults of the scale of a variable that has none."""
        for key in ("log", "limits"):
            value = getattr(self, key)
            if value:
                yield Fault.of((key,), value, f"is for numbers: {self.variable} has classes")

    def _wrong_by(self, own: Dims) -> Iterator[Fault]:
        """Faults of the dimension of panels or lines."""
        if self.by is None:
            return
        count = len(own.get(self.by, ()))
        if self.by not in own or self.by in self.axes.values():
            rule = f"must be another dimension of {self.variable}{suggestion(self.by, own)}"
            yield Fault.of(("by",), self.by, rule)
        elif count > self.room:
            rule = f"has {count} values, and there is room for {self.room}"
            yield Fault.of(("by",), self.by, rule)

    def _wrong_places(self, own: Dims) -> Iterator[Fault]:
        """Values along dimensions that are not shown: none that the study lacks, and one for each
        that varies."""
        shown = {*self.axes.values(), self.by}
        free = {name: values for name, values in own.items() if name not in shown}
        for name, value in self.at.items():
            if name not in free:
                rule = f"is no dimension that remains{suggestion(name, free)}"
                yield Fault.of(("at", name), value, rule)
            elif free[name] and not any(_same(value, known) for known in free[name]):
                yield Fault.of(("at", name), value, f"must be one of {as_text([*free[name]])}")
        for name, values in free.items():
            has_panels = self.by is None and name == NORM and len(values) <= self.room
            if name not in self.at and len(values) > 1 and not has_panels:
                rule = f"is required, or by: {name}; one of {as_text([*values])}"
                yield Fault(("at", name), "", rule)


def _same(value: Any, other: Any) -> bool:
    if isinstance(value, float) and isinstance(other, float):
        return math.isclose(value, other, rel_tol=1e-12)
    return key_of(value) == key_of(other)


class HeatMap(General):
    """A variable in colour over two dimensions; a panel for each value of a third, if wanted.

    limits : ends of the scale of colours, so that figures can be compared, or small differences be
        seen; on both sides of zero the larger one counts for both
    """

    is_map = True
    kind: Literal["heat_map"] = "heat_map"
    y: str


class CurvePlot(General):
    """A variable against one dimension; a line for each value of a second, if wanted.

    limits : ends of the variable's axis, in the unit that it has in the figure, so that figures can be
        compared; the legend says which lines lie outside
    panels : values of `by` in each panel, or a panel for each
    legend : whether lines are named in a legend even where there is room at their ends
    """

    room = 12
    kind: Literal["curve"] = "curve"
    panels: Literal["each"] | tuple[tuple[Finite | str, ...], ...] = ()
    legend: bool = False

    def faults_among(
        self, dims: Values, variables: Mapping[str, Sequence[str]], classes: Collection[str] = ()
    ) -> Iterator[Fault]:
        yield from super().faults_among(dims, variables, classes)
        if self.panels != "each":
            yield from unknown("panels", chain(*self.panels), "by", dims.get(self.by or "", ()))
