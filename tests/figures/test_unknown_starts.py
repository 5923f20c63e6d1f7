"""Pictures of basins whose starts are of unknown outcome."""

from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot

from disc_model import plot_sweep
from disc_model.data.variables import LONG_TERM_OUTCOMES
from disc_model.figures.classes import UNKNOWN_STARTS
from tests.figures.test_sweeps import said_above

NAN = np.nan
CODES = {word: code for code, word in enumerate(LONG_TERM_OUTCOMES)}
FLAGS = {"flag_values": np.arange(len(CODES), dtype=np.int8), "flag_meanings": " ".join(CODES)}
ATTRIBUTES = {
    "function": "basins",
    "options": '{"horizon": 60, "energies": [0.1], "n_starts": 4, "confidence": 0.95}',
    "base": '{"N": 385}',
}
OF_INTERVAL = "95 % interval of the share that separates"
KINDS = {
    "undecided": ["undecided", "undecided", "undecided", "undecided"],
    "quiet": ["quiet", "quiet", "quiet", "quiet"],
    "some": ["quiet", "undecided", "separating", "separating"],
    "failed": ["quiet", "quiet", "failed", "quiet"],
}
"""Outcomes of four starts."""


def basins_with(points: list[str], **values: list[float]) -> xr.Dataset:
    """A sweep of basins over the speed, with the outcomes of `KINDS` at its points."""
    codes = np.zeros((len(points), 4), dtype=np.int8)
    for place, point in enumerate(points):
        codes[place] = [CODES[word] for word in KINDS[point]]
    speeds = 14.0 + np.arange(len(points))
    study = xr.Dataset({"kind": (("Omega", "start"), codes, FLAGS)}, {"Omega": speeds}, ATTRIBUTES)
    for name, numbers in values.items():
        study[name] = ("Omega", numbers)
    return study


def words_of(ax: Any) -> list[str]:
    """What the legends of a picture say."""
    legends = [*ax.figure.legends, ax.get_legend()]
    texts = [text for legend in legends if legend for text in legend.get_texts()]
    return [text.get_text().replace("\n", " ") for text in texts]


@pytest.mark.parametrize("width", [84, 174])
def test_a_share_is_drawn_with_its_interval_also_where_all_starts_are_undecided(width: int) -> None:
    """It was a plain 0."""
    study = basins_with(
        ["quiet", "undecided"],
        separating_fraction=[0.0, NAN],
        separating_fraction_low=[0.0, 0.0],
        separating_fraction_high=[0.49, 1.0],
    )
    size = (width / 25.4, 60 / 25.4)
    _, ax = pyplot.subplots(figsize=size, layout="constrained")
    plot_sweep(study, "separating_fraction", ax=ax)

    named = words_of(ax)
    assert said_above(ax) == ["undecided"]
    assert OF_INTERVAL in named
    assert UNKNOWN_STARTS.label not in " ".join(named)

    [bars] = [line for line in ax.lines if len(line.get_xdata()) == 6]
    at_quiet = [0, 0.49, NAN]
    at_undecided = [0, 1, NAN]
    ends = bars.get_ydata()
    _, top = ax.get_ylim()
    assert ends == pytest.approx(at_quiet + at_undecided, nan_ok=True)
    assert top > 1


def test_a_map_of_shares_marks_cells_with_undecided_starts() -> None:
    """The picture was a clean 0 everywhere."""
    known = basins_with(["quiet", "quiet"], separating_fraction=[0.0, 0.0])
    with_some = basins_with(["quiet", "some"], separating_fraction=[0.0, 0.0])
    undecided = basins_with(["undecided", "quiet"], separating_fraction=[NAN, 0.0])
    loads = xr.Variable("N", [300.0, 320.0, 340.0, 360.0])
    slow = xr.concat([with_some, undecided, known, known], loads)
    fast = slow.assign_coords(Omega=[16.0, 17.0])
    study = xr.concat([slow, fast], "Omega")

    ax = plot_sweep(study)
    hatched = [patch for patch in ax.patches if patch.get_hatch() == UNKNOWN_STARTS.hatch]
    [cells] = [patch.get_path() for patch in hatched]
    n_cells = np.sum(cells.codes == cells.MOVETO)
    assert words_of(ax) == ["undecided", UNKNOWN_STARTS.label]
    assert n_cells == 2
