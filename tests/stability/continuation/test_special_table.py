"""The printed table of special points."""

import disc_model as dm


def test_a_terminal_shows_all_columns() -> None:
    """The speed was left out of lines of 80 characters."""
    branch = dm.continue_cycle(dm.Parameters(N=385, Omega=14.9), "Omega", (14.8, 15.2))
    printed = str(branch.special_points)
    assert max(map(len, printed.splitlines())) <= 80
    assert {*branch.special_points} <= {*printed.split()}
