"""Kernels that come with the package: who has a fitting processor compiles nothing, and all others as without them."""

import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

import disc_model
from disc_model.engine.cache import LEVELS, SHIPPED, VERSIONS
from tests.instruction_sets import why_not
from tests.processes import python

ROOT = Path(__file__).parents[2]
CALL = "r = dm.simulate(p, 0.1); print(repr(r.final_state.psi), len(r.events))"
SETTING = "import disc_model as dm; p = dm.Parameters(N=385, Omega=15)\n"
LEVEL = next(
    (level for level, name in zip(LEVELS, ("skylake-avx512", "haswell"), strict=True) if not why_not(name)), ""
)
pytestmark = [
    pytest.mark.slow,
    pytest.mark.compiled,
    pytest.mark.skipif(not LEVEL, reason="this processor has neither AVX2 nor AVX-512"),
]


class Copy:
    """A copy of the package with kernels for this processor's level."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        package = folder / "disc_model"
        shutil.copytree(Path(disc_model.__file__).parent, package, ignore=shutil.ignore_patterns("__pycache__"))
        self.kernels = package / SHIPPED.relative_to(Path(disc_model.__file__).parent) / LEVEL
        code = (
            f"import sys; sys.path.insert(0, {str(ROOT / 'workflow/scripts')!r})\n"
            f"from build_wheel import *\n"
            f"compile_kernels({LEVEL!r}, Path({str(self.kernels)!r}), ['simulate-rigid_vertical'])"
        )
        self.run(code, cache="not_used")

    def run(self, code: str, cache: str, **environment: str) -> subprocess.CompletedProcess[str]:
        own = {"PYTHONPATH": str(self.folder), "NUMBA_CACHE_DIR": str(self.folder / cache)}
        return python(code, **own | environment)

    def compiled(self, cache: str) -> int:
        return len(list((self.folder / cache).rglob("*.kernel")))


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Copy:
    return Copy(tmp_path_factory.mktemp("copy"))


def test_nothing_is_compiled_where_kernels_came_along(copy: Copy) -> None:
    done = copy.run(SETTING + CALL, "empty")
    assert copy.compiled("empty") == 0
    assert "RuntimeWarning" not in done.stderr
    assert done.stdout.split()[1] == "13"  # releases and stops in 0.1 s


def _of_another_numba(copy: Copy) -> None:
    versions = copy.kernels / VERSIONS
    versions.write_text(versions.read_text().replace("numba ", "numba 9."))


def _damaged(copy: Copy) -> None:
    [kernel] = copy.kernels.glob("event_loop.run.*")
    kernel.write_bytes(kernel.read_bytes()[:-1] + b"?")


@pytest.mark.parametrize(
    ("change", "environment", "phrase"),
    [
        (None, {"NUMBA_CPU_NAME": "haswell", "NUMBA_CPU_FEATURES": "+avx2,+fma"}, "no kernels came with the package"),
        (_of_another_numba, {}, "these kernels are of"),
        (_damaged, {}, "is damaged"),
    ],
    ids=["another processor", "another numba", "damaged"],
)
def test_what_does_not_fit_is_compiled_and_it_is_said_in_one_line(
    copy: Copy, change: Callable[[Copy], None] | None, environment: dict[str, str], phrase: str, tmp_path: Path
) -> None:
    before = {path: path.read_bytes() for path in copy.kernels.iterdir()}
    if change:
        change(copy)
    done = copy.run(SETTING + CALL, str(tmp_path), **environment)
    for path, content in before.items():
        path.write_bytes(content)
    assert done.stderr.count(phrase) == done.stderr.count("RuntimeWarning") == 1
    assert len(list(tmp_path.rglob("*.kernel"))) == 1
    assert done.stdout.split()[1] == "13"
