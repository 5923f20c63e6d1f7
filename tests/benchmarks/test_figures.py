"""The benchmark's figures."""

import xarray as xr

from disc_model.benchmarks import figures
from disc_model.benchmarks.methods import METHODS
from disc_model.figures.drawing import save
from tests.figures.reading import labels


def test_cost_against_accuracy_is_drawn(dataset: xr.Dataset, tmp_path) -> None:
    figure = figures.overview(dataset)
    expected = {METHODS[name].label for name in ("series", "RK4", "Radau")}
    assert set(labels(figure)) == expected | {f"{METHODS['RK4'].label}, without Python"}
    assert [text.get_text() for text in figure.axes[0].texts] == ["wrong\nevents"]
    save(figure, tmp_path / "overview.png")


def test_a_cell_of_prices_names_its_setting(priced: xr.Dataset) -> None:
    texts = [text.get_text() for text in figures.prices(priced).axes[0].texts]
    assert texts == ["2 s", "tol 1e-2", "wrong at 2", "0.4 ms", "tol 1e-6", "wrong"]
    figure = figures.answers(priced)
    assert labels(figure) == ["late", "series, modes, rigid contact", "series, from the cycle itself"]
    assert [text.get_text() for text in figure.axes[0].texts] == ["8", "4"]
