"""Kernels without `merging`: numba compiles them by itself, to the same results."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from disc_model.engine.jit import PLAIN
from tests.processes import run

KERNELS = """
from disc_model.engine.jit import RULES, helper, inlined, kernel
@inlined
def half(x):
    return 0.5 * x
@helper
def quarter(x):
    return half(half(x))
@kernel
def eighth(x):
    return half(quarter(x))
print(eighth(8.0), "pipeline_class" in RULES)
"""
MOTION = """
import disc_model as dm
run = dm.simulate(dm.Parameters(N=385, Omega=15.1, n_diameters=1), 0.05)
print(*run.events["kind"])
print(*run.events["time"])
"""
pytestmark = pytest.mark.compiled


def answer(tmp_path: Path, code: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """A process without kernels in its cache."""
    script = tmp_path / "script.py"
    script.write_text(code)
    path = tmp_path / "cache"
    return run(sys.executable, script, NUMBA_CACHE_DIR=str(path), **environment)


def test_kernels_are_merged_unless_it_is_switched_off(tmp_path: Path) -> None:
    assert answer(tmp_path, KERNELS).stdout == "1.0 True\n"
    assert answer(tmp_path, KERNELS, **{PLAIN: "1"}).stdout == "1.0 False\n"


def test_without_the_parts_of_numba_that_merging_needs_kernels_work_and_it_is_said_once(
    tmp_path: Path,
) -> None:
    missing = "import sys; sys.modules['disc_model.engine.jit.merging'] = None\n"
    done = answer(tmp_path, missing + KERNELS)
    assert done.stdout == "1.0 False\n"
    assert done.stderr.count("otherwise than expected") == 1


@pytest.mark.slow
def test_plain_numba_gives_the_same_motion(tmp_path: Path) -> None:
    if os.environ.get("NUMBA_DISABLE_JIT"):
        pytest.skip("nothing is compiled")
    merged = answer(tmp_path, MOTION).stdout.splitlines()
    path = tmp_path / ".."
    plain = answer(path, MOTION, **{PLAIN: "1"}).stdout.splitlines()
    assert plain[0] == merged[0]
    times = [[float(time) for time in lines[1].split()] for lines in (merged, plain)]
    # rounding of a clock and of roots: the optimiser chooses what is rounded once
    assert times[1] == pytest.approx(times[0], rel=0, abs=1e-14)
