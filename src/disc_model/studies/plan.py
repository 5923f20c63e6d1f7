"""What a run of a study would compute: points, batches, and an estimate of the time."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import NamedTuple

from disc_model.parameters import Parameters
from disc_model.simulation.case import CaseSpec
from disc_model.studies.costs import unit_costs
from disc_model.studies.grid import GridStudy

ROUNDED_TO_100 = 99.5  # least number that has three digits once it is rounded to two


class Plan(NamedTuple):
    """What is to be done for one grid, or for all named cases.

    Attributes
    ----------
    name : of the study
    quantity : of the grid; "simulation" for named cases
    points : number of points or cases
    batches : number of batches or cases
    computed : how many of these batches have files already; Snakemake knows whether they are up to date
    seconds : estimated processor time of each batch without a file, s
    """

    name: str
    quantity: str
    points: int
    batches: int
    computed: int
    seconds: tuple[float, ...]


def plan_of(grid: GridStudy, results: Path) -> Plan:
    """The plan of a grid whose files are in a folder of results."""
    folder = results / grid.name / "batches"
    missing = {name: work for name, work in grid.work.items() if not _is_there(folder, name)}
    count = len(grid.work)
    seconds = tuple(missing.values())
    return Plan(grid.name, grid.quantity, grid.n_points, count, count - len(missing), seconds)


def plan_of_cases(name: str, cases: Mapping[str, CaseSpec], results: Path) -> Plan:
    """The plan of named cases whose files are in a folder of results."""
    folder = results / name / "cases"
    missing = [case for key, case in cases.items() if not _is_there(folder, key)]
    count = len(cases)
    seconds = tuple(map(_seconds_of, missing))
    return Plan(name, "simulation", count, count, count - len(missing), seconds)


def time_on(cores: int, seconds: Iterable[float]) -> float:
    """Time (s) that jobs with these processor times take on some cores: no shorter than the longest
    of them."""
    each = list(seconds)
    return max(sum(each) / cores, max(each, default=0.0))


def duration_text(seconds: float) -> str:
    """A time that is known roughly, in words."""
    if seconds < 1:
        return "less than 1 s"
    if seconds < ROUNDED_TO_100:
        return f"{seconds:.2g} s"
    if seconds < 60 * ROUNDED_TO_100:
        return f"{seconds / 60:.2g} min"
    hours = float(f"{seconds / 3600:.2g}")
    return f"{hours:g} h"


def _is_there(folder: Path, name: str) -> bool:
    return (folder / f"{name}.nc").is_file()


def _seconds_of(case: CaseSpec) -> float:
    """Estimated processor time of a named case, s."""
    values: Parameters = case.parameters
    return unit_costs(values).second * case.t_end
