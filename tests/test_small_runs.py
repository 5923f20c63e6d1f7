"""Simulations of a few hundredths of a second with few modes: what they keep, how they end, how they are drawn."""

from __future__ import annotations

import io
import math
import sys

import matplotlib.pyplot as plt
import numpy as np
import pytest

from disc_model import ParameterError, Parameters, Poincare, Record, Window, cli, simulate
from disc_model.errors import DiscModelError, StepLimit
from disc_model.figures.quicklook import quicklook

P = Parameters(N=200, Omega=50, n_diameters=1)
BASE = ("--N", "200", "--Omega", "50", "--n-diameters", "1")


# ------------------------------------------------------------------------------------- what is kept
def test_envelopes_are_the_extremes_of_the_samples():
    plain = Window(start=0.01, stop=0.03, rate=5000)
    record = Record(windows=(plain, plain.model_copy(update={"envelope": 10})), poincare=Poincare())
    result = simulate(P, 0.031, tol=1e-9, record=record)
    samples, envelope = result.samples
    assert len(samples["time"]) == 101
    assert len(envelope["time"]) == 10
    for name in ("P", "u", "psi"):
        cells = samples[name][:100].reshape(10, 10)
        np.testing.assert_array_equal(envelope[f"{name}_min"], cells.min(axis=1))
        np.testing.assert_array_equal(envelope[f"{name}_max"], cells.max(axis=1))
    np.testing.assert_allclose(envelope["time"], samples["time"][:100].reshape(10, 10).mean(axis=1))
    assert result.poincare["time"].tolist() == [0.0]


def test_small_buffers_and_many_pauses_change_nothing(monkeypatch):
    record = Record(windows=(Window(start=0, stop=0.05, rate=20_000),))
    whole = simulate(P, 0.05, tol=1e-9, record=record)
    monkeypatch.setattr("disc_model.simulation.collector.BUFFER", 16)
    monkeypatch.setattr(sys.modules["disc_model.simulation.api"], "STEPS_PER_PAUSE", 3)
    seen = []
    again = simulate(P, 0.05, tol=1e-9, record=record, progress=seen.append)
    for name, values in whole.samples[0].items():
        np.testing.assert_array_equal(again.samples[0][name], values, err_msg=name)
    np.testing.assert_array_equal(again.events["time"], whole.events["time"])
    assert seen == sorted(seen)
    assert seen[-1] == 0.05
    assert len(seen) > 3


def test_nothing_is_kept_if_nothing_is_asked_for():
    result = simulate(P, 0.03, tol=1e-9, record=Record(events=False))
    assert len(result.events) == 0
    assert result.statistics["events"] > 0
    still = simulate(P.replace(Omega=0), 0.01, record=Record(poincare=Poincare()))
    assert len(still.poincare["time"]) == 0


@pytest.mark.parametrize(("t_end", "rate"), [(0.3, 10), (0.07, 300), (0.05, 700)])
def test_the_sample_at_the_very_end_is_taken(t_end, rate):
    """3 * 0.1 > 0.3: its time is rounded to behind the end."""
    window = Window(start=0, stop=t_end, rate=rate)
    time = simulate(P, t_end, tol=1e-9, record=Record(windows=(window,))).samples[0]["time"]
    assert len(time) == window.count
    assert time[-1] == pytest.approx(t_end, abs=1e-15)
    assert time[-1] <= t_end


def test_samples_by_the_drive_end_with_the_run():
    turn = 2 * math.pi / P.Omega
    for turns in range(1, 8):
        taken = simulate(P, turns * turn, tol=1e-9, record=Record(poincare=Poincare())).poincare
        assert len(taken["time"]) == turns + 1


def test_windows_that_the_run_does_not_enter_are_warned_of():
    windows = tuple(Window(start=start, stop=start + 0.01, rate=1000) for start in (0.0, 0.03, 0.5))
    with pytest.warns(
        UserWarning, match=r"windows\[2\] = \[0.5, 0.51\] s: stays empty, the run is from 0 to 0.04 s"
    ) as seen:
        result = simulate(P, 0.04, tol=1e-9, record=Record(windows=windows))
    assert len(seen) == 1
    assert seen[0].filename == __file__
    assert [len(samples["time"]) for samples in result.samples] == [11, 11, 0]
    with pytest.warns(UserWarning, match=r"windows\[0\] .* from 0.04 to 0.05 s"):
        simulate(P, 0.05, tol=1e-9, initial_state=result.final_state, record=Record(windows=windows[:1]))


# ------------------------------------------------------------------------------------- how runs end
def test_steps_run_out():
    result = simulate(P, 1.0, max_steps=3)
    assert result.status == "step_limit"
    assert not result.status.complete
    assert result.statistics["steps"] == 3
    with pytest.raises(StepLimit, match="raise max_steps"):
        result.raise_for_status()


