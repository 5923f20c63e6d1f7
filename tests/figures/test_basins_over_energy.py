"""Shares of starts over the energy of their kicks, with a panel for each value of a parameter."""

import pytest
import xarray as xr

from disc_model.figures.kinds import kind_of
from tests.figures.reading import crosses, draw
from tests.figures.test_motions import made, shares  # fixtures
from tests.studies.conftest import with_failed

__all__ = ["made", "shares"]


@pytest.mark.parametrize("width", ["column", "page"])
def test_shares_over_the_energy_have_a_panel_for_each_speed(shares: xr.Dataset, width: str) -> None:
    """The energy was refused as the axis of a figure."""
    figure = draw("basins", shares, x="energy", by="Omega", width=width)
    titles = [ax.get_title(loc="left") for ax in figure.axes]
    assert [title.split(") ")[1] for title in titles] == [
        "Speed Ω = 12 rad/s",
        "13 rad/s",
        "14 rad/s",
        "15 rad/s",
    ]
    separating = [[bar.get_height() for bar in ax.patches][:3] for ax in figure.axes]
    assert separating == [[0, 0, 0], [0, 0, 1], [0, 1, 1], [1, 1, 1]]
    assert figure.axes[-1].get_xlabel() == "Energy of the kick (J)"
    numbers = [text.get_text() for text in figure.axes[-1].get_xticklabels()]
    assert numbers == ["0.01", "0.1", "1"]
    without = draw("basins", with_failed(shares, Omega=13.0), x="energy", by="Omega", width=width)
    assert crosses(without.axes[1]) == [[0, 1, 2]]


def test_a_single_speed_has_one_panel_over_the_energy(shares: xr.Dataset) -> None:
    [ax] = draw("basins", shares.sel(Omega=[13.0]), x="energy").axes
    assert [bar.get_height() for bar in ax.patches][:3] == [0, 0, 1]


@pytest.mark.parametrize(
    ("phrase", "said"),
    [
        ({"x": "energy"}, "by: is required over the energy, such as Omega"),
        ({"x": "energy", "by": "N"}, "by='N': is no dimension of this study (known: Omega)"),
        ({"x": "Omega", "by": "Omega"}, "by='Omega': must be left out, unless x is energy"),
    ],
)
def test_what_panels_over_the_energy_need(phrase: dict[str, str], said: str) -> None:
    plot = kind_of("basins").model_validate({"kind": "basins", **phrase})
    assert [str(fault) for fault in plot.faults({"Omega": [12.0, 13.0]})] == [said]
