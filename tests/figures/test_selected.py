"""What pictures say of a selection of a sweep, and how they draw values that are equal but for
rounding."""

from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot as plt

import disc_model as dm
from disc_model.studies.sweeps import sweep

SPEEDS = np.array([10.0, 11.0, 12.0])
P = dm.Parameters(N=385, Omega=14)


def swept(count: int = 2) -> xr.Dataset:
    """A sweep up and down, of several loads."""
    shape = (count, 2, SPEEDS.size)
    heights = 1e-5 * np.arange(np.prod(shape)).reshape(shape)
    words = {"units": "m", "long_name": "range of the slider's height"}
    speed = {"units": "rad s-1", "long_name": "speed of the drive point, in the sweep"}
    return xr.Dataset(
        {"range": (("N", "direction", "sweep_Omega"), heights, words)},
        {
            "N": ("N", 300.0 + np.arange(count), {"units": "N"}),
            "direction": ["up", "down"],
            "sweep_Omega": ("sweep_Omega", SPEEDS, speed),
        },
        {"function": "hysteresis", "parameters": P.canonical_json},
    )


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
@pytest.mark.parametrize("lines", ["", False])
def test_a_title_says_what_was_selected(
    chosen: dict[str, Any], phrases: list[str], lines: Any
) -> None:
    ax = dm.plot_sweep(swept().sel(chosen), lines=lines)
    title = ax.figure.get_suptitle()
    assert title.split(", ")[: len(phrases)] == phrases
    plt.close(ax.figure)


@pytest.mark.parametrize(
    ("name", "values", "words", "phrase"),
    [
        ("mode", [1, 2], "number of the mode, lowest frequency first", "mode 2"),
        ("crossing_number", [0, 1], "number of the crossing, as the speed rises", "crossing 1"),
        ("begin", ["at_rest", "sliding"], "start of the motion", "sliding"),
        ("my_shift", [0.5, 0.75], "", "my_shift = 0.75"),
    ],
)
def test_every_coordinate_of_a_selection_is_said(
    name: str, values: list[Any], words: str, phrase: str
) -> None:
    coordinate = xr.DataArray(values, dims=name)
    if words:
        coordinate.attrs["long_name"] = words
    study = swept().isel(direction=0).drop_vars("direction").rename(N=name)
    study = study.assign_coords({name: coordinate})
    ax = dm.plot_sweep(study.isel({name: 1}))
    assert phrase in ax.figure.get_suptitle()
    plt.close(ax.figure)


def test_lines_of_two_selections_are_named_by_what_was_selected() -> None:
    ax = dm.plot_sweep(swept().sel(direction="up", N=300))
    dm.plot_sweep(swept().sel(direction="down", N=300), ax=ax)
    assert ax.figure.get_suptitle() == "N = 300 N"
    assert {"on the way up", "on the way down"} <= {*ax.get_legend_handles_labels()[1]}
    plt.close(ax.figure)


def test_a_selected_value_is_not_called_the_first_of_several() -> None:
    found = sweep(dm.coupled_natural_frequencies, P, k=[1e3, 1e4])
    ax = dm.plot_sweep(found.isel(value_index=1))
    assert "lowest" not in ax.get_ylabel().lower()
    plt.close(ax.figure)


@pytest.mark.parametrize("lines", ["", False])
def test_values_that_are_equal_but_for_rounding_are_flat(lines: Any) -> None:
    """Neither peaks of lines nor colours of maps show rounding."""
    study = swept()
    rounding = 1e-14 * np.random.default_rng(1).standard_normal(study["range"].shape)
    study["range"] = study["range"].copy(data=0.1354 * (1 + rounding))
    ax = dm.plot_sweep(study.sel(direction="up"), lines=lines)
    low, high = ax.get_ylim()
    if lines is False:
        low, high = ax.images[0].get_clim() if ax.images else ax.collections[0].get_clim()
    assert low == pytest.approx(135.4, rel=0.6)
    assert high - low > 0.05 * 135.4
    plt.close(ax.figure)
