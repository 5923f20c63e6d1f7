"""The cache of compiled kernels: found again, and never trusted when damaged."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
import textwrap
import types
import warnings
from collections.abc import Iterator
from pathlib import Path
from unittest import mock

import numba
import pytest
from numba.core import caching, dispatcher, serialize

from disc_model.engine import cache, machine
from disc_model.engine.cache import kept_in
from disc_model.engine.kernel_files import KernelCache, KernelFiles

KERNEL = """
    import sys
    import numba
    from disc_model.engine.cache import kept_in
    with kept_in(sys.argv[1]):
        @numba.njit(cache=True)
        def twice(x):
            return 2 * x
    print(twice(21), sum(twice.stats.cache_hits.values()))
"""

WITHOUT = """
import sys
sys.modules["disc_model.engine.kernel_files"] = None  # its import fails
"""


def asked_for(tmp_path: Path, before: str = "") -> subprocess.CompletedProcess[str]:
    """A process that asks for a kernel, and prints 42 and how often it was found in the cache."""
    script = tmp_path / "script.py"  # numba keeps nothing of code that has no file
    script.write_text(before + textwrap.dedent(KERNEL))
    command = [sys.executable, str(script), str(tmp_path / "cache")]
    return subprocess.run(command, capture_output=True, text=True, check=True)


@pytest.fixture
def files(tmp_path: Path) -> KernelFiles:
    return KernelFiles(str(tmp_path), "module.kernel-1.py3", b"source")


def only(folder: Path) -> Path:
    (path,) = folder.glob("*.kernel")
    return path


def test_gives_back_what_was_saved_for_a_key(files: KernelFiles, tmp_path: Path) -> None:
    files.save(("float64",), [1, 2])
    files.save(("int64",), [3])
    assert files.load(("float64",)) == [1, 2]
    assert files.load(("int64",)) == [3]
    assert files.load(("int8",)) is None
    assert not list(tmp_path.glob("*.tmp"))


def test_other_sources_find_nothing(files: KernelFiles, tmp_path: Path) -> None:
    files.save("key", 1)
    assert KernelFiles(str(tmp_path), "module.kernel-1.py3", b"changed").load("key") is None


def test_what_another_numba_saved_is_not_unpacked(files: KernelFiles, tmp_path: Path) -> None:
    """It may name what this version does not have, and every simulation ended there."""
    vanished = types.ModuleType("vanished")
    vanished.Thing = type("Thing", (), {"__module__": "vanished"})
    other = KernelFiles(str(tmp_path), "module.kernel-1.py3", b"source")
    other._stamp = ("0.1", b"source")
    with mock.patch.dict(sys.modules, vanished=vanished):
        other.save("key", vanished.Thing)
    with pytest.raises(ModuleNotFoundError):
        pickle.loads(pickle.loads(only(tmp_path).read_bytes()[32:])[1])
    assert files.load("key") is None


def test_any_damage_is_noticed(files: KernelFiles, tmp_path: Path) -> None:
    files.save("key", list(range(20)))
    path = only(tmp_path)
    whole = path.read_bytes()
    for at in range(len(whole)):
        path.write_bytes(whole[:at] + bytes([whole[at] ^ 1]) + whole[at + 1 :])
        assert files.load("key") is None
        path.write_bytes(whole[:at])
        assert files.load("key") is None
    path.write_bytes(whole)
    assert files.load("key") == list(range(20))


def test_a_file_of_another_key_is_not_taken(files: KernelFiles, tmp_path: Path) -> None:
    """As happens with numba's own index when two processes compile at the same time."""
    files.save("a", 1)
    first = only(tmp_path)
    files.save("b", 2)
    (second,) = set(tmp_path.glob("*.kernel")) - {first}
    os.replace(second, first)
    assert files.load("a") is None


def test_flush_forgets_this_kernel_only(files: KernelFiles, tmp_path: Path) -> None:
    other = KernelFiles(str(tmp_path), "module.other-9.py3", b"source")
    files.save("a", 1)
    other.save("a", 2)
    files.flush()
    assert files.load("a") is None
    assert other.load("a") == 2


