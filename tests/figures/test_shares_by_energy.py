"""Shares of starts over a parameter and their energy: a line for each energy."""

import numpy as np
import pytest
import xarray as xr

import disc_model as dm
from tests.figures.test_wishes import legend_texts
from tests.refusals import refusal

ENERGIES = [0.01, 1.0]
SPEEDS = [12.0, 14.0, 16.0]
SEPARATING = np.array([[0.0, 0.25], [0.25, 0.5], [0.5, 1.0]])
"""Shares of the starts that separate, by speed and energy."""


def study() -> xr.Dataset:
    """Shares of starts at three speeds, of two energies, with intervals of the share that separates."""
    dims = ("Omega", "energy", "attractor_class")
    shares = np.stack([1 - SEPARATING, SEPARATING], axis=-1)
    data = {
        "basin_fraction_by_energy": (dims, shares, {"units": "1"}),
        "basin_fraction_by_energy_low": (dims, 0.5 * shares),
        "basin_fraction_by_energy_high": (dims, np.minimum(1, shares + 0.1)),
    }
    energy = ("energy", ENERGIES, {"units": "J", "long_name": "energy of the kick"})
    coords = {"Omega": SPEEDS, "energy": energy, "attractor_class": ["quiet", "separating"]}
    attrs = {"function": "basins", "options": '{"confidence": 0.9}'}
    return xr.Dataset(data, coords, attrs)


def test_shares_over_a_parameter_have_a_line_for_each_energy() -> None:
    """They were refused, as shares are drawn as bars."""
    ax = dm.plot_sweep(study(), "basin_fraction_by_energy", lines="energy")
    lines = [line for line in ax.lines if len(line.get_xdata()) == len(SPEEDS)]
    np.testing.assert_allclose([line.get_ydata() for line in lines], SEPARATING.T)
    bars = [line for line in ax.lines if len(line.get_xdata()) == 3 * len(SPEEDS)]
    lows = [line.get_ydata().reshape(3, 3)[:, 0] for line in bars]
    np.testing.assert_allclose(lows, 0.5 * SEPARATING.T)
    assert legend_texts(ax) == [
        "Energy of the kick = 0.01 J",
        "1 J",
        "90 % interval of the share that separates",
    ]
    assert ax.get_ylabel() == "Share of the starts that separate"


def test_shares_over_the_energy_have_a_line_for_each_value_of_a_parameter() -> None:
    ax = dm.plot_sweep(study(), "basin_fraction_by_energy", x="energy", lines="Omega")
    lines = [line for line in ax.lines if len(line.get_xdata()) == len(ENERGIES)]
    np.testing.assert_allclose([line.get_ydata() for line in lines], SEPARATING)


def test_shares_of_all_outcomes_at_once_say_how_to_draw_lines() -> None:
    with refusal(r'study\.sel\(Omega=12\), or draw a line for each energy by lines="energy"'):
        dm.plot_sweep(study(), "basin_fraction_by_energy")
    with pytest.raises(dm.ParameterError, match="must be another dimension than x"):
        dm.plot_sweep(study(), "basin_fraction_by_energy", lines="mu_k")
