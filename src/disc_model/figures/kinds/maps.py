"""Kinds of maps over two parameters, and of charts over speed and preload."""

import math
from collections.abc import Iterator, Mapping
from typing import Any, ClassVar, Literal

from pydantic import Field

from disc_model.errors import Fault
from disc_model.figures.kinds.base import CURVES, Compared, Plot, Role, Roles, Values
from disc_model.parameters import Parameters
from disc_model.units import Finite, Strict, Units


class Mark(Strict):
    """A case of the paper: where it lies, and what the paper says of it.

    assumed : whether the paper does not state where, so that nothing is said of its start
    """

    x: Finite
    y: Finite
    paper_outcome: Literal["quiet", "growing", "separation"]
    assumed: bool = False


class RegionMap(Compared):
    """Regions of outcomes over two parameters, and the growth rate of the cycle below."""

    titled_by_legend = True
    quantities = ("regions",)
    kind: Literal["region_map"] = "region_map"
    x: str
    y: str
    marks: dict[str, Mark] = Field({})

    @property
    def roles(self) -> Roles:  # type: ignore[override]
        return {"curves": CURVES}

    @classmethod
    def _units(cls, data: Mapping[str, Any]) -> dict[str, Units]:
        units = super()._units(data)
        axes: dict[str, Units] = {axis: Parameters.unit(str(data.get(axis))) for axis in ("x", "y")}
        marks = data.get("marks")
        units["marks"] = dict.fromkeys(marks, axes) if isinstance(marks, dict) else ""
        return units

    def faults(self, values: Values) -> Iterator[Fault]:
        yield from super().faults(values)
        for name, mark in self.marks.items():
            for axis, dim, value in (("x", self.x, mark.x), ("y", self.y, mark.y)):
                along = [x for x in values.get(dim, ()) if isinstance(x, float)]
                if along and not any(math.isclose(value, x, rel_tol=1e-12) for x in along):
                    rule = f"must be a value of {dim}, such as an extra one"
                    yield Fault.of(("marks", name, axis), value, rule)
        if "curves" in self.overlays and (self.x, self.y) != ("Omega", "N"):
            rule = "needs x: Omega and y: N"
            yield Fault.of(("overlays", "curves"), self.overlays["curves"], rule)


class SlidingOutcome(Compared):
    """What linear analysis says of steady sliding beside what the motion does, over two
    parameters."""

    quantities = ("regions", "outcome")
    kind: Literal["sliding_outcome"] = "sliding_outcome"
    x: str
    y: str

    @property
    def roles(self) -> Roles:  # type: ignore[override]
        beside = () if self.by == "normalization" else (self.by,)
        return {"sliding": Role("sliding", (self.y, *beside), {"parameter": self.x}, required=True)}


class CriticalSpeed(Plot):
    """Speeds at which separation begins or ends against the preload, for several horizons."""

    needs = ("N",)
    roles: ClassVar[Roles] = {
        "hysteresis": Role("hysteresis"),
        "cycle": Role("regions", ("N", "Omega")),
        "curves": CURVES,
        "basins": Role("basins", ("Omega",)),
    }
    kind: Literal["critical_speed"] = "critical_speed"
    paper_points: dict[str, tuple[Finite, Finite]] = Field({})


class RampedSpeeds(Plot):
    """Where separation begins on the way up and ends on the way down, against the rate of the
    speed's ramps."""

    roles: ClassVar[Roles] = {"curves": CURVES}
    usual = "column"
    kind: Literal["ramps"] = "ramps"
