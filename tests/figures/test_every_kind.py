"""Every kind of figure names the quantities on its axes, their units and scales, and shows the
values of its data in these units."""

import pytest
import xarray as xr
from matplotlib import pyplot

from disc_model.figures.kinds import KINDS, kind_of
from disc_model.figures.render import render
from tests.figures.every_kind import EXAMPLES
from tests.figures.measured import assert_shows
from tests.figures.reading import assert_fit_for_print


@pytest.mark.parametrize("kind", KINDS)
def test_labels_units_scales_and_values_are_those_of_the_data(kind: str) -> None:
    """Microseconds for milliseconds, metres for millimetres and 1/min for 1/s were not noticed."""
    example = EXAMPLES[kind]()
    inputs = {
        name: given if isinstance(given, xr.DataTree) else xr.DataTree(given)
        for name, given in example.inputs.items()
    }
    figure = render(kind_of(kind).model_validate({"kind": kind, **example.phrase}), inputs)
    assert_fit_for_print(figure)
    assert example.shown
    for expected in example.shown:
        assert_shows(figure, expected)
    pyplot.close("all")
