"""What a measurement was made with."""

import os
import platform
import re
from pathlib import Path

import pandas as pd

from disc_model.provenance import versions


def machine() -> str:
    """Return the processor, its number of cores and the system, in words."""
    model = platform.processor() or platform.machine()
    described = Path("/proc/cpuinfo")
    if described.exists():
        names = re.findall(r"model name\s*: (.*)", described.read_text("utf-8"))
        model = [*names, model][0]
    return f"{model}, {os.cpu_count()} cores, {platform.system()}"


def stamped(table: pd.DataFrame) -> pd.DataFrame:
    """Return a table with the machine and the versions of libraries in two more columns."""
    used = versions("heyoka", "scikit-sundae")
    return table.assign(
        machine=machine(), versions=" ".join(f"{name}={number}" for name, number in used.items())
    )
