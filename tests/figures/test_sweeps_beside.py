"""Pictures of two sweeps on the same axes, each of whose points keeps its meaning."""

from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes

import disc_model as dm
from disc_model import plot_sweep
from disc_model.figures.labels import words_of
from tests.refusals import refusal

CASE = dm.Parameters(N=385, Omega=14)
SOFT = CASE.replace(k_p=20e3)
STIFF = CASE.replace(k_p=25e3)


def words_along(ticks: list[Any]) -> list[str]:
    """The words of the ticks of an axis."""
    return [words_of(tick) for tick in ticks]


# ---- Words along the vertical axis


def named(name: str, words: list[Any], case: dm.Parameters = SOFT) -> xr.Dataset:
    """A sweep of words, or of what is true, over speeds from 10 rad/s on."""
    speeds = 10.0 + np.arange(len(words))

    def word_at(case: dm.Parameters) -> dict[str, Any]:
        place = round(case.Omega) - 10
        return {name: words[place]}

    return dm.sweep(word_at, case, Omega=speeds)


def said_of_points(ax: Axes, ticked: Axes | None = None) -> list[list[str]]:
    """The word beside which each point of each line stands; axes that share theirs have it once."""
    with_ticks = ticked or ax
    words = words_along(with_ticks.get_yticklabels())
    heights = ax.get_yticks()
    word_at = dict(zip(heights, words, strict=True))
    said = []
    for line in ax.lines:
        points = line.get_ydata()
        said.append([word_at[height] for height in points])
    return said


@pytest.mark.parametrize(
    ("name", "words", "further"),
    [
        ("outcome", ["quiet", "separation"], ["growing", "growing"]),
        ("outcome", ["growing", "growing"], ["quiet", "separation"]),
        ("stable", [True, True], [False, False]),
    ],
)
def test_points_of_two_sweeps_stand_beside_their_own_words(
    name: str, words: list[Any], further: list[Any]
) -> None:
    """The second picture named the points of the first by its own words."""
    first = named(name, words, SOFT)
    second = named(name, further, STIFF)
    together = plot_sweep(first, name)
    of_first = said_of_points(together)
    of_second = said_of_points(plot_sweep(second, name))

    plot_sweep(second, name, ax=together)
    assert said_of_points(together) == of_first + of_second


# ---- Words along the horizontal axis


def speed(case: dm.Parameters, name: str) -> dict[str, float]:
    """A quantity that is computed of a specimen with a name."""
    return {"speed": case.Omega}


# ---- What would cover what is there


def growth(case: dm.Parameters) -> dict[str, float]:
    """A made-up growth rate that rises with the speed and falls with the load."""
    rate = 1e-3 * (case.Omega - case.N / 30)
    return {"growth_rate": rate}


def rates(case: dm.Parameters) -> xr.Dataset:
    """Growth rates over speed and load."""
    speeds = [8, 10, 12, 14]
    loads = [200, 300, 400, 500]
    return dm.sweep(growth, case, Omega=speeds, N=loads)


def shares(speed: float) -> xr.Dataset:
    """What starts at two energies come to."""
    case = CASE.replace(Omega=speed)
    energies = [1e-3, 0.1]
    return dm.basins(case, energies, 2, horizon=20)


@pytest.mark.parametrize("asked", [None, {"y": "Own words", "bar": "Own words"}])
def test_maps_are_not_drawn_over_each_other(asked: Any) -> None:
    """The second hid the first, and had a further bar of colours."""
    ax = plot_sweep(rates(SOFT))
    drawn = ax.get_children()
    with refusal("a map would cover: draw on other axes"):
        plot_sweep(rates(STIFF), ax=ax, labels=asked)
    assert ax.get_children() == drawn


def test_bars_are_not_drawn_over_bars() -> None:
    """Those of the second case stood under the title of the first, among intervals of both."""
    slow = shares(14)
    fast = shares(15.5)
    ax = plot_sweep(slow)
    with refusal("bars would cover: draw on other axes"):
        plot_sweep(fast, ax=ax)
    ax.clear()
    plot_sweep(fast, ax=ax)
    assert ax.patches
