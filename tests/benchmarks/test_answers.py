"""What each answer costs: the right answers, what is missing, the table and the chart."""

from __future__ import annotations

import math

import numpy as np
import pytest
import xarray as xr

from disc_model.benchmarks import answers
from disc_model.benchmarks.methods import METHODS
from disc_model.benchmarks.methods.base import Method, MethodResult, Outcome
from disc_model.figures import benchmark as figures
from disc_model.schema import CYCLE_TOLERANCES, limits_faults


class Late(Method):
    """Finds the first separation late by its tolerance, and none at a coarse one; the finest takes too long."""

    label, look = "late", ("#000000", "s", "-")

    def _solve(self, problem, value, budget):
        times = np.array([1.0, 40.0 + value, 41.0]) if value < 0.1 else np.array([1.0])
        kinds = ("stick_to_slip", "separation", "separation")[: len(times)]
        outcome = Outcome.TOO_SLOW if value < 1e-3 else Outcome.FINISHED
        return MethodResult(times, kinds, problem.start, 2.0, 1, outcome)


@pytest.fixture
def dataset(monkeypatch: pytest.MonkeyPatch) -> xr.Dataset:
    monkeypatch.setitem(METHODS, "late", Late())
    known = {  # by diameters: what is found, and what the tolerance adds
        "first_separation": lambda p, tol: 40.0 + (4 - p.n_diameters) + tol * (tol > 1e-14),
        "growth_rate": lambda p, tol: math.nan if p.n_diameters == 0 else 0.5 / p.n_diameters,
    }
    for name, ask in known.items():
        _, p, tolerances = answers.ANSWERS[name]
        monkeypatch.setitem(answers.ANSWERS, name, (ask, p, tolerances[:2]))
    settings = {"late": (1.0, 1e-2, 1e-4, 1e-6)}
    asked = ("first_separation", "growth_rate")
    return answers.measure(settings, answers=asked, diameters=(0, 4, 8), richest=8)


def line(dataset: xr.Dataset, answer: str, name: str) -> xr.Dataset:
    return dataset.isel(row=(dataset["answer"].values == answer) & (dataset["line"].values == name))


def test_errors_of_models_are_against_the_richest_and_those_of_methods_against_nine_modes(dataset: xr.Dataset) -> None:
    modes = line(dataset, "first_separation", "modes")
    np.testing.assert_allclose(modes["error"], [8, 4, 0], atol=1e-9)
    late = line(dataset, "first_separation", "late")
    # without an answer there is no error; what takes too long is not tried at a finer setting
    np.testing.assert_allclose(late["error"], [math.nan, 1e-2, 1e-4], atol=1e-12)
    assert late["found"][1] == pytest.approx(40.01)
    np.testing.assert_allclose(line(dataset, "growth_rate", "modes")["found"], [math.nan, 0.125, 0.0625])
    assert np.all(line(dataset, "growth_rate", "series")["error"] == 0)


def test_it_is_written_and_drawn(dataset: xr.Dataset) -> None:
    text = answers.to_markdown(dataset)
    assert dataset.attrs["machine"] in text
    assert "| late | 1 | - | - | 2 |" in text
    figure = figures.answers(dataset)
    assert [ax.get_xlabel() for ax in figure.axes] == [figures.ANSWERS[n] for n in ("first_separation", "growth_rate")]
    assert {text.get_text() for text in figure.axes[0].texts} == {"0", "4", "8"}
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert labels == ["series, number of modes", "late", METHODS["series"].label]


def test_what_is_asked_is_taken() -> None:
    """The rule broke off at a tolerance that the search for a cycle refuses."""
    for _, _, tolerances in answers.ANSWERS.values():
        assert not any(limits_faults("tol", tol, CYCLE_TOLERANCES) for tol in tolerances)


@pytest.mark.compiled
def test_the_engines_answers_are_the_known_ones() -> None:
    """Time of first separation as stored (long double), fold and growth rate as tested elsewhere."""
    assert answers.exact("first_separation") == pytest.approx(54.418905535947973, abs=1e-11)
    assert answers.exact("onset") == pytest.approx(15.0949, abs=5e-5)
    assert answers.exact("growth_rate") == pytest.approx(0.0188, abs=1e-4)
