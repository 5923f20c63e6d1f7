"""Places of what is on a page are found without setting ticks or writing legends again."""

from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot
from matplotlib.axis import Axis

import disc_model as dm
from disc_model.figures import page_legends
from disc_model.figures.legends import legend_below
from disc_model.figures.places import ticks_once
from disc_model.figures.sizes import COLUMN


def test_ticks_are_set_once_for_each_range_of_an_axis(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each measure of an axis set them anew."""
    update = Axis._update_ticks  # type: ignore[attr-defined]
    updated: list[Axis] = []

    def counted(axis: Axis) -> Any:
        updated.append(axis)
        return update(axis)

    monkeypatch.setattr(Axis, "_update_ticks", counted)
    figure, ax = pyplot.subplots()
    with ticks_once(figure):
        for right in (1.0, 2.0):
            ax.set_xlim(0.0, right)
            with ticks_once(figure):
                ax.xaxis.get_tightbbox()
            ax.xaxis.get_tightbbox()
    assert updated == [ax.xaxis, ax.xaxis]
    ax.xaxis.get_tightbbox()
    assert len(updated) > 2, "as usual afterwards"


@pytest.mark.parametrize(("layout", "times"), [(None, 1), ("constrained", 2)])
def test_a_legend_below_plain_axes_is_written_once(
    layout: Any, times: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It was written twice, though nothing makes these axes lower."""
    written: list[Any] = []

    def counted(*given: Any, **look: Any) -> Any:
        written.append(look)
        return legend_below(*given, **look)

    monkeypatch.setattr(page_legends, "legend_below", counted)
    axes = {"N": [300.0, 400.0], "Omega": [10.0, 12.0, 14.0]}
    words = np.array([["quiet", "separation", "quiet"], ["quiet", "quiet", "separation"]])
    study = xr.Dataset({"outcome": ([*axes], words)}, axes)
    _, ax = pyplot.subplots(figsize=(COLUMN, 2.4), layout=layout)
    dm.plot_sweep(study, "outcome", ax=ax)
    assert len(written) == times
