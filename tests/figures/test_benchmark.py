"""The benchmark's figures."""

from __future__ import annotations

import numpy as np
import xarray as xr

from disc_model.benchmarks import scenes
from disc_model.benchmarks.methods import METHODS
from disc_model.benchmarks.register import SCENES
from disc_model.figures import benchmark as figures
from disc_model.figures.parts import save
from tests.benchmarks.conftest import dataset, known

__all__ = ["dataset", "known"]


def test_cost_against_accuracy_is_drawn(dataset: xr.Dataset, tmp_path) -> None:
    figure = figures.work_precision(dataset, "stick_slip")
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert set(labels) == {METHODS[name].label for name in ("series", "RK4", "Radau")}
    texts = {text.get_text() for text in figure.axes[0].texts}
    assert "4.0" in texts
    assert "wrong\nevents" in texts
    save(figure, tmp_path / "scene.png")
    save(figures.overview(dataset), tmp_path / "overview.png")
    assert figures._spread([(1e-8, 1.0, "a", "k"), (1e-8, 1.1, "b", "k"), (1e-3, 1.1, "c", "k")]) == [
        (1e-8, 1.0, "a", "k"),
        (1e-8, 1.5, "b", "k"),
        (1e-3, 1.1, "c", "k"),
    ]


def test_every_method_looks_otherwise_and_every_scene_has_a_title():
    assert len({method.look for method in METHODS.values()}) == len(METHODS)
    assert set(figures.TITLES) == set(SCENES) == set(scenes.TITLES)
    assert figures.VERDICTS == scenes.VERDICT_WORDS


def test_many_settings_are_said_in_few_letters() -> None:
    """Five of them were longer than the cell that they stand in."""
    setting = np.array([1e-7, 1e-3, 1e-5, 1e-9])
    listed = [figures._listed(setting, np.array(chosen, bool)) for chosen in ([0, 1, 0, 0], [1, 0, 1, 0], [1, 1, 1, 0])]
    assert listed == ["1e-3", "1e-5, 1e-7", "1e-3 to 1e-7"]
    assert figures._listed(setting, np.array([True, True, False, True])) == "3 settings"
