"""Separations in windows of samples, for figures of the paper."""

import numpy as np
import pytest
import xarray as xr

from disc_model.data.variables import PHASES
from workflow.paper.figures.separations import after, first_complete, separations

FLAGS = {"flag_meanings": " ".join(PHASES), "flag_values": [*range(len(PHASES))]}


def window(marks: str) -> xr.Dataset:
    """Samples each 0.1 s from 2 s on, separated where there is an x."""
    apart = PHASES.index("separation")
    slip = PHASES.index("slip")
    codes = np.array([apart if mark == "x" else slip for mark in marks], np.int8)
    time = 2 + 0.1 * np.arange(len(marks))
    return xr.Dataset({"phase": ("time", codes, FLAGS)}, {"time": time})


def test_separations_are_from_their_first_to_their_last_sample() -> None:
    spans = np.array(separations(window("x..xxx..x")))
    np.testing.assert_allclose(spans, [[2.0, 2.0], [2.3, 2.5], [2.8, 2.8]])


@pytest.mark.parametrize(
    ("marks", "span"),
    [
        ("xx..xx.", (2.4, 2.5)),  # the first one began before the window
        ("..xx..xx", (2.2, 2.3)),
        ("xx...xx", None),  # both are cut off
        ("....", None),
    ],
)
def test_a_complete_separation_begins_and_ends_inside(
    marks: str, span: tuple[float, float] | None
) -> None:
    found = first_complete(window(marks))
    if span is None:
        assert found is None
    else:
        assert found == pytest.approx(span)


def test_times_after_a_start_are_in_milliseconds() -> None:
    np.testing.assert_allclose(after(window("..."), 2.05)["time"], [-50, 50, 150])
