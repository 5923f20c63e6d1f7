"""The register of rivals: names without the methods themselves."""

from tests.processes import python


def test_nothing_heavy_is_imported_to_read_it() -> None:
    """The workflow reads it at every start."""
    code = "import sys, disc_model.benchmarks.registry; print(*{'numba', 'numpy', 'matplotlib'} & set(sys.modules))"
    assert python(code).stdout.strip() == ""
