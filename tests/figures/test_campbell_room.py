"""Room in Campbell diagrams: names of modes beside the panel, the legend, and rings of rates."""

import numpy as np

import disc_model as dm
from tests.figures.made_up import campbell_study


def rings_of(rates: list[float]) -> set[float]:
    """The rates that a diagram has rings at."""
    study = campbell_study().isel(Omega=slice(0, len(rates)))
    study["growth_rate"][:] = rates
    _, bottom = dm.plot_campbell(study)
    found = set[float]()
    for line in bottom.lines:
        if line.get_markerfacecolor() == "white":
            found |= {*np.ravel(line.get_ydata()).tolist()}
    return found


def test_a_smooth_curve_of_large_rates_has_no_ring() -> None:
    """Of a disc that squeals, each point had one: any step over 0.1/s was open."""
    assert not rings_of([6.0, 7.0, 8.5, 10.0, 11.0, 11.5, 11.0])


def test_a_jump_of_small_rates_has_a_ring() -> None:
    assert rings_of([-0.05, -0.05, -0.05, 0.2, -0.05, -0.05]) == {0.2}