def test_a_run_stops_at_its_first_separation():
    p = P.replace(N=60.0)
    start = simulate(p, 1e-6).final_state
    kicked = start.replace(alpha=start.alpha + np.array([0.0, 20.0]))
    result = simulate(p, 0.05, initial_state=kicked, stop_at="first_separation")
    assert result.status == "stopped"
    assert result.status.complete
    assert result.first_separation == result.final_state.time == result.events["time"].iloc[-1]
    assert result.final_state.phase == "separation"
    assert result.raise_for_status() is result


def test_a_state_that_overflows_is_named():
    start = simulate(P, 1e-6).final_state
    with np.errstate(all="ignore"):
        result = simulate(P, 0.01, initial_state=start.replace(phase="slip", direction=1, f=1e308))
    assert result.status == "non_finite"
    assert result.message == "non_finite: at t = 1e-06 s in slip"


def test_all_faults_of_the_arguments_come_at_once():
    with pytest.raises(ParameterError) as error:
        simulate(3, math.nan, tol=1, record="all", stop_at="never", max_steps=0)
    names = [fault.partition("=")[0] for fault in error.value.faults]
    assert names == ["p", "record", "t_end", "tol", "stop_at", "max_steps"]
    state = simulate(P, 1e-3).final_state
    wrong = state.replace(phase="slip", direction=1, f=-1.0, psi=math.inf, a=np.zeros(7))
    with pytest.raises(ParameterError) as error:
        simulate(P, 1.0, initial_state=wrong)
    assert [fault.partition("=")[0].partition(":")[0] for fault in error.value.faults] == [
        "initial_state.a",
        "initial_state.psi",
        "initial_state.f",
    ]
    for changes, fault in (
        ({"phase": "flight"}, "must be one of stick, slip, separation"),
        ({"phase": "stick", "f": 1.0}, "must be 0 in stick"),
        ({"phase": "slip", "direction": 0}, "must be -1 or 1 in slip"),
        ({"known": 4}, "known=4: must be 0, 1, 2 or 3"),
        ({"time_low": math.nan}, "time_low=nan: must be less than the last digit of the time"),
        ({"time_low": 1e-3}, "time_low=0.001: must be less than the last digit of the time"),
    ):
        with pytest.raises(ParameterError, match=fault):
            simulate(P, 1.0, initial_state=state.replace(**changes))


@pytest.mark.parametrize("model", [Window, Poincare])
def test_windows_in_the_wrong_order_are_refused(model):
    with pytest.raises(ParameterError, match=r"start=2: must be < stop=1"):
        model(start=2, stop=1, **({"rate": 10} if model is Window else {}))


# ------------------------------------------------------------------------------------- checkpoints
class Interrupted(Exception):
    pass


def test_an_interrupted_run_goes_on_from_its_checkpoint(tmp_path, monkeypatch, caplog):
    monkeypatch.setattr(sys.modules["disc_model.simulation.api"], "STEPS_PER_PAUSE", 5)
    record = Record(windows=(Window(start=0, stop=0.1, rate=2000),), poincare=Poincare())
    whole = simulate(P, 0.1, tol=1e-9, record=record)
    file, pauses = tmp_path / "run", []

    def stop(time):
        pauses.append(time)
        if len(pauses) % 4 == 0:
            raise Interrupted

    options = {"tol": 1e-9, "record": record, "checkpoint": file, "checkpoint_every": 0}
    for _ in range(2):
        with pytest.raises(Interrupted):
            simulate(P, 0.1, **options, progress=stop)
    assert pauses == sorted(pauses)
    # what was cut off is not used
    file.write_bytes(file.read_bytes()[:-3])
    again = simulate(P, 0.1, **options)
    assert "cut off" in caplog.text
    np.testing.assert_array_equal(again.events["time"], whole.events["time"])
    for name, values in whole.samples[0].items():
        np.testing.assert_array_equal(again.samples[0][name], values)
    assert not file.exists()


@pytest.mark.parametrize("content", [b"", b"x" * 4000])
def test_what_is_no_checkpoint_is_left_out(tmp_path, content, caplog):
    file = tmp_path / "run"
    file.write_bytes(content)
    result = simulate(P, 0.02, tol=1e-9, checkpoint=file, checkpoint_every=3600)
    assert result.status == "ok"
    assert ("ignored: not a checkpoint" in caplog.text) == bool(content)


def test_the_checkpoint_of_another_run_is_left_out(tmp_path, monkeypatch, caplog):
    monkeypatch.setattr(sys.modules["disc_model.simulation.api"], "STEPS_PER_PAUSE", 5)

    def stop(time):
        raise Interrupted

    with pytest.raises(Interrupted):
        simulate(P, 0.05, tol=1e-9, checkpoint=tmp_path / "run", checkpoint_every=0, progress=stop)
    simulate(P, 0.04, tol=1e-9, checkpoint=tmp_path / "run", checkpoint_every=3600)
    assert "of another run (other t_end" in caplog.text


# ------------------------------------------------------------------------------------- the command line
def call(capsys, *arguments):
    with pytest.raises(SystemExit) as ended:
        cli.main(list(arguments))
    out = capsys.readouterr()
    return int(ended.value.code or 0), out.out, out.err


