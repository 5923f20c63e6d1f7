"""Legends that readers make themselves of pictures without one."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

import disc_model as dm
from disc_model.figures.gap_rows import rows_above
from tests.figures.reading import as_map

SPEEDS = np.array([10.0, 12.0, 14.0, 16.0])  # rad/s
LOADS = [200.0, 385.0]  # N
WORDS = "ok no_cycle separates"
STATUS = {"flag_values": np.arange(3, dtype=np.int8), "flag_meanings": WORDS}
PLANE = ("Omega", "N")


def rates() -> xr.Dataset:
    """Shares of sticking with two reasons why there is none."""
    shares = 1 / SPEEDS[:, None] + 1e-4 * np.array(LOADS)
    status = np.zeros(shares.shape, dtype=np.int8)
    status[1] = 1
    status[2, 0] = 2
    shares[status > 0] = np.nan
    study = xr.Dataset({"stick_fraction": (PLANE, shares), "status": (PLANE, status, STATUS)})
    return study.assign_coords(Omega=SPEEDS, N=LOADS)


def entries(ax: Axes) -> list[str]:
    """The words that a legend of matplotlib finds at axes."""
    return ax.get_legend_handles_labels()[1]


def words_in_legend(ax: Axes) -> list[str]:
    """The words of the legend of a figure."""
    [legend] = ax.figure.legends
    return [text.get_text() for text in legend.get_texts()]


def test_strips_keep_their_words_without_a_legend() -> None:
    """Nothing on the picture told what the marks above the panel stand for."""
    ax = dm.plot_sweep(rates(), "stick_fraction", lines="N", legend=False)
    words = [each.words.get_text() for each in rows_above(ax)]
    assert words == ["no cycle found", "immediate separation"]
    assert entries(ax) == ["Preload N = 200 N", "385 N"]
    assert not ax.figure.legends


def test_classes_of_a_map_are_entries_of_a_legend() -> None:
    """There were none."""
    usual = words_in_legend(as_map(rates(), "stick_fraction"))
    ax = as_map(rates(), "stick_fraction", legend=False)
    assert entries(ax) == usual
    legend = ax.legend()
    patches = [patch for patch in legend.get_patches() if patch.get_hatch()]
    assert len(patches) == len(usual)
