"""The files of compiled kernels: found again, and never trusted when damaged."""

import subprocess
import sys
import threading
import time
from pathlib import Path

import numba
import pytest

from disc_model import Parameters, floquet, simulate
from disc_model.engine import event_loop
from disc_model.engine.jit import cache
from tests.processes import python, run

KERNEL = """
import numba
from disc_model.engine.jit import kernel
@kernel
def twice(x):
    return 2 * x
print(twice(21), sum(twice.stats.cache_hits.values()))
"""
OUTER = """
from disc_model.engine.jit import kernel
@kernel
def inner(x):
    for i in range(3):
        x += 0.5 * x + i
    return x
@kernel
def outer(x):
    return inner(x) + 1.0
print(inner(1.0), outer(1.0))
"""
pytestmark = pytest.mark.compiled


def ask_for_a_kernel(
    tmp_path: Path, before: str = "", code: str = KERNEL
) -> subprocess.CompletedProcess[str]:
    """A process that asks for a kernel, and prints 42 and how often it was found in the cache."""
    script = tmp_path / "script.py"
    script.write_text(before + code)
    return run(sys.executable, script, NUMBA_CACHE_DIR=str(tmp_path / "cache"))


def test_what_was_written_comes_back_and_any_damage_is_noticed(tmp_path: Path) -> None:
    path = tmp_path / "new" / "a.kernel"
    assert cache.read(path) is None
    cache.write(path, list(range(20)))
    assert list(path.parent.iterdir()) == [path]
    whole = path.read_bytes()
    for at in range(len(whole)):
        path.write_bytes(whole[:at] + bytes([whole[at] ^ 1]) + whole[at + 1 :])
        assert cache.read(path) is None
        path.write_bytes(whole[:at])
        assert cache.read(path) is None
    path.write_bytes(whole)
    assert cache.read(path) == list(range(20))


def test_what_is_in_the_cache_is_found_again_and_what_is_damaged_or_gone_is_compiled(
    tmp_path: Path,
) -> None:
    """As when one of two kernels was compiled before an interruption: the other's file held a stub,
    and it crashed."""

    def the(name: str) -> Path:
        (path,) = tmp_path.rglob(name)
        return path

    printed = [ask_for_a_kernel(tmp_path, code=KERNEL + OUTER).stdout.splitlines()]
    the("*.outer.*.kernel").unlink()
    printed.append(ask_for_a_kernel(tmp_path, code=KERNEL + OUTER).stdout.splitlines())
    twice = the("*.twice.*.kernel")
    twice.write_bytes(twice.read_bytes()[: twice.stat().st_size // 2])
    printed.append(ask_for_a_kernel(tmp_path, code=KERNEL + OUTER).stdout.splitlines())
    assert [lines[0] for lines in printed] == ["42 0", "42 1", "42 0"]
    assert [lines[1] for lines in printed] == ["6.875 7.875"] * 3


def test_a_folder_that_cannot_be_written_costs_time_not_the_result(tmp_path: Path) -> None:
    (tmp_path / "cache").write_text("no folder")
    done = ask_for_a_kernel(tmp_path)
    assert done.stdout == "42 0\n"
    assert done.stderr.count("compiled kernels cannot be kept there") == 1


# ---------------------------------------------------------------- a numba without the parts that
# this needs
LACKS = {
    "cache": "import numba.core.dispatcher as d; d.NullCache.load_overload = property()\n",
    "merging": "import sys; sys.modules['disc_model.engine.jit.merging'] = None\n",
}


@pytest.mark.parametrize("part", LACKS)
def test_without_a_part_of_numba_kernels_work_and_it_is_said_once(
    part: str, tmp_path: Path
) -> None:
    done = ask_for_a_kernel(tmp_path, before=LACKS[part])
    assert done.stdout.split()[0] == "42"
    assert done.stderr.count("otherwise than expected") == 1


# ---------------------------------------------------------------- two processes that need the same
# kernel at once


def test_a_process_waits_while_another_compiles_the_same_kernel(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fcntl = pytest.importorskip("fcntl")
    monkeypatch.setattr(cache, "folder", lambda: tmp_path)
    with (tmp_path / "taken.lock").open("a") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        released, start = (
            threading.Timer(0.2, fcntl.flock, (file, fcntl.LOCK_UN)),
            time.perf_counter(),
        )
        released.start()
        with cache.lock("taken"):
            assert time.perf_counter() - start >= 0.2


@pytest.mark.skipif(bool(numba.config.DISABLE_JIT), reason="nothing is compiled")
def test_a_first_call_with_kernels_in_the_cache_compiles_nothing() -> None:
    """A helper that Python called was compiled in every process, for 0.2 s."""
    code = """
from numba.core import event
import disc_model as dm
p = dm.Parameters(N=385, Omega=15)
class Told(event.Listener):
    def on_start(self, found): print(found.data["dispatcher"].py_func.__name__)
    def on_end(self, found): pass
event.register("numba:compile", Told())
dm.simulate(p, 0.1)
dm.floquet(p)
"""
    p = Parameters(N=385, Omega=15)  # its kernels are compiled here where the cache has none
    simulate(p, 0.1)
    floquet(p)
    done = python(code)
    assert not done.stdout
    assert not done.stderr  # kernels from the cache are no news
    assert Path(event_loop.run.stats.cache_path).name.startswith("engine-")
