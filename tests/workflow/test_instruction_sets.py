"""Other processors, tried on this one: kernels are compiled and libraries take code for their instruction sets.

Processors differ in the last bit: one has fused multiplication and addition and rounds a * b + c once, another rounds
twice; vectors of another length add up in another order.  No test may turn on that, and no published digit.
"""

import functools
import re
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from tests import instruction_sets
from tests.processes import python, run
from tests.tally import tried
from tests.workflow.conftest import copy_repository

pytestmark = [pytest.mark.workflow, pytest.mark.slow]

NUMBERS = ("tests/engine", "tests/simulation", "tests/stability", "tests/validation")
DATASETS = (
    "results/test/cases.nc",
    *(f"results/{name}/{name}.nc" for name in ("test_grid", "test_curve", "test_growth")),
)
FUSED = """
import numba
@numba.njit("float64(float64, float64, float64)", fastmath={"contract"})
def fused(a, b, c):
    return a * b + c
print(any("vfmadd" in text for text in fused.inspect_asm().values()))
"""


@pytest.fixture(params=instruction_sets.SETS)
def name(request: pytest.FixtureRequest) -> str:
    """An instruction set that this processor can run."""
    if reason := instruction_sets.why_not(request.param):
        pytest.skip(f"{request.param}: {reason}")
    return request.param


@pytest.fixture(scope="module")
def environment(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], dict[str, str]]:
    """Variables for a set; its cache of kernels lasts for all tests of this file."""
    folder = tmp_path_factory.mktemp("kernels")
    return lambda name: instruction_sets.environment(name) | {"NUMBA_CACHE_DIR": str(folder / name)}


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Path]:
    """Results of the small study, computed with the variables of a set; with none, as this processor does it."""

    @functools.cache
    def results(**variables: str) -> Path:
        project = copy_repository(tmp_path_factory.mktemp("study"), {}, **variables)
        replace(project, config="config/test.yaml").complete("-j2", *DATASETS)
        return project.folder / "results"

    return results


def test_code_is_compiled_for_the_set(name: str, environment: Callable[[str], dict[str, str]]) -> None:
    """Or what follows would try this processor's own code again."""
    done = python(FUSED, **environment(name))
    assert done.stdout.strip() == str("fma" in instruction_sets.SETS[name].features), done.stderr


def test_the_numbers_pass(name: str, environment: Callable[[str], dict[str, str]]) -> None:
    options = ("-q", "-p", "no:cacheprovider", "-m", "not slow and not workflow")
    done = run(sys.executable, "-m", "pytest", *options, *NUMBERS, PYTEST_ADDOPTS="", **environment(name))
    passed = re.search(r"(\d+) passed", done.stdout)
    assert passed
    tried("instruction sets", f"tests in that of {name}", int(passed[1]))


def test_the_small_study(name: str, environment: Callable[[str], dict[str, str]], study: Callable[..., Path]) -> None:
    """Whatever is counted or named is the same: phases, kinds and numbers of switches, statuses, steps.

    Slow growth multiplies every rounding: in 150 s times of switches shift by up to 2e-10 s, in which the highest mode
    turns by 1e-6 rad. The residual of the energy is itself rounding, and differs in its second digit.
    """
    found = list(instruction_sets.differences(study(**environment(name)), study()))
    for file, variable, difference in found:
        assert difference < (0.1 if variable.endswith("energy_residual") else 1e-6), (file, variable, difference)
    tried("instruction sets", f"variables of the small study in that of {name}", len(found))
    # parameters, times of samples, counts and names at least
    assert sum(difference == 0.0 for *_, difference in found) > len(found) / 4
