"""The benchmark's figures."""

import json

import numpy as np
import pandas as pd
import pytest
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


@pytest.fixture
def two_lines() -> xr.Dataset:
    """One line with a right and a wrong setting, one without answers, and a model of which two points coincide."""
    rows = [
        ("RK4", "step", 1e-4, 1e-3, 0.4, figures.RIGHT),
        ("RK4", "step", 4e-4, 5.0, 0.1, figures.WRONG),
        ("CVODE", "tol", 1e-3, np.nan, 2.0, figures.NO_ANSWER),
        ("rigid", "diameters", 8, 1e-2, 0.3, figures.RIGHT),
        ("rigid", "diameters", 6, 1e-2, 0.29, figures.RIGHT),
        ("rigid", "diameters", 1, 1.0, 0.01, figures.WRONG),
    ]
    table = pd.DataFrame(rows, columns=["line", "varies", "setting", "error", "seconds", "verdict"]).rename_axis("row")
    table = table.assign(label=table["line"], answer="first_separation")
    questions = json.dumps({"first_separation": {"enough": 0.1}})
    return xr.Dataset.from_dataframe(table).assign_attrs(questions=questions)


def test_a_cell_of_prices_names_its_setting_and_no_number_covers_another(two_lines: xr.Dataset) -> None:
    texts = figures.prices(two_lines).axes[0].texts
    assert [text.get_text() for text in texts] == ["0.4 s", "step 1e-4 s", "wrong at 1", "no answer"]
    figure = figures.answers(two_lines)
    assert labels(figure) == ["RK4", "rigid"]
    assert [text.get_text() for text in figure.axes[0].texts] == ["8", "1"]
