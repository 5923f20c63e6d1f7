"""The units of figures of studies: those in which the file gives what varies."""

from typing import Any

import pytest

import disc_model as dm
from disc_model.studies.given_units import given_units
from disc_model.studies.study import parse_study
from tests.figures.reading import draw

RANGE = {"start": "100 rpm", "stop": "160 rpm", "count": 3}
CURVE = {"kind": "curve", "variable": "growth_rate", "x": "Omega", "by": "N"}


def shown_units(content: dict[str, Any]) -> dict[str, dict[str, str]]:
    """The units of each figure of a study."""
    study = parse_study({"study": "mine", "quantity": "floquet", **content})
    grids, _ = study.grids()
    return {name: entry.plot.units for (_, name), entry in study.entries(grids).items()}


def test_figures_have_the_units_of_the_axes_unless_they_say_others() -> None:
    """Axes given in rpm were drawn in rad/s, unless each figure repeated the unit."""
    own = CURVE | {"units": {"Omega": "rad/s"}}
    figures = {"plain": CURVE, "own": own}
    axes = {"Omega": RANGE, "N": ["0.3 kN", "0.4 kN"]}
    shown = shown_units({"axes": axes, "figures": figures})
    assert shown["plain"] == {"Omega": "rpm", "N": "kN"}
    assert shown["own"] == {"Omega": "rad/s", "N": "kN"}


def test_titles_and_captions_have_the_units_of_the_base() -> None:
    """The speed of a study was titled in rad/s, though it was given in rpm."""
    content = {"base": {"Omega": "140 rpm"}, "axes": {"N": [300.0, 400.0]}}
    figures = {"plain": CURVE | {"x": "N", "by": None}}
    study = parse_study({"study": "mine", "quantity": "floquet", **content, "figures": figures})
    [entry] = study.entries(study.grids()[0]).values()
    assert "Ω = 140 rpm" in entry.caption
    computed = dm.run_study({"study": "mine", "quantity": "floquet", **content})
    figure = draw("curve", computed, variable="growth_rate", x="N", units=entry.plot.units)
    assert "140 rpm" in figure.get_suptitle()


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        ({"axes": {"Omega": RANGE}}, {"Omega": "rpm"}),
        ({"axes": {"Omega": RANGE | {"extra": ["170 rpm"]}}}, {"Omega": "rpm"}),
        ({"axes": {"Omega": {"blocks": [["100 rpm"], RANGE]}}}, {"Omega": "rpm"}),
        ({"zip": {"N": ["0.3 kN"], "Omega": [12]}}, {"N": "kN"}),
        ({"zip": [{"N": ["0.3 kN"]}, {"c": [1]}]}, {"N": "kN"}),
        ({"options": {"scan": RANGE}}, {"Omega": "rpm"}),
        ({"options": {"scan": {"start": "1 kN"}, "parameter": "N"}}, {"N": "kN"}),
        ({"options": {"low": "100 rpm"}}, {"Omega": "rpm"}),
        ({"options": {"x_range": ["1 kN", "2 kN"], "x": "N"}}, {"N": "kN"}),
        ({"base": {"Omega": "140 rpm", "N": 300, "disc": "a.csv"}}, {"Omega": "rpm"}),
        ({"base": {"Omega": "14 rad/s", "N": "0.3 kN"}, "axes": {"k": [1]}}, {"N": "kN"}),
        ({"base": {"N": "0.3 kN"}, "options": {"scan": RANGE}}, {"N": "kN", "Omega": "rpm"}),
        ({"axes": {"Omega": [12, "100 rpm"]}}, {}),
        ({"axes": {"Omega": ["12 rad/s"], "N": ["300 N"], "h": ["2 mm"]}}, {}),
        ({"axes": {"Omega": ["3 kN"], "contact": ["unilateral"], "mu_k": [0.2]}}, {}),
        ({"axes": None, "zip": None, "options": None}, {}),
    ],
)
def test_units_of_axes(content: dict[str, Any], expected: dict[str, str]) -> None:
    """A unit that figures have by themselves, or that only some values have, is none of them."""
    assert given_units(content) == expected
