"""A run of tests against a changed copy of the package, in a process of its own that has the libraries already.

Nothing of the package may be imported here: the copy is to be found first.
"""

from __future__ import annotations

import multiprocessing
import os
import resource
import sys
from multiprocessing import forkserver
from pathlib import Path
from unittest import mock

LIBRARIES = ("numpy", "scipy.linalg", "scipy.integrate", "scipy.special", "xarray", "pandas", "numba", "pydantic")
LIBRARIES += ("pytest", "hypothesis", "matplotlib.figure")
OPTIONS = ("-x", "-q", "-p", "no:cacheprovider", "--tb=line", "-m", "not slow and not compiled")
PATIENCE = 120
"""s of the processor; what is tried takes a fifth of that."""
CONTEXT = multiprocessing.get_context("forkserver")


def start() -> None:
    """Begin the server of processes: libraries loaded, nothing compiled, one thread."""
    CONTEXT.set_forkserver_preload(list(LIBRARIES))
    threads = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    with mock.patch.dict(os.environ, threads | {"NUMBA_DISABLE_JIT": "1"}):
        forkserver.ensure_running()


def run(folder: Path, tests: tuple[str, ...]) -> int:
    """Exit code of the tests against the copy in ``folder``; negative if they ran into an endless loop.

    What they say is in the folder's file ``output``.
    """
    process = CONTEXT.Process(target=_run, args=(str(folder), tests))
    process.start()
    process.join()
    assert process.exitcode is not None
    return process.exitcode


def _run(folder: str, tests: tuple[str, ...]) -> None:
    output = os.open(f"{folder}/output", os.O_CREAT | os.O_TRUNC | os.O_WRONLY)
    os.dup2(output, 1)
    os.dup2(output, 2)
    # one more second to the hard limit, which kills at once: an endless loop is told by the signal of the soft one
    resource.setrlimit(resource.RLIMIT_CPU, (PATIENCE, PATIENCE + 1))
    sys.path.insert(0, folder)
    sys.dont_write_bytecode = True
    os.environ["HYPOTHESIS_STORAGE_DIRECTORY"] = f"{folder}/hypothesis"
    os.environ.pop("PYTEST_ADDOPTS", None)
    import disc_model

    assert Path(disc_model.__file__).is_relative_to(folder), disc_model.__file__
    import pytest

    code = pytest.main([*tests, *OPTIONS])
    sys.stdout.flush()
    os._exit(int(code))
