"""The order of entries of legends: lines, marks of points, what filled ones say, and words alone."""

import pytest
import xarray as xr
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

import disc_model as dm
from disc_model.figures.legend_samples import in_order
from tests.figures.test_wishes import legend_texts


def shares(N: float) -> xr.Dataset:
    """Shares of starts at two speeds, at the first of which one start is undecided."""
    data = {
        "separating_fraction": ("Omega", [0.2, 0.4]),
        "separating_fraction_low": ("Omega", [0.1, 0.3]),
        "separating_fraction_high": ("Omega", [0.3, 0.5]),
        "kind": (("Omega", "start"), [["undecided", "quiet"], ["quiet", "quiet"]]),
    }
    attrs = {"function": "basins", "base": f'{{"N": {N}}}', "options": "{}"}
    return xr.Dataset(data, {"Omega": [10.0, 12.0]}, attrs)


def test_lines_come_before_marks_and_what_filled_ones_say() -> None:
    """The lines of a second sweep came after the marks of the first one."""
    ax = dm.plot_sweep(shares(300), "separating_fraction")
    dm.plot_sweep(shares(385), "separating_fraction", ax=ax)
    texts = legend_texts(ax)
    assert ["N = 300 N" in texts[0], "385 N" in texts[1]] == [True, True]
    assert texts[2:] == [
        "interval of the share that separates",
        "filled: outcome of some starts unknown",
    ]


@pytest.mark.parametrize("reverse", [False, True])
def test_entries_are_sorted_by_their_kind(reverse: bool) -> None:
    entries = [
        Line2D([], [], label="a line"),
        Patch(label="an area"),
        Line2D([], [], linestyle="", marker="o", label="a mark"),
        Line2D([], [], linestyle="", marker="o", label="filled: in doubt"),
        Line2D([], [], linestyle="", label="words"),
    ]
    given = [*reversed(entries)] if reverse else entries
    kinds = [str(entry.get_label()) for entry in in_order(given)]
    assert {*kinds[:2]} == {"a line", "an area"}
    assert kinds[2:] == ["a mark", "filled: in doubt", "words"]
