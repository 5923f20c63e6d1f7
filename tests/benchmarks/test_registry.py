"""The register of rivals: names without the methods themselves."""

import pkgutil

import pytest

from disc_model.benchmarks.registry import METHODS
from tests.processes import python


def test_nothing_heavy_is_imported_to_read_it() -> None:
    """The workflow reads it at every start."""
    code = "import sys, disc_model.benchmarks.registry; print(*{'numba', 'numpy', 'matplotlib'} & set(sys.modules))"
    assert python(code).stdout.strip() == ""


@pytest.mark.parametrize("name", METHODS)
def test_each_method_names_the_function_that_solves(name: str) -> None:
    assert callable(pkgutil.resolve_name(f"disc_model.benchmarks.methods.{METHODS[name].place}"))
