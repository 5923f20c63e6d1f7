"""The tests notice a wrong sign or factor in any of the equations of motion.

One at a time, the mutations of tests/validation/mutants.py are made in a copy of the package, and a few quick tests are
run against the copy, without compilation: at least one of them must fail.  Against an unchanged copy all must pass.
"""

from __future__ import annotations

import ast
import os
import shutil
import subprocess
import sys
import threading
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

import pytest

import disc_model
from tests import needs
from tests.validation.mutants import MUTANTS

PACKAGE = Path(disc_model.__file__).parent
ROOT = Path(__file__).parents[2]
EQUATIONS = ("tests/validation/test_equations.py",)
TWINS = ("tests/engine/test_series.py", *EQUATIONS)
CLOSED_FORM = (
    *EQUATIONS,
    "tests/engine/test_stick_modes.py",
    "tests/engine/test_coasting.py::test_closed_form_is_the_series",
    "tests/engine/test_coasting.py::test_stick_holds_as_long_as_promised_and_not_much_longer[0-dampers]",
    "tests/engine/test_coasting.py::test_events_are_those_of_the_series",
)
DERIVATIVES = ("tests/engine/test_variational.py",)
METHODS = (
    "tests/benchmarks/methods/test_kernels.py",
    "tests/benchmarks/methods/test_short_motions.py",
    "tests/benchmarks/methods/test_phases.py",
    "tests/benchmarks/methods/test_regularised.py",
    "tests/benchmarks/methods/test_rk4.py",
    *EQUATIONS,
)
#: What notices mutations in a file, if it is not the tests of the equations.
NOTICED_BY = {
    "engine/plain.py": TWINS[:1],
    "engine/series.py": TWINS,
    "engine/coasting.py": CLOSED_FORM,
    "engine/stick_modes.py": CLOSED_FORM,
    "engine/saltation.py": DERIVATIVES,
    "engine/tangent.py": DERIVATIVES,
    "engine/variational.py": DERIVATIVES,
    "stability/return_map.py": ("tests/stability/test_cycle.py", "tests/stability/test_return_map.py", *DERIVATIVES),
    "benchmarks/methods/phases.py": METHODS,
    "benchmarks/methods/kernels.py": METHODS,
    "benchmarks/methods/regularised.py": METHODS,
    "benchmarks/methods/taylor_heyoka.py": METHODS,
    "plate.py": ("tests/test_plate.py",),
}
#: Without what a file cannot be tried.
REQUIRES = {"benchmarks/methods/taylor_heyoka.py": needs.RIVALS}
PATIENCE = 300
"""s; all that can be tried takes a tenth of that."""
WITHOUT_COMPILATION = """
import sys
from pathlib import Path
import pytest
import disc_model
assert Path(disc_model.__file__).is_relative_to(sys.argv[1]), disc_model.__file__
sys.exit(pytest.main(sys.argv[2:]))
"""


class Mutant(NamedTuple):
    """One wrong sign or factor."""

    equation: str
    file: str
    function: str
    original: str
    mutated: str

    def __str__(self) -> str:
        return f"{self.file}:{self.function}:{self.original}:{self.mutated}"

    def tests(self) -> tuple[str, ...]:
        """What has to notice it."""
        return NOTICED_BY.get(self.file, EQUATIONS)

    @property
    def possible(self) -> bool:
        """Whether the packages that its file needs are installed."""
        return self.file not in REQUIRES or REQUIRES[self.file].met

    def apply(self, source: str) -> str:
        """The file's text with the mutation in it; the original must stand in its function exactly once."""
        first, end = _lines(source, self.function)
        lines = source.splitlines(keepends=True)
        body = "".join(lines[first:end])
        count = body.count(self.original)
        assert count == 1, f"{self}: the original text occurs {count} times; bring mutants.py up to date"
        return "".join([*lines[:first], body.replace(self.original, self.mutated), *lines[end:]])


def _lines(source: str, function: str) -> tuple[int, int]:
    """First line and the line after the last of a function or method."""
    found = [
        node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.FunctionDef) and node.name == function
    ]
    assert len(found) == 1, f"{function}: {len(found)} functions of that name"
    return found[0].lineno - 1, found[0].end_lineno or 0


ALL = [Mutant(row[0], *place.split(":"), *row[1:]) for place, rows in MUTANTS.items() for row in rows]


