"""Figures of the paper show what their descriptions say: places, colours, labels and units."""

import pytest

from tests.figures.description import describe, differences, kept
from tests.paper.described import DESCRIBED, FOLDER


@pytest.mark.parametrize("name", DESCRIBED)
def test_a_figure_shows_what_its_description_says(name: str) -> None:
    apart = differences(describe(DESCRIBED[name]()), kept(FOLDER, name))
    assert not apart, "\n".join(apart)


def test_there_is_a_description_of_each_example_and_no_other() -> None:
    assert {path.stem for path in FOLDER.iterdir()} == {*DESCRIBED}
