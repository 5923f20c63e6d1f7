"""Lines of critical speeds, which jump from one range of separation to another one."""

import numpy as np
import xarray as xr

import disc_model as dm
from disc_model.explorer.curves import open_along
from disc_model.figures.rate_scale import ANOTHER_RANGE
from tests.explorer.test_page import flagged

LOADS = [200.0, 220.0, 240.0, 260.0]  # N
BEGINS, ENDS = 0, 1


def scan() -> xr.Dataset:
    """Two ranges of separation: one begins at 12 rad/s from 240 N on, and the other near 20."""
    nothing = np.nan
    crossings = np.array(
        [[20.0, nothing, nothing], [19.6, nothing, nothing], [12.0, 13.0, 19.2], [12.2, 13.2, 18.8]]
    )
    kinds = np.tile(np.array([BEGINS, ENDS, BEGINS], np.int8), (len(LOADS), 1))
    units = {"units": "rad s-1", "long_name": "critical speed"}
    data = {
        "status": ("N", np.zeros(len(LOADS), np.int8), flagged("ok failed")),
        "critical_speed": ("N", crossings[:, 0], units),
        "crossing": (("N", "crossing_number"), crossings, units),
        "crossing_kind": (("N", "crossing_number"), kinds, flagged("begins ends")),
    }
    return xr.Dataset(data, {"N": ("N", LOADS, {"units": "N"})}, {"quantity": "critical_speed"})


def test_a_line_is_open_between_two_ranges_of_separation() -> None:
    """One line joined them in the explorer and in curves, unlike the chart over speed and load."""
    study = scan()
    assert open_along(study, "critical_speed")["N"].tolist() == [False, True, False, False]
    ax = dm.plot_sweep(study, "critical_speed", x="N")
    [line] = [line for line in ax.lines if len(line.get_xdata()) > len(LOADS)]
    heights = np.asarray(line.get_ydata(), dtype=float)
    np.testing.assert_array_equal(heights, [20.0, 19.6, np.nan, 12.0, 12.2])
    assert any(ANOTHER_RANGE in text.get_text() for text in ax.texts)
