"""What a run of a study takes beside its points: the start of Snakemake and of jobs, figures, and the page.

Measured as in `disc_model.studies.costs`, with the imports of each.
"""

from collections.abc import Mapping, Sequence, Set
from pathlib import Path
from typing import NamedTuple

from disc_model.studies.grid import FigureEntry
from disc_model.studies.plan import Plan

START = 4.5  # s, of Snakemake, from the command to the first job and after the last one
BATCH = 1.5  # s, of a job with its compiled kernels, for each batch or case
MERGE = 0.5  # s, of a grid or of all cases
FIGURE = 1.2  # s
PAGE = 1.5  # s, with the motions that it shows
Figures = Mapping[tuple[str, str], FigureEntry]


class FixedCosts(NamedTuple):
    """Times beside those of points, s: `alone` while nothing else runs, and of each of other jobs."""

    alone: float
    jobs: tuple[float, ...]


def fixed_costs(
    plans: Sequence[Plan], figures: Figures, results: Path, *, page: bool = False
) -> FixedCosts:
    """What a run takes beside its points; nothing if there is nothing to do.

    Parameters
    ----------
    plans : of its grids and cases
    figures : by study and name
    results : the folder of results
    page : whether the page of all points is made
    """
    unfinished = {each.name for each in plans if each.seconds}
    batches = sum(len(each.seconds) for each in plans)
    merged = sum(1 for each in plans if each.seconds)
    drawn = 0
    for (study, name), entry in figures.items():
        file = results / study / "figures" / f"{name}.png"
        drawn += _is_drawn(file, {study, *entry.inputs.values()}, unfinished)
    jobs = (BATCH,) * batches + (MERGE,) * merged + (FIGURE,) * drawn + (PAGE,) * page
    return FixedCosts(START if jobs else 0.0, jobs)


def _is_drawn(file: Path, inputs: Set[str], unfinished: Set[str]) -> bool:
    """Whether a figure is drawn: it is missing, or shows what is computed."""
    return not file.is_file() or bool(unfinished & inputs)
