"""Labels and titles in as few lines as their axes have room for."""

import disc_model as dm
from disc_model.figures.head_texts import head_text, what_case
from disc_model.figures.stated_case import stated


def test_many_values_take_two_lines_above_a_figure() -> None:
    """The head of a map of a steel disc took seven lines, a third of its figure."""
    values = ", ".join(f"x{i} = {i} N" for i in range(40))
    title, *lines = head_text(3.5, "A title", values, most=2).split("\n")
    assert title == "A title"
    assert len(lines) == 2
    shown = " ".join(lines).count("=")
    assert lines[-1].endswith(f"and {40 - shown} further parameters")
    assert head_text(3.5, "", "N = 1 N", most=2) == "N = 1 N"
    assert head_text(3.5, "", values).count("=") == 40


def test_parameters_without_a_symbol_have_words() -> None:
    assert what_case({"contact_arc": 0.4}) == "a pad over 0.4 rad"


def test_titles_tell_discs_that_are_given_by_their_modes_apart() -> None:
    """Two discs of as many modes had the same title."""
    titles = []
    for highest in (1820, 2300):
        disc = dm.Disc(diameters=[0, 2], omega=[1490, highest], amplitude=[1.5, 2.2])
        titles.append(stated(dm.Parameters(N=385, Omega=15, disc=disc)))
    start = "N = 385 N, Ω = 15 rad/s, a disc given by 2 modes of 237.1 to"
    assert titles == [f"{start} {highest} Hz" for highest in ("289.7", "366.1")]
