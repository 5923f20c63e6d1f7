"""What a study file may say about the quantity `stability_curves`."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from disc_model.parameters import Count, Real
from disc_model.studies.faults import Strict
from disc_model.studies.grids.axes import Finite, Range
from disc_model.studies.grids.quantities.options import Positive

Free = Literal["Omega", "N", "D_star", "c", "c_p", "k", "k_p", "E", "m"]


class StabilityCurvesOptions(Strict):
    """Neutral curves and folds of the stick-slip cycle in the plane of two parameters.

    x, y : the parameters
    x_range : from, to; the cycle is looked for at `points` places of it
    y_lines : values of y along which that is done; curves are followed from the first to the last, widened by `margin`
    margin : of the range of y, beyond the lines at both ends
    longest : arclength of the longest step along a curve
    max_points : of a curve, each way from where it was met
    max_curves : room for that many
    """

    x: Free = "Omega"
    y: Free = "N"
    x_range: tuple[Finite, Finite]
    y_lines: Range
    margin: Annotated[Real, Field(ge=0, le=1)] = 0.0
    points: Annotated[Count, Field(ge=2, le=10_000)] = 31
    longest: Positive = 0.1
    max_points: Annotated[Count, Field(ge=2, le=10_000)] = 100
    max_curves: Annotated[Count, Field(ge=1, le=1000)] = 24
    tol: Annotated[Real, Field(ge=1e-14, le=1e-6)] = 1e-12

    @model_validator(mode="after")
    def _plane(self) -> Self:
        if self.x == self.y:
            raise ValueError("x and y must differ")
        if not self.x_range[0] < self.x_range[1]:
            raise ValueError("x_range must ascend")
        return self

    @property
    def scans(self) -> tuple[str, ...]:
        """Parameters varied by the quantity itself."""
        return (self.x, self.y)

    @property
    def bounds(self) -> dict[str, tuple[float, float]]:
        """Of both parameters."""
        low, high = self.y_lines.start, self.y_lines.stop
        wide = self.margin * (high - low)
        return {self.x: self.x_range, self.y: (low - wide, high + wide)}
