"""Words of figures for values and horizons."""

import numpy as np
import pytest
import xarray as xr

from disc_model.figures.durations import horizon_text
from disc_model.figures.multipliers import period_text
from disc_model.figures.names import name_of
from disc_model.figures.words import missing_text, named_value, value_text


def along(name: str, value: float) -> xr.DataArray:
    """A number at one value of a parameter."""
    return xr.DataArray(1.0, {name: value})


@pytest.mark.parametrize(
    ("value", "text"), [(11892.137, "11.89 kN/m"), (11892.1, "11.8921 kN/m"), (12e3, "12 kN/m")]
)
def test_numbers_that_six_digits_do_not_give_have_four(value: float, text: str) -> None:
    """Names of samples were as long as "11.8921 kN/m", which was rounded all the same."""
    assert value_text(xr.Dataset(coords={"k": value}), "k", short=True) == text


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        ("contact_compliance", 0.0, "rigid contact"),
        ("contact_compliance", 2.6e-7, "compliance 0.26 µm/N"),
        ("contact_arc", 0.0, "contact at a point"),
        ("contact_arc", 0.1, "a pad over 0.1 rad"),
        ("friction_offset", 0.0, "friction in the middle plane"),
        ("friction_offset", 0.001, "friction 1 mm above the middle plane"),
        ("contact_force", "normal", "normal contact force"),
        ("contact_force", "vertical", "vertical contact force"),
    ],
)
def test_laws_of_contact_name_themselves(name: str, value: float, text: str) -> None:
    data = along(name, value)
    assert value_text(data, name) == text
    assert named_value(data, name) == text


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        ("N", 385.0, "385 N"),
        ("k_p", 2e4, "20 kN/m"),
        ("h", 0.002, "2 mm"),
        ("mu_s", 0.4, "0.4"),
        ("mu_s", 0.0, "0"),
    ],
)
def test_other_values_have_the_unit_of_figures(name: str, value: float, text: str) -> None:
    data = along(name, value)
    assert value_text(data, name) == text
    assert named_value(data, name).endswith(f" = {text}")


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ('{"horizon": 500}', "500 s"),
        ('{"horizon": 12.5}', "12.5 s"),
        ('{"horizon": "20 min"}', "20 min"),
        ('{"horizon": [1, 2]}', ""),
        ("{}", ""),
    ],
)
def test_the_horizon_of_a_study_has_its_unit(options: str, text: str) -> None:
    study = xr.Dataset(attrs={"options": options})
    assert horizon_text(study) == text


@pytest.mark.parametrize(
    ("name", "options", "text"),
    [
        ("first_separation", '{"horizon": 500}', "none within 500 s"),
        (
            "first_separation",
            '{"horizon": 500, "extrapolate": true}',
            "none within 500 s, or not timed",
        ),
        ("first_separation", "{}", "no value"),
        ("period", '{"horizon": 500}', "no value"),
    ],
)
def test_points_without_a_separation_are_called_so(name: str, options: str, text: str) -> None:
    study = xr.Dataset(attrs={"options": options})
    assert missing_text(study, name) == text


@pytest.mark.parametrize(
    ("quantity", "name", "dims", "long_name", "text"),
    [
        ("critical_speed", "critical_speed", "N", "lowest speed", "none from 5 to 24 rad/s"),
        ("critical_speed", "crossing", "crossing_number", "a speed", "no further crossing"),
        ("branches", "period", "branch_point", "period", "no branch, or one of fewer points"),
        (
            "hysteresis",
            "onset_speed",
            "N",
            "speed, nan if at none or at the lowest",
            "none within the bounds",
        ),
        ("regions", "period", "N", "period of the cycle", "no cycle is followed"),
        ("floquet", "period", "N", "period of the cycle", "no value"),
    ],
)
def test_a_missing_value_has_its_reason(
    quantity: str, name: str, dims: str, long_name: str, text: str
) -> None:
    """Critical speeds that were not found were "no value"."""
    variable = xr.DataArray([1.0, np.nan], dims=dims, attrs={"long_name": long_name})
    study = xr.Dataset({name: variable}, {"scan_Omega": [5.0, 24.0]}, {"quantity": quantity})
    assert missing_text(study, name) == text


@pytest.mark.parametrize(
    ("period", "text"), [(0.0144, "14.4 ms"), (0.75, "750 ms"), (2.5, "2.5 s")]
)
def test_periods_of_more_than_a_second_are_in_seconds(period: float, text: str) -> None:
    assert period_text(period) == text


@pytest.mark.parametrize(
    ("diameters", "name"),
    [
        ((0,), "l = 0"),
        ((2, 0), "l = 0, 2"),
        ((3, 3), "l = 3"),
        ((-1,), "in-plane"),
        ((2, -1), "in-plane, l = 2"),
    ],
)
def test_modes_are_named_by_their_nodal_diameters(diameters: tuple[int, ...], name: str) -> None:
    assert name_of(*diameters) == name
