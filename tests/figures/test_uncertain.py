"""Figures of uncertain parameters and Campbell diagrams: what is drawn, and that no name covers another."""

import json

import numpy as np
import xarray as xr

from disc_model.figures.modes import gaps
from disc_model.figures.uncertain import probabilities
from disc_model.studies.quantities.campbell import EFFECTS
from tests.figures.reading import draw
from tests.studies.quantities import test_sensitivity as uncertain


def test_instability_against_each_parameter() -> None:
    """Made up so that a sample is unstable where mu_s is above its middle: k does not matter."""
    study = uncertain.made_up()
    drawn = study["parameter_values"].transpose("N", "sample", "parameter").values
    words = study["cycle"].attrs["flag_meanings"].split()
    states = np.where(drawn[..., 1] > np.median(drawn[..., 1]), words.index("unstable"), words.index("stable"))
    study["cycle"] = (("N", "sample"), states.astype(np.int8), study["cycle"].attrs)
    for N in range(study.sizes["N"]):
        of_mu, of_k = (probabilities(study.isel(N=N), name) for name in ("mu_s", "k"))
        assert of_mu[[0, -1], 0].tolist() == [0, 1]
        assert np.all((of_k[:, 1] < 0.5) & (of_k[:, 2] > 0.5))
    figure = draw("sensitivity", study)
    assert len(figure.axes) == study.sizes["N"]
    assert [text.get_text() for text in figure.axes[0].get_yticklabels()] == ["k", "$μ_s$"], "what matters is above"


def made_up_crossings() -> xr.Dataset:
    """One mode drifts upward through zero before 11 rad/s, another peaks there; no cycle at 9 and from 13 to 14."""
    speeds = np.linspace(8, 15, 71)
    first = -0.09 + 0.1 * (speeds - 10)
    second = -1 + 0.5 / (1 + ((speeds - 11) / 0.05) ** 2)
    gone = (np.abs(speeds - 9) < 0.01) | ((speeds > 12.99) & (speeds < 14.01))
    growth = np.where(gone[:, None], np.nan, np.stack([first, second], axis=1))
    at_11 = growth[30, 0]
    by_mode, same = ("Omega", "mode"), np.ones((71, 2))
    effects = [EFFECTS.index(effect) for effect in ("no_cycle", "rises", "destabilises")]
    values = {
        "stick_slip_frequency": ("Omega", np.where(gone, np.nan, 10 * speeds)),
        "rotation_frequency": ("Omega", speeds / (2 * np.pi)),
        "growth_rate": ("Omega", np.where(gone, np.nan, growth.max(axis=1))),
        "mode_kind": (by_mode, same.astype(int), {"flag_meanings": "none disc slider"}),
        "diameters": (by_mode, same.astype(int)),
        "sliding_frequency": (by_mode, same * [100, 220]),
        "cycle_frequency": (by_mode, same * [100, 220]),
        "cycle_growth_rate": (by_mode, growth),
        "crossing_Omega": ("crossing", [9.0, 11.0, 11.04]),
        "crossing_frequency": ("crossing", [180.0, 220.0, 100.0]),
        "crossing_multiple": ("crossing", [2.0, 2.0, 1.0]),
        "crossing_growth_rate": ("crossing", [np.nan, at_11, at_11]),
        "crossing_effect": ("crossing", effects, {"flag_meanings": " ".join(EFFECTS)}),
        "crossing_line": ("crossing", [1, 1, 1], {"flag_meanings": "none stick_slip rotation"}),
    }
    attrs = {"base": json.dumps({"N": 385, "normalization": "as_published"}), "title": "made up"}
    return xr.Dataset(values, {"Omega": speeds, "mode": [1, 2]}, attrs)


def test_a_campbell_diagram_cuts_nothing_off_and_numbers_what_matters() -> None:
    study = made_up_crossings()
    found = [(round(low, 9), round(high, 9), count) for low, high, count in gaps(study)]
    assert found == [(8.95, 9.05, 1), (12.95, 14.05, 11)]
    above, below, _ = draw("campbell", study).axes
    for ax in (above, below):
        assert [round(bar.get_width(), 9) for bar in ax.patches] == [0.1, 1.1]
    numbers = [text.get_text() for text in above.texts if text.get_text().isdigit()]
    assert numbers[-2:] == ["1", "2"], "after the multiples of the stick-slip frequency"
    low, high = below.get_ylim()
    growth = study["cycle_growth_rate"]
    assert low <= float(growth.min()) < float(growth.max()) <= high
    # all crossings lie on lines that are drawn
    whole = [np.asarray(line.get_ydata(), dtype=float) for line in above.lines if len(line.get_xdata()) == 71]
    ratios = [line / study["stick_slip_frequency"].values for line in whole]
    multiples = {float(np.round(np.nanmean(ratio), 6)) for ratio in ratios if np.nanstd(ratio) < 1e-9}
    assert multiples >= set(study["crossing_multiple"].values.tolist())
