"""Neutral curves and folds of the stick-slip cycle, by continuation in two parameters."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from pydantic import Field

from disc_model.data.variables import Variable
from disc_model.studies.quantity import (
    STATUS,
    Coordinate,
    Free,
    Point,
    Quantity,
    Range,
    along,
    listed,
)
from disc_model.units import Count, CycleTolerance, Finite, Positive, Real, Unit

if TYPE_CHECKING:
    from disc_model.stability.curves import StabilityCurve

KINDS = ("none", "neutral", "fold")
SIDES = ("no", "yes")
_one = along("curve")
_each = along("curve", "curve_point")


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
    COLUMNS: ClassVar = {
        "status": STATUS,
        "n_curves": Variable("1", "number of curves found", whole=True),
        "n_continuation_failures": Variable(
            "1", "number of places at which a curve could not be followed", whole=True
        ),
        "kind": _one(
            "1", "neutral: a multiplier of modulus one; fold: two cycles meet and vanish", KINDS
        ),
        "x": _each("", "first parameter along the curve, SI units"),
        "y": _each("", "second parameter along the curve, SI units"),
        "adjoins_stable_cycle": _each("1", "whether the cycle is stable on one side", SIDES),
        "period": _each("s", "period of the cycle on the curve"),
        "multiplier_re": _each("1", "real part of the leading multiplier"),
        "multiplier_im": _each("1", "imaginary part of the leading multiplier"),
        "resonance_harmonic": _one("1", "n of the resonance n f_s = f + s l Omega / 2 pi"),
        "resonance_frequency": _one("Hz", "f of that resonance, of a mode at rest"),
        "resonance_diameters": _one("1", "l of that resonance", whole=True),
        "resonance_sign": _one("1", "s of that resonance, -1, 0 or 1", whole=True),
        "resonance_detuning": _one(
            "Hz", "how far the cycle at the curve's middle is from that resonance"
        ),
    }
    COORDINATES: ClassVar = {
        "curve": Coordinate(
            "1", "number of the curve", lambda o: range(o.max_curves), "max_curves"
        ),
        "curve_point": Coordinate(
            "1", "number of the point along the curve", lambda o: range(2 * o.max_points)
        ),
    }

    def compute_point(self, point: Point) -> tuple[dict[str, Any], str]:
        from disc_model.stability.curves import neutral_curves

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
