"""Figures of uncertain parameters and Campbell diagrams: what is drawn, and that no name covers another."""

from __future__ import annotations

import numpy as np
import pytest

from disc_model.figures.grids import campbell, sensitivity
from disc_model.figures.grids.campbell import noted, spread
from disc_model.figures.grids.kinds import Campbell, Sensitivity
from disc_model.studies.files import StudyError
from disc_model.studies.grids.schema import parse_grid
from tests.studies.grids.conftest import SMALL, computed
from tests.studies.grids.quantities import test_sensitivity as uncertain


def test_bars_and_probabilities_are_those_of_the_study() -> None:
    study = uncertain.made_up()
    figure = sensitivity.draw(study, {}, Sensitivity())
    assert len(figure.axes) == 1 + 2 * study.sizes["N"]
    first = figure.axes[1]
    widths = [bar.get_width() for bar in first.patches]
    cell = study.isel(N=0).sel(output="instability")
    np.testing.assert_allclose(widths, [*cell["first_index"].values, *cell["total_index"].values])
    assert [label.get_text() for label in first.get_yticklabels()] == ["k", "$\\mu_s$"]
    assert "N = 200 N" in first.get_title(loc="left")


@pytest.mark.compiled
def test_a_campbell_diagram_numbers_what_matters() -> None:
    study = computed(
        quantity="campbell",
        options={"window": 20},
        base={"N": 200, "normalization": "as_published", **SMALL},
        axes={"Omega": {"start": 9, "stop": 13, "step": 0.25}},
    )
    figure = campbell.draw(study, {}, Campbell())
    numbers = [text.get_text() for text in figure.axes[0].texts if text.get_text().isdigit()]
    assert numbers == [str(i) for i in range(1, len(noted(study)) + 1)]


@pytest.mark.parametrize("places", [[1.0, 1.01, 1.02], [0.0, 0.0, 10.0], [10.0, 10.0], [5.0], [], list(np.zeros(30))])
def test_names_are_spread(places: list[float]) -> None:
    found = np.array(spread(places, 0.5, 0.0, 10.0))
    assert len(found) == len(places)
    if len(places) > 1:
        assert np.diff(found).min() >= min(0.5, 10 / (len(places) - 1)) * (1 - 1e-12)
    if len(places):
        assert found.min() >= -1e-12
        assert found.max() <= 10 + 1e-12


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (
            {"axes": {"N": [1, 2, 3, 4, 5]}},
            "figures.f.kind = 'sensitivity': has room for 4 points beside their samples",
        ),
        ({"figures": {"f": {"kind": "campbell"}}}, "figures.f.kind = 'campbell': needs the quantity campbell"),
    ],
)
def test_what_a_figure_cannot_show_is_said(change, said) -> None:
    raw = {"study": "s", **uncertain.study({"k": uncertain.UNIFORM}, figures={"f": {"kind": "sensitivity"}}), **change}
    with pytest.raises(StudyError) as error:
        parse_grid(raw)
    assert said in str(error.value)


def test_a_campbell_diagram_shows_one_normalization() -> None:
    raw = {"study": "s", "quantity": "campbell", "base": {"N": 200}, "figures": {"f": {"kind": "campbell"}}}
    axes = {"Omega": [1, 2], "normalization": ["as_published", "orthonormal"]}
    with pytest.raises(StudyError, match=r"can show one normalization only"):
        parse_grid(raw | {"axes": axes})
    raw["figures"]["f"]["normalization"] = "orthonormal"
    assert parse_grid(raw | {"axes": axes}).plots
    with pytest.raises(StudyError, match=r"is not computed"):
        parse_grid(raw | {"axes": axes | {"normalization": ["as_published"]}})
