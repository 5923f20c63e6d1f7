"""Places of what is on a page are found without setting ticks or writing legends again."""

from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot
from matplotlib.axis import Axis

import disc_model as dm
from disc_model.figures import legends, page_legends
from disc_model.figures.legends import legend_below
from disc_model.figures.places import has_settled, set_places, ticks_once
from disc_model.figures.sizes import COLUMN, PAGE


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


def test_a_layout_that_has_settled_is_not_set_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """Places were set a second time after a legend had found its own, where nothing moved."""
    placed: list[Any] = []

    def counted(page: Any) -> None:
        set_places(page)
        placed.append(page)

    monkeypatch.setattr(legends, "set_places", counted)
    figure, ax = pyplot.subplots(figsize=(PAGE, 4.0), layout="constrained")
    ax.plot([0, 1], label="line")
    figure.draw_without_rendering()
    legend_below(ax, ax.lines)
    assert has_settled(figure)
    assert len(placed) == 2, "before and after the legend has its place"


def test_axes_that_become_smaller_have_not_settled() -> None:
    figure, ax = pyplot.subplots(layout="constrained")
    ax.set_ylabel("several\nlines\nof words")
    set_places(figure)
    assert has_settled(figure)
    before = ax.bbox.bounds
    set_places(figure)
    assert ax.bbox.bounds == pytest.approx(before, abs=1e-6)
    ax.legend(ax.plot([0, 1]), ["words"], loc="upper left", bbox_to_anchor=(0, -0.2))
    set_places(figure)
    assert not has_settled(figure)
