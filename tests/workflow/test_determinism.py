"""The same study gives the same data: what is equal to the last bit, and what only within rounding.

Equal to the last bit, on one kind of processor: every file of a study on 1 and 2 cores, with 1 and
2 threads of the linear algebra, in another folder, with kernels just compiled or from the cache.

Equal within rounding: with and without compilation, and on another kind of processor, which
`tests/workflow/test_instruction_sets.py` tries.  Compiled code may round a * b + c once instead of
twice (`contract`, see `disc_model.engine.jit`); Python rounds twice.
"""

from dataclasses import replace
from pathlib import Path

import pytest

from tests import THREADS, instruction_sets
from tests.processes import python
from tests.workflow.conftest import TEXTS, Project, copy_repository

pytestmark = pytest.mark.slow


def test_one_and_two_cores(project: Project, finished: Project) -> None:
    project.forget()
    replace(project, variables=dict.fromkeys(THREADS, "2")).complete("-j1")
    assert project.products() == finished.products()


CASES = """
import sys
from disc_model import Parameters, Poincare, Window, simulate
from disc_model.data.dataset import save
from disc_model.simulation.named_case import run_case
from disc_model.simulation.case import CaseSpec
from tests.references import stored

record = {"windows": {"history": Window(start=0, stop=1, rate=1000)}, "poincare": Poincare(), "events": {"stop": 1.0}}
p = Parameters(N=385, Omega=15.1)
spec = CaseSpec(parameters=p, t_end=1.0, record=record)
save(run_case(spec), sys.argv[1] + "/grows.nc")
after = stored.load("C")
p = Parameters(**after["parameters"])
start = stored.engine_state(after["start"], p)
window = Window(start=start.time, stop=after["t_end"], rate=1000)
simulate(p, after["t_end"], {"w": window}, initial_state=start).save(sys.argv[1] + "/separates.nc")
"""


def test_kernels_just_compiled_from_the_cache_and_none(tmp_path: Path) -> None:
    """Without compilation each of a thousand steps rounds otherwise: 1e-16 x 1000 of a quantity's
    extremes.

    The motion does not tell neighbours apart faster than that within a second, but after an impact
    velocities of the slider are differences of larger numbers. Measured: 9e-12 of the extremes.
    Switches, phases and steps are the same.
    """
    cache_path = tmp_path / "cache"
    own = {"NUMBA_CACHE_DIR": str(cache_path)}
    ways = {"cold": own, "warm": own, "usual": {}, "none": {"NUMBA_DISABLE_JIT": "1"}}
    for name, variables in ways.items():
        (tmp_path / name).mkdir()
        python(CASES, tmp_path / name, **variables)
    assert any(cache_path.rglob("*.nbc"))
    cold_path = tmp_path / "cold"
    for name in ("warm", "usual"):
        found = instruction_sets.differences(tmp_path / name, cold_path)
        assert max(difference for *_, difference in found) == 0
    none_path = tmp_path / "none"
    for file, variable, difference in instruction_sets.differences(none_path, cold_path):
        # residuals of the energy are rounding themselves
        limit = 1e-10
        if "energy" in variable:
            limit = 0.5
        assert difference < limit, (file, variable, difference)


COUNTS = """
import atexit, gc, sys

def count():
    if "numba" not in sys.modules:
        return
    from numba.core.dispatcher import Dispatcher
    compiled = [one for one in gc.get_objects() if issubclass(type(one), Dispatcher)]
    kernels = [one for one in compiled if type(one._cache).__name__ == "KernelCache"]
    with open(FILE, "a") as file:
        for kernel in kernels:
            for signature in kernel.stats.cache_misses:
                print(kernel.__name__, signature, file=file)

atexit.register(count)
"""
"""Imported by each Python that starts: it writes down which kernels it compiled."""
KINDS = (TEXTS / "kinds.yaml").read_text()


def test_jobs_at_the_same_time_compile_each_kernel_once(tmp_path: Path) -> None:
    counted = tmp_path / "compiled.txt"
    cache_path = tmp_path / "cache"
    environment = {"NUMBA_CACHE_DIR": str(cache_path)}
    project_path = tmp_path / "project"
    project = copy_repository(project_path, {"config/kinds.yaml": KINDS}, **environment)
    (project.folder / "src" / "sitecustomize.py").write_text(f"FILE = {str(counted)!r}\n{COUNTS}")
    replace(project, config="config/kinds.yaml").complete("-j2", "all", "explorer")
    kernels = counted.read_text().splitlines()
    assert kernels
    assert sorted(kernels) == sorted(set(kernels))
