"""The speed of onset, and every crossing."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray as xr

from disc_model.data.variables import Outcome, flag_names
from disc_model.errors import Status
from disc_model.parameters import Parameters
from disc_model.stability.follower import OutcomeResult
from disc_model.studies.quantities.critical_speed import (
    CriticalSpeed,
    _crossings,
    _first_separation,
    _middles,
)
from disc_model.studies.quantity import Point
from tests.studies.conftest import SCAN, compute


def test_every_crossing_is_found(speeds: xr.Dataset) -> None:
    one = speeds.squeeze("normalization")
    longest = one.sel(horizon=1000)
    # 2e5/200 = 1000 s at 12 rad/s: from 12.4 on it is less
    assert longest["critical_speed"].values.tolist() == [12.4, 12.4]
    assert longest["n_crossings"].values.tolist() == [1, 1]
    kinds = flag_names(longest["crossing_kind"].sel(N=200))
    assert kinds[:2].tolist() == ["begins", "none"]
    # at 200 N 900 s are reached at 14 rad/s only; then comes the gap, which the scan of 0.5 rad/s
    # steps over
    shorter = one.sel(horizon=900, N=200)
    assert shorter["critical_speed"] == 14.0
    assert one["simulations"].sel(N=200) > 7
    assert flag_names(one["status"]).tolist() == ["ok", "ok"]


@pytest.mark.parametrize(("lost", "lowest"), [(13.0, np.nan), (14.5, 14.0)])
def test_a_speed_that_failed_hides_those_above_it(
    lost: float, lowest: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Separation comes from 14 rad/s on, as far as is known."""

    def motion(p: Parameters, horizon: float, **_: Any) -> OutcomeResult:
        if p.Omega == lost:
            return OutcomeResult(failed=SimpleNamespace(status=Status.NON_FINITE, message="lost"))
        first = np.nan
        if p.Omega >= 14:
            first = 10.0
        return OutcomeResult(first_separation=first)

    monkeypatch.setattr("disc_model.stability.follower.find_outcome", motion)
    options = CriticalSpeed.model_validate({"horizons": [900], "scan": SCAN, "precision": 0.1})
    found = compute(options, [Point(Parameters(N=200, Omega=1))])
    np.testing.assert_array_equal(found.arrays["critical_speed"], [[lowest]])
    assert found.messages == [f"Omega = {lost:g} rad/s: lost"]


INF = np.inf
ON_LATTICE = {0: INF, 4: 90.0, 5: 20.0, 9: INF, 20: np.nan, 21: 5.0}
"""First separations in s by places on the lattice of the precision."""


def test_intervals_in_which_separation_begins_or_ends_are_halved() -> None:
    assert _middles(ON_LATTICE, 100.0) == [2, 7]
    assert _middles(ON_LATTICE, 50.0) == [7], "between 4 and 5 there is no place"
    assert _middles(ON_LATTICE, 10.0) == [], "and beside what is unknown none is looked for"


@pytest.mark.parametrize(
    ("horizon", "lowest", "speeds", "kinds"),
    [
        (100.0, 4.0, [4.0, 9.0], ["begins", "ends"]),
        (90.0, 4.0, [4.0, 9.0], ["begins", "ends"]),  # at the horizon itself
        (50.0, 5.0, [5.0, 9.0], ["begins", "ends"]),
        (10.0, np.nan, [], []),  # a speed that is unknown hides the one above it
    ],
)
def test_a_crossing_is_the_upper_end_of_its_interval(
    horizon: float, lowest: float, speeds: list[float], kinds: list[str]
) -> None:
    found = _crossings(ON_LATTICE, horizon, float)
    np.testing.assert_equal(found["critical_speed"], lowest)
    assert found["crossing"] == speeds
    assert found["crossing_kind"] == kinds
    assert found["n_crossings"] == len(speeds)


def test_a_motion_without_separation_separates_never_unless_it_failed() -> None:
    assert _first_separation(OutcomeResult(first_separation=3.0)) == 3.0
    assert _first_separation(OutcomeResult()) == INF
    lost: Any = SimpleNamespace(status=Status.NON_FINITE, message="lost")
    assert np.isnan(_first_separation(OutcomeResult(failed=lost)))


