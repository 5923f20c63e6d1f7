"""Lines of branches: those of unstable cycles never look like those of stable ones."""

from typing import Any

import numpy as np
import pytest
import xarray as xr

import disc_model as dm
from disc_model.data.variables import axis_of
from disc_model.figures.words import label_of
from tests.refusals import refusal


@pytest.fixture(scope="module")
def branch() -> dm.Branch:
    """From 14.85 rad/s round the fold at 15.09 and back."""
    return dm.continue_cycle(dm.Parameters(N=385, Omega=14.9), "Omega", (14.85, 15.2))


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
