"""Words of figures for values and horizons."""

import numpy as np
import pytest
import xarray as xr

from disc_model.figures.durations import horizon_text
from disc_model.figures.missing_texts import missing_text
from disc_model.figures.multipliers import period_text
from disc_model.figures.names import name_of
from disc_model.figures.value_texts import named_value, value_text


def along(name: str, value: float) -> xr.DataArray:
    """A number at one value of a parameter."""
    return xr.DataArray(1.0, {name: value})


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
        (
            "critical_speed",
            "critical_speed",
            "N",
            "lowest speed",
            "none found from 5 to 24 rad/s in steps of 19 rad/s",
        ),
        ("critical_speed", "crossing", "crossing_number", "a speed", "no further crossing"),
        ("branches", "period", "branch_point", "period", "no branch, or one of fewer points"),
        (
            "hysteresis",
            "onset_speed",
            "N",
            "speed, nan if at none or at the lowest",
            "none found within the bounds",  # which are not known
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


def test_a_sweep_that_found_no_separation_names_its_steps() -> None:
    attributes = {"long_name": "speed, nan if at none or at the lowest"}
    onset = xr.DataArray([np.nan], dims="N", attrs=attributes)
    study = xr.Dataset({"onset_speed": onset}, {"sweep_Omega": [8.0, 8.5, 9.0]})
    text = "none found from 8 to 9 rad/s in steps of 0.5 rad/s"
    assert missing_text(study, "onset_speed") == text


def test_a_missing_end_of_separation_on_a_ramp_names_its_speeds() -> None:
    """It was "none found", of speeds that the figure did not say."""
    onset = {"long_name": "speed at the first separation on the way up, nan if there is none"}
    end = {"long_name": "speed at the last, nan if there is none, or it continues"}
    speeds = {"onset_speed": ("rate", [np.nan], onset), "offset_speed": ("rate", [np.nan], end)}
    attributes = {"quantity": "ramps", "options": '{"low": 8, "high": 20}'}
    study = xr.Dataset(speeds, attrs=attributes)
    assert missing_text(study, "onset_speed") == "none found from 8 to 20 rad/s"
    assert missing_text(study, "offset_speed") == "none, or it continues at 8 rad/s"


@pytest.mark.parametrize("bounds", ["[8, 22]", '["8 rad/s", "22 rad/s"]'])
def test_a_search_without_a_border_names_its_bounds(bounds: str) -> None:
    """It was "unstable at all values", though the cycle is stable at other speeds."""
    border = xr.DataArray([np.nan], dims="N", attrs={"units": "rad s-1"})
    options = f'{{"bounds": {bounds}, "name": "Omega"}}'
    study = xr.Dataset({"border": border}, attrs={"function": "critical", "options": options})
    stable = "stable at the upper bound, 22 rad/s"
    unstable = "unstable at all values from 8 to 22 rad/s"
    assert missing_text(study, "border") == f"{stable}, or {unstable}"


def test_a_search_without_a_critical_value_names_its_largest_step() -> None:
    value = xr.DataArray([np.nan, np.nan], dims="N", attrs={"units": "rad s-1"})
    attributes = {"function": "critical", "options": '{"bounds": [8, 22]}'}
    study = xr.Dataset({"value": value, "resolution": ("N", [0.25, 0.5])}, attrs=attributes)
    text = "none found from 8 to 22 rad/s in steps of at most 0.5 rad/s"
    assert missing_text(study, "value") == text


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
