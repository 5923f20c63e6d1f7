"""Names of columns that are read one by one, as in the explorer's list of variables."""

import re

import numpy as np
import pytest
import xarray as xr

from disc_model.figures.missing_texts import missing_text
from disc_model.studies.registry import quantity_of


def test_names_of_attractors_say_what_they_are_of() -> None:
    """The list had "its period" and "growth rate of it"."""
    columns = quantity_of("basins").COLUMNS
    names = [column.long_name for name, column in columns.items() if name.startswith("attractor_")]
    assert len(names) > 5
    assert all("attractor" in name for name in names)
    assert not any(re.search(r"^its |\b(on|of) it\b", name) for name in names)


@pytest.mark.parametrize(
    ("long_name", "text"),
    [
        (
            "speed, nan if friction acts on no surface that moves",
            "friction acts on no surface that moves",
        )
    ],
)
def test_pictures_say_why_there_is_no_value(long_name: str, text: str) -> None:
    """They said "no value", though the name of the variable gives the reason."""
    study = xr.Dataset({"x": ("N", [np.nan], {"long_name": long_name})})
    assert missing_text(study, "x") == text
