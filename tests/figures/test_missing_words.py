"""Words that are missing along an axis, or among the names of lines."""

from typing import Any

import numpy as np
import pytest

import disc_model as dm

LOADS = [200.0, 385.0, 600.0]  # N


def load_of(case: dm.Parameters) -> dict[str, float]:
    """A result of its own."""
    return {"size": case.N}


@pytest.mark.parametrize("nothing", ["", None, np.nan])
def test_a_missing_word_along_an_axis_is_named(nothing: Any) -> None:
    """Its place had no word, or "nan"."""
    words = np.array(["a", nothing, "c"], dtype=object)
    sizes = dm.sweep(load_of, dm.Parameters(N=385, Omega=15), N=LOADS)
    ax = dm.plot_sweep(sizes.assign_coords(word=("N", words)), "size", x="word")
    ax.figure.canvas.draw()
    assert [text.get_text() for text in ax.get_xticklabels()] == ["a", "missing", "c"]
