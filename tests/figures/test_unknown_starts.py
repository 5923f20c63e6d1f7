"""Pictures of basins whose starts are of unknown outcome."""

from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot

import disc_model as dm
from disc_model.data.variables import LONG_TERM_OUTCOMES
from disc_model.figures.classes import UNKNOWN_STARTS
from tests.figures.test_sweeps import said_above

NAN = np.nan
CODES = {word: code for code, word in enumerate(LONG_TERM_OUTCOMES)}
OPTIONS = '{"horizon": 60, "energies": [0.1], "n_starts": 4, "confidence": 0.95}'
OF_INTERVAL = "95 % interval of the share that separates"
KINDS = {
    "undecided": 4 * ["undecided"],
    "quiet": 4 * ["quiet"],
    "some": ["quiet", "undecided", "separating", "separating"],
    "failed": ["quiet", "quiet", "failed", "quiet"],
}
"""Outcomes of four starts."""


def basins_with(points: list[str], **values: list[float]) -> xr.Dataset:
    """A sweep of basins over the speed, with the outcomes of `KINDS` at its points."""
    kinds = [[CODES[word] for word in KINDS[point]] for point in points]
    flags = {"flag_values": np.arange(len(CODES), dtype=np.int8), "flag_meanings": " ".join(CODES)}
    variables: dict[str, Any] = {"kind": (("Omega", "start"), np.array(kinds, np.int8), flags)}
    for name, numbers in values.items():
        variables[name] = ("Omega", numbers)
    attrs = {"function": "basins", "options": OPTIONS, "base": '{"N": 385}'}
    speeds = 14.0 + np.arange(len(points))
    return xr.Dataset(variables, {"Omega": ("Omega", speeds)}, attrs)


def words_of(ax: Any) -> list[str]:
    """What the legends of a picture say."""
    legends = [*ax.figure.legends, ax.get_legend()]
    texts = [text for legend in legends if legend for text in legend.get_texts()]
    return [text.get_text().replace("\n", " ") for text in texts]


@pytest.mark.parametrize(
    ("point", "said"),
    [
        ("undecided", "undecided"),
        ("failed", "failed"),
        ("quiet", "no start led to lasting separation within 60 s"),
    ],
)
def test_a_critical_energy_is_not_called_missing_where_starts_are_undecided(
    point: str, said: str
) -> None:
    """Of starts that had all lost contact it was said that none led to separation."""
    study = basins_with(["some", point], critical_energy=[0.07, NAN])
    ax = dm.plot_sweep(study, "critical_energy")
    assert said_above(ax) == [said]
    assert UNKNOWN_STARTS.label in words_of(ax)
    pyplot.close("all")


@pytest.mark.parametrize("width", [84, 174])
def test_a_share_is_drawn_with_its_interval_also_where_all_starts_are_undecided(width: int) -> None:
    """It was a plain 0."""
    study = basins_with(
        ["quiet", "undecided"],
        separating_fraction=[0.0, NAN],
        separating_fraction_low=[0.0, 0.0],
        separating_fraction_high=[0.49, 1.0],
    )
    _, ax = pyplot.subplots(figsize=(width / 25.4, 60 / 25.4), layout="constrained")
    dm.plot_sweep(study, "separating_fraction", ax=ax)
    assert said_above(ax) == ["undecided"]
    assert OF_INTERVAL in words_of(ax)
    assert UNKNOWN_STARTS.label not in words_of(ax)
    [bars] = [line for line in ax.lines if len(line.get_xdata()) == 6]
    assert bars.get_ydata() == pytest.approx([0, 0.49, NAN, 0, 1, NAN], nan_ok=True)
    assert ax.get_ylim()[1] > 1
    pyplot.close("all")


def test_a_map_of_shares_marks_cells_with_undecided_starts() -> None:
    """The picture was a clean 0 everywhere."""
    rows = []
    for points in (["quiet", "some"], ["undecided", "quiet"], ["quiet"] * 2, ["quiet"] * 2):
        shares = [NAN if point == "undecided" else 0.0 for point in points]
        rows.append(basins_with(points, separating_fraction=shares))
    speeds = xr.concat(
        rows, xr.Variable("N", [300.0, 320.0, 340.0, 360.0]), combine_attrs="override"
    )
    study = xr.concat([speeds, speeds.assign_coords(Omega=[16.0, 17.0])], "Omega")
    ax = dm.plot_sweep(study)
    assert words_of(ax) == ["undecided", UNKNOWN_STARTS.label]
    hatched = [patch for patch in ax.patches if patch.get_hatch() == UNKNOWN_STARTS.hatch]
    [cells] = [patch.get_path() for patch in hatched]
    assert np.sum(cells.codes == cells.MOVETO) == 2
    pyplot.close("all")
