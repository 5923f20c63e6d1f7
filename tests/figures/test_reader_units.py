"""Units of the reader on axes of variables that have another name than their parameter."""

import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes

from tests.explorer.left_out import ruled
from tests.figures.reading import draw

OVER = {"x": "Omega", "y": "N"}


def study() -> xr.Dataset:
    """Contact forces of 6 to 8 kN."""
    found = ruled().isel(mu_s=1)
    forces = np.linspace(6000.0, 8000.0, 6).reshape(3, 2)
    return found.assign(P_max=found["P_max"].copy(data=forces))


def numbers_beside(ax: Axes) -> list[float]:
    """The numbers within a vertical axis."""
    ax.figure.canvas.draw()
    low, high = ax.get_ylim()
    texts = [text for text in ax.get_yticklabels() if low <= text.get_position()[1] <= high]
    return [float(text.get_text()) for text in texts]


@pytest.mark.parametrize("log", [False, True])
def test_the_unit_of_a_force_is_that_of_its_range(log: bool) -> None:
    """It was accepted, and the bar stayed in newtons."""
    figure = draw("heat_map", study(), variable="P_max", log=log, units={"P": "kN"}, **OVER)
    bar = figure.axes[-1]
    assert bar.get_ylabel().endswith("(kN)")
    numbers = numbers_beside(bar)
    assert numbers
    assert all(6 <= number <= 8 for number in numbers)


def test_limits_have_the_unit_of_the_figure() -> None:
    figure = draw(
        "curve", study(), variable="P_max", x="Omega", by="N", units={"P": "kN"}, limits=[6, 9]
    )
    [ax] = figure.axes
    assert ax.get_ylim() == (6000.0, 9000.0)
    assert all(6 <= number <= 9 for number in numbers_beside(ax))
