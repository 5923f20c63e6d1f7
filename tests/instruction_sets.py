"""Instruction sets of other processors that this one can run, and how far apart datasets are.

    python -m tests.instruction_sets NAME COMMAND ...

runs a command as a processor of that name would.  Four libraries choose their code by the
processor: numba, OpenBLAS (which has a name of its own for it), numpy's loops and the C library's
elementary functions.
"""

import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import llvmlite.binding as llvm
import numpy as np
import xarray as xr


class InstructionSet(NamedTuple):
    """What a processor has.

    Attributes
    ----------
    features : what compiled code may contain beyond x86-64 as it began, by LLVM's names
    openblas : its name there
    numpy : levels of numpy's loops that it lacks
    glibc : what the C library is told that it lacks
    """

    features: tuple[str, ...]
    openblas: str
    numpy: str
    glibc: str = ""


_HASWELL = ("avx", "avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe", "popcnt", "sse4.2")
_SKYLAKE = (*_HASWELL, "avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl")
SETS = {
    "generic": InstructionSet((), "Nehalem", "X86_V3 X86_V4 AVX512_ICL", "-AVX2,-FMA,-FMA4"),
    "haswell": InstructionSet(_HASWELL, "Haswell", "X86_V4 AVX512_ICL"),
    "skylake-avx512": InstructionSet(_SKYLAKE, "SkylakeX", "AVX512_ICL"),
}


def why_not(name: str) -> str:
    """What the processor lacks for a set; "" if it can run it."""
    here = llvm.get_host_cpu_features()
    lacking = [feature for feature in SETS[name].features if not here.get(feature, False)]
    if lacking:
        return f"this processor has no {', '.join(lacking)}"
    return ""


def environment(name: str) -> dict[str, str]:
    """Variables that make the libraries take the code for a set.

    Without features of its own numba takes those of the processor at hand, whatever the name.
    """
    chosen = SETS[name]
    return {
        "NUMBA_CPU_NAME": name,
        "NUMBA_CPU_FEATURES": "",
        "OPENBLAS_CORETYPE": chosen.openblas,
        "NPY_DISABLE_CPU_FEATURES": chosen.numpy,
        "GLIBC_TUNABLES": f"glibc.cpu.hwcaps={chosen.glibc}" if chosen.glibc else "",
    }


def differences(found: Path, expected: Path) -> Iterator[tuple[str, str, float]]:
    """(file, variable, difference) for each variable of all datasets below two folders.

    The difference is relative to the variable's largest absolute value; 0 means equal, inf
    that shapes, integers or the places of nan differ.
    """
    names = sorted(str(path.relative_to(expected)) for path in expected.rglob("*.nc"))
    assert names == sorted(str(path.relative_to(found)) for path in found.rglob("*.nc"))
    for name in names:
        with xr.open_datatree(found / name) as mine, xr.open_datatree(expected / name) as theirs:
            assert mine.groups == theirs.groups, name
            for group in theirs.groups:
                for variable, values in theirs[group].to_dataset().variables.items():
                    own = mine[group].to_dataset().variables[variable]
                    yield (
                        name,
                        f"{group}/{variable}".lstrip("/"),
                        _difference(own.values, values.values),
                    )


def _difference(found: np.ndarray, expected: np.ndarray) -> float:
    numbers = expected.dtype.kind == "f"
    if np.array_equal(found, expected, equal_nan=numbers):
        return 0.0
    if found.shape != expected.shape or not numbers:
        return np.inf
    known = np.isfinite(expected)
    if not np.array_equal(found[~known], expected[~known], equal_nan=True):
        return np.inf
    with np.errstate(divide="ignore"):
        return float(np.abs(found - expected)[known].max() / np.abs(expected[known]).max())


if __name__ == "__main__":
    name, *command = sys.argv[1:]
    if reason := why_not(name):
        sys.exit(f"{name}: {reason}")
    os.execvpe(command[0], command, os.environ | environment(name))
