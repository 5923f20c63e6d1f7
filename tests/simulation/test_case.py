"""What a simulation keeps: windows, envelopes, samples by the drive; and which records are
refused."""

import json
import re

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from disc_model import ParameterError, Parameters, Poincare, Ramp, Window, simulate
from disc_model.simulation import collector
from disc_model.simulation.case import CaseSpec, Start, resolved_windows
from disc_model.simulation.states import perturb, static_start
from tests.refusals import refusal

P = Parameters(N=200, Omega=50, n_diameters=1)


def test_envelopes_are_the_extremes_of_the_samples():
    plain = Window(start=0.01, stop=0.03, rate=5000)
    windows = {"all": plain, "bins": plain.replace(envelope=10), "turns": Poincare()}
    result = simulate(P, 0.031, windows, tol=1e-9)
    samples, envelope, turns = result.samples.values()
    assert len(samples["time"]) == 101
    assert len(envelope["time"]) == 10
    for name in ("P", "u", "psi"):
        cells = samples[name][:100].reshape(10, 10)
        np.testing.assert_array_equal(envelope[f"{name}_min"], cells.min(axis=1))
        np.testing.assert_array_equal(envelope[f"{name}_max"], cells.max(axis=1))
    first = samples["time"][:100]
    bins = first.reshape(10, 10)
    middles = bins.mean(axis=1)
    np.testing.assert_allclose(envelope["time"], middles)
    assert turns["time"].tolist() == [0.0]


@given(
    *[st.integers(0, 60)] * 4, st.sampled_from(["stop", "end", "last"]), st.sampled_from([None, 2])
)
@example(0, 9, 9, 1, "end", None)
@example(0, 9, 8, 1, "end", 2)
def test_a_window_has_the_samples_within_it(begin, duration, start, length, until, envelope):
    """Times are in quarters of the interval between samples, 1/64 s: none is rounded, all digits
    are shown."""
    end = begin + duration + 1
    stop = start + length + 1
    times = {"last": {"last": length + 1}, "stop": {"start": start, "stop": stop}}.get(
        until, {"start": start}
    )
    window = Window(rate=16, envelope=envelope, **{name: time / 64 for name, time in times.items()})
    if (until == "end" and start >= end) or (until == "stop" and start > end):
        with refusal(rf"^windows\.w\.start={start / 64:.9g}: must be <.*{end / 64:.9g}"):
            resolved_windows({"w": window}, begin / 64, end / 64)
        return
    resolved = resolved_windows({"w": window}, begin / 64, end / 64)["w"]
    first = start
    if until == "last":
        first = max(begin, end - length - 1)
    last = end
    if until == "stop":
        last = stop
    assert resolved.start == first / 64
    assert resolved.last is None
    assert resolved.stop <= last / 64
    if (
        envelope and until != "stop"
    ):  # without the instant of the end, and half an interval before it
        last = max(end - 2, first)
    assert resolved.count == len(range(first, last + 1, 4))
    assert resolved_windows({"w": resolved}, begin / 64, end / 64)["w"] == resolved


@given(st.integers(1, 10**12), st.floats(1e-3, 1e9))
def test_rounding_loses_no_sample(intervals, rate):
    assert Window(stop=intervals / rate, rate=rate).count == intervals + 1


def test_a_section_has_one_sample_a_turn():
    p = P.replace(Omega=500)
    turn = 2 * np.pi / 500
    windows = {"turns": Poincare(start=1.5 * turn, stop=4.1 * turn, theta=2.0)}
    windows |= {
        f"at {theta:g}": Window(start=2 * turn, rate=1 / turn, theta=theta) for theta in (1.0, 2.0)
    }
    turns, other, same = simulate(p, 4.5 * turn, windows).samples.values()
    np.testing.assert_allclose(turns["time"], turn * np.arange(2, 5), rtol=1e-15)
    np.testing.assert_allclose(
        turns["w_point"], same["w_point"], rtol=1e-9
    )  # times differ by their rounding
    assert not np.isclose(turns["w_point"], other["w_point"], rtol=1e-2).any()


def test_a_text_is_a_case():
    brief = CaseSpec(parameters=P, t_end=1.0, windows=(("w", Window(rate=10, stop=1)),))
    later = {"start": Start(prerun={"parameters": {"N": 385}, "time": 1})}
    later |= {
        "ramps": (Ramp(parameter="N", to=100, start=0, end=1),),
        "poincare": Poincare(theta=2.0),
    }
    full = CaseSpec(**dict(brief) | later | {"windows": (("w", Window(rate=10, last=1)),)})
    fields = [json.loads(case.canonical) for case in (brief, full)]
    assert {text["format"] for text in fields} == {1}
    assert [[*case.sections] for case in (brief, full)] == [["w"], ["w", "poincare"]]
    for case, named in zip((brief, full), fields, strict=True):
        assert CaseSpec.model_validate_json(case.canonical) == case
        own = json.loads(case.parameters.canonical_json)
        assert named == {"parameters": own, **json.loads(case.beside)}
        assert "parameters" not in json.loads(case.beside)


def test_nothing_is_kept_if_nothing_is_asked_for():
    result = simulate(P, 0.03, events=False, tol=1e-9)
    assert len(result.events) == 0
    assert result.statistics["n_events"] > 0
    still = simulate(P.replace(Omega=0), 0.01, {"turns": Poincare()})
    assert len(still.samples["turns"]["time"]) == 0


