"""Campbell diagrams: rows of the table, crossings against root finding, and what growth rates do
there."""

from typing import Any

import numpy as np
import pytest
import xarray as xr
from scipy.optimize import brentq

from disc_model.data.variables import flag_names
from disc_model.parameters import Parameters
from disc_model.stability.frequencies import frequencies
from disc_model.studies.quantities.campbell import Campbell
from tests.studies.conftest import SMALL, computed


def words(study: xr.Dataset, name: str) -> list[str]:
    return flag_names(study[name]).tolist()


@pytest.mark.compiled
def test_a_crossing_is_where_root_finding_says() -> None:
    """Between speeds f_s is almost straight."""
    base = {"N": 200, **SMALL}
    found = computed(
        quantity="campbell",
        options={},
        base=base,
        axes={"Omega": {"start": 9, "stop": 13, "step": 0.25}},
    )
    assert set(words(found, "status")) == {"ok"}
    count = int(found["n_crossings"])
    assert count
    for i in range(count):
        one = found.isel(crossing=i)
        mode = int(one["crossing_mode"]) - 1
        multiple = float(one["crossing_multiple"])

        def detuning(speed: float, mode: int = mode, multiple: float = multiple) -> float:
            cycle, modes, (of_cycle, *_) = frequencies(Parameters(Omega=speed, **base))
            if np.isfinite(of_cycle[mode]):
                own = of_cycle
            else:
                own = modes.frequency
            return multiple / cycle.period - float(own[mode])

        speed = float(one["crossing_Omega"])
        # the line bends by f_s'' d^2 / 8 between speeds, some 0.05 Hz of a slope of some Hz per
        # rad/s
        assert speed == pytest.approx(
            brentq(detuning, speed - 0.25, speed + 0.25, xtol=1e-6), abs=0.02
        )
        assert words(one, "crossing_line") == "stick_slip"


def made_up(**changes: Any) -> xr.Dataset:
    """f_s = 10 Omega, a mode at 100 Hz with l = 1: crossings of n f_s at 20 / 2 n, of f_Omega at
    200 pi."""
    speeds = np.linspace(8, 12, 401)
    rate = -0.2 + 0.1 / (1 + ((speeds - 10) / 0.02) ** 2)
    values = {
        "growth_rate": rate,
        "stick_slip_frequency": 10 * speeds,
        "rotation_frequency": speeds / (2 * np.pi),
        "diameters": np.ones((401, 1), int),
        "sliding_frequency": np.full((401, 1), 100.0),
        "cycle_frequency": np.full((401, 1), 100.0),
        "mac": np.ones((401, 1)),
        "cycle_growth_rate": rate[:, None],
    } | changes
    dims = {1: "Omega", 2: ("Omega", "mode")}
    made = {name: (dims[value.ndim], value) for name, value in values.items()}
    made["status"] = ("Omega", np.zeros(401, int), {"flag_meanings": "ok excluded"})
    return xr.Dataset(made, {"Omega": speeds, "mode": [1]})


def effects(cell: xr.Dataset, **options: Any) -> list[str]:
    return Campbell(**options).summarise(cell)["crossing_effect"]


def test_a_growth_rate_that_rises_at_the_crossing_is_told_from_one_that_does_not() -> None:
    """The line meets the mode at 10 rad/s; the window of 1 Hz is 0.1 rad/s there on either side."""
    peak = made_up()
    found = Campbell().summarise(peak)
    assert found["n_crossings"] == 1
    assert found["crossing_Omega"][0] == pytest.approx(10, abs=1e-9)
    assert found["crossing_line"] == ["stick_slip"]
    assert found["crossing_multiple"][0] == 1
    assert found["crossing_growth_rate"][0] == pytest.approx(-0.1)
    # at the window's ends, one step beyond it, the peak has fallen to 1 / (1 + 5.5^2)
    assert found["crossing_rise"][0] == pytest.approx(0.1 - 0.1 / (1 + 5.5**2), rel=1e-3)
    assert effects(peak) == ["rises"]
    assert effects(peak, min_rise=0.2) == ["no_rise"]
    rate = peak["growth_rate"].values
    raised = made_up(growth_rate=rate + 0.15, cycle_growth_rate=rate[:, None] + 0.15)
    assert effects(raised) == ["destabilises"]
    assert effects(made_up(growth_rate=np.full(401, -0.05))) == ["mode_rises"]
    flat = made_up(growth_rate=np.full(401, -0.1), cycle_growth_rate=np.full((401, 1), -0.1))
    assert effects(flat) == ["no_rise"]
    lost = np.abs(peak["Omega"].values - 10.05) < 0.01
    assert effects(made_up(growth_rate=np.where(lost, np.nan, rate))) == ["no_cycle"]
    assert effects(made_up(cycle_growth_rate=np.full((401, 1), np.nan))) == ["unresolved"]
    assert effects(peak.isel(Omega=slice(0, 401, 20))) == ["unresolved"]
    assert effects(peak.isel(Omega=slice(195, 401))) == ["unresolved"]
