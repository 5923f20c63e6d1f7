"""Every kind of figure names the quantities on its axes, their units and scales, and shows the
values of its data in these units."""

import json

import pytest
import xarray as xr
from matplotlib import pyplot

from disc_model.figures.kinds import KINDS, Compared, kind_of
from disc_model.figures.kinds.base import Width
from disc_model.figures.render import render
from disc_model.figures.sizes import WIDTHS
from tests.figures.every_kind import EXAMPLES
from tests.figures.measured import assert_shows
from tests.figures.reading import assert_fit_for_print

IN_WIDTHS = [
    pytest.param(kind, width, marks=[] if width == form.widths[0] else pytest.mark.slow)
    for kind, form in KINDS.items()
    for width in form.widths
]
"""Kinds of figures in all their widths; a further width of one is a slow test."""


@pytest.mark.parametrize(("kind", "width"), IN_WIDTHS)
def test_labels_units_scales_and_values_are_those_of_the_data(kind: str, width: Width) -> None:
    """Microseconds for milliseconds, metres for millimetres and 1/min for 1/s were not noticed."""
    example = EXAMPLES[kind]()
    inputs = {
        name: given if isinstance(given, xr.DataTree) else xr.DataTree(given)
        for name, given in example.inputs.items()
    }
    phrase = {"kind": kind, "width": width, **example.phrase}
    figure = render(kind_of(kind).model_validate(phrase), inputs)
    assert figure.get_figwidth() == WIDTHS[width]
    assert_fit_for_print(figure)
    assert example.shown
    for expected in example.shown:
        assert_shows(figure, expected)
    pyplot.close("all")


COMPARED = {name: kind for name, kind in KINDS.items() if issubclass(kind, Compared)}


@pytest.mark.parametrize("kind", COMPARED)
def test_models_stand_beside_each_other_and_titles_say_what_differs(kind: str) -> None:
    """Two models of one thing are panels of one figure, with names of the file's own."""
    example = EXAMPLES[kind]()
    inputs = {}
    for name, given in example.inputs.items():
        study = given
        if "normalization" in given.dims:
            study = given.squeeze("normalization")
        study = study.drop_vars("normalization", errors="ignore")
        models = xr.concat([study.assign_coords(k=value) for value in (2e4, 6e4)], "k")
        base = {"normalization": "as_published", **json.loads(given.attrs["base"])}
        inputs[name] = xr.DataTree(models.assign_attrs(given.attrs | {"base": json.dumps(base)}))

    for names, expected in (
        ({"20000.0": "soft", "60000.0": "stiff"}, ["soft", "stiff"]),
        ({}, ["Spring k = 20 kN/m", "60 kN/m"]),
    ):
        phrase = {"kind": kind, "by": "k", "names": names, **example.phrase}
        figure = render(kind_of(kind).model_validate(phrase), inputs)
        assert_fit_for_print(figure)
        titles = [ax.get_title(loc="left") for ax in figure.axes]
        subjects = [title.partition(") ")[2].replace("\n", " ") for title in titles]
        assert [subject for subject in subjects if subject] == expected
    pyplot.close("all")


@pytest.mark.parametrize(
    ("kind", "dim"),
    [
        ("late_range", "contact"),
        ("late_range", "disc"),
        ("sliding_modes", "value"),
        ("sliding_modes", "mode"),
        ("staircase", "Omega"),
    ],
)
def test_a_dimension_may_have_one_value(kind: str, dim: str) -> None:
    """It was dropped before something was drawn along it."""
    example = EXAMPLES[kind]()
    inputs = {name: given.isel({dim: slice(1)}) for name, given in example.inputs.items()}
    plot = kind_of(kind).model_validate({"kind": kind, **example.phrase})
    figure = render(plot, {name: xr.DataTree(given) for name, given in inputs.items()})
    figure.draw_without_rendering()
    pyplot.close("all")


@pytest.mark.parametrize("kind", ["late_range", "escape"])
def test_a_dimension_of_a_figure_may_be_the_normalization(kind: str) -> None:
    plot = kind_of(kind).model_validate({"kind": kind, "by": "normalization"})
    values = {name: [0.0, 1.0] for name in plot.dims}
    values |= {"normalization": ["as_published", "orthonormal"]}
    assert not [*plot.wrong_dims(values)]
    other = kind_of(kind).model_validate({"kind": kind})
    values |= {name: [0.0, 1.0] for name in other.dims}
    assert [*other.wrong_dims(values)]
