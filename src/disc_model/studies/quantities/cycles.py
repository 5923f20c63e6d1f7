"""The stick-slip cycle near the static start: its stability, neutral curves in a plane of two parameters,
and Lyapunov exponents of the motion."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated

import numpy as np
from xarray import Dataset

from disc_model.data.variables import message_of
from disc_model.parameters import Parameters
from disc_model.simulation.case import Start
from disc_model.studies.quantity import STATIC, Free, Motion, Row, Values, found, listed, quantity
from disc_model.units import (
    CycleTolerance,
    Finite,
    Positive,
    Seconds,
    Several,
    Share,
    Tolerance,
    Unit,
)

if TYPE_CHECKING:
    from disc_model.simulation.states import State
    from disc_model.stability.continuation import StabilityCurve

EXPONENTS = 2
MOST_CURVES = 24
CYCLE = "The stick-slip cycle, stable or not; without one, the motion from the static start."


def _on_cycle(case: Parameters, *, tol: float) -> State:
    """A state on the cycle, or else the static start."""
    from disc_model.simulation.states import static_start
    from disc_model.stability.cycle import find_cycle

    return find_cycle(case, tol).state or static_start(case)


@quantity(points_per_job=1000, motion=Motion(100, CYCLE, _on_cycle))
def floquet(case: Parameters, *, tol: CycleTolerance = 1e-12) -> Dataset:
    """The stick-slip cycle near the static start and its growth rate, by Floquet multipliers.

    Parameters
    ----------
    tol : tolerance of cycles: relative residual of the return map
    """
    from disc_model.stability.cycle import find_cycle

    cycle = find_cycle(case, tol)
    leading = complex(math.nan, math.nan)
    if cycle.status == "ok":
        leading = cycle.multipliers[0]
    values = {
        "status": cycle.status.value,
        "growth_rate": cycle.growth_rate,
        "period": cycle.period,
        "stick_fraction": cycle.stick_fraction,
        "multiplier_re": leading.real,
        "multiplier_im": leading.imag,
        "sliding_growth_rate": cycle.sliding.growth_rate,
    }
    return found("floquet", values, message_of(cycle))


# ---- Lyapunov exponents


@quantity(points_per_job=60)
def lyapunov_exponents(
    case: Parameters,
    *,
    transient: Seconds,
    duration: Seconds,
    start: Start = STATIC,
    tol: Tolerance = 1e-10,
) -> Dataset:
    """The two largest Lyapunov exponents of the motion across all its events, without the one along it, which
    is zero.

    Parameters
    ----------
    transient : time left out at the beginning
    duration : time over which rates are averaged
    start : start of the motion
    tol : tolerance of simulations: error of event times after a second of motion
    """
    from disc_model.simulation.starts import state_after
    from disc_model.stability.lyapunov import lyapunov_exponents as exponents_of

    result = exponents_of(
        case,
        duration,
        initial_state=state_after(case, start, transient, tol),
        count=EXPONENTS,
        interval=0.05,
        tol=tol,
    )
    values = {
        "status": result.status.value,
        "exponent": result.exponents,
        "exponent_error": result.errors,
        "converged": np.where(np.isfinite(result.exponents), 1 + result.converged, 0),
        "averaging_time": result.duration,
    }
    message = ""
    if not result.status.complete:
        message = result.status.advice
    return found("lyapunov_exponents", values, message, exponent_number=range(EXPONENTS))


# ---- Neutral curves


@quantity(
    own=("x", "y"),
    rules=(
        (lambda o: o.x != o.y, "x and y must differ"),
        (lambda o: o.bounds[0] < o.bounds[1], "bounds={0.bounds} must ascend"),
    ),
)
def neutral_curves(
    case: Parameters,
    *,
    x: Free = "Omega",
    y: Free = "N",
    bounds: Annotated[tuple[Finite, Finite], Unit(of="x")],
    lines: Annotated[Values, Unit(of="y")],
    margin: Share = 0.0,
    points: Several = 31,
    max_step: Positive = 0.1,
    max_points: Several = 200,
    tol: CycleTolerance = 1e-12,
) -> Dataset:
    """Neutral curves and folds of the stick-slip cycle in the plane of two parameters, by continuation.

    Parameters
    ----------
    x : first number of the case that varies
    y : second number of the case that varies
    bounds : least and greatest value of x
    lines : values of y along which cycles are searched for
    margin : fraction of the range of y by which curves may leave it
    points : number of points of the search along each line
    max_step : arclength of the longest step along a curve
    max_points : most points of a curve, in each direction
    tol : tolerance of cycles: relative residual of the return map
    """
    from disc_model.stability.continuation import neutral_curves as curves_of

    beyond = margin * (lines[-1] - lines[0])
    plane = {x: bounds, y: (lines[0] - beyond, lines[-1] + beyond)}
    curves = curves_of(
        case, plane, lines, points=points, max_points=max_points, longest=max_step, tol=tol
    )
    # those beside a stable cycle first, in case there are more than the array holds
    rows = []
    for curve in sorted(curves, key=_importance, reverse=True):
        row = {
            "kind": curve.kind,
            "adjoins_stable_cycle": curve.adjoins_stable_cycle,
            "period": curve.period,
            "x": curve.values[:, 0],
            "y": curve.values[:, 1],
            "multiplier_re": curve.multipliers.real,
            "multiplier_im": curve.multipliers.imag,
        }
        row |= {f"resonance_{name}": value for name, value in curve.resonance._asdict().items()}
        rows.append(row)
    values = {
        "n_curves": len(curves),
        "n_continuation_failures": len(curves.failures),
        **listed(rows),
    }
    own: Row = {"curve": range(MOST_CURVES), "curve_point": range(2 * max_points)}
    return found("neutral_curves", values, **own)


def _importance(curve: StabilityCurve) -> tuple[int, int]:
    """The number of points of a curve beside a stable cycle, and that of all."""
    return int(curve.adjoins_stable_cycle.sum()), len(curve.period)
