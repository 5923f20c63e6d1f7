"""Lists of the points of a study of which there is something to say, in files beside its dataset."""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from disc_model.data.variables import WITHOUT_CYCLE

if TYPE_CHECKING:
    from disc_model.studies.grid import GridStudy

NONE = "no point"
"""The line of a file that lists none."""


def point_list(lines: Iterable[str]) -> str:
    """The text of a file that lists points, a line for each."""
    return "".join(f"{line}\n" for line in [*lines] or [NONE])


def listed_in(file: Path) -> list[str]:
    """The lines of the points that a file lists."""
    lines = file.read_text(encoding="utf-8").splitlines()
    return [] if lines == [NONE] else lines


def closing_lines(grids: Mapping[str, "GridStudy"]) -> Iterator[str]:
    """Grids with points that have no result, no cycle, which is an answer, or a remark on the
    result, and where these are listed."""
    for name, grid in grids.items():
        file = Path(f"results/{name}/{name}.failed.txt")
        remarks = file.with_name(f"{name}.remarks.txt")
        lines = listed_in(file)
        answers = Counter(filter(None, map(_answer_in, lines)))
        said = ", ".join(f"{count} {word}" for word, count in answers.most_common())
        told = (
            (len(lines) - answers.total(), "no result", file),
            (answers.total(), f"no stick-slip cycle ({said})", file),
            (len(listed_in(remarks)), "a remark", remarks),
        )
        for count, have, listed in told:
            if count:
                yield f"{name}: {count} of {grid.n_points} points have {have}, see {listed}"


def _answer_in(line: str) -> str:
    """What the motion does in place of a stick-slip cycle, by the line of a point; "" if the line
    does not say so."""
    said = line.split(": ")[1:2]  # after the point, whose values have no such sign
    return said[0] if said and said[0] in WITHOUT_CYCLE.values() else ""
