"""What a simulation keeps: windows, envelopes, samples by the drive; and which records are refused."""

import numpy as np
import pytest

from disc_model import ParameterError, Parameters, Poincare, Window, simulate
from disc_model.simulation import recorder

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
    np.testing.assert_allclose(envelope["time"], samples["time"][:100].reshape(10, 10).mean(axis=1))
    assert turns["time"].tolist() == [0.0]


def test_nothing_is_kept_if_nothing_is_asked_for():
    result = simulate(P, 0.03, events=False, tol=1e-9)
    assert len(result.events) == 0
    assert result.statistics["events"] > 0
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


def test_windows_that_the_run_does_not_enter_are_warned_of():
    windows = {f"from {start}": Window(start=start, stop=start + 0.01, rate=1000) for start in (0.0, 0.03, 0.5)}
    with pytest.warns(
        UserWarning, match=r"windows.from 0.5 = \[0.5, 0.51\] s: stays empty, the run is from 0 to 0.04 s"
    ) as seen:
        result = simulate(P, 0.04, windows, tol=1e-9)
    assert len(seen) == 1
    assert seen[0].filename == __file__
    assert [len(samples["time"]) for samples in result.samples.values()] == [11, 11, 0]
    first = {"from 0.0": windows["from 0.0"]}
    with pytest.warns(UserWarning, match=r"windows.from 0.0 .* from 0.04 to 0.05 s"):
        simulate(P, 0.05, first, tol=1e-9, initial_state=result.final_state)


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
    monkeypatch.setattr(recorder, "_memory", lambda: 5e5)
    windows = {f"w{i}": window for i, window in enumerate(GREEDY[what])}
    p = P.replace(Omega=1e300) if what == "sections" else P
    with pytest.raises(ParameterError, match=rf"^windows\.w{len(windows) - 1}: must fit into memory: .* GB of samples"):
        simulate(p, 1.0, windows)
