"""Pictures of two sweeps on the same axes, each of whose points keeps its meaning."""

from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import disc_model as dm
from disc_model.figures.labels import words_of

CASE = dm.Parameters(N=385, Omega=14)


@pytest.fixture(autouse=True)
def _closed() -> object:
    yield
    pyplot.close("all")


def named(name: str, words: list[Any], *, stiffness: float = 20e3) -> xr.Dataset:
    """A sweep of words, or of what is true."""
    found = dict(zip(range(len(words)), words, strict=True))
    case = CASE.replace(k_p=stiffness)
    speeds = [10.0 + place for place in found]
    return dm.sweep(lambda at: {name: found[round(at.Omega) - 10]}, case, Omega=speeds)


def said_of_points(ax: Axes, ticked: Axes | None = None) -> list[list[str]]:
    """The word beside which each point of each line stands; axes that share theirs have it once."""
    words = [words_of(label) for label in (ticked or ax).get_yticklabels()]
    ticks = dict(zip(ax.get_yticks(), words, strict=True))
    return [[ticks[height] for height in line.get_ydata()] for line in ax.lines]


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
    alone = dm.plot_sweep(named(name, words), name)
    expected = said_of_points(alone)
    ax = dm.plot_sweep(named(name, further), name)
    expected += said_of_points(ax)

    dm.plot_sweep(named(name, further, stiffness=25e3), name, ax=alone)
    assert said_of_points(alone) == expected


def test_points_of_panels_that_share_their_axis_stand_beside_their_own_words() -> None:
    _, axes = pyplot.subplots(1, 2, sharey=True)
    dm.plot_sweep(named("outcome", ["quiet", "separation"]), "outcome", ax=axes[0])
    dm.plot_sweep(named("outcome", ["growing", "growing"]), "outcome", ax=axes[1])
    assert said_of_points(axes[0]) == [["quiet", "separation"]]
    assert said_of_points(axes[1], axes[0]) == [["growing, in contact"] * 2]


def test_words_of_axes_that_were_cleared_are_forgotten() -> None:
    ax = dm.plot_sweep(named("outcome", ["quiet", "separation"]), "outcome")
    ax.clear()
    dm.plot_sweep(named("outcome", ["growing", "growing"]), "outcome", ax=ax)
    assert [words_of(label) for label in ax.get_yticklabels()] == ["growing, in contact"]


def test_long_words_along_the_axis_are_those_of_both_sweeps() -> None:
    """The words of the second stood below the points of the first."""

    def speed(case: dm.Parameters, name: str) -> dict[str, float]:
        return {"speed": case.Omega}

    first = [f"a specimen of grey cast iron, {number}" for number in range(4)]
    second = [f"a specimen of carbon, {number}" for number in range(4)]
    ax = dm.plot_sweep(dm.sweep(speed, CASE, over={"name": first}))
    dm.plot_sweep(dm.sweep(speed, CASE.replace(Omega=10), over={"name": second}), ax=ax)
    words = [words_of(label) for label in ax.get_xticklabels()]
    places = dict(zip(words, ax.get_xticks(), strict=True))
    assert [places[word] for word in first] == [0, 1, 2, 3]
    assert [places[word] for word in second] == [4, 5, 6, 7]


def rates(stiffness: float) -> xr.Dataset:
    """Growth rates over speed and load."""

    def growth(case: dm.Parameters) -> dict[str, float]:
        return {"growth_rate": 1e-3 * (case.Omega - case.N / 30)}

    case = CASE.replace(k_p=stiffness)
    return dm.sweep(growth, case, Omega=[8, 10, 12, 14], N=[200, 300, 400, 500])


def shares(speed: float) -> xr.Dataset:
    """What starts at two energies come to."""
    return dm.basins(CASE.replace(Omega=speed), [1e-3, 0.1], 2, horizon=20)


@pytest.mark.parametrize("asked", [None, {"y": "Own words", "bar": "Own words"}])
def test_maps_are_not_drawn_over_each_other(asked: Any) -> None:
    """The second hid the first, and had a further bar of colours."""
    ax = dm.plot_sweep(rates(20e3), "growth_rate")
    drawn = ax.get_children()
    with pytest.raises(dm.ParameterError, match="a map would cover: draw on other axes"):
        dm.plot_sweep(rates(10e3), "growth_rate", ax=ax, labels=asked)
    assert ax.get_children() == drawn


def test_bars_are_not_drawn_over_bars() -> None:
    """Those of the second case stood under the title of the first, among intervals of both."""
    ax = dm.plot_sweep(shares(14))
    with pytest.raises(dm.ParameterError, match="bars would cover: draw on other axes"):
        dm.plot_sweep(shares(15.5), ax=ax)
    ax.clear()
    dm.plot_sweep(shares(15.5), ax=ax)
    assert ax.patches


def test_modes_are_not_drawn_over_modes() -> None:
    axes = dm.plot_modes(CASE.replace(n_diameters=1))
    with pytest.raises(dm.ParameterError, match="shapes of modes would cover"):
        dm.plot_modes(CASE.replace(n_diameters=1), ax=axes)


def sections(*, stiffness: float, settled: str) -> xr.Dataset:
    """Angles once a turn, of motions that had settled or had not."""
    angles = 1e-6 * stiffness * np.arange(6.0).reshape(2, 3)
    return xr.Dataset(
        {
            "psi": (("Omega", "sample"), angles, {"units": "rad", "long_name": "angle"}),
            "settled": ("Omega", [settled] * 2),
        },
        {
            "Omega": [10.0, 12.0],
            "sample": ("sample", range(3), {"long_name": "number of the turn"}),
        },
        {"base": CASE.replace(k_p=stiffness).canonical_json},
    )


def looks_of_entries(ax: Axes) -> dict[str, tuple[Any, ...]]:
    """Colour and mark of each entry of the legend, by its words."""
    legend = ax.figure.legends[0]
    looks = [(line.get_color(), line.get_marker()) for line in legend.get_lines()]
    return dict(zip(map(words_of, legend.get_texts()), looks, strict=True))


def test_rings_of_two_diagrams_are_told_apart() -> None:
    """Both were grey, and the legend had the mark of a case that was nowhere."""
    ax = dm.plot_sweep(sections(stiffness=20e3, settled="changing"))
    dm.plot_sweep(sections(stiffness=25e3, settled="changing"), ax=ax)
    drawn = [(line.get_color(), line.get_marker()) for line in ax.lines]
    entries = looks_of_entries(ax)
    assert [*entries] == [
        "not settled, or undecided, $k_p$ = 20 kN/m",
        "not settled, or undecided, $k_p$ = 25 kN/m",
    ]
    assert [*entries.values()] == drawn
    assert len({*drawn}) == 2


def test_dots_and_rings_of_one_diagram_have_entries_of_their_own() -> None:
    ax = dm.plot_sweep(sections(stiffness=20e3, settled="settled"))
    dm.plot_sweep(sections(stiffness=25e3, settled="changing"), ax=ax)
    drawn = [(line.get_color(), line.get_marker()) for line in ax.lines]
    assert [*looks_of_entries(ax).values()] == drawn


def test_room_on_a_plain_page_is_found_without_drawing_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """All panels were drawn some sixty times for each picture."""
    drawn = []
    monkeypatch.setattr(Figure, "draw_without_rendering", lambda page: drawn.append(page))
    _, axes = pyplot.subplots(2, 2)
    for ax in axes.flat:
        dm.plot_sweep(rates(20e3), "growth_rate", lines="N", ax=ax)
    assert not drawn
