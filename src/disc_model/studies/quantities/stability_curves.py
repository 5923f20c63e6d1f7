"""Neutral curves and folds of the stick-slip cycle, by continuation in two parameters."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from pydantic import Field

from disc_model.data.variables import OF_QUANTITIES
from disc_model.studies.quantity import Coordinate, Free, Point, Quantity, Range, listed
from disc_model.units import Count, CycleTolerance, Finite, Positive, Real, Unit

if TYPE_CHECKING:
    from disc_model.stability.continuation import StabilityCurve


class StabilityCurves(Quantity):
    """Neutral curves and folds of the stick-slip cycle in the plane of two parameters."""

    x: Free = "Omega"
    """first number of the case that varies"""
    y: Free = "N"
    """second number of the case that varies"""
    x_range: Annotated[tuple[Finite, Finite], Unit(of="x")]
    """least and greatest value of x"""
    y_lines: Annotated[Range, Unit(of="y")]
    """values of y along which cycles are searched for"""
    margin: Annotated[Real, Field(ge=0, le=1)] = 0.0
    """fraction of the range of y by which curves may leave it"""
    points: Annotated[Count, Field(ge=2, le=10_000)] = 31
    """number of points of the search along each line"""
    max_step: Positive = 0.1
    """arclength of the longest step along a curve"""
    max_points: Annotated[Count, Field(ge=2, le=10_000)] = 200
    """most points of a curve, in each direction"""
    max_curves: Annotated[Count, Field(ge=1, le=1000)] = 24
    """room for that many curves"""
    tol: CycleTolerance = 1e-12
    """tolerance of cycles: relative residual of the return map"""

    _rules = (
        (lambda o: o.x != o.y, "x and y must differ"),
        (lambda o: o.x_range[0] < o.x_range[1], "x_range must ascend"),
    )
    points_per_job: ClassVar = 1
    scans: ClassVar = ("x", "y")
    COLUMNS: ClassVar = OF_QUANTITIES["stability_curves"]["columns"]
    COORDINATES: ClassVar = {
        "curve": Coordinate(lambda o: range(o.max_curves), "max_curves"),
        "curve_point": Coordinate(lambda o: range(2 * o.max_points)),
    }

    def compute_point(self, point: Point) -> tuple[dict[str, Any], str]:
        from disc_model.stability.continuation import neutral_curves

        lines = self.y_lines
        margin = self.margin * (lines.stop - lines.start)
        bounds = {self.x: self.x_range, self.y: (lines.start - margin, lines.stop + margin)}
        curves = neutral_curves(
            point.parameters,
            bounds,
            lines.values,
            points=self.points,
            max_points=self.max_points,
            longest=self.max_step,
            tol=self.tol,
        )
        # those beside a stable cycle first, in case there are more than the array holds
        rows = [_row(curve) for curve in sorted(curves, key=_importance, reverse=True)]
        columns: dict[str, Any] = listed(rows)
        columns["n_curves"] = len(curves)
        columns["n_continuation_failures"] = len(curves.failures)
        columns["status"] = "ok"
        return columns, ""


def _importance(curve: StabilityCurve) -> tuple[int, int]:
    """The number of points of a curve beside a stable cycle, and that of all."""
    return int(curve.adjoins_stable_cycle.sum()), len(curve.period)


def _row(curve: StabilityCurve) -> dict[str, Any]:
    """The columns of a curve."""
    row: dict[str, Any] = {
        "kind": curve.kind,
        "adjoins_stable_cycle": curve.adjoins_stable_cycle,
        "period": curve.period,
        "x": curve.values[:, 0],
        "y": curve.values[:, 1],
        "multiplier_re": curve.multipliers.real,
        "multiplier_im": curve.multipliers.imag,
    }
    for name, value in asdict(curve.resonance).items():
        row[f"resonance_{name}"] = value
    return row
