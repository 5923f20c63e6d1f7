"""Where a benchmark runs, one core of a named machine, and how much arithmetic the engine does there."""

from __future__ import annotations

import json
import os
import platform
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any


@contextmanager
def one_core() -> Iterator[None]:
    """Keep this process, and the threads begun meanwhile, on one of its cores; afterwards it has all of them back."""
    if not hasattr(os, "sched_setaffinity"):
        yield
        return
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {max(before)})
    try:
        yield
    finally:
        os.sched_setaffinity(0, before)


def machine() -> str:
    """Processor and number of cores, as the system names them."""
    model = platform.processor() or platform.machine()
    with suppress(OSError, StopIteration):
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        model = next(line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return f"{model}, {os.cpu_count()} cores, {platform.system()}"


# ----------------------------------------------------------------------------------------------------
# Vector operations, counted while the engine runs uncompiled. Scalars (the slider, one recurrence of nine modes) are
# left out: they are a tenth of the work and hide behind the lanes.

# Of one operation on all lanes; total adds up half as many lanes at each of three levels.
_OPERATIONS = {"fma": 16, "mul": 8, "add": 8, "sub": 8, "total": 7}


def vector_flops(scene: str, tol: float) -> float:
    """Floating-point operations per simulated second of a scene, counted in a process of its own."""
    environment = os.environ | {"NUMBA_DISABLE_JIT": "1"}
    command = [sys.executable, "-m", "disc_model.benchmarks.machine", scene, repr(tol)]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    return float(json.loads(done.stdout))


def _count(scene: str, tol: float) -> float:
    from disc_model.benchmarks.scenes import problem
    from disc_model.engine import coasting, dense_output, polynomial, series
    from disc_model.simulation.api import simulate

    done = 0

    def counting(operation: Any, flops: int) -> Any:
        def counted(*lanes: Any) -> Any:
            nonlocal done
            done += flops
            return operation(*lanes)

        return counted

    for name, flops in _OPERATIONS.items():
        for module in (dense_output, coasting, polynomial, series):
            if hasattr(module, name):
                setattr(module, name, counting(getattr(module, name), flops))
    case = problem(scene)
    simulate(case.parameters, case.t_end, tol=tol, initial_state=case.start)
    return done / case.span


if __name__ == "__main__":
    sys.stdout.write(json.dumps(_count(sys.argv[1], float(sys.argv[2]))))
