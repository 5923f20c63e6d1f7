"""An interrupted simulation continues from its checkpoint to the same result, bit for bit; and so do long ones."""

import importlib
import inspect
import json
import os
import pickle
import re
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from disc_model import Execution, ParameterError, Parameters, Poincare, Ramp, Record, Window
from disc_model.data.dataset import load
from disc_model.simulation import api
from disc_model.simulation.api import run_case, simulate
from disc_model.simulation.case import CaseSpec
from disc_model.simulation.result import Result, State
from tests import processes
from tests.commands import Command
from tests.simulation.equal import same
from tests.studies.refused import faults_of

SIMULATE = importlib.import_module("disc_model.simulation.api")
P = Parameters(N=385, Omega=15.1)
# the last window of ALL is beyond the end of every run
pytestmark = pytest.mark.filterwarnings("ignore:windows:UserWarning")

ALL = Record(
    windows=(
        Window(start=54.5, stop=55.2, rate=3e3),
        Window(start=54.45, stop=55.5, rate=1e3, theta=2.0, envelope=7),
        Window(start=60, stop=61, rate=1e3),
    ),
    poincare=Poincare(start=54.6),
    audit_every_step=True,
)


RAMPS = (Ramp(parameter="Omega", to=14.0, start=54.5, end=55.5), Ramp(parameter="N", to=300.0, start=54.9, end=55.2))


Options = dict[str, Any]
HOW = inspect.signature(Execution).parameters.keys()


class Interrupted(Exception):
    pass


def simulated(*args: Any, **options: Any) -> Result:
    """`simulate` with an `Execution` of those options that belong there."""
    how = {name: options.pop(name) for name in HOW & options.keys()}
    return simulate(*args, **options, execution=Execution(**how))


@pytest.fixture(scope="module")
def separating() -> State:
    """The first loss of contact."""
    return simulated(P, 60, stop_at="first_separation").final_state


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "x"


@pytest.fixture
def run(separating: State, file: Path) -> Options:
    """What a run with a checkpoint is given."""
    return {"initial_state": separating, "checkpoint": file}


