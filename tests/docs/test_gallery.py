"""Pictures of the gallery."""

from pathlib import Path

import numpy as np
from docs.make_gallery import PAGE, film, shrink
from PIL import Image, ImageColor

from disc_model.figures.drawing import PHASE_COLOURS, SLIDER
from tests.figures.test_cases import simulated


def test_small_pictures_showed_phases_in_other_colours(tmp_path: Path) -> None:
    """128 colours by frequency made the green of stick grey beside a map of many hues."""
    across = np.linspace(0, 255, PAGE).astype(np.uint8)
    picture = np.stack(np.broadcast_arrays(across[None, :], across[:600, None], across[None, ::-1]), axis=-1)
    kept = [ImageColor.getrgb(colour) for colour in (*PHASE_COLOURS.values(), SLIDER, "#ffffff")]
    picture = picture.copy()
    for i, colour in enumerate(kept):
        picture[20:60, 100 * i : 100 * i + 40] = colour
    Image.fromarray(picture).save(tmp_path / "large.png")
    with Image.open(shrink(tmp_path / "large.png", tmp_path / "small.png")) as small:
        shown = np.asarray(small.convert("RGB"))
    scale = shown.shape[1] / PAGE
    for i, colour in enumerate(kept):
        assert tuple(shown[round(40 * scale), round((100 * i + 20) * scale)].tolist()) == colour


def test_a_film_moves(tmp_path: Path) -> None:
    path = tmp_path / "film.webp"
    film(simulated(True), path, frames=3)
    with Image.open(path) as picture:
        assert picture.n_frames >= 3
    assert path.stat().st_size < 100_000
