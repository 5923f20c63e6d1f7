"""Figures show what their descriptions say: places, colours, marks, widths, labels and units."""

import pytest

from tests.figures.described import DESCRIBED, FOLDER
from tests.figures.description import describe, differences, kept


@pytest.mark.parametrize("name", DESCRIBED)
def test_a_figure_shows_what_its_description_says(name: str) -> None:
    apart = differences(describe(DESCRIBED[name]()), kept(FOLDER, name))
    assert not apart, "\n".join(apart)


def test_there_is_a_description_of_each_example_and_no_other() -> None:
    assert {path.stem for path in FOLDER.iterdir()} == {*DESCRIBED}


@pytest.mark.parametrize(
    ("found", "same"),
    [
        ("line #000000 'u (mm)': 1 2; 3 4.0005", True),
        ("line #000000 'u (mm)': 1 2; 3 4.05", False),
        ("line #000000 'u (m)': 1 2; 3 4", False),
        ("line #0000ff 'u (mm)': 1 2; 3 4", False),
        ("line #000000 'u (mm)': 1 2; 3 4; 5 6", False),
        ("line #000000 'u (mm)': 1 2; 3 nan", False),
    ],
)
def test_descriptions_differ_in_words_and_numbers(found: str, same: bool) -> None:
    kept_line = "line #000000 'u (mm)': 1 2; 3 4"
    assert bool(differences([found], [kept_line])) is not same
    assert differences([found, "more"], [kept_line])
    assert differences([], [kept_line])
