"""What compiling each kind of kernel costs: processor time and size of its files, from an empty cache."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

LAWS = {
    "": "",
    ", compliant contact": "contact_compliance=2e-7",
    ", normal contact force": "contact_force='normal'",
    ", both": "contact_compliance=2e-7, contact_force='normal'",
}
KINDS = {
    f"{function}{law}": f"dm.{function}({arguments.format(change)})"
    for function, arguments in {"simulate": "p.replace({}), 0.1", "floquet": "p.replace({})"}.items()
    for law, change in (LAWS | {", more than four nodal diameters": "n_diameters=8"}).items()
}
KINDS["simulate, a ramp"] = "dm.simulate(p, 0.1, ramps=dm.Ramp(parameter='Omega', to=5.0, start=0.05, end=400.0))"
"""What asks for kernels of each kind."""

SCRIPT = """
import time
import disc_model as dm
p = dm.Parameters(N=385, Omega=15)
before = time.process_time()
dm.plate_modes(p), dm.simulate  # imports are not what is measured
{call}
print(time.process_time() - before)
"""


def main() -> None:
    print(f"{'kernels of':36}{'processor time, s':>20}{'again, s':>12}{'files':>8}{'kB':>8}")
    for kind, call in KINDS.items():
        with tempfile.TemporaryDirectory() as folder:
            environment = os.environ | {"NUMBA_CACHE_DIR": folder}
            command = [sys.executable, "-c", SCRIPT.format(call=call)]
            times = [
                float(subprocess.run(command, env=environment, check=True, capture_output=True, text=True).stdout)
                for _ in range(2)
            ]
            sizes = [path.stat().st_size for path in Path(folder).rglob("*.kernel")]
        print(f"{kind:36}{times[0]:20.1f}{times[1]:12.2f}{len(sizes):8}{sum(sizes) / 1000:8.0f}")


if __name__ == "__main__":
    main()
