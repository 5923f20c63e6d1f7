"""What a measurement was made with."""

import os
import platform
from contextlib import suppress
from pathlib import Path

import pandas as pd
from disc_model.provenance import versions


def machine() -> str:
    """Return the processor, its number of cores and the system, in words."""
    model = platform.processor() or platform.machine()
    with suppress(OSError):
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                model = line.partition(":")[2].strip()
                break
    return f"{model}, {os.cpu_count()} cores, {platform.system()}"


def stamped(table: pd.DataFrame) -> pd.DataFrame:
    """Return a table with the machine and the versions of libraries in two more columns."""
    used = versions("heyoka", "scikit-sundae")
    return table.assign(
        machine=machine(), versions=" ".join(f"{name}={number}" for name, number in used.items())
    )