def test_a_run_is_summarised_and_drawn(capsys, tmp_path):
    path = tmp_path / "run.png"
    code, out, _ = call(capsys, "run", *BASE, "--t-end", "0.05", "--tol", "1e-8", "--plot", str(path))
    assert code == 0
    events = simulate(P, 0.05, tol=1e-8).statistics["events"]
    assert str(events) in out
    assert path.read_bytes().startswith(b"\x89PNG")


def test_a_run_that_ends_early_is_drawn_to_its_end(capsys, monkeypatch, tmp_path):
    drawn = []
    monkeypatch.setattr("disc_model.figures.quicklook.quicklook", lambda result: drawn.append(result) or plt.figure())
    command = ("run", *BASE, "--t-end", "3", "--stop-at", "first_separation", "--tol", "1e-8")
    kicked = simulate(P, 1e-6).final_state
    start = kicked.replace(alpha=kicked.alpha + np.array([0.0, 20.0]), time=0.0)
    real = sys.modules["disc_model.simulation.api"].simulate
    kick = {"initial_state": start}
    monkeypatch.setattr(
        sys.modules["disc_model.simulation.api"], "simulate", lambda *args, **how: real(*args, **kick, **how)
    )
    code, out, _ = call(capsys, *command, "--plot", str(tmp_path / "run.png"))
    assert code == 0
    assert "stopped" in out
    [shown] = drawn
    reached = shown.t_end
    assert reached < 0.1
    assert shown.samples[-1]["time"][-1] == pytest.approx(reached, abs=1e-3)


def test_a_run_that_cannot_go_on_has_exit_code_1(capsys, monkeypatch):
    monkeypatch.setattr(sys.modules["disc_model.simulation.api"], "_step_limit", lambda model, duration: 3)
    code, out, err = call(capsys, "run", *BASE, "--t-end", "0.05")
    assert code == 1
    assert "step_limit" in out + err


@pytest.mark.parametrize(
    ("error", "exit_code", "said"),
    [(DiscModelError("told"), 2, "error: told\n"), (KeyboardInterrupt(), 130, "error: interrupted\n")],
)
def test_errors_end_in_one_line(capsys, monkeypatch, error, exit_code, said):
    def fail(*_, **__):
        raise error

    monkeypatch.setattr(sys.modules["disc_model.simulation.api"], "simulate", fail)
    code, _, err = call(capsys, "run", *BASE, "--t-end", "0.05")
    assert code == exit_code
    assert err == said


def test_what_is_nobodys_fault_is_not_hidden(monkeypatch):
    def fail(*_, **__):
        raise RuntimeError("unforeseen")

    monkeypatch.setattr(sys.modules["disc_model.simulation.api"], "simulate", fail)
    with pytest.raises(RuntimeError, match="unforeseen"):
        cli.main(["run", *BASE, "--t-end", "0.05"])


# ------------------------------------------------------------------------------------- a first look
def test_quicklook_marks_the_separation_and_draws_bands():
    p = P.replace(N=60.0)
    start = simulate(p, 1e-6).final_state
    kicked = start.replace(alpha=start.alpha + np.array([0.0, 20.0]), time=0.0)
    windows = (Window(start=0, stop=0.02, rate=2000, envelope=4), Window(start=0.0, stop=0.02, rate=2000))
    result = simulate(p, 0.02, tol=1e-8, initial_state=kicked, record=Record(windows=windows))
    assert math.isfinite(result.first_separation)
    figure = quicklook(result)
    assert len(figure.axes) == 4
    assert "N = 60 N" in figure.get_suptitle()
    marks = [line for line in figure.axes[1].lines if line.get_linestyle() == "--"]
    assert marks[0].get_xdata()[0] == result.first_separation
    plt.close(figure)
    with pytest.raises(ValueError, match="no window"):
        quicklook(simulate(P, 1e-3))


# ------------------------------------------------------------------------------------- the rest of the command line
def test_a_checkpoint_may_be_named(capsys, tmp_path):
    code, _, err = call(capsys, "run", *BASE, "--t-end", "0.01", "--checkpoint", str(tmp_path / "no" / "such"))
    assert code == 2
    assert "must be a file in a folder that exists" in err
    file = tmp_path / "run"
    code, out, _ = call(capsys, "run", *BASE, "--t-end", "0.01", "--checkpoint", str(file))
    assert code == 0
    assert "ok" in out
    assert not file.exists()


def test_a_plot_that_cannot_be_written_is_bad_input(capsys, tmp_path, monkeypatch):
    from matplotlib.figure import Figure

    def full(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Figure, "savefig", full)
    code, _, err = call(capsys, "run", *BASE, "--t-end", "0.01", "--plot", str(tmp_path / "x.png"))
    assert code == 2
    assert "cannot be written (No space left on device)" in err


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_progress_is_shown_on_a_terminal(monkeypatch):
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    with cli._progress(4.0) as progress:
        progress(1.0)
        progress(9.0)
    assert "simulating" in terminal.getvalue()
    assert "4.00 of 4 s" in terminal.getvalue()  # no further than the end
    monkeypatch.setattr(sys, "stderr", io.StringIO())
    with cli._progress(4.0) as progress:
        assert progress is None
