"""Bifurcation diagrams say what kind of motion each of their columns of points is of."""

import numpy as np
import pytest
import xarray as xr

import disc_model as dm
from disc_model.analysis.classify import ANSWER
from disc_model.data.variables import LONG_TERM_OUTCOMES, PHASES
from disc_model.figures.gap_rows import rows_above
from disc_model.figures.kind_rows import FILLS, SHAPES, WORDS
from tests.figures.every_kind import column, flag, over, stated
from tests.figures.made_up import status
from tests.figures.reading import draw, labels

SPEEDS = np.array([8.0, 9.0, 10.0])
KINDS = ["quiet", "separating", "undecided"]


def study_of(section: str) -> xr.Dataset:
    """Two samples of each of three motions."""
    angles = np.array([[0.031, 0.032], [0.028, 0.04], [0.03, 0.035]])
    phases = [["stick"] * 2, ["separation"] * 2, ["stick"] * 2]
    data = {
        "psi": (("Omega", "sample"), angles, column("bifurcation", "psi")),
        "phase": flag(("Omega", "sample"), phases, ("none", *PHASES)),
        "settled": flag(("Omega",), ["settled"] * 3, ANSWER.flags),
        "kind": flag(("Omega",), KINDS, LONG_TERM_OUTCOMES),
        "period_events": ("Omega", [1, 2, 0], column("bifurcation", "period_events")),
        "status": status(("Omega",), ["ok"] * 3),
    }
    words = {**stated(section=section), "quantity": "bifurcation"}
    return xr.Dataset(data, over(Omega=SPEEDS, sample=np.arange(2)), words)


@pytest.mark.parametrize(("section", "words"), [("stroboscopic", FILLS), ("event", WORDS)])
def test_a_sweep_has_a_row_for_each_kind_which_the_legend_names(section: str, words: str) -> None:
    """A stable cycle filled an interval once a turn, and looked like chaos."""
    ax = dm.plot_sweep(study_of(section), "psi")
    [strip] = rows_above(ax)
    assert strip.words.get_text().replace("\n", " ") == words
    places = [list(row.get_xdata()) for row in strip.rows]
    assert places == [[8.0], [9.0], [10.0]]
    assert {*KINDS} <= {*labels(ax.figure)}


def test_only_cycles_fill_intervals() -> None:
    study = study_of("stroboscopic")
    ax = dm.plot_sweep(study.isel(Omega=[2, 2]).assign_coords(Omega=[10.0, 11.0]), "psi")
    [strip] = rows_above(ax)
    assert strip.words.get_text().replace("\n", " ") == WORDS


def test_a_figure_of_a_study_has_the_same_rows() -> None:
    ax = draw("bifurcation", study_of("stroboscopic"), x="Omega").axes[0]
    marks = {line.get_label(): line for line in ax.lines}
    for kind, speed in zip(KINDS, SPEEDS, strict=True):
        assert marks[kind].get_marker() == SHAPES[kind]
        assert list(marks[kind].get_xdata()) == [speed]
    title = ax.get_legend().get_title().get_text()
    assert FILLS in title.replace("\n", " ")
