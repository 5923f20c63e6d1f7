"""Measure the cost of compiling each kind of kernel, processor time and size of files: from an
empty cache, with the kinds above it in the cache, and again."""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

COMPLIANT = {"contact_compliance": 2.7e-7}  # close to the residual flexibility
MODELS = {
    "the paper's model": {},
    "normal": {"contact_force": "normal"},
    "compliant": COMPLIANT,
    "compliant, normal": {"contact_force": "normal", **COMPLIANT},
    "more modes": {"n_diameters": 5},
}
TASKS = {
    "simulate": "disc_model.simulate(p, 0.1)",
    "floquet": "disc_model.floquet(p)",
    "ramp": "disc_model.simulate(p, 0.1, ramps=disc_model.Ramp(parameter='Omega', to=5, start=0, end=400))",
}
KINDS = [(task, model) for model in MODELS for task in TASKS if task != "ramp" or not MODELS[model]]
SCRIPT = """
import time
import disc_model
from disc_model.disc.modes import plate_modes
p = disc_model.Parameters(N=385, Omega=15, **{model})
disc_model.floquet
before = time.process_time()
plate_modes(p)  # imports are not what is measured
{task}
print(time.process_time() - before)
"""


def measure(task: str, model: str, folder: str) -> float:
    """Processor time (s) to compile a kind, or to load it from the cache in a folder."""
    command = [sys.executable, "-c", SCRIPT.format(task=TASKS[task], model=MODELS[model])]
    environment = os.environ | {"NUMBA_CACHE_DIR": folder}
    return float(
        subprocess.run(command, env=environment, check=True, capture_output=True, text=True).stdout
    )


def size(folder: str) -> int:
    return sum(path.stat().st_size for path in Path(folder).rglob("*") if path.is_file())


columns = ("alone, s", "further, s", "again, s", "further kB")
print(f"{'kernels':36}" + "".join(f"{column:>12}" for column in columns))
with tempfile.TemporaryDirectory() as common:
    for kind in KINDS:
        with tempfile.TemporaryDirectory() as own:
            alone = measure(*kind, own)
        before = size(common)
        further, again = measure(*kind, common), measure(*kind, common)
        size_kB = (size(common) - before) / 1000
        print(
            f"{', '.join(kind):36}{alone:12.1f}{further:12.1f}{again:12.2f}{size_kB:12.0f}",
            flush=True,
        )
    print(f"all files: {size(common) / 1e6:.1f} MB")