@pytest.mark.parametrize(("t_end", "rate"), [(0.3, 10), (0.07, 300), (0.05, 700)])
def test_the_sample_at_the_very_end_is_taken(t_end, rate):
    """3 * 0.1 > 0.3: its time is rounded to behind the end."""
    window = Window(start=0, stop=t_end, rate=rate)
    time = simulate(P, t_end, {"w": window}, tol=1e-9).samples["w"]["time"]
    assert len(time) == window.count
    assert time[-1] == pytest.approx(t_end, abs=1e-15)
    assert time[-1] <= t_end


def test_windows_after_the_run_are_refused_and_those_before_it_stay_empty():
    windows = {
        f"from {start}": Window(start=start, stop=start + 0.01, rate=1000) for start in (0.0, 0.03)
    }
    result = simulate(P, 0.04, windows, tol=1e-9)
    assert [len(samples["time"]) for samples in result.samples.values()] == [11, 11]
    later = simulate(P, 0.05, windows, tol=1e-9, initial_state=result.final_state)
    assert [len(samples["time"]) for samples in later.samples.values()] == [0, 1]
    with pytest.raises(
        ParameterError,
        match=r"^windows\.from 0\.03\.start=0\.03: must be <= 0\.02, where the run ends$",
    ):
        simulate(P, 0.02, windows)


GREEDY = {
    "bins": (Window(rate=1e5, envelope=10),),
    "a step": (Window(rate=1e12, envelope=2**40),),
    "all together": (*(Window(rate=1e3),) * 9, Window(rate=2e3)),
    "sections": (Poincare(),),
    "beyond floats": (Window(rate=1e308, stop=1e300),),
}


@pytest.mark.parametrize("what", GREEDY)
def test_what_no_memory_holds_is_refused_before_anything_runs(what, monkeypatch):
    """Bins, samples of a step and sections were not counted: they ended in a MemoryError."""
    monkeypatch.setattr(collector, "_memory", lambda: 5e5)
    windows = {f"w{i}": window for i, window in enumerate(GREEDY[what])}
    p = P
    if what == "sections":
        p = P.replace(Omega=1e300)
    with pytest.raises(
        ParameterError,
        match=rf"^windows\.w{len(windows) - 1}: must fit into memory: .* GB of samples",
    ):
        simulate(p, 1.0, windows)


def test_a_window_counts_back_from_where_a_run_stops():
    """From t_end there was not a sample, without a word."""
    p = Parameters(N=385, Omega=15.1)
    start = perturb(p, static_start(p), u=-0.02)
    windows = {
        "late": Window(last=1e-3, rate=1e5),
        "bins": Window(last=1e-3, rate=1e5, envelope=10),
        "long": Window(last=0.9, rate=1e4),
        "after": Window(start=0.5, stop=0.6, rate=1e3),
    }
    run = simulate(p, 1.0, windows, stop_at="first_separation", initial_state=start)
    stop = run.first_separation
    assert run.status == "stopped"
    assert 1e-3 < stop < 0.1
    late = run.samples["late"]["time"]
    assert len(late) == 101
    assert late[[0, -1]] == pytest.approx([stop - 1e-3, stop], abs=1e-15)
    assert len(run.samples["bins"]["time"]) == 10
    assert run.samples["long"]["time"][0] == 0.0
    assert len(run.samples["after"]["time"]) == 0
    assert run.windows["late"].stop == stop
    whole = simulate(p, stop, {"late": Window(last=1e-3, rate=1e5)}, initial_state=start)
    np.testing.assert_array_equal(whole.samples["late"]["P"], run.samples["late"]["P"])
    # a run that does not separate before its end is as without the option
    quiet = simulate(P, 0.03, {"w": Window(last=0.01, rate=1e3)}, stop_at="first_separation")
    assert len(quiet.samples["w"]["time"]) == 11


@pytest.mark.parametrize(
    ("name", "rule"),
    [
        (1, "must be a text"),
        ("", "must not be empty"),
        ("a", "must not be the name of a parameter of results; window_a would do"),
        ("steps", "must not be the name of a variable of results; window_steps would do"),
        ("events", "must not be the name of a group of results; window_events would do"),
        ("a/b", "must have no /"),
        (" late", "must begin with a letter, a digit or _"),
        ("late ", "must not end in a space"),
        ("x" * 61, "must have at most 60 characters"),
        ("x\n", "must have printable characters only"),
    ],
)
def test_the_rule_that_the_name_of_a_window_breaks_is_told_alone(name: object, rule: str) -> None:
    """All rules were told of any name, so that nobody knew which of them `a` breaks."""
    with pytest.raises(ParameterError) as caught:
        resolved_windows({name: Window(rate=10)}, 0.0, 1.0)
    [fault] = caught.value.faults
    assert fault.rule == f"the name of a window {rule}"


def test_names_that_groups_of_files_can_have_are_taken() -> None:
    names = ["late", "_1", "2 s later", "\u00e4", "x" * 60]
    assert [*resolved_windows(dict.fromkeys(names, Window(rate=10)), 0.0, 1.0)] == names


def test_a_window_longer_than_the_run_is_an_error_of_both_times():
    """It was cut to the run, without a word."""
    windows = {"late": Window(last=2, rate=1e3)}
    rule = re.escape("windows.late.last=2: must be <= 1 s, the length of the run")
    with refusal(rule):
        simulate(P, 1.0, windows)
    begun = simulate(P, 0.02).final_state
    with refusal(r"late\.last=2: must be <= 1 s"):
        simulate(P, duration=1, windows=windows, initial_state=begun)
    # a window as long as the run, rounded
    duration = 0.1 + 0.2
    run = simulate(P, 0.3, {"all": Window(last=duration, rate=1e3)})
    assert run.windows["all"].start == 0.0
