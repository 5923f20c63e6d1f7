"""The room of figures keeps to what matplotlib offers: no registry, no private name, one layout."""

import re
from pathlib import Path

import pytest

import disc_model

ROOM = Path(disc_model.__file__).parent / "figures"
FORBIDDEN = {
    "a registry by weak keys": r"weakref|Weak\w+Dictionary",
    "a private name of matplotlib": r"\b(?:ax|axes|axis|figure|legend|line|mesh|bar|spec)\._[a-z]",
    "a measure of what is drawn": r"get_window_extent|get_tightbbox|set_dpi",
    "a second layout": r"tight_layout|subplots_adjust|set_position",
    "a regular expression on a long name": r"re\.\w+\([^)]*long_name",
}


@pytest.mark.parametrize("what", FORBIDDEN)
def test_the_room_has_none(what: str) -> None:
    for path in ROOM.rglob("*.py"):
        found = re.search(FORBIDDEN[what], path.read_text(encoding="utf-8"))
        assert found is None, (path.name, found)
