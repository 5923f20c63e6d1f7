"""Curves of stability as columns of a study."""

from typing import Any

import numpy as np
import pytest

from disc_model.parameters import Parameters
from disc_model.stability import continuation
from disc_model.studies.quantities.stability_curves import StabilityCurves
from disc_model.studies.quantity import Point


@pytest.mark.parametrize(("margin", "wanted"), [(0.0, (180.0, 420.0)), (0.25, (120.0, 480.0))])
def test_curves_may_leave_the_range_of_lines_by_the_margin(
    margin: float, wanted: tuple[float, float], monkeypatch: pytest.MonkeyPatch
) -> None:
    """On either side, by a fraction of the range; the other parameter has its range."""
    asked: list[tuple[Any, ...]] = []

    def neutral_curves(p, bounds, lines, **how):
        asked.append((bounds, lines, how))
        return continuation.NeutralCurves(p, bounds, (), ())

    monkeypatch.setattr(continuation, "neutral_curves", neutral_curves)
    lines = {"start": 180, "stop": 420, "count": 3}
    options = StabilityCurves(x_range=[3, 18], y_lines=lines, margin=margin, points=9, max_step=0.2)
    values, _ = options.compute_point(Point(Parameters(N=1, Omega=1)))
    ((bounds, along, how),) = asked
    assert bounds == {"Omega": (3, 18), "N": pytest.approx(wanted)}
    assert along == [180, 300, 420]
    assert how["points"] == 9
    assert how["longest"] == 0.2
    assert how["max_points"] == 200
    assert how["tol"] == 1e-12
    assert values["n_curves"] == 0
    assert values["n_continuation_failures"] == 0


def test_the_longest_curve_comes_first(plane) -> None:
    """Of the toy's ellipse and fold, in columns as long as the study allows."""
    one = plane.squeeze("normalization")
    lengths = np.isfinite(one["x"]).sum("curve_point").values
    assert lengths[0] >= lengths[1] > 0
    assert one["n_curves"] == (lengths > 0).sum() == 2
