"""What a run of studies says at its end of points without a result."""

from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path

from disc_model.data.variables import WITHOUT_CYCLE
from disc_model.studies.grid import GridStudy
from disc_model.studies.point_lists import listed_in


def closing_lines(grids: Mapping[str, GridStudy]) -> Iterator[str]:
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
