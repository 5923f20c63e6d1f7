"""The register of rivals: names without the methods themselves."""

import math

from disc_model.benchmarks.registry import METHODS, SCENES
from tests.processes import python


def test_every_rival_is_measured_in_scenes_that_there_are() -> None:
    for method in METHODS.values():
        assert {*method.settings, *method.maps} <= set(SCENES)
        assert math.isnan(method.order) or method.order > 0


def test_nothing_heavy_is_imported_to_read_it() -> None:
    """The workflow reads it at every start."""
    code = "import sys, disc_model.benchmarks.registry; print(*{'numba', 'numpy', 'matplotlib'} & set(sys.modules))"
    assert python(code).stdout.strip() == ""
