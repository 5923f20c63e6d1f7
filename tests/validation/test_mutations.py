"""The tests notice a wrong sign, factor or comparison in any of the equations of motion.

One at a time, the changes of tests/validation/mutants.py are made in a copy of the package, and a few quick tests are
run against the copy, without compilation: at least one of them must fail.  Against an unchanged copy all must pass.
"""

from __future__ import annotations

import compileall
import os
import shutil
import signal
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

import pytest

from tests import needs
from tests.validation import trial
from tests.validation.mutants import EQUIVALENT, PACKAGE, Mutant, all_mutants

LAWS = "tests/validation/test_contact_laws.py"
RAMPS = (
    "tests/simulation/test_ramps.py",
    *(
        f"tests/validation/test_ramps.py::test_{name}"
        for name in ("series_against_the_reference", "a_block_on_a_belt", "the_drive_goes_on_turning")
    ),
    "tests/validation/test_ramps.py::test_energy_balance_of_every_step",
)
EQUATIONS = ("tests/validation/test_equations.py", LAWS)
TWINS = ("tests/engine/test_series.py", *EQUATIONS, *RAMPS)
CLOSED_FORM = (
    *EQUATIONS,
    "tests/engine/test_stick_modes.py",
    "tests/engine/test_coasting.py::test_closed_form_is_the_series",
    "tests/engine/test_coasting.py::test_stick_holds_as_long_as_promised_and_not_much_longer[0-dampers]",
    "tests/engine/test_coasting.py::test_a_spring_that_pulls_hard_already_leaves_less_time",
    "tests/engine/test_coasting.py::test_events_are_those_of_the_series",
)
DERIVATIVES = ("tests/engine/test_variational.py",)
SECTION = ("tests/stability/test_return_map.py", *DERIVATIVES)
RIVALS = "tests/benchmarks/methods"
METHODS = (*(f"{RIVALS}/test_{name}.py" for name in ("kernels", "rk4", "regularised", "short_motions")), *EQUATIONS)
#: What notices changes of a file, if it is not the tests of the equations.
NOTICED_BY = {
    "engine/series.py": TWINS,
    "engine/audit.py": (*EQUATIONS, *RAMPS),
    "engine/contact_series.py": (LAWS, *RAMPS),
    "engine/dense_output.py": (*EQUATIONS, *RAMPS),
    "engine/layout.py": (*CLOSED_FORM, *RAMPS, "tests/engine/test_layout.py"),
    "engine/sampling.py": (*EQUATIONS, *RAMPS),
    "engine/stepping.py": RAMPS,
    "engine/laws.py": (*EQUATIONS, *DERIVATIVES),
    "engine/switches.py": (*EQUATIONS, *DERIVATIVES),
    "simulation/ramps.py": RAMPS,
    "engine/coasting.py": CLOSED_FORM,
    "engine/stick_modes.py": CLOSED_FORM,
    "engine/saltation.py": DERIVATIVES,
    "engine/tangent.py": DERIVATIVES,
    "engine/variational.py": SECTION,
    "stability/return_map.py": SECTION,
    "stability/sliding.py": ("tests/stability/test_sliding.py",),
    "benchmarks/methods/phases.py": METHODS,
    "benchmarks/methods/kernels.py": METHODS,
    "benchmarks/methods/taylor_heyoka.py": METHODS,
    "flexibility.py": ("tests/test_flexibility.py",),
    "plate.py": ("tests/test_plate.py",),
}
#: Without what a file cannot be tried.
REQUIRES = {"benchmarks/methods/taylor_heyoka.py": needs.RIVALS}
ALL = all_mutants()
OVER_TIME = -signal.SIGXCPU
"""Exit code of tests that were caught in an endless loop."""


def noticed_by(mutant: Mutant) -> tuple[str, ...]:
    """What has to notice a mutant."""
    return NOTICED_BY.get(mutant.file, EQUATIONS)


def possible(mutant: Mutant) -> bool:
    """Whether the packages that its file needs are installed."""
    return mutant.file not in REQUIRES or REQUIRES[mutant.file].met


