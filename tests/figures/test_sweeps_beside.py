"""Pictures of two sweeps on the same axes, each of whose points keeps its meaning."""

from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import disc_model as dm
from disc_model import plot_sweep
from disc_model.figures.labels import words_of
from tests.refusals import refusal

CASE = dm.Parameters(N=385, Omega=14)
SOFT = CASE.replace(k_p=20e3)
STIFF = CASE.replace(k_p=25e3)
DISC = CASE.replace(n_diameters=1)


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


def quiet_then_separation() -> xr.Dataset:
    """A sweep of two outcomes."""
    return named("outcome", ["quiet", "separation"])


def all_growing() -> xr.Dataset:
    """A sweep of one outcome, which the other sweep does not have."""
    return named("outcome", ["growing", "growing"])


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


def test_points_of_panels_that_share_their_axis_stand_beside_their_own_words() -> None:
    _, [left, right] = pyplot.subplots(1, 2, sharey=True)
    plot_sweep(quiet_then_separation(), ax=left)
    plot_sweep(all_growing(), ax=right)
    assert said_of_points(left) == [["quiet", "separation"]]
    assert said_of_points(right, left) == [["growing, in contact"] * 2]


def test_words_of_axes_that_were_cleared_are_forgotten() -> None:
    ax = plot_sweep(quiet_then_separation())
    ax.clear()
    plot_sweep(all_growing(), ax=ax)
    words = words_along(ax.get_yticklabels())
    assert words == ["growing, in contact"]


# ---- Words along the horizontal axis


def speed(case: dm.Parameters, name: str) -> dict[str, float]:
    """A quantity that is computed of a specimen with a name."""
    return {"speed": case.Omega}


def specimens(case: dm.Parameters, material: str) -> xr.Dataset:
    """A sweep over four specimens with long names."""
    names = [f"a specimen of {material}, {number}" for number in range(4)]
    return dm.sweep(speed, case, over={"name": names})


def test_long_words_along_the_axis_are_those_of_both_sweeps() -> None:
    """The words of the second stood below the points of the first."""
    iron = specimens(CASE, "grey cast iron")
    carbon = specimens(CASE.replace(Omega=10), "carbon")
    ax = plot_sweep(iron)
    plot_sweep(carbon, ax=ax)
    words = words_along(ax.get_xticklabels())
    places = dict(zip(words, ax.get_xticks(), strict=True))
    of_iron = [places[name] for name in iron["name"].values]
    of_carbon = [places[name] for name in carbon["name"].values]
    assert of_iron == [0, 1, 2, 3]
    assert of_carbon == [4, 5, 6, 7]


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


def test_modes_are_not_drawn_over_modes() -> None:
    axes = dm.plot_modes(DISC)
    with refusal("shows modes already: give each its own axes"):
        dm.plot_modes(DISC, ax=axes)


# ---- Marks of motions that have not settled


def sections(case: dm.Parameters, settled: str) -> xr.Dataset:
    """Angles once a turn, of motions that had settled or had not."""
    turns = np.arange(6.0).reshape(2, 3)
    angles = 1e-6 * case.k_p * turns
    of_angles = {"units": "rad", "long_name": "angle"}
    of_turns = {"long_name": "number of the turn"}
    return xr.Dataset(
        {"psi": (("Omega", "sample"), angles, of_angles), "settled": ("Omega", [settled, settled])},
        {"Omega": [10.0, 12.0], "sample": ("sample", range(3), of_turns)},
        {"base": case.canonical_json},
    )


def look(line: Any) -> tuple[Any, Any]:
    """Colour and mark of a line, or of its sample in a legend."""
    return line.get_color(), line.get_marker()


def looks_of_entries(ax: Axes) -> dict[str, tuple[Any, Any]]:
    """The look of each entry of the legend, by its words."""
    [legend] = ax.figure.legends
    looks = map(look, legend.get_lines())
    words = words_along(legend.get_texts())
    return dict(zip(words, looks, strict=True))


def test_rings_of_two_diagrams_are_told_apart() -> None:
    """Both were grey, and the legend had the mark of a case that was nowhere."""
    ax = plot_sweep(sections(SOFT, "changing"))
    plot_sweep(sections(STIFF, "changing"), ax=ax)
    drawn = [look(line) for line in ax.lines]
    entries = looks_of_entries(ax)
    assert [*entries] == [
        "not settled, or undecided, $k_p$ = 20 kN/m",
        "not settled, or undecided, $k_p$ = 25 kN/m",
    ]
    assert [*entries.values()] == drawn
    assert len({*drawn}) == 2


def test_rings_of_two_diagrams_are_told_apart_in_grey_print() -> None:
    """Only their colours differed."""
    ax = plot_sweep(sections(SOFT, "changing"))
    plot_sweep(sections(STIFF, "changing"), ax=ax)
    first, second = (line.get_markersize() for line in ax.lines)
    assert second > 1.4 * first
    [legend] = ax.figure.legends
    assert [line.get_markersize() for line in legend.get_lines()] == [first, second]


def test_dots_and_rings_of_one_diagram_have_entries_of_their_own() -> None:
    ax = plot_sweep(sections(SOFT, "settled"))
    plot_sweep(sections(STIFF, "changing"), ax=ax)
    drawn = [look(line) for line in ax.lines]
    entries = looks_of_entries(ax)
    assert [*entries.values()] == drawn
    assert len({*drawn}) == 2


# ---- Room


def test_room_on_a_plain_page_is_found_without_drawing_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """All panels were drawn some sixty times for each picture."""
    drawn: list[Figure] = []
    monkeypatch.setattr(Figure, "draw_without_rendering", lambda page: drawn.append(page))
    _, axes = pyplot.subplots(2, 2)
    study = rates(SOFT)
    for ax in axes.flat:
        plot_sweep(study, lines="N", ax=ax)
    assert not drawn
