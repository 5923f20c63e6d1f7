"""The same study gives the same data: what is equal to the last bit, and what only within rounding.

Equal to the last bit, on one kind of processor: every file of a study on 1 and 2 cores, with 1 and 2 threads of the
linear algebra, in another folder, with kernels just compiled or from the cache.

Equal within rounding: with and without compilation, and on another kind of processor. Compiled code may round a * b + c
once instead of twice (`contract`, see `disc_model.engine.compile`), where the processor can; Python rounds twice. The
sequence of switches, the number of steps and the phases are the same all the same.
"""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests import instruction_sets
from tests.workflow.conftest import copy_repository
from tests.workflow.faulty import STUDY, products

pytestmark = [pytest.mark.workflow, pytest.mark.slow]


# ---- equal to the last bit


def test_one_and_two_cores(tmp_path: Path) -> None:
    """Two folders; one job at a time with one thread of the linear algebra, or two with two."""
    found = []
    for cores in (1, 2):
        threads = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), str(cores))
        project = copy_repository(tmp_path / f"cores{cores}", STUDY, **threads)
        project.complete(f"-j{cores}")
        found.append(products(project))
    assert set(found[0]) == set(found[1])
    assert [name for name in found[0] if found[0][name] != found[1][name]] == []


CASE = """
import sys
from disc_model import Parameters, Poincare, Window
from disc_model.data.dataset import save
from disc_model.simulation.api import run_case
from disc_model.simulation.case import CaseSpec

windows = (("history", Window(start=0, stop=1, rate=1000)),)
p = Parameters(N=385, Omega=15.1)
spec = CaseSpec(parameters=p, t_end=1.0, windows=windows, poincare=Poincare(), events=(0.0, 1.0), energy=True)
save(run_case(spec), sys.argv[1])
"""


def test_cold_and_warm_cache(tmp_path: Path) -> None:
    """Kernels compiled in the process, found in the cache it left, and found in the user's cache."""
    own = {"NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    contents = {}
    for name, variables in {"cold": own, "warm": own, "usual": {}}.items():
        python(CASE, tmp_path / name, variables)
        contents[name] = (tmp_path / name).read_bytes()
    assert any((tmp_path / "cache").rglob("*.kernel"))
    assert contents["warm"] == contents["cold"]
    assert contents["usual"] == contents["cold"]


# ---- equal within rounding

SECOND = """
import pickle, sys
from disc_model import Parameters, Record, Window, simulate
from disc_model.benchmarks.scenes import problem

after = problem("separating")
cases = {
    "stick and slip": (Parameters(N=385, Omega=15.1), None, 0.0, 1.0),
    "131 separations": (after.parameters, after.start, after.start.time, after.t_end),
}
found = {}
for name, (p, start, begin, end) in cases.items():
    record = Record(windows=(Window(start=begin, stop=end, rate=1000),))
    r = simulate(p, end, initial_state=start, record=record)
    found[name] = (r.events, r.samples[0], r.statistics)
pickle.dump(found, open(sys.argv[1], "wb"))
"""
Found = dict[str, tuple[Any, dict[str, np.ndarray], dict[str, Any]]]


@pytest.fixture(scope="module")
def compiled(tmp_path_factory: pytest.TempPathFactory) -> Found:
    return one_second(tmp_path_factory.mktemp("compiled") / "found", {})


def test_with_and_without_compilation(compiled: Found, tmp_path: Path) -> None:
    check_close(one_second(tmp_path / "found", {"NUMBA_DISABLE_JIT": "1"}), compiled)


def test_another_processor(compiled: Found, tmp_path: Path) -> None:
    """One without fused multiplication and addition, and with short vectors."""
    own = instruction_sets.environment("generic") | {"NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    check_close(one_second(tmp_path / "found", own), compiled)


def check_close(found: Found, expected: Found) -> None:
    """About a thousand steps, each of which rounds otherwise: 1e-16 x 1000 relative to a quantity's extremes.

    The motion does not tell neighbours apart faster than that within a second, but after an impact velocities of the
    slider are differences of larger numbers. Measured: 7e-15 s, 9e-12 of the extremes.
    """
    for name, (events, samples, statistics) in expected.items():
        own_events, own_samples, own_statistics = found[name]
        assert list(own_events["kind"]) == list(events["kind"])
        assert list(own_events["phase"]) == list(events["phase"])
        for count in ("steps", "events", "separations"):
            assert own_statistics[count] == statistics[count]
        np.testing.assert_allclose(own_events["time"], events["time"], rtol=0, atol=1e-13)
        np.testing.assert_array_equal(own_samples["phase"], samples["phase"])
        for quantity, values in samples.items():
            size = np.abs(values).max()
            np.testing.assert_allclose(own_samples[quantity], values, rtol=0, atol=1e-10 * size, err_msg=quantity)


def one_second(path: Path, variables: dict[str, str]) -> Found:
    python(SECOND, path, variables)
    found: Found = pickle.loads(path.read_bytes())
    return found


def python(code: str, argument: Path, variables: dict[str, str]) -> None:
    """Run code in a process of its own."""
    subprocess.run([sys.executable, "-c", code, str(argument)], env=os.environ | variables, check=True, timeout=900)