def _run(folder: Path, mutant: Mutant | None, tests: tuple[str, ...]) -> subprocess.CompletedProcess[str]:
    """Run ``tests`` against a copy of the package in ``folder``, mutated or not."""
    shutil.copytree(PACKAGE, folder / "disc_model", ignore=shutil.ignore_patterns("__pycache__"))
    if mutant:
        path = folder / "disc_model" / mutant.file
        path.write_text(mutant.apply(path.read_text(encoding="utf-8")), encoding="utf-8")
    environment = os.environ | {
        "PYTHONPATH": str(folder),
        "PYTHONDONTWRITEBYTECODE": "1",
        "NUMBA_DISABLE_JIT": "1",
        "NUMBA_CACHE_DIR": str(folder / "cache"),
        "HYPOTHESIS_STORAGE_DIRECTORY": str(folder / "hypothesis"),
        # a thread for each mutant is enough
        **dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1"),
    }
    environment.pop("PYTEST_ADDOPTS", None)
    arguments = [
        str(folder),
        *tests,
        "-x",
        "-q",
        "-p",
        "no:cacheprovider",
        "--tb=line",
        "-m",
        "not slow and not compiled",
    ]
    try:
        return subprocess.run(
            [sys.executable, "-c", WITHOUT_COMPILATION, *arguments],
            cwd=ROOT, env=environment, capture_output=True, text=True, check=False, timeout=PATIENCE,
        )  # fmt: skip
    finally:
        shutil.rmtree(folder)


class Trials:
    """All runs, begun ahead of the tests that ask for them, as many at once as there are processors."""

    def __init__(self, folder: Path, mutants: list[Mutant]) -> None:
        self._pool = ThreadPoolExecutor(len(os.sched_getaffinity(0)))
        self._folder, self._lock, self._count = folder, threading.Lock(), 0
        files = dict.fromkeys(mutant.tests() for mutant in mutants)
        self._unchanged = {tests: self._begin(None, tests) for tests in files}
        self._mutated = {mutant: self._begin(mutant, mutant.tests()) for mutant in mutants}
        self.killed, self.tried = 0, len(mutants)

    def _begin(self, mutant: Mutant | None, tests: tuple[str, ...]) -> Future[subprocess.CompletedProcess[str]]:
        self._count += 1
        return self._pool.submit(_run, self._folder / str(self._count), mutant, tests)

    def unchanged(self, tests: tuple[str, ...]) -> subprocess.CompletedProcess[str]:
        """Outcome of the tests against the package as it is."""
        return self._unchanged[tests].result()

    def mutated(self, mutant: Mutant) -> subprocess.CompletedProcess[str]:
        """Outcome of the tests against a mutant."""
        return self._mutated[mutant].result()

    def close(self) -> None:
        """Begin no more."""
        self._pool.shutdown(cancel_futures=True)


@pytest.fixture(scope="module")
def trials(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory):
    """Runs for the mutants that were asked for."""
    wanted = [item.callspec.params["mutant"] for item in request.session.items if "mutant" in _parameters(item)]
    found = Trials(tmp_path_factory.mktemp("mutants"), [mutant for mutant in wanted if mutant.possible])
    yield found
    found.close()


def _parameters(item: pytest.Item) -> dict[str, object]:
    return getattr(getattr(item, "callspec", None), "params", {})


def test_every_original_text_is_there() -> None:
    """The table keeps up with the code; quick, so that a change of the code is noticed at once."""
    for mutant in ALL:
        changed = mutant.apply((PACKAGE / mutant.file).read_text(encoding="utf-8"))
        compile(changed, mutant.file, "exec")
    assert len(set(ALL)) == len(ALL)


@pytest.mark.slow
@pytest.mark.parametrize("mutant", ALL, ids=str)
def test_a_mutant_is_killed(mutant: Mutant, trials: Trials) -> None:
    if not mutant.possible:
        pytest.skip(REQUIRES[mutant.file].reason)
    unchanged = trials.unchanged(mutant.tests())
    assert unchanged.returncode == pytest.ExitCode.OK, unchanged.stdout + unchanged.stderr
    done = trials.mutated(mutant)
    # anything else is no verdict: not collected, not found, interrupted
    assert done.returncode in (pytest.ExitCode.OK, pytest.ExitCode.TESTS_FAILED), done.stdout + done.stderr
    assert done.returncode == pytest.ExitCode.TESTS_FAILED, f"{mutant} survives ({mutant.equation})"
    trials.killed += 1


@pytest.mark.slow
def test_all_are_killed(trials: Trials, capsys: pytest.CaptureFixture[str]) -> None:
    with capsys.disabled():
        print(f"\nmutants killed: {trials.killed} of {trials.tried}")
    assert trials.killed == trials.tried
