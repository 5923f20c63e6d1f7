"""Pictures that tell what they show in grey print as well."""

from pathlib import Path

import numpy as np

import disc_model as dm
from disc_model.figures.film import LEVELS
from disc_model.simulation.case import Window


def test_a_film_shows_the_sign_of_the_deflection_without_colours(tmp_path: Path) -> None:
    """Both ends of its scale of colours are dark."""
    window = Window(start=0.0, stop=0.01, rate=1000)
    run = dm.simulate(dm.Parameters(N=385, Omega=15.1), 0.01, {"w": window})
    film = run.animate(tmp_path / "film.gif", window="w", frames=2)
    disc = film._fig.axes[0]
    [lines] = [each for each in disc.collections if hasattr(each, "levels")]
    greatest = max(lines.levels) / max(LEVELS)
    np.testing.assert_allclose(lines.levels, greatest * np.array(LEVELS))
    assert len({*map(str, lines.get_linestyles())}) == 2, "dashed below zero"
