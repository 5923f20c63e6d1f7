"""Measure the cost of compiling each kind of kernel: processor time and size of its files.

Each kind is compiled from an empty cache, then with the kinds above it in the cache, then once more.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from disc_model.kernels import USUAL

SCRIPT = """
import time
from disc_model.kernels import example, compile_kernels
from disc_model.disc.plate import plate_modes
from disc_model.stability.cycle import floquet
before = time.process_time()
plate_modes(example("{kind}"))  # imports are not what is measured
compile_kernels("{kind}")
print(time.process_time() - before)
"""


def measure(kind: str, folder: str) -> float:
    """Processor time (s) to compile a kind, or to load it from the cache in a folder."""
    command = [sys.executable, "-c", SCRIPT.format(kind=kind)]
    environment = os.environ | {"NUMBA_CACHE_DIR": folder}
    return float(subprocess.run(command, env=environment, check=True, capture_output=True, text=True).stdout)


def size(folder: str) -> int:
    """Bytes in a folder."""
    return sum(path.stat().st_size for path in Path(folder).rglob("*") if path.is_file())


columns = ("alone, s", "further, s", "again, s", "further kB")
print(f"{'kernels':36}" + "".join(f"{column:>12}" for column in columns))
with tempfile.TemporaryDirectory() as common:
    for kind in USUAL:
        with tempfile.TemporaryDirectory() as own:
            alone = measure(kind, own)
        before = size(common)
        further, again = measure(kind, common), measure(kind, common)
        print(f"{kind:36}{alone:12.1f}{further:12.1f}{again:12.2f}{(size(common) - before) / 1000:12.0f}", flush=True)
    print(f"all files: {size(common) / 1e6:.1f} MB")
