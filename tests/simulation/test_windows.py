"""What a simulation keeps: windows, envelopes, samples by the drive; and which records are
refused."""

import json
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from disc_model import Parameters, Poincare, Ramp, Window, simulate
from disc_model.simulation.case import CaseSpec, Start, resolved_windows
from tests.refusals import refusal

P = Parameters(N=200, Omega=50, n_diameters=1)
ONE = Window(rate=10)


def test_envelopes_are_the_extremes_of_the_samples() -> None:
    plain = Window(start=0.01, stop=0.03, rate=5000)
    windows = {"all": plain, "bins": plain.replace(envelope=10), "turns": Poincare()}
    samples, envelope, turns = simulate(P, 0.031, windows).samples.values()
    assert (len(samples["time"]), len(envelope["time"])) == (101, 10)
    cells = {name: x[:100].reshape(10, 10) for name, x in samples.items()}
    for name in ("P", "u", "psi"):
        np.testing.assert_array_equal(envelope[f"{name}_min"], cells[name].min(axis=1))
        np.testing.assert_array_equal(envelope[f"{name}_max"], cells[name].max(axis=1))
    np.testing.assert_allclose(envelope["time"], cells["time"].mean(axis=1))
    assert turns["time"].tolist() == [0.0]


@given(
    *[st.integers(0, 60)] * 4, st.sampled_from(["stop", "end", "last"]), st.sampled_from([None, 2])
)
@example(0, 9, 9, 1, "end", None)
@example(0, 9, 8, 1, "end", 2)
def test_a_window_has_the_samples_within_it(
    begin: int, duration: int, start: int, length: int, until: str, envelope: int | None
) -> None:
    """Times are in quarters of the interval between samples, 1/64 s: none is rounded."""
    end = begin + duration + 1
    stop = start + length + 1
    known = {"last": {"last": length + 1}, "stop": {"start": start, "stop": stop}}
    times = {name: time / 64 for name, time in known.get(until, {"start": start}).items()}
    window = Window(rate=16, envelope=envelope, **times)
    if (until == "last" and length + 1 > end - begin) or (until != "last" and start > end):
        with refusal(r"^windows\.w\.(start|last)=.*: must be <"):
            resolved_windows({"w": window}, begin / 64, end / 64)
        return
    resolved: Any = resolved_windows({"w": window}, begin / 64, end / 64)["w"]
    first = end - length - 1 if until == "last" else start
    last = stop if until == "stop" else end
    assert resolved.start == first / 64
    assert resolved.stop == last / 64
    taken = [time for time in range(first, min(last, end) + 1, 4) if time >= begin]
    assert resolved.grid(P, begin / 64, end / 64).number == len(taken)
    assert resolved_windows({"w": resolved}, begin / 64, end / 64)["w"] == resolved


@given(st.integers(1, 10**12), st.floats(1e-3, 1e9))
def test_rounding_loses_no_sample(intervals: int, rate: float) -> None:
    assert Window(rate=rate).grid(P, 0.0, intervals / rate).number == intervals + 1


@pytest.mark.parametrize(("t_end", "rate"), [(0.3, 10), (0.07, 300), (0.05, 700)])
def test_the_sample_at_the_very_end_is_taken(t_end: float, rate: float) -> None:
    """3 * 0.1 > 0.3: its time is rounded to behind the end."""
    time = simulate(P, t_end, {"w": Window(stop=t_end, rate=rate)}).samples["w"]["time"]
    assert len(time) == round(t_end * rate) + 1
    assert t_end - 1e-15 <= time[-1] <= t_end


def test_a_section_has_one_sample_a_turn() -> None:
    p = P.replace(Omega=500)
    turn = 2 * np.pi / 500
    windows = {"turns": Poincare(start=1.5 * turn, stop=4.1 * turn, theta=2.0)}
    windows |= {str(x): Window(start=2 * turn, rate=1 / turn, theta=x) for x in (1.0, 2.0)}
    turns, other, same = simulate(p, 4.5 * turn, windows).samples.values()
    np.testing.assert_allclose(turns["time"], turn * np.arange(2, 5), rtol=1e-15)
    # times differ by their rounding
    np.testing.assert_allclose(turns["w_point"], same["w_point"], rtol=1e-9)
    assert not np.isclose(turns["w_point"], other["w_point"], rtol=1e-2).any()
    still = simulate(P.replace(Omega=0), 0.01, {"turns": Poincare()})
    assert still.samples["turns"]["time"].tolist() == [0.0]


def test_parts_of_a_run_may_share_windows() -> None:
    windows = {str(x): Window(start=x, stop=x + 0.01, rate=1000) for x in (0.0, 0.03)}
    first = simulate(P, 0.04, windows)
    later = simulate(P, 0.05, windows, initial_state=first.final_state)
    assert [len(x["time"]) for x in first.samples.values()] == [11, 11]
    assert [len(x["time"]) for x in later.samples.values()] == [0, 1]


@pytest.mark.parametrize(
    ("windows", "fault"),
    [
        ([1], "^windows="),
        ({1: ONE}, "^windows.1=1: "),
        ({"": ONE}, "^windows.*='': must match"),
        ({"steps": ONE}, "must not be the name of a variable"),
        ({"events": ONE}, "must not be the name of a variable"),
        *(
            ({name: ONE}, "must match pattern|at most 60 characters")
            for name in ("a/b", " x", "x ", "x" * 61, "x\n")
        ),
        ({"w": 3}, "^windows.w=3: .*Window.*Poincare"),
        ({"w": Window(start=1.5, stop=2, rate=9)}, r"windows\.w\.start=1\.5: must be <= 1, where"),
        # it was cut to the run
        ({"w": Window(last=2, rate=9)}, r"windows\.w\.last=2: must be <= 1 s, the length of"),
        ({"w": Window(rate=1e19)}, r"windows\.w=.*must have 1e\+09 samples at most"),
    ],
)
def test_windows_that_cannot_be_are_refused(windows: Any, fault: str) -> None:
    with refusal(fault):
        simulate(P, 1.0, windows)


def test_names_that_groups_of_files_can_have_are_taken() -> None:
    names = ["late", "_1", "2 s later", "\u00e4", "x" * 60]
    assert [*resolved_windows(dict.fromkeys(names, ONE), 0.0, 1.0)] == names
    # a window as long as the run, rounded
    run = simulate(P, 0.3, {"all": Window(last=0.1 + 0.2, rate=1e3)})
    assert run.windows["all"].start == 0.0


@pytest.mark.parametrize(
    "more",
    [
        {"record": {"windows": {"w": Window(rate=10, stop=1)}}},
        {
            "start": Start(prerun={"parameters": {"N": 385}, "time": 1}),
            "ramps": (Ramp(parameter="N", to=100, start=0, end=1),),
            "record": {"windows": {"w": Window(rate=10, last=1)}, "poincare": Poincare(theta=2.0)},
        },
    ],
)
def test_a_text_is_a_case(more: dict[str, Any]) -> None:
    case = CaseSpec(parameters=P, t_end=1.0, **more)
    assert CaseSpec.model_validate_json(case.canonical) == case
    assert json.loads(case.canonical)["parameters"] == case.parameters.canonical
    assert [*case.record.sections] == ["w", *["poincare"] * ("poincare" in more["record"])]
