"""Campbell diagrams: rows of the table, crossings against root finding, and what growth rates do
there."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray as xr
from disc_model.studies.merge import summarised
from scipy.optimize import brentq

import disc_model as dm
from disc_model.data.variables import CycleStatus, flag_names
from disc_model.parameters import Parameters
from disc_model.stability.cycle import FloquetResult
from disc_model.stability.frequencies import frequencies
from disc_model.studies.quantities.campbell import Campbell, Rates, effect_of, frequency_of
from disc_model.studies.quantity import Point
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
        "near_motion": np.full(401, np.nan),
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
    square = 5.5**2
    beside = 0.1 / (1 + square)
    rise = found["crossing_rise"][0]
    assert rise == pytest.approx(0.1 - beside, rel=1e-3)
    assert effects(peak) == ["rises"]
    assert effects(peak, min_rise=0.2) == ["no_rise"]
    rate = peak["growth_rate"].values
    raised = made_up(growth_rate=rate + 0.15, cycle_growth_rate=rate[:, None] + 0.15)
    assert effects(raised) == ["destabilises"]
    assert effects(made_up(growth_rate=np.full(401, -0.05))) == ["mode_rises"]
    level = np.full(401, -0.1)
    flat = made_up(growth_rate=level, cycle_growth_rate=level[:, None])
    assert effects(flat) == ["no_rise"]
    speeds = peak["Omega"].values
    lost = np.abs(speeds - 10.05) < 0.01
    broken = made_up(growth_rate=np.where(lost, np.nan, rate))
    assert effects(broken) == ["no_cycle"]
    away = np.where(lost, 0.0, np.nan)
    assert effects(made_up(near_motion=away)) == ["not_near"]
    unknown = np.full((401, 1), np.nan)
    without = made_up(cycle_growth_rate=unknown)
    assert effects(without) == ["unresolved"]
    coarse = peak.isel(Omega=slice(0, 401, 20))
    assert effects(coarse) == ["unresolved"]


@pytest.mark.parametrize(
    ("ends", "within", "effect"),
    [
        ((-0.05, 0.02), 0.025, "no_rise"),  # unstable at one end already
        ((0.02, -0.05), 0.025, "no_rise"),
        ((0.02, -0.05), 0.035, "rises"),
        ((0.0, -0.05), 0.005, "destabilises"),
        ((-0.05, -0.01), 0.005, "destabilises"),
        ((-0.05, -0.01), -0.005, "no_rise"),
        ((-0.05, -0.02), -0.005, "rises"),
    ],
)
def test_a_rise_is_one_above_both_ends_of_the_window(
    ends: tuple[float, float], within: float, effect: str
) -> None:
    """Of the cycle and of the second of two modes; speeds beyond the window count for nothing."""
    detuning = np.array([2.0, 1.2, 0.8, 0.4, -0.1, -0.4, -0.8, -1.2, -2.0])
    first, last = ends
    leading = np.array([0.5, first, *[-0.2] * 2, within, *[-0.2] * 2, last, 0.5])
    growth = np.column_stack([np.full(9, -0.3), leading])
    rates = Rates(growth, leading, np.zeros(9, dtype=bool), np.zeros(8, dtype=bool))
    found = effect_of(detuning, 3, rates, Campbell())
    assert found["effect"] == effect
    assert found["growth_rate"] == within
    assert found["rise"] == pytest.approx(within - max(ends), abs=1e-12)
    assert found["growing_mode"] == 2


def found_crossings(cell: xr.Dataset) -> list[tuple[float, float, int, str, float]]:
    """Speed, frequency, mode, line and multiple of each crossing."""
    found = Campbell().summarise(cell)
    names = ("Omega", "frequency", "mode", "line", "multiple")
    columns = [found[f"crossing_{name}"] for name in names]
    return list(zip(*columns, strict=True))


def test_modes_cross_multiples_and_halves_of_f_s_and_turns_up_to_their_diameters() -> None:
    """The mode has 100 Hz at all speeds; the frequencies that it meets are made up."""
    speeds = np.linspace(8, 12, 401)
    steep = made_up(stick_slip_frequency=20 * speeds)
    [half] = found_crossings(steep)
    speed, frequency, *line = half
    assert line == [1, "stick_slip", 0.5]
    assert speed == pytest.approx(10.0)
    assert frequency == pytest.approx(100.0)

    # 2.5 f_s, and 3 f_s at the end of the axis
    gentle = made_up(stick_slip_frequency=4 * speeds - 0.01)
    third, second = found_crossings(gentle)
    assert third[4] == 3.0
    assert second[4] == 2.5
    assert third[0] == pytest.approx((100 / 3 + 0.01) / 4)
    assert second[0] == pytest.approx(10.0025)

    # a table with room for one only has both
    short = summarised(gentle, Campbell(max_crossings=1))
    assert short["n_crossings"] == 2
    assert short["crossing"].values.tolist() == [1, 2]
    assert np.isfinite(short["crossing_Omega"]).all()
    assert summarised(gentle, Campbell()).sizes["crossing"] == 100

    turning = {"rotation_frequency": 5.02 * speeds, "stick_slip_frequency": np.full(401, np.nan)}
    assert Campbell().summarise(made_up(**turning))["n_crossings"] == 0  # of l = 1 only once
    three = found_crossings(made_up(**turning, diameters=np.full((401, 1), 3)))
    assert [row[2:] for row in three] == [(1, "rotation", 2.0)]
    assert three[0][:2] == pytest.approx((100 / 10.04, 100.0))


def test_frequencies_without_a_multiplier_are_those_of_sliding_with_the_difference() -> None:
    speeds = np.linspace(8, 12, 401)
    sliding = 100 + 0.5 * speeds[:, None]
    mac = np.ones((401, 1))
    mac[150:250] = 0.74  # resembles another shape as much
    of_cycle = sliding + np.where(mac < 0.75, 40.0, 0.2 * (speeds - 8)[:, None])
    cell = made_up(sliding_frequency=sliding, cycle_frequency=of_cycle, mac=mac).isel(mode=0)
    expected = sliding[:, 0] + 0.2 * (speeds - 8)
    np.testing.assert_allclose(frequency_of(cell), expected, rtol=1e-12)
    none = made_up(sliding_frequency=sliding, mac=0 * mac).isel(mode=0)
    np.testing.assert_array_equal(frequency_of(none), sliding[:, 0])


def test_a_window_of_two_speeds_says_nothing() -> None:
    """At least three lie within; those of the ends do not count."""
    peak = made_up()
    at = [0, 150, 190, 199, 201, 205, 250, 400]
    assert effects(peak.isel(Omega=at)) == ["rises"]
    assert effects(peak.isel(Omega=[0, 150, 199, 201, 250, 400])) == ["unresolved"]


def test_columns_are_those_of_the_cycle_and_of_the_modes(monkeypatch: pytest.MonkeyPatch) -> None:
    status = {"ok": CycleStatus.OK, "none": CycleStatus.NO_CYCLE}
    modes = SimpleNamespace(
        diameters=np.array([-1, 0, 2]),
        forward=np.array([0.5, 0.5, 0.9]),
        frequency=np.array([71.0, 130, 140]),
        growth_rate=np.array([-0.1, -0.2, -0.3]),
    )
    columns = np.arange(9.0).reshape(3, 3)
    for word, releases in (("ok", 2), ("none", 0)):
        case = Parameters(N=200, Omega=11)
        cycle = FloquetResult(
            case, 1e-12, status[word], "", growth_rate=-0.05, releases=releases, period=0.03
        )
        monkeypatch.setattr(
            "disc_model.stability.frequencies.frequencies",
            lambda p, tol, cycle=cycle: (cycle, modes, columns),
        )
        values, message = Campbell().compute_point(Point(case))
        assert message == ("" if word == "ok" else CycleStatus.NO_CYCLE.advice)
        if word == "ok":
            rate = 2 / 0.03
        else:
            rate = np.nan
        assert values["stick_slip_frequency"] == pytest.approx(rate, nan_ok=True)
    assert values["rotation_frequency"] == pytest.approx(11 / (2 * np.pi))
    assert values["n_modes"] == 3
    assert values["largest_sliding_growth_rate"] == dm.steady_sliding(case).growth_rate
    assert values["diameters"].tolist() == [0, 0, 2]
    kinds = Campbell.COLUMNS["mode_kind"].flags
    assert [kinds[code] for code in values["mode_kind"]] == ["slider", "disc", "disc"]
    assert values["sliding_frequency"].tolist() == [71, 130, 140]
    assert values["sliding_growth_rate"].tolist() == [-0.1, -0.2, -0.3]
    assert values["cycle_frequency"].tolist() == [0, 1, 2]
    assert values["cycle_growth_rate"].tolist() == [3, 4, 5]
    assert values["mac"].tolist() == [6, 7, 8]
    assert values["forward_wave_fraction"].tolist() == [0.5, 0.5, 0.9]


@pytest.mark.parametrize(("diameters", "count"), [(1, 0), (2, 1)])
def test_turns_count_up_to_the_greatest_number_of_diameters(diameters: int, count: int) -> None:
    """The mode has 100 Hz, and the drive 50 Hz at 10 rad/s."""
    speeds = np.linspace(8, 12, 401)
    none = np.full(401, np.nan)
    numbers = np.full((401, 1), diameters)
    turning = made_up(rotation_frequency=5 * speeds, stick_slip_frequency=none, diameters=numbers)
    summary = Campbell().summarise(turning)
    assert summary["n_crossings"] == count


STEEL = {
    "N": 5000,
    "E": 210e9,
    "rho": 7850,
    "nu": 0.3,
    "h": 6e-3,
    "m": 0.3,
    "k": 5e5,
    "k_p": 2e5,
    "c_p": 20,
    "mu_s": 0.45,
    "mu_k": 0.35,
    "damping_ratio": 5e-4,
    "normalization": "orthonormal",
    "friction_offset": "surface",
    "contact_arc": 0.4,
    "n_diameters": 6,
}
"""A disc with 14 modes, of which the eleventh to the thirteenth may be the most unstable ones."""


def campbell_of_steel(**options: Any) -> xr.Dataset:
    """A study of this disc at two speeds."""
    speeds = {"Omega": [60, 61]}
    return computed(quantity="campbell", options=options, base=STEEL, axes=speeds)


@pytest.fixture(scope="module")
def largest_of_steel() -> float:
    """The largest growth rate of all modes at the first speed."""
    sliding = dm.steady_sliding(Parameters(Omega=60, **STEEL))
    return sliding.growth_rate


def test_the_most_unstable_mode_has_room(largest_of_steel: float) -> None:
    """Of 14 modes 12 had room, and their largest growth rate was 2.16/s; that of all is 2.39/s."""
    study = campbell_of_steel()
    of_modes = study["sliding_growth_rate"].sel(Omega=60)
    assert largest_of_steel == pytest.approx(2.39, abs=0.005)
    assert of_modes.max().item() == pytest.approx(largest_of_steel)
    assert study["n_modes"].values.tolist() == [14, 14]


def test_the_most_unstable_mode_is_known_whatever_the_room(largest_of_steel: float) -> None:
    study = campbell_of_steel(modes=12)
    first = study.sel(Omega=60)
    of_modes = first["sliding_growth_rate"]
    of_all = first["largest_sliding_growth_rate"]
    assert of_modes.max().item() < 2.2
    assert of_all.item() == pytest.approx(largest_of_steel)


def test_modes_without_room_are_counted_and_told() -> None:
    study = campbell_of_steel(modes=12)
    assert study["n_modes"].values.tolist() == [14, 14]
    for message in study["message"].values:
        assert message.endswith("room for 12: raise modes")


@pytest.mark.compiled
def test_a_study_says_where_the_motion_is_not_near_the_cycle() -> None:
    """Its growth rate of 0.28/s stood for that of a motion near another cycle, of 0.0004/s."""
    axes = {"Omega": [7.3, 7.35, 7.4]}
    found = computed(quantity="campbell", options={}, base={"N": 375}, axes=axes)
    assert (found["near_motion"] == 0).values.tolist() == [False, True, False]
    assert found["growth_rate"].values[1] == pytest.approx(0.2789, abs=1e-4)
