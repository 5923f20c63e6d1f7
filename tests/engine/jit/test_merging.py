"""Kernels without `merging` and `blocks`: numba compiles them by itself, to the same results."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from disc_model.engine.jit import PLAIN
from tests.processes import run

KERNELS = """
from typing import NamedTuple
from disc_model.engine.jit import RULES, helper, inlined, kernel
from disc_model.engine.state import packed
class Pair(NamedTuple):
    first: float
    second: float
Pair = packed()(Pair)
@inlined
def half(x):
    return 0.5 * x
@helper
def quarter(x):
    return half(half(x))
@kernel
def eighth(pair):
    return half(quarter(pair.first)) + pair.second
print(eighth(Pair(8.0, 1.0)), "pipeline_class" in RULES, hasattr(Pair, "address"))
"""
MOTION = """
import disc_model as dm
run = dm.simulate(dm.Parameters(N=385, Omega=15.1, n_diameters=1), 0.05)
print(*run.events["kind"])
print(*run.events["time"])
"""
pytestmark = [pytest.mark.compiled, pytest.mark.slow]


def answer(tmp_path: Path, code: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """A process without kernels in its cache."""
    script = tmp_path / "script.py"
    script.write_text(code)
    path = tmp_path / "cache"
    return run(sys.executable, script, NUMBA_CACHE_DIR=str(path), **environment)


@pytest.mark.parametrize(
    ("missing", "environment", "expected"),
    [
        ("", {}, "2.0 True True"),
        ("", {PLAIN: "1"}, "2.0 False False"),
        ("merging", {}, "2.0 False True"),
        ("blocks", {}, "2.0 True False"),
    ],
)
def test_without_the_parts_of_numba_that_it_needs_kernels_work_and_it_is_said_once(
    tmp_path: Path, missing: str, environment: dict[str, str], expected: str
) -> None:
    hide = f"import sys; sys.modules['disc_model.engine.jit.{missing}'] = None\n"
    done = answer(tmp_path, (hide if missing else "") + KERNELS, **environment)
    assert done.stdout == f"{expected}\n"
    assert done.stderr.count("otherwise than expected") == bool(missing)


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
