"""Stretches of stick, slip and separation between events."""

import json

import numpy as np
import pytest
import xarray as xr

from disc_model.data.dataset import Missing
from disc_model.data.variables import PHASES
from disc_model.figures.runs import spans_between, spans_in
from disc_model.figures.stated_case import _course, ramps_of
from disc_model.parameters import Parameters

TIMES = [0.0, 1.0, 2.0, 2.5, 4.0]  # s
WORDS = ["slip", "stick", "slip", "slip", "separation"]
"""A reversal of slip at 2.5 s is no border."""
FLAGS = {"flag_meanings": " ".join(PHASES), "flag_values": [*range(len(PHASES))]}


def run(**kept: float) -> xr.DataTree:
    """A case with events, each with the phase that it begins, and a window of samples."""
    phase = [PHASES.index(word) for word in WORDS]
    events = xr.Dataset(
        {"time": ("event", TIMES), "phase": ("event", np.array(phase, np.int8), FLAGS)}, attrs=kept
    )
    time = np.arange(0.5, 4.6, 1.0)
    words = [WORDS[np.searchsorted(TIMES, each, "right") - 1] for each in time]
    codes = np.array([PHASES.index(word) for word in words], np.int8)
    window = xr.Dataset({"phase": ("time", codes, FLAGS)}, {"time": time})
    return xr.DataTree.from_dict({"/": xr.Dataset(), "/events": events, "/window": window})


def test_borders_are_events_and_the_first_phase_is_that_before() -> None:
    spans = spans_between(run(), 0.5, 4.5)
    assert spans["slip"] == [(0.5, 1.0), (2.0, 4.0)]
    assert spans["stick"] == [(1.0, 2.0)]
    assert spans["separation"] == [(4.0, 4.5)]
    inside = spans_between(run(), 1.2, 1.8)
    assert inside["stick"] == [(1.2, 1.8)]
    assert inside["slip"] == inside["separation"]
    assert inside["separation"] == []


@pytest.mark.parametrize(
    ("kept", "start"), [({"kept_from": 1.0}, 0.5), ({"kept_until": 4.0}, 0.5), ({}, -1.0)]
)
def test_events_that_were_not_kept_are_missed(kept: dict[str, float], start: float) -> None:
    with pytest.raises(Missing, match="keeps no events"):
        spans_between(run(**kept), start, 4.5)


def test_samples_stand_in_for_events_that_were_not_kept() -> None:
    case = run(kept_from=3.0)
    spans = spans_in(case, case["window"].to_dataset())
    assert spans["stick"] == [(1.0, 2.0)], "halfway between samples"
    assert spans["slip"] == [(0.5, 1.0), (2.0, 4.0)]
    assert spans["separation"] == [(4.0, 4.5)]


def test_ramps_are_told_in_the_order_of_their_times() -> None:
    up = {"parameter": "Omega", "to": 16.0, "start": 0.0, "end": 0.1}
    down = {"parameter": "Omega", "to": 8.0, "start": 0.2, "end": 0.3}
    other = {"parameter": "N", "to": 300.0, "start": 0.1, "end": 0.2}
    attrs = {
        "parameters": Parameters(N=385, Omega=15.1).canonical_json,
        "ramps": json.dumps([down, other, up]),
    }
    run = xr.DataTree(xr.Dataset(attrs=attrs))
    said = _course("Omega", ramps_of(run))
    assert said == "Ω = 15.1 to 16 to 8 rad/s"
