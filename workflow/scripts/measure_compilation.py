"""Measure the cost of compiling each kind of kernel: processor time and size of its files, from an empty cache."""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from disc_model.kernels import USUAL

SCRIPT = """
import time
from disc_model.kernels import example, compile_kernels
from disc_model.plate import plate_modes
from disc_model.stability.cycle import floquet
before = time.process_time()
plate_modes(example("{kind}"))  # imports are not what is measured
compile_kernels("{kind}")
print(time.process_time() - before)
"""

print(f"{'kernels':36}{'processor time, s':>20}{'again, s':>12}{'files':>8}{'kB':>8}")
for kind in USUAL:
    with tempfile.TemporaryDirectory() as folder:
        environment = os.environ | {"NUMBA_CACHE_DIR": folder}
        command = [sys.executable, "-c", SCRIPT.format(kind=kind)]
        times = [
            float(subprocess.run(command, env=environment, check=True, capture_output=True, text=True).stdout)
            for _ in range(2)
        ]
        sizes = [path.stat().st_size for path in Path(folder).rglob("*.kernel")]
    print(f"{kind:36}{times[0]:20.1f}{times[1]:12.2f}{len(sizes):8}{sum(sizes) / 1000:8.0f}")
