"""Shares of what many starts come to, by themselves and in Fig. 15."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from disc_model.data.variables import Outcome
from disc_model.figures.parts import save
from disc_model.stability.attractor.many import Arrival, Attractor
from disc_model.studies.grids.quantities import basins
from tests.figures.grids.reading import draw, labels, lines
from tests.stability.test_attractor import stretch
from tests.studies.grids.conftest import computed, growth_over, with_failed

QUIET, APART = (
    Attractor(Outcome.QUIET, stretch(u_min=0, u_max=1e-5, separation_rate=0, share_stick=0.3, share_separation=0)),
    Attractor(Outcome.SEPARATING, stretch(u_min=0, u_max=0.03)),
)


@pytest.fixture
def shares(monkeypatch: pytest.MonkeyPatch) -> xr.Dataset:
    """All quiet at 12 rad/s, some at 13 and 14, none at 15."""

    class Made:
        def __init__(self, p, *_, **__) -> None:
            self.least = {12: 9.0, 13: 0.5, 14: 0.05, 15: -1.0}[p.Omega]

        def reached(self, energy: float) -> Arrival:
            attractor = APART if energy > self.least else QUIET
            return Arrival(attractor.kind, attractor, 50.0, False)

    monkeypatch.setattr(basins, "Basins", Made)
    monkeypatch.setattr(basins, "random_kick", lambda p, state, energy, key: energy)
    return computed(
        quantity="basins", options={"energies": [0.01, 0.1, 1], "starts": 4}, base={"N": 385},
        axes={"Omega": [12, 13, 14, 15]},
    )  # fmt: skip


def test_shares_attractors_and_kicks_are_drawn(shares: xr.Dataset, tmp_path) -> None:
    figure = draw("basins", shares, x="Omega")
    assert labels(figure) == ["quiet", "separating"]
    np.testing.assert_allclose(
        lines(figure.axes[2])["by bisection"].get_ydata(), [np.nan, 0.5, 0.05, np.nan], rtol=0.06
    )
    save(figure, tmp_path / "shares.png")
    # what separates without a kick has no place on a logarithmic scale, and is not left out
    assert [(text.get_position()[0], text.get_text()) for text in figure.axes[2].texts] == [(15, "0")]
    # a point that failed is marked
    save(draw("basins", with_failed(shares, Omega=13.0), x="Omega"), tmp_path / "failed.png")


def test_the_band_of_fig_15_is_where_both_shares_are_above_zero(
    shares: xr.Dataset, speeds: xr.Dataset, sweep: xr.Dataset, tmp_path
) -> None:
    others = {"hysteresis": sweep, "cycle": growth_over([200.0, 400.0], np.linspace(12, 15, 7))}

    before = draw("critical_speed", speeds, others)
    assert "quiet or separating,\nnot measured" in labels(before)
    figure = draw("critical_speed", speeds, others | {"basins": shares})
    assert "quiet or separating,\nmeasured at 385 N" in labels(figure)
    assert "quiet or separating,\nnot measured" not in labels(figure)
    # not beyond what was measured: the bar used to go on to halfway to the next speed, past the cycle's end
    bars = [(bar.get_x(), bar.get_x() + bar.get_width()) for bar in figure.axes[1].patches if bar.get_width() > 0]
    assert bars == [(13.0, 14.0)]
    save(figure, tmp_path / "both.png")