class Outcome(NamedTuple):
    """Exit code of a run, and what it said."""

    code: int
    said: str


class Trials:
    """All runs, begun ahead of the tests that ask for them, as many at once as there are processors."""

    def __init__(self, folder: Path, mutants: list[Mutant]) -> None:
        self._folder, self._lock, self._count = folder, threading.Lock(), 0
        shutil.copytree(PACKAGE, folder / "whole", ignore=shutil.ignore_patterns("__pycache__"))
        compileall.compile_dir(folder / "whole", quiet=2)
        trial.start()
        self._pool = ThreadPoolExecutor(len(os.sched_getaffinity(0)))
        suites = dict.fromkeys(noticed_by(mutant) for mutant in mutants)
        self._unchanged = {tests: self._pool.submit(self._try, None, tests) for tests in suites}
        self._changed = {mutant: self._pool.submit(self._try, mutant, noticed_by(mutant)) for mutant in mutants}
        self.killed, self.tried = 0, len(mutants)

    def _try(self, mutant: Mutant | None, tests: tuple[str, ...]) -> Outcome:
        with self._lock:
            self._count += 1
            folder = self._folder / str(self._count)
        shutil.copytree(self._folder / "whole", folder / "disc_model")
        if mutant:
            file = folder / "disc_model" / mutant.file
            file.write_text(mutant.source(), encoding="utf-8")
            for stale in (file.parent / "__pycache__").glob(f"{file.stem}.*"):
                stale.unlink()
        try:
            code = trial.run(folder, tests)
            return Outcome(code, (folder / "output").read_text(encoding="utf-8", errors="replace"))
        finally:
            shutil.rmtree(folder)

    def unchanged(self, tests: tuple[str, ...]) -> Outcome:
        """Outcome of the tests against the package as it is."""
        return self._unchanged[tests].result()

    def changed(self, mutant: Mutant) -> Outcome:
        """Outcome of the tests against a mutant."""
        return self._changed[mutant].result()

    def close(self) -> None:
        """Begin no more."""
        self._pool.shutdown(cancel_futures=True)


@pytest.fixture(scope="module")
def trials(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory):
    """Runs for the mutants that were asked for."""
    parameters = (getattr(getattr(item, "callspec", None), "params", {}) for item in request.session.items)
    wanted = [given["mutant"] for given in parameters if "mutant" in given]
    found = Trials(tmp_path_factory.mktemp("mutants"), [mutant for mutant in wanted if possible(mutant)])
    yield found
    found.close()


def test_every_function_is_there_and_can_be_changed() -> None:
    """The list keeps up with the code; quick, so that a change of the code is noticed at once."""
    for mutant in {(mutant.file, mutant.function): mutant for mutant in ALL}.values():
        compile(mutant.source(), mutant.file, "exec")
    names = {str(mutant) for mutant in ALL}
    assert len(names) == len(ALL)
    assert set(EQUIVALENT) <= names


@pytest.mark.slow
@pytest.mark.parametrize("mutant", [mutant for mutant in ALL if str(mutant) not in EQUIVALENT], ids=str)
def test_a_mutant_is_killed(mutant: Mutant, trials: Trials) -> None:
    if not possible(mutant):
        pytest.skip(REQUIRES[mutant.file].reason)
    unchanged = trials.unchanged(noticed_by(mutant))
    assert unchanged.code == pytest.ExitCode.OK, unchanged.said
    done = trials.changed(mutant)
    assert done.code != pytest.ExitCode.OK, f"{mutant} survives"
    # anything else is no verdict: not found, interrupted; what cannot even be imported is noticed
    assert done.code in (pytest.ExitCode.TESTS_FAILED, pytest.ExitCode.INTERRUPTED, OVER_TIME), done.said
    trials.killed += 1


@pytest.mark.slow
def test_all_are_killed(trials: Trials, capsys: pytest.CaptureFixture[str]) -> None:
    with capsys.disabled():
        print(f"\nmutants killed: {trials.killed} of {trials.tried}; {len(EQUIVALENT)} more make no difference")
    assert trials.killed == trials.tried
