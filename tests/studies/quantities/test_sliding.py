"""Complex eigenvalues along a parameter, as a grid has them."""

import numpy as np
import pytest
import xarray as xr

from disc_model import Parameters, steady_sliding
from tests.studies.conftest import SMALL, computed


@pytest.fixture(scope="module")
def over_mu() -> xr.Dataset:
    """Kinetic friction up to the static one and beyond it."""
    options = {"parameter": "mu_k", "scan": {"start": 0.1, "stop": 0.6, "count": 6}}
    return computed(quantity="sliding", options=options, base={"Omega": 20, **SMALL}, axes={"N": [200, 400]})


def test_rows_are_those_of_steady_sliding(over_mu: xr.Dataset) -> None:
    assert over_mu["value"].attrs["long_name"] == "mu_k"
    for N in over_mu["N"].values:
        for mu in over_mu["value"].values:
            sliding = steady_sliding(Parameters(N=N, Omega=20, mu_k=mu, mu_s=0.6, **SMALL))
            one = over_mu.sel(N=N, value=mu)
            assert float(one["largest_growth_rate"]) == pytest.approx(sliding.growth_rate, rel=1e-9, abs=1e-12)
            assert int(one["unstable_modes"]) == sliding.unstable_modes
            assert float(one["contact_force"]) == pytest.approx(sliding.contact_force, rel=1e-12)
            growth = one["mode_growth_rate"].values
            assert np.nanmax(growth) == pytest.approx(sliding.growth_rate, rel=1e-6, abs=1e-9)
            assert np.isfinite(growth).sum() == 4
    assert float(over_mu["mac"].min()) > 0.9


def test_values_without_steady_sliding_have_no_modes() -> None:
    found = computed(quantity="sliding", options={"scan": {"start": 0, "stop": 40, "count": 3}}, axes={"N": [200]})
    assert np.isfinite(found["frequency"]).sum("mode").values.tolist() == [[0, 10, 10]]
    assert str(found["message"].values[0]).startswith("Omega=0: The disc is not driven")
