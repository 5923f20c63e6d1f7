"""What is shown of long work: on a terminal, and elsewhere."""

import functools
import io
import sys
import threading

import numba
import pytest

from disc_model import Execution, Parameters, display, simulate
from disc_model.engine.jit import cache
from disc_model.simulation import api

P = Parameters(N=200, Omega=50, n_diameters=1)


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


EVERYWHERE = pytest.mark.parametrize("kind", [Terminal, io.StringIO])


@EVERYWHERE
@pytest.mark.parametrize(("patience", "option", "shown"), [(0.0, None, True), (60.0, None, False), (0.0, False, False)])
def test_only_a_long_simulation_is_shown(
    kind: type[io.StringIO], monkeypatch: pytest.MonkeyPatch, patience: float, option: bool | None, shown: bool
) -> None:
    stderr = kind()
    monkeypatch.setattr(sys, "stderr", stderr)
    monkeypatch.setattr(display, "PATIENCE", patience)
    monkeypatch.setattr(api, "STEPS_PER_PAUSE", 10)  # as if it were long: it pauses
    simulate(P, 0.05, execution=Execution(progress=option))
    assert ("simulating 0.05 s" in stderr.getvalue()) == shown
    assert bool(stderr.getvalue()) == shown


@pytest.mark.skipif(bool(numba.config.DISABLE_JIT), reason="nothing is compiled")
@EVERYWHERE
@pytest.mark.parametrize("report", [True, False])
def test_compilation_is_said_in_one_line(
    kind: type[io.StringIO], monkeypatch: pytest.MonkeyPatch, report: bool
) -> None:
    stderr = kind()
    monkeypatch.setattr(sys, "stderr", stderr)
    monkeypatch.setattr(cache.LINES, "shown", set())
    inner = numba.njit(lambda x: x + 1)
    outer = numba.njit(lambda x: inner(x) + 1)
    with cache.compiling(report):
        outer(1)
        outer(2.0)
    assert stderr.getvalue() == f"{cache.COMPILING}\n" * report


def test_a_wait_for_another_process_is_said_and_its_helpers_are_read(monkeypatch: pytest.MonkeyPatch, tmp_path) -> None:
    fcntl = pytest.importorskip("fcntl")
    stderr = io.StringIO()
    monkeypatch.setattr(sys, "stderr", stderr)
    monkeypatch.setattr(cache, "folder", lambda: tmp_path)
    monkeypatch.setattr(cache.LINES, "shown", set())
    monkeypatch.setattr(cache, "stored_helpers", functools.cache(lambda codegen: object()))
    before = cache.stored_helpers(None)
    with cache.compiling(), cache.lock("free"):
        pass
    assert (stderr.getvalue(), cache.stored_helpers(None)) == ("", before)
    with (tmp_path / "taken.lock").open("a") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        threading.Timer(0.2, fcntl.flock, (file, fcntl.LOCK_UN)).start()
        with cache.compiling(), cache.lock("taken"):
            pass
    assert stderr.getvalue() == f"{cache.WAITING}\n"
    assert cache.stored_helpers(None) is not before