@pytest.mark.compiled
def test_a_damaged_kernel_is_compiled_again(tmp_path: Path) -> None:
    assert asked_for(tmp_path).stdout == "42 0\n"
    assert asked_for(tmp_path).stdout == "42 1\n"
    path = only(tmp_path / "cache")
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2])
    assert asked_for(tmp_path).stdout == "42 0\n"
    assert asked_for(tmp_path).stdout == "42 1\n"
    assert path.stat().st_size == len(whole)


@pytest.mark.compiled
def test_a_full_disk_costs_time_not_the_result(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(KernelFiles, "save", full)
    with kept_in(str(tmp_path / "cache")):

        @numba.njit(cache=True)
        def thrice(x: int) -> int:
            return 3 * x

    with pytest.warns(RuntimeWarning, match=r"cannot be kept there \(No space left on device\)"):
        assert thrice(14) == 42


def test_other_users_of_numba_are_left_alone(tmp_path: Path) -> None:
    before = numba.config.CACHE_DIR
    with kept_in(str(tmp_path)):
        assert isinstance(dispatcher.FunctionCache(only), KernelCache)
    assert dispatcher.FunctionCache is caching.FunctionCache
    assert before == numba.config.CACHE_DIR


@pytest.mark.skipif(bool(numba.config.DISABLE_JIT), reason="nothing is compiled")
def test_the_engine_uses_it() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert isinstance(machine.run._cache, KernelCache)
    assert Path(machine.run.stats.cache_path).name.startswith("engine-")


# ---------------------------------------------------------------- a numba without the parts that checksums need
PARTS = {
    "locator": (caching, "UserProvidedCacheLocator"),
    "implementation": (caching, "CompileResultCacheImpl"),
    "serializer": (serialize, "dumps"),
}


@pytest.fixture
def another_numba(monkeypatch: pytest.MonkeyPatch) -> Iterator[pytest.MonkeyPatch]:
    """Parts of numba can be taken away, and kernel files are defined anew with what is left."""
    monkeypatch.delitem(sys.modules, "disc_model.engine.kernel_files")
    cache._say_once.cache_clear()
    yield monkeypatch
    cache._say_once.cache_clear()


def falls_back() -> None:
    """Two kernels in turn have numba's own cache; it is said once."""
    with pytest.warns(RuntimeWarning, match="keeps compiled kernels in another way than expected") as said:
        assert [cache._cache_of(lambda _: "numba's own", only) for _ in range(2)] == ["numba's own"] * 2
    assert len(said) == 1


@pytest.mark.parametrize("part", PARTS)
def test_without_a_part_numba_keeps_its_own_files(part: str, another_numba: pytest.MonkeyPatch) -> None:
    another_numba.delattr(*PARTS[part])
    falls_back()


def test_files_under_another_name(another_numba: pytest.MonkeyPatch) -> None:
    another_numba.setattr(caching.Cache, "__init__", lambda self, _: setattr(self, "_impl", self._impl_class(only)))
    falls_back()


def test_a_dispatcher_that_has_no_cache(another_numba: pytest.MonkeyPatch, tmp_path: Path) -> None:
    another_numba.delattr(dispatcher, "FunctionCache")
    before = numba.config.CACHE_DIR
    with pytest.warns(RuntimeWarning, match="numba.core.dispatcher has no FunctionCache"), kept_in(str(tmp_path)):
        assert str(tmp_path) == numba.config.CACHE_DIR
    assert before == numba.config.CACHE_DIR
    assert not hasattr(dispatcher, "FunctionCache")


@pytest.mark.compiled
def test_kernels_are_found_again_in_numbas_own_files(tmp_path: Path) -> None:
    for hits in ("0", "1"):
        done = asked_for(tmp_path, before=WITHOUT)
        assert done.stdout.split() == ["42", hits]
        assert done.stderr.count("RuntimeWarning") == 1
    assert list((tmp_path / "cache").rglob("*.nbi"))
