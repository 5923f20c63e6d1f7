"""Figures of uncertain parameters and Campbell diagrams: what is drawn, and that no name covers
another."""

import numpy as np

from disc_model.figures.sensitivity import probabilities
from tests.figures.reading import draw
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
