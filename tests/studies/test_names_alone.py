"""Names of columns that are read one by one, as in the explorer's list of variables."""

import re

from disc_model.studies.registry import quantity_of


def test_names_of_attractors_say_what_they_are_of() -> None:
    """The list had "its period" and "growth rate of it"."""
    columns = quantity_of("basins").COLUMNS
    names = [column.long_name for name, column in columns.items() if name.startswith("attractor_")]
    assert len(names) > 5
    assert all("attractor" in name for name in names)
    assert not any(re.search(r"^its |\b(on|of) it\b", name) for name in names)
