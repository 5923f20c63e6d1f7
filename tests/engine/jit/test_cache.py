"""The files of compiled kernels: found again, and compiled again when damaged."""

import subprocess
import sys
from pathlib import Path

import numba
import pytest

from disc_model import Parameters, floquet, simulate
from disc_model.engine import loop
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


def ask_for_a_kernel(tmp_path: Path, code: str = KERNEL) -> subprocess.CompletedProcess[str]:
    """A process that asks for a kernel, and prints 42 and how often it was found in the cache."""
    script = tmp_path / "script.py"
    script.write_text(code)
    path = tmp_path / "cache"
    return run(sys.executable, script, NUMBA_CACHE_DIR=str(path))


def the_file(tmp_path: Path, name: str) -> Path:
    (path,) = tmp_path.rglob(name)
    return path


def test_what_is_in_the_cache_is_found_again_and_what_is_gone_is_compiled(tmp_path: Path) -> None:
    """As when one of two kernels was compiled before an interruption: the other's file held a stub,
    and it crashed."""
    first = ask_for_a_kernel(tmp_path, KERNEL + OUTER).stdout.splitlines()
    the_file(tmp_path, "*.outer*.nbc").unlink()
    second = ask_for_a_kernel(tmp_path, KERNEL + OUTER).stdout.splitlines()
    assert first == ["42 0", "6.875 7.875"]
    assert second == ["42 1", "6.875 7.875"]


@pytest.mark.slow
@pytest.mark.parametrize("damaged", ["*.twice*.nbc", "*.twice*.nbi"])
def test_a_damaged_file_is_compiled_again_and_replaced(tmp_path: Path, damaged: str) -> None:
    ask_for_a_kernel(tmp_path)
    path = the_file(tmp_path, damaged)
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    assert [ask_for_a_kernel(tmp_path).stdout for _ in range(2)] == ["42 0\n", "42 1\n"]


@pytest.mark.slow
def test_a_comment_leaves_the_files_as_they_are(tmp_path: Path) -> None:
    ask_for_a_kernel(tmp_path)
    assert ask_for_a_kernel(tmp_path, "# a comment\n" + KERNEL).stdout == "42 1\n"


@pytest.mark.slow
def test_a_folder_that_cannot_be_written_costs_time_not_the_result(tmp_path: Path) -> None:
    path = tmp_path / "cache"
    path.write_text("no folder")
    done = ask_for_a_kernel(tmp_path)
    assert done.stdout == "42 0\n"
    assert done.stderr.count("compiled kernels cannot be kept there") == 1


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
    assert Path(loop.run.stats.cache_path).name.startswith("engine-")
