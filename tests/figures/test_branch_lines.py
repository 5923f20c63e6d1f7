"""Lines of branches: those of unstable cycles never look like those of stable ones."""

from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot as plt

import disc_model as dm
from disc_model.data.variables import axis_of
from disc_model.figures.branch_lines import STABLE
from disc_model.figures.drawing import BLACK
from disc_model.figures.words import label_of
from tests.refusals import refusal


def thinnest(ax: plt.Axes) -> float:
    """The width of the thinnest line of a black branch on axes."""
    lines = [line for line in ax.lines if line.get_color() == BLACK]
    widths = [line.get_linewidth() for line in lines if line.get_linestyle() != "None"]
    return float(min(widths))


@pytest.fixture(scope="module")
def branch() -> dm.Branch:
    """From 14.85 rad/s round the fold at 15.09 and back."""
    return dm.continue_cycle(dm.Parameters(N=385, Omega=14.9), "Omega", (14.85, 15.2))


def in_legend(ax: plt.Axes, label: str) -> Any:
    """The entry of a label."""
    handles, labels = ax.get_legend_handles_labels()
    return handles[labels.index(label)]


def dashed(ax: plt.Axes) -> list[Any]:
    """The dashed lines on axes."""
    drawn = [line for line in ax.lines if len(line.get_xdata())]
    return [line for line in drawn if line.get_linestyle() == "--"]


def test_unstable_cycles_look_the_same_in_all_pictures(branch: dm.Branch) -> None:
    """Their lines were thinner in pictures of growth rates. Two that touch stay thinner than a stable one."""
    rates = branch.plot(legend=False)
    periods = branch.plot("period", legend=False)
    assert thinnest(rates) == thinnest(periods)
    assert 2 * thinnest(rates) < STABLE
    widths = [in_legend(ax, "unstable").get_linewidth() for ax in (rates, periods)]
    assert widths[0] == widths[1]


def test_unstable_parts_are_dashed_where_a_reader_wishes(branch: dm.Branch) -> None:
    """Looks of branches could not be chosen."""
    _, ax = plt.subplots()
    branch.plot(
        "period", ax=ax, legend=False, looks={"stable": {"lw": 1}, "unstable": {"ls": "--"}}
    )
    [unstable] = dashed(ax)
    fold = branch.special[1]
    assert unstable.get_ydata()[0] == pytest.approx(1e3 * fold.period)
    assert in_legend(ax, "unstable").get_linestyle() == "--"
    assert in_legend(ax, "stable").get_linestyle() == "-"
    assert in_legend(ax, "stable").get_linewidth() == 1


def test_wished_dashes_tell_stability_and_not_branches(branch: dm.Branch) -> None:
    """Colours alone tell branches apart then; dots can be left out."""
    _, ax = plt.subplots()
    looks = {
        "stable": {"color": "k", "ls": "-"},
        "unstable": {"ls": "--"},
        "cycles": {"marker": ""},
    }
    for name in ("first", "second"):
        branch.plot("period", ax=ax, legend=False, looks=looks, labels={"branch": name})
    first, second = dashed(ax)
    assert first.get_color() != second.get_color()
    assert {line.get_marker() for line in ax.lines} <= {"", "None", "s"}
    assert in_legend(ax, "stable").get_color() == "k"


@pytest.mark.parametrize(
    "looks",
    [{"stabel": {}}, {"stable": {"colour": "r"}}, {"stable": 3}, {"stable": {"label": ""}}, 3],
)
def test_looks_that_cannot_be_understood_are_refused(branch: dm.Branch, looks: Any) -> None:
    with refusal("^looks"):
        branch.plot(looks=looks)


def test_a_unit_of_amplitudes_is_a_root_in_labels() -> None:
    values = xr.DataArray(np.zeros(2), name="amplitude", attrs={"units": "kg^-1/2"})
    assert label_of(values)[0].endswith("(kg^-1/2)")
    assert axis_of("amplitude_2_0")[0].endswith("(kg^-1/2)")
