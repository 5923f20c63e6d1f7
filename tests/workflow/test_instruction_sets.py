"""Other processors, tried on this one: kernels are compiled and libraries take code for their
instruction sets.

Processors differ in the last bit: one has fused multiplication and addition and rounds a * b + c
once, another rounds twice; vectors of another length add up in another order.  No test may turn on
that, and no published digit.
"""

import functools
import re
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from disc_model import Parameters, Result, simulate
from disc_model.disc.plate import mode_arrays
from tests import instruction_sets
from tests.processes import python, run
from tests.workflow.conftest import copy_repository

pytestmark = pytest.mark.slow

NUMBERS = ("tests/engine", "tests/simulation", "tests/stability", "tests/validation")
DATASETS = (
    *(f"results/test/cases/{name}.nc" for name in ("F02", "F04", "F11", "F13")),
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
    """Results of the small study, computed with the variables of a set; with none, as this
    processor does it."""

    @functools.cache
    def results(**variables: str) -> Path:
        project = copy_repository(tmp_path_factory.mktemp("study"), {}, **variables)
        replace(project, config="config/test.yaml").complete("-j2", *DATASETS)
        return project.folder / "results"

    return results


def test_code_is_compiled_for_the_set(
    name: str, environment: Callable[[str], dict[str, str]]
) -> None:
    """Or what follows would try this processor's own code again."""
    done = python(FUSED, **environment(name))
    assert done.stdout.strip() == str("fma" in instruction_sets.SETS[name].features), done.stderr


def test_the_numbers_pass(name: str, environment: Callable[[str], dict[str, str]]) -> None:
    options = ("-q", "-p", "no:cacheprovider", "-m", "not slow")
    done = run(
        sys.executable, "-m", "pytest", *options, *NUMBERS, PYTEST_ADDOPTS="", **environment(name)
    )
    assert re.search(r"\d+ passed", done.stdout)


MODES = """
import sys
import numpy as np
from disc_model import Parameters, simulate
from disc_model.disc.plate import mode_arrays
p = Parameters(N=800, Omega=30)
for normalization in ("as_published", "orthonormal"):
    own = p.replace(normalization=normalization)
    modes = mode_arrays(own.replace(n_diameters=20, n_circles=4))
    np.savez(f"{sys.argv[1]}/{normalization}.npz", omega=modes.omega, psi=modes.psi)
    simulate(own, 0.5).save(f"{sys.argv[1]}/{normalization}.nc")
"""


@pytest.mark.parametrize(
    "openblas", ["Prescott", *(chosen.openblas for chosen in instruction_sets.SETS.values())]
)
def test_modes_and_states_are_those_of_any_linear_algebra(openblas: str, tmp_path: Path) -> None:
    """A null vector has another sign on another processor: states taken there were those of other
    motions.

    Modes differ by 6e-14 of the largest, and times of switches by 1e-14 s in half a second. Both
    continue after a stop, which moves switches by the tolerance: the steps are others.
    """
    for name, chosen in instruction_sets.SETS.items():
        if chosen.openblas == openblas and (reason := instruction_sets.why_not(name)):
            pytest.skip(f"{openblas}: {reason}")
    python(MODES, tmp_path, OPENBLAS_CORETYPE=openblas)
    for file in sorted(tmp_path.glob("*.npz")):
        p = Parameters(N=800, Omega=30, normalization=file.stem)
        modes = mode_arrays(p.replace(n_diameters=20, n_circles=4))
        for variable, values in np.load(file).items():
            own = getattr(modes, variable)
            np.testing.assert_allclose(values, own, rtol=0, atol=1e-12 * np.abs(own).max())
        states = simulate(p, 0.5).final_state, Result.load(file.with_suffix(".nc")).final_state
        here, there = (simulate(p, 1.0, initial_state=state).event_rows[:, 0] for state in states)
        np.testing.assert_allclose(there, here, rtol=0, atol=1e-12)


def test_the_small_study(
    name: str, environment: Callable[[str], dict[str, str]], study: Callable[..., Path]
) -> None:
    """Whatever is counted or named is the same: phases, kinds and numbers of switches, statuses,
    steps.

    Slow growth multiplies every rounding: in 150 s times of switches shift by up to 2e-10 s, in
    which the highest mode turns by 1e-6 rad. The residual of the energy is itself rounding, and
    differs in its second digit.
    """
    found = list(instruction_sets.differences(study(**environment(name)), study()))
    for file, variable, difference in found:
        assert difference < (0.1 if variable.endswith("energy_residual") else 1e-6), (
            file,
            variable,
            difference,
        )
    # parameters, times of samples, counts and names at least
    assert sum(difference == 0.0 for *_, difference in found) > len(found) / 4
