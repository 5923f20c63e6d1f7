"""Lists of the points of a study of which there is something to say, in files beside its dataset."""

from collections.abc import Iterable
from pathlib import Path

NONE = "no point"
"""The line of a file that lists none."""


def point_list(lines: Iterable[str]) -> str:
    """The text of a file that lists points, a line for each."""
    return "".join(f"{line}\n" for line in [*lines] or [NONE])


def listed_in(file: Path) -> list[str]:
    """The lines of the points that a file lists."""
    lines = file.read_text(encoding="utf-8").splitlines()
    return [] if lines == [NONE] else lines
