"""The tests notice a wrong sign, factor or comparison in any of the equations:
tests/validation/mutants.py."""

import ast
import os
import subprocess
import sys

import pytest

from tests.validation.mutants import EQUIVALENT, MODULES, NO_EQUATION, PACKAGE, mutants, places


def test_every_module_can_be_changed() -> None:
    """Quick, so that a change of the code is noticed at once."""
    for module in MODULES:
        found = list(mutants(module))
        assert len({str(mutant) for mutant in found}) == len(found) > 0
        assert found[0].code()
    assert {str(mutant) for module in MODULES for mutant in mutants(module)} >= EQUIVALENT.keys()
    for modules in NO_EQUATION.values():
        for module, names in modules.items():
            tree = ast.parse((PACKAGE / module).read_text(encoding="utf-8"))
            assert {function for function, _ in places(tree)} >= {*names.split()}, module


@pytest.mark.slow
def test_all_mutants_are_killed(capfd: pytest.CaptureFixture[str]) -> None:
    command = [sys.executable, "-m", "tests.validation.mutants"]
    done = subprocess.run(command, env=os.environ | {"NUMBA_DISABLE_JIT": "1"}, check=False)
    text = capfd.readouterr()
    assert done.returncode == 0, text.out + text.err
    with capfd.disabled():
        print(f"\nmutants killed: {text.out.strip()}; {len(EQUIVALENT)} more make no difference")