@pytest.fixture(autouse=True)
def _many_pauses(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(SIMULATE, "STEPS_PER_PAUSE", 120)


def interrupted_after(pauses: int) -> Callable[[float], None]:
    """To be given as ``progress``: raises at one of the pauses."""
    left = iter(range(pauses))

    def progress(time: float) -> None:
        if next(left, None) is None:
            raise Interrupted

    return progress


def interrupt(pauses: int, *args: Any, **options: Any) -> None:
    """Run until an interruption."""
    with pytest.raises(Interrupted):
        simulated(*args, **options, checkpoint_every=0, progress=interrupted_after(pauses))


RUNS: dict[str, Options] = {
    "everything": {"record": ALL},
    "nothing kept": {"record": Record(events=False)},
    "stopped": {"initial_state": None, "stop_at": "first_separation", "record": Record(audit_every_step=True)},
    "out of steps": {"max_steps": 900, "record": ALL},
    "on ramps": {"record": ALL.replace(poincare=None), "ramps": RAMPS},
}


@pytest.mark.compiled
class TestGoingOn:
    @pytest.mark.parametrize("name", RUNS)
    def test_the_result_is_that_of_an_undisturbed_run(self, separating: State, file: Path, name: str) -> None:
        options = {"initial_state": separating} | RUNS[name]
        undisturbed = simulated(P, 55.6, **options)
        for pauses in (1, 1, 0, 2):
            interrupt(pauses, P, 55.6, **options, checkpoint=file)
        resumed = simulated(P, 55.6, **options, checkpoint=file)
        same(undisturbed, resumed)
        assert resumed.statistics["wall_time"] > 0
        assert os.listdir(file.parent) == []

    def test_an_interruption_when_all_is_done(self, run: Options) -> None:
        """The very end is no place to go on from: one more step, of no length, would be counted."""
        pauses: list[float] = []
        run["record"] = ALL
        undisturbed = simulated(P, 55, **run | {"checkpoint": None}, progress=pauses.append)
        interrupt(len(pauses) - 1, P, 55, **run)
        same(simulated(P, 55, **run), undisturbed)

    @pytest.mark.parametrize("every", [0, 3600])
    @pytest.mark.parametrize("another_run", [False, True])
    def test_what_is_not_this_runs_is_never_lost(
        self, run: Options, file: Path, another_run: bool, every: float
    ) -> None:
        if another_run:
            interrupt(3, P, 55, **run)
        else:
            file.write_text("kept")
        content = file.read_bytes()
        earlier = file.with_name("x.other")
        earlier.write_text("kept before")
        simulated(P, 54.5, **run, checkpoint_every=every)
        assert earlier.read_text() == "kept before"
        earlier.unlink()
        (aside,) = file.parent.iterdir()
        assert re.fullmatch(r"x\.[0-9a-f]{12}\.other", aside.name)
        assert aside.read_bytes() == content

    def test_runs_that_take_turns_on_one_path_each_go_on(self, run: Options, file: Path) -> None:
        """The second run's checkpoint took the place of the first one's, which was lost."""
        ends = 55.0, 55.5
        seen: dict[float, list[float]] = {}
        undisturbed = {
            end: simulated(P, end, **run | {"checkpoint": None}, progress=seen.setdefault(end, []).append)
            for end in ends
        }
        for pauses in (2, 1):
            for end in ends:
                interrupt(pauses, P, end, **run)
        for end in ends:
            rest: list[float] = []
            same(simulated(P, end, **run, progress=rest.append), undisturbed[end])
            assert rest == seen[end][5:]  # three pauses and two
        assert os.listdir(file.parent) == []

    def test_another_runs_checkpoint_that_cannot_be_moved_ends_this_run(
        self, run: Options, file: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        interrupt(3, P, 55, **run)
        content = file.read_bytes()

        def refused(*_: object) -> None:
            raise PermissionError(13, "Permission denied")

        monkeypatch.setattr(os, "replace", refused)
        with pytest.raises(ParameterError, match=r"checkpoint='.*x': is of another run .* cannot be renamed"):
            simulated(P, 54.5, **run, checkpoint_every=0)
        assert file.read_bytes() == content


OTHERS: dict[str, tuple[Parameters, float, Options]] = {
    "parameters": (P.replace(mu_k=0.23), 55, {}),
    "t_end": (P, 55.25, {}),
    "tol": (P, 55, {"tol": 1e-9}),
    "record": (P, 55, {"record": Record(windows=ALL.windows[:1])}),
    "stop_at": (P, 55, {"stop_at": "first_separation"}),
    "max_steps": (P, 55, {"max_steps": 300}),
    "initial state": (P, 55, {"initial_state": lambda start: start.replace(psi=np.nextafter(start.psi, 1))}),
}


@pytest.mark.compiled
class TestNotTrusted:
    @pytest.mark.parametrize("name", OTHERS)
    def test_the_checkpoint_of_another_run(self, run: Options, caplog: pytest.LogCaptureFixture, name: str) -> None:
        run["record"] = ALL
        interrupt(3, P, 55, **run)
        p, t_end, options = OTHERS[name]
        options = {key: value(run[key]) if callable(value) else value for key, value in options.items()}
        found = simulated(p, t_end, **run | options)
        phrase = re.search(r"checkpoint (.*) ignored: of another run \(other (.*)\)", caplog.text)
        assert phrase is not None
        assert phrase[1] == str(run["checkpoint"])
        assert name in phrase[2].split(", ")
        same(found, simulated(p, t_end, **run | options | {"checkpoint": None}))

    @pytest.mark.parametrize(("function", "name"), [("source_hash", "sources"), ("versions", "versions")])
    def test_another_engine(
        self, run: Options, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch, function, name
    ) -> None:
        interrupt(3, P, 55, **run)
        monkeypatch.setattr(api, function, lambda *_: "another")
        begun: list[float] = []
        simulated(P, 55, **run, progress=begun.append)
        assert f"(other {name})" in caplog.text
        assert begun[0] < run["initial_state"].time + 0.2

    def test_a_byte_changed_anywhere(self, run: Options, file: Path, caplog: pytest.LogCaptureFixture) -> None:
        run["record"] = ALL
        interrupt(1, P, 54.8, **run)
        content = file.read_bytes()
        undisturbed = simulated(P, 54.8, **run | {"checkpoint": None})
        places = [*range(40), *np.random.default_rng(1).integers(0, len(content), 40), len(content) - 1]
        for place in places:
            caplog.clear()
            changed = bytearray(content)
            changed[place] ^= 1 << int(place) % 8
            file.write_bytes(changed)
            same(simulated(P, 54.8, **run), undisturbed)
            assert "ignored" in caplog.text

    @pytest.mark.parametrize(
        "content", [b"", b"\0" * 10_000, b"discArys" * 1000, b"discCkpt" * 1000, pickle.dumps(list(range(1000)))]
    )
    def test_something_else(self, run: Options, file: Path, content: bytes) -> None:
        file.write_bytes(content)
        interrupt(2, P, 55, **run)
        same(simulated(P, 55, **run), simulated(P, 55, **run | {"checkpoint": None}))
        assert not file.exists()


class TestArguments:
    def test_all_faults_in_one_error(self, tmp_path: Path) -> None:
        faults = faults_of(simulated, P, -1, checkpoint=tmp_path / "no" / "such", checkpoint_every=-1)
        assert [fault.partition("=")[0] for fault in faults] == ["t_end", "checkpoint", "checkpoint_every"]

    @pytest.mark.parametrize(
        "path", ["", ".", "/", 3, b"x", "\0", "x" * 5000 + "/x", __file__ + "/x", "x" * 240, "é" * 120]
    )
    def test_a_place_for_no_file(self, path: Any) -> None:
        rule = "must be a file in a folder that exists, with a name of at most 233 bytes"
        with pytest.raises(ParameterError, match=rf"^checkpoint=.*{rule}$"):
            simulated(P, 1, checkpoint=path)

    @pytest.mark.compiled
    def test_a_checkpoint_that_cannot_be_written_does_not_end_the_run(
        self, run: Options, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """The disk is full for a while, half-way through a checkpoint."""
        write, calls = np.savez, []

        def failing(file: Any, **arrays: Any) -> None:
            calls.append(file)
            write(file, **arrays)
            if 3 < len(calls) < 6:
                file.truncate(file.tell() - 1)
                raise OSError(28, "No space left on device")

        run["record"] = ALL
        monkeypatch.setattr(np, "savez", failing)
        interrupt(4, P, 55.6, **run)
        interrupt(4, P, 55.6, **run)
        assert caplog.text.count("not written: [Errno 28]") == 2
        assert len(calls) == 10
        same(simulated(P, 55.6, **run), simulated(P, 55.6, **run | {"checkpoint": None}))


@pytest.mark.compiled
class TestCommands:
    def test_run(self, file: Path, capsys: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture) -> None:
        interrupt(2, P, 2.0, checkpoint=file)
        words = ("run", "--N", "385", "--Omega", "15.1", "--t-end", "2")
        resumed = Command(capsys).out(*words, "--checkpoint", str(file)).splitlines()
        assert f"from checkpoint {file}" in caplog.text
        assert not file.exists()
        undisturbed = Command(capsys).out(*words).splitlines()
        assert [line for line in resumed if "wall" not in line] == [line for line in undisturbed if "wall" not in line]

    def test_a_case_of_the_workflow(self, tmp_path: Path) -> None:
        window = Window(start=0, stop=5, rate=50, envelope=10)
        spec = CaseSpec(parameters=P, t_end=5.0, windows=(("history", window),), events=(0.0, 5.0))
        interrupt(2, P, spec.t_end, record=spec.record, checkpoint=tmp_path / ".A.checkpoint")
        done = processes.run(sys.executable, "workflow/scripts/simulate_case.py", spec.canonical, tmp_path / "A.nc")
        assert "continues at t = " in done.stderr
        assert os.listdir(tmp_path) == ["A.nc"]
        assert load(tmp_path / "A.nc").identical(run_case(spec))


def test_what_a_run_left_that_was_killed_while_it_wrote_is_removed(tmp_path: Path) -> None:
    left, of_another = (tmp_path / f".{name}.0123456789abcdef.tmp" for name in ("checkpoint", "checkpoint.nc"))
    left.touch()
    of_another.touch()
    simulate(P, 0.1, execution=Execution(checkpoint=tmp_path / "checkpoint"))
    assert [*tmp_path.iterdir()] == [of_another]


# ----------------------------------------------------------------------------------------------------
# Long runs


HOUR = """
import logging, pickle, sys
from disc_model import Execution, Parameters, Poincare, Record, Window, simulate
logging.basicConfig(level=logging.INFO)
windows = Window(start=0, stop=3600, rate=200, envelope=100), Window(start=3000, stop=3001, rate=1e4)
record = Record(windows=windows, poincare=Poincare(start=1000))
execution = Execution(checkpoint=sys.argv[2], checkpoint_every=0.3)
result = simulate(Parameters(N=385, Omega=15.1), 3600, record=record, execution=execution)
pickle.dump(result, open(sys.argv[1], "wb"))
"""


@pytest.mark.slow
def test_an_hour_killed_several_times(tmp_path: Path) -> None:
    """SIGKILL, at any moment, leaves no chance to tidy up."""
    file, log = tmp_path / "checkpoint", tmp_path / "log"

    def start(name: str, checkpoint: Path) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-c", HOUR, str(tmp_path / name), str(checkpoint)]
        return subprocess.Popen(command, stderr=log.open("a"))

    for delay in (0.4, 0.05, 0.01, 0.2):
        size = file.stat().st_size if file.exists() else 0
        process = start("resumed", file)
        while not (file.exists() and file.stat().st_size > size):
            assert process.poll() is None, log.read_text()
            time.sleep(0.001)
        time.sleep(delay)
        process.kill()
        assert process.wait() < 0, "it was done before it could be killed"
    assert start("resumed", file).wait() == 0
    assert start("undisturbed", tmp_path / "other").wait() == 0
    assert log.read_text().count("continues at t = ") == 4
    resumed, undisturbed = (pickle.loads((tmp_path / name).read_bytes()) for name in ("resumed", "undisturbed"))
    same(resumed, undisturbed)
    assert undisturbed.statistics["events"] > 1e6
    assert {path.name for path in tmp_path.iterdir()} == {"resumed", "undisturbed", "log"}


TWO_HOURS = """
import json, resource
from disc_model import Execution, Parameters, Record, simulate
seen = []
def progress(time):
    seen.append((time, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss))
execution = Execution(progress=progress)
result = simulate(Parameters(N=385, Omega=15.1), 7200, record=Record(events=False), execution=execution)
print(json.dumps({"seen": seen, "status": result.status.value, **result.statistics}))
"""


@pytest.mark.slow
def test_two_hours_need_no_more_memory_than_twelve_minutes() -> None:
    found = json.loads(processes.python(TWO_HOURS).stdout)
    assert found["status"] == "ok"
    assert found["events"] >= 1e6
    assert found["energy_residual"] < 1e-10
    unit = 1 if sys.platform == "darwin" else 1024
    early = max(size for time, size in found["seen"] if time <= 720)
    assert (found["seen"][-1][1] - early) * unit < 2e6
