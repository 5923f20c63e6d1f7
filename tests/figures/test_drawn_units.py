"""Units in which pictures are drawn from Python: those asked for, and those of coordinates."""

from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes

import disc_model as dm
from disc_model.data.variables import attributes
from tests.refusals import refusal

SPEEDS = np.array([10.0, 12.0, 14.0])
RPM = 30 / np.pi
IN_RPM = {"units": "rpm", "long_name": "speed"}


def sweep(**coordinates: Any) -> xr.Dataset:
    """Growth rates over speeds, as a sweep has them."""
    rates = {"units": "s-1", "long_name": "growth rate of the stick-slip cycle"}
    given = {"Omega": ("Omega", SPEEDS, attributes("Omega")), **coordinates}
    attrs = {"function": "floquet", "base": '{"N": 385.0, "Omega": 15.0}'}
    data = {"growth_rate": ("Omega", [-0.1, 0.1, 0.2], rates)}
    return xr.Dataset(data, given, attrs)


def plane() -> xr.Dataset:
    """Growth rates over speeds and two preloads."""
    loads = xr.Variable("N", [300.0, 350.0], attributes("N"))
    return sweep().expand_dims(N=loads)


def ends_of(ax: Axes) -> list[float]:
    """The places of the first and the last point along the axis."""
    return list(map(float, ax.dataLim.intervalx))


def entries_of(ax: Axes) -> list[str]:
    """The words of the legend."""
    return [text.get_text() for text in ax.figure.legends[0].get_texts()]


# ---- Coordinates with units of their own


def test_a_coordinate_is_drawn_by_its_own_name_and_unit() -> None:
    """The axis said rad/s, over numbers in rpm."""
    ax = dm.plot_sweep(sweep(Omega=("Omega", [100.0, 120.0, 140.0], IN_RPM)))
    assert ax.get_xlabel() == "Speed (rpm)"
    assert ends_of(ax) == pytest.approx([100, 140])


def test_a_coordinate_with_a_unit_alone_keeps_its_usual_name() -> None:
    ax = dm.plot_sweep(sweep(Omega=("Omega", [100.0, 120.0, 140.0], {"units": "rpm"})))
    assert ax.get_xlabel() == "Speed Ω (rpm)"


def test_a_unit_of_another_kind_is_shown_as_it_is() -> None:
    ax = dm.plot_sweep(sweep(Omega=("Omega", SPEEDS, {"units": "m", "long_name": "radius"})))
    assert ax.get_xlabel() == "Radius (m)"
    assert ends_of(ax) == [10, 14]


def test_lines_are_named_in_the_unit_of_their_coordinate() -> None:
    loads = ("N", [0.3, 0.35], {"units": "kN", "long_name": "load"})
    ax = dm.plot_sweep(plane().assign_coords(N=loads))
    assert entries_of(ax) == ["Load = 0.3 kN", "0.35 kN"]


def test_a_map_has_the_units_of_its_coordinates() -> None:
    loads = ("N", [0.3, 0.35], {"units": "kN", "long_name": "load"})
    ax = dm.plot_sweep(plane().assign_coords(N=loads), x="Omega", lines=False)
    assert ax.get_ylabel() == "Load (kN)"
    assert ax.get_ylim() == pytest.approx((0.3, 0.35))


def test_the_title_has_the_unit_of_a_single_coordinate() -> None:
    loads = ("N", [0.3, 0.35], {"units": "kN"})
    ax = dm.plot_sweep(plane().assign_coords(N=loads).isel(N=0))
    assert ax.figure.get_suptitle() == "N = 0.3 kN"


# ---- Units asked for


def test_values_are_drawn_in_the_units_asked_for() -> None:
    ax = dm.plot_sweep(plane(), units={"Omega": "rpm", "N": "kN"})
    assert ax.get_xlabel() == "Speed Ω (rpm)"
    assert entries_of(ax) == ["Preload N = 0.3 kN", "0.35 kN"]
    assert ends_of(ax) == pytest.approx([10 * RPM, 14 * RPM])


def test_units_asked_for_come_before_those_of_coordinates() -> None:
    given = sweep(Omega=("Omega", [100.0, 120.0, 140.0], {"units": "rpm"}))
    ax = dm.plot_sweep(given, units={"Omega": "rad/s"})
    assert ax.get_xlabel() == "Speed Ω (rad/s)"
    assert ends_of(ax) == pytest.approx([100 / RPM, 140 / RPM])


def test_speeds_that_are_found_have_the_unit_of_speeds() -> None:
    speeds = xr.Variable("Omega", SPEEDS, {"units": "rad s-1", "long_name": "critical speed"})
    ax = dm.plot_sweep(
        sweep().assign(critical_speed=speeds), "critical_speed", units={"Omega": "rpm"}
    )
    assert ax.get_ylabel().endswith("(rpm)")


def test_a_scan_without_a_critical_speed_says_its_range_in_rpm() -> None:
    case = dm.Parameters(N=300, Omega=15)
    bounds = ("100 rpm", "120 rpm")
    found = dm.sweep(dm.critical_speed, case, N=[1, 2], bounds=bounds, step="20 rpm", horizon=0.01)
    ax = dm.plot_sweep(found, units={"Omega": "rpm"})
    words = [text.get_text() for text in ax.figure.findobj(lambda each: hasattr(each, "get_text"))]
    assert any("from 100 to 120 rpm" in text for text in words)


def test_a_branch_is_drawn_in_the_units_asked_for() -> None:
    case = dm.Parameters(N=385, Omega=14.9)
    branch = dm.continue_cycle(case, "Omega", (14.8, 15.2))
    ax = branch.plot(units={"Omega": "rpm"})
    assert ax.get_xlabel() == "Speed Ω (rpm)"
    assert ax.dataLim.x0 == pytest.approx(branch.values.min() * RPM)
    assert any("rpm" in text for text in entries_of(ax))


def test_a_campbell_diagram_is_drawn_in_the_units_asked_for() -> None:
    axes = {"Omega": {"start": 10, "stop": 10.04, "step": 0.01}}
    study = dm.run_study({"study": "c", "quantity": "campbell", "base": {"N": 385}, "axes": axes})
    _, rates = dm.plot_campbell(study, highest=400, units={"Omega": "rpm"})
    assert rates.get_xlabel() == "Speed Ω (rpm)"
    assert rates.get_xlim() == pytest.approx((10 * RPM, 10.04 * RPM))


@pytest.mark.parametrize(
    ("units", "rule"),
    [
        (3, "units=3: must be None, or units by names"),
        ({"Omega": "kN"}, "units.Omega='1 kN': must be a number in rad/s"),
        ({"Omeg": "rpm"}, "units.Omeg='rpm': no parameter or variable with a unit"),
    ],
)
def test_units_that_cannot_be_understood_are_refused(units: Any, rule: str) -> None:
    with refusal(rule):
        dm.plot_sweep(sweep(), units=units)
