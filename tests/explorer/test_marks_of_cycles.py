"""Marks over cells of the explorer's maps."""

import numpy as np
import xarray as xr

from disc_model.explorer.marks import marked_cells
from disc_model.figures.classes import NOT_NEAR


def test_cells_of_a_cycle_that_the_motion_is_not_near_are_marked() -> None:
    """They looked like any other."""
    axes = {"N": [100.0, 200.0, 300.0], "Omega": [10.0, 11.0, 12.0]}
    away = np.full((3, 3), np.nan)
    away[0, 1] = 0.0
    away[2, 2] = 1.0
    data = {
        "status": ([*axes], np.zeros((3, 3), int), {"flag_meanings": "ok failed"}),
        "growth_rate": ([*axes], np.full((3, 3), 0.5)),
        "near_motion": ([*axes], away),
    }
    study = xr.Dataset(data, axes)
    found = {mark.word: mark for mark in marked_cells(study, "growth_rate")}
    mark = found[NOT_NEAR.label]
    assert mark.look is NOT_NEAR
    assert np.argwhere(mark.cells).tolist() == [[0, 1]]
    without = marked_cells(study.drop_vars("near_motion"), "growth_rate")
    assert NOT_NEAR.label not in [mark.word for mark in without]
