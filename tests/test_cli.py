"""The command line: options, summary, plot, and one line for bad input."""

from __future__ import annotations

import inspect
import io
import json
import os
import pty
import subprocess
import sys
import time
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest

import disc_model
from disc_model import Parameters, cli, mode_choice, simulate
from disc_model.cli.case import option_name
from disc_model.cli.progress import compiling, simulating
from disc_model.cli.run import _plot_record
from disc_model.errors import DiscModelError
from disc_model.studies.schema import load_study

BASE = ("--N", "385", "--Omega", "15.1")
SMALL = Parameters(N=200, Omega=50, n_diameters=1)
SMALL_BASE = ("--N", "200", "--Omega", "50", "--n-diameters", "1")


def call(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    """Exit code, stdout and stderr of the command line, run in this process."""
    with pytest.raises(SystemExit) as ended:
        cli.main(list(arguments))
    out = capsys.readouterr()
    return int(ended.value.code or 0), out.out, out.err


def options_of(command: str) -> set[str]:
    commands = {info.callback.__name__: info.callback for info in cli.app.registered_commands if info.callback}
    return set(inspect.signature(commands[command]).parameters)


@pytest.mark.parametrize("command", ["run", "modes", "floquet"])
def test_every_parameter_is_an_option(command: str) -> None:
    assert set(Parameters.model_fields) <= options_of(command)


def test_every_option_reaches_the_parameters(capsys: pytest.CaptureFixture[str]) -> None:
    """A bad value given to each option comes back in the one message, under the parameter's name."""
    arguments = [part for name in Parameters.model_fields for part in (option_name(name), "bad")]
    code, _, err = call(capsys, "run", *arguments, "--t-end", "1")
    assert code == 2
    assert all(f"{name}='bad'" in err for name in Parameters.model_fields)


def test_underscores_are_accepted_in_option_names(capsys: pytest.CaptureFixture[str]) -> None:
    _, dashed, _ = call(capsys, "modes", "--n-circles", "1", "--r-0", "0.11")
    code, underscored, _ = call(capsys, "modes", "--n_circles", "1", "--r_0", "0.11")
    assert (code, dashed) == (0, underscored)


@pytest.mark.parametrize(
    ("arguments", "parts"),
    [
        (
            ("--N", "-1", "--Omega", "nan", "--mu-k", "0.5", "--t-end", "1"),
            ("N=-1: ", "Omega=nan", "mu_k=0.5"),
        ),
        ((*BASE, "--a", "0.2", "--t-end", "1"), ("a=0.2: must be < r_0=0.1",)),
        ((*BASE, "--r-0", "0.2", "--t-end", "1"), ("r_0=0.2: must be <= b=0.12",)),
        ((*BASE, "--t-end", "0"), ("t_end=0: must be finite and > 0",)),
        ((*BASE, "--t-end", "inf"), ("t_end=inf: must be finite and > 0",)),
        ((*BASE, "--t-end", "soon"), ("t_end='soon': must be a number",)),
        ((*BASE, "--t-end", "1", "--tol", "1"), ("tol=1: must be",)),
        ((*BASE, "--t-end", "1", "--tol", "nan"), ("tol=nan: must be",)),
        ((*BASE, "--t-end", "1", "--stop-at", "never"), ("stop_at='never': must be 'first_separation'",)),
        ((*BASE, "--t-end", "1", "--plot", "p.doc"), ("plot='p.doc': must end in",)),
        ((*BASE, "--t-end", "1", "--plot", "no/such/p.png"), ("must be in a folder that exists",)),
        ((*BASE, "--t-end", "1", "--max-steps", "1.5"), ("max_steps=1.5: must be a whole number >= 1",)),
        ((*BASE, "--t-end", "1", "--save", "no/such/r.nc"), ("save='no/such/r.nc': must be in a folder that exists",)),
        ((*BASE, "--t-end", "1", "--checkpoint", "no/such"), ("checkpoint='no/such': must be a file in a folder",)),
        ((*BASE, "--t-end", "1", "--window", "late"), ("window='late': must be NAME:KEY=VALUE,...",)),
        # used to be refused by the file, after the simulation
        ((*BASE, "--t-end", "1", "--window", "events:rate=100"), ("window='events:rate=100': must be NAME:KEY",)),
        ((*BASE, "--t-end", "1", "--window", "late:last=0,rate=1"), ("window.late.last=0: must be > 0",)),
        (
            (*BASE, "--t-end", "1", "--window", "w:start=0,stop=3,rate=1"),
            ("window.w: must be within the run: stop=3 <= t_end=1",),
        ),
        ((*BASE, "--t-end", "1", "--ramp", "Omega"), ("ramp='Omega': must be PARAMETER:KEY=VALUE,...",)),
        ((*BASE, "--t-end", "1", "--ramp", "N:to=0,start=1,end=2"), ("ramp.0.to=0: must be > 0",)),
        ((*BASE, "--t-end", "1", "--window", "w:rat=1"), ("window.w.rat='1': unknown key, did you mean rate?",)),
        ((*BASE,), ("t_end: is required",)),
        ((), ("N: is required", "Omega: is required", "t_end: is required")),
        (("--Omga", "3"), ("--Omga", "--Omega")),
        (("--t-end",), ("--t-end",)),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(
    capsys: pytest.CaptureFixture[str], arguments: tuple[str, ...], parts: tuple[str, ...]
) -> None:
    code, out, err = call(capsys, "run", *arguments)
    assert code == 2
    assert out == ""
    assert err.startswith("error: ")
    assert err.count("\n") == 1
    assert all(part in err for part in parts)


def test_unknown_command_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    code, _, err = call(capsys, "rum")
    assert code == 2
    assert err.startswith("error: ")
    assert err.count("\n") == 1


def test_help_shows_units_and_defaults(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = call(capsys, "run", "--help")
    assert code == 0
    assert "(N m s)" in " ".join(out.replace("│", " ").split())
    assert "[default: as_published]" in " ".join(out.replace("│", " ").split())


def test_modes_prints_the_papers_frequencies(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = call(capsys, "modes")
    assert code == 0
    for number in ("1491.927", "4383.044", "66.7946", "850.864", "2758.016", "3.099618e-05"):
        assert number in out


@pytest.mark.compiled
def test_run_prints_a_summary(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = call(capsys, "run", *BASE, "--t-end", "0.5")
    assert (code, err) == (0, "")
    for part in (
        "status              ok",
        "first separation    none",
        "stick_to_slip",
        "time in slip",
        "wall time",
    ):
        assert part in out
    assert "energy residual" in out


def test_run_agrees_with_simulate(capsys: pytest.CaptureFixture[str]) -> None:
    _, out, _ = call(capsys, "run", *BASE, "--t-end", "0.3", "--k-p", "1.5e4", "--tol", "1e-8")
    result = simulate(Parameters(N=385, Omega=15.1, k_p=1.5e4), 0.3, tol=1e-8)
    assert f"events              {result.statistics['events']}\n" in out
    assert f"key {result.parameters.key}" in out


@pytest.mark.compiled
@pytest.mark.parametrize("t_end", ["0.1", "0.4", "5"])
def test_plot_is_written(capsys: pytest.CaptureFixture[str], tmp_path: Path, t_end: str) -> None:
    path = tmp_path / "run.png"
    code, out, _ = call(capsys, "run", *BASE, "--t-end", t_end, "--plot", str(path))
    assert code == 0
    assert path.read_bytes().startswith(b"\x89PNG")
    assert str(path) in out


def test_plot_record_does_not_grow_with_time() -> None:
    for t_end in (0.1, 1.0, 60.0, 1e4):
        windows = _plot_record(t_end).windows
        assert sum(window.count // (window.envelope or 1) for window in windows) <= 6100


@pytest.mark.compiled
def test_plot_of_a_run_stopped_early(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """The last window may then be empty."""
    path = tmp_path / "run.svg"
    case = ("--N", "200", "--Omega", "50", "--k", "0", "--mu-s", "0.9", "--mu-k", "0.1", "--k-p", "2e3")
    code, _, _ = call(capsys, "run", *case, "--t-end", "40", "--stop-at", "first_separation", "--plot", str(path))
    assert code == 0
    assert path.stat().st_size > 0


def test_module_runs_as_a_program() -> None:
    done = subprocess.run([sys.executable, "-m", "disc_model", "modes", "--b", "0.05"], capture_output=True, text=True)
    assert done.returncode == 2
    assert done.stderr == "error: r_0=0.1: must be <= b=0.05\n"
    assert done.stdout == ""


def test_progress_is_shown_on_a_terminal_only() -> None:
    main, secondary = pty.openpty()
    command = [sys.executable, "-m", "disc_model", "run", *BASE, "--t-end", "1"]
    environment = {**os.environ, "TERM": "xterm"}
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=secondary, text=True, env=environment) as process:
        os.close(secondary)
        shown = b""
        while chunk := _read_terminal(main):  # a terminal that nobody reads blocks its writer
            shown += chunk
        out = process.stdout.read() if process.stdout else ""
    os.close(main)
    assert process.returncode == 0
    assert b"simulating" in shown
    assert "simulating" not in out


def _read_terminal(descriptor: int) -> bytes:
    try:
        return os.read(descriptor, 65536)
    except OSError:  # how Linux reports that the other side has been closed
        return b""


def test_warm_says_that_it_is_done(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = call(capsys, "warm")
    assert code == 0
    assert "cached" in out


def test_a_run_is_summarised_and_drawn(capsys, tmp_path):
    path = tmp_path / "run.png"
    code, out, _ = call(capsys, "run", *SMALL_BASE, "--t-end", "0.05", "--tol", "1e-8", "--plot", str(path))
    assert code == 0
    events = simulate(SMALL, 0.05, tol=1e-8).statistics["events"]
    assert str(events) in out
    assert path.read_bytes().startswith(b"\x89PNG")


def test_a_run_that_ends_early_is_drawn_to_its_end(capsys, monkeypatch, tmp_path):
    drawn = []
    monkeypatch.setattr(
        "disc_model.simulation.quicklook.quicklook", lambda result: drawn.append(result) or plt.figure()
    )
    command = ("run", *SMALL_BASE, "--t-end", "3", "--stop-at", "first_separation", "--tol", "1e-8")
    kicked = simulate(SMALL, 1e-6).final_state
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
    code, out, err = call(capsys, "run", *SMALL_BASE, "--t-end", "0.05")
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
    code, _, err = call(capsys, "run", *SMALL_BASE, "--t-end", "0.05")
    assert code == exit_code
    assert err == said


def test_what_is_nobodys_fault_is_not_hidden(monkeypatch):
    def fail(*_, **__):
        raise RuntimeError("unforeseen")

    monkeypatch.setattr(sys.modules["disc_model.simulation.api"], "simulate", fail)
    with pytest.raises(RuntimeError, match="unforeseen"):
        cli.main(["run", *SMALL_BASE, "--t-end", "0.05"])


def test_a_checkpoint_may_be_named(capsys, tmp_path):
    file = tmp_path / "run"
    code, out, _ = call(capsys, "run", *SMALL_BASE, "--t-end", "0.01", "--checkpoint", str(file))
    assert code == 0
    assert "ok" in out
    assert not file.exists()


def test_a_plot_that_cannot_be_written_is_bad_input(capsys, tmp_path, monkeypatch):
    from matplotlib.figure import Figure

    def full(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Figure, "savefig", full)
    code, _, err = call(capsys, "run", *SMALL_BASE, "--t-end", "0.01", "--plot", str(tmp_path / "x.png"))
    assert code == 2
    assert "cannot be written (No space left on device)" in err


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_progress_is_shown_on_a_terminal(monkeypatch):
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    with simulating(4.0) as progress:
        progress(1.0)
        progress(9.0)
    assert "simulating" in terminal.getvalue()
    assert "4.00 of 4 s" in terminal.getvalue()  # no further than the end
    monkeypatch.setattr(sys, "stderr", io.StringIO())
    with simulating(4.0) as progress:
        assert progress is None


def test_the_version_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = call(capsys, "--version")
    assert (code, out) == (0, f"disc_model {disc_model.__version__}\n")


def test_help_shows_what_there_is_to_choose_from(capsys: pytest.CaptureFixture[str], monkeypatch) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    _, out, _ = call(capsys, "run", "--help")
    for choices in ("as_published|orthonormal", "separable|bonded", "first_separation"):
        assert choices in out
    _, out, _ = call(capsys, "--help")
    for command in ("run", "floquet", "modes", "study", "list", "init", "warm", "--install-completion"):
        assert command in out


def test_what_auto_chose_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    _, out, _ = call(capsys, "modes", "--n-diameters", "auto")
    assert out.startswith("modes chosen")


def test_auto_is_told_by_what_to_choose(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(mode_choice.MEASURES, "growth", lambda p: 1.0 + 0.1 / p.n_diameters)
    asked = ("modes", *SMALL_BASE[:4], "--n-diameters", "auto", "--truncation-quantity", "growth")
    code, out, _ = call(capsys, *asked, "--truncation-tolerance", "0.05")
    assert code == 0
    assert '"n_diameters": 1, "quantity": "growth", "tolerance": 0.05' in out
    code, _, err = call(capsys, *asked, "--truncation-tolerance", "1e-4")
    assert code == 2
    assert "n_diameters: undecided: growth still changes by" in err
    code, _, err = call(capsys, "modes", "--truncation-quantity", "growth")
    assert code == 2
    assert "truncation_quantity='growth': is used with n_diameters='auto' only" in err


def test_windows_are_saved_by_their_names(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    path = tmp_path / "run.nc"
    windows = ("--window", "late:last=0.02,rate=1000", "--window", "rate=500,envelope=5")
    code, out, _ = call(capsys, "run", *SMALL_BASE, "--t-end", "0.05", *windows, "--save", str(path))
    assert code == 0
    assert f"saved               {path}" in out
    found = disc_model.load(path)
    assert np.allclose(found["late/time"], np.arange(0.03, 0.0505, 0.001))
    assert found["sample_1/P_min"].sizes["time"] == 5


def test_a_ramp_is_that_of_the_function(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    ramps = ("--ramp", "Omega:to=20,start=0.01,end=0.03", "--ramp", "N:to=150,start=0.02,end=0.04")
    code, _, _ = call(capsys, "run", *SMALL_BASE, "--t-end", "0.05", *ramps, "--save", str(tmp_path / "run.nc"))
    assert code == 0
    found = disc_model.load(tmp_path / "run.nc")
    p = Parameters(**json.loads(found.attrs["parameters"]))
    given = tuple(disc_model.Ramp(**ramp) for ramp in json.loads(found.attrs["ramps"]))
    assert [(ramp.parameter, ramp.to) for ramp in given] == [("Omega", 20.0), ("N", 150.0)]
    wanted = disc_model.simulate(p, 0.05, ramps=given).events
    assert np.array_equal(found["events/time"], wanted["time"])
    assert len(wanted) > 0


def test_steps_can_be_limited(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = call(capsys, "run", *SMALL_BASE, "--t-end", "0.05", "--max-steps", "3")
    assert code == 1
    assert "steps               3\n" in out


@pytest.mark.compiled
def test_floquet_says_whether_the_quiet_motion_lasts(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = call(capsys, "floquet", "--N", "385", "--Omega", "15")
    rate = disc_model.floquet(Parameters(N=385, Omega=15)).growth_rate
    assert code == 0
    assert f"growth rate         {rate:.6g} 1/s (small disturbances die out)" in out
    code, out, _ = call(capsys, "floquet", "--N", "0", "--Omega", "0")
    assert code == 1
    assert "advice" in out
    code, _, err = call(capsys, "floquet", *BASE, "--tol", "1")
    assert (code, err) == (2, "error: tol=1: must be within 1e-14 and 1e-06\n")


def test_compiling_is_told_when_the_first_kernel_is_kept(capsys, monkeypatch, tmp_path: Path) -> None:
    """Nothing is said where all kernels are there already."""
    from types import SimpleNamespace

    from disc_model.engine import machine

    monkeypatch.setattr(machine, "run", SimpleNamespace(stats=SimpleNamespace(cache_path=str(tmp_path))))
    (tmp_path / "old.kernel").touch()
    with compiling():
        time.sleep(0.5)
    assert capsys.readouterr().err == ""
    with compiling():
        (tmp_path / "new.kernel").touch()
        time.sleep(0.5)
    said = capsys.readouterr().err
    assert said.startswith("compiling kernels, once")
    assert "1 kernels compiled in" in said


STUDY = """\
study: mine
quantity: floquet
base: {N: 200, Omega: 20}
axes: {mu_s: [0.3, 0.4], mu_k: [0.1, 0.2]}
cases:
  A: {title: one case, parameters: {mu_k: 0.2}, t_end: 1, record: {windows: {w: {rate: 1000}}}}
figures:
  growth: {kind: heat_map, variable: growth_rate, x: mu_s, y: mu_k}
  seen: {kind: history, case: A, window: w}
"""


@pytest.mark.parametrize(
    ("what", "parts"),
    [
        ("studies", ("mine", "floquet", "mu_s x mu_k", "4", "not computed")),
        ("figures", ("growth", "heat_map", "seen", "history")),
        ("cases", ("A", "one case", "mu_k = 0.2", "1")),
    ],
)
def test_what_a_study_has_is_listed(capsys, monkeypatch, tmp_path: Path, what: str, parts: tuple[str, ...]) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    (tmp_path / "mine.yaml").write_text(STUDY)
    code, out, _ = call(capsys, "list", what, str(tmp_path / "mine.yaml"), "--directory", str(tmp_path))
    assert code == 0
    assert all(part in out for part in parts)


def test_what_can_be_listed_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    code, _, err = call(capsys, "list", "colours")
    assert (code, err) == (2, "error: what='colours': must be one of studies, figures, cases, stale\n")


def test_a_folder_is_laid_out_and_its_study_is_right(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    folder = tmp_path / "my own"
    code, out, _ = call(capsys, "init", str(folder))
    assert code == 0
    assert f"cd '{folder}' && disc-model study my_study.yaml" in out
    study = load_study(folder / "my_study.yaml")
    assert study.grid is not None
    assert study.grid.n_points == 143
    assert (folder / "profiles" / "default" / "config.yaml").is_file()
    code, _, err = call(capsys, "init", str(folder))
    assert code == 2
    assert "must not hold my_study.yaml, Snakefile, profiles/default/config.yaml yet" in err


def test_a_study_is_handed_to_snakemake(capsys, monkeypatch, tmp_path: Path) -> None:
    given = []
    monkeypatch.setattr(subprocess, "call", lambda command: given.append(command) or 3)
    path = tmp_path / "mine.yaml"
    path.write_text(STUDY)
    options = ("--cores", "2", "-n", "--directory", str(tmp_path), "--target", "bench", "--snakemake", "--quiet rules")
    code, _, _ = call(capsys, "study", str(path), *options)
    assert code == 3
    (command,) = given
    snakefile = Path(command[command.index("-s") + 1])
    assert snakefile.is_file()
    assert command[-2:] == ["--configfile", str(path)]
    assert {"-j2", "-n", "bench", "--quiet", "rules", "--directory", str(tmp_path)} <= {*command}


def test_a_wrong_study_is_told_before_snakemake_starts(capsys, monkeypatch, tmp_path: Path) -> None:
    monkeypatch.setattr(subprocess, "call", lambda command: pytest.fail("was started"))
    path = tmp_path / "mine.yaml"
    path.write_text(STUDY.replace("mu_k: [0.1, 0.2]", "mu: [1]"))
    code, _, err = call(capsys, "study", str(path))
    assert code == 2
    assert "axes.mu: cannot be an axis" in err
