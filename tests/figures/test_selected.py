"""What pictures say of a selection of a sweep, and how they draw values that are equal but for
rounding."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes

import disc_model as dm
from disc_model import plot_sweep
from tests.figures.reading import as_map

SPEEDS = np.array([10.0, 11.0, 12.0])
P = dm.Parameters(N=385, Omega=14)


def title_of(ax: Axes) -> str:
    """The title of the figure of a picture."""
    return ax.figure.get_suptitle()


def swept() -> xr.Dataset:
    """A sweep up and down, at two loads."""
    heights = 1e-5 * np.arange(12.0)
    of_range = {"units": "m", "long_name": "range of the slider's height"}
    of_speed = {"units": "rad s-1", "long_name": "speed of the drive point, in the sweep"}
    axes = ("N", "direction", "sweep_Omega")
    return xr.Dataset(
        {"range": (axes, heights.reshape(2, 2, 3), of_range)},
        {
            "N": ("N", [300.0, 301.0], {"units": "N"}),
            "direction": ["up", "down"],
            "sweep_Omega": ("sweep_Omega", SPEEDS, of_speed),
        },
        {"function": "hysteresis", "parameters": P.canonical_json},
    )


# ---- Words of what was selected


@pytest.mark.parametrize(
    ("chosen", "phrases"),
    [
        ({"direction": "up"}, ["on the way up"]),
        ({"direction": "down"}, ["on the way down"]),
        ({"sweep_Omega": 11.0}, ["Ω = 11 rad/s"]),
        ({"direction": "down", "sweep_Omega": 12.0}, ["on the way down", "Ω = 12 rad/s"]),
        ({"N": 301.0, "direction": "up"}, ["N = 301 N", "on the way up"]),
    ],
)
@pytest.mark.parametrize("draw", [plot_sweep, as_map])
def test_a_title_says_what_was_selected(
    chosen: dict[str, Any], phrases: list[str], draw: Callable[..., Axes]
) -> None:
    selected = swept().sel(chosen)
    ax = draw(selected, "range")
    said = title_of(ax).split(", ")
    count = len(phrases)
    assert said[:count] == phrases


def test_lines_of_two_selections_are_named_by_what_was_selected() -> None:
    study = swept().sel(N=300)
    ax = plot_sweep(study.sel(direction="up"))
    plot_sweep(study.sel(direction="down"), ax=ax)
    _, names = ax.get_legend_handles_labels()
    assert title_of(ax) == "N = 300 N"
    assert "on the way up" in names
    assert "on the way down" in names
