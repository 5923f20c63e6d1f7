"""Points that xarray's where masks are left out of pictures of sweeps."""

import functools
from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot
from matplotlib.patches import PathPatch

import disc_model as dm
from disc_model.data.variables import flag_names
from disc_model.figures.gap_rows import rows_above
from tests.figures.test_wishes import legend_texts

CASE = dm.Parameters(N=385, Omega=15, n_diameters=2)
OUTCOMES = [["separation"] * 3 for _ in range(4)]


@pytest.fixture(autouse=True)
def _closed() -> object:
    yield
    pyplot.close("all")


@functools.cache
def masked() -> xr.Dataset:
    """Cycles at four speeds, but one, and three loads."""
    study = dm.sweep(dm.floquet, CASE, Omega=[11, 12, 13, 14], N=[350, 360, 370])
    outcome = (("Omega", "N"), OUTCOMES, {"long_name": "outcome"})
    return study.assign(outcome=outcome).where(study["Omega"] != 12)


@pytest.mark.parametrize("variable", ["growth_rate", "period", "stable", "status", "outcome"])
def test_masked_points_of_a_map_are_blank(variable: str) -> None:
    """They were a class of the name "nan", or had failed, and a masked column was unresolved."""
    ax = dm.plot_sweep(masked(), variable, lines=False)
    said = legend_texts(ax)
    assert "left out" in said
    assert not {"nan", "failed", "unresolved"} & {*said}
    hatched = [patch for patch in ax.patches if isinstance(patch, PathPatch)]
    assert all(patch.get_hatch() for patch in hatched)
    assert not any(patch.get_path().contains_point((12, 360)) for patch in hatched)


@pytest.mark.parametrize("variable", ["growth_rate", "period", "stable", "status"])
def test_masked_points_of_lines_are_left_out(variable: str) -> None:
    ax: Any = dm.plot_sweep(masked(), variable, lines="N")
    assert {row.reason for row in rows_above(ax)} <= {"no cycle found"}
    assert "nan" not in [text.get_text() for text in ax.get_yticklabels()]
    heights = [np.asarray(line.get_ydata(), dtype=float) for line in ax.lines]
    assert not any(line.size == 4 and np.isfinite(line[1]) for line in heights)


def test_masked_words_are_empty() -> None:
    words = flag_names(masked()["status"])
    assert (words[1] == "").all()
    assert (words[0] == "ok").all()


def test_legends_below_maps_have_letters_of_one_size() -> None:
    """The smaller one stood beside one of usual size."""
    figure, axes = pyplot.subplots(1, 2, figsize=(84 / 25.4, 3), layout="constrained")
    dm.plot_sweep(masked(), "status", ax=axes[0], lines=False)
    words = ("no cycle found", "left out", "yes")
    named = {word: f"{word}, of several words that need room" for word in words}
    dm.plot_sweep(masked(), "stable", ax=axes[1], lines=False, labels=named)
    sizes = {text.get_fontsize() for ax in axes for text in ax.get_legend().get_texts()}
    assert len(sizes) == 1
    pyplot.close(figure)
