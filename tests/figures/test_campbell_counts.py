"""How many crossings the legend of a Campbell diagram counts: each one has a mark, or is counted once."""

import re
from typing import Any

import pytest
import xarray as xr
from matplotlib import pyplot
from matplotlib.figure import Figure

import disc_model as dm
from disc_model.figures.campbell_looks import CROSSINGS
from disc_model.studies.quantities.campbell import EFFECTS, LINES
from tests.figures.every_kind import flag
from tests.figures.made_up import campbell_study
from tests.figures.reading import labels

MARKS = {"o", "D", *(crossing.marker for crossing in CROSSINGS)}
"""Of crossings in a panel of frequencies."""


def study_of_many() -> xr.Dataset:
    """A study of nine crossings of all kinds, of which two lie at a peak each."""
    study = campbell_study()
    data = {
        "crossing_Omega": [10.52, 10.48, 14.1, 8.5, 9.0, 11.0, 12.0, 13.0, 17.0],
        "crossing_frequency": [140.5, 189.5, 2.2, 71.0, 139.0, 189.0, 142.0, 187.0, 147.0],
        "crossing_multiple": [2.5, 3.0, 1.0, 1.0, 2.5, 3.0, 2.5, 3.0, 2.5],
        "crossing_step": [0.1] * 9,
    }
    lines = ["stick_slip", "stick_slip", "rotation", *["stick_slip"] * 6]
    effects = [
        *("rises", "no_rise", "rises", "unresolved", "unresolved"),
        *("beyond_scan", "no_rise", "mode_rises", "beyond_scan"),
    ]
    crossings = [name for name in study if "crossing" in study[name].dims]
    study = study.drop_vars(crossings)
    for name, values in data.items():
        study[name] = ("crossing", values)
    study["crossing_mode"] = ("crossing", [2, 3, 3, 1, 2, 3, 2, 3, 2])
    study["crossing_line"] = flag(("crossing",), lines, LINES)
    study["crossing_effect"] = flag(("crossing",), effects, EFFECTS)
    return study


def count_said(figure: Figure) -> tuple[int, int, int]:
    """What the legend says: the number of all crossings, of those counted, and of those among them that
    have a mark."""
    [said] = [text for text in labels(figure) if re.match(r"\d+ crossings?:", text)]
    head, _, tail = said.partition(":")
    every = int(head.split()[0])
    counted = 0
    marked = 0
    for part in tail.replace(",\n", ";").split(";"):
        word = part.split()[0]
        count = every if word == "all" else int(word)
        counted += count
        inside = re.search(r"\((\d*) ?marked\)", part)
        if inside:
            marked += int(inside[1] or count)
    return every, counted, marked


def marks_of(figure: Figure) -> int:
    """The number of crossings that have a mark in the panels of frequencies."""
    count = 0
    panels = [ax for ax in figure.axes if "growth" not in ax.get_ylabel()]
    for ax in panels:
        if ax.get_yscale() == "symlog":
            continue
        places = set[Any]()
        for line in ax.lines:
            if line.get_marker() in MARKS and line.get_linestyle() == "None":
                places |= {tuple(place) for place in line.get_xydata().tolist()}
        count += len(places)
    return count


def assert_counts_add_up(figure: Figure) -> None:
    every, counted, marked_and_counted = count_said(figure)
    assert marks_of(figure) - marked_and_counted + counted == every


LIMITS = [None, 150.0, 50.0]
ASKED_FOR: list[list[float]] = [[], [3], [1, 2.5, 3]]


@pytest.mark.parametrize("multiples", ASKED_FOR)
@pytest.mark.parametrize("highest", LIMITS)
def test_crossings_with_a_mark_and_those_counted_are_all(
    highest: float | None, multiples: list[float]
) -> None:
    """Of 12 crossings, 4 were not marked and 2 not known, and no mark was to be seen."""
    top, _ = dm.plot_campbell(study_of_many(), highest=highest, multiples=multiples)
    assert_counts_add_up(top.figure)
    pyplot.close("all")


def said_of_counts(study: xr.Dataset, **wishes: Any) -> list[str]:
    """What the legend says of the number of crossings."""
    top, _ = dm.plot_campbell(study, **wishes)
    said = [text.replace("\n", " ") for text in labels(top.figure)]
    return [text for text in said if re.match(r"\d+ crossings?:", text)]


def test_crossings_above_the_highest_frequency_are_counted() -> None:
    assert said_of_counts(campbell_study(), highest=150) == ["3 crossings: 1 above 150 Hz"]
    assert said_of_counts(campbell_study(), highest=1) == ["3 crossings: all above 1 Hz"]
