"""The whole disc from a few of its points."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from PIL import Image

from disc_model import Parameters, Record, Window, simulate
from disc_model.data.dataset import Missing
from disc_model.figures.paper.disc import film, motion_of
from tests.figures.paper.test_catalogue import made_up_case


@pytest.fixture(scope="module")
def case() -> xr.DataTree:
    """A light disc that turns and separates soon; three modes, five angles."""
    p = Parameters(N=300, Omega=50, n_diameters=2, normalization="orthonormal")
    windows = [Window(start=0.5, stop=0.52, rate=2e4, theta=1.2 * j) for j in range(5)]
    windows.append(Window(start=0.5, stop=0.52, rate=2e4, theta=2.1))
    names = [*(f"around{j}" for j in range(5)), "elsewhere"]
    return simulate(p, 0.52, record=Record(windows=tuple(windows))).to_tree(names)


@pytest.mark.compiled
def test_the_disc_between_the_angles_is_the_disc(case: xr.DataTree) -> None:
    """Under the slider, and at an angle that the shape is not made from; to rounding of the displacement itself."""
    motion = motion_of(case)
    r_0 = np.array([motion.parameters.r_0])
    elsewhere = case["elsewhere"].to_dataset()
    size = float(np.abs(elsewhere["w"]).max())
    for i in range(0, motion.time.size, 20):
        under, there = motion.deflection(i, r_0, np.array([motion.slider[i], 2.1]))[0]
        assert under == pytest.approx(float(elsewhere["w"][i]), abs=1e-12 * size)
        assert there == pytest.approx(float(elsewhere["w_point"][i]), abs=1e-12 * size)


@pytest.mark.compiled
def test_the_disc_is_clamped_inside(case: xr.DataTree) -> None:
    motion = motion_of(case)
    p = motion.parameters
    r = np.array([p.a, p.a + 1e-3 * (p.b - p.a), p.b])
    w = np.abs(motion.deflection(10, r, np.linspace(0, 6, 7))).max(axis=1)
    assert w[0] < 1e-9 * w[2]
    assert 0 < w[1] < 1e-5 * w[2]  # it leaves its plane with the square of the distance


@pytest.mark.compiled
def test_what_does_not_determine_the_disc_is_said(case: xr.DataTree) -> None:
    with pytest.raises(Missing, match="recorded the disc at 4 angles, 5 are needed"):
        motion_of(case.drop_nodes("around4"))
    late = case["around1"].to_dataset().assign_coords(time=case["around1"]["time"] + 1.0)
    with pytest.raises(Missing, match="at other times at other angles"):
        motion_of(case.assign(around1=xr.DataTree(late)))
    circles = case.copy()
    circles.attrs["parameters"] = (
        Parameters.model_validate_json(case.attrs["parameters"]).replace(n_circles=1).canonical_json
    )
    with pytest.raises(Missing, match="nodal circles"):
        motion_of(circles)


def test_a_film_moves(tmp_path: Path) -> None:
    path = tmp_path / "film.webp"
    film(made_up_case(), path, frames=3)
    with Image.open(path) as picture:
        assert picture.n_frames >= 3
    assert path.stat().st_size < 100_000
