"""The table of variables: values of points that are missing, attributes, and words of flags."""

import numpy as np
import pytest
import xarray as xr

from disc_model.data.variables import SCALARS, SERIES, STATUSES, Variable, attributes, flag_names


def test_points_that_are_missing_have_a_value_that_says_so() -> None:
    assert STATUSES[int(SCALARS["status"].missing)] == "failed"
    assert SCALARS["steps"].missing == 0
    assert np.isnan(SCALARS["first_separation"].missing)
    # without a word for it, the first one: the kind of no event
    assert SERIES["kind"].missing == 0
    empty = SCALARS["status"].empty((2, 3))
    assert empty.dtype == np.int8
    assert empty.shape == (2, 3)
    assert (empty == STATUSES.index("failed")).all()
    assert SCALARS["n_events"].empty((1,)).dtype == np.int64


@pytest.mark.parametrize(
    ("name", "unit", "text"),
    [
        ("P_min", "N", "contact force, positive in compression, least within the bin"),
        ("u_velocity_max", "m s-1", "vertical velocity of the slider, greatest within the bin"),
        (
            "w_max",
            "m",
            "displacement of the disc under the slider, greatest within the bin; from the undeformed disc",
        ),
        ("rho", "kg m-3", "density of the disc"),
        ("k", "N m-1", "spring of the slider, normal to the disc"),
        ("mu_k_over_mu_s", "1", "mu_k relative to mu_s"),
    ],
)
def test_attributes_of_derived_names(name: str, unit: str, text: str) -> None:
    found = attributes(name)
    assert found["units"] == unit
    assert found["long_name"] == text


@pytest.mark.parametrize("name", ["u", "w", "w_point", "u_0", "u_min"])
def test_a_displacement_says_what_it_is_measured_from(name: str) -> None:
    """Those of samples and those of outcomes have two zeros, and samples named none."""
    assert attributes(name)["long_name"].endswith("the undeformed disc")


def test_flags_are_words_by_their_numbers() -> None:
    variable = Variable("1", "a flag", ("no", "yes"))
    assert variable.attributes["flag_meanings"] == "no yes"
    assert variable.attributes["flag_values"].tolist() == [0, 1]
    values = xr.DataArray(np.array([1, 0, 1], np.int8), attrs=variable.attributes)
    assert flag_names(values).tolist() == ["yes", "no", "yes"]
    assert flag_names(xr.DataArray(["a"])).tolist() == ["a"]
