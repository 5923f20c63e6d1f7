"""Figures of uncertain parameters and Campbell diagrams: what is drawn, and that no name covers
another."""

import numpy as np
import pytest

from disc_model.figures.selection import spans
from disc_model.figures.sensitivity import probabilities
from tests.figures.reading import draw
from tests.studies.conftest import SMALL, computed
from tests.studies.quantities import test_sensitivity as uncertain


def test_instability_against_each_parameter() -> None:
    """Made up so that a sample is unstable where mu_s is above its middle: k does not matter."""
    study = uncertain.made_up()
    drawn = study["parameter_values"].transpose("N", "sample", "parameter").values
    words = study["cycle"].attrs["flag_meanings"].split()
    states = np.where(
        drawn[..., 1] > np.median(drawn[..., 1]), words.index("unstable"), words.index("stable")
    )
    study["cycle"] = (("N", "sample"), states.astype(np.int8), study["cycle"].attrs)
    for N in range(study.sizes["N"]):
        of_mu, of_k = (probabilities(study.isel(N=N), name) for name in ("mu_s", "k"))
        assert of_mu[[0, -1], 0].tolist() == [0, 1]
        assert np.all((of_k[:, 1] < 0.5) & (of_k[:, 2] > 0.5))
    figure = draw("sensitivity", study)
    assert len(figure.axes) == study.sizes["N"]
    assert [text.get_text() for text in figure.axes[0].get_yticklabels()] == ["k", "$μ_s$"], (
        "what matters is above"
    )


def test_a_campbell_diagram_cuts_nothing_off_and_names_what_matters() -> None:
    """Of three modes from 9 to 13 rad/s, as if none were at 10 and at 12 to 12.25, another at 12.5,
    a peak at 11."""
    speeds = {"start": 9, "stop": 13, "step": 0.25}
    study = computed(
        quantity="campbell", options={}, base={"N": 200, **SMALL}, axes={"Omega": speeds}
    )
    gone = study["Omega"].isin([10, 12, 12.25])
    lost = ("stick_slip_frequency", "growth_rate", "cycle_frequency", "cycle_growth_rate")
    study = study.assign({name: study[name].where(~gone) for name in lost})
    assert spans(study["Omega"].values, study["growth_rate"].isnull().values) == [
        (9.875, 10.125),
        (11.875, 12.375),
    ]
    study["growth_rate"].loc[{"Omega": [11, 12.5]}] = [20, 30]
    beside = {
        "crossing_Omega": 11.01,
        "crossing_frequency": study["sliding_frequency"].sel(Omega=11).max(),
    }
    study = study.isel(crossing=[0]).assign(
        {name: ("crossing", [value]) for name, value in beside.items()}
    )
    figure = draw("campbell", study)
    figure.draw_without_rendering()  # names find their places
    above, below = figure.axes
    assert [bar.get_width() for ax in (above, below) for bar in ax.patches] == pytest.approx(
        2 * [0.25, 0.5]
    )
    low, high = below.get_ylim()
    assert low <= float(study["growth_rate"].min()) < 30 <= high
    assert [
        len(line.get_xdata()) for line in below.lines if line.get_markerfacecolor() == "white"
    ] == [2, 1]
    name = f"{float(study['crossing_multiple'][0]):g} $f_s$"
    assert [text.get_text() for text in below.texts if text.get_visible()] == [name]
    assert {text.get_text() for text in above.texts} >= {name, "in-plane"}
    assert 11.01 in [line.get_xdata()[0] for line in above.lines], "the crossing is marked"
