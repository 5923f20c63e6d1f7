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


def test_first_separations_far_from_the_converged_one_are_arrows_and_models_without_a_cycle_crosses() -> None:
    models = {"case": ["one"], "contact": ["rigid", "residual"], "model": ["1,0", "2,0", "3,0"]}
    others = ("frequency_error", "cost", "separations", "separated_share", "u_range", "force_max_separating")
    values = dict.fromkeys(others, np.ones((1, 2, 3))) | {
        "modes": np.array([[[3, 5, 7]] * 2]),
        "growth_rate": np.array([[[np.nan, 0.2, 0.1], [0.3, 0.2, 0.1]]]),
        "first_separation": np.array([[[20.0, 9.0, 5.0], [10.2, 10.1, 10.0]]]),
    }
    cases = json.dumps({"one": {"N": 800.0, "Omega": 30.0}})
    study = xr.Dataset({name: ([*models], value) for name, value in values.items()}, models, {"cases": cases})
    figure = figures.contact_truncation(study)
    assert labels(figure) == ["as published, N = 800 N, Ω = 30 rad/s", "residual", "rigid", "no cycle found"]
    _, growth, late, *_ = figure.axes
    # at these numbers of modes: rigid contact is twice as late with 3 modes, and half as late with 7
    found = {line.get_marker(): [*line.get_xdata()] for ax in (growth, late) for line in ax.lines}
    assert {mark: found[mark] for mark in "x^v"} == {"x": [3], "^": [3], "v": [7]}
    assert late.get_ylim() == (-figures.FAR, figures.FAR)
    shown = [line.get_ydata() for line in late.lines if len(line.get_ydata()) == 3]
    np.testing.assert_allclose(shown, [[2, 1, 0], [100, -10, -50]], atol=1e-12)
