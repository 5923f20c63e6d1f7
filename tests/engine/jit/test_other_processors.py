"""Kernels on 64-bit Arm: LLVM writes machine code for it from what numba hands over here."""

import json
from pathlib import Path

import pytest

from tests import instruction_sets
from tests.processes import python

COMPILE = """
import gc, json, re, sys
import llvmlite.binding as llvm
import disc_model as dm
from disc_model.engine.jit import cache
from numba.core.dispatcher import Dispatcher

dm.simulate(dm.Parameters(N=385, Omega=15), 0.05)
dm.floquet(dm.Parameters(N=385, Omega=15))
llvm.initialize_all_targets()
llvm.initialize_all_asmprinters()
machine = llvm.Target.from_triple("aarch64-unknown-linux-gnu").create_target_machine(opt=2)
report = {}
for thing in gc.get_objects():
    if not isinstance(thing, Dispatcher) or not isinstance(thing._cache, cache.KernelCache):
        continue
    for text in thing.inspect_llvm().values():
        declared = re.findall(r"^declare [^@]*@\\"?([\\w.]+)", text, re.M)
        text = re.sub(r"^target (?:triple|datalayout).*$", "", text, flags=re.M)
        module = llvm.parse_assembly(text)
        module.triple = machine.triple
        module.data_layout = str(machine.target_data)
        code = machine.emit_assembly(module)
        fused = len(re.findall(r"\\bfml[as]\\s+v\\d+\\.2d", code))
        report[thing.__name__] = {"declared": declared, "fused": fused, "asm": "asm " in text}
json.dump(report, sys.stdout)
"""
ANYWHERE = ("Py", "_Py", "numba_")
"""Beginnings of the names of functions that Python and numba have on every processor."""
OF_C = {"sqrt", "exp", "exp2", "log", "sin", "cos", "pow", "fma", "memset", "memcpy", "sincos"}


@pytest.mark.slow
@pytest.mark.compiled
def test_no_kernel_assumes_an_x86_processor(tmp_path: Path) -> None:
    """Compiled with what every x86-64 processor has, for eight doubles that fill no register,
    as on Arm. LLVM ends the process if it cannot write an instruction."""
    variables = {**instruction_sets.environment("generic"), "NUMBA_CACHE_DIR": str(tmp_path)}
    done = python(COMPILE, **variables)
    report = json.loads(done.stdout)
    assert {"run", "_flight"} <= report.keys()
    for name, found in report.items():
        functions = {x for x in found["declared"] if not x.startswith(ANYWHERE)} - OF_C
        assert all(x.startswith("llvm.") for x in functions), (name, functions)
        assert not [x for x in functions if "x86" in x], name
        assert not found["asm"], name
    # the lanes are vectors there as well: two doubles in a register
    assert report["run"]["fused"] > 100