def test_all_simulations_are_counted_with_their_time(monkeypatch: pytest.MonkeyPatch) -> None:
    followed = []

    def motion(p: Parameters, horizon: float, **_: Any) -> OutcomeResult:
        followed.append(p.Omega)
        return OutcomeResult(simulated=10.0 + len(followed))

    monkeypatch.setattr("disc_model.stability.follower.find_outcome", motion)
    options = CriticalSpeed.model_validate({"horizons": [900], "scan": SCAN, "precision": 0.1})
    found = compute(options, [Point(Parameters(N=200, Omega=1))]).arrays
    assert followed == [12, 12.5, 13, 13.5, 14, 14.5, 15]
    assert found["simulations"].tolist() == [7]
    assert found["simulated_time"].tolist() == [70.0 + 28.0]


def test_simulations_of_the_bisection_are_counted_with_their_time(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Separation begins between 13 and 13.5 rad/s, five places of 0.1 rad/s apart."""

    def motion(p: Parameters, horizon: float, **_: Any) -> OutcomeResult:
        first = np.nan
        if p.Omega >= 13.4:
            first = 10.0
        return OutcomeResult(simulated=2.0, first_separation=first)

    monkeypatch.setattr("disc_model.stability.follower.find_outcome", motion)
    options = CriticalSpeed.model_validate({"horizons": [900], "scan": SCAN, "precision": 0.1})
    found = compute(options, [Point(Parameters(N=200, Omega=1))]).arrays
    count = int(found["simulations"][0])
    assert count > 7
    assert found["simulated_time"].tolist() == [2.0 * count]
    assert found["critical_speed"].tolist() == [[13.4]]


def test_a_separation_after_an_extrapolation_counts_and_has_no_time(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It is compared with the horizon; its time is known to a hundredth only."""

    def motion(p: Parameters, horizon: float, **_: Any) -> OutcomeResult:
        if p.Omega < 13:
            return OutcomeResult(Outcome.STICK_SLIP)
        rough = p.Omega < 14
        return OutcomeResult(Outcome.SEPARATION, first_separation=100.0, extrapolated=rough)

    monkeypatch.setattr("disc_model.stability.follower.find_outcome", motion)
    options = CriticalSpeed.model_validate({"horizons": [900], "scan": SCAN, "precision": 0.1})
    found = compute(options, [Point(Parameters(N=200, Omega=1))]).arrays
    assert found["critical_speed"].tolist() == [[13.0]]
    # from 12 to 15 rad/s in steps of 0.5 rad/s
    times = [np.nan] * 4 + [100.0] * 3
    np.testing.assert_array_equal(found["scan_first_separation"], [times])


RESULTS = Path(__file__).parents[3] / "results"


@pytest.mark.skipif(
    not (RESULTS / "map_N" / "map_N.nc").exists(), reason="needs results/map_N, by `make reproduce`"
)
@pytest.mark.parametrize(
    ("study", "least"), [("critical_speed", 30), ("critical_speed_orthonormal", 60)]
)
def test_scan_and_map_of_the_results_agree(study: str, least: int) -> None:
    """At 510 N and 12 rad/s and four more common points the map had inferred, or extrapolated,
    another outcome than the scan; where it was simulated, first separations differed by up to a
    third in regular motions, too."""
    scan, mapped = (xr.load_dataset(RESULTS / name / f"{name}.nc") for name in (study, "map_N"))
    scan = scan.squeeze("normalization").rename(scan_Omega="Omega")
    scan, mapped = xr.align(scan, mapped.sel(normalization=scan["normalization"]), join="inner")
    assert mapped["outcome"].size >= least
    in_map = xr.DataArray(
        flag_names(mapped["outcome"]) == "separation", dims=mapped["outcome"].dims
    )
    # both have a horizon of 1000 s
    in_scan = xr.DataArray(
        flag_names(scan["scan_outcome"]) == "separation", dims=scan["scan_outcome"].dims
    )
    assert (in_scan == in_map).all()
    simulated = mapped["first_separation"].values
    wanted = scan["scan_first_separation"].transpose(*mapped["first_separation"].dims).values
    # of extrapolated motions neither has a time
    there = np.isfinite(simulated) & np.isfinite(wanted)
    assert there.any()
    # both follow the same motion; the map's rougher steps matter where it is irregular before
    apart = np.abs(simulated[there] / wanted[there] - 1)
    assert np.median(apart) < 1e-6
