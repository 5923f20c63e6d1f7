"""Figures of any case: what they show of a computed run, and what stands where a case holds less."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure

from disc_model.data.variables import axis_of
from disc_model.figures.kinds import CASE_PLOTS
from disc_model.figures.parts import draw, save
from tests.claims.damaged import damaged
from tests.figures.grids.reading import labels
from tests.figures.paper.test_catalogue import made_up_window

RATE = 4000.0
TIME = np.arange(0, 3, 1 / RATE)


@pytest.fixture
def case() -> xr.DataTree:
    """A disc that swings at 100 Hz, a slider that goes round in psi, and a first separation at 2 s."""
    swing = 1e-3 * np.cos(2 * np.pi * 100 * TIME)
    samples = {"P": 200 + swing, "w": swing, "w_point": swing, "psi": np.cos(TIME), "psi_velocity": -np.sin(TIME)}
    samples |= {"u": swing, "w_point_velocity": swing, "phase": (TIME > 1).astype(np.int8)}
    late = made_up_window(TIME, samples, theta=1.0)
    few = late[["P", "w"]].isel(time=slice(None, None, 100))
    whole = few.rename(P="P_min", w="w_min").merge((few + 1).rename(P="P_max", w="w_max"))
    root = xr.Dataset({"first_separation": 2.0, "time_reached": 3.0}, attrs={"parameters": '{"N": 200, "Omega": 20}'})
    turns = late.isel(time=slice(0, None, 500))
    return xr.DataTree.from_dict({"/": root, "/late": late, "/whole": whole, "/poincare": turns})


def drawn(case: xr.DataTree, kind: str, **said: Any) -> Figure:
    plot = CASE_PLOTS[kind].model_validate({"kind": kind, "case": "A", **said})
    return draw(plot, {"A": case})


def test_a_history_has_a_panel_for_each_variable(case: xr.DataTree, tmp_path: Path) -> None:
    figure = drawn(case, "history", window="late", variables=["P", "w_point", "psi"], title="Seen")
    assert figure.axes[0].get_ylabel() == axis_of("P")[0]
    assert figure.get_suptitle() == "Seen\nN = 200 N, Ω = 20 rad/s"
    assert len(figure.axes) == 3
    line = figure.axes[0].lines[0]
    assert np.array_equal(line.get_ydata(), case["late/P"].values)
    assert figure.axes[1].lines[0].get_ydata()[0] == pytest.approx(1.0)  # mm
    assert any("first separation 2.00 s" in text.get_text() for text in figure.axes[0].texts)
    save(figure, tmp_path / "history.png")


def test_a_history_of_ranges_is_a_band(case: xr.DataTree) -> None:
    figure = drawn(case, "history", window="whole")
    assert all(len(ax.collections) == 1 for ax in figure.axes)


def test_a_spectrogram_shows_the_frequency_that_is_there(case: xr.DataTree) -> None:
    (mesh,) = drawn(case, "spectrogram", window="late", highest=400).axes[0].collections
    values = mesh.get_array()
    corners = mesh.get_coordinates()[:, 0, 1]
    centre = (corners[:-1] + corners[1:]) / 2
    assert centre[int(np.argmax(values.sum(axis=1)))] == pytest.approx(100, abs=2)  # two steps of the transform


def test_a_portrait_is_coloured_by_phase(case: xr.DataTree) -> None:
    (ax,) = drawn(case, "portrait", window="late").axes
    assert labels(ax) == ["stick", "slip"]
    assert ax.get_xlabel() == axis_of("psi")[0]


def test_a_section_has_slider_and_disc(case: xr.DataTree) -> None:
    slider, disc = drawn(case, "poincare").axes
    shown = sum(len(collection.get_offsets()) for collection in slider.collections)
    assert shown == case["poincare"].sizes["time"]
    assert disc.get_xlabel().startswith("Disc at")


@pytest.mark.parametrize("kind", ["history", "spectrogram", "portrait"])
def test_a_window_that_the_run_did_not_reach_is_said(kind: str, case: xr.DataTree) -> None:
    """A case that stops at its first separation ended the job of a history in an IndexError."""
    early = damaged(case, lambda groups: groups | {"late": groups["late"].isel(time=slice(0))})
    figure = drawn(early, kind, window="late")
    texts = [text.get_text().replace("\n", " ") for ax in figure.axes for text in ax.texts]
    assert any("has 0 samples in late" in text for text in texts)


@pytest.mark.parametrize("kind", CASE_PLOTS)
def test_what_a_failed_case_lacks_is_said(kind: str) -> None:
    empty = xr.DataTree(xr.Dataset({"first_separation": np.nan, "time_reached": 0.0}))
    said = {} if kind == "poincare" else {"window": "late"}
    texts = [text.get_text() for ax in drawn(empty, kind, **said).axes for text in ax.texts]
    assert any("did not record" in text.replace("\n", " ") for text in texts)
