"""tests/uncompiled.txt, by which `make coverage` chooses its tests."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).parents[1]
LINES = (ROOT / "tests" / "uncompiled.txt").read_text(encoding="utf-8").splitlines()


def test_every_name_is_that_of_a_test() -> None:
    """A name that is there no more would be passed over in silence, and a slow test run for minutes."""
    assert len(set(LINES)) == len(LINES)
    for line in LINES:
        place, *names = re.sub(r"^--(deselect|ignore)=", "", line).split("::")
        assert (ROOT / place).exists(), line
        source = (ROOT / place).read_text(encoding="utf-8") if names else ""
        for name in names:
            assert re.search(rf"^ *(def|class) {name.partition('[')[0]}\b", source, re.MULTILINE), line


def test_what_is_left_out_is_in_what_is_run() -> None:
    taken = [line for line in LINES if not line.startswith("--")]
    for line in LINES:
        if line.startswith("--"):
            left_out = line.partition("=")[2]
            assert any(left_out.startswith(place) for place in taken), line
