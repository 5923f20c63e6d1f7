"""The register of rivals: names without the methods themselves."""

import math

from disc_model.benchmarks.methods import METHODS
from disc_model.benchmarks.registry import RIVALS, SCENES, absent
from tests.processes import python


def test_every_rival_is_made_as_registered() -> None:
    assert [rival.name for rival in RIVALS] == list(METHODS)
    for rival in RIVALS:
        method = METHODS[rival.name]
        assert (method.name, method.requires, method.label) == (rival.name, rival.requires, rival.label)
        assert bool(method.unavailable()) == bool(absent(rival.requires))
        assert set(method.settings) <= set(SCENES)
        assert math.isnan(method.order) or method.order > 0


def test_nothing_heavy_is_imported_to_read_it() -> None:
    """The workflow reads it at every start."""
    code = "import sys, disc_model.benchmarks.registry; print(*{'numba', 'numpy', 'matplotlib'} & set(sys.modules))"
    assert python(code).stdout.strip() == ""
