"""Measurements beside what a fitted case computes of them, in percent and in standard deviations."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from matplotlib import pyplot

from disc_model.figures.fit import plot_fit
from disc_model.fitting.result import Fitted

FRICTION = Fitted(0.419988, 0.00055, 0.4189, 0.4211)
STIFFNESS = Fitted(19000.7, 21.0, 18959.5, 19041.9)


def made_up(**changes: Any) -> Any:
    """Three measurements: one exceeded by 10 %, one of which 4 standard deviations are missing, and
    one of zero, of which there is no percentage."""
    measurements = [
        SimpleNamespace(quantity="first", at={}, value=200.0, uncertainty=4.0),
        SimpleNamespace(quantity="second", at={}, value=-50.0, uncertainty=2.0),
        SimpleNamespace(quantity="third", at={}, value=0.0, uncertainty=0.5),
    ]
    computed = np.array([220.0, -58.0, 0.25])
    fit = {"measurements": measurements, "computed": computed, "chi_squared": 41.25}
    fit |= {"parameters": {"mu_s": FRICTION, "k_p": STIFFNESS}, "limits": {}, "at_bounds": {}}
    fit |= {
        "doubt": "",
        "gap": None,
        "converged": True,
        "misses": False,
        "share_text": "0.07 % of fits of the right model are this bad",
        "confidence": 0.95,
    }
    fit |= {"indistinct": (), "determined": {}, "unpredicted": {}, "outside": {}, "reached": ()}
    fit |= {"freedom": 1, "deviations": np.array([5.0, -4.0, 0.5])}
    return SimpleNamespace(**{**fit, **changes})


@pytest.fixture
def panels() -> Any:
    yield plot_fit(made_up())
    pyplot.close("all")


def computed_of(ax: Any) -> tuple[list[float], list[float]]:
    [line] = [line for line in ax.lines if line.get_marker() == "D"]
    return line.get_xdata().tolist(), line.get_ydata().tolist()


def test_differences_are_in_percent_of_what_was_measured(panels: Any) -> None:
    left, _ = panels
    shift, rows = computed_of(left)
    assert shift == pytest.approx([10.0, -16.0])
    assert rows == [2, 1], "the first on top"
    [bars] = left.containers
    segments = bars[2][0].get_segments()
    half = [segment[1, 0] for segment in segments]
    assert half == pytest.approx([2.0, 4.0])
    [said] = left.texts
    assert (said.get_text(), said.get_position()[1]) == ("measured 0, which has no %", 0)
    assert [text.get_text() for text in left.get_yticklabels()] == ["first", "second", "third"]
    assert left.get_xlabel() == "Difference from the measured value (%)"


def test_deviations_are_in_standard_deviations_of_which_two_are_expected(panels: Any) -> None:
    _, right = panels
    deviations, rows = computed_of(right)
    assert deviations == [5.0, -4.0, 0.5]
    assert rows == [2, 1, 0]
    assert right.get_xlim() == pytest.approx((-5.5, 5.5))
    [band] = right.patches
    assert (band.get_x(), band.get_x() + band.get_width()) == (-2.0, 2.0)
    assert right.get_title(loc="left") == "chi squared 41.2, 1 degree of freedom"
    assert right.get_xlabel() == "Deviation (standard deviations)"
