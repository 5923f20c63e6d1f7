"""Measures of cases against numbers that are counted by hand."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
import xarray as xr

from disc_model.data.dataset import Missing
from disc_model.data.variables import STATUSES
from disc_model.parameters import Parameters
from tests.paper.evidence import kept_events
from workflow.paper import measures
from workflow.paper.measures import CaseView, Range, Signal

P = Parameters(N=385, Omega=20)


def view(events: Sequence[tuple[Any, ...]] = (), **scalars: float) -> CaseView:
    """Return a case of 100 s that keeps its events from 90 s on, and a history of bins of 0.5 s.

    The range of P rises from 10 N by 1 N/s; that of w_point grows at 0.02/s.
    """
    known = {
        "N": P.N,
        "Omega": P.Omega,
        "status": STATUSES.index("ok"),
        "first_separation": 60.0,
        "n_separations": 7,
        "time_reached": 100.0,
        "time_stick": 25.0,
        **scalars,
    }
    time = np.arange(0.25, 100, 0.5)
    width = np.exp(0.02 * time)
    history = xr.Dataset(
        {
            "P_min": ("time", 380 - time),
            "P_max": ("time", np.full(time.size, 390.0)),
            "w_point_min": ("time", -0.25 * width),
            "w_point_max": ("time", 0.75 * width),
        },
        {"time": time},
    )
    groups = {
        "/": xr.Dataset(known, attrs={"parameters": P.canonical_json}),
        "/history": history,
        "/events": kept_events(events, 90.0, 110.0),
    }
    return CaseView("made up", xr.DataTree.from_dict(groups))


def separations(*spans: tuple[float, float]) -> list[tuple[Any, ...]]:
    """Return events of separations from 90 s on; the slider sticks first, for 2 s, and then slips."""
    rows: list[tuple[Any, ...]] = [
        (90.0, "slip_to_stick", "stick"),
        (92.0, "stick_to_slip", "slip"),
    ]
    for begin, end in spans:
        rows.append((begin, "separation", "separation"))
        if math.isfinite(end):
            rows.append((end, "reattachment", "slip"))
    return rows


# ---- Events


@pytest.mark.parametrize(
    ("spans", "longest"),
    [
        ([(93, 93.25), (94, 94.75), (95, 95.5)], 0.75),
        ([(93, 93.25), (94, 94.5), (98, math.inf)], 2.0),  # it lasts until 100 s at least
        ([(93, 93.25), (94, 94.5), (99.75, math.inf)], 0.5),
        ([(94, 94.5)], 0.5),
    ],
)
def test_the_longest_separation_may_be_one_that_goes_on(
    spans: list[tuple[float, float]], longest: float
) -> None:
    assert view(separations(*spans)).longest_separation == pytest.approx(longest, abs=1e-12)


def test_a_separation_from_before_the_kept_events_has_no_length() -> None:
    before: list[tuple[Any, ...]] = [(91.0, "reattachment", "slip")]
    after = separations((93, 93.25))[2:]
    assert view(before + after).longest_separation == pytest.approx(0.25, abs=1e-12)
    for rows in (before, before + after[:1]):
        with pytest.raises(Missing, match="case made up keeps no whole separation"):
            _ = view(rows).longest_separation


def test_shares_and_rates_are_those_of_the_time_for_which_events_are_kept() -> None:
    case = view(separations((93, 94), (95, 96), (97, 97.5)))
    assert case.kept_span == Range(90.0, 100.0)  # the run ended before 110 s
    assert case.stick == pytest.approx(0.2)
    assert case.phase_share("separation") == pytest.approx(0.25)
    assert case.phase_share("slip") == pytest.approx(0.55)
    assert case.stick_in_all == 0.25
    assert case.rate_of("separation") == pytest.approx(0.3)
    assert case.rate_of("stick_to_slip") == pytest.approx(0.1)
    assert case.times_of("reattachment").tolist() == [94, 96, 97.5]


def test_events_are_kept_to_the_end_that_comes_first() -> None:
    assert view(time_reached=120.0).kept_span == Range(90.0, 110.0)


def test_intervals_need_enough_releases() -> None:
    times = 90 + 0.5 * np.arange(measures.FEWEST + 1)
    rows = [(time, "stick_to_slip", "slip") for time in times]
    np.testing.assert_allclose(view(rows).intervals(), np.full(measures.FEWEST, 0.5))
    with pytest.raises(Missing, match=f"keeps fewer than {measures.FEWEST} stick-slip cycles"):
        view(rows[:-1]).intervals()
    with pytest.raises(Missing, match=f"keeps fewer than {measures.FEWEST} separations"):
        view(rows).intervals("separation")


def test_a_period_is_told_in_releases_separations_and_seconds() -> None:
    """Each third interval is longer, and contact is lost once in each."""
    intervals = np.tile([0.01, 0.01, 0.02], 160)
    times = 90 + np.concatenate([[0.0], np.cumsum(intervals)])
    rows = [(time, "stick_to_slip", "slip") for time in times]
    assert view(rows, time_reached=96.4).motion == (
        "periodic: it repeats after 3 releases, every 0.04 s"
    )
    for time in times[:-1:3]:
        rows.append((time + 0.001, "separation", "separation"))
        rows.append((time + 0.002, "reattachment", "slip"))
    assert view(sorted(rows), time_reached=96.4).motion == (
        "periodic: it repeats after 3 releases and 1 separation, every 0.04 s"
    )


def test_up_to_half_of_the_intervals_a_motion_is_seen_not_to_repeat() -> None:
    """Sixty intervals that turn by the golden mean."""
    turns = 0.618034 * np.arange(60) % 1
    intervals = 0.01 + 0.001 * turns
    times = 90 + np.concatenate([[0.0], np.cumsum(intervals)])
    rows = [(time, "stick_to_slip", "slip") for time in times]
    said = view(rows, time_reached=91.0).motion
    assert "it does not repeat after any number of releases up to 30, " in said
    assert "the 0-1 test for chaos gives" in said


# ---- Ranges


def test_ranges_are_those_of_the_bins_between_two_times() -> None:
    case = view()
    assert case.range_of("P", 10.0, 20.0) == Range(380 - 19.75, 390.0)
    assert case.early == Range(380 - 20.75, 390.0)  # 1 to 21 s
    assert case.late == Range(380 - 99.75, 390.0)
    width = np.exp(0.02 * 99.75)
    assert case.disc == pytest.approx((-0.25 * width, 0.75 * width))
    # bins that are cut do not count
    assert case.range_of("P", 9.8, 20.2) == Range(380 - 19.75, 390.0)
    with pytest.raises(Missing, match=r"has no history from 10 to 10\.4 s"):
        case.range_of("P", 10.0, 10.4)


def test_last_stretches_come_last_first() -> None:
    case = view()
    widths = [10 + 99.75, 10 + 89.75, 10 + 79.75]
    assert case.last_widths("P", 10.0, 3) == pytest.approx(widths)
    # quarters of the 40 s after the first separation
    assert case.last_quarters("P") == pytest.approx(widths[:2])


def test_the_slope_of_a_range_is_a_growth_rate() -> None:
    case = view()
    assert case.slope("w_point", 10.0, 50.0) == pytest.approx(0.02, rel=1e-10)
    with pytest.raises(Missing, match=r"has no history from 10 to 11\.7 s"):
        case.slope("w_point", 10.0, 11.7)
    flat = case.node.copy(deep=True)
    flat["history"] = xr.DataTree(flat["history"].to_dataset().assign(P_min=lambda h: h["P_max"]))
    with pytest.raises(Missing, match="has no vibration in P from 10 to 50 s"):
        CaseView("flat", flat).slope("P", 10.0, 50.0)


def test_four_bins_are_enough_for_a_slope_if_none_is_still() -> None:
    case = view()
    slope = case.slope("w_point", 10.0, 12.0)
    assert slope == pytest.approx(0.02, rel=1e-10)
    node = case.node.copy(deep=True)
    history = node["history"].to_dataset()
    low = history["w_point_min"].copy()
    low[21] = history["w_point_max"][21]
    still = history.assign(w_point_min=low)
    node["history"] = xr.DataTree(still)
    one = CaseView("one", node)
    with pytest.raises(Missing, match="has no vibration in w_point from 10 to 50 s"):
        one.slope("w_point", 10.0, 50.0)


def test_a_range_has_a_width_and_one_number_if_its_ends_are_equal() -> None:
    assert Range(-2.0, 3.5).width == 5.5
    assert f"{Range(-2.0, 3.5):.1f}" == "-2.0 to 3.5"
    assert f"{Range(2.0, 2.0):g}" == "2"
    assert measures.extent([3, -1, 2]) == Range(-1, 3)


# ---- Words


def test_a_case_is_told_by_place_contact_and_drive() -> None:
    case = view()
    assert case.place == "385 N, 20 rad/s"
    assert case.contact == "contact is lost at 60.00 s"
    assert view(first_separation=math.nan).contact == "contact is kept for 100 s"
    assert case.drive == pytest.approx(20 / math.tau)
    assert case.separates
    assert not view(n_separations=0).separates
    assert case.status == "ok"
    assert case.from_rest
    assert not case.is_grid
    assert not case.bilateral


def test_a_place_has_the_numbers_that_differ_from_table_1_and_no_words() -> None:
    case = view()
    other = P.replace(c=0.1, normalization="orthonormal")
    case.node.attrs["parameters"] = other.canonical_json
    assert case.place == "385 N, 20 rad/s, c = 0.1 N s/m"


@pytest.mark.parametrize(
    ("rate", "text"), [(0.12345, "+0.1235/s"), (-0.5, "-0.5000/s"), (math.nan, "no cycle")]
)
def test_rates_have_their_sign(rate: float, text: str) -> None:
    assert measures.rate_text(rate, "/s") == text


# ---- Signals

TIME = np.arange(0, 20, 1 / 2000)


def signal(*lines: tuple[float, float]) -> Signal:
    """Return a sum of lines: frequency in Hz and amplitude."""
    values = np.zeros(TIME.size)
    for frequency, amplitude in lines:
        values += amplitude * np.cos(2 * np.pi * frequency * TIME)
    return Signal("made up", "window", TIME, values)


def test_lines_of_a_signal_are_counted_from_the_strongest() -> None:
    found = signal((50.0, 1.0), (120.0, 3.0), (310.0, 2.0))
    assert [line.frequency for line in found.lines()] == pytest.approx([50, 120, 310], abs=1e-3)
    assert [line.frequency for line in found.lines(2)] == pytest.approx([120, 310], abs=1e-3)
    assert [line.frequency for line in found.lines(1, below=100.0)] == pytest.approx([50], abs=1e-3)
    with pytest.raises(Missing, match="case made up has no line in the spectrum of window"):
        found.lines(above=400.0)


def test_power_above_a_frequency_is_a_share_of_that_above_20_Hz() -> None:
    found = signal((10.0, 9.0), (50.0, 1.0), (310.0, 2.0))
    assert found.power_above(200.0) == pytest.approx(4 / 5, rel=1e-6)
    with pytest.raises(Missing):
        signal((10.0, 9.0)).power_above(200.0)


def test_fuzz_fills_the_spectrum_from_20_to_300_Hz_and_lines_do_not() -> None:
    lines = signal((50.0, 1.0), (120.0, 1.0))
    noise = np.random.default_rng(0).standard_normal(TIME.size)
    fuzz = lines._replace(values=lines.values + 0.2 * noise)
    assert lines.filled < 0.01
    assert fuzz.filled > 0.9
    above = signal((50.0, 1.0), (120.0, 1.0), *[(f, 1.0) for f in np.arange(305.0, 700, 0.5)])
    assert above.filled < 0.03


# ---- Several cases and grid studies


def test_a_ratio_needs_a_positive_denominator() -> None:
    assert measures.ratio(3.0, 4.0, "the width") == 0.75
    for whole in (0.0, -1.0, math.nan):
        with pytest.raises(Missing, match="the width is"):
            measures.ratio(3.0, whole, "the width")
