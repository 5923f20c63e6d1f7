"""Neutral curves and folds of the stick-slip cycle, by continuation in two parameters."""

from dataclasses import asdict
from typing import Any

from disc_model.data.variables import Variable
from disc_model.stability.curves import stability_curves
from disc_model.studies.document import StabilityCurvesOptions
from disc_model.studies.grids.points import STATUS, Coordinate, Point, listed

KINDS = ("none", "neutral", "fold")
SIDES = ("no", "yes")
_ONE, _EACH = ("curve",), ("curve", "curve_point")
COLUMNS = {
    "status": STATUS,
    "n_curves": Variable("1", "number of curves found", whole=True),
    "n_continuation_failures": Variable("1", "number of places at which a curve could not be followed", whole=True),
    "kind": Variable("1", "neutral: a multiplier of modulus one; fold: two cycles meet and vanish", KINDS, dims=_ONE),
    "x": Variable("", "first parameter along the curve, SI units", dims=_EACH),
    "y": Variable("", "second parameter along the curve, SI units", dims=_EACH),
    "adjoins_stable_cycle": Variable("1", "whether the cycle is stable on one side", SIDES, dims=_EACH),
    "period": Variable("s", "period of the cycle on the curve", dims=_EACH),
    "multiplier_re": Variable("1", "real part of the leading multiplier", dims=_EACH),
    "multiplier_im": Variable("1", "imaginary part of the leading multiplier", dims=_EACH),
    "resonance_harmonic": Variable("1", "n of the resonance n f_s = f + s l Omega / 2 pi", dims=_ONE),
    "resonance_frequency": Variable("Hz", "f of that resonance, of a mode at rest", dims=_ONE),
    "resonance_diameters": Variable("1", "l of that resonance", dims=_ONE, whole=True),
    "resonance_sign": Variable("1", "s of that resonance, -1, 0 or 1", dims=_ONE, whole=True),
    "resonance_detuning": Variable("Hz", "how far the cycle at the curve's middle is from that resonance", dims=_ONE),
}
COORDINATES = {
    "curve": Coordinate("1", "number of the curve", lambda o: range(o.max_curves)),
    "curve_point": Coordinate("1", "number of the point along the curve", lambda o: range(2 * o.max_points)),
}


def compute_point(point: Point, options: StabilityCurvesOptions) -> tuple[dict[str, Any], str]:
    """Compute the curves of the plane; the point's own values of its two parameters are not used."""
    lines = options.y_lines
    margin = options.margin * (lines.stop - lines.start)
    curves, notes = stability_curves(
        point.parameters,
        (options.x, options.y),
        {options.x: options.x_range, options.y: (lines.start - margin, lines.stop + margin)},
        lines.values,
        points=options.points,
        max_points=options.max_points,
        longest=options.max_step,
        tol=options.tol,
    )
    # the array holds the longest curve
    rows = [
        {
            "kind": curve.kind,
            "x": curve.values[:, 0],
            "y": curve.values[:, 1],
            "adjoins_stable_cycle": curve.adjoins_stable_cycle,
            "period": curve.period,
            "multiplier_re": curve.multipliers.real,
            "multiplier_im": curve.multipliers.imag,
            **{f"resonance_{name}": value for name, value in asdict(curve.resonance).items()},
        }
        for curve in sorted(curves, key=lambda curve: -len(curve.period))
    ]
    return listed(rows) | {"status": "ok", "n_curves": len(curves), "n_continuation_failures": len(notes)}, ""
