"""Lines of branches: those of unstable cycles never look like those of stable ones."""

import numpy as np
import xarray as xr
from matplotlib import pyplot as plt

import disc_model as dm
from disc_model.data.variables import axis_of
from disc_model.figures.branch_lines import STABLE
from disc_model.figures.words import label_of


def thinnest(ax: plt.Axes) -> float:
    """The width of the thinnest line of a branch on axes."""
    widths = [line.get_linewidth() for line in ax.lines if line.get_linestyle() != "None"]
    return float(min(widths))


def test_both_sides_of_a_narrow_peak_are_thinner_than_a_stable_line() -> None:
    """They touch in pictures of growth rates, and looked thick."""
    branch = dm.continue_cycle(dm.Parameters(N=385, Omega=14.9), "Omega", (14.85, 15.2))
    rates = branch.plot()
    periods = branch.plot("period")
    assert thinnest(rates) < thinnest(periods)
    assert 2 * thinnest(rates) < STABLE / 2
    plt.close("all")


def test_a_unit_of_amplitudes_is_a_root_in_labels() -> None:
    values = xr.DataArray(np.zeros(2), name="amplitude", attrs={"units": "kg^-1/2"})
    assert label_of(values)[0].endswith("(kg^-1/2)")
    assert axis_of("amplitude_2_0")[0].endswith("(kg^-1/2)")
