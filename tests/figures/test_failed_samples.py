"""Samples of a sensitivity study that failed."""

import numpy as np
import xarray as xr

from disc_model.analysis.classify import share
from disc_model.figures.sensitivity import probabilities
from tests.figures.every_kind import flag
from tests.figures.made_up import sensitivity
from tests.figures.reading import labels


def failed_samples(words: list[str]) -> xr.Dataset:
    """Samples of one parameter, in the order of its values."""
    classes = ("failed", "stable", "unstable")
    values = np.arange(float(len(words)))[:, None]
    data = {
        "parameter_values": (("sample", "parameter"), values),
        "cycle": flag(("sample",), np.array(words), classes),
    }
    return xr.Dataset(data, {"parameter": ["k"]})


def test_intervals_of_sensitivity_hold_failed_samples() -> None:
    """They were left out, and nothing said how many there were."""
    assert "95 % interval, which holds 10 failed of 120 samples" in labels(sensitivity())
    ends = probabilities(failed_samples(["unstable", "stable", "failed"] * 3), "k")
    assert (ends[:, 1] < share(1, 2)[1]).all()
    assert (ends[:, 2] > share(1, 2)[2]).all()
