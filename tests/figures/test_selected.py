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


COORDINATES = {
    "mode": ([1, 2], "number of the mode, lowest frequency first"),
    "crossing_number": ([0, 1], "number of the crossing, as the speed rises"),
    "begin": (["at_rest", "sliding"], "start of the motion"),
    "my_shift": ([0.5, 0.75], ""),
}
"""Values of coordinates, and what they are."""


@pytest.mark.parametrize(
    ("name", "phrase"),
    [
        ("mode", "mode 2"),
        ("crossing_number", "crossing 1"),
        ("begin", "sliding"),
        ("my_shift", "my_shift = 0.75"),
    ],
)
def test_every_coordinate_of_a_selection_is_said(name: str, phrase: str) -> None:
    values, words = COORDINATES[name]
    attributes = {"long_name": words} if words else {}
    upward = swept().isel(direction=0, drop=True)
    study = upward.rename(N=name)
    study[name] = (name, values, attributes)
    second = study.isel({name: 1})
    ax = plot_sweep(second)
    assert phrase in title_of(ax)


def test_lines_of_two_selections_are_named_by_what_was_selected() -> None:
    study = swept().sel(N=300)
    ax = plot_sweep(study.sel(direction="up"))
    plot_sweep(study.sel(direction="down"), ax=ax)
    _, names = ax.get_legend_handles_labels()
    assert title_of(ax) == "N = 300 N"
    assert "on the way up" in names
    assert "on the way down" in names


def test_a_selected_value_is_not_called_the_first_of_several() -> None:
    found = dm.sweep(dm.coupled_natural_frequencies, P, k=[1e3, 1e4])
    second = found.isel(value_index=1)
    ax = plot_sweep(second)
    along = ax.get_ylabel().lower()
    assert "frequency" in along
    assert "lowest" not in along


# ---- Values that are equal but for rounding

HEIGHT = 0.1354  # m


@pytest.fixture
def level() -> xr.Dataset:
    """A sweep whose values are equal but for rounding."""
    study = swept()
    random = np.random.default_rng(1)
    noise = random.standard_normal((2, 2, 3))
    heights = HEIGHT * (1 + 1e-14 * noise)
    study["range"] = study["range"].copy(data=heights)
    return study.sel(direction="up")


def assert_wide(low: float, high: float) -> None:
    """A range in millimetres holds the height, and is far wider than rounding."""
    assert low == pytest.approx(135.4, rel=0.6)
    assert low < 135.4 < high
    assert high - low > 0.05 * 135.4


def test_lines_do_not_show_rounding(level: xr.Dataset) -> None:
    ax = plot_sweep(level, lines="")
    low, high = ax.get_ylim()
    assert_wide(low, high)


def test_colours_of_a_map_do_not_show_rounding(level: xr.Dataset) -> None:
    ax = as_map(level)
    [cells] = [*ax.images, *ax.collections]
    low, high = cells.get_clim()
    assert_wide(low, high)
